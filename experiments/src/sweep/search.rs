//! The search for a motion that attracts: shooting, and marching where that finds none.
//!
//! Shooting and repeating cycles find any periodic motion, stable or not. What is reported has been shown to attract:
//!
//! 1. A motion that shooting finds from the given state is taken if its Floquet multipliers are smaller than 1.
//! 2. Otherwise the set is marched from the given state as it moves by itself, off the unstable motion by a small push
//!    along the perturbation that grows. Where cycles come near to repeating after 1 to 8, shooting finds the motion
//!    that they approach.
//! 3. If that ends without one, the set is marched from rest, and from the unstable motion, pushed to either side.
//!
//! Without a derivative there are no multipliers: the march then goes on until changes from cycle to cycle have
//! been seen to fall.

use super::attraction::{Attraction, Decay};
use super::error::SweepError;
use super::march::{MOST_REPEATS, March};
use super::marching::Marching;
use super::record::Record;
use super::rest_samples::RestSamples;
use super::set_shape::SetShape;
use super::shooting::{Ahead, SMALL, Shot, multipliers_ahead, shot, shot_over};
use super::steady::{CameFrom, Steady, SteadyMethod, SteadySettings, left_of_transient};
use crate::table_growth::Outgrown;

/// Changes from cycle to cycle up to this leave no question of a transient: it would have to lose less than 1e-4
/// of itself in a cycle to be 1 % of the vibration.
const SETTLED: f64 = 1e-6;

/// Changes of the displacements of this size are rounding, relative to the vibration.
const ROUNDING: f64 = 1e-12;

/// Push of the given state along what grows about the unstable motion, of the vibration: a state of the same
/// symmetry would stay on that motion until rounding grows.
const SMALL_PUSH: f64 = 1e-3;

/// Push of the unstable motion itself.
const PUSH: f64 = 0.05;

/// Share by which the state of a set without derivative is changed to see a decay.
const CHANGE: f64 = 1e-5;

/// Cycles marched before shooting is tried again, and their least growth from one trial to the next.
const FIRST_TRIAL: usize = 8;
const LATER: f64 = 1.5;

/// Largest change over the cycles after which a march comes near to repeating at which shooting is tried.
const NEAR: f64 = 0.1;

/// Share of that change at which shooting is tried again.
const NEARER: f64 = 0.5;

/// Most periods of shooting from a march that comes near to repeating.
const MOST_PERIODS: usize = 16;

/// Largest distance of the motion that shooting finds from the march, of the vibration.
const MOST_DISTANCE: f64 = 0.3;

/// Finds a motion near the present state, which must be at the start of a mesh cycle, that repeats and attracts.
/// Where there is none, the motion after as many cycles as allowed, as what it is ([`Steady::attraction`],
/// [`Steady::repeats_after`]).
///
/// # Errors
/// If a step fails.
pub fn steady(
    set: &mut dyn Marching,
    shape: impl Into<SetShape>,
    first_planet_rad: f64,
    steps: usize,
    settings: &SteadySettings,
) -> Result<Steady, SweepError> {
    let shape = shape.into();
    let has_derivative = set.derivative().is_some();
    if settings.method == SteadyMethod::Marching || !has_derivative {
        let march = March::new(set, shape, first_planet_rad, steps);
        let found = Search { march, settings, derivatives: 0 }.until_it_repeats()?;
        let is_asked = settings.method == SteadyMethod::Marching;
        let why_marched = (!is_asked).then(|| "the model has no derivative of its steps".into());
        return Ok(Steady { why_marched, ..found });
    }
    let start = set.state();
    let (why_marched, unstable, cycles, derivatives) = match shot(
        set,
        shape,
        first_planet_rad,
        steps,
        settings,
    )? {
        Ok(found) if found.attraction != Attraction::Repels => return Ok(found.into_steady()),
        Ok(found) => {
            let largest = found.multipliers.first().map_or(0.0, |m| m.size());
            let why = format!(
                "the periodic motion that shooting found is unstable: a multiplier of size {largest:.6}"
            );
            let (cycles, derivatives) = (found.cycles, found.derivatives);
            (why, found.growing.map(|growing| (set.state(), growing)), cycles, derivatives)
        }
        Err(why) => (why.to_string(), None, 0, 0),
    };
    let mut march = March::new(set, shape, first_planet_rad, steps);
    march.cycles = cycles;
    let mut search = Search { march, settings, derivatives };
    let most = settings.most_cycles.max(2);
    search.march.set.restore(&start)?;
    if let Some((_, growing)) = &unstable {
        push(search.march.set, growing, SMALL_PUSH)?;
    }
    let mut found = search.attractor_ahead(most)?;
    if found.is_none() {
        let end = search.march.set.state();
        found = search.attractor_elsewhere(unstable, most / 2)?;
        if found.is_none() {
            search.march.set.restore(&end)?;
        }
    }
    let found = match found {
        Some(found) => found,
        None => search.without_repeat()?,
    };
    let (method, derivatives) = (SteadyMethod::Marching, search.derivatives);
    Ok(Steady { method, why_marched: Some(why_marched), derivatives, ..found })
}

/// Moves the coordinates of a set along a direction whose size is the peak-to-peak vibration.
fn push(set: &mut dyn Marching, direction: &[f64], size: f64) -> Result<(), SweepError> {
    let Some(own) = set.derivative() else { return Ok(()) };
    let y = own.coordinates();
    let pushed: Vec<f64> = y.iter().zip(direction).map(|(y, d)| y + size * d).collect();
    own.set_coordinates(&pushed)
}

/// A march to a motion that repeats.
struct Search<'m> {
    march: March<'m>,
    settings: &'m SteadySettings,
    /// Derivatives of a cycle computed.
    derivatives: usize,
}

impl Search<'_> {
    /// From rest, and from an unstable motion pushed to either side, each for at most some cycles.
    fn attractor_elsewhere(
        &mut self,
        unstable: Option<(Vec<f64>, Vec<f64>)>,
        most: usize,
    ) -> Result<Option<Steady>, SweepError> {
        let pushed = unstable.iter().flat_map(|own| [(own, PUSH), (own, -PUSH)]);
        for start in std::iter::once(None).chain(pushed.map(Some)) {
            let came_from = match start {
                None => {
                    self.march.set.rest()?;
                    CameFrom::Rest
                }
                Some(((state, growing), side)) => {
                    self.march.set.restore(state)?;
                    push(self.march.set, growing, side)?;
                    CameFrom::Unstable
                }
            };
            match self.attractor_ahead(most) {
                Ok(Some(found)) => return Ok(Some(Steady { came_from, ..found })),
                Err(error) if error.is_too_small() => return Err(error),
                // A start may lead to where no step can be taken.
                Ok(None) | Err(_) => {}
            }
        }
        Ok(None)
    }

    /// Marches on, and shoots where cycles come near to repeating; `None` if no motion that attracts was found
    /// within `most` cycles.
    fn attractor_ahead(&mut self, most: usize) -> Result<Option<Steady>, SweepError> {
        self.march.begin_anew();
        let begin = self.march.cycles;
        let until = begin + most;
        let (mut trial, mut side) = (begin + FIRST_TRIAL, SMALL_PUSH);
        let mut nearest = NEAR;
        while self.march.cycles < until {
            self.march.advance()?;
            if self.march.cycles < trial.min(until) {
                continue;
            }
            let marched = (self.march.cycles - begin) as f64;
            trial = begin + (LATER * marched).ceil() as usize;
            let (count, change) = self.march.nearest_repeat();
            if change > nearest {
                continue;
            }
            // What does not come nearer is tried once.
            nearest = NEARER * change;
            let here = self.march.set.state();
            let mut found = self.shot_near(count)?;
            // A motion that repeats after fewer cycles also solves the equations of several times as many.
            let fewer = found.as_ref().and_then(|own| own.repeats_already_after(self.settings));
            if let Some(fewer) = fewer {
                found = self.shot_near(fewer)?;
            }
            match found {
                Some(found) if found.attraction.is_shown() => {
                    let mut steady = found.into_steady();
                    steady.cycles += self.march.cycles;
                    if steady.repeats_after != Some(1) {
                        steady.rest = self.sampled_rest(&steady.record)?;
                    }
                    return Ok(Some(steady));
                }
                Some(Shot { growing: Some(growing), .. }) => {
                    self.march.set.restore(&here)?;
                    push(self.march.set, &growing, side)?;
                    side = -side;
                }
                _ => self.march.set.restore(&here)?,
            }
        }
        Ok(None)
    }

    /// The motion near the present state that repeats after so many cycles, if shooting finds one.
    fn shot_near(&mut self, count: usize) -> Result<Option<Shot>, SweepError> {
        let March { shape, first_planet_rad, steps, .. } = self.march;
        let set = &mut *self.march.set;
        let settings = SteadySettings { most_cycles: MOST_PERIODS, ..self.settings.clone() };
        let found = match count {
            1 => {
                let whole = SteadySettings { whole_cycles: true, ..settings };
                shot(set, shape, first_planet_rad, steps, &whole)?
            }
            _ => shot_over(set, shape, first_planet_rad, steps, (&settings, count))?,
        };
        self.derivatives += found.as_ref().map_or(0, |own| own.derivatives);
        Ok(found.ok().filter(|own| own.distance <= MOST_DISTANCE))
    }

    /// Marches until cycles repeat within the tolerance and the motion was shown to attract, or as long as allowed.
    fn until_it_repeats(mut self) -> Result<Steady, SweepError> {
        let SteadySettings { tolerance, most_cycles, .. } = *self.settings;
        let most = most_cycles.max(2);
        let has_derivative = self.march.set.derivative().is_some();
        // Of the changes over 1 to 8 cycles.
        let mut decays: [Decay; MOST_REPEATS] = Default::default();
        let (mut side, mut is_changed) = (SMALL_PUSH, false);
        while self.march.cycles < most {
            self.march.advance()?;
            if !has_derivative {
                for (decay, count) in decays.iter_mut().zip(1..) {
                    decay.add(self.march.change_over(count));
                }
            }
            let Some(count) = self.march.repeats_after(tolerance) else { continue };
            let recorded = self.march.last(count);
            let here = self.march.set.state();
            let March { shape, first_planet_rad, steps, .. } = self.march;
            let ahead = multipliers_ahead(self.march.set, shape, first_planet_rad, (steps, count))?;
            if ahead.is_some() {
                self.march.set.restore(&here)?;
            }
            let residual = self.march.change_over(count);
            let attraction = match &ahead {
                Some(ahead) => Attraction::by(&ahead.multipliers),
                None if decays[count - 1].is_shown(ROUNDING) => Attraction::ByDecay,
                None => Attraction::NotShown,
            };
            match (attraction, &ahead) {
                (Attraction::Repels, Some(Ahead { growing: Some(growing), .. })) => {
                    push(self.march.set, growing, side)?;
                    side = -side;
                    self.march.begin_anew();
                }
                (Attraction::NotShown, _) => {
                    if !decays[count - 1].is_visible() && !is_changed {
                        // The march began where it ends: a change of its state has to decay.
                        let counters = self.march.set.counters();
                        let mut changed = here;
                        changed.iter_mut().skip(counters).for_each(|x| *x *= 1.0 + CHANGE);
                        self.march.set.restore(&changed)?;
                        self.march.begin_anew();
                        (decays, is_changed) = (Default::default(), true);
                    }
                }
                _ => return self.repeating((recorded, count, residual), attraction, ahead),
            }
        }
        self.without_repeat()
    }

    /// A marched motion that repeats.
    fn repeating(
        mut self,
        (whole, count, residual): (Record, usize, f64),
        attraction: Attraction,
        ahead: Option<Ahead>,
    ) -> Result<Steady, SweepError> {
        let (record, watched) = match count {
            1 => (whole, None),
            _ => (whole.mean_cycle(count), Some(whole)),
        };
        let (mut multipliers, critical) = match ahead {
            Some(ahead) => (ahead.multipliers, ahead.critical),
            None => (Vec::new(), None),
        };
        let is_question = residual > SETTLED && count == 1 && !multipliers.is_empty();
        let transient = is_question.then(|| residual * left_of_transient(&multipliers));
        multipliers.retain(|m| m.size() >= SMALL);
        let cycles = self.march.cycles;
        Ok(Steady {
            method: SteadyMethod::Marching,
            why_marched: None,
            derivatives: self.derivatives,
            attraction,
            came_from: CameFrom::Given,
            multipliers,
            critical,
            cycles,
            residual,
            between: self.between()?,
            rest: self.sampled_rest(&record)?,
            transient,
            repeats_after: Some(count),
            record,
            watched,
        })
    }

    /// The motion after as many cycles as allowed, which does not repeat or was not shown to attract.
    fn without_repeat(&mut self) -> Result<Steady, SweepError> {
        self.march.begin_anew();
        let marched = self.march.cycles;
        for _ in 0..=MOST_REPEATS {
            self.march.advance()?;
        }
        let repeats_after = self.march.repeats_after(self.settings.tolerance);
        let (record, watched) = (self.march.last(1), self.march.last(MOST_REPEATS));
        let residual = self.march.change_over(1);
        Ok(Steady {
            method: SteadyMethod::Marching,
            why_marched: None,
            derivatives: self.derivatives,
            attraction: Attraction::NotShown,
            came_from: CameFrom::Given,
            multipliers: Vec::new(),
            critical: None,
            cycles: marched,
            residual,
            between: self.between()?,
            rest: self.sampled_rest(&record)?,
            transient: None,
            repeats_after,
            watched: (repeats_after != Some(1)).then_some(watched),
            record,
        })
    }

    /// Energy between harmonics over further cycles, if requested.
    fn between(&mut self) -> Result<Option<f64>, SweepError> {
        let count = self.settings.between_cycles;
        if count == 0 {
            return Ok(None);
        }
        let March { shape, first_planet_rad, steps, .. } = self.march;
        let mut further = Record::new(shape);
        further.march(self.march.set, first_planet_rad, steps * count)?;
        Ok(Some(further.between_harmonics(count)?))
    }

    /// Kinematic rest over one more cycle.
    fn sampled_rest(
        &mut self,
        record: &Record,
    ) -> Result<Option<fe_contact::statics::KinematicRest>, SweepError> {
        let March { set, steps, .. } = &mut self.march;
        if set.loaded_step().is_none() {
            return Ok(None);
        }
        let mut rest = RestSamples::new(*steps);
        for step in 0..*steps {
            set.step()?;
            rest.take(&**set, step);
        }
        Ok(rest.rest(&**set, record))
    }
}

impl Shot {
    /// Number of cycles, a divisor of those that it was found to repeat after, after which it repeats already.
    fn repeats_already_after(&self, settings: &SteadySettings) -> Option<usize> {
        let (whole, count) = (self.whole.as_ref()?, self.repeats_after);
        let same = SETTLED.max(10.0 * settings.tolerance);
        let is_enough = |fewer: &usize| {
            count.is_multiple_of(*fewer) && whole.change_after(*fewer, count) <= same
        };
        (1..count).find(is_enough)
    }

    fn into_steady(self) -> Steady {
        Steady {
            method: SteadyMethod::Shooting,
            why_marched: None,
            derivatives: self.derivatives,
            attraction: self.attraction,
            came_from: CameFrom::Given,
            rest: self.rest,
            multipliers: self.multipliers,
            critical: self.critical,
            record: self.record,
            cycles: self.cycles,
            residual: self.residual,
            between: self.between,
            transient: None,
            repeats_after: Some(self.repeats_after),
            watched: self.whole,
        }
    }
}
