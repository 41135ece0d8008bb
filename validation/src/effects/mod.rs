//! Which part of the difference to the paper is due to parameters and which to the model: the tabled modes
//! from three models, and the effect of every single change on them.

use experiments::NaturalMode;
use experiments::modal::{
    Preload, linear_modes, lumped_frequencies, lumped_from_fe, majority, preloaded,
};
use fe_contact::statics::Bodies;
use gearset::PlanetPositions;
use lumped::{LumpedModel, campbell};
use scene::Scene;
use serde::Serialize;

use crate::catalogue::scene;
use crate::error::ValidationError;
use crate::published_table::Table;
use crate::reference::Reference;

mod tabled;
mod tables;
mod variant;

pub use tabled::{TabledFrequency, tabled};
pub use variant::{Base, Variant};

/// A change's effect on one tabled mode.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Effect {
    /// Change of its frequency (of a pair's mean), percent of the base's.
    pub percent: f64,
    /// Difference of the two frequencies of a pair, percent of their mean.
    pub split_percent: f64,
}

/// One step of the way from the published lumped model to FE/contact.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PathStep {
    /// What is changed, keeping all changes before.
    pub change: &'static str,
    /// Whether it changes parameters; the model otherwise.
    pub is_parameter: bool,
    /// The tabled frequencies after it, Hz.
    pub frequency_hz: Vec<f64>,
}

/// The tabled modes from three models, and what changes them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Effects {
    /// Which table.
    pub table: Table,
    /// Type of each row.
    pub mode_type: Vec<String>,
    /// Printed lumped frequencies, Hz.
    pub printed_lumped_hz: Vec<f64>,
    /// Printed FE/contact frequencies, Hz.
    pub printed_fe_contact_hz: Vec<f64>,
    /// Lumped as published, Hz.
    pub published_hz: Vec<f64>,
    /// Lumped, parameters from FE, Hz.
    pub lumped_from_fe_hz: Vec<f64>,
    /// FE/contact, linearised, Hz.
    pub fe_contact_hz: Vec<f64>,
    /// The same without the stiffness of mesh forces that turn with their lines of action, Hz.
    pub still_hz: Vec<f64>,
    /// Split of each row in the last two models, percent.
    pub split_percent: [Vec<f64>; 2],
    /// Changes one by one; `None` for those whose bodies were not given.
    pub variants: Vec<(Variant, Option<Vec<Effect>>)>,
    /// Changes one after the other, the published lumped model first.
    pub path: Vec<PathStep>,
}

/// Input of the tables of effects.
#[derive(Debug, Clone, Copy)]
pub struct EffectStudy<'b> {
    /// Bodies of the table's scene.
    pub bodies: &'b Bodies,
    /// Bodies of the changes that need their own, [`Variant::own_bodies`]; a change whose bodies are
    /// not here has no effects.
    pub own: &'b [(Variant, Bodies)],
    /// Position and torque of the standing set.
    pub preload: Preload,
    /// The changes.
    pub variants: &'b [Variant],
}

/// A model's tabled modes.
type Rows = Vec<TabledFrequency>;

/// Computes the tables of effects.
///
/// # Errors
/// If a scene cannot be used, or an equilibrium or an eigenproblem cannot be solved.
pub fn effects(
    reference: &Reference,
    table: Table,
    study: &EffectStudy<'_>,
) -> Result<Effects, ValidationError> {
    let EffectStudy { bodies, own, preload, variants: wanted } = *study;
    let printed = table.printed(reference);
    let (set, as_published) = (scene(table.consistent())?, scene(table.as_published())?);
    let lumped = |scene: &Scene| -> Result<Rows, ValidationError> {
        Ok(tabled(printed, &lumped_frequencies(scene)?))
    };
    let turned = |scene: &Scene, bodies: &Bodies, preload: Preload, turns: bool| {
        let set = preloaded(scene, bodies, &preload)?;
        let mut linear = set.linearised()?;
        if !turns {
            linear.supports -= &linear.turning;
        }
        let modes = linear_modes(&set, &linear)?;
        let typed: Vec<NaturalMode> = modes.iter().map(NaturalMode::from).collect();
        Ok::<Rows, ValidationError>(tabled(printed, &typed))
    };
    let fe = |scene: &Scene, bodies: &Bodies, preload| turned(scene, bodies, preload, true);
    let from_fe = lumped_from_fe(&set, bodies, &preload)?;
    let (of_fe, of_lumped) = (fe(&set, bodies, preload)?, lumped(&from_fe)?);
    let mut variants = Vec::new();
    for &variant in wanted {
        let rows = match variant.base() {
            Base::LumpedFromFe => {
                let (changed, _) = variant.applied(&from_fe, &set, preload);
                Some(match variant {
                    Variant::Gyroscopic => tabled(printed, &turning(&changed)?),
                    _ => lumped(&changed)?,
                })
            }
            Base::FeContact => {
                let with = match variant.needs_bodies() {
                    true => own.iter().find(|(v, _)| *v == variant).map(|(_, b)| b),
                    false => Some(bodies),
                };
                let (changed, preload) = variant.applied(&set, &set, preload);
                with.map(|bodies| fe(&changed, bodies, preload)).transpose()?
            }
        };
        let base = if variant.base() == Base::FeContact { &of_fe } else { &of_lumped };
        variants.push((variant, rows.map(|rows| effect_of(base, &rows))));
    }
    let mut path = vec![step("lumped, as published", true, &lumped(&as_published)?)];
    let mut equal = set.clone();
    equal.planets = PlanetPositions::equally_spaced(set.planets.count());
    path.push(step("operating angles of Table 1", true, &lumped(&equal)?));
    if table == Table::Three {
        path.push(step("spacing that can be assembled", true, &lumped(&set)?));
    }
    let (own_masses, _) = Variant::PrintedMeshes.applied(&from_fe, &set, preload);
    path.push(step("masses and inertias of the meshes", true, &lumped(&own_masses)?));
    path.push(step("tangent stiffness of each mesh: lumped, parameters from FE", true, &of_lumped));
    let (rigid, _) = Variant::RigidCarrier.applied(&set, &set, preload);
    path.push(step(
        "corner contacts press along their own normals",
        false,
        &turned(&rigid, bodies, preload, false)?,
    ));
    let of_still = turned(&set, bodies, preload, false)?;
    path.push(step("carrier gives way", false, &of_still));
    let last = "forces turn with their lines of action: FE/contact, linearised";
    path.push(step(last, false, &of_fe));
    let means = |rows: &Rows| rows.iter().map(|r| r.mean_hz).collect::<Vec<f64>>();
    let splits = |rows: &Rows| rows.iter().map(TabledFrequency::split_percent).collect();
    Ok(Effects {
        table,
        mode_type: printed.mode_type.clone(),
        printed_lumped_hz: printed.lumped_hz.clone(),
        printed_fe_contact_hz: printed.fe_contact_hz.clone(),
        published_hz: path[0].frequency_hz.clone(),
        lumped_from_fe_hz: means(&of_lumped),
        fe_contact_hz: means(&of_fe),
        still_hz: means(&of_still),
        split_percent: [splits(&of_lumped), splits(&of_fe)],
        variants,
        path,
    })
}

fn step(change: &'static str, is_parameter: bool, rows: &Rows) -> PathStep {
    let frequency_hz = rows.iter().map(|r| r.mean_hz).collect();
    PathStep { change, is_parameter, frequency_hz }
}

fn effect_of(base: &Rows, rows: &Rows) -> Vec<Effect> {
    let one = |(base, row): (&TabledFrequency, &TabledFrequency)| Effect {
        percent: 100.0 * (row.mean_hz / base.mean_hz - 1.0),
        split_percent: row.split_percent(),
    };
    base.iter().zip(rows).map(one).collect()
}

/// Frequencies of a lumped scene in the frame of its rotating carrier.
fn turning(scene: &Scene) -> Result<Vec<NaturalMode>, ValidationError> {
    let missing = || ValidationError::Incomplete("operating speed");
    let kinematics = scene.kinematics().ok().ok_or_else(missing)?;
    let speed = kinematics.speeds_rad_per_s.carrier;
    let model = LumpedModel::from_scene(scene)?;
    let list = campbell(&model, &[speed])?;
    let of = |mode: &lumped::SpeedMode| NaturalMode {
        mode_type: majority(&mode.participation),
        frequency_hz: mode.frequency_hz,
    };
    Ok(list.iter().flat_map(|s| s.modes.iter().map(of)).collect())
}

impl Effects {
    /// Effects of one change, if it was worked out.
    pub fn of(&self, variant: Variant) -> Option<&[Effect]> {
        let found = self.variants.iter().find(|(v, _)| *v == variant);
        found.and_then(|(_, effects)| effects.as_deref())
    }

    /// Sum of the single effects of the parameters less their joint effect, for each row, percent:
    /// Σ ln(f_i/f_lumped) − ln(f_published/f_lumped).
    pub fn remainders_percent(&self) -> Vec<f64> {
        let joint =
            self.published_hz.iter().zip(&self.lumped_from_fe_hz).map(|(p, f)| (p / f).ln());
        let single = |row: usize| {
            let of = |v| self.of(v).map_or(f64::NAN, |e| (0.01 * e[row].percent).ln_1p());
            Variant::TO_PUBLISHED.into_iter().map(of).sum::<f64>()
        };
        joint.enumerate().map(|(row, joint)| 100.0 * (single(row) - joint)).collect()
    }

    /// Difference of FE/contact from the lumped model with parameters from FE that is left without the
    /// effects of the flexible carrier and of mesh forces that turn with their lines of action, for each row,
    /// percent.
    pub fn beyond_carrier_percent(&self) -> Vec<f64> {
        let rigid = self.of(Variant::RigidCarrier);
        let of = |(row, (fe, from_fe)): (usize, (&f64, &f64))| {
            let carrier = rigid.map_or(f64::NAN, |e| (0.01 * e[row].percent).ln_1p());
            100.0 * ((fe / from_fe).ln() + carrier)
        };
        self.still_hz.iter().zip(&self.lumped_from_fe_hz).enumerate().map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Single effects whose product is the joint effect leave no remainder.
    #[test]
    fn remainders_vanish_for_effects_that_multiply() {
        let single = [3.0, -2.0, 0.5, 1.0];
        let whole: f64 = single.iter().map(|p| 1.0 + 0.01 * p).product();
        let effect = |percent| Some(vec![Effect { percent, split_percent: 0.0 }]);
        let mut variants: Vec<_> =
            Variant::TO_PUBLISHED.into_iter().zip(single.map(effect)).collect();
        variants.push((Variant::RigidCarrier, effect(2.0)));
        let effects = Effects {
            table: Table::Two,
            mode_type: vec!["rotational".into()],
            printed_lumped_hz: vec![1.0],
            printed_fe_contact_hz: vec![1.0],
            published_hz: vec![1000.0 * whole],
            lumped_from_fe_hz: vec![1000.0],
            // The flexible carrier lowers the frequency by 2 %, another effect by 0.1 %.
            still_hz: vec![1000.0 / 1.02 * 0.999],
            fe_contact_hz: vec![1000.0 / 1.02 * 0.999],
            split_percent: [vec![0.0], vec![0.0]],
            variants,
            path: Vec::new(),
        };
        assert!(effects.remainders_percent()[0].abs() < 1e-10);
        assert!((effects.beyond_carrier_percent()[0] - 100.0 * 0.999f64.ln()).abs() < 1e-10);
    }
}
