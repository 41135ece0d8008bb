//! Flank elements divided in three along and across the flank, and the elements that join them to those behind.
//!
//! Elements of the first column behind a flank become nine; those of the second column, and the one below the first
//! flank element, become four, with three edges on the divided side and one on each other:
//!
//! ```text
//! t = 1   T3 ─────────────────── B1         s = −1: the divided side, s = 1: the one opposite.
//!          │      ___________/   │          C = (0, −1/3), D = (0, 1/3)
//!         T2 ─── D               │
//!          │     │               │          Every edge is shared by two whole elements or by none: the mesh stays conforming,
//!         T1 ─── C ___________   │          without constraints on hanging nodes.
//!          │                  \  │
//! t = −1  T0 ─────────────────── B0
//! ```

use scene::ElementFamily;

use super::sector::{Builder, Place};
use crate::element::{Edge, Shape};

/// Parts of a divided edge.
pub(super) const PARTS: usize = 3;

/// Fractions with every interval divided.
pub(super) fn divided(fractions: &[f64]) -> Vec<f64> {
    let parts = |pair: &[f64]| {
        let (from, to) = (pair[0], pair[1]);
        (0..PARTS).map(move |k| from + (to - from) * k as f64 / PARTS as f64)
    };
    fractions.windows(2).flat_map(parts).chain(fractions.last().copied()).collect()
}

/// The value `part` parts of an interval beyond the entry `at` of a list.
pub(super) fn between(list: &[f64], at: usize, part: usize) -> f64 {
    let next = list[(at + 1).min(list.len() - 1)];
    list[at] + part as f64 / PARTS as f64 * (next - list[at])
}

/// Lattice of a column of divided elements: half edges of theirs from the corner of the first flank element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layer {
    /// Column of the tooth block where it begins.
    pub(super) column: usize,
    /// Row of the tooth block where the flank begins.
    pub(super) row: usize,
    /// Whether the flank is on the side of growing columns.
    pub(super) is_last: bool,
}

impl Layer {
    /// Place of a node: that of the tooth block's lattice where it is one of its nodes.
    pub(super) fn place(&self, i: usize, j: usize) -> Place {
        match (i % PARTS, j % PARTS) {
            (0, 0) => Place::Tooth(self.column + i / PARTS, self.row + j / PARTS),
            _ => Place::Layer(self.is_last, i, j),
        }
    }

    /// Whether a column of the lattice lies on the flank.
    pub(super) fn is_on_flank(&self, i: usize) -> bool {
        i == if self.is_last { 2 * PARTS } else { 0 }
    }
}

/// Side of an element on which its neighbour is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Divided {
    First,
    Last,
    Above,
}

impl Divided {
    /// (ξ, η) of the element at (s, t): turned so that the divided side is s = −1.
    fn turned(self, [s, t]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::First => [s, t],
            Self::Last => [-s, -t],
            Self::Above => [t, -s],
        }
    }
}

impl Builder<'_> {
    /// Adds the nodes of a layer with so many rows that the tooth block's lattice does not have; `at`: point at a
    /// column and a row of the layer, whose first column is that of the block's lattice.
    pub(super) fn layer_nodes(
        &mut self,
        layer: &Layer,
        rows: usize,
        at: &dyn Fn(usize, usize, usize) -> [f64; 2],
    ) {
        for j in 0..rows {
            for i in 0..=2 * PARTS {
                let place = layer.place(i, j);
                let is_derivative = layer.is_on_flank(i) && j % 2 == 1;
                if self.is_node(i, j) && !is_derivative && !self.nodes.contains_key(&place) {
                    self.add(place, at(i, j, layer.column));
                }
            }
        }
    }

    /// Adds what takes the place of the element at lattice (i, j) of the tooth block where a flank behind it or beside
    /// it is divided, those on the flanks also to `on_flanks` (first column, last column); whether there is any.
    /// `half_length`: half of Δℓ of a flank element that is not divided, m.
    pub(super) fn divided(
        &mut self,
        (i, j): (usize, usize),
        layers: &[Layer; 2],
        half_length: f64,
        on_flanks: &mut [Vec<usize>; 2],
    ) -> bool {
        let [first, last] = layers;
        let on_flank = j >= first.row;
        for (layer, list) in layers.iter().zip(on_flanks) {
            let column = layer.column;
            if i == column && on_flank {
                list.extend(self.nine(layer, j, half_length / PARTS as f64));
                return true;
            }
            if i == column && j + 2 == layer.row {
                self.transition((i, j), layer, Divided::Above);
                return true;
            }
        }
        if on_flank && i == first.column + 2 {
            self.transition((i, j), first, Divided::First);
            return true;
        }
        if on_flank && i + 2 == last.column {
            self.transition((i, j), last, Divided::Last);
            return true;
        }
        false
    }

    /// The nine elements behind a flank element at row j of the tooth block; returns those on the flank.
    fn nine(&mut self, layer: &Layer, j: usize, half_length: f64) -> [usize; PARTS] {
        let row = PARTS * (j - layer.row);
        let (edge, column) = if layer.is_last { (1, PARTS - 1) } else { (3, 0) };
        [0, 1, 2].map(|b| {
            let mut on_flank = 0;
            for a in 0..PARTS {
                let (mut edges, mut lengths) = ([Edge::Quadratic; 4], [0.0; 4]);
                if a == column {
                    (edges[edge], lengths[edge]) = (Edge::Hermite, half_length);
                }
                let place = |i: usize, j: usize| layer.place(i, j);
                let element = self.element(&place, (2 * a, row + 2 * b), edges, lengths);
                if a == column {
                    on_flank = element;
                }
            }
            on_flank
        })
    }

    /// The four elements in place of the one at lattice (i, j) of the tooth block, whose neighbour on one side is
    /// divided.
    fn transition(&mut self, (i, j): (usize, usize), layer: &Layer, divided: Divided) {
        let quadratic = self.family == ElementFamily::Quadratic;
        // Nodes of the divided side, ascending in t; of linear elements each second one alone.
        let along: [usize; 2 * PARTS + 1] = std::array::from_fn(|k| {
            let place = match divided {
                Divided::First => layer.place(2 * PARTS, PARTS * (j - layer.row) + k),
                Divided::Last => layer.place(0, PARTS * (j - layer.row) + 2 * PARTS - k),
                Divided::Above => layer.place(k, 0),
            };
            if quadratic || k % 2 == 0 { self.node(place) } else { usize::MAX }
        });
        // Node of the whole element at (s, t), each −1, 0 or 1.
        let whole = |b: &Self, at: [f64; 2]| {
            let [u, v] = divided.turned(at).map(|x| x as i64);
            let at = |first: usize, own: i64| first + (own + 1) as usize;
            let is_middle = u * v == 0;
            if is_middle && !quadratic {
                usize::MAX
            } else {
                b.node(Place::Tooth(at(i, u), at(j, v)))
            }
        };
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let middles = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];
        let shape = if quadratic { Shape::QUADRATIC } else { Shape::LINEAR };
        // In the turned coordinates (s, t) the element has its functions in their own order.
        let own = corners.into_iter().chain(middles).take(shape.count());
        let points: Vec<[f64; 2]> = own.map(|at| self.sector.points[whole(self, at)]).collect();
        let mut inner = |[s, t]: [f64; 2]| {
            let n = shape.at(s, t).n;
            let place = |k: usize| points.iter().zip(n).map(|(p, n)| n * p[k]).sum::<f64>();
            self.added([place(0), place(1)])
        };
        let third = 1.0 / PARTS as f64;
        let [c, d] = [inner([0.0, -third]), inner([0.0, third])];
        let of_edges =
            [[0.5, -2.0 * third], [0.5, 2.0 * third], [0.0, 0.0], [-0.5, -third], [-0.5, third]];
        let [cb, db, cd, tc, td] =
            of_edges.map(|at| if quadratic { inner(at) } else { usize::MAX });
        let [_, b0, b1, _] = corners.map(|at| whole(self, at));
        let [low, opposite, high, _] = middles.map(|at| whole(self, at));
        let [t0, m0, t1, m1, t2, m2, t3] = along;
        for nodes in [
            ([c, b0, b1, d], [cb, opposite, db, cd]),
            ([t1, c, d, t2], [tc, cd, td, m1]),
            ([t0, b0, c, t1], [low, cb, tc, m0]),
            ([t2, d, b1, t3], [td, db, high, m2]),
        ] {
            self.with_nodes(nodes, [Edge::Quadratic; 4], [0.0; 4]);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use gearset::Geometry;
    use scene::{FlankLayer, Scene, SceneKind, template};

    use super::super::{Elements, FeGearMesh, Outline, Sector};
    use super::*;
    use crate::element::matrices;
    use crate::material::Elastic;

    const FAMILIES: [ElementFamily; 3] =
        [ElementFamily::Linear, ElementFamily::Incompatible, ElementFamily::Quadratic];

    fn scene() -> Scene {
        Scene::from_toml(template(SceneKind::Planetary)).unwrap()
    }

    /// A tooth of every gear with flanks of `along_flank` elements, whole and divided.
    fn teeth(family: ElementFamily, along_flank: usize) -> Vec<[(Outline, Sector); 2]> {
        let Geometry { sun, planet, ring, .. } = scene().tooth_geometry().unwrap();
        let all = [("sun", sun), ("planet", Some(planet)), ("ring", ring)];
        let each = all.map(|(name, gear)| {
            [FlankLayer::Whole, FlankLayer::Divided].map(|layer| {
                let elements = Elements { family, along_flank, layer };
                FeGearMesh::one_tooth(name, gear.as_ref().unwrap(), elements).unwrap()
            })
        });
        each.into()
    }

    /// Edges of the elements: corners, and the number of elements that have the edge with the same nodes between.
    fn edges(sector: &Sector) -> HashMap<[usize; 2], Vec<Vec<usize>>> {
        let mut found: HashMap<[usize; 2], Vec<Vec<usize>>> = HashMap::new();
        for element in &sector.elements {
            let mut next = 4;
            for (edge, (a, b)) in [(0, 1), (1, 2), (3, 2), (0, 3)].into_iter().enumerate() {
                let own = match element.shape.edges[edge] {
                    Edge::Linear => 0,
                    Edge::Quadratic => 1,
                    Edge::Hermite => 2,
                };
                let (from, to) = (element.nodes[a], element.nodes[b]);
                let between = element.nodes[next..next + own].to_vec();
                found.entry([from.min(to), from.max(to)]).or_default().push(between);
                next += own;
            }
        }
        found
    }

    /// Every edge belongs to two elements with the same nodes, or lies on the border of the tooth, which is one closed
    /// line: a node hanging on an edge would open a second one around the gap.
    #[test]
    fn divided_layers_are_joined_edge_to_edge() {
        for family in FAMILIES {
            for (whole, divided) in
                teeth(family, 6).into_iter().map(|[(_, whole), (_, divided)]| (whole, divided))
            {
                let mut around: HashMap<usize, Vec<usize>> = HashMap::new();
                for ([a, b], shared) in edges(&divided) {
                    match shared.as_slice() {
                        [_] => {
                            around.entry(a).or_default().push(b);
                            around.entry(b).or_default().push(a);
                        }
                        [one, other] => assert_eq!(one, other),
                        more => panic!("{} elements on one edge", more.len()),
                    }
                }
                assert!(around.values().all(|beside| beside.len() == 2));
                let first = divided.race[0];
                let (mut before, mut at, mut length) = (first, around[&first][0], 1);
                while at != first {
                    let [a, b] = around[&at][..] else { unreachable!("two") };
                    (before, at) = (at, if a == before { b } else { a });
                    length += 1;
                }
                assert_eq!(length, around.len());
                // Each flank element is three: four more edges on either flank for every two.
                let of_whole = edges(&whole).values().filter(|shared| shared.len() == 1).count();
                let on_tip = 2 * 2;
                assert_eq!(length, of_whole + 2 * 2 * 6 + on_tip);
                let stretches = divided.flanks.each_ref().map(Vec::len);
                assert_eq!(stretches, [18, 18]);
            }
        }
    }

    /// The same tooth: its area, and none of its elements inside out.
    #[test]
    fn divided_layers_fill_the_same_tooth() {
        let material = Elastic::new(&scene().material, scene().fe_contact.plane);
        for pair in teeth(ElementFamily::Quadratic, 8) {
            let [whole, divided] = pair.map(|(_, sector)| {
                let area = |e: &super::super::SectorElement| {
                    let nodes = &e.nodes[..e.shape.count()];
                    let points: Vec<_> = nodes.iter().map(|n| sector.points[*n]).collect();
                    let own = matrices(&e.shape, &points, &material, 1.0, false).unwrap();
                    let along_x = |k: usize| 2 * k;
                    let at: Vec<usize> = (0..4).chain(4..nodes.len()).collect();
                    let is_value = |k: &usize| !sector.is_derivative[nodes[*k]];
                    let of: Vec<usize> = at.into_iter().filter(is_value).collect();
                    let sum = |a: &usize| {
                        of.iter().map(|b| own.mass[(along_x(*a), along_x(*b))]).sum::<f64>()
                    };
                    of.iter().map(sum).sum::<f64>() / material.density
                };
                sector.elements.iter().map(area).sum::<f64>()
            });
            assert!((divided / whole - 1.0).abs() < 1e-4, "{divided} {whole}");
        }
    }

    /// A displacement of constant strain leaves no force on inner nodes, whatever elements meet there.
    #[test]
    fn constant_strain_is_in_equilibrium_across_the_transition() {
        let material = Elastic::new(&scene().material, scene().fe_contact.plane);
        for family in FAMILIES {
            for [_, (_, sector)] in teeth(family, 6) {
                let at = |[x, y]: [f64; 2]| [3e-4 * x - 2e-4 * y, 5e-4 * x + 7e-4 * y];
                let mut forces = vec![[0.0f64; 2]; sector.points.len()];
                let mut largest = 0.0f64;
                for e in &sector.elements {
                    let nodes = &e.nodes[..e.shape.count()];
                    let points: Vec<_> = nodes.iter().map(|n| sector.points[*n]).collect();
                    let incompatible = family == ElementFamily::Incompatible;
                    let k = matrices(&e.shape, &points, &material, 1.0, incompatible).unwrap();
                    for (a, node) in nodes.iter().enumerate() {
                        for (r, force) in forces[*node].iter_mut().enumerate() {
                            let sum = |b: usize| {
                                let row = 2 * a + r;
                                let of = |(c, u): (usize, f64)| k.stiffness[(row, 2 * b + c)] * u;
                                at(points[b]).into_iter().enumerate().map(of).sum::<f64>()
                            };
                            let own: f64 = (0..nodes.len()).map(sum).sum();
                            *force += own;
                            largest = largest.max(own.abs());
                        }
                    }
                }
                let border: Vec<usize> = edges(&sector)
                    .into_iter()
                    .filter(|(_, shared)| shared.len() == 1)
                    .flat_map(|(ends, shared)| ends.into_iter().chain(shared[0].clone()))
                    .collect();
                for (node, force) in forces.iter().enumerate().filter(|(n, _)| !border.contains(n))
                {
                    let size = force[0].hypot(force[1]);
                    assert!(size < 1e-9 * largest, "{family:?} node {node}: {size:e} {largest:e}");
                }
            }
        }
    }
}
