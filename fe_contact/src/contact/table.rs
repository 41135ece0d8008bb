//! Contact cells of one mesh at one phase, with the compliance between all of them.

use nalgebra::DMatrix;

use gearset::{Mesh, MeshMember};
use scene::{CellLayout, PerMesh};

use super::cells::Cells;
use super::half_plane::HalfPlane;
use super::hertz::Hertz;
use super::pair::{Location, PairFrame, candidates, members};
use super::seen::{Seen, tooth_numbers};
use crate::body::GearBody;
use crate::error::FeError;

/// How cells are laid out and matched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellSettings {
    /// Cells of one pair.
    pub cells: usize,
    /// Where they are.
    pub layout: CellLayout,
    /// Where half-plane and FE are matched.
    pub matching: Matching,
    /// Force of the whole mesh for which the grids are sized, N.
    pub force: f64,
    /// Pairs whose least gap exceeds that of the nearest pair by no more than this take part, m.
    pub window: f64,
    /// Factors on the FE part of the meshes' compliance; the half-plane part is the flanks' own.
    pub flexibility_factor: PerMesh,
}

/// Matching of half-plane and FE below each cell.
///
/// `[eq:matched-compliance]` u(r) = u_hs(r) + (u_fe − u_hs)(q), matched at one point q; at two points at the depths d
/// and 2d: u(r) = u_hs(r) + 2 (u_fe − u_hs)(q₁) − (u_fe − u_hs)(q₂).
/// Source: the paper, eq. (1); extrapolation from two depths derived here.
/// Checked by: `fe.convergence.depth`, `fe.resolved`, `fe.calculix`.
///
/// The bracket, the part of the field that knows the tooth's shape, is smooth but not constant between q and the
/// surface; taking it at q leaves an error of first order in the depth (for OH-58 about 0.1 µm a millimetre and body).
/// Two points extrapolate it linearly to the surface, with an error of second order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matching {
    /// Depth d of the (first) matching point, m.
    pub depth: f64,
    /// One point (the paper's), two, or none: the surface itself, for meshes fine enough to
    /// resolve the contact by elements alone.
    pub points: usize,
}

impl Matching {
    /// Depths (m) and weights of the matching points; the weights add up to 1.
    pub fn weights(&self) -> &'static [f64] {
        if self.points == 2 { &[2.0, -1.0] } else { &[1.0] }
    }

    pub(super) fn depth(&self, point: usize) -> f64 {
        if self.points == 0 { 0.0 } else { self.depth * (point + 1) as f64 }
    }
}

/// Half the grid over the half-width that one pair alone, without tip relief, would have under the
/// whole force. [`PairFrame::grid`] says what becomes of the grid with tip relief.
const GRID_MARGIN: f64 = 1.5;

/// Cells of one pair.
#[derive(Debug, Clone)]
pub struct PairCells {
    /// Pair k.
    pub index: i64,
    /// Path or corner.
    pub location: Location,
    /// Approach for unit displacements of driver and driven, mesh frame.
    pub row: [f64; 6],
    /// Angles of the two teeth's axes, driver first, mesh frame, rad.
    pub axes: [f64; 2],
    /// First cell in the table.
    pub first: usize,
    /// Tangential coordinate of the least gap, m: 0 without tip relief.
    pub centre: f64,
    /// Least gap less the gap of the flanks without tip relief at the reference point, m: 0 without
    /// tip relief.
    pub relief: f64,
    /// Tangential coordinates of the cells' middles, m.
    pub x: Vec<f64>,
    /// Widths of the cells, m.
    pub widths: Vec<f64>,
    /// Edges of the cells, m; `None` if all have one width.
    edges: Option<Vec<f64>>,
    /// Length of the grid, m.
    pub length: f64,
    /// Whether the grid ends where a flank does, at its low and at its high end.
    pub ends_at_tip: [bool; 2],
}

/// A mesh at one phase.
#[derive(Debug, Clone)]
pub struct MeshTable {
    /// Phase, cycles.
    pub phase: f64,
    /// Candidate pairs.
    pub pairs: Vec<PairCells>,
    /// Gaps of all cells, m.
    pub gaps: Vec<f64>,
    /// Compliance between all cells, n×n, m/N.
    pub compliance: DMatrix<f64>,
    /// Largest asymmetry of the matched compliance before its symmetric part was taken, over its
    /// largest entry.
    pub asymmetry: f64,
    /// Face width, m.
    pub face_width: f64,
    /// Smallest gap of the pairs left out, m.
    pub next_gap: f64,
}

impl MeshTable {
    /// Lays out the cells of a mesh and computes the compliance between them.
    ///
    /// # Errors
    /// If a matching point lies outside its tooth.
    pub fn new(
        mesh: &Mesh,
        bodies: [&GearBody; 2],
        phase: f64,
        settings: &CellSettings,
    ) -> Result<Self, FeError> {
        let [driver, _] = bodies;
        let face_width = driver.face_width;
        let factor = settings.flexibility_factor.of(mesh.kind);
        // The window is made for a mesh six times softer than usual; the factor may use up half.
        let window = settings.window * (factor / 3.0).max(1.0);
        // The mesh gives way only once its nearest pair touches. Without tip relief that pair is on the
        // path and has no gap.
        let all = candidates(mesh, phase, f64::INFINITY);
        let least: Vec<f64> = all.iter().map(PairFrame::least_gap).collect();
        let nearest = least.iter().fold(f64::INFINITY, |a, gap| a.min(*gap));
        let window = if nearest.is_finite() { window + nearest.max(0.0) } else { window };
        let next_gap =
            least.iter().filter(|gap| **gap > window).fold(f64::INFINITY, |a, g| a.min(*g));
        let within = all.into_iter().zip(&least).filter(|(_, gap)| **gap <= window);
        let frames: Vec<PairFrame<'_>> = within.map(|(frame, _)| frame).collect();
        let (mut pairs, mut gaps, mut points) = (Vec::new(), Vec::new(), Vec::new());
        for frame in &frames {
            let hertz = Hertz::new(settings.force / face_width, frame.radius(), &driver.material);
            let reach = GRID_MARGIN * hertz.half_width;
            let cells = Cells::new(frame, reach, settings.cells, settings.layout);
            let Cells { x, widths, edges, length, ends_at_tip } = cells;
            let centre = frame.least_gap_at();
            let relief = frame.least_gap() - frame.rigid_gap();
            let first = gaps.len();
            let own: Vec<_> = x.iter().map(|x| frame.flank_points(*x)).collect();
            gaps.extend(own.iter().map(|ends| frame.gap_between(ends)));
            points.push(own);
            let (index, location, row) = (frame.index, frame.location, frame.approach_row());
            let axes = [MeshMember::Driver, MeshMember::Driven].map(|m| frame.tooth(m).axis);
            pairs.push(PairCells {
                index,
                location,
                row,
                axes,
                first,
                centre,
                relief,
                x,
                widths,
                edges,
                length,
                ends_at_tip,
            });
        }
        let n = gaps.len();
        let mut compliance = DMatrix::zeros(n, n);
        for (member, body) in [MeshMember::Driver, MeshMember::Driven].into_iter().zip(bodies) {
            let name = members(mesh.kind)[member as usize];
            let deepest = settings.matching.depth(settings.matching.weights().len() - 1);
            let lost = || FeError::DepthOutside { body: name, phase, depth_mm: deepest * 1e3 };
            let numbers = tooth_numbers(&frames, member, body);
            let seen: Vec<Seen> = frames
                .iter()
                .zip(&points)
                .map(|(frame, points)| {
                    Seen::new(frame, points, member, body, &settings.matching).ok_or_else(lost)
                })
                .collect::<Result<_, _>>()?;
            for (a, (loads, on)) in seen.iter().zip(&pairs).enumerate() {
                for (b, (deeps, of)) in seen.iter().zip(&pairs).enumerate() {
                    let place = (of.first, on.first);
                    deeps.add_under(loads, body, numbers[b] - numbers[a], &mut compliance, place);
                }
            }
        }
        // Load and measured point stand at different depths, so reciprocity holds only as far as
        // the two solutions match; the complementarity problem takes the symmetric part.
        let (mut largest, mut skew) = (0.0f64, 0.0f64);
        for i in 0..n {
            for j in 0..=i {
                let (low, high) = (compliance[(i, j)], compliance[(j, i)]);
                largest = largest.max(low.abs()).max(high.abs());
                skew = skew.max((low - high).abs());
                let even = (0.5 * factor) * (low + high);
                (compliance[(i, j)], compliance[(j, i)]) = (even, even);
            }
        }
        let asymmetry = if largest > 0.0 { 0.5 * skew / largest } else { 0.0 };
        let half = bodies.map(|body| HalfPlane::new(&body.material));
        for cells in &pairs {
            let surface = (&half, &settings.matching, face_width);
            match &cells.edges {
                None => add_half_planes(&mut compliance, surface, cells),
                Some(edges) => add_graded_half_planes(&mut compliance, surface, cells, edges),
            }
        }
        Ok(Self { phase, pairs, gaps, compliance, asymmetry, face_width, next_gap })
    }

    /// The same mesh with one pair alone; `None` if it is not among the candidates.
    pub fn only(&self, index: i64) -> Option<Self> {
        let pair = self.pairs.iter().find(|p| p.index == index)?;
        let (first, n) = (pair.first, pair.x.len());
        let mut own = pair.clone();
        own.first = 0;
        Some(Self {
            phase: self.phase,
            pairs: vec![own],
            gaps: self.gaps[first..first + n].to_vec(),
            compliance: self.compliance.view((first, first), (n, n)).into(),
            asymmetry: self.asymmetry,
            face_width: self.face_width,
            next_gap: self.next_gap,
        })
    }

    /// Pair (position in the table) of each cell.
    pub fn pair_of_cells(&self) -> Vec<usize> {
        let of = |(k, pair): (usize, &PairCells)| std::iter::repeat_n(k, pair.x.len());
        self.pairs.iter().enumerate().flat_map(of).collect()
    }
}

/// Half-planes of both bodies, where they are matched with the FE part, and the face width, m.
type Surface<'s> = (&'s [HalfPlane; 2], &'s Matching, f64);

/// Half-plane part of eq. (1) in both bodies, within one pair on cells of one width.
fn add_half_planes(
    compliance: &mut DMatrix<f64>,
    (half, matching, face_width): Surface<'_>,
    cells: &PairCells,
) {
    let n = cells.x.len();
    let width = cells.length / n as f64;
    // One unit of force is a pressure of 1/(width · face width).
    let pressure = 1.0 / (width * face_width);
    let by_distance: Vec<f64> = (0..n)
        .map(|d| {
            let x = d as f64 * width;
            let one = |half: &HalfPlane| {
                let matched = matching.weights().iter().enumerate().map(|(i, weight)| {
                    weight * half.strip_above_depth(x, matching.depth(i), 0.5 * width)
                });
                matched.sum::<f64>()
            };
            pressure * half.iter().map(one).sum::<f64>()
        })
        .collect();
    for i in 0..n {
        for j in 0..n {
            compliance[(cells.first + i, cells.first + j)] += by_distance[i.abs_diff(j)];
        }
    }
}

/// The same on cells of different widths, between `edges` (m).
///
/// The displacement in the middle of cell i under a unit force on cell j is that of the surface loaded up to the low
/// edge of j less that up to its high edge. The middles stand for the cells' means, so that reciprocity holds up to
/// the change of width from cell to cell; the symmetric part is taken, as of the FE part.
fn add_graded_half_planes(
    compliance: &mut DMatrix<f64>,
    (half, matching, face_width): Surface<'_>,
    cells: &PairCells,
    edges: &[f64],
) {
    if matching.points == 0 {
        // Matched at the surface: nothing of the half-plane is left.
        return;
    }
    let (n, widths) = (cells.x.len(), &cells.widths);
    // Mostly both bodies are of one material.
    let bodies = if half[0] == half[1] { &half[..1] } else { &half[..] };
    let times = half.len() as f64 / bodies.len() as f64;
    let mut surface = DMatrix::zeros(n, n);
    let mut up_to = vec![0.0; n + 1];
    for (i, x) in cells.x.iter().enumerate() {
        for (up_to, edge) in up_to.iter_mut().zip(edges) {
            *up_to = bodies.iter().map(|half| half.surface_up_to(x - edge)).sum::<f64>();
        }
        for (j, width) in widths.iter().enumerate() {
            // One unit of force is a pressure of 1/(width · face width).
            surface[(i, j)] = (up_to[j] - up_to[j + 1]) / width;
        }
    }
    for i in 0..n {
        for j in 0..=i {
            let x = cells.x[i] - cells.x[j];
            // What the symmetric part of a displacement below the surface has.
            let width2 = 0.5 * (widths[i] * widths[i] + widths[j] * widths[j]);
            let below = |(k, weight): (usize, &f64)| {
                let z = matching.depth(k);
                let one = |half: &HalfPlane| half.narrow_strip(x, z, width2);
                weight * bodies.iter().map(one).sum::<f64>()
            };
            let even = 0.5 * (surface[(i, j)] + surface[(j, i)]);
            let matched = even - matching.weights().iter().enumerate().map(below).sum::<f64>();
            let own = times * matched / face_width;
            compliance[(cells.first + i, cells.first + j)] += own;
            if i != j {
                compliance[(cells.first + j, cells.first + i)] += own;
            }
        }
    }
}
