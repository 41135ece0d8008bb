//! Solvers of the contact problem by their names on the command line.

#[cfg(feature = "interior_point")]
use fe_contact::complementarity::InteriorPoint;
use fe_contact::complementarity::{ActiveSet, ComplementaritySolver, Lemke};

use crate::arguments::ContactSolver;

/// The solver asked for.
pub(super) fn solver(which: ContactSolver) -> &'static (dyn ComplementaritySolver + Sync) {
    match which {
        ContactSolver::ActiveSet => &ActiveSet,
        ContactSolver::Lemke => &Lemke,
        #[cfg(feature = "interior_point")]
        ContactSolver::InteriorPoint => &InteriorPoint,
    }
}

/// How many times as long as with active sets it takes.
pub(super) fn slowness(which: ContactSolver) -> f64 {
    match which {
        ContactSolver::ActiveSet => 1.0,
        ContactSolver::Lemke => 6.0,
        #[cfg(feature = "interior_point")]
        ContactSolver::InteriorPoint => 160.0,
    }
}
