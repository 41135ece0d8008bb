//! Shipped scenes as tests use them: finite elements coarse enough to be quick, steps and damping as asked.

use scene::Scene;

/// A scene of the catalogue with 8 elements along a flank, `steps` in a mesh cycle,
/// and the damping of bodies and teeth times a factor; that of bearings stays.
pub(crate) fn scene(name: &str, steps: u32, damping: f64) -> Scene {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    scene.fe_contact.flank_elements = 8;
    scene.dynamics.steps_per_cycle = steps;
    scene.damping.mass_proportional_per_s *= damping;
    scene.damping.stiffness_proportional_s *= damping;
    scene
}
