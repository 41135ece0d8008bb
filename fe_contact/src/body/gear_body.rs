//! One gear on a rigid race: its static flexibility between flank points.

use faer::Mat;
use nalgebra::DMatrix;

use super::matrices::{BodyMatrices, number_unknowns};
use crate::error::FeError;
use crate::fe_mesh::{FeGearMesh, Side};
use crate::material::Elastic;

/// Neighbouring teeth on either side whose response to a loaded tooth is kept.
const REACH: i64 = 4;

/// Teeth whose response at all their nodes is kept, of a gear of so many teeth.
pub(crate) fn kept_teeth(teeth: u32) -> u32 {
    2 * (REACH as u32).min(teeth.saturating_sub(1) / 2) + 1
}

/// Unit loads for which a body is solved at a time.
const AT_ONCE: usize = 16;

/// A point of a flank. A load at the point acts on the flank's functions work-equivalently, in
/// proportion to their values there.
#[derive(Debug, Clone, Copy)]
pub struct FlankPoint {
    /// Column of the response of each function of the flank, for loads along x (the next one is for
    /// y).
    pub columns: [usize; 4],
    /// Values of the functions at the point.
    pub weights: [f64; 4],
}

/// A point inside a tooth.
#[derive(Debug, Clone, Copy)]
pub struct Deep {
    /// Element of the sector.
    pub element: usize,
    /// Number of functions.
    pub count: usize,
    /// Nodes of the sector.
    pub nodes: [usize; crate::element::MOST],
    /// Values of the functions at the point.
    pub weights: [f64; crate::element::MOST],
}

/// Finite-element body of a gear whose race stands still.
#[derive(Debug, Clone)]
pub struct GearBody {
    /// Its mesh.
    pub mesh: FeGearMesh,
    /// Material.
    pub material: Elastic,
    /// Face width, m.
    pub face_width: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Polar inertia about the centre, kg m².
    pub inertia: f64,
    /// Degrees of freedom.
    pub unknowns: usize,
    /// Nodes of tooth 0's flanks that take load, both sides, in the sector's numbering.
    load_nodes: Vec<usize>,
    /// Column pair of each sector node, `usize::MAX` if it takes no load.
    column_of: Vec<usize>,
    /// Displacements (2 rows per sector node, in the frame of the displaced tooth) under unit loads
    /// on tooth 0 (2 columns per load node, in the frame of tooth 0), one matrix for each of the
    /// teeth −REACH…REACH, m/N.
    responses: Vec<DMatrix<f64>>,
    /// The same at the load nodes only (2 rows each), for every tooth, counted from the loaded one;
    /// for tooth 0 only where teeth are meshed differently, m/N.
    around: Vec<DMatrix<f64>>,
    boxes: Vec<[f64; 4]>,
}

impl GearBody {
    /// Assembles and factorises the body and solves for loads on one tooth.
    ///
    /// # Errors
    /// If an element is distorted or the stiffness is not positive definite.
    pub fn new(mesh: FeGearMesh, material: Elastic, face_width: f64) -> Result<Self, FeError> {
        let (mass, inertia) = mesh.mass_properties(&material, face_width)?;
        let unknown_of = number_unknowns(&mesh);
        let matrices = BodyMatrices::of_gear(&mesh, &material, face_width)?;
        let factor = matrices.stiffness.factorise(mesh.name)?;
        let sector = mesh.sector(0);
        let mut column_of = vec![usize::MAX; sector.points.len()];
        let mut load_nodes = Vec::new();
        for side in &sector.flanks {
            for node in side.iter().flat_map(|stretch| stretch.nodes) {
                if column_of[node] == usize::MAX {
                    column_of[node] = 2 * load_nodes.len();
                    load_nodes.push(node);
                }
            }
        }
        let columns = 2 * load_nodes.len();
        let teeth = mesh.outline.gear().teeth as i64;
        let reach = REACH.min((teeth - 1) / 2);
        // Displacements that are kept: a tooth, nodes of its sector, and their response in the
        // tooth's frame.
        let seen = |tooth: usize, locals: Vec<usize>| {
            let response = DMatrix::zeros(2 * locals.len(), columns);
            (tooth, locals, response)
        };
        let mut near: Vec<_> = (-reach..=reach)
            .map(|offset| {
                let tooth = offset.rem_euclid(teeth) as usize;
                seen(tooth, (0..mesh.nodes[tooth].len()).collect())
            })
            .collect();
        let alike = if mesh.sectors.len() > 1 { 1 } else { teeth as usize };
        let mut ring: Vec<_> = (0..alike).map(|tooth| seen(tooth, load_nodes.clone())).collect();
        // In blocks of loads: the displacements of the whole body under all loads at once would be
        // the largest array in memory.
        for first in (0..columns).step_by(AT_ONCE) {
            let count = AT_ONCE.min(columns - first);
            let mut right = Mat::zeros(factor.size, count);
            for c in 0..count {
                let (node, axis) = (load_nodes[(first + c) / 2], (first + c) % 2);
                right[(unknown_of[mesh.nodes[0][node]] + axis, c)] = 1.0;
            }
            factor.solve(&mut right);
            for (tooth, locals, response) in near.iter_mut().chain(&mut ring) {
                let (sin, cos) = mesh.tooth_angle(*tooth).sin_cos();
                for (row, local) in locals.iter().enumerate() {
                    let unknown = unknown_of[mesh.nodes[*tooth][*local]];
                    if unknown == usize::MAX {
                        continue;
                    }
                    for c in 0..count {
                        let (x, y) = (right[(unknown, c)], right[(unknown + 1, c)]);
                        response[(2 * row, first + c)] = cos * x + sin * y;
                        response[(2 * row + 1, first + c)] = -sin * x + cos * y;
                    }
                }
            }
        }
        let kept = |list: Vec<(usize, Vec<usize>, DMatrix<f64>)>| {
            list.into_iter().map(|(_, _, response)| response).collect::<Vec<_>>()
        };
        let (responses, around) = (kept(near), kept(ring));
        let boxes = sector.elements.iter().map(|e| {
            let mut b = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
            // The corners bound the element except where its curved edges bulge; the margin covers
            // that.
            for node in &e.nodes[..4] {
                let [x, y] = sector.points[*node];
                b = [b[0].min(x), b[1].min(y), b[2].max(x), b[3].max(y)];
            }
            let margin = 0.2 * (b[2] - b[0]).max(b[3] - b[1]);
            [b[0] - margin, b[1] - margin, b[2] + margin, b[3] + margin]
        });
        let boxes = boxes.collect();
        let unknowns = factor.size;
        Ok(Self {
            mesh,
            material,
            face_width,
            mass,
            inertia,
            unknowns,
            load_nodes,
            column_of,
            responses,
            around,
            boxes,
        })
    }

    /// Number of load nodes on both flanks of a tooth.
    pub fn load_count(&self) -> usize {
        self.load_nodes.len()
    }

    /// The flank's functions at arc length ℓ (m), which is clamped to the flank's ends.
    pub fn flank_point(&self, side: Side, l: f64) -> FlankPoint {
        let flank = &self.mesh.sectors[0].flanks[side.index()];
        let k = flank.partition_point(|s| s.to < l).min(flank.len() - 1);
        let stretch = &flank[k];
        let half = 0.5 * (stretch.to - stretch.from);
        let t = ((l - stretch.from) / half - 1.0).clamp(-1.0, 1.0);
        FlankPoint {
            columns: stretch.nodes.map(|n| self.column_of[n]),
            weights: crate::fe_mesh::hermite(t, half),
        }
    }

    /// The element functions at a point of the tooth frame; `None` outside the sector.
    pub fn locate(&self, point: [f64; 2]) -> Option<Deep> {
        let sector = &self.mesh.sectors[0];
        let inside = |b: &[f64; 4]| {
            point[0] >= b[0] && point[1] >= b[1] && point[0] <= b[2] && point[1] <= b[3]
        };
        let mut best: Option<(f64, Deep)> = None;
        for (element, _) in self.boxes.iter().enumerate().filter(|(_, b)| inside(b)) {
            let e = &sector.elements[element];
            let count = e.shape.count();
            let (mut xi, mut eta) = (0.0, 0.0);
            for _ in 0..12 {
                let v = e.shape.at(xi, eta);
                let (mut r, mut m) = ([-point[0], -point[1]], [[0.0; 2]; 2]);
                for (i, node) in e.nodes[..count].iter().enumerate() {
                    let p = sector.points[*node];
                    for k in 0..2 {
                        r[k] += v.n[i] * p[k];
                        m[k][0] += v.dxi[i] * p[k];
                        m[k][1] += v.deta[i] * p[k];
                    }
                }
                let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
                let step = [
                    (m[1][1] * r[0] - m[0][1] * r[1]) / determinant,
                    (m[0][0] * r[1] - m[1][0] * r[0]) / determinant,
                ];
                xi = (xi - step[0]).clamp(-2.0, 2.0);
                eta = (eta - step[1]).clamp(-2.0, 2.0);
                if step[0].abs() + step[1].abs() < 1e-13 {
                    break;
                }
            }
            let outside = xi.abs().max(eta.abs());
            if best.as_ref().is_none_or(|(least, _)| outside < *least) {
                let v = e.shape.at(xi, eta);
                best = Some((outside, Deep { element, count, nodes: e.nodes, weights: v.n }));
            }
            if outside <= 1.0 {
                break;
            }
        }
        best.filter(|(outside, _)| *outside <= 1.0 + 1e-3).map(|(_, deep)| deep)
    }

    /// Response of a tooth `offset` teeth on from the loaded one; `None` beyond the kept ones, and
    /// for teeth meshed differently from the loaded one.
    pub fn response(&self, offset: i64) -> Option<&DMatrix<f64>> {
        if offset != 0 && self.mesh.sectors.len() > 1 {
            return None;
        }
        let reach = (self.responses.len() as i64 - 1) / 2;
        self.responses.get(usize::try_from(offset + reach).ok()?)
    }

    /// Normal displacement at `depth` (m) below mid-flank of the tooth `offset` on, under a unit
    /// normal force at mid-flank of tooth 0, m/N. Zero if that point lies outside the tooth.
    pub fn mid_flank_flexibility(&self, side: Side, depth: f64, offset: i64) -> f64 {
        let outline = &self.mesh.outline;
        let l = 0.5 * outline.flank_length();
        let (p, t) = (outline.flank_point(l), outline.flank_tangent(l));
        // Into the material: the tangent towards the tip turned to the tooth's axis.
        let sign = side.sign();
        let mut inwards = [-t[1], t[0]];
        if inwards[1] > 0.0 {
            inwards = inwards.map(|x| -x);
        }
        let inwards = [inwards[0], sign * inwards[1]];
        let at = [p[0] + depth * inwards[0], sign * p[1] + depth * inwards[1]];
        let Some(deep) = self.locate(at) else { return 0.0 };
        self.flexibility((&self.flank_point(side, l), inwards), offset, (&deep, inwards))
    }

    /// Sector node on which the load of a column of the response acts.
    pub fn node_of(&self, column: usize) -> usize {
        self.load_nodes[column / 2]
    }

    /// A load spread like a half ellipse of half-width `w` (m) about arc length ℓ: functions of the
    /// flank, as columns of the response, with weights that sum to those of a unit load. The part
    /// beyond an end of the flank is reflected at that end.
    pub fn flank_load(&self, side: Side, l: f64, w: f64) -> Vec<(usize, f64)> {
        const POINTS: usize = 7;
        let length = self.mesh.outline.flank_length();
        let mut load: Vec<(usize, f64)> = Vec::new();
        for i in 1..=POINTS {
            // Gauss–Chebyshev rule of the second kind: ∫ f √(1−s²) ds = Σ π/(n+1) sin²θ_i f(cos θ_i)
            let angle = std::f64::consts::PI * i as f64 / (POINTS + 1) as f64;
            let share = 2.0 / (POINTS + 1) as f64 * angle.sin().powi(2);
            let at = (l + w * angle.cos()).abs();
            let point = self.flank_point(side, at.min(2.0 * length - at));
            for (column, weight) in point.columns.into_iter().zip(point.weights) {
                match load.iter_mut().find(|(known, _)| *known == column) {
                    Some((_, sum)) => *sum += share * weight,
                    None => load.push((column, share * weight)),
                }
            }
        }
        load
    }

    /// Displacement along `measured`, averaged with the weights of the second load, of the tooth
    /// `offset` teeth on from the loaded one, under a unit force along `force` distributed as the
    /// first load; directions in the teeth's own frames, m/N.
    pub fn surface_flexibility(
        &self,
        (load, force): (&[(usize, f64)], [f64; 2]),
        offset: i64,
        (point, measured): (&[(usize, f64)], [f64; 2]),
    ) -> f64 {
        let teeth = self.mesh.nodes.len() as i64;
        let Some(response) = self.around.get(offset.rem_euclid(teeth) as usize) else { return 0.0 };
        let mut sum = 0.0;
        for (column, w) in load {
            for (k, f) in force.iter().enumerate() {
                for (at, n) in point {
                    for (r, m) in measured.iter().enumerate() {
                        sum += w * f * n * m * response[(at + r, column + k)];
                    }
                }
            }
        }
        sum
    }

    /// Displacement along `measured` of a point inside the tooth `offset` teeth on from the loaded
    /// one, under a unit force along `force` at a flank point; directions in the teeth's own
    /// frames, m/N.
    pub fn flexibility(
        &self,
        (load, force): (&FlankPoint, [f64; 2]),
        offset: i64,
        (deep, measured): (&Deep, [f64; 2]),
    ) -> f64 {
        let Some(response) = self.response(offset) else { return 0.0 };
        let mut sum = 0.0;
        for (column, w) in load.columns.iter().zip(load.weights) {
            for (k, f) in force.iter().enumerate() {
                for (node, n) in deep.nodes[..deep.count].iter().zip(deep.weights) {
                    for (r, m) in measured.iter().enumerate() {
                        sum += w * f * n * m * response[(2 * node + r, column + k)];
                    }
                }
            }
        }
        sum
    }
}
