//! Interface of a vibrating body, the same for every level of fidelity.

use dynamics::Motion;

use super::fixed_race_mode::FixedRaceMode;
use super::modal_body::ModalBody;

/// Displacement, velocity and acceleration of a race: x, y (m) and u = r θ (m) each.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RaceMotion {
    /// Displacement.
    pub x: [f64; 3],
    /// Velocity.
    pub v: [f64; 3],
    /// Acceleration.
    pub a: [f64; 3],
}

/// A place at which a force loads the flexible part of a body. The elastic displacement measured
/// there is ℓ u = Σ w u, and a unit force there loads the degrees of freedom with ℓᵀ.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Port {
    /// (degree of freedom in the body's frame, weight).
    pub terms: Vec<(usize, f64)>,
}

impl Port {
    /// ℓ u.
    pub fn read(&self, u: &[f64]) -> f64 {
        self.terms.iter().map(|(i, w)| w * u[*i]).sum()
    }

    /// u += factor ℓᵀ.
    pub fn add_to(&self, factor: f64, u: &mut [f64]) {
        for (i, w) in &self.terms {
            u[*i] += factor * w;
        }
    }
}

/// A body that is advanced by time steps.
///
/// A point is displaced by its race (x, y, u = rθ), carried along rigidly, plus the elastic
/// displacement, which vanishes on the race. Within a step of Newmark's method the body gives
///
/// ```text
/// elastic displacement at port a   = free_a + c_aᵀ q − Σ_b G_ab P_b
/// force needed on the race         = A q − L + Σ_a c_a P_a
/// ```
///
/// for race displacements q at the end of the step and forces P_b that press on its ports (positive
/// against the ports' directions). A and G_ab do not change from step to step. Proportional damping
/// C = αM + βK acts within the body.
///
/// The body's own frame is turned by `angle` (rad) from the frame of the race's coordinates.
pub trait VibratingBody: std::fmt::Debug + Send {
    /// A, 3×3, N/m.
    fn race_stiffness(&self) -> [[f64; 3]; 3];

    /// Starts a step from the state at its beginning; returns L, N.
    fn predict(&mut self, race: &RaceMotion, angle: f64) -> [f64; 3];

    /// free_a, m, after [`VibratingBody::predict`].
    fn free(&self, port: &Port) -> f64;

    /// c_a.
    fn coupling(&self, port: &Port, angle: f64) -> [f64; 3];

    /// G_ab for all pairs of some ports, by rows, m/N.
    fn receptance(&self, ports: &[Port]) -> Vec<f64>;

    /// Part of the ports' static flexibility that the body's own elastic state represents, by rows,
    /// m/N; the rest acts without inertia.
    fn carried_flexibility(&self, ports: &[Port]) -> Vec<f64>;

    /// Ends the step with the race displaced by q and one force P for each port.
    fn finish(&mut self, race: [f64; 3], angle: f64, ports: &[Port], forces: &[f64]);

    /// Puts the elastic state to rest under one force P for each port.
    fn rest_under(&mut self, ports: &[Port], forces: &[f64]);

    /// Elastic state besides the race; empty where there are no unknowns.
    fn elastic_mut(&mut self) -> &mut Motion;

    /// Modes that represent the body, `None` where it has every degree of freedom.
    fn modes(&self) -> Option<&[FixedRaceMode]>;

    /// Degrees of freedom besides the race.
    fn unknowns(&self) -> usize;

    /// The body as one of modes (none for a quasi-static body); `None` where it has every degree of freedom.
    fn modal(&self) -> Option<&ModalBody> {
        None
    }
}

/// Components of a race vector in a frame turned by `angle`: x and y turn, u stays.
pub(super) fn into_frame(v: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    [cos * v[0] + sin * v[1], -sin * v[0] + cos * v[1], v[2]]
}

/// Inverse of [`into_frame`].
pub(super) fn out_of_frame(v: [f64; 3], angle: f64) -> [f64; 3] {
    into_frame(v, -angle)
}
