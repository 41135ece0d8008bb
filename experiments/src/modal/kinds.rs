//! Kinds of motion of a set as subspaces: rotational, translational, and planet motion.

use dynamics::{EigenError, orthonormal_basis, split};
use fe_contact::statics::Races;
use gearset::{Axis, Body};
use lumped::ModeType;

/// A mode is of a kind if that kind has more than this share of its kinetic energy. At one position
/// the meshes of different planets differ, so that kinds mix a little.
const MAJORITY: f64 = 0.5;

/// Bases of the rotational and the translational kind on coordinates scaled by √mass; the rest of the space is the
/// planet kind.
#[derive(Debug)]
pub struct MotionKinds {
    bases: [Vec<Vec<f64>>; 2],
    root: Vec<f64>,
}

impl MotionKinds {
    /// On the coordinates of the races with their masses (n, kg).
    pub(super) fn of_races(races: &Races, mass: &[f64]) -> Self {
        // Rotations of a pair that are one coordinate are in the basis of the central members already.
        let rotation = |body| races.of(body, Axis::Rotation);
        let is_one = races.is_pair() && rotation(Body::Planet(0)) == rotation(Body::Sun);
        let of = |body: Body, axis: Axis| match (body, axis) {
            (Body::Planet(_), Axis::Rotation) if is_one => None,
            _ => races.of(body, axis),
        };
        Self::new(mass, &races.psi, &of)
    }

    /// On displacements of carrier, ring, sun (x, y, m; θ, rad) and planets (ζ, η, θ) one after another, with the
    /// inertias along them (kg, kg, kg m²; 0 where held) and the angles of the planets (rad).
    pub fn of_bodies(inertias: &[[f64; 3]], psi: &[f64]) -> Self {
        let mass = inertias.as_flattened();
        let of = |body: Body, axis: Axis| {
            let place = 3 * body.index() + axis as usize;
            mass.get(place).filter(|m| **m > 0.0).map(|_| place)
        };
        Self::new(mass, psi, &of)
    }

    /// `of`: place of a body's coordinate, `None` if it is held.
    fn new(mass: &[f64], psi: &[f64], of: &dyn Fn(Body, Axis) -> Option<usize>) -> Self {
        let n = mass.len();
        let root: Vec<f64> = mass.iter().map(|m| m.sqrt()).collect();
        let unit = |i: usize| (0..n).map(|k| f64::from(u8::from(k == i))).collect::<Vec<f64>>();
        let central =
            |axis| Body::CENTRAL.into_iter().filter_map(move |body| of(body, axis)).map(unit);
        let mut rotational: Vec<Vec<f64>> = central(Axis::Rotation).collect();
        let mut translational: Vec<Vec<f64>> =
            central(Axis::First).chain(central(Axis::Second)).collect();
        for axis in Axis::ALL {
            let pattern = |weight: &dyn Fn(f64) -> f64| {
                let mut v = vec![0.0; n];
                for (planet, psi) in psi.iter().enumerate() {
                    if let Some(i) = of(Body::Planet(planet), axis) {
                        v[i] = root[i] * weight(*psi);
                    }
                }
                v
            };
            let alike = orthonormal_basis(&[pattern(&|_| 1.0)], &[]);
            let around = orthonormal_basis(&[pattern(&f64::cos), pattern(&f64::sin)], &alike);
            rotational.extend(alike);
            translational.extend(around);
        }
        Self { bases: [rotational, translational], root }
    }

    /// `[eq:kinds-by-kinetic-energy]` Shares of rotational, translational and planet motion in the directions of a
    /// group of modes, given by their race displacements (real vectors spanning the group).
    ///
    /// Source: as in the lumped model (`eq:mode-kinds`).
    /// Checked by: `table2.fe_contact.types`, `table3.fe_contact.types`.
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

    /// Shares of rotational, translational and planet motion in the kinetic energy of a vibration with the
    /// displacements Re((a + i b) e^{iωt}), the mean over its period; `None` without motion.
    pub(crate) fn shares_of(&self, parts: [&[f64]; 2]) -> Option<[f64; 3]> {
        let scaled =
            parts.map(|part| part.iter().zip(&self.root).map(|(x, r)| x * r).collect::<Vec<f64>>());
        let square = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>();
        let whole: f64 = scaled.iter().map(|v| square(v)).sum();
        let [rotational, translational] = [0, 1].map(|kind: usize| {
            let along = |basis: &Vec<f64>, v: &Vec<f64>| {
                basis.iter().zip(v).map(|(a, b)| a * b).sum::<f64>().powi(2)
            };
            let bases = self.bases[kind].iter();
            bases.map(|b| scaled.iter().map(|v| along(b, v)).sum::<f64>()).sum::<f64>() / whole
        });
        let planet = (1.0 - rotational - translational).max(0.0);
        (whole > 0.0 && whole.is_finite()).then_some([rotational, translational, planet])
    }
}

/// Type by majority of kinetic energy.
pub(crate) fn type_of(shares: &[f64; 3]) -> ModeType {
    match shares {
        [r, _, _] if *r > MAJORITY => ModeType::Rotational,
        [_, t, _] if *t > MAJORITY => ModeType::Translational,
        [_, _, p] if *p > MAJORITY => ModeType::Planet,
        _ => ModeType::Mixed,
    }
}
