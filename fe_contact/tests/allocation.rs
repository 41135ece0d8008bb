//! A time step allocates no memory once its contact maps exist.

use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::{
    Loading, MeshLawSet, MeshLawSettings, NominalRotation, VibratingSet, mesh_law,
};
use gearset::{Facing, PathDirection};
use scene::{Fidelity, Scene};

#[test]
fn a_warm_step_allocates_nothing() {
    for fidelity in [Fidelity::QuasiStatic, Fidelity::Modal(2)] {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let mut scene = Scene::from_file(path.as_ref()).unwrap();
        scene.fe_contact.flank_elements = 8;
        scene.dynamics.fidelity = fidelity;
        let bodies = Bodies::new(&scene).unwrap();
        let rotation = NominalRotation::Turning {
            mesh_frequency: 500.0,
            steps_per_cycle: 28,
            direction: PathDirection::Forward,
        };
        let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
        let loading = Loading { torque_nm: 1130.0, mesh_force: 8000.0 };
        let mut set = VibratingSet::new(&scene, &bodies, sense, none, rotation, loading).unwrap();
        set.rest(1130.0).unwrap();
        let cold = allocation_counter::measure(|| set.step().unwrap());
        assert!(cold.count_total > 0, "the first step builds its maps");
        for _ in 0..150 * 28 {
            set.step().unwrap();
        }
        let warm = allocation_counter::measure(|| {
            for _ in 0..10 * 28 {
                set.step().unwrap();
            }
        });
        assert_eq!(warm.count_total, 0, "{fidelity:?}");
    }
}

#[test]
fn a_step_on_tabulated_forces_never_allocates() {
    let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    scene.fe_contact.flank_elements = 8;
    let bodies = Bodies::new(&scene).unwrap();
    let sense = Facing::CounterClockwise;
    let settings = MeshLawSettings { nodes: 16, ..MeshLawSettings::at(1130.0) };
    let law = mesh_law(&scene, &bodies, sense, 28, &settings).unwrap();
    let mut set = MeshLawSet::new(&scene, &bodies, sense, 500.0, 1130.0, law).unwrap();
    set.rest(1130.0).unwrap();
    let made = allocation_counter::measure(|| (0..280).for_each(|_| set.step().unwrap()));
    assert_eq!(made.count_total, 0);
}
