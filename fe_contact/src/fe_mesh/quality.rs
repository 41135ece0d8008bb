//! How well shaped the elements are.

use serde::Serialize;

use super::sector::Sector;

/// Worst values over a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Quality {
    /// Smallest corner angle, degrees.
    pub least_angle_deg: f64,
    /// Largest corner angle, degrees.
    pub largest_angle_deg: f64,
    /// Largest ratio of an element's longest to its shortest side.
    pub aspect_ratio: f64,
    /// Smallest det J over the element's largest, at 5×5 points.
    pub jacobian_ratio: f64,
}

impl Quality {
    /// Quality of the sectors a mesh is made of.
    pub fn of(sectors: &[Sector]) -> Self {
        let mut q = Self {
            least_angle_deg: 180.0,
            largest_angle_deg: 0.0,
            aspect_ratio: 1.0,
            jacobian_ratio: 1.0,
        };
        for sector in sectors {
            for e in &sector.elements {
                let points: Vec<_> =
                    e.nodes[..e.shape.count()].iter().map(|n| sector.points[*n]).collect();
                let side =
                    |a: usize, b: usize| [points[b][0] - points[a][0], points[b][1] - points[a][1]];
                let lengths: Vec<f64> =
                    (0..4).map(|i| side(i, (i + 1) % 4)).map(|d| d[0].hypot(d[1])).collect();
                let longest = lengths.iter().fold(0.0f64, |a, b| a.max(*b));
                let shortest = lengths.iter().fold(f64::INFINITY, |a, b| a.min(*b));
                q.aspect_ratio = q.aspect_ratio.max(longest / shortest);
                for i in 0..4 {
                    let (a, b) = (side(i, (i + 1) % 4), side(i, (i + 3) % 4));
                    let cross = a[0] * b[1] - a[1] * b[0];
                    let angle = cross.atan2(a[0] * b[0] + a[1] * b[1]).to_degrees();
                    q.least_angle_deg = q.least_angle_deg.min(angle);
                    q.largest_angle_deg = q.largest_angle_deg.max(angle);
                }
                let (mut least, mut most) = (f64::INFINITY, 0.0f64);
                for i in 0..5 {
                    for j in 0..5 {
                        let v = e.shape.at(-1.0 + 0.5 * f64::from(i), -1.0 + 0.5 * f64::from(j));
                        let mut m = [[0.0; 2]; 2];
                        for (k, p) in points.iter().enumerate() {
                            for c in 0..2 {
                                m[0][c] += v.dxi[k] * p[c];
                                m[1][c] += v.deta[k] * p[c];
                            }
                        }
                        let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
                        least = least.min(determinant);
                        most = most.max(determinant);
                    }
                }
                q.jacobian_ratio = q.jacobian_ratio.min(least / most);
            }
        }
        q
    }
}
