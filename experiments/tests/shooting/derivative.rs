//! The derivative of a cycle: against differences, along fewer coordinates, and in single precision.

use dynamics::{MapDerivative, multipliers};
use experiments::sweep::{Marching, MeshLawModel, Record, SweepModel};
use fe_contact::statics::Bodies;
use fe_contact::vibration::Along;
use nalgebra::DMatrix;
use scene::{Fidelity, LoadCase};

use super::apart;
use super::sets::{backward, end_of_cycle, fe, march_cycle, scene};

/// A cycle in the middle of which a step failed is begun anew by setting coordinates or a state: the same cycle
/// follows, but for the rounding of contact patterns that were met in between.
#[test]
fn a_cycle_that_fails_leaves_nothing_behind() {
    let steps = 28;
    for fidelity in [Fidelity::QuasiStatic, Fidelity::Modal(4)] {
        let scene = scene("oh58_4p", fidelity, steps as u32);
        let bodies = Bodies::new(&scene).unwrap();
        let model = fe(&scene, &bodies, 1130.0);
        let mut set = model.turning(&model.case().at_speed(1500.0), 0).unwrap();
        set.rest().unwrap();
        march_cycle(set.as_mut(), steps);
        let (start, state) = (set.derivative().unwrap().coordinates(), set.state());
        let end = end_of_cycle(set.as_mut(), &start, steps);
        // Away from the motion by more and more, until a mesh gives way beyond its tables in the middle of the cycle.
        let fail = |set: &mut dyn Marching| {
            (0..60).any(|k| {
                let factor = 2f64.powf(0.5 * f64::from(k));
                let away = |(a, b): (&f64, &f64)| a + factor * (b - a);
                let wild: Vec<f64> = start.iter().zip(&end).map(away).collect();
                set.derivative().unwrap().set_coordinates(&wild).unwrap();
                let failed = (0..steps).find(|_| set.step().is_err());
                if failed.is_none() {
                    set.derivative().unwrap().end().unwrap();
                }
                failed.is_some_and(|step| step > 0)
            })
        };
        let displaced = |set: &dyn Marching, y: &[f64]| -> Vec<f64> {
            let (central, planets) = set.displacements_of(y);
            central.iter().chain(&planets).flatten().copied().collect()
        };
        let expected = displaced(set.as_ref(), &end);
        let size = expected.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        let is_same = |set: &dyn Marching, y: &[f64]| {
            let found = displaced(set, y);
            found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-10 * size)
        };
        assert!(fail(set.as_mut()));
        let again = end_of_cycle(set.as_mut(), &start, steps);
        assert!(is_same(set.as_ref(), &again), "{fidelity:?}");
        assert!(fail(set.as_mut()));
        set.restore(&state).unwrap();
        march_cycle(set.as_mut(), steps);
        let again = set.derivative().unwrap().coordinates();
        assert!(is_same(set.as_ref(), &again), "{fidelity:?}");
    }
}

/// Columns of the derivative against central differences over a whole cycle, of meshes that run forward and backward.
#[test]
fn the_derivative_is_that_of_the_cycle() {
    for (fidelity, runs_backward) in [
        (Fidelity::QuasiStatic, false),
        (Fidelity::QuasiStatic, true),
        (Fidelity::Modal(4), false),
        (Fidelity::Modal(4), true),
    ] {
        let scene = scene("oh58_4p", fidelity, 28);
        let scene = if runs_backward { backward(scene) } else { scene };
        let bodies = Bodies::new(&scene).unwrap();
        let model = fe(&scene, &bodies, 1130.0);
        let mut set = model.turning(&model.case().at_speed(1500.0), 0).unwrap();
        set.rest().unwrap();
        let mut record = Record::new(4);
        record.march(set.as_mut(), 0.0, 28 * 4).unwrap();
        let start = set.derivative().unwrap().coordinates();
        march_cycle(set.as_mut(), 28);
        let derivative = set.derivative().unwrap().of_cycle(Along::Every).unwrap();
        for (column, j) in derivative.active.iter().enumerate().step_by(5) {
            let change = 1e-10 * derivative.scales[*j];
            let ends = [1.0, -1.0].map(|sign| {
                let mut y = start.clone();
                y[*j] += sign * change;
                end_of_cycle(set.as_mut(), &y, 28)
            });
            let (mut size, mut off) = (0.0f64, 0.0f64);
            for (i, scale) in derivative.scales.iter().enumerate() {
                let exact = derivative.columns[(i, column)] * derivative.scales[*j] / scale;
                let found =
                    (ends[0][i] - ends[1][i]) / (2.0 * change) * derivative.scales[*j] / scale;
                size = size.max(exact.abs());
                off = off.max((found - exact).abs());
            }
            assert!(off < 1e-5 * (1.0 + size), "{fidelity:?}, coordinate {j}: {off:e} of {size:e}");
        }
    }
}

/// The derivative of a steady cycle along displacements and velocities, and another one.
fn both_derivatives(fidelity: Fidelity, other: Along) -> [MapDerivative; 2] {
    let scene = scene("oh58_4p", fidelity, 56);
    let bodies = Bodies::new(&scene).unwrap();
    both_derivatives_of(&fe(&scene, &bodies, 1130.0), other)
}

fn both_derivatives_of(model: &dyn SweepModel, other: Along) -> [MapDerivative; 2] {
    let mut set = model.turning(&model.case().at_speed(2200.0), 0).unwrap();
    set.rest().unwrap();
    // The cycle before the start must be as that before the end.
    (0..400).for_each(|_| march_cycle(set.as_mut(), 56));
    [Along::Motion, other].map(|along| set.derivative().unwrap().of_cycle(along).unwrap())
}

/// Largest difference of the multipliers above 0.01 of the second from those of the first.
fn multipliers_off(first: &MapDerivative, second: &MapDerivative) -> f64 {
    let [a, b] = [first, second].map(|own| multipliers(own).unwrap());
    let large = b.iter().filter(|m| m.size() > 1e-2);
    assert!(large.clone().count() >= 20);
    large.zip(&a).fold(0.0f64, |off, (b, a)| off.max(apart(*a, *b)))
}

/// Displacements and velocities suffice: the derivative along them, with accelerations and lag following, has the
/// multipliers of the derivative with respect to every coordinate.
#[test]
fn multipliers_follow_from_displacements_and_velocities() {
    let [motion, every] = both_derivatives(Fidelity::QuasiStatic, Along::Every);
    let off = multipliers_off(&motion, &every);
    assert!(off < 1e-8, "{off:e}");
}

/// The same with a fifth and a twentieth of the damping, whose lag is a smaller part of a step and is followed over
/// fewer steps.
#[test]
fn multipliers_follow_from_displacements_and_velocities_at_little_damping() {
    for factor in [0.2, 0.05] {
        let mut scene = scene("oh58_4p", Fidelity::QuasiStatic, 56);
        scene.damping.mass_proportional_per_s *= factor;
        scene.damping.stiffness_proportional_s *= factor;
        scene.damping.bearing_s *= factor;
        let bodies = Bodies::new(&scene).unwrap();
        let [motion, every] = both_derivatives_of(&fe(&scene, &bodies, 1130.0), Along::Every);
        let off = multipliers_off(&motion, &every);
        println!("{factor}: {off:e}");
        assert!(off < 1e-8, "{factor}: {off:e}");
    }
}

/// The same with modes of the bodies.
#[test]
fn multipliers_follow_from_displacements_and_velocities_of_modal_bodies() {
    let [motion, every] = both_derivatives(Fidelity::Modal(4), Along::Every);
    let off = multipliers_off(&motion, &every);
    println!("{off:e}");
    assert!(off < 1e-8, "{off:e}");
}

/// The rough derivative, in single precision and of FE/contact with a shorter follow-up of the lag, differs from the
/// exact one by less than corrections of a state need, also with modes of the bodies and with tabulated mesh forces: (I
/// − D)⁻¹ D' − (I − D)⁻¹ D is what a correction leaves of an error.
#[test]
fn the_rough_derivative_leaves_little_of_an_error() {
    let scene = scene("oh58_4p", Fidelity::MeshLaw, 56);
    let bodies = Bodies::new(&scene).unwrap();
    let case = LoadCase::of_scene(&scene).unwrap().with_sun_torque(1130.0);
    let law = MeshLawModel::new(&scene, &bodies, case).unwrap();
    let all = [
        ("quasi_static", both_derivatives(Fidelity::QuasiStatic, Along::MotionRoughly)),
        ("modal", both_derivatives(Fidelity::Modal(4), Along::MotionRoughly)),
        ("mesh_law", both_derivatives_of(&law, Along::MotionRoughly)),
        ("lumped", both_derivatives_of(&law.lumped(), Along::MotionRoughly)),
    ];
    for (name, both) in all {
        let [exact, rough] = both.map(|own| {
            let (active, s) = (&own.active, &own.scales);
            DMatrix::from_fn(active.len(), active.len(), |i, j| {
                own.columns[(active[i], j)] * s[active[j]] / s[active[i]]
            })
        });
        let n = exact.nrows();
        let left = (DMatrix::identity(n, n) - &exact).lu().solve(&(&rough - &exact)).unwrap();
        let largest = left.complex_eigenvalues().iter().fold(0.0f64, |a, x| a.max(x.norm()));
        println!("{name}: left {largest:.1e}, entries off by {:.1e}", (rough - exact).amax());
        assert!(largest > 1e-9 && largest < 1e-2, "{name}: {largest:e}");
    }
}

/// A derivative that forgets the state of the lag, as if it began every cycle at rest, has other multipliers than one
/// that keeps it, by more than the two ways to keep it differ.
#[test]
fn a_forgotten_lag_shows_in_the_multipliers() {
    let [motion, every] = both_derivatives(Fidelity::QuasiStatic, Along::Every);
    let mut forgets = every.clone();
    let kept: Vec<usize> =
        (0..forgets.active.len()).filter(|k| forgets.scales[forgets.active[*k]] != 1e9).collect();
    assert!(kept.len() < forgets.active.len());
    forgets.columns = forgets.columns.select_columns(&kept);
    forgets.active = kept.iter().map(|k| forgets.active[*k]).collect();
    let [right, wrong] = [&motion, &forgets].map(|own| multipliers_off(own, &every));
    println!("lag kept {right:e}, forgotten {wrong:e}");
    assert!(wrong > 10.0 * right, "{wrong:e}, {right:e}");
}
