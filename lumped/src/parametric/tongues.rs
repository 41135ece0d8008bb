//! Instability tongues to first order in the stiffness variation.
//!
//! Near lΩ = ω_p + ω_q (Ω the mesh frequency) the slowly varying amplitudes of two groups of modes P and Q obey, with
//! V_l = Σ_i k_i ŵ_il b_i b_iᵀ and H = Φ_Pᵀ V_l Φ_Q,
//!
//! ```text
//! 2i ω_p Ȧ = −ε H B̄ e^{iδt},   2i ω_q Ḃ = −ε Hᵀ Ā e^{iδt},   lΩ = ω_p + ω_q + δ
//! ```
//!
//! which grow between the borders of [`tongue`].

use std::f64::consts::TAU;

use dynamics::c64;
use nalgebra::DMatrix;

use super::floquet::ParametricSet;
use crate::error::LumpedError;
use crate::kinds::ModeType;
use crate::modes::{ModeGroup, NaturalModes};

/// A tongue to first order.
#[derive(Debug, Clone, PartialEq)]
pub struct Tongue {
    /// Harmonic l of the mesh frequency.
    pub harmonic: u32,
    /// Natural frequencies f_p ≤ f_q, Hz.
    pub frequency_hz: [f64; 2],
    /// Their types.
    pub mode_type: [ModeType; 2],
    /// Mesh frequency at ε = 0, (f_p + f_q)/l, Hz.
    pub mesh_frequency_hz: f64,
    /// Half-width in mesh frequency per ε, Hz.
    pub half_width_hz: f64,
    /// The most that any phases and contact ratios of the meshes could give, from Σ_i k_i (2/πl) |b_iᵀ Φ_P| |b_iᵀ Φ_Q|:
    /// what is left of it tells which tongues vanish.
    pub bound_hz: f64,
    /// Largest growth rate per ε, 1/s.
    pub growth_per_s: f64,
}

impl Tongue {
    /// Half-width over its bound, 0 to 1.
    pub fn strength(&self) -> f64 {
        match self.bound_hz > 0.0 {
            true => self.half_width_hz / self.bound_hz,
            false => 0.0,
        }
    }
}

/// All tongues of harmonics 1…`harmonics`, by mesh frequency. Rigid-body modes have none.
///
/// # Errors
/// If the modes cannot be found.
pub fn tongues(set: &ParametricSet, harmonics: u32) -> Result<Vec<Tongue>, LumpedError> {
    let modes = NaturalModes::of(set.model())?;
    let groups: Vec<&ModeGroup> = modes.groups.iter().filter(|g| g.frequency_hz > 0.0).collect();
    let mut all = Vec::new();
    for l in 1..=harmonics {
        for (i, p) in groups.iter().enumerate() {
            for q in &groups[i..] {
                all.push(tongue(set, l, p, q));
            }
        }
    }
    all.sort_by(|a, b| a.mesh_frequency_hz.total_cmp(&b.mesh_frequency_hz));
    Ok(all)
}

/// `[eq:tongues]` lΩ = ω_p + ω_q ± ε σ(H)/√(ω_p ω_q), H = Φ_Pᵀ V_l Φ_Q, with the largest singular value σ: motions
/// grow between these borders at a rate of at most half of their half-width. For single modes they are
/// lΩ = 2ω_n ± ε|H_nn|/ω_n and ω_n + ω_m ± ε|H_nm|/√(ω_n ω_m); for modes of equal frequency σ takes the place of |H|,
/// whatever basis is chosen for them.
///
/// Source: Lin & Parker, J. Sound Vib. 249 (2002) 129–145, for single modes; modes of equal frequency derived here.
/// Checked by: `lumped/tests/parametric.rs::borders_are_the_first_order_ones_up_to_the_square_of_the_variation`,
/// `lumped/tests/parametric.rs::planet_phasing_closes_the_tongues_that_symmetry_forbids`.
fn tongue(set: &ParametricSet, l: u32, p: &ModeGroup, q: &ModeGroup) -> Tongue {
    let order = f64::from(l);
    let [wp, wq] = [p, q].map(|g| TAU * g.frequency_hz);
    // Half-width of lΩ over ε, rad/s.
    let width = |h: DMatrix<c64>| largest_singular(&h) / (wp * wq).sqrt();
    let own = width(coupling(set, p, q, |i| set.waves()[i].harmonic(l)));
    let top = 2.0 / (std::f64::consts::PI * order);
    let most = top * bound(set, p, q) / (wp * wq).sqrt();
    Tongue {
        harmonic: l,
        frequency_hz: [p.frequency_hz, q.frequency_hz],
        mode_type: [p.mode_type, q.mode_type],
        mesh_frequency_hz: (p.frequency_hz + q.frequency_hz) / order,
        half_width_hz: own / TAU / order,
        bound_hz: most / TAU / order,
        growth_per_s: 0.5 * own,
    }
}

/// Σ_i k_i |b_iᵀ Φ_P| |b_iᵀ Φ_Q|, above σ(H) for any |ŵ_i| ≤ 1.
fn bound(set: &ParametricSet, p: &ModeGroup, q: &ModeGroup) -> f64 {
    let length = |g: &ModeGroup, row: &[(usize, f64)]| -> f64 {
        let stretch = |j: usize| row.iter().map(|&(k, b)| b * g.vectors[(k, j)]).sum::<f64>();
        (0..g.multiplicity).map(|j| stretch(j).powi(2)).sum::<f64>().sqrt()
    };
    set.meshes().iter().map(|(k, row)| k * length(p, row) * length(q, row)).sum()
}

/// H = Σ_i k_i ŵ_i (b_iᵀ Φ_P)ᵀ (b_iᵀ Φ_Q).
fn coupling(
    set: &ParametricSet,
    p: &ModeGroup,
    q: &ModeGroup,
    wave: impl Fn(usize) -> c64,
) -> DMatrix<c64> {
    let mut h = DMatrix::from_element(p.multiplicity, q.multiplicity, c64::new(0.0, 0.0));
    for (i, (stiffness, row)) in set.meshes().iter().enumerate() {
        let stretch = |g: &ModeGroup, j: usize| -> f64 {
            row.iter().map(|&(k, b)| b * g.vectors[(k, j)]).sum()
        };
        let factor = wave(i) * *stiffness;
        for a in 0..p.multiplicity {
            for b in 0..q.multiplicity {
                h[(a, b)] += factor * (stretch(p, a) * stretch(q, b));
            }
        }
    }
    h
}

/// The largest singular value: that of the real form [Re, −Im; Im, Re].
fn largest_singular(h: &DMatrix<c64>) -> f64 {
    let (m, n) = h.shape();
    let real = DMatrix::from_fn(2 * m, 2 * n, |i, j| {
        let z = h[(i % m, j % n)];
        match (i < m, j < n) {
            (true, true) | (false, false) => z.re,
            (true, false) => -z.im,
            (false, true) => z.im,
        }
    });
    // σ² of the smaller product.
    let gram = if m <= n { &real * real.transpose() } else { real.transpose() * &real };
    gram.symmetric_eigenvalues().max().max(0.0).sqrt()
}
