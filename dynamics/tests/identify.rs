//! Modes identified from sums of damped cosines, against the parameters of these cosines.

use crate::synthetic;

use std::f64::consts::TAU;

use dynamics::c64;
use dynamics::identify::{
    Decimation, Identification, Method, Mode, Options, Scaling, identify, share_in_span,
};
use synthetic::{Damped, Numbers, decays, disturb};

/// Sample interval, s.
const INTERVAL: f64 = 5e-6;

/// Wanted band, Hz, and the frequencies of the modes in it: two double ones, and four within 3 %.
const BAND: (f64, f64) = (500.0, 2500.0);
const WANTED: [f64; 9] = [780.0, 780.0, 1104.0, 1695.0, 1708.0, 1717.0, 1743.0, 2145.0, 2145.0];

/// Modes above the band: frequency, Hz, and damping ratio.
const ABOVE: [(f64, f64); 4] = [(5200.0, 0.01), (7400.0, 0.03), (9800.0, 0.06), (12800.0, 0.09)];

/// The wanted modes with 2 % damping and those above, with pseudo-random shapes and participations.
fn set(inputs: usize, outputs: usize, seed: u64) -> Vec<Damped> {
    let mut numbers = Numbers::new(seed);
    let below = WANTED.iter().map(|f| (*f, 0.02));
    let mode = |(frequency, damping)| Damped {
        frequency,
        damping,
        shape: numbers.many(outputs),
        participation: numbers.many(inputs),
        phase: 3.0 * numbers.even(),
    };
    below.chain(ABOVE).map(mode).collect()
}

fn run(records: &[Vec<Vec<f64>>], options: &Options) -> Identification {
    identify(records, INTERVAL, options).unwrap()
}

/// Frequencies and damping ratios of `found` are those of `expected` (ascending), relative.
fn assert_poles(found: &[Mode], expected: &[(f64, f64)], frequency: f64, damping: f64) {
    let got: Vec<f64> = found.iter().map(|m| m.frequency).collect();
    assert_eq!(found.len(), expected.len(), "{got:?}");
    for (mode, (f, zeta)) in found.iter().zip(expected) {
        let off = (mode.frequency / f - 1.0).abs();
        assert!(off < frequency, "{} Hz for {f}: {off:e}", mode.frequency);
        let off = (mode.damping / zeta - 1.0).abs();
        assert!(off < damping, "damping at {f} Hz: {off:e}");
    }
}

fn wanted() -> Vec<(f64, f64)> {
    WANTED.iter().map(|f| (*f, 0.02)).collect()
}

/// Largest deviation of the residues Σ φ pᵀ at frequency f from those the records are made of,
/// relative to the largest: cos(ω_d t + phase) is Re of exp(i phase) exp(i ω_d t).
fn residue_error(found: &[Mode], made: &[Damped], f: f64) -> f64 {
    let near = |x: f64| (x - f).abs() < 1e-3 * f;
    let (mut worst, mut largest) = (0.0f64, 0.0f64);
    for o in 0..made[0].shape.len() {
        for i in 0..made[0].participation.len() {
            let of_mode = |m: &Mode| m.shape[o] * m.participation[i];
            let is: c64 = found.iter().filter(|m| near(m.frequency)).map(of_mode).sum();
            let of_made =
                |m: &Damped| c64::from_polar(1.0, m.phase) * (m.shape[o] * m.participation[i]);
            let should: c64 = made.iter().filter(|m| near(m.frequency)).map(of_made).sum();
            worst = worst.max((is - should).norm());
            largest = largest.max(should.norm());
        }
    }
    worst / largest
}

/// Every true shape lies in the span of the shapes found at its frequency.
fn assert_shapes(found: &[Mode], made: &[Damped], tolerance: f64) {
    for mode in made.iter().filter(|m| m.frequency < BAND.1) {
        let near = |m: &&Mode| (m.frequency - mode.frequency).abs() < 1e-3 * mode.frequency;
        let family: Vec<&[c64]> = found.iter().filter(near).map(|m| m.shape.as_slice()).collect();
        let shape: Vec<c64> = mode.shape.iter().map(|x| c64::new(*x, 0.0)).collect();
        let missed = 1.0 - share_in_span(&shape, &family);
        assert!(missed < tolerance, "{} Hz: {missed:e}", mode.frequency);
    }
}

#[test]
fn close_and_repeated_modes_come_out_to_rounding_without_noise() {
    for (inputs, outputs, samples, stride) in
        [(4, 8, 4000, 20), (6, 17, 4000, 20), (5, 12, 8000, 12), (4, 8, 8000, 5)]
    {
        let made = set(inputs, outputs, 1);
        let records = decays(&made, samples, INTERVAL);
        let found = run(&records, &Options::new(BAND, stride));
        assert_poles(&found.modes, &wanted(), 1e-10, 1e-8);
        let multiplicities: Vec<usize> = found.modes.iter().map(|m| m.multiplicity).collect();
        assert_eq!(multiplicities, [2, 2, 1, 1, 1, 1, 1, 2, 2]);
        assert_shapes(&found.modes, &made, 1e-10);
        for f in WANTED {
            let error = residue_error(&found.modes, &made, f);
            assert!(error < 1e-7, "{inputs}×{outputs}, {f} Hz: {error:e}");
        }
    }
}

/// The limits are twice the worst of twenty seeds of the smallest set.
#[test]
fn noise_of_a_ten_thousandth_of_the_peak_moves_little() {
    for (inputs, outputs, samples) in [(4, 8, 4000), (6, 17, 4000), (4, 8, 8000)] {
        for seed in [1, 2] {
            let made = set(inputs, outputs, seed);
            let mut records = decays(&made, samples, INTERVAL);
            disturb(&mut records, 1e-4, 7 * seed);
            for method in [Method::Hankel, Method::Correlation] {
                let options = Options { method, ..Options::new(BAND, 20) };
                let found = run(&records, &options);
                assert_poles(&found.modes, &wanted(), 5e-5, 3e-3);
                assert_shapes(&found.modes, &made, 1e-4);
                assert!(found.modes.iter().all(|m| m.coherence > 0.999));
            }
        }
    }
}

#[test]
fn the_chart_shows_modes_stable_and_noise_not() {
    let made = set(4, 8, 3);
    let mut records = decays(&made, 4000, INTERVAL);
    disturb(&mut records, 1e-4, 11);
    let options = Options::new(BAND, 20);
    let found = run(&records, &options);
    let orders: Vec<usize> = found.chart.iter().map(|o| o.order).collect();
    assert_eq!(orders, (1..=30).map(|k| 2 * k).collect::<Vec<_>>());
    assert!(found.chart[0].poles.iter().all(|p| !p.stable.frequency));
    for order in found.chart.iter().filter(|o| o.order >= 30) {
        let stable: Vec<f64> = order
            .poles
            .iter()
            .filter(|p| p.stable.all() && p.coherence > options.coherence)
            .map(|p| p.frequency)
            .filter(|f| (BAND.0..BAND.1).contains(f))
            .collect();
        assert_eq!(stable.len(), WANTED.len(), "order {}: {stable:?}", order.order);
    }
}

#[test]
fn modes_a_thousand_times_weaker_are_found() {
    for weak in [0, 2, 4] {
        let mut made = set(4, 8, 5);
        made[weak].shape.iter_mut().for_each(|x| *x *= 1e-3);
        let records = decays(&made, 4000, INTERVAL);
        let found = run(&records, &Options::new(BAND, 20));
        assert_poles(&found.modes, &wanted(), 1e-9, 1e-7);
        assert_shapes(&found.modes, &made, 1e-8);
    }
}

#[test]
fn a_mode_one_input_does_not_excite_has_no_share_of_it() {
    let mut made = set(4, 8, 2);
    made[3].participation[1] = 0.0;
    let records = decays(&made, 4000, INTERVAL);
    let found = run(&records, &Options::new(BAND, 20));
    assert_poles(&found.modes, &wanted(), 1e-10, 1e-8);
    let (silent, other) = (&found.modes[3], &found.modes[4]);
    assert!(silent.participation[1].norm() < 1e-9 && other.participation[1].norm() > 1e-3);
}

/// One input per kind of mode: translational in either direction, rotational, and the others.
#[test]
fn inputs_adapted_to_the_symmetry_find_all_kinds() {
    let mut made = set(4, 12, 4);
    let kind = [0, 1, 2, 3, 2, 3, 2, 0, 1];
    for (j, mode) in made.iter_mut().enumerate() {
        let own = kind.get(j).copied().unwrap_or(j % 4);
        mode.participation = (0..4).map(|i| f64::from(u8::from(i == own))).collect();
    }
    let mut records = decays(&made, 4000, INTERVAL);
    let found = run(&records, &Options::new(BAND, 20));
    assert_poles(&found.modes, &wanted(), 1e-10, 1e-8);
    disturb(&mut records, 1e-4, 3);
    let found = run(&records, &Options::new(BAND, 20));
    assert_poles(&found.modes, &wanted(), 5e-5, 3e-3);
    // An input whose response is rounding alone does not change the modes.
    records.push(
        decays(&made, 4000, INTERVAL)[0]
            .iter()
            .map(|x| x.iter().map(|v| v * 1e-16).collect())
            .collect(),
    );
    let found = run(&records, &Options::new(BAND, 20));
    assert_poles(&found.modes, &wanted(), 5e-5, 3e-3);
}

#[test]
fn a_single_mode_needs_one_record() {
    let made = Damped {
        frequency: 1000.0,
        damping: 0.05,
        shape: vec![-2e-6],
        participation: vec![1.0],
        phase: 0.4,
    };
    let records = decays(std::slice::from_ref(&made), 4000, INTERVAL);
    for decimation in [Decimation::Plain { stride: 1 }, Decimation::Filtered { stride: 20 }] {
        let options = Options { decimation, ..Options::new(BAND, 1) };
        let found = run(&records, &options);
        assert_eq!(found.order, 2);
        assert_poles(&found.modes, &[(1000.0, 0.05)], 1e-10, 1e-8);
        // The shape is real and positive; phase and sign are in the participation.
        let mode = &found.modes[0];
        assert!((mode.shape[0] / 2e-6 - 1.0).norm() < 1e-9);
        let phase = c64::from_polar(1.0, 0.4 + 0.5 * TAU);
        assert!((mode.participation[0] - phase).norm() < 1e-9);
        assert!((mode.frequency - mode.s.norm() / TAU).abs() < 1e-12 * mode.frequency);
    }
}

/// With one input the two modes of a repeated pole respond in a fixed combination: they cannot be separated,
/// and one mode is reported.
#[test]
fn a_repeated_pole_under_one_input_comes_out_once() {
    let made: Vec<Damped> = set(1, 17, 1).into_iter().filter(|m| m.frequency < 1200.0).collect();
    let mut records = decays(&made, 8000, INTERVAL);
    for noise in [0.0, 1e-4] {
        disturb(&mut records, noise, 9);
        let found = run(&records, &Options::new(BAND, 20));
        assert_poles(&found.modes, &[(780.0, 0.02), (1104.0, 0.02)], 1e-4, 1e-2);
        assert_eq!(found.modes[0].multiplicity, 1);
    }
}

/// Displacements of micrometres beside one force of kilonewtons.
#[test]
fn outputs_of_small_unit_do_not_drown() {
    let unit = |o: usize| if o == 0 { 1e3 } else { 1e-6 };
    let mut made = set(4, 8, 6);
    let mut records = decays(&made, 4000, INTERVAL);
    disturb(&mut records, 1e-4, 2);
    let plain = run(&records, &Options::new(BAND, 20));
    for (o, record) in records.iter_mut().flat_map(|row| row.iter_mut().enumerate()) {
        record.iter_mut().for_each(|x| *x *= unit(o));
    }
    let scaled = run(&records, &Options::new(BAND, 20));
    let poles: Vec<(f64, f64)> = plain.modes.iter().map(|m| (m.frequency, m.damping)).collect();
    assert_poles(&scaled.modes, &poles, 1e-9, 1e-7);
    for mode in &mut made {
        mode.shape.iter_mut().enumerate().for_each(|(o, x)| *x *= unit(o));
    }
    assert_shapes(&scaled.modes, &made, 1e-4);
    // Unscaled, the force output dominates, on which a repeated pole has only one shape.
    let ones = Options { scaling: Scaling::Given(vec![1.0; 8]), ..Options::new(BAND, 20) };
    let blind = run(&records, &ones);
    assert!(blind.modes.iter().all(|m| m.multiplicity == 1));
}

/// At a sampling rate of 10 kHz, 7400 Hz fold to 2600 Hz, 9800 Hz to 200 Hz and 12 800 Hz to 2800 Hz; the
/// filter removes them.
#[test]
fn what_folds_into_the_band_is_filtered_out() {
    let made = set(4, 8, 8);
    let records = decays(&made, 4000, INTERVAL);
    let stride = 20;
    let options = Options { band: (150.0, 3000.0), ..Options::new(BAND, stride) };
    let clean = run(&records, &options);
    assert_poles(&clean.modes, &wanted(), 1e-10, 1e-8);
    let plain = Options { decimation: Decimation::Plain { stride }, ..options };
    let folded = run(&records, &plain);
    assert!(folded.modes.iter().any(|m| (m.frequency - 2600.0).abs() < 50.0));
}

#[test]
fn the_same_records_give_the_same_digits() {
    let mut records = decays(&set(4, 8, 9), 4000, INTERVAL);
    disturb(&mut records, 1e-4, 1);
    let once = run(&records, &Options::new(BAND, 20));
    let again = run(&records, &Options::new(BAND, 20));
    assert_eq!(format!("{:?}", once.modes), format!("{:?}", again.modes));
}
