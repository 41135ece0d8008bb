//! One sector of a gear of equal teeth, condensed onto its cuts with the next ones.
//!
//! All displacements are in the frame of the sector's tooth. With v_j those of its first cut, its last cut has T
//! v_{j+1}, where T turns by the angle between two teeth. The race is held. Its equations, i: the inner unknowns, c =
//! (v_j, v_{j+1}): those of both cuts, T included in the columns and rows of the last cut,
//!
//! ```text
//! [K_ii  K_ic] [u_i]   [f]                    u_i = K_ii⁻¹ f + E c,   E = −K_ii⁻¹ K_ic
//! [K_ci  K_cc] [ c ] = [·]     ⇒              S c = Eᵀ f + …,         S = K_cc + K_ci E
//! ```

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use nalgebra::DMatrix;

use super::assembly::{Factor, Triplets};
use crate::element::matrices;
use crate::error::FeError;
use crate::fe_mesh::{FeGearMesh, Sector};
use crate::material::Elastic;

/// Where the displacement of a node of the sector comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// The race: none.
    Race,
    /// First of two inner unknowns.
    Inner(usize),
    /// First of two unknowns of the first cut.
    First(usize),
    /// The same of the last cut.
    Last(usize),
}

/// A sector condensed onto its cuts.
#[derive(Debug, Clone)]
pub(super) struct Condensed {
    /// Displacements of all nodes of the sector (2 rows each) under unit displacements c of the cuts
    /// (first, then next, 2m columns).
    pub(super) carried: DMatrix<f64>,
    /// S, 2m×2m, N/m.
    stiffness: DMatrix<f64>,
    /// Unknowns m of a cut.
    pub(super) cut: usize,
    /// Sectors Z.
    pub(super) sectors: usize,
    /// T.
    turn: [[f64; 2]; 2],
    /// Of each node.
    places: Vec<Place>,
    /// Number of the inner unknowns.
    inner: usize,
    /// K_ii.
    factor: Factor,
}

/// A sector under loads.
pub(super) struct Pressed {
    /// Displacements of all nodes of the sector (2 rows each) under the loads with both cuts held, m/N for unit loads.
    pub(super) held: DMatrix<f64>,
    /// g = Eᵀ f + f_c, 2m×loads.
    pub(super) on_cuts: DMatrix<f64>,
}

impl Condensed {
    /// Of a gear whose teeth are meshed alike, and what it is under `loads`, as [`Condensed::under`]: one solution for
    /// both.
    ///
    /// # Errors
    /// If an element is distorted or the stiffness is not positive definite.
    pub(super) fn new(
        mesh: &FeGearMesh,
        material: &Elastic,
        face_width: f64,
        loads: &DMatrix<f64>,
    ) -> Result<(Self, Pressed), FeError> {
        let sector = mesh.sector(0);
        let (places, inner, cut) = places(sector);
        // Tooth of the next sector less that of this one: T turns by that many pitches.
        let next = -mesh.outline.radial_sign();
        let (sin, cos) = (next * mesh.outline.gear().pitch_angle()).sin_cos();
        let turn = [[cos, -sin], [sin, cos]];
        let incompatible = mesh.family == scene::ElementFamily::Incompatible;
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
        // K_ii⁻¹ (f, −K_ic), the second of which is E
        let count = loads.ncols();
        let mut right = Mat::zeros(inner, count + 2 * cut);
        press(&places, loads, &mut right);
        border.iter().for_each(|(r, c, k)| right[(*r, count + c)] -= k);
        factor.solve(&mut right);
        // S = K_cc + K_ci E: of the border only the entries that are not 0
        for q in 0..2 * cut {
            let column = right.col(count + q);
            border.iter().for_each(|(r, p, k)| stiffness[(*p, q)] += k * column[*r]);
        }
        stiffness = 0.5 * (&stiffness + stiffness.transpose());
        let mut carried = DMatrix::zeros(2 * places.len(), 2 * cut);
        for (node, place) in places.iter().enumerate() {
            for r in 0..2 {
                let row = 2 * node + r;
                match *place {
                    Place::Race => {}
                    Place::First(at) => carried[(row, at + r)] = 1.0,
                    Place::Last(at) => {
                        (0..2).for_each(|c| carried[(row, cut + at + c)] = turn[r][c]);
                    }
                    Place::Inner(at) => {
                        (0..2 * cut).for_each(|q| carried[(row, q)] = right[(at + r, count + q)]);
                    }
                }
            }
        }
        let sectors = mesh.nodes.len();
        let own = Self { carried, stiffness, cut, sectors, turn, places, inner, factor };
        let pressed = own.pressed(loads, &right);
        Ok((own, pressed))
    }

    /// The sector under `loads`: 2 rows for each of its nodes in the frame of its tooth, one column a load; what acts
    /// on the race is taken by it.
    pub(super) fn under(&self, loads: &DMatrix<f64>) -> Pressed {
        let mut right = Mat::zeros(self.inner, loads.ncols());
        press(&self.places, loads, &mut right);
        self.factor.solve(&mut right);
        self.pressed(loads, &right)
    }

    /// The sector under loads whose displacements of the inner unknowns are the first columns of `inner`.
    fn pressed(&self, loads: &DMatrix<f64>, inner: &Mat<f64>) -> Pressed {
        let (cut, count) = (self.cut, loads.ncols());
        let mut on_cuts = DMatrix::<f64>::zeros(2 * cut, count);
        let mut held = DMatrix::zeros(2 * self.places.len(), count);
        for c in 0..count {
            for (node, place) in self.places.iter().enumerate() {
                let own = [loads[(2 * node, c)], loads[(2 * node + 1, c)]];
                for r in 0..2 {
                    match *place {
                        Place::Race => {}
                        Place::Inner(at) => {
                            held[(2 * node + r, c)] = inner[(at + r, c)];
                            // Eᵀ f: of the loads only the entries that are not 0
                            if own[r] != 0.0 {
                                let elastic = self.carried.row(2 * node + r);
                                (0..2 * cut).for_each(|q| on_cuts[(q, c)] += own[r] * elastic[q]);
                            }
                        }
                        Place::First(at) => on_cuts[(at + r, c)] += own[r],
                        // Tᵀ f
                        Place::Last(at) => {
                            on_cuts[(cut + at + r, c)] +=
                                self.turn[0][r] * own[0] + self.turn[1][r] * own[1];
                        }
                    }
                }
            }
        }
        Pressed { held, on_cuts }
    }

    /// Displacement of sector 0 (2 rows a node, in the frame of its tooth, 3 columns) where every sector carries the
    /// loads of a body force: columns 0 and 1 of the loads are those along x and y of the tooth's frame, column 2 turns
    /// with the teeth.
    ///
    /// Forces along x or y of the fixed frame of tooth 0 are, in the frame of the tooth at the angle φ_j = ηj, the real
    /// and imaginary part of (f_x + i f_y) e^{iηj}: one harmonic of the ring.
    ///
    /// ```text
    /// (S_aa + S_bb + S_ab e^{iη} + S_ba e^{−iη}) V = g_a + g_b e^{−iη},   v_0 = V,   v_1 = V e^{iη}
    /// ```
    ///
    /// # Errors
    /// If a harmonic is not positive definite.
    pub(super) fn everywhere(
        &self,
        loads: &Pressed,
        body: &'static str,
    ) -> Result<DMatrix<f64>, FeError> {
        let m = self.cut;
        let blocks = self.blocks();
        let g =
            |of_next: bool, r: usize, c: usize| loads.on_cuts[(if of_next { m + r } else { r }, c)];
        let (cos, sin) = (self.turn[0][0], self.turn[1][0]);
        let mut both = Mat::from_fn(2 * m, 1, |r, _| match r / m {
            0 => g(false, r, 0) + cos * g(true, r, 0) + sin * g(true, r, 1),
            _ => g(false, r - m, 1) + cos * g(true, r - m, 1) - sin * g(true, r - m, 0),
        });
        blocks.solve((sin, cos), &mut both, || "translation of the race".into(), body)?;
        let mut turning = Mat::from_fn(m, 1, |r, _| g(false, r, 2) + g(true, r, 2));
        blocks.solve((0.0, 1.0), &mut turning, || "rotation of the race".into(), body)?;
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
        Ok(&self.carried * cuts + &loads.held)
    }

    /// Blocks of S by which the harmonics of the ring are coupled.
    pub(super) fn blocks(&self) -> Blocks {
        let m = self.cut;
        let block = |r: usize, c: usize| self.stiffness.view((r * m, c * m), (m, m));
        Blocks {
            own: block(0, 0) + block(1, 1),
            even: block(0, 1) + block(1, 0),
            odd: block(0, 1) - block(1, 0),
        }
    }
}

/// S_aa + S_bb, S_ab + S_ba and S_ab − S_ba, m×m, N/m.
pub(super) struct Blocks {
    own: DMatrix<f64>,
    even: DMatrix<f64>,
    odd: DMatrix<f64>,
}

impl Blocks {
    /// Solves the equations of a harmonic whose phase from one sector to the next has the given sine and cosine, for
    /// the real part alone (m rows) or for both parts (2m rows).
    pub(super) fn solve(
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

/// Writes loads on the inner unknowns into the first columns of `right`.
fn press(places: &[Place], loads: &DMatrix<f64>, right: &mut Mat<f64>) {
    for c in 0..loads.ncols() {
        for (node, place) in places.iter().enumerate() {
            if let Place::Inner(at) = *place {
                (0..2).for_each(|r| right[(at + r, c)] = loads[(2 * node + r, c)]);
            }
        }
    }
}

/// Place of each node of a sector; number of inner unknowns, and of those of one cut.
pub(super) fn places(sector: &Sector) -> (Vec<Place>, usize, usize) {
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
