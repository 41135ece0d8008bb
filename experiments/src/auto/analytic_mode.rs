//! A mode of the lumped model with parameters in closed form, and the estimated errors of its frequency. `docs/auto.md` derives them.

use gearset::{LoadCase, Scene};
use lumped::{AnalyticSet, ModeGroup, Parameter, SpringId, sensitivities};

use super::choice::ErrorPart;
use super::energy::{ModeEnergy, mixed, of_group};
use super::error_parts::SetSize;
use super::frequency::{BODY_INERTIA, FrequencyRequest};
use crate::error::ExperimentError;
use crate::modal::majority;

/// What the stiffness of the sun meshes and that of the ring meshes may be off together, where no pair hands over, as 95 % of the means over
/// the meshes of one kind are (2.8 and 3.9 % on the drawn sets 1 to 119, 3.2 and 3.7 % on 120 to 249, at twelve positions).
const STIFFNESS_DOUBT: [f64; 2] = [0.03, 0.04];

/// Twice the coefficient of correlation of both (0.53 and 0.43 on these sets).
const ALIKE: f64 = 1.0;

/// Effect on a quantity of which the relative sensitivities to the stiffness of sun and ring meshes are `sizes`.
pub(super) fn of_stiffness(sizes: [f64; 2]) -> f64 {
    let [sun, ring] = [0, 1].map(|kind| STIFFNESS_DOUBT[kind] * sizes[kind]);
    (sun * sun + ring * ring + ALIKE * sun * ring).sqrt()
}

/// What the flexibility of pin seats may be off: 3 % radial and 0.7 % tangential on the drawn sets.
pub(super) const SEAT_DOUBT: f64 = 0.04;

/// Part of what turning forces do at most that their closed form may leave: planets share the torque evenly in it.
const TURNING_DOUBT: f64 = 0.1;

/// Largest effect of corner contacts that press along their own normals on a mode that meshes govern
/// (`docs/fe_dynamics_effects.md`).
const CORNERS: f64 = 0.006;

/// Part of the mean slope of loaded flanks by which the closed forms of rows that lean and of corners may miss a frequency.
const SLOPE_DOUBT: f64 = 0.5;

/// What the closed form of the change by the inertia of the bodies may leave: parts of that change and of its bound.
const CHANGE_DOUBT: [f64; 2] = [0.3, 0.1];

/// A mode of the lumped model in closed form.
#[derive(Debug, Clone)]
pub(super) struct AnalyticMode {
    set: AnalyticSet,
    group: ModeGroup,
    energy: ModeEnergy,
    /// Change of the frequency by the inertia of elastic displacements, relative.
    change: f64,
    /// A mode up to this one, or close above it, that is of the asked type about as much as of others, Hz.
    pub(super) mixed_hz: Option<f64>,
}

impl AnalyticMode {
    /// The mode that is asked for.
    ///
    /// # Errors
    /// If the scene has no parameters in closed form, or the set no such mode.
    pub(super) fn of(
        scene: &Scene,
        case: &LoadCase,
        request: &FrequencyRequest,
    ) -> Result<Self, ExperimentError> {
        let set = AnalyticSet::new(scene, case, 0.0)?;
        let groups = set.modes()?.groups;
        let own = groups.iter().filter(|g| majority(&g.participation) == request.mode_type);
        let mut each = own.clone().flat_map(|g| std::iter::repeat_n(g, g.multiplicity));
        let group = match each.nth(request.number.wrapping_sub(1)) {
            Some(group) => group.clone(),
            None => return Err(request.missing(own.map(|g| g.multiplicity).sum())),
        };
        let shares = groups.iter().map(|g| {
            let p = &g.participation;
            (g.frequency_hz, [p.rotational, p.translational, p.planet])
        });
        let mixed_hz = mixed(shares, group.frequency_hz, request.mode_type);
        let energy = of_group(&set.model, &group);
        let change = set.inertia_change(&group);
        Ok(Self { set, group, energy, change, mixed_hz })
    }

    /// Frequency with the inertia of the bodies, Hz.
    pub(super) fn frequency_hz(&self) -> f64 {
        self.energy.frequency_hz * (1.0 + self.change)
    }

    /// Estimated errors beside FE/contact with every degree of freedom.
    pub(super) fn error_parts(&self, size: &SetSize) -> Vec<ErrorPart> {
        let mut families = [0.0, 0.0];
        let (mut hand_over, mut seats) = (0.0, 0.0);
        let planets = self.set.model.psi.len();
        for sensitivity in sensitivities(&self.set.model, &self.group) {
            let size = sensitivity.logarithmic.abs();
            match sensitivity.parameter {
                Parameter::Stiffness(SpringId::SunMesh(n)) => {
                    families[0] += size;
                    hand_over += size * self.set.hand_overs[n].abs();
                }
                Parameter::Stiffness(SpringId::RingMesh(n)) => {
                    families[1] += size;
                    hand_over += size * self.set.hand_overs[planets + n].abs();
                }
                Parameter::Stiffness(SpringId::PlanetBearing(n)) => {
                    seats += size * self.set.seat_share(n);
                }
                _ => (),
            }
        }
        let stiffness = of_stiffness(families);
        let [of_change, of_bound] = CHANGE_DOUBT;
        let bound = size.body_inertia(&self.energy);
        vec![
            ErrorPart::new("mesh stiffness in closed form", stiffness),
            ErrorPart::new("tooth pairs that may or may not touch", hand_over),
            ErrorPart::new("pin seats in closed form", SEAT_DOUBT * seats),
            ErrorPart::new(
                "mesh forces that turn with their lines of action",
                TURNING_DOUBT * size.of_turning(&self.energy),
            ),
            ErrorPart::new(
                "corner contacts beside the line of action",
                CORNERS * self.energy.meshes,
            ),
            ErrorPart::new("flanks that lean under load", SLOPE_DOUBT * size.slope()),
            ErrorPart::new(BODY_INERTIA, of_change * self.change.abs() + of_bound * bound),
        ]
    }
}
