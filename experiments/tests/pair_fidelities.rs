//! A gear pair in time at the fidelities with bodies that vibrate within themselves.

use crate::amplitudes;

use amplitudes::{off, rotation};
use experiments::sweep::{FeModel, SteadyMethod, SteadySettings, SweepModel, SweepPoint, steady};
use fe_contact::statics::{Bodies, Imperfections};
use scene::{Fidelity, LoadCase, Scene};

/// The catalogue pair on a coarse mesh with the driven gear on a torsional spring and more damping.
fn sprung(fidelity: Fidelity, steps: u32, damping_factor: f64) -> Scene {
    let text = format!(
        "{}\n[planet]\ntorsional_nm_per_rad = 2e5\n",
        include_str!("../../scenes/pair_50_50.toml")
    );
    let mut scene = Scene::from_toml(&text).unwrap();
    scene.fe_contact.flank_elements = 6;
    scene.dynamics.steps_per_cycle = steps;
    scene.dynamics.fidelity = fidelity;
    scene.damping.mass_proportional_per_s *= damping_factor;
    scene.damping.stiffness_proportional_s *= damping_factor;
    scene
}

/// The steady state at a speed.
fn at(scene: &Scene, bodies: &Bodies, rpm: f64, settings: &SteadySettings) -> SweepPoint {
    let case = LoadCase::of_scene(scene).unwrap().at_speed(rpm);
    let model = FeModel::new(scene, bodies, Imperfections::default(), case);
    let mut set = model.turning(&case, 0).unwrap();
    set.rest().unwrap();
    let steps = model.steps_per_cycle();
    let found =
        steady(set.as_mut(), model.shape(), model.first_planet_rad(), steps, settings).unwrap();
    SweepPoint::new(case, &found, settings, 0).unwrap()
}

/// The pair with two modes of each gear: shooting finds what marching finds.
#[test]
#[ignore = "long: .ci/full runs it"]
fn shooting_and_marching_agree_on_a_pair_with_modes() {
    let shooting = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
    let marching =
        SteadySettings { method: SteadyMethod::Marching, tolerance: 1e-10, ..shooting.clone() };
    let scene = sprung(Fidelity::Modal(2), 60, 6.0);
    let bodies = Bodies::new(&scene).unwrap();
    for rpm in [600.0, 1500.0, 2400.0] {
        let [shot, marched] =
            [&shooting, &marching].map(|settings| at(&scene, &bodies, rpm, settings));
        assert_eq!(shot.method, SteadyMethod::Shooting, "{rpm} rpm: {:?}", shot.why_marched);
        assert!(shot.largest_multiplier().unwrap() < 1.0);
        let off = off(&rotation(&marched.state), &rotation(&shot.state));
        assert!(off < 1e-6, "{rpm} rpm: {off:e}");
    }
}

/// With every degree of freedom of the gears: quasi-static gears lack the inertia of their own deflection, and modes of
/// each gear leave at most a third of that error. Damped so much, with so few steps, that the march is short; with the
/// damping of the other test and 60 steps six modes left a fiftieth of it at 600 rpm and a thirtieth at 1500 rpm, in
/// four minutes each.
#[test]
#[ignore = "long: .ci/full runs it"]
fn modes_bring_a_pair_near_to_full_bodies() {
    let marching = SteadySettings {
        method: SteadyMethod::Marching,
        tolerance: 1e-4,
        most_cycles: 40,
        between_cycles: 0,
        ..SteadySettings::default()
    };
    let bodies = Bodies::new(&sprung(Fidelity::QuasiStatic, 20, 40.0)).unwrap();
    let of = |fidelity| {
        let scene = sprung(fidelity, 20, 40.0);
        let point = at(&scene, &bodies, 900.0, &marching);
        println!("{fidelity:?}: {} cycles, change {:e}", point.cycles, point.residual);
        rotation(&point.state)
    };
    let full = of(Fidelity::Full);
    let [rigid, modal] =
        [Fidelity::QuasiStatic, Fidelity::Modal(6)].map(|own| off(&full, &of(own)));
    println!("off full bodies: quasi-static {rigid:e}, six modes {modal:e}");
    assert!(rigid > 3e-3 && modal < rigid / 3.0, "{rigid:e} {modal:e}");
}
