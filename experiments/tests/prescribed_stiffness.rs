//! The lumped model with prescribed mesh stiffness: a linear model as long as teeth touch, and at rest the tabulated
//! one.

use crate::shipped;

use experiments::sweep::{MeshLawModel, SteadySettings, SweepModel, steady};
use fe_contact::statics::Bodies;
use fe_contact::vibration::{MeshLawSettings, mesh_law};
use gearset::MeshLaw;
use scene::LoadCase;

/// Rotation of the sun over the steps of a steady mesh cycle, rad, and the lowest mesh force, N.
fn motion(model: &MeshLawModel<'_>, case: &LoadCase) -> (Vec<f64>, f64) {
    let mut set = model.turning(case, 0).unwrap();
    set.rest().unwrap();
    let settings = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
    let (steps, first) = (model.steps_per_cycle(), model.first_planet_rad());
    let found = steady(set.as_mut(), model.shape(), first, steps, &settings).unwrap();
    let meshes = model.shape().meshes();
    let forces = (0..meshes).flat_map(|mesh| found.record.mesh_force(mesh));
    let lowest = forces.fold(f64::INFINITY, f64::min);
    (found.record.channel(8), lowest)
}

fn mean_and_range(samples: &[f64]) -> (f64, f64) {
    let ends = samples
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)]);
    (samples.iter().sum::<f64>() / samples.len() as f64, ends[1] - ends[0])
}

/// With one law, twice the torque gives twice the motion, to the tolerance of steady states: there is no excitation but
/// the torque on a stiffness that changes. Of tabulated forces it does not (teeth in contact all the time, both).
///
/// Slowly turned, every mesh carries nearly its even share, under which both laws deflect alike: mean transmission
/// errors agree to second order: load sharing swings by some 3 %, the tangent differs from the secant by a tenth, and
/// the meshes have a twentieth of the deflection, which makes 1.5e-4.
#[test]
fn it_is_linear_and_deflects_at_rest_as_the_tabulated_one() {
    let scene = shipped::scene("oh58_4p", 140, 1.0);
    let bodies = Bodies::new(&scene).unwrap();
    let case = LoadCase::of_scene(&scene).unwrap();
    let settings = MeshLawSettings::at(case.sun_load_nm());
    let law = mesh_law(&scene, &bodies, case.sense(), 140, &settings).unwrap();
    let prescribed = |law: &MeshLaw, model: &MeshLawModel<'_>| {
        let own = model.lumped_prescribed(false).unwrap();
        let sun = bodies.geometry.sun.as_ref().unwrap().base_radius;
        let share = case.sun_load_nm() / sun / scene.planets.psi_rad.len() as f64;
        (own, law.with_prescribed_stiffness(share).unwrap().without_side_loads())
    };
    let model = MeshLawModel::new(&scene, &bodies, case).unwrap();
    let (own, by_hand) = prescribed(&law, &model);
    let half = case.with_sun_torque(0.5 * case.sun_torque_nm);
    let at = |case: LoadCase, law: &MeshLaw| MeshLawModel::lumped_with(&scene, case, law.clone());

    let rpm = 1500.0;
    let (whole, lowest) = motion(&own, &case.at_speed(rpm));
    assert!(lowest > 0.0);
    assert_eq!(whole, motion(&at(case, &by_hand), &case.at_speed(rpm)).0);
    let (of_half, _) = motion(&at(half, &by_hand), &half.at_speed(rpm));
    let (_, range) = mean_and_range(&whole);
    let off = |a: &[f64], b: &[f64]| {
        a.iter().zip(b).map(|(a, b)| (a - 2.0 * b).abs()).fold(0.0, f64::max) / range
    };
    assert!(off(&whole, &of_half) < 1e-7, "{:e}", off(&whole, &of_half));
    let tabulated = [case, half].map(|case| motion(&at(case, &law), &case.at_speed(rpm)).0);
    assert!(off(&tabulated[0], &tabulated[1]) > 0.05, "{:e}", off(&tabulated[0], &tabulated[1]));

    let [(slow, _), (slow_tabulated, _)] =
        [&own, &at(case, &law)].map(|model| motion(model, &case.at_speed(40.0)));
    let [(mean, range), (tabulated, range_tabulated)] =
        [slow, slow_tabulated].map(|samples| mean_and_range(&samples));
    println!("mean {mean:e} beside {tabulated:e}, range {range:e} beside {range_tabulated:e}");
    assert!((mean / tabulated - 1.0).abs() < 2e-4, "{mean:e} {tabulated:e}");
}
