//! A picture of meshes set together.

use std::collections::HashSet;
use std::fmt::Write as _;

use super::outline::Drawn;

/// A mesh with its place.
#[derive(Debug)]
pub struct Placed<'d> {
    /// Mesh.
    pub drawn: &'d Drawn,
    /// Centre, m.
    pub centre: [f64; 2],
    /// Angle of tooth 0's axis, rad.
    pub angle: f64,
    /// Line colour.
    pub colour: &'static str,
}

/// SVG of meshes in their places; every element edge is drawn once, through its middle.
pub fn picture(bodies: &[Placed<'_>], title: &str) -> String {
    let mut reach = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let mut paths = String::new();
    for body in bodies {
        let (sin, cos) = body.angle.sin_cos();
        // Millimetres, y upwards.
        let at = |[x, y]: [f64; 2]| {
            [
                1e3 * (body.centre[0] + cos * x - sin * y),
                -1e3 * (body.centre[1] + sin * x + cos * y),
            ]
        };
        let mut seen = HashSet::new();
        let mut path = String::new();
        for e in &body.drawn.elements {
            for edge in 0..4 {
                let (a, b) = (e.nodes[edge], e.nodes[(edge + 1) % 4]);
                if !seen.insert((a.min(b), a.max(b))) {
                    continue;
                }
                let [p, m, q] = [a, e.nodes[4 + edge], b].map(|n| at(body.drawn.points[n]));
                // A parabola through the middle: control point 2m − (p + q)/2.
                let c = [0, 1].map(|k| 2.0 * m[k] - 0.5 * (p[k] + q[k]));
                // Writing to a string cannot fail.
                let _ = write!(
                    path,
                    "M{:.3} {:.3}Q{:.3} {:.3} {:.3} {:.3}",
                    p[0], p[1], c[0], c[1], q[0], q[1]
                );
                for point in [p, q] {
                    reach[0] = reach[0].min(point[0]);
                    reach[1] = reach[1].min(point[1]);
                    reach[2] = reach[2].max(point[0]);
                    reach[3] = reach[3].max(point[1]);
                }
            }
        }
        let _ = writeln!(paths, "<path d=\"{path}\" stroke=\"{}\"/>", body.colour);
    }
    let margin = 0.02 * (reach[2] - reach[0]);
    let (x, y) = (reach[0] - margin, reach[1] - margin);
    let (w, h) = (reach[2] - reach[0] + 2.0 * margin, reach[3] - reach[1] + 2.0 * margin);
    let line = 4e-4 * w;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{x:.3} {y:.3} {w:.3} {h:.3}\" width=\"1000\" height=\"{:.0}\">\n<title>{}</title>\n<rect x=\"{x:.3}\" y=\"{y:.3}\" width=\"{w:.3}\" height=\"{h:.3}\" fill=\"#ffffff\"/>\n<g fill=\"none\" stroke-width=\"{line:.4}\">\n{paths}</g>\n</svg>\n",
        1000.0 * h / w,
        title.replace('&', "&amp;").replace('<', "&lt;")
    )
}
