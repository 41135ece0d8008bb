//! The finite-element meshes of a scene, assembled.

use std::collections::HashSet;

use fe_contact::body::{CarrierBody, GearBody};
use fe_contact::contact::PairFrame;
use fe_contact::export::Drawn;
use fe_contact::fe_mesh::polar;
use fe_contact::statics::Bodies;
use gearset::{Facing, GearAngles, MeshKind, MeshMember, Phasing};
use scene::Scene;

use super::drawing::{Canvas, Pen, Picture, Pixel};

/// Width of the picture and of its lines, px.
const WIDTH: f64 = 1000.0;
const LINE: f64 = 0.4;

/// A mesh with its position.
struct Placed<'d> {
    drawn: &'d Drawn,
    /// Centre, m.
    centre: [f64; 2],
    /// Angle of tooth 0's axis, rad.
    angle: f64,
    colour: &'static str,
}

/// The meshes of all bodies, each turned and placed as it meshes; the carrier if its shape is known.
pub fn meshes(scene: &Scene, bodies: &Bodies, carrier: Option<&CarrierBody>) -> Picture {
    let drawn = |body: &GearBody| Drawn::gear(&body.mesh);
    let (sun, planet, ring) =
        (bodies.sun.as_ref().map(drawn), drawn(&bodies.planet), bodies.ring.as_ref().map(drawn));
    let carrier = carrier.map(|body| Drawn::carrier(&body.mesh));
    let angles = angles(scene, bodies);
    let central = |drawn, angle, colour| Placed { drawn, centre: [0.0; 2], angle, colour };
    // Behind everything else.
    let mut placed: Vec<Placed<'_>> =
        carrier.iter().map(|drawn| central(drawn, 0.0, "#b9c4cc")).collect();
    placed.extend(ring.iter().map(|drawn| central(drawn, angles.ring, "#5a6570")));
    placed.extend(scene.planets.psi_rad.iter().zip(angles.planets).map(|(psi, angle)| Placed {
        drawn: &planet,
        centre: polar(bodies.geometry.center_distance, *psi),
        angle,
        colour: "#1b6ca8",
    }));
    placed.extend(sun.iter().map(|drawn| central(drawn, angles.sun, "#b8860b")));
    picture(&placed)
}

/// Every element edge once, as the parabola through its mid-side node.
fn picture(bodies: &[Placed<'_>]) -> Picture {
    let lists: Vec<Vec<[[f64; 2]; 3]>> = bodies.iter().map(edges).collect();
    let mut reach = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for [p, _, q] in lists.iter().flatten() {
        for k in [0, 1] {
            reach[0][k] = reach[0][k].min(p[k]).min(q[k]);
            reach[1][k] = reach[1][k].max(p[k]).max(q[k]);
        }
    }
    let margin = 0.02 * (reach[1][0] - reach[0][0]);
    let size = [0, 1].map(|k| reach[1][k] - reach[0][k] + 2.0 * margin);
    let to_pixels = WIDTH / size[0];
    // y downwards
    let pixel = |[x, y]: [f64; 2]| {
        [to_pixels * (x - reach[0][0] + margin), to_pixels * (reach[1][1] + margin - y)]
    };
    let mut canvas = Canvas::new([WIDTH, to_pixels * size[1]]);
    for (body, list) in bodies.iter().zip(lists) {
        let curves: Vec<[Pixel; 3]> = list.into_iter().map(|edge| edge.map(pixel)).collect();
        canvas.parabolas(&curves, Pen::new(body.colour, LINE));
    }
    canvas.picture()
}

/// Ends of a body's element edges with the control points between them, m.
fn edges(body: &Placed<'_>) -> Vec<[[f64; 2]; 3]> {
    let (sin, cos) = body.angle.sin_cos();
    let at = |n: usize| {
        let [x, y] = body.drawn.points[n];
        [body.centre[0] + cos * x - sin * y, body.centre[1] + sin * x + cos * y]
    };
    let (mut seen, mut list) = (HashSet::new(), Vec::new());
    for e in &body.drawn.elements {
        for edge in 0..4 {
            let (a, b) = (e.nodes[edge], e.nodes[(edge + 1) % 4]);
            if seen.insert((a.min(b), a.max(b))) {
                let [p, m, q] = [a, e.nodes[4 + edge], b].map(at);
                // A parabola through the middle: control point 2m − (p + q)/2.
                list.push([p, [0, 1].map(|k| 2.0 * m[k] - 0.5 * (p[k] + q[k])), q]);
            }
        }
    }
    list
}

/// Angles of tooth 0 of the gears in mesh, that of the ring half a pitch from its tooth space 0.
fn angles(scene: &Scene, bodies: &Bodies) -> GearAngles {
    let geometry = &bodies.geometry;
    if let Some(phasing) = Phasing::new(geometry, &scene.planets).filter(|_| scene.pair.is_none()) {
        let mut found = phasing.gear_angles(0.0, Facing::CounterClockwise);
        found.ring += geometry.ring.as_ref().map_or(0.0, |ring| 0.5 * ring.pitch_angle());
        return found;
    }
    let mesh = scene.pair.and_then(|kind| geometry.mesh(kind));
    let frame = mesh.and_then(|mesh| PairFrame::new(mesh, 0.3, 0));
    let [driver, driven] = [MeshMember::Driver, MeshMember::Driven]
        .map(|member| frame.as_ref().map_or(0.0, |frame| frame.tooth(member).axis));
    match scene.pair {
        Some(MeshKind::RingPlanet) => GearAngles { sun: 0.0, ring: driven, planets: vec![driver] },
        _ => GearAngles { sun: driver, ring: 0.0, planets: vec![driven] },
    }
}
