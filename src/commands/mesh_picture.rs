//! The meshes of a scene set together.

use fe_contact::body::CarrierBody;
use fe_contact::contact::PairFrame;
use fe_contact::export::{Drawn, Placed, picture};
use fe_contact::mesh::polar;
use fe_contact::statics::Bodies;
use gearset::{Facing, MeshMember, Phasing, Scene};

const SUN: &str = "#b8860b";
const PLANET: &str = "#1b6ca8";
const RING: &str = "#5a6570";
const CARRIER: &str = "#b9c4cc";

/// SVG of all bodies in mesh.
pub(super) fn assembled(scene: &Scene, bodies: &Bodies, carrier: Option<&CarrierBody>) -> String {
    let drawn = |body: &fe_contact::body::GearBody| Drawn::gear(&body.mesh);
    let (sun, planet, ring) =
        (bodies.sun.as_ref().map(drawn), drawn(&bodies.planet), bodies.ring.as_ref().map(drawn));
    let carrier = carrier.map(|body| Drawn::carrier(&body.mesh));
    let centre = |psi: f64| polar(bodies.geometry.center_distance, psi);
    let origin = [0.0, 0.0];
    let mut placed = Vec::new();
    // Behind everything else.
    if let Some(drawn) = &carrier {
        placed.push(Placed { drawn, centre: origin, angle: 0.0, colour: CARRIER });
    }
    let [sun_angle, ring_angle, planet_angles] = angles(scene, bodies);
    if let Some(drawn) = &ring {
        placed.push(Placed { drawn, centre: origin, angle: ring_angle[0], colour: RING });
    }
    for (psi, angle) in scene.planets.psi_rad.iter().zip(planet_angles) {
        placed.push(Placed { drawn: &planet, centre: centre(*psi), angle, colour: PLANET });
    }
    if let Some(drawn) = &sun {
        placed.push(Placed { drawn, centre: origin, angle: sun_angle[0], colour: SUN });
    }
    picture(&placed, &scene.title)
}

/// Angles of the teeth 0: sun, ring (a tooth, half a pitch from its space), planets.
fn angles(scene: &Scene, bodies: &Bodies) -> [Vec<f64>; 3] {
    let geometry = &bodies.geometry;
    if let Some(phasing) = Phasing::new(geometry, &scene.planets).filter(|_| scene.pair.is_none()) {
        let found = phasing.gear_angles(0.0, Facing::CounterClockwise);
        let half = geometry.ring.as_ref().map_or(0.0, |ring| 0.5 * ring.pitch_angle());
        return [vec![found.sun], vec![found.ring + half], found.planets];
    }
    let frame = scene.pair.and_then(|kind| geometry.mesh(kind));
    let frame = frame.and_then(|mesh| Some((mesh, PairFrame::new(mesh, 0.3, 0)?)));
    let Some((mesh, frame)) = frame else { return [vec![0.0], vec![0.0], vec![0.0]] };
    let [driver, driven] =
        [MeshMember::Driver, MeshMember::Driven].map(|member| frame.tooth(member).axis);
    match mesh.kind {
        gearset::MeshKind::SunPlanet => [vec![driver], vec![0.0], vec![driven]],
        gearset::MeshKind::RingPlanet => [vec![0.0], vec![driven], vec![driver]],
    }
}
