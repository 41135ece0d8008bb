//! Sweeps of quasi-static bodies tell where the inertia that they lack matters.

use experiments::sweep::{Direction, FeModel, InertiaError, Memory, Plan, SteadySettings, run};
use fe_contact::statics::{Bodies, Imperfections};
use scene::{LoadCase, Scene};

fn error_at(name: &str, change: impl Fn(&mut Scene), rpm: f64) -> Option<InertiaError> {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    change(&mut scene);
    let case = LoadCase::of_scene(&scene).unwrap();
    let bodies = Bodies::new(&scene).unwrap();
    let model = FeModel::new(&scene, &bodies, Imperfections::default(), case);
    let steady = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
    let plan = Plan::new(&[rpm], &[Direction::Up], steady).unwrap();
    let sweep = run(&model, &plan, &Memory, &|_| ()).unwrap();
    sweep.points()[0].inertia_error
}

/// OH-58 at moderate speed has stiff bodies; a carrier three times as wide as its bore has its first mode below the
/// strong harmonics of fast rotation.
#[test]
fn a_slender_carrier_is_told_and_stiff_bodies_are_not() {
    assert_eq!(error_at("oh58_4p", |_| (), 1500.0), None);
    let slender = |scene: &mut Scene| {
        let carrier = scene.geometry.as_mut().unwrap().carrier.as_mut().unwrap();
        carrier.bore_radius_m = carrier.outer_radius_m / 2.9;
        scene.damping = scene.damping.times(2.0);
    };
    let told = error_at("oh58_4p", slender, 8000.0).unwrap();
    assert!(told.share.is_none_or(|share| share > 0.05), "{told:?}");
}
