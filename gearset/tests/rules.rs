//! Excitation rules: the printed ones against phasor sums, and OH-58.

use std::f64::consts::{PI, TAU};
use std::num::NonZeroU32;

use gearset::{
    AllowedKinds, DiametricalRule, ExcitationStrengths, FORBIDDEN_UP_TO, PlanetPositions, Spacing,
    SpacingError, Table4, Teeth, diametrical_rule, excitation, table4,
};
use proptest::prelude::*;

/// What rounding may leave of a sum that cancels.
const ROUNDING: f64 = 1e-14;

fn nz(n: u32) -> NonZeroU32 {
    NonZeroU32::new(n).unwrap()
}

fn steps(steps: &[i64], per_turn: u32) -> Spacing {
    Spacing::from_steps(steps.to_vec(), nz(per_turn)).unwrap()
}

/// Planets of OH-58: 0, −88.6, 180 and 91.4 degrees in steps of 360°/126.
fn oh_58() -> Spacing {
    steps(&[0, -31, 63, 32], 126)
}

fn net_force(e: &ExcitationStrengths) -> f64 {
    e.net_force_plus.max(e.net_force_minus)
}

fn only(rotational: bool, translational: bool, planet: bool) -> AllowedKinds {
    AllowedKinds { rotational, translational, planet }
}

#[test]
fn equally_spaced_planets_give_table_4_exactly() {
    let mut worst: f64 = 0.0;
    let mut seen = [0; 3];
    for planets in 3..=8 {
        let spacing = Spacing::equal(nz(planets));
        for sun_teeth in 12..=60 {
            for harmonic in 1..=12 {
                let e = excitation(&spacing, sun_teeth, harmonic);
                let rule = table4(planets, sun_teeth, harmonic).unwrap();
                let is = |kind| f64::from(u8::from(rule == kind));
                // Every strength is 0 or 1, so that allowed and forbidden harmonics are both tested.
                let expected = [
                    (e.net_torque, is(Table4::RotationalOnly)),
                    (net_force(&e), is(Table4::TranslationalOnly)),
                    (e.planet, is(Table4::Neither)),
                ];
                for (i, (strength, printed)) in expected.into_iter().enumerate() {
                    worst = worst.max((strength - printed).abs());
                    seen[i] += usize::from(printed == 1.0);
                }
                assert_eq!(e.allowed(), rule.allowed(), "N {planets} Zs {sun_teeth} l {harmonic}");
            }
        }
    }
    assert!(worst <= ROUNDING, "{worst:e}");
    // 6·49·12 cases; every line of the table is met often.
    assert_eq!(seen.iter().sum::<usize>(), 3528);
    assert!(seen.iter().all(|&n| n > 500), "{seen:?}");
}

#[test]
fn the_sign_of_k_says_which_way_the_force_turns() {
    // N = 5: k = 1 leaves e^{i(k−1)ψ}, k = 4 leaves e^{i(k+1)ψ}.
    let spacing = Spacing::equal(nz(5));
    let k1 = excitation(&spacing, 41, 1);
    let k4 = excitation(&spacing, 44, 1);
    assert!(k1.net_force_minus > 1.0 - ROUNDING && k1.net_force_plus < ROUNDING);
    assert!(k4.net_force_plus > 1.0 - ROUNDING && k4.net_force_minus < ROUNDING);
}

#[test]
fn planet_modes_need_four_planets_and_the_right_k() {
    for sun_teeth in 12..=60 {
        for harmonic in 1..=12 {
            for planets in 1..=3 {
                let e = excitation(&Spacing::equal(nz(planets)), sun_teeth, harmonic);
                assert!(e.planet <= ROUNDING, "N {planets}: {e:?}");
            }
        }
    }
    // N = 4, k = 2: neighbouring planets are in antiphase, which excites planet modes alone.
    let four = excitation(&Spacing::equal(nz(4)), 30, 1);
    assert!((four.planet - 1.0).abs() <= ROUNDING);
    // N = 5, Z_s = 42, k = 2; no planet part at k = 1 (l = 3).
    let five = |l| excitation(&Spacing::equal(nz(5)), 42, l);
    assert!((five(1).planet - 1.0).abs() <= ROUNDING);
    assert_eq!(five(1).allowed(), only(false, false, true));
    assert!(five(3).planet <= ROUNDING);
    assert_eq!(five(3).allowed(), only(false, true, false));
}

#[test]
fn oh_58_even_harmonics_turn_the_sun_and_do_not_push_it() {
    // Derived, given with two digits: rotation 0.62 at l = 2 and 0.22 at l = 4.
    for (harmonic, torque) in [(2, 0.62), (4, 0.22)] {
        let e = excitation(&oh_58(), 27, harmonic);
        assert!((e.net_torque - torque).abs() < 0.005, "{e:?}");
        assert!(net_force(&e) <= ROUNDING, "{e:?}");
    }
    for harmonic in [1, 3, 5] {
        let e = excitation(&oh_58(), 27, harmonic);
        assert!(e.net_torque <= ROUNDING && net_force(&e) > 0.1, "{e:?}");
    }
    // By hand: partners add, so |1 + e^{i 2·27·2π·32/126}|/2 = |cos(27·2π·32/126)|.
    let by_hand = (27.0 * TAU * 32.0 / 126.0).cos().abs();
    assert!((excitation(&oh_58(), 27, 2).net_torque - by_hand).abs() < 1e-12);
}

#[test]
fn a_displaced_planet_breaks_every_zero() {
    // Negative control: one step more for one planet of OH-58, and of four equal ones.
    for (right, wrong, sun_teeth) in
        [([0, -31, 63, 32], [0, -31, 63, 33], 27), ([0, 32, 64, 96], [0, 33, 64, 96], 28)]
    {
        let per_turn = if sun_teeth == 27 { 126 } else { 128 };
        for harmonic in 1..=5 {
            let good = excitation(&steps(&right, per_turn), sun_teeth, harmonic);
            let bad = excitation(&steps(&wrong, per_turn), sun_teeth, harmonic);
            let forbidden = |e: &ExcitationStrengths| match diametrical_rule(sun_teeth, harmonic) {
                DiametricalRule::TranslationalForbidden => net_force(e),
                DiametricalRule::RotationalForbidden => e.net_torque,
            };
            assert!(forbidden(&good) <= ROUNDING, "{good:?}");
            assert!(forbidden(&bad) > 0.02, "{bad:?}");
        }
        assert!(steps(&right, per_turn).is_diametrical());
        assert!(!steps(&wrong, per_turn).is_diametrical());
    }
}

#[test]
fn where_the_two_printed_rules_differ_the_phasors_side_with_table_4() {
    // N = 4, Z_s = 30, l = 1: l Z_s is even, so only translation is forbidden by the pair rule;
    // k = 2, so Table 4 says neither.
    let spacing = Spacing::equal(nz(4));
    assert!(spacing.is_diametrical() && spacing.is_equal());
    assert_eq!(diametrical_rule(30, 1), DiametricalRule::TranslationalForbidden);
    assert_eq!(table4(4, 30, 1), Some(Table4::Neither));
    let e = excitation(&spacing, 30, 1);
    assert_eq!(e.net_torque, 0.0);
    assert_eq!(e.allowed(), Table4::Neither.allowed());
}

#[test]
fn no_table_for_one_planet() {
    assert_eq!(table4(0, 27, 1), None);
    assert_eq!(table4(1, 27, 1), None);
    let e = excitation(&Spacing::equal(nz(1)), 27, 1);
    assert_eq!(e.allowed(), only(true, true, false));
}

#[test]
fn spacings_recognise_themselves() {
    let angles = |psi: &[f64]| Spacing::from_angles(psi.to_vec()).unwrap();
    assert!(oh_58().is_diametrical() && !oh_58().is_equal());
    assert!(Spacing::equal(nz(3)).is_equal() && !Spacing::equal(nz(3)).is_diametrical());
    assert!(steps(&[0, 84, 42], 126).is_equal());
    assert!(!steps(&[0, 42, 42], 126).is_equal());
    assert!(angles(&[0.0, 0.4, PI, PI + 0.4]).is_diametrical());
    assert!(angles(&[0.0, -0.4, PI - 0.4, -PI]).is_diametrical());
    assert!(!angles(&[0.0, 0.4, PI, PI + 0.4 + 1e-6]).is_diametrical());
    // Σ e^{iψ_n} = 0 requires neither: here a diametrical pair and three equally spaced planets.
    assert!(steps(&[0, 60, 7, 47, 87], 120).is_balanced());
    assert!(!steps(&[0, 60, 7, 47, 87], 120).is_diametrical());
    assert!(oh_58().is_balanced() && Spacing::equal(nz(3)).is_balanced());
    assert!(!Spacing::equal(nz(1)).is_balanced() && !steps(&[0, -31, 63, 33], 126).is_balanced());
    // With an odd number of steps per turn no two positions are opposite.
    assert!(!steps(&[0, 62], 125).is_diametrical());
    // Equal spacing is recognised for angles of either sign.
    let equal = PlanetPositions::equally_spaced(7);
    assert_eq!(Spacing::of(&equal, None), Ok(Spacing::equal(nz(7))));
    assert_eq!(angles(&[0.0, PI / 2.0, PI, -PI / 2.0]), Spacing::equal(nz(4)));

    assert_eq!(Spacing::from_angles(vec![]), Err(SpacingError::NoPlanets));
    assert_eq!(Spacing::from_steps(vec![], nz(126)), Err(SpacingError::NoPlanets));
    let nan = Spacing::from_angles(vec![0.0, f64::NAN]);
    assert!(matches!(nan, Err(SpacingError::NotFinite { planet: 1, .. })));
}

#[test]
fn steps_are_used_only_together_with_teeth() {
    let psi_rad: Vec<f64> = [0, -31, 63, 32].iter().map(|&s| TAU * f64::from(s) / 126.0).collect();
    let positions = PlanetPositions { psi_rad, steps: Some(vec![0, -31, 63, 32]) };
    let teeth = Teeth { sun: Some(27), planet: 35, ring: Some(99) };
    let exact = Spacing::of(&positions, Some(teeth)).unwrap();
    let rounded = Spacing::of(&positions, None).unwrap();
    assert_eq!(exact, oh_58());
    assert_ne!(rounded, exact);
    for harmonic in 1..=10 {
        let (a, b) = (excitation(&exact, 27, harmonic), excitation(&rounded, 27, harmonic));
        assert!((a.net_torque - b.net_torque).abs() < 1e-12);
        assert!((a.net_force_plus - b.net_force_plus).abs() < 1e-12);
        assert!((a.net_force_minus - b.net_force_minus).abs() < 1e-12);
        assert!((a.planet - b.planet).abs() < 1e-12);
        assert_eq!(a.allowed(), b.allowed());
    }
}

#[test]
fn a_large_harmonic_stays_exact() {
    // l Z_s ψ_n is some 10¹⁰ turns: a phase not reduced in whole numbers would be off by 1e-5.
    let e = excitation(&oh_58(), 27, 1_000_000_000);
    // The same phase as l mod 126: 10⁹ = 126·7936507 + 118.
    let same = excitation(&oh_58(), 27, 118);
    assert_eq!(e.net_torque, same.net_torque);
    assert_eq!(e.net_force_plus, same.net_force_plus);
}

/// Pairs at s and s + T/2, T = Z_s + Z_r even, in any order.
fn diametrical_sets() -> impl Strategy<Value = (u32, u32, Vec<i64>)> {
    (12_u32..=90, 6_u32..=80, 1_usize..=6).prop_flat_map(|(sun, half_extra, pairs)| {
        let ring = sun + 2 * half_extra;
        let half = i64::from((sun + ring) / 2);
        let all: Vec<i64> = (0..half).collect();
        proptest::sample::subsequence(all, pairs).prop_flat_map(move |first| {
            let both = first.iter().flat_map(|&s| [s, s - half]).collect::<Vec<_>>();
            (Just(sun), Just(ring), Just(both).prop_shuffle())
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn diametrical_pairs_obey_the_odd_even_rule((sun, ring, set) in diametrical_sets()) {
        let spacing = steps(&set, sun + ring);
        prop_assert!(spacing.is_diametrical());
        for harmonic in 1..=10 {
            let e = excitation(&spacing, sun, harmonic);
            let forbidden = match diametrical_rule(sun, harmonic) {
                DiametricalRule::TranslationalForbidden => net_force(&e),
                DiametricalRule::RotationalForbidden => e.net_torque,
            };
            prop_assert!(forbidden < 1e-12, "{:?}", e);
            prop_assert!(forbidden <= FORBIDDEN_UP_TO);
        }
    }

    #[test]
    fn sun_and_ring_phases_agree_where_planets_can_be_assembled(
        sun in 12_u32..=90,
        ring in 40_u32..=200,
        set in prop::collection::vec(-150_i64..150, 1..9),
        harmonic in 1_u32..=12,
    ) {
        let spacing = steps(&set, sun + ring);
        let at_sun = excitation(&spacing, sun, harmonic);
        let at_ring = excitation(&spacing, ring, harmonic);
        // e^{i l Z_s ψ} = e^{−i l Z_r ψ}: the conjugate, so the two forces change places.
        prop_assert!((at_sun.net_torque - at_ring.net_torque).abs() < ROUNDING);
        prop_assert!((at_sun.net_force_plus - at_ring.net_force_minus).abs() < ROUNDING);
        prop_assert!((at_sun.net_force_minus - at_ring.net_force_plus).abs() < ROUNDING);
        prop_assert!((at_sun.planet - at_ring.planet).abs() < 1e-10);
    }

    #[test]
    fn strengths_say_how_the_phasors_split(
        sun in 12_u32..=90,
        ring in 40_u32..=200,
        set in prop::collection::vec(0_i64..100, 1..9),
        harmonic in 1_u32..=12,
    ) {
        let e = excitation(&steps(&set, sun + ring), sun, harmonic);
        for strength in [e.net_torque, e.net_force_plus, e.net_force_minus, e.planet] {
            prop_assert!((0.0..=1.0 + ROUNDING).contains(&strength));
        }
        // Every phasor vector has a part in at least one kind of mode.
        let allowed = e.allowed();
        prop_assert!(allowed.rotational || allowed.translational || allowed.planet);
        // Turning the whole set changes nothing.
        let turned: Vec<i64> = set.iter().map(|s| s + 17).collect();
        let f = excitation(&steps(&turned, sun + ring), sun, harmonic);
        prop_assert!((e.net_torque - f.net_torque).abs() < ROUNDING);
        prop_assert!((e.net_force_plus - f.net_force_plus).abs() < ROUNDING);
        prop_assert!((e.planet - f.planet).abs() < 1e-10);
    }
}
