//! One gear on a rigid race: its static flexibility between flank points.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::responses::{LoadNodes, Responses};
use super::sector_ring::RingOfSectors;
use super::{sector_ring, whole_gear};
use crate::error::FeError;
use crate::fe_mesh::{FeGearMesh, Side};
use crate::material::Elastic;

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

/// Place of a point in an element of the sector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct InElement {
    element: usize,
    xi: f64,
    eta: f64,
}

impl InElement {
    /// Largest of |ξ| and |η|: at most 1 inside.
    fn outside(&self) -> f64 {
        self.xi.abs().max(self.eta.abs())
    }
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
    loads: LoadNodes,
    responses: Responses,
    boxes: Vec<[f64; 4]>,
}

impl GearBody {
    /// Solves for loads on one tooth: teeth meshed alike from one sector, else by the whole gear.
    ///
    /// # Errors
    /// If an element is distorted or the stiffness is not positive definite.
    pub fn new(mesh: FeGearMesh, material: Elastic, face_width: f64) -> Result<Self, FeError> {
        match mesh.sectors.len() {
            1 => Self::with(mesh, material, face_width, sector_ring::responses),
            _ => Self::of_whole_gear(mesh, material, face_width),
        }
    }

    /// The same body from the assembled and factorised stiffness of the whole gear, at many times the
    /// cost: a second route to the same numbers.
    ///
    /// # Errors
    /// As [`GearBody::new`].
    pub fn of_whole_gear(
        mesh: FeGearMesh,
        material: Elastic,
        face_width: f64,
    ) -> Result<Self, FeError> {
        Self::with(mesh, material, face_width, whole_gear::responses)
    }

    fn with(
        mesh: FeGearMesh,
        material: Elastic,
        face_width: f64,
        responses: fn(&FeGearMesh, &Elastic, f64, &LoadNodes) -> Result<Responses, FeError>,
    ) -> Result<Self, FeError> {
        let (mass, inertia) = mesh.mass_properties(&material, face_width)?;
        let sector = mesh.sector(0);
        let loads = LoadNodes::of(sector);
        let responses = responses(&mesh, &material, face_width, &loads)?;
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
        let unknowns = 2 * mesh.on_race.iter().filter(|held| !**held).count();
        Ok(Self { mesh, material, face_width, mass, inertia, unknowns, loads, responses, boxes })
    }

    /// Number of load nodes on both flanks of a tooth.
    pub fn load_count(&self) -> usize {
        self.loads.list.len()
    }

    /// The flank's functions at arc length ℓ (m), which is clamped to the flank's ends.
    pub fn flank_point(&self, side: Side, l: f64) -> FlankPoint {
        let flank = &self.mesh.sectors[0].flanks[side.index()];
        let k = flank.partition_point(|s| s.to < l).min(flank.len() - 1);
        let stretch = &flank[k];
        let half = 0.5 * (stretch.to - stretch.from);
        let t = ((l - stretch.from) / half - 1.0).clamp(-1.0, 1.0);
        FlankPoint {
            columns: stretch.nodes.map(|n| self.loads.column_of[n]),
            weights: crate::fe_mesh::hermite(t, half),
        }
    }

    /// The element functions at a point of the tooth frame; `None` outside the sector.
    pub fn locate(&self, point: [f64; 2]) -> Option<Deep> {
        self.locate_near(point, None).map(|(deep, _)| deep)
    }

    /// The same with the point's place in its element. The element of a `place` found nearby is tried
    /// first, from there; which element has the point does not depend on it, except on their common
    /// edge, where both have the same displacement.
    pub(crate) fn locate_near(
        &self,
        point: [f64; 2],
        place: Option<InElement>,
    ) -> Option<(Deep, InElement)> {
        if let Some(near) = place {
            let at = self.place_in(near, point);
            if at.outside() <= 1.0 {
                return Some((self.deep(at), at));
            }
        }
        let inside = |b: &[f64; 4]| {
            point[0] >= b[0] && point[1] >= b[1] && point[0] <= b[2] && point[1] <= b[3]
        };
        let mut best: Option<InElement> = None;
        for (element, _) in self.boxes.iter().enumerate().filter(|(_, b)| inside(b)) {
            let at = self.place_in(InElement { element, xi: 0.0, eta: 0.0 }, point);
            if best.is_none_or(|least| at.outside() < least.outside()) {
                best = Some(at);
            }
            if at.outside() <= 1.0 {
                break;
            }
        }
        let at = best.filter(|at| at.outside() <= 1.0 + 1e-3)?;
        Some((self.deep(at), at))
    }

    /// Newton's method for the place of a point in an element, from another place in it.
    fn place_in(&self, from: InElement, point: [f64; 2]) -> InElement {
        let sector = &self.mesh.sectors[0];
        let InElement { element, mut xi, mut eta } = from;
        let e = &sector.elements[element];
        let count = e.shape.count();
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
            // Convergence is quadratic: the next step would be below 1e-14.
            if step[0].abs() + step[1].abs() < 1e-8 {
                break;
            }
        }
        InElement { element, xi, eta }
    }

    fn deep(&self, at: InElement) -> Deep {
        let e = &self.mesh.sectors[0].elements[at.element];
        let weights = e.shape.at(at.xi, at.eta).n;
        Deep { element: at.element, count: e.shape.count(), nodes: e.nodes, weights }
    }

    /// Response of a tooth `offset` teeth on from the loaded one; `None` beyond the kept ones, and
    /// for teeth meshed differently from the loaded one.
    pub fn response(&self, offset: i64) -> Option<&DMatrix<f64>> {
        if offset != 0 && self.mesh.sectors.len() > 1 {
            return None;
        }
        self.responses.near(offset)
    }

    /// The same under loads on one flank, with the column of the whole response that is its first.
    pub(crate) fn response_under(&self, offset: i64, side: Side) -> Option<(&DMatrix<f64>, usize)> {
        if offset != 0 && self.mesh.sectors.len() > 1 {
            return None;
        }
        self.responses.near_under(offset, side)
    }

    /// The ring of sectors from which responses are computed; `None` where teeth are meshed differently or the whole
    /// gear was solved.
    pub(super) fn ring(&self) -> Option<&Arc<RingOfSectors>> {
        self.responses.ring()
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
        self.loads.list[column / 2]
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
        let Some(response) = self.responses.around(offset) else { return 0.0 };
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
