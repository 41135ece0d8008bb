//! The inertia of elastic displacements themselves in a moving set of quasi-static bodies, to first order.
//!
//! The displacement u_s = −K⁻¹ Σ_b ℓ_bᵀ P_b of a body under the forces of its tooth pairs needs the forces M_ff ü_s, under which the pairs give way
//! as under accelerations of the race, and load the races by
//!
//! ```text
//! f = −Σ_a G_aᵀ d²/dt² (Σ_b z_ab P_b),   z_ab = ℓ_a K⁻¹ M_ff K⁻¹ ℓ_bᵀ
//! ```
//!
//! where the derivative follows every tooth with the load that moves along its flank: z_ab is taken between loads at the present and the neighbouring steps. Where a pair
//! begins or ends to touch the velocity u̇_s jumps, and so do the rows of G: the impulse acts by their mean, for which the kinetic energy as a function of the motion,
//! with the place of the jump in it, has its derivative. Rows of one side alone would leave anything from nothing to twice the impulse, by where the steps fall. A small
//! change δ of the motion adds −Gᵀ z G δ̈, as a mass would.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{DMatrix, DVector};

use super::elastic_gears::ElasticGears;
use super::elastic_load::ElasticLoad;
use super::set::VibratingSet;
use crate::body::{LoadProducts, ToothGram};

/// A force on a tooth at one step.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PressedTooth {
    /// Number of the tooth.
    pub(super) tooth: i64,
    /// P, N.
    pub(super) force: f64,
    /// Columns of the gear's response with their weights.
    pub(super) load: Vec<(usize, f64)>,
    /// Row of G, N/m.
    pub(super) given: DVector<f64>,
}

/// Load and mass by the inertia of elastic displacements, by step of a cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct ElasticMass {
    /// f, N.
    pub forces: Vec<DVector<f64>>,
    /// Gᵀ z G, n×n, kg.
    pub masses: Vec<DMatrix<f64>>,
}

impl ElasticGears {
    /// Over the steps of a mesh cycle, `step_s` seconds each, of a steady motion of a set with the bodies of `set`, which may stand.
    pub fn mass(&self, set: &VibratingSet<'_>, cycle: &[ElasticLoad], step_s: f64) -> ElasticMass {
        let n = cycle.first().map_or(0, |own| own.pressed.len());
        let mut all = ElasticMass {
            forces: vec![DVector::zeros(n); cycle.len()],
            masses: vec![DMatrix::zeros(n, n); cycle.len()],
        };
        // Gears with equal teeth share the products of their responses.
        let mut grams: BTreeMap<usize, ToothGram> = BTreeMap::new();
        for (k, gear) in set.bodies.gears.iter().enumerate() {
            let gram = grams.entry(self.kind(k)).or_insert_with(|| {
                let of_kind = cycle.iter().flat_map(|own| own.pressing.iter().enumerate());
                let alike =
                    of_kind.filter(|(j, _)| self.kind(*j) == self.kind(k)).flat_map(|(_, own)| own);
                let columns: BTreeSet<usize> =
                    alike.flat_map(|own| own.load.iter().map(|(column, _)| *column)).collect();
                self.of(k).gram(gear.body, &columns.into_iter().collect::<Vec<_>>())
            });
            let products = |own: &ElasticLoad| {
                own.pressing[k].iter().map(|tooth| gram.of(&tooth.load)).collect::<Vec<_>>()
            };
            let products = cycle.iter().map(products).collect();
            let of_gear = Turned { cycle, products, gear: k };
            for t in 0..cycle.len() as i64 {
                let (mut force, mut mass) = (DVector::zeros(n), DMatrix::zeros(n, n));
                for (share, a) in of_gear.yielding(t) {
                    let mut second = 0.0;
                    for (ahead, factor) in [(-1, 1.0), (0, -2.0), (1, 1.0)] {
                        for ((tooth, b), products) in of_gear.with_products(t + ahead) {
                            let z = gram.between(&a.1.load, products, tooth - a.0);
                            second += factor * z * b.force;
                        }
                    }
                    force.axpy(-share * second / (step_s * step_s), &a.1.given, 1.0);
                }
                for (tooth, a) in of_gear.at(t) {
                    for ((other, b), products) in of_gear.with_products(t) {
                        let z = gram.between(&a.load, products, other - tooth);
                        mass.ger(z, &a.given, &b.given, 1.0);
                    }
                }
                all.forces[t as usize] += force;
                all.masses[t as usize] += mass;
            }
        }
        all
    }
}

/// Forces on the teeth of one gear in a motion that repeats itself.
struct Turned<'c> {
    cycle: &'c [ElasticLoad],
    /// Products of the loads of each step.
    products: Vec<Vec<LoadProducts>>,
    gear: usize,
}

impl<'c> Turned<'c> {
    /// Those at step t of any cycle, with the number of the tooth in that cycle.
    fn at(&self, t: i64) -> impl Iterator<Item = (i64, &'c PressedTooth)> {
        let steps = self.cycle.len() as i64;
        let own = &self.cycle[t.rem_euclid(steps) as usize];
        let passed = t.div_euclid(steps) * own.teeth_per_cycle[self.gear];
        own.pressing[self.gear].iter().map(move |tooth| (tooth.tooth + passed, tooth))
    }

    /// The same with the products of their loads.
    fn with_products(
        &self,
        t: i64,
    ) -> impl Iterator<Item = ((i64, &'c PressedTooth), &LoadProducts)> {
        let products = &self.products[t.rem_euclid(self.cycle.len() as i64) as usize];
        self.at(t).zip(products)
    }

    /// Whether other teeth are pressed at step t + 1 than at step t.
    fn changes_after(&self, t: i64) -> bool {
        let teeth = |t: i64| self.at(t).map(|(tooth, _)| tooth).collect::<BTreeSet<_>>();
        teeth(t) != teeth(t + 1)
    }

    /// The forces by which the races yield at step t, each with its share: where a pair begins or ends to touch, velocities jump while the rows of G do, and
    /// the mean of both sides acts.
    fn yielding(&self, t: i64) -> Vec<(f64, (i64, &'c PressedTooth))> {
        // The steps beside this one on the other side of a change.
        let mut others = Vec::new();
        if self.changes_after(t - 1) {
            others.push(t - 1);
        }
        if self.changes_after(t) {
            others.push(t + 1);
        }
        let share = 0.5 / others.len().max(1) as f64;
        let own_share = if others.is_empty() { 1.0 } else { 0.5 };
        let own = self.at(t).map(|a| (own_share, a));
        own.chain(others.into_iter().flat_map(|o| self.at(o).map(move |a| (share, a)))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::elastic_gears::tests::oh58_at_rest;
    use super::super::elastic_inertia::pressing;
    use super::*;

    /// In every mode of a set at rest φᵀ Gᵀ z G φ is the kinetic energy u_sᵀM_ff u_s of all gears, which is summed over their teeth by other means: here over products of
    /// loads on the same and on neighbouring teeth.
    #[test]
    fn mass_is_the_energy_of_the_displacements_of_a_mode() {
        oh58_at_rest(6, |set| {
            let linear = set.linearised().unwrap();
            let gears = ElasticGears::new(set).unwrap().unwrap();
            let load = gears.load(set, &linear).unwrap();
            let mass = &gears.mass(set, &[load], 5e-6).masses[0];
            let frame = set.frames.current(set.clock.step_in_cycle).unwrap();
            let (frequencies, shapes) = linear.undamped().unwrap();
            let mut compared = 0;
            for (shape, _) in shapes.column_iter().zip(&frequencies).filter(|(_, f)| **f > 100.0) {
                let z = DVector::from_iterator(shape.nrows(), shape.iter().copied());
                let forces = &linear.contact * (&linear.rows * &z);
                let energy = |k: usize| {
                    let body = set.bodies.gears[k].body;
                    gears.of(k).energy(body, &pressing(frame, k, body, &forces).0, [0.0; 3])
                };
                let expected: f64 = (0..set.bodies.gears.len()).map(energy).sum();
                let got = z.dot(&(mass * &z));
                // Displacements that meet from meshes of other planets are left out here.
                assert!((got - expected).abs() < 5e-3 * expected, "{got:e} {expected:e}");
                compared += 1;
            }
            assert!(compared > 14, "{compared}");
        });
    }
}
