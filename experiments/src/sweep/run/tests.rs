//! Runs of a model whose motion is prescribed: points that fail, tables that grow, motions that repeat after
//! several mesh cycles.

use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use fe_contact::FeError;
use scene::LoadCase;

use super::super::attraction::Attraction;
use super::super::marching::{Effort, Marching};
use super::super::plan::{Direction, Plan};
use super::super::set_shape::SetShape;
use super::super::state::{Coordinate, Line, Part};
use super::super::steady::SteadyMethod;
use super::*;

const STEPS: usize = 28;

/// What happens at a speed.
#[derive(Debug, Clone, Copy)]
enum Fate {
    /// The motion repeats after so many cycles.
    Repeats(usize),
    /// The motion never repeats.
    Wanders,
    /// Tables up to this size are outgrown.
    Outgrows(usize),
    /// Tables of size 0 are outgrown, and the motion diverges with larger ones.
    OutgrowsThenDiverges,
    /// The motion diverges in the second cycle.
    Diverges,
}

/// A model of one planet with prescribed motion.
struct Prescribed {
    fates: Vec<(f64, Fate)>,
    /// Whether the set has an equilibrium.
    rests: bool,
    started_from_rest: AtomicUsize,
}

impl Prescribed {
    fn new(fates: &[(f64, Fate)]) -> Self {
        Self { fates: fates.to_vec(), rests: true, started_from_rest: AtomicUsize::new(0) }
    }
}

struct Motion<'m> {
    model: &'m Prescribed,
    fate: Fate,
    size: usize,
    step: usize,
    /// Steps since the set was brought to a state, from which it deviates by a transient.
    since: usize,
}

fn diverged() -> SweepError {
    let body = gearset::Body::Sun;
    FeError::Diverged { time_s: 0.1, body, axis: gearset::Axis::First, value: 1e3 }.into()
}

impl Motion<'_> {
    /// Time in mesh cycles.
    fn cycles(&self) -> f64 {
        self.step as f64 / STEPS as f64
    }
}

impl Marching for Motion<'_> {
    fn rest(&mut self) -> Result<(), SweepError> {
        self.model.started_from_rest.fetch_add(1, Ordering::Relaxed);
        if self.model.rests { Ok(()) } else { Err(diverged()) }
    }

    fn step(&mut self) -> Result<(), SweepError> {
        self.step += 1;
        self.since += 1;
        match self.fate {
            Fate::Diverges if self.step > STEPS => Err(diverged()),
            Fate::OutgrowsThenDiverges if self.size > 0 => Err(diverged()),
            Fate::Outgrows(size) if self.size > size => Ok(()),
            Fate::Outgrows(_) | Fate::OutgrowsThenDiverges => {
                Err(FeError::GridOverflow { phase: 0.25, pair: 3, reach_mm: 0.1, force_n: 9e4 }
                    .into())
            }
            _ => Ok(()),
        }
    }

    fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        let turn = std::f64::consts::TAU * self.cycles();
        let slow = match self.fate {
            Fate::Repeats(period) if period > 1 => (turn / period as f64).sin(),
            Fate::Wanders => (turn / std::f64::consts::SQRT_2).sin(),
            _ => 0.0,
        };
        let transient = 1e-6 * 0.2f64.powf(self.since as f64 / STEPS as f64);
        let x = 3e-6 * turn.cos() + 1e-6 * slow + transient;
        ([[0.0; 3], [0.0; 3], [x, 4e-6 * turn.sin(), 1e-5 * x]], vec![[x, 0.0, 0.0]])
    }

    /// The sun mesh parts in the second half of every other cycle, and then presses backwards in its last
    /// quarter.
    fn mesh_forces(&self, out: &mut Vec<f64>) {
        let within = self.step % (2 * STEPS);
        let sun_mesh = if within >= STEPS + STEPS / 2 { 0.0 } else { 100.0 };
        let behind = if within >= STEPS + 3 * STEPS / 4 { 50.0 } else { 0.0 };
        out.clear();
        out.extend([sun_mesh, 80.0, behind, 0.0]);
    }

    fn effort(&self) -> Effort {
        Effort { coordinates: 12, solutions: 1.0 }
    }

    fn state(&mut self) -> Vec<f64> {
        vec![self.step as f64]
    }

    fn counters(&self) -> usize {
        1
    }

    fn restore(&mut self, state: &[f64]) -> Result<(), SweepError> {
        self.since = 0;
        // Divergence is timed from the start of a point.
        self.step = if matches!(self.fate, Fate::Diverges) { 0 } else { state[0] as usize };
        Ok(())
    }
}

impl SweepModel for Prescribed {
    fn name(&self) -> String {
        "prescribed".into()
    }

    fn case(&self) -> LoadCase {
        LoadCase::turning(1130.0, 100.0, 50.0)
    }

    fn shape(&self) -> SetShape {
        1.into()
    }

    fn first_planet_rad(&self) -> f64 {
        0.0
    }

    fn steps_per_cycle(&self) -> usize {
        STEPS
    }

    fn turning_damped(
        &self,
        case: &LoadCase,
        _: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        let own = self.fates.iter().find(|(speed, _)| *speed == case.speed_rpm);
        let fate = own.map_or(Fate::Repeats(1), |(_, fate)| *fate);
        Ok(Box::new(Motion { model: self, fate, size, step: 0, since: 0 }))
    }
}

fn plan(speeds: &[f64]) -> Plan {
    let steady = SteadySettings {
        method: SteadyMethod::Shooting,
        tolerance: 1e-9,
        most_cycles: 60,
        harmonics: 2,
        between_cycles: 0,
        whole_cycles: false,
        keeps_steps: false,
    };
    Plan::new(speeds, &[Direction::Up], steady).unwrap()
}

#[test]
fn a_speed_that_fails_is_recorded_and_its_chain_goes_on() {
    for (failing, rests) in [(100.0, 2), (200.0, 1), (300.0, 1)] {
        let model = Prescribed::new(&[(failing, Fate::Diverges)]);
        let sweep = run(&model, &plan(&[100.0, 200.0, 300.0]), &Memory, &|_| ()).unwrap();
        assert_eq!(sweep.points().len(), 2);
        let [failed] = &sweep.failed[..] else { panic!("{:?}", sweep.failed) };
        assert_eq!((failed.case.speed_rpm, failed.chain.as_str()), (failing, "up_00"));
        assert!(failed.reason.contains("the motion diverges"), "{}", failed.reason);
        let typed = failed.error.as_deref();
        assert!(matches!(typed, Some(SweepError::Fe(FeError::Diverged { .. }))));
        // Only a chain without any point before the failed one starts from rest again.
        assert_eq!(model.started_from_rest.load(Ordering::Relaxed), rests);
        let error = sweep.complete().unwrap_err();
        assert!(error.to_string().contains(&format!("at {failing} rpm: the motion diverges")));
    }
}

#[test]
fn a_set_without_equilibrium_ends_the_sweep() {
    let model = Prescribed { rests: false, ..Prescribed::new(&[]) };
    let found = run(&model, &plan(&[100.0, 200.0]), &Memory, &|_| ());
    assert!(matches!(found, Err(SweepError::Fe(FeError::Diverged { .. }))));
}

#[test]
fn tables_grow_at_a_speed_up_to_their_limit_and_then_the_speed_fails() {
    let fates = [(200.0, Fate::Outgrows(1)), (300.0, Fate::Outgrows(99))];
    let model = Prescribed::new(&fates);
    let sweep = run(&model, &plan(&[100.0, 200.0, 300.0, 400.0]), &Memory, &|_| ()).unwrap();
    let sizes: Vec<usize> = sweep.points().iter().map(|p| p.size).collect();
    assert_eq!(sizes, [0, 2, 0]);
    let [failed] = &sweep.failed[..] else { panic!("{:?}", sweep.failed) };
    assert_eq!(failed.case.speed_rpm, 300.0);
    for words in [
        "pair 3",
        "it does so on contact tables made for up to 16 times the load",
        "a smaller torque",
    ] {
        assert!(failed.reason.contains(words), "{}", failed.reason);
    }
}

#[test]
fn the_number_of_cycles_after_which_a_motion_repeats_is_found() {
    for (fate, expected) in [
        (Fate::Repeats(1), Some(1)),
        (Fate::Repeats(2), Some(2)),
        (Fate::Repeats(3), Some(3)),
        (Fate::Repeats(8), Some(8)),
        (Fate::Repeats(9), None),
        (Fate::Wanders, None),
    ] {
        let model = Prescribed::new(&[(100.0, fate)]);
        let sweep = run(&model, &plan(&[100.0]), &Memory, &|_| ()).unwrap();
        let point = sweep.points()[0];
        assert_eq!(point.repeats_after, expected, "{fate:?}");
        assert_eq!(point.is_steady, expected == Some(1), "{fate:?}");
        let shown = expected.map_or(Attraction::NotShown, |_| Attraction::ByDecay);
        assert_eq!(point.attracts, shown, "{fate:?}");
    }
}

#[test]
fn contact_is_watched_over_a_whole_period() {
    let model = Prescribed::new(&[(100.0, Fate::Repeats(2))]);
    let sweep = run(&model, &plan(&[100.0]), &Memory, &|_| ()).unwrap();
    let point = sweep.points()[0];
    let of = |part, coordinate| point.state.line(part, coordinate, 0).unwrap().amplitude;
    assert_eq!((point.lowest_force_n, point.contact_loss), (0.0, 0.25));
    assert_eq!(point.backside_contact, Some(0.125));
    assert_eq!(of(Part::SunMesh(0), Coordinate::BacksideContact), 0.125);
    assert_eq!(of(Part::RingMesh(0), Coordinate::BacksideContact), 0.0);
    assert_eq!(of(Part::RingMesh(0), Coordinate::LowestForce), 80.0);
    // In the table a translation stands beside its components.
    let lines = point.state.with_translations();
    let row = |coordinate: &str| {
        let is_it =
            |l: &&Line| (l.part, l.coordinate.name(), l.harmonic) == (Part::SUN, coordinate, 1);
        lines.iter().find(is_it).unwrap().amplitude
    };
    let (radial, tangential) = (row("radial"), row("tangential"));
    assert!(radial > 1e-7 && tangential > 1e-7);
    assert_eq!(row("translation"), radial.hypot(tangential));
    assert!(
        !lines
            .iter()
            .any(|l| l.coordinate == Coordinate::Translation && l.part.name().contains("mesh"))
    );
}

#[test]
fn larger_tables_that_fail_otherwise_are_told_from_outgrown_ones() {
    let model = Prescribed::new(&[(100.0, Fate::OutgrowsThenDiverges)]);
    let sweep = run(&model, &plan(&[100.0]), &Memory, &|_| ()).unwrap();
    let reason = &sweep.failed[0].reason;
    for words in ["pair 3", "made for 2 times the load fail too: the motion diverges"] {
        assert!(reason.contains(words), "{reason}");
    }
    assert!(!reason.contains("16 times"), "{reason}");
}

/// Keeps points as text, as a store on disk does.
#[derive(Default)]
struct Texts(Mutex<HashMap<(String, usize), String>>);

impl PointStore for Texts {
    fn load(&self, chain: &Chain, index: usize) -> Result<Option<Kept>, StoreError> {
        let texts = self.0.lock().unwrap();
        Ok(texts.get(&(chain.name.clone(), index)).map(|text| serde_json::from_str(text).unwrap()))
    }

    fn save(&self, chain: &Chain, index: usize, kept: &Kept) -> Result<(), StoreError> {
        let text = serde_json::to_string(kept).unwrap();
        self.0.lock().unwrap().insert((chain.name.clone(), index), text);
        Ok(())
    }
}

#[test]
fn a_failure_is_stored_as_a_finished_point() {
    let (failing, plan) = ([(200.0, Fate::Diverges)], plan(&[100.0, 200.0, 300.0]));
    let store = Texts::default();
    let first = run(&Prescribed::new(&failing), &plan, &store, &|_| ()).unwrap();
    // Nothing is computed again, so that another fate of that speed does not matter.
    let heard = AtomicUsize::new(0);
    let count = |_: &Kept| {
        heard.fetch_add(1, Ordering::Relaxed);
    };
    let again = run(&Prescribed::new(&[]), &plan, &store, &count).unwrap();
    assert_eq!((again.failed.len(), &again), (1, &first));
    assert!(again.failed[0].error.is_none());
    assert_eq!(heard.into_inner(), 3);
}

#[test]
fn points_come_by_speed_and_then_by_chain() {
    let model = Prescribed::new(&[]);
    let settings = plan(&[1.0]).steady;
    let both = [Direction::Up, Direction::Down];
    let plan = Plan::new(&[100.0, 200.0], &both, settings).unwrap();
    let mut sweep = run(&model, &plan, &Memory, &|_| ()).unwrap();
    let around = Plan::around(&[150.0], 0.1, 2, plan.steady.clone());
    sweep.extend(run(&model, &around, &Memory, &|_| ()).unwrap());
    let order: Vec<(&str, f64)> =
        sweep.by_speed().iter().map(|(chain, p)| (*chain, p.state.case.speed_rpm)).collect();
    let chains = ["up_00", "down_00", "peak_00", "peak_00", "up_00", "down_00"];
    assert_eq!(order.iter().map(|(chain, _)| *chain).collect::<Vec<_>>(), chains);
    assert!(order.is_sorted_by(|a, b| a.1 <= b.1));
}
