//! What of a gear's circles is filled with material: the outline of a tooth with its root fillets, mass and inertia.

use std::f64::consts::PI;

use crate::gear::{Gear, ToothSide};

/// Nodes and weights of Gauss's formula with eight points on [−1, 1]; the other four are mirrored.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_5],
    [0.960_289_856_497_536_2, 0.101_228_536_290_376_3],
];

/// Points and weights for an integral from `from` to `to`, to eight points.
pub fn gauss_points(from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    GAUSS
        .into_iter()
        .flat_map(move |[x, w]| [(middle - half * x, half * w), (middle + half * x, half * w)])
}

impl Gear {
    /// Half the angle that the material of one tooth fills at `radius` (rad), from its axis: involute flank, root
    /// fillet and, of an external tooth whose fillet ends below the base circle, the radial line between them. π/Z on
    /// the root circle only where the fillets of one tooth space meet.
    ///
    /// The fillet is a circle of radius ρ about a centre on r_c = r_f ± ρ, at the angle ϑ_c from the axis of the tooth:
    /// cos(ϑ_c − ϑ) = (r² + r_c² − ρ²)/(2 r r_c).
    pub fn tooth_half_angle(&self, radius: f64) -> f64 {
        let (rho, r) = (self.fillet_radius, radius);
        let half_pitch = PI / f64::from(self.teeth);
        let off_centre = |centre: f64| {
            let cosine = (r * r + centre * centre - rho * rho) / (2.0 * r * centre);
            cosine.clamp(-1.0, 1.0).acos()
        };
        match self.side {
            ToothSide::External if self.form_roll_length().is_some() && r >= self.form_radius() => {
                self.half_angle(r)
            }
            ToothSide::External => {
                let centre = self.root_radius + rho;
                if self.form_roll_length().is_none() {
                    // The radial line touches the fillet at √(r_c² − ρ²).
                    if r >= self.base_radius {
                        return self.half_angle(r);
                    }
                    if r * r >= centre * centre - rho * rho {
                        return self.half_angle_base;
                    }
                }
                let centre_angle = half_pitch - 0.5 * self.root_land_angle();
                (centre_angle - off_centre(centre)).min(half_pitch)
            }
            ToothSide::Internal if r <= self.form_radius() => half_pitch - self.half_angle(r),
            ToothSide::Internal => {
                let centre = self.root_radius - rho;
                let land = 0.5 * self.root_land_angle();
                half_pitch - (land + off_centre(centre))
            }
        }
    }

    /// Area (m²) and polar second moment of area about the centre (m⁴) of the cross-section, without tip relief; `None`
    /// without a bore or rim.
    pub fn section_moments(&self) -> Option<(f64, f64)> {
        let body = self.body_radius?;
        let annulus = |power: i32| {
            let own =
                2.0 * PI / f64::from(power) * (self.root_radius.powi(power) - body.powi(power));
            own.abs()
        };
        let (mut area, mut polar) = (annulus(2), annulus(4));
        let form = match (self.side, self.form_roll_length()) {
            (ToothSide::External, None) => self.base_radius,
            _ => self.form_radius(),
        };
        // ∫ 2 Z ϑ(r) r dr, and r³; the fillet starts with a vertical tangent, so that it is cut once more.
        let near_root = self.root_radius + 0.1 * (form - self.root_radius);
        for (from, to) in
            [(self.root_radius, near_root), (near_root, form), (form, self.tip_radius)]
        {
            for (r, weight) in gauss_points(from.min(to), from.max(to)) {
                let filled = 2.0 * f64::from(self.teeth) * self.tooth_half_angle(r).max(0.0);
                area += weight * filled * r;
                polar += weight * filled * r.powi(3);
            }
        }
        Some((area, polar))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Geometry;
    use crate::scene::{Scene, SceneKind};
    use crate::template::template;

    fn gears() -> [Gear; 3] {
        let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        let geometry = Geometry::from_scene(&scene).unwrap();
        [geometry.sun.unwrap(), geometry.planet, geometry.ring.unwrap()]
    }

    /// At the form circle the fillet passes into the flank with the same angle and the same tangent; on the root circle
    /// it leaves the land that the geometry states.
    #[test]
    fn fillets_pass_smoothly_from_flank_to_root_circle() {
        let [sun, planet, ring] = gears();
        // A deep fillet below the base circle has a radial line above it.
        let low = Gear { root_radius: sun.base_radius - 2.0 * sun.fillet_radius, ..sun.clone() };
        assert!(low.form_roll_length().is_none());
        for gear in [sun, planet, ring, low] {
            let at = |r: f64| gear.tooth_half_angle(r);
            let sign = if gear.side == ToothSide::External { 1.0 } else { -1.0 };
            let join = gear.form_radius();
            let step = 1e-7 * join;
            let slope = |r: f64| (at(r + step) - at(r)) / step;
            if gear.form_roll_length().is_some() {
                assert!((at(join + 1e-12) - at(join - 1e-12)).abs() < 1e-8, "{gear:?}");
                let [inside, outside] = [join - 2.0 * step, join + step].map(slope);
                assert!((inside - outside).abs() < 1e-3 * inside.abs(), "{inside} {outside}");
            }
            let land = PI / f64::from(gear.teeth) - at(gear.root_radius + sign * 1e-15);
            assert!((land - 0.5 * gear.root_land_angle()).abs() < 1e-6, "{gear:?}");
        }
    }

    /// Against areas of polygons with a hundred thousand corners on the outline.
    #[test]
    fn moments_are_those_of_the_outline() {
        for gear in gears() {
            let count = 100_000;
            let (low, high) =
                (gear.root_radius.min(gear.tip_radius), gear.root_radius.max(gear.tip_radius));
            let (mut area, mut polar) = (0.0, 0.0);
            let step = (high - low) / f64::from(count);
            for i in 0..count {
                let r = low + (f64::from(i) + 0.5) * step;
                let filled = 2.0 * f64::from(gear.teeth) * gear.tooth_half_angle(r);
                area += filled * r * step;
                polar += filled * r.powi(3) * step;
            }
            let body = gear.body_radius.unwrap();
            area += PI * (gear.root_radius.powi(2) - body.powi(2)).abs();
            polar += 0.5 * PI * (gear.root_radius.powi(4) - body.powi(4)).abs();
            let (own, own_polar) = gear.section_moments().unwrap();
            assert!((own / area - 1.0).abs() < 1e-5, "{own} {area}");
            assert!((own_polar / polar - 1.0).abs() < 1e-5, "{own_polar} {polar}");
        }
    }

    /// Gauss's formula with eight points is exact to the power 15.
    #[test]
    fn gauss_points_integrate_a_power_exactly() {
        for (power, from, to) in [(0, -1.0, 2.0), (7, 0.5, 1.5), (15, 0.0, 2.0)] {
            let own: f64 = gauss_points(from, to).map(|(x, w)| w * f64::powi(x, power)).sum();
            let n = power + 1;
            let exact = (f64::powi(to, n) - f64::powi(from, n)) / f64::from(n);
            assert!((own / exact - 1.0).abs() < 1e-13, "{own} {exact}");
        }
    }
}
