//! Couplings and their force law.

/// Forces of couplings over their deflections.
pub trait CouplingForce {
    /// Force (N, not falling with deflection) and tangent (N/m) of a coupling at a step
    /// of the cycle and a deflection (m).
    fn answer(&self, coupling: usize, step_in_cycle: usize, deflection: f64) -> (f64, f64);

    /// A deflection (m) up to which a coupling has no force at any step of the cycle.
    fn silent_up_to(&self, coupling: usize) -> f64 {
        let _ = coupling;
        f64::NEG_INFINITY
    }

    /// Whether two couplings, each at a step of the cycle, have the same force over deflection. A law that cannot
    /// tell says so of a coupling and itself only.
    fn is_same(&self, first: (usize, usize), second: (usize, usize)) -> bool {
        first == second
    }
}

/// One coupling: δ = rᵀx − o.
#[derive(Debug, Clone, PartialEq)]
pub struct Coupling {
    /// r on the coordinates.
    pub row: Vec<f64>,
    /// o, m.
    pub offset: f64,
    /// τ, s: the force answers to δ + τ δ̇.
    pub lag: f64,
}
