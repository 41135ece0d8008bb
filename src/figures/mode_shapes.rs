//! Mode shapes as pictures: bodies at rest and displaced.

use std::f64::consts::FRAC_PI_2;

use experiments::modal::FeMode;
use fe_contact::fe_mesh::polar;
use gearset::{Body, MeshKind, MeshMember};

use super::ModalTest;
use super::drawing::{Anchor, Canvas, Pen, Picture, Pixel, Symbol, Type};

/// Side of a panel and height of its title, px.
const SIDE: f64 = 300.0;
const HEAD: f64 = 26.0;

const AT_REST: Pen = Pen::new("#c4c8cc", 0.8);

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
    let title = format!("{}: modes from the impulse test, thin lines at rest", of.scene.title);
    let size = [SIDE, SIDE + HEAD];
    let (mut canvas, corners) = Canvas::cells([&title, ""], &[], 4, of.test.modes.len(), size);
    for (mode, [x, y]) in of.test.modes.iter().zip(corners) {
        let middle = x + 0.5 * SIDE;
        let label = format!("{:.1} Hz, {}", mode.frequency_hz, mode.mode_type.name());
        canvas.text([middle, y + 18.0], Type::new(14, Anchor::Middle), label);
        shape(&mut canvas, of, &circles, mode, [middle, y + HEAD + 0.5 * SIDE]);
    }
    canvas.picture()
}

/// Operating pitch circles of the gears and, for the carrier, the circle through its pin seats.
fn circles(of: &ModalTest<'_>) -> Vec<Circle> {
    let (geometry, races) = (of.geometry, of.races);
    let pitch = |kind, member| Some(geometry.mesh(kind)?.pitch_radius(member));
    let sun = pitch(MeshKind::SunPlanet, MeshMember::Driver);
    let ring = pitch(MeshKind::RingPlanet, MeshMember::Driven);
    let planet = pitch(MeshKind::SunPlanet, MeshMember::Driven);
    let planet = planet.unwrap_or(geometry.planet.base_radius);
    let carrier = (!races.is_pair()).then_some(geometry.center_distance);
    let bodies = [
        (Body::Carrier, carrier, "#8a949c"),
        (Body::Ring, ring, "#5a6570"),
        (Body::Sun, sun, "#b8860b"),
    ];
    let central =
        bodies.into_iter().zip(races.radii).filter_map(|((body, radius, colour), arm)| {
            // Lines of the large circles would cross the others.
            let hand_from = if body == Body::Sun { 0.0 } else { 0.8 };
            let (centre, axes, hand) = ([0.0; 2], 0.0, FRAC_PI_2);
            Some(Circle { body, centre, axes, radius: radius?, arm, hand, hand_from, colour })
        });
    let planets = races.psi.iter().enumerate().map(|(n, psi)| Circle {
        body: Body::Planet(n),
        centre: polar(geometry.center_distance, *psi),
        axes: *psi,
        radius: planet,
        arm: races.radii[3],
        hand: *psi,
        hand_from: 0.0,
        colour: "#1b6ca8",
    });
    central.chain(planets).collect()
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
    let reach = |c: &Circle| c.radius + c.centre[0].hypot(c.centre[1]);
    let outer = circles.iter().map(reach).fold(0.0, f64::max);
    let to_pixels = 0.42 * SIDE / outer;
    let size = |c: &Circle| {
        let ([x, y], theta) = motion(of, c, mode);
        x.hypot(y).max(c.radius * theta.abs())
    };
    let largest = circles.iter().map(size).fold(f64::MIN_POSITIVE, f64::max);
    let sun = circles.iter().find(|c| c.body == Body::Sun).map_or(0.2 * outer, |c| c.radius);
    let scale = SCALE * sun / largest;
    // y upwards
    let pixel = |[x, y]: [f64; 2]| [middle[0] + x * to_pixels, middle[1] - y * to_pixels];
    let mut draw = |circle: &Circle, [x, y]: [f64; 2], hand: f64, pen: Pen| {
        let along = |radius: f64| {
            let [a, b] = polar(radius, hand);
            pixel([x + a, y + b])
        };
        canvas.symbol(pixel([x, y]), Symbol::Ring(to_pixels * circle.radius, pen));
        canvas.line([along(circle.hand_from * circle.radius), along(circle.radius)], pen);
    };
    for circle in circles {
        draw(circle, circle.centre, circle.hand, AT_REST);
    }
    for circle in circles {
        let ([x, y], theta) = motion(of, circle, mode);
        let (sin, cos) = circle.axes.sin_cos();
        let shift = [cos * x - sin * y, sin * x + cos * y].map(|s| scale * s);
        let at = [circle.centre[0] + shift[0], circle.centre[1] + shift[1]];
        draw(circle, at, circle.hand + scale * theta, Pen::new(circle.colour, 2.0));
    }
}
