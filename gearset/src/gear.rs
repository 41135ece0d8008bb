//! One gear: circles, tooth thickness, flanks.

use std::f64::consts::{PI, TAU};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::geometry_input::{ReliefShape, TipRelief};
use crate::involute::{inv, pressure_angle_at, radius_at, roll_length_at};

/// Which side the teeth are on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ToothSide {
    /// Teeth point outwards (sun, planet).
    External,
    /// Teeth point inwards (ring).
    Internal,
}

/// One involute gear. Lengths in m, angles in rad.
///
/// Both flanks of one *lobe* are described: the tooth of an external gear, the tooth *space* of an
/// internal gear, which has the shape of an external tooth.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Gear {
    /// Number of teeth Z.
    pub teeth: u32,
    /// Where the teeth point.
    pub side: ToothSide,
    /// r_b.
    pub base_radius: f64,
    /// r_a.
    pub tip_radius: f64,
    /// r_f.
    pub root_radius: f64,
    /// Bore radius of an external gear, rim radius of the ring.
    pub body_radius: Option<f64>,
    /// Root fillet radius.
    pub fillet_radius: f64,
    /// Half the lobe's angle on the base circle: t_b / (2 r_b).
    pub half_angle_base: f64,
    /// Tip relief.
    pub tip_relief: Option<TipRelief>,
}

impl Gear {
    /// Angle between neighbouring teeth.
    pub fn pitch_angle(&self) -> f64 {
        TAU / f64::from(self.teeth)
    }

    /// `[eq:tooth-thickness]` Half the lobe's angle at `radius`: β(r) = β_b − inv α(r).
    ///
    /// Source: closed form.
    /// Checked by: `gearset/tests/geometry.rs::backlash_given_is_backlash_found`.
    pub fn half_angle(&self, radius: f64) -> f64 {
        self.half_angle_base - inv(pressure_angle_at(self.base_radius, radius))
    }

    /// Arc thickness of the tooth at `radius`; negative where the flanks would have crossed.
    pub fn tooth_thickness(&self, radius: f64) -> f64 {
        let lobe = 2.0 * self.half_angle(radius);
        let tooth = match self.side {
            ToothSide::External => lobe,
            ToothSide::Internal => self.pitch_angle() - lobe,
        };
        radius * tooth
    }

    /// Arc width of the tooth space at `radius`.
    pub fn space_width(&self, radius: f64) -> f64 {
        radius * self.pitch_angle() - self.tooth_thickness(radius)
    }

    /// Roll length at the tip.
    pub fn tip_roll_length(&self) -> f64 {
        roll_length_at(self.base_radius, self.tip_radius)
    }

    /// Roll length where the fillet, tangent to flank and root circle, leaves the flank.
    ///
    /// `None` if an external fillet ends on the radial line below the base circle. The fillet's centre lies on the base
    /// tangent through that point, ρ beyond the flank, and at r_f ± ρ from the gear's centre.
    ///
    /// `[eq:form-circle]` s = √((r_f ± ρ)² − r_b²) ∓ ρ for a fillet of radius ρ (upper sign external).
    /// Source: derived here.
    /// Checked by: `gearset/tests/geometry.rs::fillets_land_where_a_drawn_circle_touches`.
    pub fn form_roll_length(&self) -> Option<f64> {
        let rho = self.fillet_radius;
        match self.side {
            ToothSide::External => {
                let s = roll_length_at(self.base_radius, self.root_radius + rho) - rho;
                (s >= 0.0).then_some(s)
            }
            ToothSide::Internal => {
                Some(roll_length_at(self.base_radius, self.root_radius - rho) + rho)
            }
        }
    }

    /// Form radius: the flank is an involute from here to the tip.
    pub fn form_radius(&self) -> f64 {
        self.form_roll_length().map_or(self.base_radius, |s| radius_at(self.base_radius, s))
    }

    /// Angle left on the root circle between the two fillets of one tooth space; negative if the
    /// fillets overlap.
    pub fn root_land_angle(&self) -> f64 {
        let rho = self.fillet_radius;
        let half_pitch = PI / f64::from(self.teeth);
        let half = match (self.side, self.form_roll_length()) {
            // The fillet's centre lies on the flank's involute offset by ρ, which is the same involute with
            // its origin turned by ρ/r_b.
            (ToothSide::External, Some(s)) => {
                let alpha = ((s + rho) / self.base_radius).atan();
                half_pitch - (self.half_angle_base + rho / self.base_radius - inv(alpha))
            }
            (ToothSide::External, None) => {
                let centre = self.root_radius + rho;
                half_pitch - (self.half_angle_base + (rho / centre).asin())
            }
            (ToothSide::Internal, s) => {
                let alpha = ((s.unwrap_or(0.0) - rho) / self.base_radius).atan();
                self.half_angle_base - rho / self.base_radius - inv(alpha)
            }
        };
        2.0 * half
    }

    /// Tip relief at roll length `s`, measured along the line of action; zero without relief.
    pub fn relief_at(&self, roll_length: f64) -> f64 {
        self.relief_and_slope_at(roll_length)[0]
    }

    /// Tip relief (m) and its derivative with respect to the roll length (m/m); where relief starts the derivative is
    /// that of the side without relief.
    pub fn relief_and_slope_at(&self, roll_length: f64) -> [f64; 2] {
        let Some(relief) = self.tip_relief else { return [0.0; 2] };
        let start = roll_length_at(self.base_radius, relief.start_radius_m);
        // Towards the tip the roll length grows on an external gear and shrinks on an internal one.
        let length = self.tip_roll_length() - start;
        let x = (roll_length - start) / length;
        match relief.shape {
            _ if x <= 0.0 => [0.0; 2],
            ReliefShape::Linear => [relief.amount_m * x, relief.amount_m / length],
            ReliefShape::Parabolic => [relief.amount_m * x * x, 2.0 * relief.amount_m * x / length],
        }
    }
}

/// Which of a lobe's two flanks: the one at its counter-clockwise or at its clockwise end; of a torque or a
/// rotation, its sense.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Facing {
    /// The lobe's counter-clockwise end: polar angle θ₀ − inv α(r).
    CounterClockwise,
    /// The lobe's clockwise end: polar angle θ₀ + inv α(r).
    Clockwise,
}

impl Facing {
    /// +1 counter-clockwise, −1 clockwise.
    pub fn sign(self) -> f64 {
        match self {
            Self::CounterClockwise => 1.0,
            Self::Clockwise => -1.0,
        }
    }

    /// As tables print it.
    pub fn name(self) -> &'static str {
        match self {
            Self::CounterClockwise => "counter_clockwise",
            Self::Clockwise => "clockwise",
        }
    }

    /// The other flank of the lobe.
    pub fn opposite(self) -> Self {
        match self {
            Self::CounterClockwise => Self::Clockwise,
            Self::Clockwise => Self::CounterClockwise,
        }
    }
}

/// One flank placed in the plane.
#[derive(Debug, Clone, Copy)]
pub struct Flank<'g> {
    /// The gear it belongs to.
    pub gear: &'g Gear,
    /// Centre of the gear, m.
    pub centre: [f64; 2],
    /// Polar angle θ₀ of the involute's origin on the base circle, rad.
    pub origin_angle: f64,
    /// Which end of the lobe.
    pub facing: Facing,
}

impl<'g> Flank<'g> {
    /// Flank of lobe number `index` of a gear whose lobe 0 is centred at `gear_angle`.
    pub fn of_lobe(
        gear: &'g Gear,
        centre: [f64; 2],
        gear_angle: f64,
        index: i64,
        facing: Facing,
    ) -> Self {
        let lobe = gear_angle + index as f64 * gear.pitch_angle();
        let origin_angle = lobe + facing.sign() * gear.half_angle_base;
        Self { gear, centre, origin_angle, facing }
    }

    /// Point of the unrelieved flank at roll length `s`, m.
    pub fn point(&self, roll_length: f64) -> [f64; 2] {
        self.point_and_radial(roll_length).0
    }

    /// Point P of the unrelieved flank at roll length s, m, and the unit radial direction e where its base tangent
    /// leaves the base circle, so that dP/ds = (s/r_b) e:
    ///
    /// ```text
    /// P = c + r_b e(φ) ± s e'(φ),   φ = θ₀ ∓ s/r_b   (upper sign: counter-clockwise end of the lobe)
    /// ```
    pub fn point_and_radial(&self, roll_length: f64) -> ([f64; 2], [f64; 2]) {
        let (sign, r_b) = (self.facing.sign(), self.gear.base_radius);
        let (sin, cos) = (self.origin_angle - sign * roll_length / r_b).sin_cos();
        let along = sign * roll_length;
        let [x, y] = [r_b * cos - along * sin, r_b * sin + along * cos];
        ([self.centre[0] + x, self.centre[1] + y], [cos, sin])
    }

    /// Gap from the unrelieved flank to a point, measured along the base tangent through the point,
    /// positive on the free side, m. `None` inside the base circle.
    ///
    /// `[eq:corner-gap]` g = r_b (θ₀' − θ₀): the point lies on an involute of the same base circle with origin angle
    /// θ₀', and along every base tangent this involute and the flank are that far apart.
    /// Source: derived here.
    /// Checked by: `gearset/tests/rigid_polygons.rs::tip_gaps_are_distances_from_corner_to_polygon`,
    /// `gearset/tests/geometry.rs::tip_gaps_are_nil_on_the_path_and_a_few_micrometres_just_outside`.
    pub fn gap_to(&self, point: [f64; 2]) -> Option<f64> {
        let [x, y] = [point[0] - self.centre[0], point[1] - self.centre[1]];
        let r = x.hypot(y);
        if r < self.gear.base_radius {
            return None;
        }
        let sign = self.facing.sign();
        let origin = y.atan2(x) + sign * inv(pressure_angle_at(self.gear.base_radius, r));
        let turn = origin - self.origin_angle;
        let turn = turn - TAU * (turn / TAU).round();
        let free_side = match self.gear.side {
            ToothSide::External => sign,
            ToothSide::Internal => -sign,
        };
        Some(free_side * self.gear.base_radius * turn)
    }
}
