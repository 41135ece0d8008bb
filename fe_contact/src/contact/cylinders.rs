//! Two equal half-planes with circular gaps, on which the contact code is compared with Hertz's
//! closed form.

use nalgebra::DMatrix;

use super::half_plane::HalfPlane;
use crate::complementarity::{ComplementarityError, ComplementaritySolver, Problem};
use crate::material::Elastic;

/// A patch in equilibrium with a line load.
#[derive(Debug, Clone)]
pub struct Cylinders {
    /// Middles of the cells, m.
    pub x: Vec<f64>,
    /// Line loads of the cells, N/m.
    pub forces: Vec<f64>,
    /// Width of a cell, m.
    pub width: f64,
    /// Approach without the constant that is added to the half-plane's displacement, m.
    datum: f64,
}

impl Cylinders {
    /// Presses two cylinders of one material with relative radius `radius` (m) by `line_load` (N/m)
    /// on a grid of `cells` cells over ±`reach` (m).
    ///
    /// # Errors
    /// If the contact solver fails.
    pub fn press(
        material: &Elastic,
        radius: f64,
        line_load: f64,
        (reach, cells): (f64, usize),
        solver: &dyn ComplementaritySolver,
    ) -> Result<Self, ComplementarityError> {
        let width = 2.0 * reach / cells as f64;
        let x: Vec<f64> = (0..cells).map(|i| -reach + (i as f64 + 0.5) * width).collect();
        let half = HalfPlane::new(material);
        // The displacement of a half-plane is known up to a constant. A constant that makes it 0 at
        // a depth of 10 m makes the matrix positive definite.
        let far = -2.0 * half.strip(0.0, 10.0, 0.5 * width) / width;
        let compliance = DMatrix::from_fn(cells, cells, |i, j| {
            2.0 * half.strip(x[i] - x[j], 0.0, 0.5 * width) / width + far
        });
        // Bisection on the approach, the total force growing with it.
        let (mut low, mut high) = (0.0, reach * reach / radius + compliance.max() * line_load);
        let mut forces = Vec::new();
        for _ in 0..200 {
            let approach = 0.5 * (low + high);
            let gaps: Vec<f64> = x.iter().map(|x| x * x / (2.0 * radius) - approach).collect();
            let problem = Problem { compliance: &compliance, gaps: &gaps };
            forces = solver.solve(&problem, None)?.forces;
            if forces.iter().sum::<f64>() < line_load {
                low = approach
            } else {
                high = approach
            }
            if high - low <= 1e-15 * high {
                break;
            }
        }
        Ok(Self { x, forces, width, datum: low - far * line_load })
    }

    /// Pressures of the cells, Pa.
    pub fn pressures(&self) -> Vec<f64> {
        self.forces.iter().map(|f| f / self.width).collect()
    }

    /// Approach between the points at `depth` below the centre in both bodies, m.
    pub fn approach(&self, material: &Elastic, depth: f64) -> f64 {
        let half = HalfPlane::new(material);
        let deep = self
            .x
            .iter()
            .zip(&self.forces)
            .map(|(x, f)| 2.0 * f * half.strip(*x, depth, 0.5 * self.width) / self.width);
        self.datum - deep.sum::<f64>()
    }
}
