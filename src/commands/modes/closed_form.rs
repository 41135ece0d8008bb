//! The lumped model of a set with parameters from its geometry in closed form, where a scene gives none.

use std::collections::BTreeMap;
use std::io::Write;

use experiments::modal::majority;
use lumped::{AnalyticSet, LumpedModel, ModeGroup, NaturalModes, SpringId, StatedError};
use scene::{LoadCase, PerBody, PerMesh, Scene};
use schemars::JsonSchema;
use serde::Serialize;

/// Where the parameters are from.
pub(crate) const PARAMETERS: &str = "parameters from the geometry in closed form";

/// What to do where there is no closed form.
const WAY_OUT: &str = "give `lumped.mass_kg`, `lumped.inertia_kg_m2` and `lumped.mesh_n_per_m`";

/// A set and its natural modes.
pub(crate) struct ClosedForm {
    pub(super) set: AnalyticSet,
    /// With the inertia of elastic displacements, ascending.
    pub(super) modes: NaturalModes,
    /// Stated errors of each frequency.
    pub(super) errors: Vec<Vec<StatedError>>,
    scene: Scene,
    case: LoadCase,
}

impl ClosedForm {
    /// The set where planet 0's sun mesh starts its path, or why it has no closed form and what to do.
    pub(crate) fn new(scene: &Scene) -> Result<Self, String> {
        let advised = |why: String| format!("{why}; {WAY_OUT}");
        let case = LoadCase::of_scene(scene).map_err(|e| advised(e.to_string()))?;
        let set = AnalyticSet::new(scene, &case, 0.0).map_err(|e| advised(e.to_string()))?;
        let mut modes = set.modes().map_err(|e| e.to_string())?;
        let with_errors = |mut group: ModeGroup| {
            let errors = set.frequency_errors(&group);
            complete(&set, &mut group);
            (group, errors)
        };
        let mut all: Vec<_> = modes.groups.drain(..).map(with_errors).collect();
        all.sort_by(|(a, _), (b, _)| a.frequency_hz.total_cmp(&b.frequency_hz));
        let (groups, errors) = all.into_iter().unzip();
        modes.groups = groups;
        Ok(Self { set, modes, errors, scene: scene.clone(), case })
    }

    pub(super) fn parameters(&self) -> ClosedParameters {
        let own = &self.set.parameters;
        let bodies = |values: &PerBody, scale: f64| {
            let all = [
                ("carrier", values.carrier),
                ("ring", values.ring),
                ("sun", values.sun),
                ("planet", values.planet),
            ];
            let given =
                |(name, value): (&str, Option<f64>)| Some((name.to_owned(), scale * value?));
            all.into_iter().filter_map(given).collect()
        };
        let meshes = |values: &PerMesh| {
            let all = [("sun_planet", values.sun_planet), ("ring_planet", values.ring_planet)];
            all.map(|(name, value)| (name.to_owned(), value)).into()
        };
        let angles = PerMesh {
            sun_planet: own.pressure_angle_rad.sun_planet.to_degrees(),
            ring_planet: own.pressure_angle_rad.ring_planet.to_degrees(),
        };
        let bearings = self.set.model.springs.iter().filter_map(|spring| match spring.id {
            SpringId::PlanetBearing(_) => Some(spring.stiffness),
            _ => None,
        });
        let count = self.set.model.psi.len() as f64;
        let bearing = bearings.sum::<f64>() / count;
        ClosedParameters {
            sun_torque_nm: self.case.sun_torque_nm,
            mass_kg: bodies(&own.mass_kg, 1.0),
            inertia_over_r2_kg: bodies(&own.inertia_over_r2_kg, 1.0),
            radius_mm: bodies(&own.radius_m, 1e3),
            pressure_angle_deg: meshes(&angles),
            mesh_n_per_m: meshes(&own.mesh_n_per_m),
            bearing_with_seat_n_per_m: (!self.set.seats.is_empty()).then_some(bearing),
            largest_difference_percent: self.largest_difference(bearing),
        }
    }

    /// Largest difference of a frequency with a stated error from that of a scene with these parameters and this
    /// bearing (N/m), percent.
    fn largest_difference(&self, bearing: f64) -> Option<f64> {
        let mut pasted = self.scene.clone();
        pasted.lumped = Some(self.set.parameters.clone());
        pasted.supports.planet_bearing_n_per_m = bearing;
        let modes = NaturalModes::of(&LumpedModel::from_scene(&pasted).ok()?).ok()?;
        let each = |modes: &NaturalModes| -> Vec<f64> {
            let of = |g: &ModeGroup| std::iter::repeat_n(g.frequency_hz, g.multiplicity);
            modes.groups.iter().flat_map(of).collect()
        };
        let is_stated = self.modes.groups.iter().zip(&self.errors).flat_map(|(group, errors)| {
            let total: f64 = errors.iter().map(|error| error.share).sum();
            std::iter::repeat_n(total > 0.0 && total.is_finite(), group.multiplicity)
        });
        let both = each(&self.modes).into_iter().zip(each(&modes)).zip(is_stated);
        let apart = both.filter(|(_, is_stated)| *is_stated).map(|((own, other), _)| other / own);
        apart.map(|ratio| 100.0 * (ratio - 1.0).abs()).reduce(f64::max)
    }
}

/// Gives a group the inertia of elastic displacements, and the type that it is by the largest share: meshes of
/// different phases mix the types a little.
pub(super) fn complete(set: &AnalyticSet, group: &mut ModeGroup) {
    group.frequency_hz *= 1.0 + set.inertia_change(group);
    group.mode_type = majority(&group.participation);
}

/// The scene without what stands in the way of closed forms: numbers in `[lumped]` and a choice of settings.
pub(super) fn without_numbers(scene: &Scene) -> Scene {
    let mut bare = scene.clone();
    bare.lumped = None;
    bare.dynamics.auto = None;
    bare
}

/// Stated error of a frequency, percent of it.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct StatedErrorEntry {
    /// Sum of the parts; null where one has no bound.
    pub(super) percent: Option<f64>,
    parts: Vec<StatedPart>,
}

/// Part of a stated error.
#[derive(Debug, Serialize, JsonSchema)]
struct StatedPart {
    source: String,
    /// Null where there is no bound.
    percent: Option<f64>,
}

impl StatedErrorEntry {
    /// `None` for a rigid-body mode.
    pub(super) fn new(errors: &[StatedError]) -> Option<Self> {
        let percent = |share: f64| share.is_finite().then_some(100.0 * share);
        let part = |error: &StatedError| StatedPart {
            source: error.source.to_owned(),
            percent: percent(error.share),
        };
        (!errors.is_empty()).then(|| Self {
            percent: percent(errors.iter().map(|error| error.share).sum()),
            parts: errors.iter().map(part).collect(),
        })
    }
}

/// What a `[lumped]` table holds of parameters in closed form, in its keys.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct ClosedParameters {
    /// Torque on the sun under which meshes have their stiffness, N·m.
    sun_torque_nm: f64,
    mass_kg: BTreeMap<String, f64>,
    inertia_over_r2_kg: BTreeMap<String, f64>,
    radius_mm: BTreeMap<String, f64>,
    pressure_angle_deg: BTreeMap<String, f64>,
    /// Mean over the planets where planet 0's sun mesh starts its path.
    mesh_n_per_m: BTreeMap<String, f64>,
    /// Bearing of a planet in series with its own pin seat, mean over planets and directions; absent if the carrier
    /// is rigid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    bearing_with_seat_n_per_m: Option<f64>,
    /// Largest difference of a natural frequency of a scene with these parameters and this bearing from that in
    /// closed form, percent, of frequencies that have a stated error; absent if none has.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    largest_difference_percent: Option<f64>,
}

impl ClosedParameters {
    /// The table in TOML, with what it cannot hold in comments.
    pub(super) fn write(&self, title: &str, out: &mut dyn Write) -> std::io::Result<()> {
        writeln!(
            out,
            "# {title}: {PARAMETERS}, under {} N·m on the sun.",
            six(self.sun_torque_nm)
        )?;
        writeln!(
            out,
            "# The stiffness of meshes is the mean over the planets where planet 0's sun mesh starts its path.\n\
             # Not in the table: flexibility between pin seats, forces that turn with their lines of action, flanks\n\
             # that lean under load, meshes of other phases, inertia of elastic displacements."
        )?;
        if let Some(bearing) = self.bearing_with_seat_n_per_m {
            writeln!(
                out,
                "# For the lumped model alone, pin seats included: planet.bearing_n_per_m = {}",
                six(bearing)
            )?;
        }
        if let Some(percent) = self.largest_difference_percent {
            let with = self.bearing_with_seat_n_per_m.map_or("", |_| " and this bearing");
            writeln!(
                out,
                "# With it{with}, natural frequencies that have a stated error are within {percent:.2} % of those in\n\
                 # closed form."
            )?;
        }
        writeln!(out, "[lumped]")?;
        let tables = [
            ("mass_kg", &self.mass_kg),
            ("inertia_over_r2_kg", &self.inertia_over_r2_kg),
            ("radius_mm", &self.radius_mm),
            ("pressure_angle_deg", &self.pressure_angle_deg),
            ("mesh_n_per_m", &self.mesh_n_per_m),
        ];
        for (key, values) in tables {
            let all: Vec<_> =
                values.iter().map(|(name, value)| format!("{name} = {}", six(*value))).collect();
            writeln!(out, "{key} = {{ {} }}", all.join(", "))?;
        }
        Ok(())
    }
}

/// A number to six digits, as TOML reads it.
fn six(x: f64) -> String {
    match x.abs() {
        size if (1e-3..1e6).contains(&size) => {
            let decimals = (5 - size.log10().floor() as i32).max(0) as usize;
            format!("{x:.decimals$}")
        }
        _ => format!("{x:.5e}"),
    }
}
