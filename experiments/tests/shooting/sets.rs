//! Sets that tests of shooting share, and their cycles.

use experiments::sweep::{FeModel, Marching};
use fe_contact::statics::{Bodies, Imperfections};
use scene::{Fidelity, LoadCase, Scene};

pub(super) fn scene(name: &str, fidelity: Fidelity, steps: u32) -> Scene {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    scene.fe_contact.flank_elements = 6;
    scene.dynamics.steps_per_cycle = steps;
    scene.dynamics.fidelity = fidelity;
    scene
}

pub(super) fn fe<'b>(scene: &Scene, bodies: &'b Bodies, torque_nm: f64) -> FeModel<'b> {
    let case = LoadCase::of_scene(scene).unwrap().with_sun_torque(torque_nm);
    FeModel::new(scene, bodies, Imperfections::default(), case)
}

/// The same scene with its speed in the other sense: under the same torque on the sun its meshes run backward.
pub(super) fn backward(mut scene: Scene) -> Scene {
    scene.operation.as_mut().unwrap().speed_rpm *= -1.0;
    scene
}

/// Marches a cycle with every step kept, and takes it back.
pub(super) fn march_cycle(set: &mut dyn Marching, steps: usize) {
    set.derivative().unwrap().start();
    for _ in 0..steps {
        set.step().unwrap();
        set.derivative().unwrap().keep_step();
    }
    set.derivative().unwrap().end().unwrap();
}

/// Coordinates at the end of a cycle from those at its start.
pub(super) fn end_of_cycle(set: &mut dyn Marching, start: &[f64], steps: usize) -> Vec<f64> {
    set.derivative().unwrap().set_coordinates(start).unwrap();
    march_cycle(set, steps);
    set.derivative().unwrap().coordinates()
}
