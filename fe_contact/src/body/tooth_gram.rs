//! Products of the displacements of a gear under forces on its teeth with its mass.

use nalgebra::{DMatrix, DVector};

use super::accelerated::Accelerated;
use super::gear_body::GearBody;

/// z = ℓ_a K⁻¹ M_ff K⁻¹ ℓ_bᵀ of loads on the same tooth and on neighbouring ones, over all teeth.
#[derive(Debug, Clone)]
pub struct ToothGram {
    teeth: i64,
    /// Place of each column of the gear's response among those of the products.
    place_of: Vec<Option<usize>>,
    /// Products of loads from −[`MOST_APART`] teeth apart on, columns of the first tooth by rows; kg m²/N².
    apart: Vec<DMatrix<f64>>,
}

/// Teeth apart up to which products are kept. Where three pairs of a mesh touch, the outer two are taken not to move each other's teeth, and
/// so are pairs with other planets.
const MOST_APART: i64 = 1;

/// Displacement of the cuts of a sector, over the largest of all, up to which it moves too little to count: by its square in the products.
const COUNTS: f64 = 1e-4;

impl Accelerated {
    /// Products of the responses to loads of some columns.
    ///
    /// Sector j moves by E (v_j, v_{j+1}) with the displacements v of the cuts, and the loaded sector 0 by u_held besides, so that the products over all
    /// teeth are small ones. With Q = EᵀM E in blocks of first (a) and next (b) cut, and second loads on the tooth of sector s,
    ///
    /// ```text
    /// z_s = Σ_j v_jᵀ w_{j−s} + c_sᵀ (EᵀM u_held) + (u_heldᵀM E) c_{−s} + δ_s0 u_heldᵀM u_held
    /// w_j = (Q_aa + Q_bb) v_j + Q_ab v_{j+1} + Q_ba v_{j−1},   c_j = (v_j, v_{j+1})
    /// ```
    pub fn gram(&self, gear: &GearBody, columns: &[usize]) -> ToothGram {
        let teeth = gear.mesh.nodes.len();
        let mut place_of = vec![None; 2 * gear.load_count()];
        for (place, column) in columns.iter().enumerate() {
            place_of[*column] = Some(place);
        }
        let (carried, held) = (&self.ring.sector.carried, self.ring.held(columns));
        let inertia = self.times_mass(carried);
        let q = carried.transpose() * &inertia;
        let mixed = inertia.transpose() * &held;
        let of_held = held.transpose() * self.times_mass(&held);
        let (m, count) = (self.ring.sector.cut, columns.len());
        // Displacements of the cuts of sectors so far off that they do not count are zero.
        let mut v = self.ring.stacked(columns);
        let largest = v.amax();
        let counts: Vec<bool> =
            (0..teeth).map(|j| v.rows(j * m, m).amax() > COUNTS * largest).collect();
        (0..teeth).filter(|j| !counts[*j]).for_each(|j| v.rows_mut(j * m, m).fill(0.0));
        let block = |r: usize, c: usize| q.view((r * m, c * m), (m, m));
        let own = block(0, 0) + block(1, 1);
        let cut = |j: usize| v.rows(j % teeth * m, m);
        let w: Vec<_> = (0..teeth)
            .map(|j| {
                let parts =
                    [(j, own.as_view()), (j + 1, block(0, 1)), (j + teeth - 1, block(1, 0))];
                let mut parts = parts.into_iter().filter(|(j, _)| counts[j % teeth]).peekable();
                parts.peek()?;
                let mut here = DMatrix::zeros(m, count);
                parts.for_each(|(j, block)| here.gemm(1.0, &block, &cut(j), 1.0));
                Some(here)
            })
            .collect();
        let transposed = v.transpose();
        let both = |j: usize| {
            let mut c = DMatrix::zeros(2 * m, count);
            c.rows_mut(0, m).copy_from(&cut(j));
            c.rows_mut(m, m).copy_from(&cut(j + 1));
            c
        };
        let products = |apart: i64| {
            let s = self.ring.sector_of(apart);
            let mut sum =
                both(s).transpose() * &mixed + mixed.transpose() * both((teeth - s) % teeth);
            for j in (0..teeth).filter(|j| counts[*j]) {
                if let Some(w) = &w[(j + teeth - s) % teeth] {
                    sum.gemm(1.0, &transposed.columns(j * m, m), w, 1.0);
                }
            }
            if s == 0 {
                sum += &of_held;
            }
            sum
        };
        let on: Vec<_> = (0..=MOST_APART).map(products).collect();
        // Of teeth the other way round the same, with both loads exchanged.
        let back = on.iter().skip(1).rev().map(DMatrix::transpose);
        let apart = back.chain(on.iter().cloned()).collect();
        ToothGram { teeth: teeth as i64, place_of, apart }
    }
}

impl ToothGram {
    /// Products of one load, as columns with weights, with every column loaded alone.
    pub fn of(&self, load: &[(usize, f64)]) -> LoadProducts {
        let places: Vec<_> = load.iter().filter_map(|(c, x)| Some((self.place(*c)?, *x))).collect();
        let one = |products: &DMatrix<f64>| {
            let mut sum = DVector::zeros(products.nrows());
            places.iter().for_each(|(j, y)| sum.axpy(*y, &products.column(*j), 1.0));
            sum
        };
        LoadProducts { apart: self.apart.iter().map(one).collect() }
    }

    /// z of two loads, the first as columns with weights, the second on a tooth `apart` teeth on; 0 for teeth further apart than are kept.
    pub fn between(&self, a: &[(usize, f64)], b: &LoadProducts, apart: i64) -> f64 {
        let apart = (apart + self.teeth / 2).rem_euclid(self.teeth) - self.teeth / 2;
        let products = usize::try_from(apart + MOST_APART).ok().and_then(|i| b.apart.get(i));
        let Some(products) = products else { return 0.0 };
        a.iter().filter_map(|(column, x)| Some(x * products[self.place(*column)?])).sum()
    }

    fn place(&self, column: usize) -> Option<usize> {
        self.place_of.get(column).copied().flatten()
    }
}

/// Products of one load with every column of a gear's response loaded alone, kg m²/N².
#[derive(Debug, Clone)]
pub struct LoadProducts {
    /// By the number of teeth that the load is on from the column's, from −[`MOST_APART`] on.
    apart: Vec<DVector<f64>>,
}

#[cfg(test)]
mod tests {
    use gearset::Scene;

    use super::*;
    use crate::body::BodyMatrices;
    use crate::body::matrices::number_unknowns;
    use crate::fe_mesh::Side;
    use crate::statics::Bodies;

    /// Products of loads on the same tooth and on both neighbours are those of the displacements of the assembled whole gear with all of its mass.
    #[test]
    fn products_are_those_of_the_whole_gear() {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let mut scene = Scene::from_file(path.as_ref()).unwrap();
        scene.fe_contact.flank_elements = 6;
        let bodies = Bodies::new(&scene).unwrap();
        for body in [bodies.sun.as_ref().unwrap(), &bodies.planet, bodies.ring.as_ref().unwrap()] {
            let (mesh, length) = (&body.mesh, body.mesh.outline.flank_length());
            let load = |part: f64, direction: [f64; 2]| -> Vec<(usize, f64)> {
                let spread = body.flank_load(Side::Ccw, part * length, 0.05 * length);
                let both = |(column, weight): (usize, f64)| {
                    [(column, weight * direction[0]), (column + 1, weight * direction[1])]
                };
                spread.into_iter().flat_map(both).collect()
            };
            let (a, b) = (load(0.4, [0.6, 0.8]), load(0.75, [-0.8, 0.6]));
            let mut columns: Vec<_> = a.iter().chain(&b).map(|(column, _)| *column).collect();
            columns.sort_unstable();
            columns.dedup();
            let gram = Accelerated::new(body).unwrap().unwrap().gram(body, &columns);
            let whole = BodyMatrices::of_gear(mesh, &body.material, body.face_width).unwrap();
            let factor = whole.stiffness.factorise(mesh.name).unwrap();
            let unknown_of = number_unknowns(mesh);
            let moved = |load: &[(usize, f64)], tooth: usize| {
                let (sin, cos) = mesh.tooth_angle(tooth).sin_cos();
                let mut u = vec![0.0; whole.size];
                for (column, f) in load {
                    let unknown = unknown_of[mesh.nodes[tooth][body.node_of(*column)]];
                    // Of the tooth's frame turned into that of the gear.
                    let [x, y] = [[cos, sin], [-sin, cos]][column % 2];
                    u[unknown] += f * x;
                    u[unknown + 1] += f * y;
                }
                factor.solve_one(&mut u);
                u
            };
            let u = moved(&a, 0);
            let mut inertia = vec![0.0; whole.size];
            whole.mass.multiply_add(1.0, &u, &mut inertia);
            // Each sector that does not count leaves no more than a part COUNTS² of the product of a load with itself.
            let own = gram.between(&a, &gram.of(&a), 0);
            let allowed = mesh.nodes.len() as f64 * COUNTS * COUNTS * own;
            for apart in [-1i64, 0, 1] {
                let teeth = mesh.nodes.len() as i64;
                let other = moved(&b, apart.rem_euclid(teeth) as usize);
                let expected: f64 = inertia.iter().zip(&other).map(|(m, u)| m * u).sum();
                let got = gram.between(&a, &gram.of(&b), apart);
                let off = (got - expected).abs();
                assert!(off < allowed, "{} {apart}: {got:e} {expected:e}", mesh.name);
            }
        }
    }
}
