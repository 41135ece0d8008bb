//! Half the outline of one tooth: flank, fillet, root.

use std::f64::consts::PI;

use gearset::involute::{pressure_angle_at, radius_at};
use gearset::{Gear, ToothSide};

/// Which flank of a *tooth* (an external gear's lobe; on the ring, the material between spaces).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// At the tooth's counter-clockwise side.
    Ccw,
    /// At its clockwise side.
    Cw,
}

impl Side {
    /// +1 counter-clockwise, −1 clockwise.
    pub fn sign(self) -> f64 {
        match self {
            Self::Ccw => 1.0,
            Self::Cw => -1.0,
        }
    }

    /// 0 counter-clockwise, 1 clockwise.
    pub fn index(self) -> usize {
        match self {
            Self::Ccw => 0,
            Self::Cw => 1,
        }
    }
}

/// Counter-clockwise half of a tooth's outline in the tooth's frame: origin at the gear's centre,
/// x along the tooth's axis. Lengths in m.
#[derive(Debug, Clone)]
pub struct Outline {
    gear: Gear,
    form_roll_length: f64,
    /// End of the fillet on the flank side: on the involute, or on the radial line below the base
    /// circle if the fillet ends there.
    fillet_end: [f64; 2],
    fillet_centre: [f64; 2],
    /// Half the angle of the root land.
    pub half_land: f64,
}

impl Outline {
    /// Outline of a gear's tooth.
    pub fn new(gear: &Gear) -> Self {
        let rho = gear.fillet_radius;
        let half_land = 0.5 * gear.root_land_angle();
        let sign = radial_sign(gear);
        // The fillet's centre stands ρ from the root circle.
        let centre_radius = gear.root_radius + sign * rho;
        let fillet_centre = polar(centre_radius, PI / f64::from(gear.teeth) - half_land);
        let form_roll_length = gear.form_roll_length();
        let mut outline = Self {
            gear: gear.clone(),
            form_roll_length: form_roll_length.unwrap_or(0.0),
            fillet_end: [0.0; 2],
            fillet_centre,
            half_land,
        };
        outline.fillet_end = match form_roll_length {
            Some(_) => outline.flank_point(0.0),
            // On the radial line through the involute's origin.
            None => polar(
                (centre_radius.powi(2) - rho * rho).sqrt(),
                gear.tooth_thickness(gear.base_radius) / (2.0 * gear.base_radius),
            ),
        };
        outline
    }

    /// The gear.
    pub fn gear(&self) -> &Gear {
        &self.gear
    }

    /// +1 if the tip is outwards, −1 if inwards.
    pub fn radial_sign(&self) -> f64 {
        radial_sign(&self.gear)
    }

    /// Arc length of the flank from form circle to tip: |s_tip² − s_form²|/(2 r_b).
    pub fn flank_length(&self) -> f64 {
        self.flank_parameter(self.gear.tip_roll_length())
    }

    /// Arc length ℓ from the form circle to roll length `s`, growing towards the tip.
    pub fn flank_parameter(&self, roll_length: f64) -> f64 {
        let swept = roll_length * roll_length - self.form_roll_length * self.form_roll_length;
        self.radial_sign() * swept / (2.0 * self.gear.base_radius)
    }

    /// Roll length at arc length ℓ.
    pub fn roll_length_at(&self, l: f64) -> f64 {
        let swept = self.radial_sign() * 2.0 * self.gear.base_radius * l;
        (self.form_roll_length * self.form_roll_length + swept).max(0.0).sqrt()
    }

    /// Point of the counter-clockwise flank.
    pub fn flank_point(&self, l: f64) -> [f64; 2] {
        let r = radius_at(self.gear.base_radius, self.roll_length_at(l));
        polar(r, self.gear.tooth_thickness(r) / (2.0 * r))
    }

    /// Unit tangent dP/dℓ of the counter-clockwise flank, towards the tip: parallel to the radius
    /// at which the base tangent leaves the base circle.
    pub fn flank_tangent(&self, l: f64) -> [f64; 2] {
        let r = radius_at(self.gear.base_radius, self.roll_length_at(l));
        let sign = self.radial_sign();
        let angle = self.gear.tooth_thickness(r) / (2.0 * r)
            - sign * pressure_angle_at(self.gear.base_radius, r);
        polar(sign, angle)
    }

    /// How far the inward normal at the tip corner runs inside the tooth, m: to the other flank, at
    /// most the tooth's height.
    pub fn depth_at_tip(&self) -> f64 {
        let l = self.flank_length();
        let ([x, y], [tx, ty]) = (self.flank_point(l), self.flank_tangent(l));
        // The tangent turned towards the axis.
        let normal = if tx * self.radial_sign() > 0.0 {
            [ty * self.radial_sign(), -tx * self.radial_sign()]
        } else {
            [-ty * self.radial_sign(), tx * self.radial_sign()]
        };
        let inside = |t: f64| {
            let (p, q) = (x + t * normal[0], y + t * normal[1]);
            let r = p.hypot(q);
            q.atan2(p) > -self.gear.tooth_thickness(r) / (2.0 * r)
        };
        let (mut low, mut high) = (0.0, (self.gear.tip_radius - self.gear.root_radius).abs());
        if inside(high) {
            return high;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if inside(middle) { low = middle } else { high = middle }
        }
        low
    }

    /// Length of the straight radial part between fillet and base circle; zero where the fillet
    /// meets the involute.
    pub fn radial_line(&self) -> f64 {
        let [x, y] = self.flank_point(0.0);
        (x - self.fillet_end[0]).hypot(y - self.fillet_end[1])
    }

    /// Point of the radial line, t from 0 at the fillet to 1 at the base circle.
    pub fn radial_line_point(&self, t: f64) -> [f64; 2] {
        let end = self.flank_point(0.0);
        [0, 1].map(|i| self.fillet_end[i] + t * (end[i] - self.fillet_end[i]))
    }

    /// Angle the fillet sweeps.
    pub fn fillet_sweep(&self) -> f64 {
        let (from, to) = self.fillet_angles();
        (to - from).abs()
    }

    /// Point of the fillet, t from 0 on the root circle to 1 at the flank.
    pub fn fillet_point(&self, t: f64) -> [f64; 2] {
        let (from, to) = self.fillet_angles();
        let angle = from + t * (to - from);
        let arm = polar(self.gear.fillet_radius, angle);
        [self.fillet_centre[0] + arm[0], self.fillet_centre[1] + arm[1]]
    }

    /// Direction of the fillet at t, towards the flank.
    pub fn fillet_direction(&self, t: f64) -> [f64; 2] {
        let (from, to) = self.fillet_angles();
        let angle = from + t * (to - from);
        let turn = (to - from).signum();
        [-angle.sin() * turn, angle.cos() * turn]
    }

    fn fillet_angles(&self) -> (f64, f64) {
        let [x, y] = self.fillet_centre;
        // The root circle lies inwards of the centre on an external gear.
        let sign = self.radial_sign();
        let from = (-sign * y).atan2(-sign * x);
        let to = (self.fillet_end[1] - y).atan2(self.fillet_end[0] - x);
        let swept = (to - from + PI).rem_euclid(2.0 * PI) - PI;
        (from, from + swept)
    }

    /// Point of the root land, t from 0 at the middle of the space to 1 at the fillet.
    pub fn land_point(&self, t: f64) -> [f64; 2] {
        polar(self.gear.root_radius, PI / f64::from(self.gear.teeth) - t * self.half_land)
    }

    /// Half the angle of the tooth at its tip.
    pub fn tip_half_angle(&self) -> f64 {
        let r = self.gear.tip_radius;
        self.gear.tooth_thickness(r) / (2.0 * r)
    }
}

fn radial_sign(gear: &Gear) -> f64 {
    match gear.side {
        ToothSide::External => 1.0,
        ToothSide::Internal => -1.0,
    }
}

/// (r cos φ, r sin φ).
pub fn polar(r: f64, angle: f64) -> [f64; 2] {
    [r * angle.cos(), r * angle.sin()]
}
