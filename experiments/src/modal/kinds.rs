//! Kinds of modes as subspaces of the races' motion.

use dynamics::{EigenError, orthonormal_basis, split};
use fe_contact::statics::{CARRIER, PLANETS, Races, SUN};
use lumped::ModeType;

/// A mode is of a kind if that kind has more than this share of its kinetic energy. At one position
/// the meshes of different planets differ, so that kinds mix a little.
const MAJORITY: f64 = 0.5;

/// Bases of the rotational and the translational kind on the races' coordinates scaled by √mass; the rest of
/// the space is the planet kind.
#[derive(Debug)]
pub(super) struct RaceKinds {
    bases: [Vec<Vec<f64>>; 2],
    root: Vec<f64>,
}

impl RaceKinds {
    pub(super) fn new(races: &Races, mass: &[f64]) -> Self {
        let n = races.count;
        let root: Vec<f64> = mass.iter().map(|m| m.sqrt()).collect();
        let unit = |i: usize| (0..n).map(|k| f64::from(u8::from(k == i))).collect::<Vec<f64>>();
        let central =
            |axis: usize| (CARRIER..PLANETS).filter_map(move |body| races.of(body, axis)).map(unit);
        let mut rotational: Vec<Vec<f64>> = central(2).collect();
        let mut translational: Vec<Vec<f64>> = central(0).chain(central(1)).collect();
        for axis in 0..3 {
            let pattern = |weight: &dyn Fn(f64) -> f64| {
                let mut v = vec![0.0; n];
                for (planet, psi) in races.psi.iter().enumerate() {
                    if let Some(i) = races.of(PLANETS + planet, axis) {
                        v[i] = root[i] * weight(*psi);
                    }
                }
                v
            };
            if races.is_pair() && axis == 2 && races.of(PLANETS, 2) == races.of(SUN, 2) {
                continue; // One coordinate, which is in the basis already, or none.
            }
            let alike = orthonormal_basis(&[pattern(&|_| 1.0)], &[]);
            let around = orthonormal_basis(&[pattern(&f64::cos), pattern(&f64::sin)], &alike);
            rotational.extend(alike);
            translational.extend(around);
        }
        Self { bases: [rotational, translational], root }
    }

    /// Shares of rotational, translational and planet motion in the directions of a group of modes,
    /// given by their race displacements (real vectors spanning the group).
    pub(super) fn shares(&self, shapes: &[Vec<f64>]) -> Result<Vec<[f64; 3]>, EigenError> {
        let scaled: Vec<Vec<f64>> = shapes
            .iter()
            .map(|shape| shape.iter().zip(&self.root).map(|(x, r)| x * r).collect())
            .collect();
        let q = orthonormal_basis(&scaled, &[]);
        let dot = |a: &Vec<f64>, b: &Vec<f64>| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let projections: Vec<Vec<Vec<f64>>> = self
            .bases
            .iter()
            .map(|basis| basis.iter().map(|b| q.iter().map(|v| dot(b, v)).collect()).collect())
            .collect();
        let directions = split(q.len(), &projections)?;
        Ok(directions.iter().map(|d| [d.shares[0], d.shares[1], d.shares[2]]).collect())
    }
}

/// Type by majority of kinetic energy.
pub(super) fn type_of(shares: &[f64; 3]) -> ModeType {
    match shares {
        [r, _, _] if *r > MAJORITY => ModeType::Rotational,
        [_, t, _] if *t > MAJORITY => ModeType::Translational,
        [_, _, p] if *p > MAJORITY => ModeType::Planet,
        _ => ModeType::Mixed,
    }
}
