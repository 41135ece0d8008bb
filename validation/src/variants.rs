//! Variants of scenes that suites ask about. Results find a scene by its title, so that titles are made here alone.

use scene::Scene;

/// Order in which [`renumbered`] lists four planets: planet 0 stays first.
pub const RENUMBERED: [usize; 4] = [0, 2, 3, 1];

/// The set seen in a mirror along the axis of planet 0: angles of planets change sign. A counter-clockwise torque
/// becomes a clockwise one.
pub fn mirrored(scene: &Scene) -> Scene {
    let mut mirrored = scene.variant("seen in a mirror");
    mirrored.planets.psi_rad.iter_mut().for_each(|psi| *psi = -*psi);
    if let Some(steps) = &mut mirrored.planets.steps {
        steps.iter_mut().for_each(|step| *step = -*step);
    }
    mirrored
}

/// The set with its planets listed in the order [`RENUMBERED`]; of other than four planets, in the order that they
/// have.
pub fn renumbered(scene: &Scene) -> Scene {
    let mut renumbered = scene.variant("planets renumbered");
    if scene.planets.count() == RENUMBERED.len() {
        let planets = &scene.planets;
        renumbered.planets.psi_rad = RENUMBERED.map(|n| planets.psi_rad[n]).to_vec();
        renumbered.planets.steps =
            planets.steps.as_ref().map(|steps| RENUMBERED.map(|n| steps[n]).to_vec());
    }
    renumbered
}
