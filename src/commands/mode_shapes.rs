//! Mode shapes as pictures: bodies at rest and displaced.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write as _;

use experiments::modal::FeMode;
use fe_contact::mesh::polar;
use fe_contact::statics::{CARRIER, PLANETS, RING, SUN};

use super::impulse::Found;

/// Side of a panel, px, and panels beside each other.
const SIDE: f64 = 300.0;
const COLUMNS: usize = 4;

/// Height of a panel's title, px.
const HEAD: f64 = 26.0;

/// Largest displacement drawn over the sun's radius.
const SCALE: f64 = 0.35;

/// A body's circle.
struct Circle {
    body: usize,
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

/// SVG with a panel for each identified mode.
pub(super) fn picture(found: &Found) -> String {
    let circles = circles(found);
    let modes = &found.test.modes;
    let columns = COLUMNS.min(modes.len().max(1));
    let rows = modes.len().div_ceil(columns).max(1);
    let (width, height) = (SIDE * columns as f64, 40.0 + (SIDE + HEAD) * rows as f64);
    let mut panels = String::new();
    for (i, mode) in modes.iter().enumerate() {
        let x = SIDE * ((i % columns) as f64 + 0.5);
        let y = 40.0 + (SIDE + HEAD) * (i / columns) as f64;
        let (name, f) = (mode.mode_type.name(), mode.frequency_hz);
        // Writing to a string cannot fail.
        let _ = writeln!(
            panels,
            "<text x=\"{x}\" y=\"{:.0}\" font-size=\"14\">{f:.1} Hz, {name}</text>",
            y + 18.0
        );
        let _ = writeln!(
            panels,
            "<g transform=\"translate({x} {:.0})\" fill=\"none\">\n{}</g>",
            y + HEAD + 0.5 * SIDE,
            shape(found, &circles, mode)
        );
    }
    let title = found.scene.title.replace('&', "&amp;").replace('<', "&lt;");
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" font-family=\"sans-serif\" text-anchor=\"middle\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n<text x=\"{}\" y=\"26\" font-size=\"16\">{title}: modes from the impulse test, thin lines at rest</text>\n{panels}</svg>\n",
        0.5 * width
    )
}

/// Operating pitch circles of the gears, the carrier through its seats.
fn circles(found: &Found) -> Vec<Circle> {
    let (geometry, races) = (&found.bodies.geometry, &found.races);
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
        hand_from: if body == SUN { 0.0 } else { 0.8 },
        colour,
    };
    let mut list = vec![central(CARRIER, a, arm_carrier, "#8a949c")];
    if let Some(ring) = &geometry.ring {
        let radius = a * teeth(ring) / (teeth(ring) - planet);
        list.push(central(RING, radius, arm_ring, "#5a6570"));
    }
    let mut radius_of_planets = geometry.planet.base_radius;
    if let Some(sun) = &geometry.sun {
        radius_of_planets = a * planet / (teeth(sun) + planet);
        list.push(central(SUN, a - radius_of_planets, arm_sun, "#b8860b"));
    }
    list.extend(races.psi.iter().enumerate().map(|(n, psi)| Circle {
        body: PLANETS + n,
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
fn motion(found: &Found, circle: &Circle, mode: &FeMode) -> ([f64; 2], f64) {
    let of = |axis| found.races.of(circle.body, axis).map_or(0.0, |i| mode.shape[i]);
    ([of(0), of(1)], of(2) / circle.arm)
}

/// One panel about its middle.
fn shape(found: &Found, circles: &[Circle], mode: &FeMode) -> String {
    let outer =
        circles.iter().fold(0.0f64, |r, c| r.max(c.radius + c.centre[0].hypot(c.centre[1])));
    let to_pixels = 0.42 * SIDE / outer;
    let size = |c: &Circle| {
        let ([x, y], theta) = motion(found, c, mode);
        x.hypot(y).max(c.radius * theta.abs())
    };
    let largest = circles.iter().map(size).fold(f64::MIN_POSITIVE, f64::max);
    let sun = circles.iter().find(|c| c.body == SUN).map_or(0.2 * outer, |c| c.radius);
    let scale = SCALE * sun / largest;
    let (mut rest, mut moved) = (String::new(), String::new());
    for circle in circles {
        let ([x, y], theta) = motion(found, circle, mode);
        let (sin, cos) = circle.axes.sin_cos();
        let shift = [cos * x - sin * y, sin * x + cos * y].map(|s| scale * s);
        let at = [circle.centre[0] + shift[0], circle.centre[1] + shift[1]];
        let colour = circle.colour;
        let hand = circle.hand;
        drawn(&mut rest, circle, circle.centre, hand, to_pixels, "#c4c8cc", 0.8);
        drawn(&mut moved, circle, at, hand + scale * theta, to_pixels, colour, 2.0);
    }
    rest + &moved
}

/// A circle and its hand, in pixels, y upwards.
fn drawn(
    text: &mut String,
    circle: &Circle,
    centre: [f64; 2],
    hand: f64,
    to_pixels: f64,
    colour: &str,
    width: f64,
) {
    let pixels = |[x, y]: [f64; 2]| [x * to_pixels, -y * to_pixels];
    let [x, y] = pixels(centre);
    let along = |radius: f64| {
        let [a, b] = polar(radius, hand);
        pixels([centre[0] + a, centre[1] + b])
    };
    let [ax, ay] = along(circle.hand_from * circle.radius);
    let [bx, by] = along(circle.radius);
    let r = to_pixels * circle.radius;
    let _ = writeln!(
        text,
        "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{r:.2}\" stroke=\"{colour}\" stroke-width=\"{width}\"/><path d=\"M{ax:.2} {ay:.2}L{bx:.2} {by:.2}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
    );
}
