//! Mode shapes as pictures: bodies at rest and displaced.

use std::f64::consts::FRAC_PI_2;

use experiments::modal::FeMode;
use fe_contact::fe_mesh::polar;
use gearset::Body;

use super::ModalTest;
use super::drawing::{Anchor, Canvas, Pen, Picture, Pixel, Type};

/// Side of a panel, px, and number of panels in a row.
const SIDE: f64 = 300.0;
const COLUMNS: usize = 4;

const AT_REST: Pen = Pen::new("#c4c8cc", 0.8);

/// Height of the picture's title and of a panel's, px.
const TOP: f64 = 40.0;
const HEAD: f64 = 26.0;

/// Largest displacement drawn over the sun's radius.
const SCALE: f64 = 0.35;

/// A body's circle.
struct Circle {
    body: Body,
    centre: [f64; 2],
    /// Directions of its x and y coordinates: their angle, rad.
    axes: f64,
    /// Radius drawn, m.
    radius: f64,
    /// r in its coordinate u = r θ, m.
    arm: f64,
    /// Direction of the line that shows rotation, rad.
    hand: f64,
    /// Where that line begins, in parts of the radius.
    hand_from: f64,
    colour: &'static str,
}

/// A panel for each identified mode.
pub(super) fn picture(of: &ModalTest<'_>) -> Picture {
    let circles = circles(of);
    let modes = &of.test.modes;
    let columns = COLUMNS.min(modes.len().max(1));
    let rows = modes.len().div_ceil(columns).max(1);
    let width = SIDE * columns as f64;
    let mut canvas = Canvas::new([width, TOP + (SIDE + HEAD) * rows as f64]);
    let title = format!("{}: modes from the impulse test, thin lines at rest", of.scene.title);
    canvas.text([0.5 * width, 26.0], Type::new(16, Anchor::Middle), title);
    for (i, mode) in modes.iter().enumerate() {
        let x = SIDE * ((i % columns) as f64 + 0.5);
        let y = TOP + (SIDE + HEAD) * (i / columns) as f64;
        let label = format!("{:.1} Hz, {}", mode.frequency_hz, mode.mode_type.name());
        canvas.text([x, y + 18.0], Type::new(14, Anchor::Middle), label);
        shape(&mut canvas, of, &circles, mode, [x, y + HEAD + 0.5 * SIDE]);
    }
    canvas.picture()
}

/// Operating pitch circles of the gears and, for the carrier, the circle through its pin seats.
fn circles(of: &ModalTest<'_>) -> Vec<Circle> {
    let (geometry, races) = (of.geometry, of.races);
    let a = geometry.center_distance;
    let teeth = |gear: &gearset::Gear| f64::from(gear.teeth);
    let planet = teeth(&geometry.planet);
    let [arm_carrier, arm_ring, arm_sun, arm_planet] = races.radii;
    let central = |body, radius, arm, colour| Circle {
        body,
        centre: [0.0, 0.0],
        axes: 0.0,
        radius,
        arm,
        hand: FRAC_PI_2,
        // Lines of the large circles would cross the others.
        hand_from: if body == Body::Sun { 0.0 } else { 0.8 },
        colour,
    };
    let mut list = Vec::new();
    if !races.is_pair() {
        list.push(central(Body::Carrier, a, arm_carrier, "#8a949c"));
    }
    if let Some(ring) = &geometry.ring {
        let radius = a * teeth(ring) / (teeth(ring) - planet);
        list.push(central(Body::Ring, radius, arm_ring, "#5a6570"));
    }
    let mut radius_of_planets = geometry.planet.base_radius;
    if let Some(sun) = &geometry.sun {
        radius_of_planets = a * planet / (teeth(sun) + planet);
        list.push(central(Body::Sun, a - radius_of_planets, arm_sun, "#b8860b"));
    }
    list.extend(races.psi.iter().enumerate().map(|(n, psi)| Circle {
        body: Body::Planet(n),
        centre: polar(a, *psi),
        axes: *psi,
        radius: radius_of_planets,
        arm: arm_planet,
        hand: *psi,
        hand_from: 0.0,
        colour: "#1b6ca8",
    }));
    list
}

/// Translation along a body's axes (m) and rotation (rad) of a shape.
fn motion(of: &ModalTest<'_>, circle: &Circle, mode: &FeMode) -> ([f64; 2], f64) {
    let [first, second, u] = of.races.places(circle.body).map(|i| i.map_or(0.0, |i| mode.shape[i]));
    ([first, second], u / circle.arm)
}

/// One panel about its middle.
fn shape(
    canvas: &mut Canvas,
    of: &ModalTest<'_>,
    circles: &[Circle],
    mode: &FeMode,
    middle: Pixel,
) {
    let outer =
        circles.iter().fold(0.0f64, |r, c| r.max(c.radius + c.centre[0].hypot(c.centre[1])));
    let view = View { middle, to_pixels: 0.42 * SIDE / outer };
    let size = |c: &Circle| {
        let ([x, y], theta) = motion(of, c, mode);
        x.hypot(y).max(c.radius * theta.abs())
    };
    let largest = circles.iter().map(size).fold(f64::MIN_POSITIVE, f64::max);
    let sun = circles.iter().find(|c| c.body == Body::Sun).map_or(0.2 * outer, |c| c.radius);
    let scale = SCALE * sun / largest;
    for circle in circles {
        view.draw(canvas, circle, circle.centre, circle.hand, AT_REST);
    }
    for circle in circles {
        let ([x, y], theta) = motion(of, circle, mode);
        let (sin, cos) = circle.axes.sin_cos();
        let shift = [cos * x - sin * y, sin * x + cos * y].map(|s| scale * s);
        let at = [circle.centre[0] + shift[0], circle.centre[1] + shift[1]];
        let pen = Pen::new(circle.colour, 2.0);
        view.draw(canvas, circle, at, circle.hand + scale * theta, pen);
    }
}

/// Transformation from metres to pixels.
struct View {
    /// Place of the set's centre.
    middle: Pixel,
    /// Pixels in a metre.
    to_pixels: f64,
}

impl View {
    /// A circle and its hand, y upwards.
    fn draw(&self, canvas: &mut Canvas, circle: &Circle, centre: [f64; 2], hand: f64, pen: Pen) {
        let pixel = |[x, y]: [f64; 2]| {
            [self.middle[0] + x * self.to_pixels, self.middle[1] - y * self.to_pixels]
        };
        canvas.ring(pixel(centre), self.to_pixels * circle.radius, pen);
        let along = |radius: f64| {
            let [a, b] = polar(radius, hand);
            pixel([centre[0] + a, centre[1] + b])
        };
        canvas.line([along(circle.hand_from * circle.radius), along(circle.radius)], pen);
    }
}
