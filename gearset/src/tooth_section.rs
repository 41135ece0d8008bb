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
