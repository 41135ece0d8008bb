//! Gyroscopic terms: modes in the frame that turns with the carrier, over carrier speed.
//!
//! The terms are those of each body's translation ([`RotatingFrame`]), of the central members and, in ζ and η, of the
//! planets. Bearings are isotropic, so that a spring to ground has the same stiffness matrix in the rotating frame.
//!
//! The equations are those of bodies without steady centrifugal load. Planets that turn with the carrier load their
//! bearings by m Ω² r, which turns with the carrier and so resists what K_Ω does to a common rotation: a set that
//! nothing holds is the same set at every angle. Without that preload its common rotation grows, to first order in Ω
//! over the natural frequencies, as e^{at}, a² = Ω² N m_p r_c²/I, with I the inertia of the whole set about it.

use std::f64::consts::TAU;

use gearset::{Axis, Body};
use nalgebra::DMatrix;
use serde::Serialize;

use dynamics::{RotatingFrame, gyroscopic_modes};

use crate::error::LumpedError;
use crate::kinds::Kinds;
use crate::model::LumpedModel;
use crate::participation::Participation;

/// One mode at a carrier speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SpeedMode {
    /// Frequency in the carrier frame, Hz.
    pub frequency_hz: f64,
    /// What rounding may have changed of the frequency, Hz: the eigenvalues of the state matrix are good to a part
    /// of the largest, so that s² is good to n ε ω_max².
    pub uncertainty_hz: f64,
    /// Growth rate, 1/s; zero up to rounding for stable motion.
    pub growth_per_s: f64,
    /// Shares in the kinds.
    pub participation: Participation,
}

/// All modes at one carrier speed, ascending.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpeedModes {
    /// Ω_c, rad/s.
    pub carrier_speed_rad_per_s: f64,
    /// Modes.
    pub modes: Vec<SpeedMode>,
}

/// Growth rates below this part of the largest ω are rounding: s = 0, which rigid-body motion has twice, comes out
/// as the root of what rounding leaves of s².
const GROWTH_FLOOR: f64 = 1e-6;

impl SpeedModes {
    /// Largest growth rate of any mode, 1/s.
    pub fn largest_growth_per_s(&self) -> f64 {
        self.modes.iter().fold(0.0, |a, m| a.max(m.growth_per_s))
    }

    /// Frequency of the mode that grows fastest, Hz, 0 where it grows without oscillating; `None` if no mode grows
    /// faster than rounding explains.
    pub fn growing_hz(&self) -> Option<f64> {
        let fastest = |a: &&SpeedMode, b: &&SpeedMode| a.growth_per_s.total_cmp(&b.growth_per_s);
        self.modes.iter().max_by(fastest).filter(|_| self.is_unstable()).map(|m| m.frequency_hz)
    }

    /// Whether a mode grows faster than rounding explains.
    pub fn is_unstable(&self) -> bool {
        let largest = self.modes.iter().fold(0.0f64, |a, m| a.max(TAU * m.frequency_hz));
        self.largest_growth_per_s() > GROWTH_FLOOR * largest
    }
}

/// Campbell data: modes with gyroscopic terms at each carrier speed (rad/s).
///
/// # Errors
/// If an eigenproblem does not converge.
///
/// ```
/// use scene::{Scene, SceneKind, template};
/// use lumped::{LumpedModel, NaturalModes, campbell};
///
/// let set = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
/// let model = LumpedModel::from_scene(&set).unwrap();
/// let [standing, turning] = &campbell(&model, &[0.0, 50.0]).unwrap()[..] else { panic!() };
/// assert!(!standing.is_unstable() && standing.modes.len() == turning.modes.len());
/// ```
pub fn campbell(model: &LumpedModel, speeds: &[f64]) -> Result<Vec<SpeedModes>, LumpedError> {
    let k = model.stiffness();
    let kinds = Kinds::of(model);
    speeds.iter().map(|&speed| at_speed(model, &k, &kinds, speed)).collect()
}

/// `[eq:carrier-frame]` M q̈ + Ω G q̇ + (K − Ω² K_Ω) q = 0, G_xy = −2m, G_yx = +2m, K_Ω = diag(m, m, 0).
///
/// Source: derived here.
/// Checked by: `lumped/tests/derivatives.rs::an_unsupported_set_seen_from_the_carrier_whirls_at_carrier_speed`,
/// `lumped/tests/derivatives.rs::a_standing_carrier_gives_the_natural_frequencies`.
fn at_speed(
    model: &LumpedModel,
    k: &DMatrix<f64>,
    kinds: &Kinds,
    speed: f64,
) -> Result<SpeedModes, LumpedError> {
    let n = model.mass.len();
    let frame = RotatingFrame { speed };
    let mut g = DMatrix::zeros(n, n);
    let mut k = k.clone();
    for body in Body::all(model.psi.len()) {
        let translation = Axis::TRANSLATIONS.map(|axis| model.coordinates.of(body, axis));
        if let [Some(x), Some(y)] = translation {
            let m = model.mass[x];
            let [[_, of_y], [of_x, _]] = frame.gyroscopic(m);
            g[(x, y)] = of_y;
            g[(y, x)] = of_x;
            k[(x, x)] += frame.centripetal(m);
            k[(y, y)] += frame.centripetal(m);
        }
    }
    let modes = gyroscopic_modes(&model.mass, &g, &k)?;
    let largest = modes.iter().fold(0.0f64, |a, mode| a.max(mode.omega));
    // d(s²) = 2 s ds, and at s = 0 the root of it
    let unsure = n as f64 * f64::EPSILON * largest * largest;
    let modes = modes
        .iter()
        .map(|mode| {
            // Real and imaginary part side by side, M^½-scaled.
            let parts = |i: usize, part: usize| {
                let (re, im) = mode.vector[i];
                model.mass[i].sqrt() * if part == 0 { re } else { im }
            };
            let [rotational, translational] = kinds
                .projections(2, parts)
                .map(|rows| rows.iter().flatten().map(|p| p * p).sum::<f64>());
            SpeedMode {
                frequency_hz: mode.omega / TAU,
                uncertainty_hz: (unsure / (2.0 * mode.omega)).min(unsure.sqrt()) / TAU,
                growth_per_s: mode.growth,
                participation: Participation {
                    rotational,
                    translational,
                    planet: (1.0 - rotational - translational).max(0.0),
                },
            }
        })
        .collect();
    Ok(SpeedModes { carrier_speed_rad_per_s: speed, modes })
}
