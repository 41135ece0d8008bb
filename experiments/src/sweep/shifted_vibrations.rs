//! What the inertia of the bodies behind the teeth, which quasi-static bodies lack, may change of a steady state.
//!
//! The inertia of elastic displacements moves a natural frequency ω of the set by c, in closed form
//! ([`AnalyticSet::inertia_change`]). Near the first mode of a body with its race held nothing is known of it.

use std::f64::consts::TAU;

use dynamics::c64;
use lumped::{AnalyticSet, ModeType};
use scene::{LoadCase, Scene};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::resolved_steps::{Vibrations, strong_harmonics};
use super::state::{Coordinate, SteadyState};
use crate::modal::{SLOW, majority};

/// Largest part of an amplitude that inertia may change without a word.
const MOST_CHANGED: f64 = 0.05;

/// What the inertia of the bodies behind the teeth may change of an amplitude.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct InertiaError {
    /// Harmonic of the mesh frequency.
    pub harmonic: usize,
    /// Natural frequency of the set that is near it or, where no share is known, that of a body with its race held, Hz.
    pub natural_hz: f64,
    /// Change of the amplitude if that vibration alone made it, share; absent where the harmonic is above 0.7 of the
    /// first frequency of a body.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub share: Option<f64>,
}

/// Natural frequencies of a set with what inertia changes of each.
#[derive(Debug, Clone, PartialEq)]
pub struct ShiftedVibrations {
    /// Type, ω (rad/s) and c (share of it).
    modes: Vec<(ModeType, f64, f64)>,
    /// λ_1 of the bodies, (rad/s)².
    first: f64,
}

impl ShiftedVibrations {
    /// Of a scene under its load; `None` where the closed forms do not hold.
    pub(super) fn of(scene: &Scene, case: &LoadCase) -> Option<Self> {
        let set = AnalyticSet::new(scene, case, 0.0).ok()?;
        let first = set.first_of_bodies();
        let groups = set.modes().ok()?.groups;
        let known = groups.iter().filter(|group| group.lambda <= SLOW * first);
        let mode = |group: &lumped::ModeGroup| {
            (majority(&group.participation), group.lambda.sqrt(), set.inertia_change(group))
        };
        Some(Self { modes: known.map(mode).collect(), first })
    }

    /// The most that inertia may change of a strong motion of the sun in any harmonic up to `highest`, by a vibration
    /// of the kind that moves it, each with the decay rate of the one of the set that is nearest in frequency; `None`
    /// up to 5 %.
    ///
    /// `[eq:shifted-vibration]` A vibration of the decay rate δ answers a force at Ω = 2π l f_m with
    /// |ω² + δ² − Ω² + 2iδΩ| / |(1 + c)² ω² + δ² − Ω² + 2iδΩ| of its amplitude.
    /// Source: derived here (one degree of freedom).
    /// Checked by: `experiments/tests/inertia_guard.rs`.
    pub(super) fn error(
        &self,
        state: &SteadyState,
        vibrations: &Vibrations,
        highest: usize,
    ) -> Option<InertiaError> {
        let mesh_hz = state.case.mesh_frequency_hz;
        let kinds = [
            (Coordinate::Rotation, ModeType::Rotational),
            (Coordinate::Translation, ModeType::Translational),
        ];
        let strong = kinds.iter().flat_map(|(coordinate, mode_type)| {
            let list = strong_harmonics(state, *coordinate, highest);
            list.into_iter().map(move |harmonic| (harmonic, *mode_type))
        });
        let strong: Vec<(usize, ModeType)> = strong.collect();
        let force = |harmonic: usize| TAU * mesh_hz * harmonic as f64;
        let fast = strong.iter().find(|(l, _)| force(*l).powi(2) > SLOW * self.first);
        if let Some((harmonic, _)) = fast {
            let natural_hz = self.first.sqrt() / TAU;
            return Some(InertiaError { harmonic: *harmonic, natural_hz, share: None });
        }
        let errors = strong.iter().flat_map(|(harmonic, mode_type)| {
            let own = self.modes.iter().filter(move |(of, ..)| of == mode_type);
            own.map(|(_, omega, change)| {
                let (at, decay) = (force(*harmonic), vibrations.decay_near(*omega));
                let stiffness = |omega: f64| {
                    c64::new(omega * omega + decay * decay - at * at, 2.0 * decay * at).norm()
                };
                let share = (stiffness(*omega) / stiffness((1.0 + change) * omega) - 1.0).abs();
                (
                    share,
                    InertiaError {
                        harmonic: *harmonic,
                        natural_hz: omega / TAU,
                        share: Some(share),
                    },
                )
            })
        });
        let (share, largest) = errors.max_by(|a, b| a.0.total_cmp(&b.0))?;
        (share > MOST_CHANGED).then_some(largest)
    }
}
