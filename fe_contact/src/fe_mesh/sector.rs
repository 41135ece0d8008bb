//! Mesh of one tooth with its share of the rim, in the tooth's own frame.
//!
//! Two structured blocks. The *rim* block reaches from the race to the root land, the lower halves
//! of the fillets and a base line that crosses the tooth between the fillets' middles; the *tooth*
//! block stands on the base line. Splitting the fillet at its middle keeps every corner near 60°;
//! split at its end, tangent to the root circle, the tooth block would have a corner of 0°.
//!
//! Columns run clockwise on external and counter-clockwise on internal gears, rows from the race to
//! the tip, so that det J is positive in both. Lattice indices count half elements: corners have
//! even indices, mid-side nodes one odd index.

use std::collections::HashMap;

use scene::ElementFamily;

use super::flank_layer::{Layer, PARTS, between, divided};
use super::outline::{Outline, Side, polar};
use crate::element::{Edge, MOST, Shape};

/// Numbers and gradings of the elements of one sector; all lists start at 0 and end at 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Refinement {
    /// Fractions of the flank's arc length, form circle to tip.
    pub flank: Vec<f64>,
    /// Fractions across the tooth, first column to last.
    pub thickness: Vec<f64>,
    /// Fractions from race to root.
    pub rim: Vec<f64>,
    /// Elements on half the fillet.
    pub half_fillet: usize,
    /// Elements on the radial line below the base circle, if there is one.
    pub line: usize,
    /// Elements on half the root land; zero if there is none.
    pub half_land: usize,
    /// Whether the elements behind the flanks are divided in three along and across them.
    pub is_divided: bool,
}

impl Refinement {
    /// Elements of even size with `flank_elements` along the flank.
    pub fn even(outline: &Outline, body_radius: f64, flank_elements: usize) -> Self {
        let size = outline.flank_length() / flank_elements as f64;
        let count = |length: f64, least: usize| ((length / size).round() as usize).max(least);
        let gear = outline.gear();
        let middle = outline.flank_point(0.5 * outline.flank_length());
        let land = outline.half_land * gear.root_radius;
        let fillet = 0.5 * outline.fillet_sweep() * gear.fillet_radius;
        let rim = (gear.root_radius - body_radius).abs();
        // The rim is far from the load: its elements are twice as long on average, and half as long
        // at the root as at the race.
        let rows = count(0.5 * rim, 3);
        let line = outline.radial_line();
        Self {
            flank: evenly(flank_elements),
            thickness: evenly(count(2.0 * middle[1], 4)),
            rim: graded(rows, 0.5),
            half_fillet: count(fillet, 1),
            line: if line > 1e-3 * size { count(line, 1) } else { 0 },
            half_land: if land > 1e-3 * size { count(land, 1) } else { 0 },
            is_divided: false,
        }
    }
}

impl Refinement {
    /// Elements of size `size` (m) within `reach` (m) of the arc length `middle` on the flank and
    /// below it, growing by a quarter each away from there: for contact resolved by elements alone.
    pub fn resolve(&mut self, outline: &Outline, middle: f64, size: f64, reach: f64) {
        let length = outline.flank_length();
        let coarse = length / (self.flank.len() - 1) as f64;
        let (low, high) = ((middle - reach).max(0.0), (middle + reach).min(length));
        let fine = ((high - low) / size).ceil().max(1.0) as usize;
        let mut list: Vec<f64> = growing(low, size, coarse).iter().rev().map(|d| low - d).collect();
        list.extend((0..=fine).map(|i| low + (high - low) * i as f64 / fine as f64));
        list.extend(growing(length - high, size, coarse).iter().map(|d| high + d));
        self.flank = list.iter().map(|l| l / length).collect();
        // Across the tooth from both flanks to the middle.
        let half = outline.flank_point(middle)[1];
        let across = coarse.min(0.5 * half);
        let inwards: Vec<f64> = std::iter::once(0.0).chain(growing(half, size, across)).collect();
        let mut thickness: Vec<f64> = inwards.iter().map(|d| 0.5 * d / half).collect();
        thickness.extend(inwards.iter().rev().skip(1).map(|d| 1.0 - 0.5 * d / half));
        self.thickness = thickness;
        if let (Some(first), Some(last)) = (self.flank.first_mut(), self.thickness.last_mut()) {
            (*first, *last) = (0.0, 1.0);
        }
        if let Some(last) = self.flank.last_mut() {
            *last = 1.0;
        }
    }
}

/// Ends of steps from 0 to `length` that start at `first` and grow by a quarter up to `most`.
fn growing(length: f64, first: f64, most: f64) -> Vec<f64> {
    if length <= 0.0 {
        return Vec::new();
    }
    let (mut list, mut at, mut step) = (Vec::new(), 0.0, first);
    while at < length {
        at += step;
        list.push(at);
        step = (1.25 * step).min(most);
    }
    // Scaled so that the last step ends at `length`.
    let scale = length / at;
    list.iter().map(|x| x * scale).collect()
}

/// 0, 1/n, …, 1.
pub(super) fn evenly(n: usize) -> Vec<f64> {
    (0..=n).map(|i| i as f64 / n as f64).collect()
}

/// n steps from 0 to 1, the last `ratio` times as long as the first.
fn graded(n: usize, ratio: f64) -> Vec<f64> {
    let step = |i: usize| 1.0 + (ratio - 1.0) * i as f64 / (n.max(2) - 1) as f64;
    let total: f64 = (0..n).map(step).sum();
    let mut at = 0.0;
    let mut list = vec![0.0];
    for i in 0..n {
        at += step(i) / total;
        list.push(at);
    }
    list[n] = 1.0;
    list
}

/// One element of a sector.
#[derive(Debug, Clone, Copy)]
pub struct SectorElement {
    /// Shape functions.
    pub shape: Shape,
    /// Nodes in the order of the functions.
    pub nodes: [usize; MOST],
}

/// A stretch of flank between two nodes.
#[derive(Debug, Clone, Copy)]
pub struct FlankStretch {
    /// Element of the sector.
    pub element: usize,
    /// Arc lengths ℓ at its ends, m.
    pub from: f64,
    /// See `from`.
    pub to: f64,
    /// Nodes of the values at both ends, then of the derivatives at both ends.
    pub nodes: [usize; 4],
}

/// Nodes and elements of one tooth, tooth frame.
#[derive(Debug, Clone)]
pub struct Sector {
    /// Generalised nodes: positions, and dP/dℓ for derivative nodes, m.
    pub points: Vec<[f64; 2]>,
    /// Whether a node is a derivative.
    pub is_derivative: Vec<bool>,
    /// Elements.
    pub elements: Vec<SectorElement>,
    /// Nodes on the race, first column to last.
    pub race: Vec<usize>,
    /// Nodes of the first radial edge, race to root.
    pub first: Vec<usize>,
    /// Nodes of the last radial edge, race to root.
    pub last: Vec<usize>,
    /// Both flanks, form circle to tip, by [`Side::index`].
    pub flanks: [Vec<FlankStretch>; 2],
    /// Elements from here on belong to the tooth block.
    pub tooth_block: usize,
}

/// Lattice node of one of the two blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Place {
    Rim(usize, usize),
    Tooth(usize, usize),
    /// Of the divided elements behind a flank: whether it is that of the last column, and half edges of theirs.
    Layer(bool, usize, usize),
}

pub(super) struct Builder<'o> {
    outline: &'o Outline,
    pub(super) family: ElementFamily,
    pub(super) sector: Sector,
    pub(super) nodes: HashMap<Place, usize>,
    /// First and last column of the tooth block in the rim's lattice; `top` is the rim's last row.
    pub(super) base: (usize, usize),
    pub(super) top: usize,
}

impl Sector {
    /// Meshes one tooth.
    pub fn new(
        outline: &Outline,
        body_radius: f64,
        refinement: &Refinement,
        family: ElementFamily,
    ) -> Self {
        let top = boundary(outline, refinement);
        let rim = halves(&refinement.rim);
        let (columns, rows) = (top.points.len() - 1, rim.len() - 1);
        let base = (top.base, columns - top.base);
        let mut b = Builder {
            outline,
            family,
            sector: Self {
                points: Vec::new(),
                is_derivative: Vec::new(),
                elements: Vec::new(),
                race: Vec::new(),
                first: Vec::new(),
                last: Vec::new(),
                flanks: [Vec::new(), Vec::new()],
                tooth_block: 0,
            },
            nodes: HashMap::new(),
            base,
            top: rows,
        };
        // Rim block: rays from the race to the boundary above.
        for (j, depth) in rim.iter().enumerate() {
            for (i, [r, angle]) in top.points.iter().enumerate() {
                if b.is_node(i, j) {
                    let at = b.placed(body_radius + depth * (r - body_radius), *angle);
                    b.add(Place::Rim(i, j), at);
                }
            }
        }
        b.sector.race =
            (0..=columns).filter_map(|i| b.nodes.get(&Place::Rim(i, 0)).copied()).collect();
        let edge = |b: &Builder<'_>, i: usize| -> Vec<usize> {
            (0..=rows).filter_map(|j| b.nodes.get(&Place::Rim(i, j)).copied()).collect()
        };
        b.sector.first = edge(&b, 0);
        b.sector.last = edge(&b, columns);
        for j in (0..rows).step_by(2) {
            for i in (0..columns).step_by(2) {
                b.element(&Place::Rim, (i, j), [Edge::Quadratic; 4], [0.0; 4]);
            }
        }
        b.sector.tooth_block = b.sector.elements.len();
        b.tooth(refinement);
        b.sector
    }
}

/// Upper boundary of the rim block: (r, φ) for each lattice column, φ growing with the column.
struct Boundary {
    points: Vec<[f64; 2]>,
    /// Lattice column where the base line starts.
    base: usize,
}

fn boundary(outline: &Outline, refinement: &Refinement) -> Boundary {
    let to_polar = |[x, y]: [f64; 2]| [x.hypot(y), y.atan2(x)];
    // Side of the last column: from the middle of the tooth space along the root land and the lower
    // half of the fillet to the fillet's middle.
    let mut half: Vec<[f64; 2]> = Vec::new();
    if refinement.half_land > 0 {
        let list = halves(&evenly(refinement.half_land));
        half.extend(list.iter().map(|t| to_polar(outline.land_point(*t))));
        half.pop();
    }
    let list = halves(&evenly(refinement.half_fillet));
    half.extend(list.iter().map(|t| to_polar(outline.fillet_point(0.5 * t))));
    if refinement.half_land == 0 {
        // The root land is too short for elements: its two ends become one node.
        half[0][1] = std::f64::consts::PI / f64::from(outline.gear().teeth);
    }
    let across = halves(&refinement.thickness);
    let inner = across[1..across.len() - 1].iter().map(|t| to_polar(base_line(outline, *t)));
    let base = half.len() - 1;
    let mut points: Vec<[f64; 2]> = half.iter().map(|[r, angle]| [*r, -angle]).collect();
    points.extend(inner);
    points.extend(half.iter().rev());
    Boundary { points, base }
}

/// Base line from the middle of one fillet (t = 0) to that of the other: a parabola that leaves
/// the fillet at 60° to its upper part.
fn base_line(outline: &Outline, t: f64) -> [f64; 2] {
    let [x, y] = outline.fillet_point(0.5);
    let [dx, dy] = outline.fillet_direction(0.5);
    // The fillet's direction turned by 60° into the body.
    let (sin, cos) = (-outline.radial_sign() * std::f64::consts::FRAC_PI_3).sin_cos();
    let (ex, ey) = (cos * dx - sin * dy, sin * dx + cos * dy);
    // Control point where the ray in this direction meets the tooth's axis; the ray is limited to
    // 45° from the perpendicular to the axis.
    let slope = (ex / -ey).clamp(-1.0, 1.0);
    let control = x + slope * y;
    let (a, b, c) = ((1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t);
    [a * x + b * control + c * x, -a * y + c * y]
}

/// Corner positions with the middles between them.
fn halves(list: &[f64]) -> Vec<f64> {
    let mut all = Vec::with_capacity(2 * list.len() - 1);
    for pair in list.windows(2) {
        all.push(pair[0]);
        all.push(0.5 * (pair[0] + pair[1]));
    }
    all.extend(list.last());
    all
}

impl Builder<'_> {
    pub(super) fn is_node(&self, i: usize, j: usize) -> bool {
        match (i % 2, j % 2) {
            (0, 0) => true,
            (1, 1) => false,
            _ => self.family == ElementFamily::Quadratic,
        }
    }

    /// Point at (r, angle), the angle growing with the column. It is mirrored for external gears,
    /// whose columns run clockwise.
    fn placed(&self, r: f64, angle: f64) -> [f64; 2] {
        let [x, y] = polar(r, angle);
        [x, -self.outline.radial_sign() * y]
    }

    pub(super) fn add(&mut self, place: Place, at: [f64; 2]) -> usize {
        let id = self.added(at);
        self.nodes.insert(place, id);
        id
    }

    /// A node that has no place in a lattice.
    pub(super) fn added(&mut self, at: [f64; 2]) -> usize {
        self.sector.points.push(at);
        self.sector.is_derivative.push(false);
        self.sector.points.len() - 1
    }

    pub(super) fn node(&self, place: Place) -> usize {
        let place = match place {
            Place::Tooth(i, 0) => Place::Rim(self.base.0 + i, self.top),
            place => place,
        };
        self.nodes[&place]
    }

    /// Adds the element whose corners and mid-side nodes are at the lattice points (i, j) to (i + 2, j + 2) of `place`,
    /// and returns its index. The derivative nodes of Hermite edges are filled in by `Builder::flank`.
    pub(super) fn element(
        &mut self,
        place: &dyn Fn(usize, usize) -> Place,
        (i, j): (usize, usize),
        edges: [Edge; 4],
        half_lengths: [f64; 4],
    ) -> usize {
        let at = |b: &Self, (di, dj): (usize, usize)| b.node(place(i + di, j + dj));
        let corners = [(0, 0), (2, 0), (2, 2), (0, 2)].map(|to| at(self, to));
        let ends = [(1, 0), (2, 1), (1, 2), (0, 1)];
        let middles = std::array::from_fn(|e| match edges[e] {
            Edge::Quadratic if self.family == ElementFamily::Quadratic => at(self, ends[e]),
            _ => usize::MAX,
        });
        self.with_nodes((corners, middles), edges, half_lengths)
    }

    /// Adds an element with given corners and mid-side nodes, of which those that its edges have are used.
    pub(super) fn with_nodes(
        &mut self,
        (corners, middles): ([usize; 4], [usize; 4]),
        mut edges: [Edge; 4],
        half_lengths: [f64; 4],
    ) -> usize {
        let quadratic = self.family == ElementFamily::Quadratic;
        for e in edges.iter_mut().filter(|e| **e == Edge::Quadratic && !quadratic) {
            *e = Edge::Linear;
        }
        let mut nodes = [0; MOST];
        nodes[..4].copy_from_slice(&corners);
        let mut next = 4;
        for (edge, middle) in edges.into_iter().zip(middles) {
            match edge {
                Edge::Linear => {}
                Edge::Quadratic => {
                    nodes[next] = middle;
                    next += 1;
                }
                // Filled in by `Builder::flank`.
                Edge::Hermite => next += 2,
            }
        }
        let shape = Shape { edges, half_lengths };
        self.sector.elements.push(SectorElement { shape, nodes });
        self.sector.elements.len() - 1
    }

    /// The tooth block: transfinite between base line, tip arc and the two sides.
    fn tooth(&mut self, refinement: &Refinement) {
        let outline = self.outline;
        // Side of the last column, from the fillet's middle to the tip.
        let mut side: Vec<[f64; 2]> = Vec::new();
        let fillet = halves(&evenly(refinement.half_fillet));
        side.extend(fillet.iter().map(|t| outline.fillet_point(0.5 + 0.5 * t)));
        if refinement.line > 0 {
            let line = halves(&evenly(refinement.line));
            side.extend(line[1..].iter().map(|t| outline.radial_line_point(*t)));
        }
        let flank_start = side.len() - 1;
        let flank = halves(&refinement.flank);
        let length = outline.flank_length();
        side.extend(flank[1..].iter().map(|t| outline.flank_point(t * length)));
        let rows = side.len() - 1;
        let mut heights = vec![0.0];
        for pair in side.windows(2) {
            let step = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
            heights.push(heights[heights.len() - 1] + step);
        }
        let across = halves(&refinement.thickness);
        let columns = across.len() - 1;
        let tip =
            |t: f64| polar(outline.gear().tip_radius, (2.0 * t - 1.0) * outline.tip_half_angle());
        let mirrored = |[x, y]: [f64; 2]| [x, -y];
        let (foot, head) = (side[0], side[rows]);
        // Point at the fraction ξ across the tooth and η of its height, where the last column's side is at `last`.
        let placed = |xi: f64, (last, eta): ([f64; 2], f64)| {
            let (below, above) = (base_line(outline, xi), tip(xi));
            let first = mirrored(last);
            let at = [0, 1].map(|k| {
                let corners = (1.0 - eta) * ((1.0 - xi) * mirrored(foot)[k] + xi * foot[k])
                    + eta * ((1.0 - xi) * mirrored(head)[k] + xi * head[k]);
                (1.0 - xi) * first[k] + xi * last[k] + (1.0 - eta) * below[k] + eta * above[k]
                    - corners
            });
            [at[0], -outline.radial_sign() * at[1]]
        };
        for j in 1..=rows {
            let eta = heights[j] / heights[rows];
            for (i, &xi) in across.iter().enumerate() {
                let on_flank = (i == 0 || i == columns) && j > flank_start && j % 2 == 1;
                if !self.is_node(i, j) || on_flank {
                    continue;
                }
                self.add(Place::Tooth(i, j), placed(xi, (side[j], eta)));
            }
        }
        let layers = [false, true].map(|is_last| Layer {
            column: if is_last { columns - 2 } else { 0 },
            row: flank_start,
            is_last,
        });
        let divided_flank = divided(&refinement.flank);
        if refinement.is_divided {
            let list = halves(&divided_flank);
            let on_side = |j: usize| {
                let below = flank_start + j / PARTS;
                let height = between(&heights, below, j % PARTS) / heights[rows];
                (outline.flank_point(list[j] * length), height)
            };
            let at = |i: usize, j: usize, column: usize| {
                placed(between(&across, column + i / PARTS, i % PARTS), on_side(j))
            };
            layers.iter().for_each(|layer| self.layer_nodes(layer, list.len(), &at));
        }
        let mut edge_elements = [Vec::new(), Vec::new()];
        for j in (0..rows).step_by(2) {
            let on_flank = j >= flank_start;
            let half = if on_flank {
                let k = (j - flank_start) / 2;
                0.5 * length * (refinement.flank[k + 1] - refinement.flank[k])
            } else {
                0.0
            };
            for i in (0..columns).step_by(2) {
                let at_side = [i == 0, i + 2 == columns];
                if refinement.is_divided && self.divided((i, j), &layers, half, &mut edge_elements)
                {
                    continue;
                }
                let (mut edges, mut lengths) = ([Edge::Quadratic; 4], [0.0; 4]);
                for (edge, is_side) in [3, 1].into_iter().zip(at_side) {
                    if is_side && on_flank {
                        (edges[edge], lengths[edge]) = (Edge::Hermite, half);
                    }
                }
                let element = self.element(&Place::Tooth, (i, j), edges, lengths);
                for (list, is_side) in edge_elements.iter_mut().zip(at_side) {
                    if is_side && on_flank {
                        list.push(element);
                    }
                }
            }
        }
        let flank = if refinement.is_divided { &divided_flank } else { &refinement.flank };
        // The last column lies on the counter-clockwise flank of internal and on the clockwise
        // flank of external gears.
        let sides = match outline.radial_sign() > 0.0 {
            true => [Side::Ccw, Side::Cw],
            false => [Side::Cw, Side::Ccw],
        };
        for (which, side) in sides.into_iter().enumerate() {
            self.flank(flank, which, side, &edge_elements[which]);
        }
    }

    /// Derivative nodes of one flank. Neighbouring elements share them, which makes the flank C¹.
    fn flank(&mut self, fractions: &[f64], which: usize, side: Side, elements: &[usize]) {
        let length = self.outline.flank_length();
        let derivative = |b: &mut Self, t: f64| {
            let [x, y] = b.outline.flank_tangent(t * length);
            b.sector.points.push([x, side.sign() * y]);
            b.sector.is_derivative.push(true);
            b.sector.points.len() - 1
        };
        let mut below = derivative(self, fractions[0]);
        for (k, &element) in elements.iter().enumerate() {
            let above = derivative(self, fractions[k + 1]);
            let edge = if which == 0 { 3 } else { 1 };
            let e = &mut self.sector.elements[element];
            // The Hermite edge's functions follow those of the edges before it.
            let before = e.shape.edges[..edge].iter().map(|e| match e {
                Edge::Linear => 0,
                Edge::Quadratic => 1,
                Edge::Hermite => 2,
            });
            let at = 4 + before.sum::<usize>();
            (e.nodes[at], e.nodes[at + 1]) = (below, above);
            let (low, high) = if which == 0 { (0, 3) } else { (1, 2) };
            let nodes = [e.nodes[low], e.nodes[high], below, above];
            let (from, to) = (fractions[k] * length, fractions[k + 1] * length);
            self.sector.flanks[side.index()].push(FlankStretch { element, from, to, nodes });
            below = above;
        }
    }
}
