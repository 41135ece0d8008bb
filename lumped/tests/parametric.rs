//! Tongues of parametric instability: Floquet multipliers against first-order formulas, and which tongues phasing and
//! contact ratio close.

use std::path::Path;

use lumped::{LumpedError, LumpedModel, MeshWave, ModeType, ParametricSet, Tongue, tongues};
use scene::Scene;

/// A scene file of the repository.
fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
    Scene::from_file(&path).unwrap()
}

/// A tongue narrower than this part of its bound is closed.
const CLOSED: f64 = 1e-9;

/// Open tongues of the harmonics 1 to 3 that no other comes near, widest first: within six half-widths at ε no other
/// open tongue has its centre.
fn isolated(set: &ParametricSet) -> Vec<Tongue> {
    let mut open = tongues(set, 3).unwrap();
    open.retain(|t| t.strength() > CLOSED);
    let is_alone = |t: &&Tongue| {
        let near = |o: &&Tongue| {
            let wide = 6.0 * set.epsilon() * t.half_width_hz.max(o.half_width_hz);
            (o.mesh_frequency_hz - t.mesh_frequency_hz).abs() < wide
        };
        open.iter().filter(near).count() == 1
    };
    let mut alone: Vec<Tongue> = open.iter().filter(is_alone).cloned().collect();
    alone.sort_by(|a, b| b.half_width_hz.total_cmp(&a.half_width_hz));
    alone
}

/// Borders found from multipliers leave the first-order ones as ε²: the order is 2, and the half-width over ε tends to
/// the formula's. Combination and single-mode tongues, single modes and pairs.
#[test]
fn borders_are_the_first_order_ones_up_to_the_square_of_the_variation() {
    let epsilons = [0.02, 0.01, 0.005];
    let mut compared = 0;
    for (name, count) in [("five_planets.toml", 5), ("oh58_4p.toml", 3)] {
        let set = ParametricSet::from_scene(&scene(name), epsilons[0]).unwrap();
        for t in isolated(&set).iter().take(count) {
            let told = format!("{name} l {} {:.1?}", t.harmonic, t.frequency_hz);
            // Distance of the worse border, and width and growth over the formula's.
            let at = |epsilon: f64| {
                let now = set.with_variation(epsilon).unwrap();
                let found = now.edges(t).unwrap().unwrap_or_else(|| panic!("{told}: stable"));
                let half = epsilon * t.half_width_hz;
                let low = (found.low_hz - t.mesh_frequency_hz + half).abs();
                let high = (found.high_hz - t.mesh_frequency_hz - half).abs();
                let width = 0.5 * (found.high_hz - found.low_hz) / half;
                (low.max(high), width)
            };
            let [a, b, c] = epsilons.map(at);
            for (coarse, fine) in [(a, b), (b, c)] {
                let order = (coarse.0 / fine.0).log2();
                assert!((order - 2.0).abs() < 0.2, "{told}: order {order}");
            }
            // 1 + c₁ε + O(ε²), extrapolated to ε = 0.
            let limit = 2.0 * c.1 - b.1;
            assert!((limit - 1.0).abs() < 0.002, "{told}: {limit}");
            compared += 1;
        }
    }
    assert_eq!(compared, 8);
}

/// Inside a tongue vibration grows, beyond either border it does not.
#[test]
fn growth_is_inside_the_borders_and_nowhere_near() {
    let set = ParametricSet::from_scene(&scene("five_planets.toml"), 0.02).unwrap();
    let t = &isolated(&set)[0];
    let found = set.edges(t).unwrap().unwrap();
    let width = found.high_hz - found.low_hz;
    for (f, grows) in [
        (found.low_hz - 0.01 * width, false),
        (found.low_hz + 0.01 * width, true),
        (found.high_hz - 0.01 * width, true),
        (found.high_hz + 0.01 * width, false),
    ] {
        assert_eq!(set.growth_per_s(f).unwrap() > 0.0, grows, "{f}");
    }
    // Without variation all multipliers lie on the unit circle, as many as states, their product 1.
    let still = set.with_variation(0.0).unwrap();
    let all = still.multipliers(t.mesh_frequency_hz).unwrap();
    assert_eq!(all.len(), 2 * still.model().mass.len());
    assert!(all.iter().all(|m| (m.size() - 1.0).abs() < 1e-7), "{all:?}");
}

/// Five planets and a sun of 42 teeth: harmonic l has phases 2l/5 from planet to planet, modes have patterns
/// e^{ikn2π/5} with k = 0 (rotational), ±1 (translational), ±2 (planet); a tongue is open only if k_p + k_q + 2l = 0
/// mod 5.
#[test]
fn planet_phasing_closes_the_tongues_that_symmetry_forbids() {
    let set = ParametricSet::from_scene(&scene("five_planets.toml"), 0.02).unwrap();
    let patterns = |kind: ModeType| match kind {
        ModeType::Rotational => vec![0],
        ModeType::Translational => vec![-1, 1],
        _ => vec![-2, 2],
    };
    let mut counts = [0; 2];
    for t in tongues(&set, 5).unwrap() {
        let [p, q] = t.mode_type.map(patterns);
        let pairs = p.iter().flat_map(|a| q.iter().map(move |b| a + b));
        let mut sums = pairs.map(|sum: i32| (sum + 2 * t.harmonic as i32).rem_euclid(5));
        let is_allowed = sums.any(|s| s == 0);
        let told = format!("l {} {:?}: {:e}", t.harmonic, t.mode_type, t.strength());
        assert!(t.strength() < 1.0 + 1e-12, "{told}");
        assert_eq!(t.strength() > CLOSED, is_allowed, "{told}");
        counts[usize::from(is_allowed)] += 1;
    }
    assert!(counts.iter().all(|c| *c > 50), "{counts:?}");
}

/// The same meshes all in phase open a tongue that phasing closes, and the multipliers say so too; contact ratios of
/// 1.5 close every tongue of the second harmonic.
#[test]
fn phases_and_contact_ratios_decide_what_grows() {
    let scene = scene("five_planets.toml");
    let set = ParametricSet::from_scene(&scene, 0.02).unwrap();
    let model = LumpedModel::from_scene(&scene).unwrap();
    let waves = |contact_ratio: f64| vec![MeshWave { contact_ratio, phase: 0.0 }; 10];
    let in_phase = ParametricSet::new(model.clone(), waves(1.4), 0.02).unwrap();
    let twice_lowest = |set: &ParametricSet, l: u32| {
        let is_it = |t: &Tongue| {
            t.harmonic == l
                && t.mode_type == [ModeType::Rotational; 2]
                && t.frequency_hz[0] == t.frequency_hz[1]
        };
        tongues(set, 2).unwrap().into_iter().find(is_it).unwrap()
    };
    let (closed, open) = (twice_lowest(&set, 1), twice_lowest(&in_phase, 1));
    assert!(closed.strength() < CLOSED && open.strength() > 0.01);
    assert_eq!(set.growth_per_s(closed.mesh_frequency_hz).unwrap(), 0.0);
    let growth = in_phase.growth_per_s(open.mesh_frequency_hz).unwrap();
    assert!((growth / (0.02 * open.growth_per_s) - 1.0).abs() < 0.1, "{growth} {open:?}");
    let half = ParametricSet::new(model, waves(1.5), 0.02).unwrap();
    for t in tongues(&half, 2).unwrap() {
        // Coupling of planet modes to themselves in phase vanishes by symmetry with other kinds only.
        if t.harmonic == 2 {
            assert!(t.strength() < CLOSED, "{t:?}");
        }
    }
    let even = twice_lowest(&half, 2);
    assert_eq!(half.growth_per_s(even.mesh_frequency_hz).unwrap(), 0.0);
    assert!(twice_lowest(&in_phase, 2).strength() > 0.01);
}

#[test]
fn sets_without_teeth_and_negative_stiffness_are_refused() {
    let five = scene("five_planets.toml");
    let model = LumpedModel::from_scene(&five).unwrap();
    let waves = vec![MeshWave { contact_ratio: 1.8, phase: 0.0 }; 10];
    // Lowest stiffness 1 − 2·0.8 ε: 0.624 is allowed, 0.626 is not.
    assert!(ParametricSet::new(model.clone(), waves.clone(), 0.624).is_ok());
    for epsilon in [0.626, -0.1, f64::NAN] {
        let refused = ParametricSet::new(model.clone(), waves.clone(), epsilon);
        assert!(matches!(refused, Err(LumpedError::Variation { .. })), "{epsilon}");
    }
    let few = ParametricSet::new(model, waves[..9].to_vec(), 0.1);
    assert!(matches!(few, Err(LumpedError::Law { .. })));
    let bare = ParametricSet::from_scene(&scene("lin_parker_1999_4p.toml"), 0.1);
    assert!(matches!(bare, Err(LumpedError::NoTeeth)));
    let set = ParametricSet::from_scene(&five, 0.1).unwrap();
    assert!(matches!(set.multipliers(0.0), Err(LumpedError::Frequency(_))));
}
