//! Sensitivities of natural frequencies to stiffnesses and inertias, in closed form.
//!
//! A common change of a family (all sun meshes, …) keeps the symmetry that makes the eigenvalues of a group equal; the
//! mean is then the rate of each.

use std::collections::BTreeMap;

use gearset::Axis;
use serde::Serialize;

use crate::model::LumpedModel;
use crate::modes::ModeGroup;
use crate::springs::{Spring, SpringId};

/// A parameter of the model.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    /// Stiffness of one spring.
    Stiffness(SpringId),
    /// Stiffness of a family of springs, all changed alike.
    StiffnessFamily(String),
    /// Inertia of one free coordinate.
    Inertia(usize),
    /// Mass or rotary inertia (`_mass`, `_inertia`) of a kind of body, all changed alike.
    InertiaFamily(String),
}

/// Sensitivity of a group's mean eigenvalue to one parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sensitivity {
    /// The parameter p.
    pub parameter: Parameter,
    /// ∂λ/∂p, mean over the group.
    pub lambda_rate: f64,
    /// ∂f/∂p, Hz per unit of p, mean over the group; zero for rigid-body modes.
    pub frequency_rate_hz: f64,
    /// ∂ln f/∂ln p, mean over the group (a family: all members scaled by one factor); zero for
    /// rigid-body modes.
    pub logarithmic: f64,
}

impl ModeGroup {
    /// Σ over the group's modes and the spring's rows of (bᵀφ)², 1/kg.
    pub fn squared_stretch(&self, spring: &Spring) -> f64 {
        let mut sum = 0.0;
        for row in 0..spring.rows.len() {
            for j in 0..self.multiplicity {
                sum += spring.deflection(row, |i| self.vectors[(i, j)]).powi(2);
            }
        }
        sum
    }
}

/// Sensitivities of a group to every spring, every inertia and every family of either.
///
/// `[eq:sensitivity]` For M-orthonormal modes Φ of a group with eigenvalue λ and multiplicity m, a parameter p moves
/// the group's eigenvalues at the rates given by the eigenvalues of Φᵀ(∂K/∂p − λ ∂M/∂p)Φ, whose mean is trace/m:
/// ∂λ/∂k = (bᵀφ)², ∂λ/∂m = −λ φ_i².
/// Source: closed form.
/// Checked by: `lumped/tests/derivatives.rs::sensitivities_are_the_differences_they_stand_for`,
/// `lumped/tests/derivatives.rs::logarithmic_sensitivities_add_up_to_half`.
pub fn sensitivities(model: &LumpedModel, group: &ModeGroup) -> Vec<Sensitivity> {
    let m = group.multiplicity as f64;
    let mut singles = Vec::new();
    // family → (Σ rates, Σ p × rate)
    let mut families: BTreeMap<(bool, String), (f64, f64)> = BTreeMap::new();
    for spring in &model.springs {
        let rate = group.squared_stretch(spring) / m;
        let family = families.entry((false, spring.id.family())).or_default();
        *family = (family.0 + rate, family.1 + spring.stiffness * rate);
        singles.push((Parameter::Stiffness(spring.id), rate, spring.stiffness * rate));
    }
    for (i, &(body, axis)) in model.coordinates.free().iter().enumerate() {
        let squared: f64 = (0..group.multiplicity).map(|j| group.vectors[(i, j)].powi(2)).sum();
        let rate = -group.lambda * squared / m;
        let what = if axis == Axis::Rotation { "inertia" } else { "mass" };
        let family = families.entry((true, format!("{}_{what}", body.kind_name()))).or_default();
        *family = (family.0 + rate, family.1 + model.mass[i] * rate);
        singles.push((Parameter::Inertia(i), rate, model.mass[i] * rate));
    }
    let families = families.into_iter().map(|((is_inertia, name), (rate, weighted))| {
        let parameter = match is_inertia {
            true => Parameter::InertiaFamily(name),
            false => Parameter::StiffnessFamily(name),
        };
        (parameter, rate, weighted)
    });
    // f = √λ/2π: ∂f/∂p = f/(2λ) ∂λ/∂p and ∂ln f/∂ln p = p/(2λ) ∂λ/∂p
    let half_inverse = if group.lambda > 0.0 { 0.5 / group.lambda } else { 0.0 };
    singles
        .into_iter()
        .chain(families)
        .map(|(parameter, lambda_rate, weighted)| Sensitivity {
            parameter,
            lambda_rate,
            frequency_rate_hz: group.frequency_hz * half_inverse * lambda_rate,
            logarithmic: half_inverse * weighted,
        })
        .collect()
}
