//! Shape functions of quadrilaterals whose edges differ: straight, quadratic or C¹ Hermite.
//!
//! The field is the bilinear one plus, for each curved edge, the edge's departure from the straight line, blended
//! linearly to nothing at the opposite edge. With four quadratic edges this is the eight-node serendipity element.
//! Geometry and displacement use the same functions, so rigid motions and constant strains are exact.

/// How geometry and displacement run along an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// Straight between two corners.
    Linear,
    /// Through a node at the middle.
    Quadratic,
    /// Cubic, from values and arc-length derivatives at the corners: C¹ along the flank.
    Hermite,
}

/// Most functions one element has: four corners and two for each edge.
pub const MOST: usize = 12;

/// Corners at (ξ, η) = (−1, −1), (1, −1), (1, 1), (−1, 1); edges 0: η = −1, 1: ξ = 1, 2: η = 1,
/// 3: ξ = −1, each run in the direction of growing ξ or η.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Kind of each edge.
    pub edges: [Edge; 4],
    /// Δℓ/2 of Hermite edges, positive if ℓ grows along the edge's direction, m.
    pub half_lengths: [f64; 4],
}

/// Values and derivatives of all functions at one point.
#[derive(Debug, Clone, Copy, Default)]
pub struct Values {
    /// Number of functions.
    pub count: usize,
    /// N.
    pub n: [f64; MOST],
    /// ∂N/∂ξ.
    pub dxi: [f64; MOST],
    /// ∂N/∂η.
    pub deta: [f64; MOST],
}

/// First and last corner of each edge.
const ENDS: [(usize, usize); 4] = [(0, 1), (1, 2), (3, 2), (0, 3)];

impl Shape {
    /// Four straight edges.
    pub const LINEAR: Self = Self { edges: [Edge::Linear; 4], half_lengths: [0.0; 4] };

    /// The eight-node element.
    pub const QUADRATIC: Self = Self { edges: [Edge::Quadratic; 4], half_lengths: [0.0; 4] };

    /// Number of functions: corners, then for each edge in turn its middle node (quadratic) or its
    /// two derivatives (Hermite).
    pub fn count(&self) -> usize {
        4 + self.edges.iter().map(|e| own_functions(*e)).sum::<usize>()
    }

    /// Whether all edges are straight.
    pub fn is_linear(&self) -> bool {
        self.edges.iter().all(|e| *e == Edge::Linear)
    }

    /// `[eq:shape-functions]` Functions at (ξ, η): the bilinear ¼ (1 ± ξ)(1 ± η), plus for each curved edge its
    /// departure from the straight line times the weight ½ (1 ± ξ) or ½ (1 ± η) that falls to 0 at the opposite edge.
    ///
    /// Source: Gordon & Hall, Numer. Math. 21 (1973) 109–129.
    /// Checked by: `fe_contact/tests/elements.rs::patch_test`,
    /// `fe_contact/tests/elements.rs::orders_of_convergence_on_a_manufactured_solution`,
    /// `fe_contact/src/element/shape.rs::four_quadratic_edges_are_the_serendipity_element`.
    pub fn at(&self, xi: f64, eta: f64) -> Values {
        let mut v = Values { count: self.count(), ..Values::default() };
        for (corner, (sx, sy)) in
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].iter().enumerate()
        {
            v.n[corner] = 0.25 * (1.0 + sx * xi) * (1.0 + sy * eta);
            v.dxi[corner] = 0.25 * sx * (1.0 + sy * eta);
            v.deta[corner] = 0.25 * sy * (1.0 + sx * xi);
        }
        let mut next = 4;
        for (edge, (a, b)) in ENDS.into_iter().enumerate() {
            // Coordinate t along the edge, and the weight w that falls to 0 at the opposite edge.
            let (t, w, dw) = match edge {
                0 => (xi, 0.5 * (1.0 - eta), -0.5),
                1 => (eta, 0.5 * (1.0 + xi), 0.5),
                2 => (xi, 0.5 * (1.0 + eta), 0.5),
                _ => (eta, 0.5 * (1.0 - xi), -0.5),
            };
            let (along, f) =
                (edge % 2 == 0, departure(self.edges[edge], t, self.half_lengths[edge]));
            let targets = [a, b, next, next + 1];
            for (target, (value, slope)) in targets.into_iter().zip(f) {
                if value == 0.0 && slope == 0.0 {
                    continue;
                }
                v.n[target] += w * value;
                let (d_along, d_across) = (w * slope, dw * value);
                v.dxi[target] += if along { d_along } else { d_across };
                v.deta[target] += if along { d_across } else { d_along };
            }
            next += own_functions(self.edges[edge]);
        }
        v
    }
}

fn own_functions(edge: Edge) -> usize {
    match edge {
        Edge::Linear => 0,
        Edge::Quadratic => 1,
        Edge::Hermite => 2,
    }
}

/// Departure of an edge's functions from the straight line, with derivative in t: for the two
/// corners and up to two functions of the edge's own.
fn departure(edge: Edge, t: f64, half: f64) -> [(f64, f64); 4] {
    const NONE: (f64, f64) = (0.0, 0.0);
    match edge {
        Edge::Linear => [NONE; 4],
        Edge::Quadratic => {
            // M = 1 − t² for the middle node; M/2 is subtracted from the function of each corner.
            let (m, dm) = (1.0 - t * t, -2.0 * t);
            [(-0.5 * m, -0.5 * dm), (-0.5 * m, -0.5 * dm), (m, dm), NONE]
        }
        Edge::Hermite => {
            // On t ∈ [−1, 1]: H₀₀ = (2 − 3t + t³)/4 = (1 − t)/2 + (t³ − t)/4, and so on.
            let (c, dc) = (0.25 * (t * t * t - t), 0.25 * (3.0 * t * t - 1.0));
            // H₁₀ = (1 − t − t² + t³)/4, H₁₁ = (−1 − t + t² + t³)/4, times dℓ/dt.
            let (p, dp) =
                (0.25 * (1.0 - t - t * t + t * t * t), 0.25 * (-1.0 - 2.0 * t + 3.0 * t * t));
            let (q, dq) =
                (0.25 * (-1.0 - t + t * t + t * t * t), 0.25 * (-1.0 + 2.0 * t + 3.0 * t * t));
            [(c, dc), (-c, -dc), (half * p, half * dp), (half * q, half * dq)]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_quadratic_edges_are_the_serendipity_element() {
        let v = Shape::QUADRATIC.at(0.3, -0.7);
        let (xi, eta) = (0.3, -0.7);
        // N₁ = −(1 − ξ)(1 − η)(1 + ξ + η)/4, N₅ = (1 − ξ²)(1 − η)/2
        assert!((v.n[0] + 0.25 * (1.0 - xi) * (1.0 - eta) * (1.0 + xi + eta)).abs() < 1e-15);
        assert!((v.n[4] - 0.5 * (1.0 - xi * xi) * (1.0 - eta)).abs() < 1e-15);
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        let shape = Shape {
            edges: [Edge::Hermite, Edge::Quadratic, Edge::Linear, Edge::Hermite],
            half_lengths: [0.4, 0.0, 0.0, -0.3],
        };
        let (xi, eta, d) = (0.31, -0.42, 1e-6);
        let (v, count) = (shape.at(xi, eta), shape.count());
        let (right, left) = (shape.at(xi + d, eta), shape.at(xi - d, eta));
        let (up, down) = (shape.at(xi, eta + d), shape.at(xi, eta - d));
        for i in 0..count {
            assert!((v.dxi[i] - (right.n[i] - left.n[i]) / (2.0 * d)).abs() < 1e-9);
            assert!((v.deta[i] - (up.n[i] - down.n[i]) / (2.0 * d)).abs() < 1e-9);
        }
        assert_eq!(count, 9);
    }

    #[test]
    fn position_functions_sum_to_one() {
        let shape = Shape {
            edges: [Edge::Hermite, Edge::Quadratic, Edge::Quadratic, Edge::Linear],
            half_lengths: [0.7, 0.0, 0.0, 0.0],
        };
        let v = shape.at(-0.2, 0.6);
        // Corners and middle nodes; the derivatives (4, 5) carry no translation.
        let sum: f64 = (0..v.count).filter(|i| ![4, 5].contains(i)).map(|i| v.n[i]).sum();
        assert!((sum - 1.0).abs() < 1e-15);
    }
}
