//! Response of a gear of equal teeth to loads on one tooth, from the stiffness of one sector.
//!
//! The sectors j = 0…Z−1 are numbered in the order in which each shares its last cut with the first
//! cut of the next. All displacements of a sector are in the frame of its tooth. With v_j those of its first
//! cut, its last cut has T v_{j+1}, where T turns by the angle between two teeth. The race is held.
//!
//! **One sector** is condensed onto its cuts ([`Condensed`]): S c = g of the displacements c = (v_j, v_{j+1}) of both.
//!
//! **The ring.** S in blocks of first (a) and next (b) cut, g of the loads on sector 0:
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

use faer::Mat;
use nalgebra::DMatrix;

use super::condensed_sector::{Condensed, Place, Pressed, places};
use super::responses::{LoadNodes, Responses};
use crate::error::FeError;
use crate::fe_mesh::FeGearMesh;
use crate::material::Elastic;

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
    let (sector, Pressed { held, on_cuts }) = Condensed::new(mesh, material, face_width, &unit)?;
    let cuts = cuts(&sector, &on_cuts, mesh.name)?;
    // The same rows of the load nodes alone.
    let rows: Vec<usize> = loads.list.iter().flat_map(|node| [2 * node, 2 * node + 1]).collect();
    let of_load_nodes = [sector.carried.select_rows(&rows), held.select_rows(&rows)];
    // Sectors follow each other clockwise on external gears, where tooth numbers go down.
    let goes_down = mesh.outline.radial_sign() > 0.0;
    let ring = RingOfSectors { sector, held, of_load_nodes, cuts, goes_down };
    Ok(Responses::of_ring(mesh, loads, ring))
}

/// Displacements of the sectors of a ring under loads on one of them, as far as its cuts tell them.
#[derive(Debug, Clone)]
pub(super) struct RingOfSectors {
    pub(super) sector: Condensed,
    /// Displacements of all nodes of a sector (2 rows each) under the loads with both cuts held, m/N.
    held: DMatrix<f64>,
    /// Rows of the load nodes alone of [`Condensed::carried`] and of these.
    of_load_nodes: [DMatrix<f64>; 2],
    cuts: Cuts,
    /// Whether the tooth of the next sector has the next lower number.
    goes_down: bool,
}

impl RingOfSectors {
    /// Response of all nodes of the tooth `offset` teeth on from the loaded one, 2 rows each, to all loads or those of
    /// some columns, m/N.
    pub(super) fn of_all_nodes(&self, offset: i64, loads: Option<&Range<usize>>) -> DMatrix<f64> {
        self.of([&self.sector.carried, &self.held], offset, loads)
    }

    /// The same of the load nodes alone.
    pub(super) fn of_load_nodes(&self, offset: i64) -> DMatrix<f64> {
        let [carried, held] = &self.of_load_nodes;
        self.of([carried, held], offset, None)
    }

    fn of(
        &self,
        [carried, held]: [&DMatrix<f64>; 2],
        offset: i64,
        loads: Option<&Range<usize>>,
    ) -> DMatrix<f64> {
        let sector = self.sector_of(offset);
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

    /// Number of the sector of a tooth.
    pub(super) fn sector_of(&self, offset: i64) -> usize {
        let sectors = self.cuts.list.ncols() as i64;
        (if self.goes_down { -offset } else { offset }).rem_euclid(sectors) as usize
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

/// Displacements of all cuts under the loads g on sector 0.
fn cuts(sector: &Condensed, loads: &DMatrix<f64>, body: &'static str) -> Result<Cuts, FeError> {
    let (m, z, count) = (sector.cut, sector.sectors, loads.ncols());
    let blocks = sector.blocks();
    let (here, next) = (loads.rows(0, m), loads.rows(m, m));
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
