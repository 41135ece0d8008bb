//! Products of the displacements of a gear under forces on its teeth with its mass.

use nalgebra::DMatrix;

use super::accelerated::Accelerated;
use super::gear_body::GearBody;

/// z = ℓ_a K⁻¹ M_ff K⁻¹ ℓ_bᵀ of loads on the same tooth and on neighbouring ones, over the teeth at all of whose nodes the gear keeps its response.
#[derive(Debug, Clone)]
pub struct ToothGram {
    teeth: i64,
    /// Place of each column of the gear's response among those of the products.
    place_of: Vec<Option<usize>>,
    /// Products of loads on teeth 0, 1, … apart, columns of the first tooth by rows; kg m²/N².
    apart: Vec<DMatrix<f64>>,
}

/// Teeth apart up to which products are kept. Where three pairs of a mesh touch, the outer two are taken not to move each other's teeth, and
/// so are pairs with other planets.
const MOST_APART: i64 = 1;

impl Accelerated {
    /// Products of the responses of a gear to loads of some columns.
    pub fn gram(&self, gear: &GearBody, columns: &[usize]) -> ToothGram {
        let teeth = gear.mesh.nodes.len() as i64;
        let mut place_of = vec![None; 2 * gear.load_count()];
        for (place, column) in columns.iter().enumerate() {
            place_of[*column] = Some(place);
        }
        let reach = (0..=teeth / 2).take_while(|o| gear.response(*o).is_some()).last().unwrap_or(0);
        let of = |offset: i64| Some(gear.response(offset)?.select_columns(columns));
        let near: Vec<_> = (-reach..=reach).map(of).collect();
        let inertia: Vec<_> = near.iter().map(|u| u.as_ref().map(|u| self.times_mass(u))).collect();
        let count = columns.len();
        let products = |apart: i64| {
            // Σ_o r(o)ᵀ M r(o − apart)
            let mut sum = DMatrix::zeros(count, count);
            for (i, u) in near.iter().enumerate() {
                let other = usize::try_from(i as i64 - apart).ok().and_then(|j| inertia.get(j));
                if let (Some(u), Some(Some(m))) = (u, other) {
                    sum.gemm(1.0, &u.transpose(), m, 1.0);
                }
            }
            sum
        };
        ToothGram { teeth, place_of, apart: (0..=MOST_APART).map(products).collect() }
    }
}

impl ToothGram {
    /// z of two loads, the second on a tooth `apart` teeth on, each as columns with weights; 0 for teeth further apart than are kept.
    pub fn between(&self, a: &[(usize, f64)], b: &[(usize, f64)], apart: i64) -> f64 {
        let apart = (apart + self.teeth / 2).rem_euclid(self.teeth) - self.teeth / 2;
        // Of teeth the other way round the same, with both loads exchanged.
        let (a, b) = if apart < 0 { (b, a) } else { (a, b) };
        let Some(products) = self.apart.get(apart.unsigned_abs() as usize) else { return 0.0 };
        let place = |column: usize| self.place_of.get(column).copied().flatten();
        let mut sum = 0.0;
        for (i, x) in a.iter().filter_map(|(column, x)| Some((place(*column)?, x))) {
            for (j, y) in b.iter().filter_map(|(column, y)| Some((place(*column)?, y))) {
                sum += x * products[(i, j)] * y;
            }
        }
        sum
    }
}
