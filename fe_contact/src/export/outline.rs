//! Elements as four corners and four mid-side nodes, for every kind of edge.

use std::collections::HashMap;

use crate::element::Shape;
use crate::fe_mesh::{FeCarrierMesh, FeGearMesh};

/// One element: nodes of [`Drawn::points`] in the order of the eight-node element.
#[derive(Debug, Clone, Copy)]
pub struct DrawnElement {
    /// Corners, then middles of the edges 0–1, 1–2, 2–3, 3–0.
    pub nodes: [usize; 8],
    /// Tooth it belongs to (0 for the carrier).
    pub part: usize,
}

/// A mesh ready to be drawn.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// Points, m.
    pub points: Vec<[f64; 2]>,
    /// Elements.
    pub elements: Vec<DrawnElement>,
}

impl Drawn {
    /// A gear's mesh.
    pub fn gear(mesh: &FeGearMesh) -> Self {
        let elements = mesh.elements.iter().map(|e| (e.shape, e.nodes.as_slice(), e.tooth));
        Self::collect(&mesh.points, elements)
    }

    /// The carrier's mesh.
    pub fn carrier(mesh: &FeCarrierMesh) -> Self {
        let elements =
            mesh.elements.iter().map(|nodes| (FeCarrierMesh::shape(), nodes.as_slice(), 0));
        Self::collect(&mesh.points, elements)
    }

    fn collect<'m>(
        points: &[[f64; 2]],
        elements: impl Iterator<Item = (Shape, &'m [usize], usize)>,
    ) -> Self {
        let mut drawn = Self { points: Vec::new(), elements: Vec::new() };
        let mut corners: HashMap<usize, usize> = HashMap::new();
        let mut middles: HashMap<(usize, usize), usize> = HashMap::new();
        for (shape, nodes, part) in elements {
            let at = |xi: f64, eta: f64| {
                let v = shape.at(xi, eta);
                let mut p = [0.0; 2];
                for (n, node) in v.n[..v.count].iter().zip(nodes) {
                    p[0] += n * points[*node][0];
                    p[1] += n * points[*node][1];
                }
                p
            };
            let mut own = [0; 8];
            for (slot, node) in own.iter_mut().zip(&nodes[..4]) {
                *slot = *corners.entry(*node).or_insert_with(|| {
                    drawn.points.push(points[*node]);
                    drawn.points.len() - 1
                });
            }
            let places = [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)];
            for (edge, (xi, eta)) in places.into_iter().enumerate() {
                let (a, b) = (own[edge], own[(edge + 1) % 4]);
                own[4 + edge] = *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    drawn.points.push(at(xi, eta));
                    drawn.points.len() - 1
                });
            }
            drawn.elements.push(DrawnElement { nodes: own, part });
        }
        drawn
    }
}
