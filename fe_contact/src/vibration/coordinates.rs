//! The coordinates that determine the motion of a set after a whole number of mesh cycles.

use nalgebra::DVector;

use super::checkpoint::replace;
use super::set::VibratingSet;
use super::tooth_shift::ToothShift;
use crate::error::FeError;

impl VibratingSet<'_> {
    /// Whether [`VibratingSet::cycle_derivative`] gives a derivative: not where kinematics are exact at every step,
    /// where bodies have every degree of freedom, or where tooth errors let no cycle repeat.
    pub fn has_derivative(&self) -> bool {
        self.contact.grid.is_none()
            && !self.statics.has_tooth_errors()
            && self.bodies.all().all(|(_, body)| body.modal().is_some())
    }

    /// Coordinates that determine the motion after a whole number of mesh cycles: displacements, velocities and
    /// accelerations of the races, of the bodies' modes, and the state of the lag.
    pub fn coordinates(&mut self) -> Vec<f64> {
        let mut out = Vec::new();
        self.visit_coordinates(&mut |list| out.extend_from_slice(list));
        out
    }

    /// Continues from other coordinates at the start of the mesh cycle in which the set is, wherever in it a step
    /// failed; bearings follow.
    ///
    /// # Errors
    /// If they are too few or too many, or not finite.
    pub fn set_coordinates(&mut self, y: &[f64]) -> Result<(), FeError> {
        replace(y, &mut |each| self.visit_coordinates(each))?;
        self.clock.step_in_cycle = 0;
        self.follow_bearings();
        Ok(())
    }

    /// Sets the bearings to what follows from races and carrier.
    pub(super) fn follow_bearings(&mut self) {
        let race = self.race_dynamics.motion.clone();
        let carrier = self.bodies.carrier.elastic_mut().clone();
        let bearings = &mut self.race_dynamics.bearings;
        bearings.follow(&race, self.bodies.carrier.as_ref(), &carrier);
    }

    pub(super) fn visit_coordinates(&mut self, each: &mut dyn FnMut(&mut [f64])) {
        let mut motion = |motion: &mut dynamics::Motion| {
            each(&mut motion.x);
            each(&mut motion.v);
            each(&mut motion.a);
        };
        motion(&mut self.race_dynamics.motion);
        motion(self.bodies.carrier.elastic_mut());
        for gear in &mut self.bodies.gears {
            motion(gear.vibrating.elastic_mut());
        }
        for memory in &mut self.pairs.memory {
            for list in memory.lists() {
                each(list);
            }
        }
    }

    /// Displacements of carrier, ring, sun (x, y, m; θ, rad) and of the planets (ζ, η, θ) in coordinates `y`.
    pub fn displacements_of(&self, y: &[f64]) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        let n = self.statics.races.count.min(y.len());
        self.statics.displacements(&DVector::from_column_slice(&y[..n]))
    }

    /// After a whole cycle, or a part of it after which the set is itself by its [`Symmetry`](gearset::Symmetry), if
    /// that was asked for: takes it back, with the bodies' modes turned by one tooth or the planets renumbered, so that
    /// the state can be compared with that at the start.
    ///
    /// # Errors
    /// If a body's modes are not those of equal teeth.
    pub fn take_cycle_back(&mut self) -> Result<(), FeError> {
        if self.clock.step_in_cycle > 0 {
            return self.take_part_back();
        }
        self.clock.cycles -= self.clock.rotation.direction().whole();
        if self.bodies.gears.iter().all(|gear| gear.vibrating.unknowns() == 0) {
            return Ok(());
        }
        let shifts = self.tooth_shifts()?.to_vec();
        for (gear, shift) in self.bodies.gears.iter_mut().zip(shifts.iter().skip(1)) {
            if let Some(shift) = shift {
                shift.apply(gear.vibrating.elastic_mut());
            }
        }
        Ok(())
    }

    /// Shift of the bodies' modes by one tooth, by body.
    pub(super) fn tooth_shifts(&mut self) -> Result<&[Option<ToothShift>], FeError> {
        if self.tooth_shifts.is_empty() {
            self.tooth_shifts = ToothShift::of_set(&self.bodies, self.clock.rotation.direction())?;
        }
        Ok(&self.tooth_shifts)
    }
}
