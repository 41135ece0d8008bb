//! Words for the types of modes of pairs, and of sets whose central members stand still.

use std::collections::BTreeMap;

use dynamics::IMPURE;
use gearset::{Axis, Body};
use nalgebra::DMatrix;

use crate::kinds::ModeType;
use crate::model::LumpedModel;
use crate::modes::{ModeGroup, NaturalModes};
use crate::participation::Participation;

/// Part by which frequencies of planets alone may differ that are one: central members on bearings that are meant
/// to be rigid give way by about this part of the teeth at most, and take [`IMPURE`] of the energy or less.
const STILL: f64 = 1e-4;

/// Modes of one frequency that have one name.
#[derive(Debug, Clone)]
pub struct NamedModes {
    /// See [`type_name`].
    pub name: &'static str,
    /// The modes; of several groups of [`NaturalModes`] their mean frequency, and what they differ by as uncertainty.
    pub group: ModeGroup,
    /// Index of the first group of [`NaturalModes::groups`] in it.
    pub first: usize,
}

/// Name of the type of a group of modes: of a gear pair "rotational", "translational" or "coupled" by what its
/// gears do; of a set that of its [`ModeType`], but "planet" where central members could translate and do not, as
/// the N − 1 torsional modes of planets on rigid bearings.
pub fn type_name(model: &LumpedModel, group: &ModeGroup) -> &'static str {
    let share = |is: &dyn Fn(Body, Axis) -> bool| -> f64 {
        let free = model.coordinates.free().iter().enumerate();
        let energy = free.filter(|(_, (body, axis))| is(*body, *axis)).map(|(i, _)| {
            let squared: f64 = (0..group.multiplicity).map(|j| group.vectors[(i, j)].powi(2)).sum();
            model.mass[i] * squared / group.multiplicity as f64
        });
        energy.sum()
    };
    if model.is_pair() {
        return match share(&|_, axis| axis == Axis::Rotation) {
            turning if turning < IMPURE => "translational",
            turning if turning > 1.0 - IMPURE => "rotational",
            _ => "coupled",
        };
    }
    match group.mode_type {
        ModeType::Translational if share(&|body, _| !matches!(body, Body::Planet(_))) < IMPURE => {
            ModeType::Planet.name()
        }
        mode_type => mode_type.name(),
    }
}

impl LumpedModel {
    /// Whether it is a sun and one planet to ground, without ring and carrier.
    pub fn is_pair(&self) -> bool {
        let stands = |body| Axis::ALL.iter().all(|axis| self.coordinates.of(body, *axis).is_none());
        self.psi.len() == 1 && stands(Body::Ring) && stands(Body::Carrier)
    }
}

impl NaturalModes {
    /// All modes by name, ascending: groups of one frequency and name are one.
    pub fn named(&self, model: &LumpedModel) -> Vec<NamedModes> {
        let mut all: Vec<NamedModes> = Vec::with_capacity(self.groups.len());
        let mut latest: BTreeMap<&'static str, usize> = BTreeMap::new();
        for (first, group) in self.groups.iter().enumerate() {
            let name = type_name(model, group);
            let before = latest.get(name).map(|i| (*i, &all[*i].group));
            let joined = before.filter(|(_, before)| {
                let is_close = before.frequency_hz >= (1.0 - STILL) * group.frequency_hz;
                let are_still =
                    name == ModeType::Planet.name() && before.mode_type != group.mode_type;
                before.lambda == group.lambda || are_still && is_close
            });
            let joined = joined.map(|(i, before)| (i, together(before, group)));
            match joined {
                Some((i, group)) => all[i].group = group,
                None => {
                    latest.insert(name, all.len());
                    all.push(NamedModes { name, group: group.clone(), first });
                }
            }
        }
        all
    }
}

/// Two groups of one name and frequency as one.
fn together(a: &ModeGroup, b: &ModeGroup) -> ModeGroup {
    let (m, n) = (a.multiplicity as f64, b.multiplicity as f64);
    let mean = |x: f64, y: f64| (m * x + n * y) / (m + n);
    let frequency_hz = mean(a.frequency_hz, b.frequency_hz);
    let apart = [a, b].map(|g| (g.frequency_hz - frequency_hz).abs());
    let apart = if frequency_hz > 0.0 { apart[0].max(apart[1]) / frequency_hz } else { 0.0 };
    let (p, q) = (a.participation, b.participation);
    let (rows, columns) = (a.vectors.nrows(), a.multiplicity + b.multiplicity);
    let vectors = DMatrix::from_fn(rows, columns, |i, j| match j.checked_sub(a.multiplicity) {
        Some(j) => b.vectors[(i, j)],
        None => a.vectors[(i, j)],
    });
    ModeGroup {
        frequency_hz,
        uncertainty: a.uncertainty.max(b.uncertainty) + apart,
        lambda: mean(a.lambda, b.lambda),
        mode_type: if a.mode_type == b.mode_type { a.mode_type } else { ModeType::Planet },
        multiplicity: columns,
        participation: Participation {
            rotational: mean(p.rotational, q.rotational),
            translational: mean(p.translational, q.translational),
            planet: mean(p.planet, q.planet),
        },
        vectors,
    }
}
