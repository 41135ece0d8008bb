//! Response of a gear of equal teeth to loads on one tooth, from the stiffness of one sector.
//!
//! The sectors j = 0…Z−1 are numbered in the order in which each shares its last cut with the first
//! cut of the next. All displacements of a sector are in the frame of its tooth. With v_j those of its first
//! cut, its last cut has T v_{j+1}, where T turns by the angle between two teeth. The race is held.
//!
//! **One sector.** Its equations, i: the inner unknowns, c = (v_j, v_{j+1}): those of both cuts, T
//! included in the columns and rows of the last cut,
//!
//! ```text
//! [K_ii  K_ic] [u_i]   [f]                    u_i = K_ii⁻¹ f + E c,   E = −K_ii⁻¹ K_ic
//! [K_ci  K_cc] [ c ] = [·]     ⇒              S c = Eᵀ f + …,         S = K_cc + K_ci E
//! ```
//!
//! **The ring.** S in blocks of first (a) and next (b) cut, g = Eᵀ f of the loads on sector 0:
//!
//! ```text
//! S_ba v_{j−1} + (S_aa + S_bb) v_j + S_ab v_{j+1} = g_a for j = 0, g_b for j = 1, else 0
//! ```
//!
//! is circulant in blocks. With v̂_n = Σ_j v_j e^{−inθj}, θ = 2π/Z, each harmonic has its own equations,
//!
//! ```text
//! (S_aa + S_bb + S_ab e^{inθ} + S_ba e^{−inθ}) v̂_n = g_a + g_b e^{−inθ}
//! v_j = 1/Z Σ_n v̂_n e^{inθj}
//! ```
//!
//! of the size of one cut. Their matrix is Hermitian, A + iB with A symmetric and B skew, and is solved
//! in real numbers:
//!
//! ```text
//! [A  −B] [Re v̂]   [Re]
//! [B   A] [Im v̂] = [Im]
//! ```
//!
//! Harmonics n and Z−n are conjugate, so that n ≤ Z/2 suffice. Nothing has the size of the whole gear.

use std::f64::consts::TAU;
use std::ops::Range;

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use nalgebra::DMatrix;

use super::assembly::Triplets;
use super::responses::{LoadNodes, Responses};
use crate::element::matrices;
use crate::error::FeError;
use crate::fe_mesh::{FeGearMesh, Sector};
use crate::material::Elastic;

/// Where the displacement of a node of the sector comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// The race: none.
    Race,
    /// First of two inner unknowns.
    Inner(usize),
    /// First of two unknowns of the first cut.
    First(usize),
    /// The same of the last cut.
    Last(usize),
}

/// Solves for loads on tooth 0 of a gear whose teeth are meshed alike.
///
/// # Errors
/// If an element is distorted or the stiffness is not positive definite.
pub(super) fn responses(
    mesh: &FeGearMesh,
    material: &Elastic,
    face_width: f64,
    loads: &LoadNodes,
) -> Result<Responses, FeError> {
    let (places, ..) = places(mesh.sector(0));
    if loads.list.iter().any(|node| !matches!(places[*node], Place::Inner(_))) {
        return Err(FeError::Factorisation {
            body: mesh.name,
            cause: "a node that takes load lies on the border of its tooth's sector".into(),
        });
    }
    let mut unit = DMatrix::zeros(2 * places.len(), loads.columns());
    for (column, node) in loads.list.iter().enumerate() {
        (0..2).for_each(|axis| unit[(2 * node + axis, 2 * column + axis)] = 1.0);
    }
    let sector = Condensed::new(mesh, material, face_width, &unit)?;
    let cuts = sector.ring(mesh.name)?;
    let Condensed { carried, held, .. } = sector;
    // The same rows of the load nodes alone.
    let rows: Vec<usize> = loads.list.iter().flat_map(|node| [2 * node, 2 * node + 1]).collect();
    let of_load_nodes = [carried.select_rows(&rows), held.select_rows(&rows)];
    // Sectors follow each other clockwise on external gears, where tooth numbers go down.
    let goes_down = mesh.outline.radial_sign() > 0.0;
    let ring = RingOfSectors { of_all_nodes: [carried, held], of_load_nodes, cuts, goes_down };
    Ok(Responses::of_ring(mesh, loads, ring))
}

/// Displacements of the sectors of a ring under loads on one of them, as far as its cuts tell them.
#[derive(Debug, Clone)]
pub(super) struct RingOfSectors {
    /// Displacements under those of the cuts, and under the loads with both cuts held: [`Condensed::carried`] and
    /// [`Condensed::held`].
    of_all_nodes: [DMatrix<f64>; 2],
    of_load_nodes: [DMatrix<f64>; 2],
    cuts: Cuts,
    /// Whether the tooth of the next sector has the next lower number.
    goes_down: bool,
}

impl RingOfSectors {
    /// Response of all nodes of the tooth `offset` teeth on from the loaded one, 2 rows each, to all loads or those of some
    /// columns, m/N.
    pub(super) fn of_all_nodes(&self, offset: i64, loads: Option<&Range<usize>>) -> DMatrix<f64> {
        self.of(&self.of_all_nodes, offset, loads)
    }

    /// The same of the load nodes alone.
    pub(super) fn of_load_nodes(&self, offset: i64) -> DMatrix<f64> {
        self.of(&self.of_load_nodes, offset, None)
    }

    fn of(
        &self,
        [carried, held]: &[DMatrix<f64>; 2],
        offset: i64,
        loads: Option<&Range<usize>>,
    ) -> DMatrix<f64> {
        let sectors = self.cuts.list.ncols() as i64;
        let sector = (if self.goes_down { -offset } else { offset }).rem_euclid(sectors) as usize;
        let loads = loads.cloned().unwrap_or(0..self.cuts.loads);
        let moved = self.cuts.of(sector, &loads);
        // u = E c, and u_held of the loaded sector
        match sector {
            0 => {
                let mut response = held.columns_range(loads).into_owned();
                response.gemm(1.0, carried, &moved, 1.0);
                response
            }
            _ => carried * moved,
        }
    }
}

/// A sector condensed onto its cuts.
pub(super) struct Condensed {
    /// Displacements of all nodes of the sector (2 rows each) under unit displacements c of the cuts
    /// (first, then next, 2m columns).
    pub(super) carried: DMatrix<f64>,
    /// The same under the loads with both cuts held, m/N for unit loads.
    pub(super) held: DMatrix<f64>,
    /// S, 2m×2m, N/m.
    stiffness: DMatrix<f64>,
    /// g = Eᵀ f + f_c, 2m×loads.
    loads: DMatrix<f64>,
    /// Unknowns m of a cut.
    cut: usize,
    /// Sectors Z.
    sectors: usize,
}

impl Condensed {
    /// A sector under `loads`: 2 rows for each of its nodes in the frame of its tooth, one column a load; what acts on the
    /// race is taken by it.
    pub(super) fn new(
        mesh: &FeGearMesh,
        material: &Elastic,
        face_width: f64,
        loads: &DMatrix<f64>,
    ) -> Result<Self, FeError> {
        let sector = mesh.sector(0);
        let (places, inner, cut) = places(sector);
        // Tooth of the next sector less that of this one: T turns by that many pitches.
        let next = -mesh.outline.radial_sign();
        let (sin, cos) = (next * mesh.outline.gear().pitch_angle()).sin_cos();
        let turn = [[cos, -sin], [sin, cos]];
        let incompatible = mesh.family == gearset::ElementFamily::Incompatible;
        let mut triplets = Triplets::default();
        // K_ic by its entries (row, column, value), of which some repeat, and K_cc, with T.
        let mut border: Vec<(usize, usize, f64)> = Vec::new();
        let mut stiffness = DMatrix::<f64>::zeros(2 * cut, 2 * cut);
        for (i, e) in sector.elements.iter().enumerate() {
            let nodes = &e.nodes[..e.shape.count()];
            let points: Vec<_> = nodes.iter().map(|n| sector.points[*n]).collect();
            let k = matrices(&e.shape, &points, material, face_width, incompatible)
                .map_err(|cause| FeError::Distorted { body: mesh.name, element: i, cause })?
                .stiffness;
            for (a, p) in nodes.iter().map(|n| places[*n]).enumerate() {
                for (b, q) in nodes.iter().map(|n| places[*n]).enumerate() {
                    let mut block = [0, 1].map(|r| [0, 1].map(|c| k[(2 * a + r, 2 * b + c)]));
                    if let Place::Last(_) = p {
                        block = product(transposed(turn), block);
                    }
                    if let Place::Last(_) = q {
                        block = product(block, turn);
                    }
                    let of_cut = |place: Place| match place {
                        Place::First(at) => Some(at),
                        Place::Last(at) => Some(cut + at),
                        Place::Race | Place::Inner(_) => None,
                    };
                    for (r, row) in block.iter().enumerate() {
                        for (c, value) in row.iter().enumerate() {
                            match (p, q, of_cut(p), of_cut(q)) {
                                (Place::Inner(p), Place::Inner(q), ..) => {
                                    triplets.add(p + r, q + c, *value);
                                }
                                (Place::Inner(p), _, _, Some(q)) => {
                                    border.push((p + r, q + c, *value));
                                }
                                (_, _, Some(p), Some(q)) => stiffness[(p + r, q + c)] += value,
                                _ => {}
                            }
                        }
                    }
                }
            }
        }
        let factor = triplets.matrix(inner, mesh.name)?.factorise_for_many(mesh.name)?;
        // K_ii⁻¹ (f, −K_ic)
        let count = loads.ncols();
        let mut right = Mat::zeros(inner, count + 2 * cut);
        let mut pressed: Vec<(usize, usize, f64)> = Vec::new();
        let mut reduced = DMatrix::<f64>::zeros(2 * cut, count);
        for c in 0..count {
            for (node, place) in places.iter().enumerate() {
                let own = [loads[(2 * node, c)], loads[(2 * node + 1, c)]];
                for r in 0..2 {
                    match *place {
                        Place::Race => {}
                        Place::Inner(at) => {
                            right[(at + r, c)] = own[r];
                            if own[r] != 0.0 {
                                pressed.push((at + r, c, own[r]));
                            }
                        }
                        Place::First(at) => reduced[(at + r, c)] += own[r],
                        // Tᵀ f
                        Place::Last(at) => {
                            reduced[(cut + at + r, c)] += turn[0][r] * own[0] + turn[1][r] * own[1];
                        }
                    }
                }
            }
        }
        border.iter().for_each(|(r, c, k)| right[(*r, count + c)] -= k);
        factor.solve(&mut right);
        // S = K_cc + K_ci E,  g = f_c + Eᵀ f: of border and loads only the entries that are not 0
        for q in 0..2 * cut {
            let elastic = right.col(count + q);
            border.iter().for_each(|(r, p, k)| stiffness[(*p, q)] += k * elastic[*r]);
            pressed.iter().for_each(|(r, c, f)| reduced[(q, *c)] += f * elastic[*r]);
        }
        stiffness = 0.5 * (&stiffness + stiffness.transpose());
        let (mut carried, mut held) =
            (DMatrix::zeros(2 * places.len(), 2 * cut), DMatrix::zeros(2 * places.len(), count));
        // Row of the sector's nodes and of its inner unknowns.
        let mut rows: Vec<(usize, usize)> = Vec::with_capacity(inner);
        for (node, place) in places.iter().enumerate() {
            for r in 0..2 {
                let row = 2 * node + r;
                match *place {
                    Place::Race => {}
                    Place::First(at) => carried[(row, at + r)] = 1.0,
                    Place::Last(at) => {
                        (0..2).for_each(|c| carried[(row, cut + at + c)] = turn[r][c]);
                    }
                    Place::Inner(at) => rows.push((row, at + r)),
                }
            }
        }
        for c in 0..2 * cut {
            rows.iter().for_each(|(row, at)| carried[(*row, c)] = right[(*at, count + c)]);
        }
        for c in 0..count {
            rows.iter().for_each(|(row, at)| held[(*row, c)] = right[(*at, c)]);
        }
        let sectors = mesh.nodes.len();
        Ok(Self { carried, held, stiffness, loads: reduced, cut, sectors })
    }

    /// Displacement of sector 0 (2 rows a node, in the frame of its tooth, 3 columns) where every sector carries the loads
    /// of a body force: columns 0 and 1 of the loads are those along x and y of the tooth's frame, column 2 turns with the teeth.
    ///
    /// Forces along x or y of the fixed frame of tooth 0 are, in the frame of the tooth at the angle φ_j = ηj, the real and
    /// imaginary part of (f_x + i f_y) e^{iηj}: one harmonic of the ring.
    ///
    /// ```text
    /// (S_aa + S_bb + S_ab e^{iη} + S_ba e^{−iη}) V = g_a + g_b e^{−iη},   v_0 = V,   v_1 = V e^{iη}
    /// ```
    ///
    /// # Errors
    /// If a harmonic is not positive definite.
    pub(super) fn everywhere(&self, mesh: &FeGearMesh) -> Result<DMatrix<f64>, FeError> {
        let m = self.cut;
        let blocks = self.blocks();
        let g =
            |of_next: bool, r: usize, c: usize| self.loads[(if of_next { m + r } else { r }, c)];
        let (sin, cos) =
            (-mesh.outline.radial_sign() * mesh.outline.gear().pitch_angle()).sin_cos();
        let mut both = Mat::from_fn(2 * m, 1, |r, _| match r / m {
            0 => g(false, r, 0) + cos * g(true, r, 0) + sin * g(true, r, 1),
            _ => g(false, r - m, 1) + cos * g(true, r - m, 1) - sin * g(true, r - m, 0),
        });
        blocks.solve((sin, cos), &mut both, || "translation of the race".into(), mesh.name)?;
        let mut turning = Mat::from_fn(m, 1, |r, _| g(false, r, 2) + g(true, r, 2));
        blocks.solve((0.0, 1.0), &mut turning, || "rotation of the race".into(), mesh.name)?;
        let cuts = DMatrix::from_fn(2 * m, 3, |row, column| {
            let r = row % m;
            let (re, im) = (both[(r, 0)], both[(m + r, 0)]);
            match (row / m, column) {
                (_, 2) => turning[(r, 0)],
                (0, 0) => re,
                (0, _) => im,
                (_, 0) => cos * re - sin * im,
                _ => cos * im + sin * re,
            }
        });
        Ok(&self.carried * cuts + &self.held)
    }

    /// Blocks of S by which the harmonics of the ring are coupled.
    fn blocks(&self) -> Blocks {
        let m = self.cut;
        let block = |r: usize, c: usize| self.stiffness.view((r * m, c * m), (m, m));
        Blocks {
            own: block(0, 0) + block(1, 1),
            even: block(0, 1) + block(1, 0),
            odd: block(0, 1) - block(1, 0),
        }
    }

    /// Displacements of all cuts under the loads on sector 0.
    fn ring(&self, body: &'static str) -> Result<Cuts, FeError> {
        let (m, z, count) = (self.cut, self.sectors, self.loads.ncols());
        let blocks = self.blocks();
        let (here, next) = (self.loads.rows(0, m), self.loads.rows(m, m));
        let angle = |k: usize| TAU * (k % z) as f64 / z as f64;
        // Re v̂₀, then Re and Im of v̂_n, one column for each, and the weights of these columns in
        // every v_j.
        let mut spectrum = DMatrix::<f64>::zeros(m * count, z);
        let mut weights = DMatrix::<f64>::zeros(z, z);
        let mut column = 0;
        for n in 0..=z / 2 {
            let (sin, cos) = angle(n).sin_cos();
            // The first harmonic, and the last of an even number of sectors, are real.
            let is_real = n == 0 || 2 * n == z;
            let parts = if is_real { 1 } else { 2 };
            // g_a + g_b e^{−inθ}
            let mut right = Mat::from_fn(parts * m, count, |r, c| match r / m {
                0 => here[(r, c)] + cos * next[(r, c)],
                _ => -sin * next[(r - m, c)],
            });
            blocks.solve(
                (sin, cos),
                &mut right,
                || format!("harmonic {n} of the ring of teeth"),
                body,
            )?;
            let share = parts as f64 / z as f64;
            for part in 0..parts {
                for c in 0..count {
                    for r in 0..m {
                        spectrum[(c * m + r, column)] = right[(part * m + r, c)];
                    }
                }
                for j in 0..z {
                    let (sin, cos) = angle(n * j).sin_cos();
                    weights[(column, j)] = share * if part == 0 { cos } else { -sin };
                }
                column += 1;
            }
        }
        Ok(Cuts { list: spectrum * weights, cut: m, loads: count })
    }
}

/// S_aa + S_bb, S_ab + S_ba and S_ab − S_ba, m×m, N/m.
struct Blocks {
    own: DMatrix<f64>,
    even: DMatrix<f64>,
    odd: DMatrix<f64>,
}

impl Blocks {
    /// Solves the equations of a harmonic whose phase from one sector to the next has the given sine and cosine, for
    /// the real part alone (m rows) or for both parts (2m rows).
    fn solve(
        &self,
        (sin, cos): (f64, f64),
        right: &mut Mat<f64>,
        which: impl Fn() -> String,
        body: &'static str,
    ) -> Result<(), FeError> {
        let m = self.own.nrows();
        // A = S_aa + S_bb + (S_ab + S_ba) cos nθ,  B = (S_ab − S_ba) sin nθ
        let (a, b) = (&self.own + cos * &self.even, sin * &self.odd);
        let rows = right.nrows();
        let matrix = Mat::from_fn(rows, rows, |r, c| match (r / m, c / m) {
            (0, 0) | (1, 1) => a[(r % m, c % m)],
            (0, _) => -b[(r, c - m)],
            _ => b[(r - m, c)],
        });
        let failed = |e| FeError::Factorisation { body, cause: format!("{}: {e:?}", which()) };
        matrix.llt(Side::Lower).map_err(failed)?.solve_in_place(right.as_mut());
        Ok(())
    }
}

/// Displacements of the first cuts of all sectors under the loads.
#[derive(Debug, Clone)]
struct Cuts {
    /// One column for each sector: m unknowns of each load in turn.
    list: DMatrix<f64>,
    cut: usize,
    loads: usize,
}

impl Cuts {
    /// c of a sector under the loads of some columns, 2m×loads.
    fn of(&self, sector: usize, loads: &Range<usize>) -> DMatrix<f64> {
        let (m, z) = (self.cut, self.list.ncols());
        let both = [sector, (sector + 1) % z].map(|j| self.list.column(j));
        DMatrix::from_fn(2 * m, loads.len(), |r, c| both[r / m][(loads.start + c) * m + r % m])
    }
}

/// Place of each node of a sector; number of inner unknowns, and of those of one cut.
fn places(sector: &Sector) -> (Vec<Place>, usize, usize) {
    let mut places = vec![None; sector.points.len()];
    for node in &sector.race {
        places[*node] = Some(Place::Race);
    }
    let mut cut = 0;
    for (first, last) in sector.first.iter().zip(&sector.last) {
        if places[*first].is_none() {
            places[*first] = Some(Place::First(cut));
            places[*last] = Some(Place::Last(cut));
            cut += 2;
        }
    }
    let mut inner = 0;
    let number = |place: Option<Place>| {
        place.unwrap_or_else(|| {
            inner += 2;
            Place::Inner(inner - 2)
        })
    };
    let places = places.into_iter().map(number).collect();
    (places, inner, cut)
}

fn transposed(a: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [[a[0][0], a[1][0]], [a[0][1], a[1][1]]]
}

fn product(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [0, 1].map(|r| [0, 1].map(|c| a[r][0] * b[0][c] + a[r][1] * b[1][c]))
}
