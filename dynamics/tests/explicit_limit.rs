//! The border of the explicit central difference.

use dynamics::stability::explicit_limit;

/// Without damping Δt·ω_max = 2; with M and C both taken at the middle of the step, damping leaves it where it is.
#[test]
fn the_explicit_step_is_stable_up_to_two() {
    for ratio in [0.0, 0.02, 0.3] {
        let found = explicit_limit(ratio).unwrap();
        assert!((found - 2.0).abs() < 1e-5, "{ratio}: {found}");
    }
}
