//! What the coarsest candidate for an amplitude shows of the errors of all candidates. `docs/auto.md` derives the estimates.

use std::f64::consts::TAU;

use super::amplitude::AmplitudeRequest;
use super::amplitude_meshes::{of_elements, unevenness};
use super::amplitude_run::{Motions, Turning};
use super::elastic_response::{MATTERS, elastic_response};
use super::energy::ModeEnergy;
use super::error_parts::SetSize;
use super::response::{Harmonics, mode_type, name};
use crate::error::ExperimentError;

/// Numbers of steps are compared with one in so many of those of the coarsest candidate, which has the tables.
const EVERY: u32 = 2;

/// Formal order at which amplitudes converge with the steps; where a candidate moves by more than that explains, its own
/// change from the coarsest decides.
const STEP_ORDER: f64 = 2.0;

/// Factor on differences of two meshes and of two numbers of steps (grid convergence: Roache 1994).
const SAFETY: f64 = 1.25;

/// Largest shift of natural frequencies up to which a shift of the speed stands for it.
const LARGEST_SHIFT: f64 = 0.05;

/// Smallest amplitude over that of the whole motion of the sun: what planet phasing forbids is below it.
const FORBIDDEN: f64 = 1e-7;

/// Largest amplification by a mode by which the motion is taken to be larger than the excitation, of [`Excited::excitation`].
const MOST_AMPLIFIED: f64 = 20.0;

/// Share of what the correction for the frequency of the time steps moves a response by that it may still be off by, where few steps and more of
/// them agree by chance: it is of first order (`docs/auto.md`).
const OF_CORRECTION: f64 = 0.05;

/// Share of the first-order change of a response by the inertia of the bodies that an amplitude with this change may still be off by:
/// seen on development sets (`docs/auto.md`).
const OF_CHANGE: f64 = 0.25;

/// What the coarsest candidate shows.
pub(super) struct Indicators {
    pub(super) motions: Motions,
    /// Number of its mesh.
    pub(super) mesh: usize,
    top: Harmonics,
    /// Relative change of the amplitude for a relative change of the mesh stiffness.
    by_stiffness: f64,
    /// Deflection of a mesh of teeth over the excitation.
    deflection: f64,
    of_steps: f64,
    /// Part of the inertia that is left out: the bound, or what replaced it; infinite where nothing is known.
    pub(super) inertia: f64,
    /// Amplitude with the first-order change by the inertia over that without it, where that leaves less than the bound.
    pub(super) with_inertia: Option<f64>,
    /// Whether the bound stands because nothing was asked yet.
    is_bound: bool,
    first_mode_hz: f64,
}

impl Indicators {
    /// Runs the coarsest candidate, then at the speed of its largest amplitude half of its steps, and other speeds.
    ///
    /// # Errors
    /// If a motion does not become steady, or planet phasing forbids the response.
    pub(super) fn new(
        turning: &Turning<'_>,
        (size, mesh): (&SetSize, usize),
        request: &AmplitudeRequest,
    ) -> Result<Self, ExperimentError> {
        let motions = turning.motions(&request.speeds_rpm)?;
        let all = motions.of_sun(turning);
        // NaN is refused.
        let is_allowed = motions.largest() > FORBIDDEN * all;
        if !is_allowed {
            let highest = request.steady.harmonics;
            let why = format!(
                "planet phasing forbids the {} in harmonics 1 to {highest}: its amplitude is rounding",
                name(request.response)
            );
            return Err(ExperimentError::Model(why.into()));
        }
        let (top_rpm, top) =
            motions.top().cloned().ok_or(ExperimentError::Incomplete("steady state"))?;
        let modes = &turning.at_rest()?.energies;
        let excited = Excited::new(turning, size, modes, (top_rpm, &top))?;
        // Motions at other speeds tell what a shift changes, which steps change little.
        let in_steps =
            motions.in_steps(top_rpm).ok_or(ExperimentError::Incomplete("steady state"))?;
        let changed = |by: f64| -> Result<f64, ExperimentError> {
            let off = |factor: f64| -> Result<f64, ExperimentError> {
                let other = turning.motions_in_steps(&[factor * top_rpm])?.largest();
                Ok((other / in_steps.rms() - 1.0).abs())
            };
            Ok(off(1.0 + by)?.max(off(1.0 - by)?))
        };
        // δf/f = ½ e δk/k shifts a resonance as if the speed were shifted; the excitation changes as the flexibility.
        let shift = 0.5 * excited.meshes * of_elements(mesh);
        let by_shift = if shift > 0.0 { changed(shift)? / of_elements(mesh) } else { 0.0 };
        let inertia = match excited.shift <= LARGEST_SHIFT {
            true => {
                let passing = excited.passing / motions.largest();
                changed(excited.shift)? + 2.0 * excited.shift + passing
            }
            false => f64::INFINITY,
        };
        let fewer = turning.thinned(EVERY, |own| own.motions(&[top_rpm]))?;
        let by_steps = SAFETY * motions.moved(&fewer) / (f64::from(EVERY).powf(STEP_ORDER) - 1.0);
        let deflection = size.deflection() / (excited.excitation * motions.largest());
        Ok(Self {
            mesh,
            top,
            by_stiffness: 1.0 + by_shift,
            deflection,
            of_steps: by_steps.max(OF_CORRECTION * motions.apart_by_correction()),
            inertia,
            with_inertia: None,
            is_bound: true,
            first_mode_hz: size.first_mode_hz(),
            motions,
        })
    }

    /// Elements and cells of a mesh, the mean stiffness by elements alone: where the edge of a patch lies among its cells changes from step
    /// to step and from mesh to mesh, and leaves no more than a part of the unevenness.
    pub(super) fn of_mesh(&self, mesh: usize) -> f64 {
        (self.by_stiffness * of_elements(mesh)).hypot(unevenness(mesh) * self.deflection)
    }

    /// The same of a candidate that was run: where it differs from the coarsest by more than both estimates and the steps
    /// explain, what is left over counts, as the unevenness does on both.
    pub(super) fn of_mesh_seen(&self, mesh: usize, motions: &Motions) -> f64 {
        let own = self.of_mesh(mesh);
        if mesh == self.mesh {
            return own;
        }
        let seen = (motions.largest() / self.motions.largest() - 1.0).abs();
        let explained = self.of_mesh(self.mesh) + own + self.of_steps;
        let ratio = unevenness(mesh) / unevenness(self.mesh);
        own + SAFETY * (seen - explained).max(0.0) * ratio
    }

    /// Steps: by the formal order with each doubling.
    pub(super) fn of_steps(&self, doubled: u32) -> f64 {
        self.of_steps * 2f64.powf(-STEP_ORDER * f64::from(doubled))
    }

    /// [`of_steps`](Self::of_steps) of a candidate that was run: at least what its own change from the coarsest candidate says,
    /// less what the meshes explain of it.
    pub(super) fn of_steps_seen(&self, (mesh, doubled): (usize, u32), motions: &Motions) -> f64 {
        if doubled == 0 {
            return self.of_steps;
        }
        let explained = if mesh == self.mesh { 0.0 } else { self.of_mesh(self.mesh) };
        let moved = self.motions.moved(motions);
        let ratio = 2f64.powf(STEP_ORDER * f64::from(doubled));
        self.of_steps(doubled).max(SAFETY * (moved - explained).max(0.0) / (ratio - 1.0))
    }

    /// Takes what the inertia that is left out changes to first order into the amplitude, and replaces its bound by what this leaves if that is
    /// less, once.
    ///
    /// # Errors
    /// If the motion does not become steady again.
    pub(super) fn replace_bound(&mut self, turning: &Turning<'_>) -> Result<(), ExperimentError> {
        if !std::mem::replace(&mut self.is_bound, false) {
            return Ok(());
        }
        let size = self.top.rms();
        if let Some(found) = elastic_response(turning, &self.motions)? {
            let left = OF_CHANGE * found.rms() / size;
            // A change of phase at a resonance is larger than that of the amplitude, and its second order no longer small.
            if left < self.inertia {
                self.inertia = left;
                self.with_inertia = Some(found.growth());
            }
        }
        Ok(())
    }

    /// Why the inertia that is left out has no estimate.
    pub(super) fn why_no_bound(&self) -> String {
        format!(
            "a harmonic that matters is above the first mode of a body that is left out, about {:.0} Hz, or the teeth of a \
             gear are not meshed alike",
            self.first_mode_hz
        )
    }
}

/// The modes by which the harmonics of a response are excited: means over harmonics, weighted with their shares of the mean
/// square.
struct Excited {
    /// What the inertia that is left out may shift natural frequencies by (share).
    shift: f64,
    /// Share of strain energy in meshes.
    meshes: f64,
    /// Excitation over the motion: √(Σ s_l min(1, |1 − (l f_m/f)²|)²) for shares s_l of the mean square.
    excitation: f64,
    /// What teeth that pass through mesh change of the root mean square by their inertia, m, at most:
    /// Σ √s_l x_l/min(1, |1 − (l f_m/f)²|).
    passing: f64,
}

impl Excited {
    /// Of each harmonic l that matters the nearest mode of the kind that moves it; the bound at the higher of
    /// its frequency and l f_m.
    fn new(
        turning: &Turning<'_>,
        size: &SetSize,
        modes: &[ModeEnergy],
        (rpm, top): (f64, &Harmonics),
    ) -> Result<Self, ExperimentError> {
        let kind = mode_type(turning.response());
        let f_m = turning.mesh_hz(rpm);
        let mut own = Self { shift: 0.0, meshes: 0.0, excitation: 0.0, passing: 0.0 };
        for (share, l) in top.shares().into_iter().zip(1u32..).filter(|(share, _)| *share > MATTERS)
        {
            let f = f64::from(l) * f_m;
            let distance = |mode: &&ModeEnergy| (mode.frequency_hz / f).ln().abs();
            let nearest = modes
                .iter()
                .filter(|mode| mode.mode_type == kind)
                .min_by(|a, b| distance(a).total_cmp(&distance(b)))
                .ok_or(ExperimentError::Incomplete("mode that moves the response"))?;
            own.meshes += share * nearest.meshes;
            let apart = (1.0 - (f / nearest.frequency_hz).powi(2)).abs();
            let apart = apart.clamp(1.0 / MOST_AMPLIFIED, 1.0);
            own.excitation += share * apart.powi(2);
            own.passing += share.sqrt() * size.of_passing_teeth(l, TAU * f) / apart;
            let mut raised = nearest.clone();
            raised.frequency_hz = raised.frequency_hz.max(f);
            own.shift += share * size.body_inertia(&raised);
        }
        Ok(Self { excitation: own.excitation.sqrt(), ..own })
    }
}
