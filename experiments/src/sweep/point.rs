//! One speed of a sweep: what the steady state gives.

use dynamics::Multiplier;
use gearset::Body;
use scene::LoadCase;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::attraction::{Attraction, multiplier_kind};
use super::critical_motion::CriticalMotion;
use super::error::SweepError;
use super::shifted_vibrations::InertiaError;
use super::shooting::SMALL;
use super::state::{Coordinate, Line, Part, SteadyState};
use super::steady::{CameFrom, Steady, SteadyMethod};

/// A motion of which more than this part may be transient is not steady.
const MOST_TRANSIENT: f64 = 0.01;

/// Where the search for a motion began.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SearchStart {
    /// The static equilibrium at position 0 of the mesh cycle.
    #[default]
    Rest,
    /// The state after the motion at another speed of the chain, rpm.
    Speed(f64),
    /// An unstable periodic motion at this speed, pushed along the perturbation that grows.
    Unstable,
    /// The random start of this number: rest, pushed in a direction and by a size that the number alone decides.
    Random(u32),
}

impl std::fmt::Display for SearchStart {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Rest => f.write_str("rest"),
            Self::Speed(rpm) => write!(f, "{rpm} rpm"),
            Self::Unstable => f.write_str("unstable motion, pushed"),
            Self::Random(number) => write!(f, "random start {number}"),
        }
    }
}

/// What the length of the steps may change of an amplitude.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StepError {
    /// Harmonic of the mesh frequency.
    pub harmonic: usize,
    /// Natural frequency near which it is, Hz.
    pub natural_hz: f64,
    /// Change of the amplitude if that vibration alone made it, share.
    pub share: f64,
    /// Steps in a mesh cycle with which it would be 1 %.
    pub steps: usize,
}

/// What Floquet multipliers are those of.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MultipliersOf {
    /// The time steps.
    #[default]
    Steps,
    /// The vibrations of the set about its mean mesh stiffness, e^{(−δ ± iω)T}: at low speeds, where these decay
    /// within a mesh cycle and the time steps are longer than their periods.
    Vibrations,
}

/// The Floquet multiplier of largest size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LargestMultiplier {
    /// |μ| of one period.
    pub size: f64,
    /// How stability is lost where it leaves the unit circle: `fold` (μ > 0), `period_doubling` (μ < 0) or
    /// `neimark_sacker` (complex).
    pub kind: String,
    /// Type of the motion that it multiplies: rotational, translational, planet or mixed; absent for sets of fewer
    /// than three planets.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub mode_type: Option<String>,
}

/// A steady state, and how it was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SweepPoint {
    /// Harmonics of everything, with speed and load.
    #[serde(flatten)]
    pub state: SteadyState,
    /// How the steady state was found.
    pub method: SteadyMethod,
    /// Why it was marched although shooting was asked for.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub why_marched: Option<String>,
    /// Steps in a mesh cycle: at low speeds a multiple of those of the scene, as the vibrations of the set need them.
    #[serde(default)]
    pub steps_per_cycle: usize,
    /// Speed (rpm) at which the motion was computed where that is not the speed asked for: the lowest that the
    /// most steps resolve, below which inertia has no part and the motion is that at rest.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub computed_at_rpm: Option<f64>,
    /// Cycles marched.
    pub cycles: usize,
    /// Derivatives of the cycle that shooting computed.
    pub derivatives: usize,
    /// Where the search began.
    #[serde(default)]
    pub start: SearchStart,
    /// Whether motions near this one come to it, and what showed it.
    #[serde(default)]
    pub attracts: Attraction,
    /// Floquet multipliers of one period of size 1e-3 and above (real and imaginary part) by descending size;
    /// empty for a model without derivative and for a motion that does not repeat. The motion attracts if all are
    /// smaller than 1.
    pub multipliers: Vec<[f64; 2]>,
    /// What the multipliers are those of.
    #[serde(default)]
    pub multipliers_of: MultipliersOf,
    /// The largest of them; absent if there are none.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub largest_multiplier: Option<LargestMultiplier>,
    /// How the perturbation moves whose multiplier is nearest in size to 1; absent without multipliers and for sets of
    /// fewer than three planets.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub critical: Option<CriticalMotion>,
    /// Change of the last two periods, or mesh cycles of a motion that does not repeat, over the largest
    /// peak-to-peak vibration; of a motion found by shooting, that from the last period to the next one, carried
    /// by the derivative.
    pub residual: f64,
    /// Whether the motion repeats with every mesh cycle within the tolerance and was shown to attract; what may be
    /// left of a transient, where that is a question, is within 1 %.
    pub is_steady: bool,
    /// What may be left of the transient in the recorded cycle, of the vibration, by the multipliers of a marched
    /// motion whose cycles still change by more than 1e-6; absent otherwise.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub transient: Option<f64>,
    /// What the length of the steps may change of a strong harmonic of the sun; absent up to 1 %.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub step_error: Option<StepError>,
    /// What the inertia of the bodies behind the teeth, which quasi-static bodies lack, may change of a strong
    /// harmonic of the sun; absent up to 5 %, and of other models.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub inertia_error: Option<InertiaError>,
    /// Energy between mesh harmonics over all vibration.
    pub between: Option<f64>,
    /// Number of mesh cycles after which the motion repeats within the tolerance: 1 for a steady state, 2 to 8
    /// for a subharmonic response; absent if none that repeats and attracts was found, because the motion is not
    /// periodic or has not settled yet. Harmonics are those of the mean mesh cycle of one period, without one of
    /// the last mesh cycle; contact is counted over one period, or over 8 mesh cycles if there is none.
    pub repeats_after: Option<usize>,
    /// Lowest force of any mesh, N; 0 where flanks part.
    pub lowest_force_n: f64,
    /// Largest part of the time in which a mesh carries no force, 0 to 1.
    pub contact_loss: f64,
    /// Part of the time in which backside flanks of any mesh press, 0 to 1; absent for a model without
    /// backside flanks.
    pub backside_contact: Option<f64>,
    /// Distance to grazing, near which multipliers lose their meaning: the least of lowest over mean force of the
    /// meshes that never part, 0 where one is about to; absent if all meshes part.
    pub grazing_margin: Option<f64>,
    /// How often the load the tables are made for was doubled.
    pub size: usize,
    /// What approaches of tooth pairs are off their linear form about the mean loaded configuration at
    /// most, m; absent where meshes follow a law.
    pub kinematic_rest_m: Option<f64>,
    /// The same over the sun's largest peak-to-peak motion: x, y, or rotation at the base circle.
    pub kinematic_rest_share: Option<f64>,
    /// Whether that is worth a warning.
    pub is_beyond_linear: bool,
}

impl SweepPoint {
    /// Size of the largest Floquet multiplier: below 1 if the motion attracts, 0 if all perturbations are gone
    /// after one period; `None` where there are no multipliers.
    pub fn largest_multiplier(&self) -> Option<f64> {
        match self.attracts {
            Attraction::ByDecay | Attraction::NotShown => None,
            _ => Some(self.largest_multiplier.as_ref().map_or(0.0, |m| m.size)),
        }
    }

    /// The same with the multipliers of the vibrations of the set, the largest first, and the type of its motion.
    pub(super) fn with_vibrations(
        mut self,
        mut multipliers: Vec<Multiplier>,
        mode_type: Option<String>,
    ) -> Self {
        multipliers.retain(|m| m.size() >= SMALL);
        self.largest_multiplier = largest(&multipliers, mode_type);
        self.multipliers = multipliers.iter().map(|m| [m.re, m.im]).collect();
        (self.multipliers_of, self.critical) = (MultipliersOf::Vibrations, None);
        self
    }

    /// What must be said of a motion that ended within the tolerance and may be a transient all the same.
    pub fn caution(&self) -> Option<String> {
        let left = self.transient.filter(|left| *left > MOST_TRANSIENT)?;
        let rpm = self.state.case.speed_rpm;
        Some(format!(
            "at {rpm:.1} rpm the march ended when cycles changed by {:.0e} of the vibration, but the transient decays so slowly \
             that {:.0} % of the vibration may still be transient: lower the tolerance, or use shooting",
            self.residual,
            100.0 * left
        ))
    }

    /// A motion under a load case; where the search was given a state, it was that at rest.
    ///
    /// # Errors
    /// If the record is not finite.
    pub fn new(
        case: LoadCase,
        found: &Steady,
        settings: &super::SteadySettings,
        size: usize,
    ) -> Result<Self, SweepError> {
        let start = match found.came_from {
            CameFrom::Given | CameFrom::Rest => SearchStart::Rest,
            CameFrom::Unstable => SearchStart::Unstable,
        };
        let record = &found.record;
        let mut lines = Vec::new();
        let mut add = |part: Part, coordinate, channel| -> Result<(), SweepError> {
            let all = record.harmonics(channel, 1, settings.harmonics)?;
            lines.extend(all.into_iter().enumerate().map(|(harmonic, [re, im])| Line {
                part,
                coordinate,
                harmonic,
                amplitude: re.hypot(im),
                phase_rad: im.atan2(re),
            }));
            Ok(())
        };
        let shape = record.shape();
        // Carrier and ring of a pair do not exist.
        let first_body = if shape.has_ring { 0 } else { 2 };
        for body in first_body..record.bodies() {
            for (axis, coordinate) in Coordinate::DISPLACEMENTS.into_iter().enumerate() {
                add(Part::Body(Body::from_index(body)), coordinate, 3 * body + axis)?;
            }
        }
        let planets = shape.planets;
        let part = |mesh: usize| match mesh < planets {
            true => Part::SunMesh(mesh),
            false => Part::RingMesh(mesh - planets),
        };
        let first = record.displacements();
        for mesh in 0..shape.meshes() {
            add(part(mesh), Coordinate::Force, first + mesh)?;
        }
        let watched = found.watched();
        let forces: Vec<Vec<f64>> =
            (0..shape.meshes()).map(|mesh| watched.mesh_force(mesh)).collect();
        let steps = watched.len().max(1) as f64;
        let (mut lowest_force_n, mut contact_loss) = (f64::INFINITY, 0.0f64);
        for side in 0..shape.meshes().div_ceil(planets.max(1)) {
            let side = side * planets..(side + 1) * planets;
            let total: Vec<f64> = (0..watched.len())
                .map(|k| forces[side.clone()].iter().map(|f| f[k]).sum())
                .collect();
            for mesh in side {
                let share = forces[mesh].iter().zip(&total);
                let share = share.map(|(f, all)| if *all > 0.0 { f / all } else { 0.0 });
                let lost = forces[mesh].iter().filter(|f| **f <= 0.0).count() as f64 / steps;
                let single = |coordinate, amplitude| Line {
                    part: part(mesh),
                    coordinate,
                    harmonic: 0,
                    amplitude,
                    phase_rad: 0.0,
                };
                lines.push(single(Coordinate::Share, share.fold(0.0f64, f64::max)));
                lines.push(single(Coordinate::ContactLoss, lost));
                let lowest = forces[mesh].iter().fold(f64::INFINITY, |a, f| a.min(*f));
                lines.push(single(Coordinate::LowestForce, lowest));
                let behind = watched.backside_share(Some(mesh));
                lines.extend(behind.map(|share| single(Coordinate::BacksideContact, share)));
                lowest_force_n = lowest_force_n.min(lowest);
                contact_loss = contact_loss.max(lost);
            }
        }
        Ok(Self {
            state: SteadyState { case, lines },
            method: found.method,
            why_marched: found.why_marched.clone(),
            steps_per_cycle: record.len(),
            computed_at_rpm: None,
            cycles: found.cycles,
            derivatives: found.derivatives,
            start,
            attracts: found.attraction,
            multipliers: found.multipliers.iter().map(|m| [m.re, m.im]).collect(),
            multipliers_of: MultipliersOf::Steps,
            largest_multiplier: largest(
                &found.multipliers,
                found.critical.as_ref().map(|own| own.mode_type.clone()),
            ),
            critical: found.critical.clone(),
            residual: found.residual,
            is_steady: found.residual <= settings.tolerance
                && found.repeats_after == Some(1)
                && found.attraction.is_shown()
                && found.transient.is_none_or(|left| left <= MOST_TRANSIENT),
            transient: found.transient,
            step_error: None,
            inertia_error: None,
            between: found.between,
            repeats_after: found.repeats_after,
            lowest_force_n,
            contact_loss,
            backside_contact: watched.backside_share(None),
            grazing_margin: watched.grazing_margin(),
            size,
            kinematic_rest_m: found.rest.map(|rest| rest.largest),
            kinematic_rest_share: found.rest.and_then(|rest| rest.share),
            is_beyond_linear: found.rest.is_some_and(|rest| rest.is_worth_a_warning()),
        })
    }
}

/// The first of multipliers that are ordered by size, with the type of its motion.
fn largest(multipliers: &[Multiplier], mode_type: Option<String>) -> Option<LargestMultiplier> {
    let own = multipliers.first()?;
    Some(LargestMultiplier { size: own.size(), kind: multiplier_kind(*own).into(), mode_type })
}
