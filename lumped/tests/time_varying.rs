//! The lumped set in time, checked against its static solution, its natural modes and its symmetries.

use std::f64::consts::TAU;
use std::path::Path;

use gearset::{
    Axis, Body, CurveKey, Facing, FlankSide, MeshCurve, MeshLaw, MeshLawPlan, MeshStart,
    PairSprings, Phasing,
};
use lumped::{LumpedError, LumpedModel, NaturalModes, TimeVarying};
use scene::Scene;

/// A scene file of the repository.
fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
    Scene::from_file(&path).unwrap()
}

const TORQUE: f64 = 1413.0;
const FREQUENCY: f64 = 565.714;

fn starts(scene: &Scene) -> Vec<MeshStart> {
    let geometry = scene.tooth_geometry().unwrap();
    MeshStart::of_set(&Phasing::new(&geometry, &scene.planets).unwrap())
}

fn law(scene: &Scene, steps: usize, curve: impl Fn(f64) -> MeshCurve) -> MeshLaw {
    let plan = MeshLawPlan::new(&starts(scene), steps).unwrap();
    let curves = plan.curves.iter().map(|key| curve(key.phase)).collect();
    plan.law(curves).unwrap()
}

/// The scene's sun mesh stiffness for all meshes, at all phases; no force below deflection 0.
fn constant(scene: &Scene, steps: usize) -> MeshLaw {
    let k = scene.lumped.as_ref().unwrap().mesh_n_per_m.sun_planet;
    law(scene, steps, |_| MeshCurve::new(0.0, 1e-3, &[0.0, k * 1e-3], &[k, k]).unwrap())
}

fn teeth(gap: f64) -> PairSprings {
    PairSprings { stiffness: 2.2e8, contact_ratio: 1.62, gap_at_tenth: gap }
}

fn changing(scene: &Scene, steps: usize) -> MeshLaw {
    law(scene, steps, |phase| teeth(4e-6).curve(phase, 120e-6, 240).unwrap())
}

#[test]
fn static_deflection_is_the_stiffness_matrix_solved() {
    let scene = scene("oh58_4p.toml");
    let model = LumpedModel::from_scene(&scene).unwrap();
    let mut set =
        TimeVarying::new(&scene, Facing::CounterClockwise, constant(&scene, 140), FREQUENCY)
            .unwrap();
    set.rest(TORQUE).unwrap();
    let n = model.coordinates.count();
    let mut f = nalgebra::DVector::<f64>::zeros(n);
    let sun = model.coordinates.of(Body::Sun, Axis::Rotation).unwrap();
    f[sun] = TORQUE / scene.lumped.as_ref().unwrap().radius_m.sun.unwrap();
    let exact = model.stiffness().lu().solve(&f).unwrap();
    let motion = set.motion();
    let largest = motion.x.iter().fold(0.0f64, |a, x| a.max(x.abs()));
    for i in 0..n {
        assert!((motion.x[i] - exact[i]).abs() < 1e-10 * largest, "{i}");
    }
    // With constant stiffness the set stays at rest.
    (0..300).for_each(|_| set.step().unwrap());
    for (x, start) in set.motion().x.iter().zip(&motion.x) {
        assert!((x - start).abs() < 1e-10 * largest);
    }
    let mut forces = Vec::new();
    set.mesh_forces(&mut forces);
    assert_eq!(forces.len(), 8);
    let share = TORQUE / scene.lumped.as_ref().unwrap().radius_m.sun.unwrap();
    assert!((forces[..4].iter().sum::<f64>() / share - 1.0).abs() < 1e-9);
}

/// Released from a displacement in one mode about the preloaded state, without damping, the set vibrates in
/// that mode alone, at the frequency (2/h) atan(ωh/2) of Newmark's rule.
#[test]
fn natural_modes_are_those_of_the_eigen_model() {
    let mut scene = scene("oh58_4p.toml");
    scene.damping.mass_proportional_per_s = 0.0;
    scene.damping.stiffness_proportional_s = 0.0;
    scene.damping.bearing_s = 0.0;
    let model = LumpedModel::from_scene(&scene).unwrap();
    let modes = NaturalModes::of(&model).unwrap();
    let mut set =
        TimeVarying::new(&scene, Facing::CounterClockwise, constant(&scene, 140), FREQUENCY)
            .unwrap();
    set.rest(TORQUE).unwrap();
    let (rest, h) = (set.motion().x, 1.0 / (FREQUENCY * 140.0));
    for group in &modes.groups {
        for j in 0..group.multiplicity {
            let shape: Vec<f64> = (0..rest.len()).map(|i| 1e-7 * group.vectors[(i, j)]).collect();
            let x: Vec<f64> = rest.iter().zip(&shape).map(|(r, s)| r + s).collect();
            set.set_motion(0, &x, &vec![0.0; x.len()]).unwrap();
            let omega = TAU * group.frequency_hz;
            let turned = 2.0 / h * (0.5 * omega * h).atan();
            let steps = 400;
            (0..steps).for_each(|_| set.step().unwrap());
            let swing = (turned * h * f64::from(steps)).cos();
            for (i, x) in set.motion().x.iter().enumerate() {
                let exact = rest[i] + swing * shape[i];
                let size = shape.iter().fold(0.0f64, |a, s| a.max(s.abs()));
                assert!((x - exact).abs() < 1e-5 * size, "{} Hz", group.frequency_hz);
            }
        }
    }
}

/// Stiffness-proportional damping acts on the bodies' share of the flexibility of a mesh alone: with a share of
/// 0.3 a set moves as with 0.3 times the damping on all of it.
#[test]
fn damping_of_a_mesh_is_that_of_its_bodies_share() {
    let mut scene = scene("oh58_4p.toml");
    scene.damping.bearing_s = 1e-6;
    let mut march = |beta: f64, share: f64| {
        scene.damping.stiffness_proportional_s = beta;
        let law = changing(&scene, 140).with_damping_share(&[share; 8]).unwrap();
        let mut set = TimeVarying::new(&scene, Facing::CounterClockwise, law, FREQUENCY).unwrap();
        set.rest(TORQUE).unwrap();
        (0..280).for_each(|_| set.step().unwrap());
        set.motion().x
    };
    let (own, same, whole) = (march(2e-6, 0.3), march(0.6e-6, 1.0), march(2e-6, 1.0));
    let size = own.iter().fold(0.0f64, |a, x| a.max(x.abs()));
    let off = |other: &[f64]| own.iter().zip(other).fold(0.0f64, |a, (x, y)| a.max((x - y).abs()));
    assert!(off(&same) < 1e-10 * size, "{:e}", off(&same) / size);
    assert!(off(&whole) > 1e-5 * size, "{:e}", off(&whole) / size);
}

/// At light load and large initial displacement contact is lost and backside flanks touch; all steps
/// converge, no mesh force is negative, and contact is regained.
#[test]
fn loss_of_contact_at_high_excitation_stays_sound() {
    let mut scene = scene("oh58_4p.toml");
    scene.damping.mass_proportional_per_s = 30.0;
    scene.damping.stiffness_proportional_s = 3e-7;
    let plan_law = |backside: bool| {
        let mut starts = starts(&scene);
        for start in &mut starts {
            start.backside = backside.then_some(0.37 - start.front);
        }
        let plan = MeshLawPlan::new(&starts, 140).unwrap();
        let curve = |key: &CurveKey| {
            let own = teeth(0.5e-6).curve(key.phase, 60e-6, 240).unwrap();
            match key.side {
                FlankSide::Front => own,
                FlankSide::Backside => own.moved(8e-6),
            }
        };
        let curves = plan.curves.iter().map(curve).collect();
        plan.law(curves).unwrap()
    };
    let mut seen = [false; 2];
    for frequency in [900.0, 1300.0, 1700.0, 2100.0, 2600.0] {
        let sense = Facing::CounterClockwise;
        let mut set = TimeVarying::new(&scene, sense, plan_law(true), frequency).unwrap();
        set.rest(30.0).unwrap();
        let x: Vec<f64> = set.motion().x.iter().map(|x| 8.0 * x).collect();
        set.set_motion(0, &x, &vec![0.0; x.len()]).unwrap();
        let mut forces = Vec::new();
        let (mut lost, mut loaded) = (0, 0);
        for _ in 0..140 * 40 {
            set.step().unwrap();
            set.mesh_forces(&mut forces);
            assert_eq!(forces.len(), 16);
            assert!(forces.iter().all(|f| *f >= 0.0));
            lost += forces[..8].iter().filter(|f| **f == 0.0).count();
            loaded += forces[..8].iter().filter(|f| **f > 0.0).count();
        }
        assert!(loaded > 0);
        seen[0] |= lost > 0;
        seen[1] |= set.counts().1 > 0;
    }
    assert_eq!(seen, [true, true], "contact lost, backside flanks met");
}

/// A clockwise torque on the mirrored set gives the mirrored motion.
#[test]
fn mirrored_sets_move_mirrored() {
    let scene = scene("oh58_3p.toml");
    let law = changing(&scene, 140);
    let run = |scene: &Scene, sense| {
        let mut set = TimeVarying::new(scene, sense, law.clone(), FREQUENCY).unwrap();
        set.rest(TORQUE).unwrap();
        (0..500).for_each(|_| set.step().unwrap());
        set.displacements()
    };
    let (a, b) = (run(&scene, Facing::CounterClockwise), {
        let mut mirrored = scene.clone();
        mirrored.planets.psi_rad.iter_mut().for_each(|psi| *psi = -*psi);
        run(&mirrored, Facing::Clockwise)
    });
    let all = |(central, planets): &([[f64; 3]; 3], Vec<[f64; 3]>)| -> Vec<[f64; 3]> {
        central.iter().chain(planets).copied().collect()
    };
    for (a, b) in all(&a).iter().zip(all(&b)) {
        assert!((a[0] - b[0]).abs() < 1e-15);
        assert!((a[1] + b[1]).abs() < 1e-15 && (a[2] + b[2]).abs() < 1e-13);
    }
}

/// Three equal planets a third of a cycle apart: in steady motion the mesh forces of planet n are those of
/// planet 0 shifted by n/3 cycle. They agree to rounding if the number of steps per cycle is a multiple of 3,
/// and otherwise not.
#[test]
fn planets_follow_their_exact_phases() {
    let mut scene = scene("oh58_3p.toml");
    scene.damping.mass_proportional_per_s = 2000.0;
    let mut starts = starts(&scene);
    for (i, start) in starts.iter_mut().enumerate() {
        start.front += (i % 3) as f64 / 3.0;
    }
    let apart = |steps: usize| {
        let plan = MeshLawPlan::new(&starts, steps).unwrap();
        let curve = |key: &CurveKey| teeth(4e-6).curve(key.phase, 120e-6, 240).unwrap();
        let curves = plan.curves.iter().map(curve).collect();
        let law = plan.law(curves).unwrap();
        let mut set = TimeVarying::new(&scene, Facing::CounterClockwise, law, FREQUENCY).unwrap();
        set.rest(TORQUE).unwrap();
        (0..60 * steps).for_each(|_| set.step().unwrap());
        let mut rows = Vec::new();
        for _ in 0..steps {
            set.step().unwrap();
            let mut forces = Vec::new();
            set.mesh_forces(&mut forces);
            rows.push(forces);
        }
        assert!(set.is_within_tables());
        let mut worst = 0.0f64;
        for (i, row) in rows.iter().enumerate() {
            for n in 1..3 {
                let ahead = &rows[(i + (n * steps) / 3) % steps];
                for mesh in [0, 3] {
                    worst = worst.max((row[mesh + n] / ahead[mesh] - 1.0).abs());
                }
            }
        }
        worst
    };
    let (divided, not) = (apart(141), apart(140));
    assert!(divided < 1e-9, "{divided:e}");
    assert!(not > 1e-4, "{not:e}");
}

#[test]
fn a_motion_that_diverges_is_told_by_body_and_displacement() {
    let scene = scene("oh58_4p.toml");
    let mut set =
        TimeVarying::new(&scene, Facing::CounterClockwise, constant(&scene, 140), FREQUENCY)
            .unwrap();
    set.load(1e15).unwrap();
    let error = (0..140).find_map(|_| set.step().err()).unwrap();
    assert!(matches!(error, LumpedError::Diverged { body: Body::Sun, .. }), "{error}");
    assert!(error.to_string().contains("the rotation of the sun is "), "{error}");
}

#[test]
fn states_resume_bit_by_bit() {
    let scene = scene("oh58_4p.toml");
    let mut set =
        TimeVarying::new(&scene, Facing::CounterClockwise, changing(&scene, 140), FREQUENCY)
            .unwrap();
    set.rest(TORQUE).unwrap();
    (0..77).for_each(|_| set.step().unwrap());
    let state = set.state().clone();
    (0..200).for_each(|_| set.step().unwrap());
    let end = set.motion();
    set.set_state(&state).unwrap();
    (0..200).for_each(|_| set.step().unwrap());
    assert_eq!(end, set.motion());
}

/// A set taken to another speed marches bit by bit as one made there, whatever it was doing and with its torque kept.
#[test]
fn a_set_at_another_frequency_is_the_set_made_there() {
    for name in ["oh58_4p.toml", "oh58_3p.toml"] {
        let scene = scene(name);
        let law = changing(&scene, 140);
        let at = |f| TimeVarying::new(&scene, Facing::Clockwise, law.clone(), f).unwrap();
        let mut first = at(FREQUENCY);
        first.rest(TORQUE).unwrap();
        (0..77).for_each(|_| first.step().unwrap());
        let mut taken = first.at_frequency(1.7 * FREQUENCY).unwrap();
        let mut made = at(1.7 * FREQUENCY);
        made.load(TORQUE).unwrap();
        assert_eq!(taken.state(), made.state());
        for _ in 0..200 {
            taken.step().unwrap();
            made.step().unwrap();
        }
        assert_eq!(taken.motion(), made.motion());
        assert_eq!(taken.time(), made.time());
        assert!(first.at_frequency(0.0).unwrap_err().to_string().contains("mesh frequency"));
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let scene = scene("oh58_4p.toml");
    let other = self::scene("oh58_3p.toml");
    let new = |scene: &Scene, law: MeshLaw, f| {
        TimeVarying::new(scene, Facing::CounterClockwise, law, f)
            .map(|_| ())
            .map_err(|e| e.to_string())
    };
    assert!(new(&scene, constant(&other, 20), FREQUENCY).unwrap_err().contains("6 meshes"));
    assert!(new(&scene, constant(&scene, 20), -1.0).unwrap_err().contains("mesh frequency"));
    let mut bad = scene.clone();
    bad.damping.bearing_s = -1.0;
    assert!(new(&bad, constant(&scene, 20), FREQUENCY).unwrap_err().contains("damping.bearing_s"));
}
