//! The involute of a circle: closed forms used by every part of the geometry.

/// `[eq:involute]` inv α = tan α − α.
///
/// Source: closed form.
/// Checked by: `gearset/src/involute.rs::inv_of_twenty_degrees_is_the_handbook_value`.
pub fn inv(alpha: f64) -> f64 {
    alpha.tan() - alpha
}

/// Pressure angle of the involute of base radius `base_radius` at `radius`: cos α = r_b / r.
///
/// Zero at and inside the base circle.
pub fn pressure_angle_at(base_radius: f64, radius: f64) -> f64 {
    // α = atan(√(r² − r_b²) / r_b) is accurate near the base circle, where acos(r_b/r) is not.
    (roll_length_at(base_radius, radius) / base_radius).atan()
}

/// `[eq:roll-length]` Roll length at `radius`, the flank's radius of curvature: s = √(r² − r_b²), where cos
/// α = r_b/r.
///
/// Source: closed form.
/// Checked by: `gearset/src/involute.rs::roll_length_and_radius_are_inverse`.
pub fn roll_length_at(base_radius: f64, radius: f64) -> f64 {
    ((radius - base_radius) * (radius + base_radius)).max(0.0).sqrt()
}

/// Radius at roll length `s`.
pub fn radius_at(base_radius: f64, roll_length: f64) -> f64 {
    base_radius.hypot(roll_length)
}

/// `[eq:inverse-involute]` The angle α (rad) with inv α = `value`; `None` below 0. Newton's method on tan α − α, which
/// is convex, from the root of its first term α³/3, above the solution: the steps fall monotonically.
///
/// Source: closed form.
/// Checked by: `gearset/src/involute.rs::the_inverse_gives_the_angle_back`.
pub fn angle_with_inv(value: f64) -> Option<f64> {
    if value.is_nan() || value < 0.0 {
        return None;
    }
    let mut alpha = (3.0 * value).cbrt().min(1.5);
    for _ in 0..60 {
        let step = (inv(alpha) - value) / alpha.tan().powi(2);
        if step.is_nan() || step.abs() <= 1e-16 * alpha {
            break;
        }
        alpha -= step;
    }
    Some(alpha)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roll_length_and_radius_are_inverse() {
        let r_b = 35.2e-3;
        for r in [35.2e-3, 36.0e-3, 42.0e-3] {
            assert!((radius_at(r_b, roll_length_at(r_b, r)) - r).abs() < 1e-17);
        }
    }

    #[test]
    fn inv_of_twenty_degrees_is_the_handbook_value() {
        // inv 20° = 0.014904…, printed in every gear handbook.
        assert!((inv(20f64.to_radians()) - 0.014_904_4).abs() < 5e-8);
    }

    #[test]
    fn the_inverse_gives_the_angle_back() {
        for degrees in [0.0, 0.5, 12.0, 20.0, 24.58, 35.0, 60.0] {
            let alpha = f64::to_radians(degrees);
            let found = angle_with_inv(inv(alpha)).unwrap();
            assert!((found - alpha).abs() < 1e-12, "{degrees}: {found}");
        }
        assert!(angle_with_inv(-1e-3).is_none() && angle_with_inv(f64::NAN).is_none());
    }
}
