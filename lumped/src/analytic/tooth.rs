//! Flexibility of one tooth under a force on its flank, in closed form: Weber's beam on an elastic foundation.
//!
//! The formula is that of [`Tooth::at`]. y(x): half the thickness of the tooth, from the base section, at 0.3 of the
//! fillet's radius above the root circle, to the point P of the force; S: twice y there; u: distance along the axis
//! from the base section to where the force meets the axis; r: radius of the base section; t: depth of the rim from
//! root circle to race. Beam, and the first two terms of the foundation with X = 1, are those of Weber & Banaschek. The
//! rest of the foundation is a rim on a rigid race instead of their half-plane, which on external gears falls away from
//! the tooth on either side the more, the fewer teeth there are (S/r): T, R and Z of external, X, T and R of internal
//! teeth are fitted to FE/contact (`docs/closed_forms.md`).

use gearset::involute::{pressure_angle_at, radius_at};
use gearset::{Gear, ToothSide, gauss_points};

use super::plane::Plane;

/// Where the base section is above the root circle, in fillet radii.
const BASE: f64 = 0.3;

/// 50/(3π): rotation of the base section under its moment.
const ROTATION: f64 = 5.305_164_769_729_845;

/// The terms of the foundation that are fitted, on the drawn sets 1 to 119 (`docs/closed_forms.md`).
struct Foundation {
    /// X.
    cross: f64,
    /// T.
    constant: f64,
    /// R.
    of_rim: f64,
    /// Z.
    of_curvature: f64,
}

/// Those of external teeth.
const EXTERNAL: Foundation =
    Foundation { cross: 1.0, constant: -1.02, of_rim: 2.11, of_curvature: 7.05 };

/// Those of internal teeth, of which a curvature says nothing more.
const INTERNAL: Foundation =
    Foundation { cross: 3.39, constant: -0.76, of_rim: 1.03, of_curvature: 0.0 };

/// Ratios t/S of the rim to which they were fitted.
const RIMS: std::ops::RangeInclusive<f64> = 0.7..=3.0;

/// A tooth as a force on its flank sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tooth {
    /// Displacement of P along a unit force on it, without what the flank yields near P, m/N.
    pub(super) flexibility: f64,
    /// Distance from P along the force to the axis of the tooth, m.
    pub(super) depth: f64,
}

impl Tooth {
    /// The tooth of a gear under a force at a roll length; `None` where the rim is thinner or thicker than those to
    /// which the foundation was fitted, or has no race.
    ///
    /// `[eq:tooth-flexibility]` c = c_b + c_f with E' = E/(1 − ν²) and the angle β of the force to the normal of the
    /// tooth's axis:
    /// ```text
    /// b c_b = ∫ [m²/(E' I) + 1.2 cos²β/(G A) + sin²β/(E' A)] dx,   m = (x_P − x) cos β − y_P sin β,  I = ⅔ y³,  A = 2 y,
    /// b c_f = cos²β/E' [50/(3π) (u/S)² + X 2 (1 − 2ν)/(1 − ν) u/S + T + R ln(t/S) + Z S/r].
    /// ```
    /// Source: Weber & Banaschek, Formänderung und Profilrücknahme bei gerad- und schrägverzahnten Rädern (1953); T,
    /// R, Z and, of internal teeth, X fitted.
    /// Checked by: `validation/tests/closed_forms.rs::closed_forms_hold_on_shipped_sets`,
    /// `lumped/src/analytic/tooth.rs::flexibility_grows_towards_the_tip_and_scales_with_width_and_modulus`.
    pub(super) fn at(gear: &Gear, roll_length: f64, plane: &Plane) -> Option<Self> {
        let radius = radius_at(gear.base_radius, roll_length);
        let half = gear.tooth_half_angle(radius);
        let normal = pressure_angle_at(gear.base_radius, radius);
        // The axis points from root to tip, towards the centre in an internal gear.
        let (outwards, beta, fitted) = match gear.side {
            ToothSide::External => (1.0, normal - half, EXTERNAL),
            ToothSide::Internal => (-1.0, normal + half, INTERNAL),
        };
        let (sin, cos) = beta.sin_cos();
        let (end, y_end) = (radius * half.cos(), radius * half.sin());
        let base = gear.root_radius + outwards * BASE * gear.fillet_radius;
        let width = |r: f64| r * gear.tooth_half_angle(r).sin();
        let (start, y_start) = (base * gear.tooth_half_angle(base).cos(), width(base));
        let length = outwards * (end - start);
        if length <= 0.0 {
            return None;
        }
        let Plane { modulus, shear, poisson, width: b } = *plane;
        let mut beam = 0.0;
        for (share, weight) in gauss_points(0.0, 0.5).chain(gauss_points(0.5, 1.0)) {
            // Sections are taken at radii in proportion to their places on the axis.
            let y = width(base + share * (radius - base));
            let moment = (1.0 - share) * length * cos - y_end * sin;
            beam += weight
                * length
                * (moment * moment / (modulus * 2.0 / 3.0 * y.powi(3))
                    + 1.2 * cos * cos / (shear * 2.0 * y)
                    + sin * sin / (modulus * 2.0 * y));
        }
        let (chord, arm) = (2.0 * y_start, (length - y_end * beta.tan()) / (2.0 * y_start));
        let rim = (gear.root_radius - gear.body_radius?).abs() / chord;
        if !RIMS.contains(&rim) {
            return None;
        }
        let cross = fitted.cross * 2.0 * (1.0 - 2.0 * poisson) / (1.0 - poisson);
        let of_rim =
            fitted.constant + fitted.of_rim * rim.ln() + fitted.of_curvature * chord / base;
        let foundation = cos * cos / modulus * (ROTATION * arm * arm + cross * arm + of_rim);
        Some(Self { flexibility: (beam + foundation) / b, depth: y_end / cos })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use scene::{Scene, SceneKind, template};

    fn sun() -> (Gear, Plane) {
        let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        let geometry = scene.tooth_geometry().unwrap();
        (geometry.sun.unwrap(), Plane::new(&scene, geometry.face_width))
    }

    /// A force nearer the tip bends the tooth more, half the width yields twice as much, and twice the modulus half.
    #[test]
    fn flexibility_grows_towards_the_tip_and_scales_with_width_and_modulus() {
        let (gear, plane) = sun();
        let (low, high) = (gear.form_roll_length().unwrap_or(0.0), gear.tip_roll_length());
        let at = |share: f64, plane: &Plane| {
            Tooth::at(&gear, low + share * (high - low), plane).unwrap().flexibility
        };
        let all: Vec<f64> = (1..=10).map(|i| at(f64::from(i) / 10.0, &plane)).collect();
        assert!(all.windows(2).all(|w| w[1] > w[0]), "{all:?}");
        let narrow = Plane { width: 0.5 * plane.width, ..plane };
        assert!((at(0.5, &narrow) / at(0.5, &plane) - 2.0).abs() < 1e-12);
        let stiff = Plane { modulus: 2.0 * plane.modulus, shear: 2.0 * plane.shear, ..plane };
        assert!((at(0.5, &stiff) / at(0.5, &plane) - 0.5).abs() < 1e-12);
    }

    /// A rim outside of the fitted range, or none, has no flexibility.
    #[test]
    fn rims_that_were_not_fitted_are_refused() {
        let (gear, plane) = sun();
        let with = |body: Option<f64>| Gear { body_radius: body, ..gear.clone() };
        let middle = 0.5 * (gear.root_radius + gear.tip_radius);
        let roll = gearset::involute::roll_length_at(gear.base_radius, middle);
        assert!(Tooth::at(&with(gear.body_radius), roll, &plane).is_some());
        assert!(Tooth::at(&with(Some(0.999 * gear.root_radius)), roll, &plane).is_none());
        assert!(Tooth::at(&with(Some(0.01 * gear.root_radius)), roll, &plane).is_none());
        assert!(Tooth::at(&with(None), roll, &plane).is_none());
    }
}
