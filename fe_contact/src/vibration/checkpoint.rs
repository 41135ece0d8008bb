//! The state of a set between two mesh cycles as plain numbers, from which it continues with the
//! same results.

use dynamics::Motion;

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

    /// Continues from a state of a set of the same scene and fidelity, at this set's own speed.
    ///
    /// # Errors
    /// If the state is that of another kind of set.
    pub fn restore(&mut self, state: &[f64]) -> Result<(), FeError> {
        let mut expected = 1;
        self.visit(&mut |list| expected += list.len());
        if state.len() != expected || !state.iter().all(|x| x.is_finite()) {
            return Err(FeError::Unfit {
                key: "state".into(),
                value: format!("{} numbers", state.len()),
                allowed: format!("{expected} finite numbers"),
                why: "a set goes on from a state of the same scene and fidelity only".into(),
            });
        }
        self.clock.cycles = state[0] as i64;
        let mut rest = &state[1..];
        self.visit(&mut |list| {
            let (own, others) = rest.split_at(list.len());
            list.copy_from_slice(own);
            rest = others;
        });
        Ok(())
    }

    fn visit(&mut self, each: &mut dyn FnMut(&mut [f64])) {
        let mut motion = |motion: &mut Motion| {
            each(&mut motion.x);
            each(&mut motion.v);
            each(&mut motion.a);
        };
        motion(&mut self.race_dynamics.motion);
        motion(&mut self.race_dynamics.bearings.state);
        motion(self.bodies.carrier.elastic_mut());
        for gear in &mut self.bodies.gears {
            motion(gear.vibrating.elastic_mut());
        }
        for memory in &mut self.pairs.memory {
            for list in memory.lists() {
                each(list);
            }
        }
        each(self.external.as_mut_slice());
    }
}
