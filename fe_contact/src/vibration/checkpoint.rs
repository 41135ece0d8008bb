//! The state of a set between two mesh cycles as plain numbers, from which it continues with the
//! same results.

use super::set::VibratingSet;
use crate::error::FeError;

impl VibratingSet<'_> {
    /// Everything the next step starts from: races, bearings, bodies, forces of the tooth pairs. To
    /// be taken after whole mesh cycles. Contact maps and frames are left out, since they can be
    /// computed again.
    pub fn state(&mut self) -> Vec<f64> {
        let mut out = vec![self.clock.cycles as f64];
        self.visit(&mut |list| out.extend_from_slice(list));
        out
    }

    /// Continues from a state of a set of the same scene and fidelity, at this set's own speed and at the start of a
    /// mesh cycle.
    ///
    /// # Errors
    /// If the state is that of another kind of set.
    pub fn restore(&mut self, state: &[f64]) -> Result<(), FeError> {
        let (cycles, rest) = state.split_first().unwrap_or((&f64::NAN, state));
        let cycles = *cycles;
        if !cycles.is_finite() {
            return Err(foreign(state.len(), "finite numbers"));
        }
        replace(rest, &mut |each| self.visit(each))?;
        (self.clock.step_in_cycle, self.clock.cycles) = (0, cycles as i64);
        Ok(())
    }

    fn visit(&mut self, each: &mut dyn FnMut(&mut [f64])) {
        self.visit_coordinates(each);
        let bearings = &mut self.race_dynamics.bearings.state;
        each(&mut bearings.x);
        each(&mut bearings.v);
        each(&mut bearings.a);
        each(self.external.as_mut_slice());
    }
}

/// Shows lists of numbers, in a fixed order, to what is given.
pub(super) type Visit<'v> = dyn FnMut(&mut dyn FnMut(&mut [f64])) + 'v;

/// Replaces the lists that `visit` shows by numbers in the same order.
///
/// # Errors
/// If these are too few or too many, or not finite; nothing is changed then.
pub(super) fn replace(numbers: &[f64], visit: &mut Visit<'_>) -> Result<(), FeError> {
    let mut expected = 0;
    visit(&mut |list| expected += list.len());
    if numbers.len() != expected || !numbers.iter().all(|x| x.is_finite()) {
        return Err(foreign(numbers.len(), &format!("{expected} finite numbers")));
    }
    let mut rest = numbers;
    visit(&mut |list| {
        let (own, others) = rest.split_at(list.len());
        list.copy_from_slice(own);
        rest = others;
    });
    Ok(())
}

fn foreign(count: usize, allowed: &str) -> FeError {
    FeError::Unfit {
        key: "state".into(),
        value: format!("{count} numbers"),
        allowed: allowed.into(),
        why: "a set goes on from a state of the same scene and fidelity only".into(),
    }
}
