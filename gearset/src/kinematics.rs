//! Speeds, mesh frequency and external torques of a simple planetary set in steady motion.
//!
//! Everything is absolute (inertial frame) and counter-clockwise positive unless a name says
//! otherwise. The relations hold at any pressure angle and profile shift: they use tooth numbers
//! alone, and Z_r = Z_s + 2 Z_p is not required.

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::Serialize;

use crate::operation::Member;

/// rad/s in one rpm: 2π/60.
const RAD_PER_S_IN_RPM: f64 = TAU / 60.0;

/// Why a set has no kinematics.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum KinematicsError {
    /// The driven and the held member are the same.
    #[error("the {} is both held and driven: the input must be another member", .0.name())]
    InputIsFixed(Member),
    /// The speed is not a number.
    #[error("input speed {0} rpm is not finite")]
    SpeedNotFinite(f64),
    /// The scene lacks data from which speeds follow.
    #[error(
        "{0} is absent: motion follows from the numbers of teeth and the operating point of a planetary set"
    )]
    Absent(&'static str),
    /// A gear without teeth.
    #[error("the {0} has no teeth")]
    NoTeeth(&'static str),
}

/// Angular speeds of all members, counter-clockwise positive, all in one unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct MemberSpeeds {
    /// ω_s.
    pub sun: f64,
    /// ω_r.
    pub ring: f64,
    /// ω_c.
    pub carrier: f64,
    /// ω_p, absolute.
    pub planet: f64,
    /// ω_p − ω_c: the planet on its pin.
    pub planet_relative_to_carrier: f64,
}

impl MemberSpeeds {
    /// Speed of a central member.
    pub fn of(&self, member: Member) -> f64 {
        match member {
            Member::Sun => self.sun,
            Member::Ring => self.ring,
            Member::Carrier => self.carrier,
        }
    }

    fn scaled(self, factor: f64) -> Self {
        Self {
            sun: self.sun * factor,
            ring: self.ring * factor,
            carrier: self.carrier * factor,
            planet: self.planet * factor,
            planet_relative_to_carrier: self.planet_relative_to_carrier * factor,
        }
    }
}

/// External torques that hold the central members in steady motion, N·m, counter-clockwise
/// positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct MemberTorques {
    /// T_s.
    pub sun: f64,
    /// T_r.
    pub ring: f64,
    /// T_c.
    pub carrier: f64,
}

impl MemberTorques {
    /// Torque on a central member.
    pub fn of(&self, member: Member) -> f64 {
        match member {
            Member::Sun => self.sun,
            Member::Ring => self.ring,
            Member::Carrier => self.carrier,
        }
    }
}

/// Steady motion of a simple planetary set with one member held and one turned.
///
/// ```
/// use gearset::{Kinematics, Member};
///
/// let set = Kinematics::new(27, 35, 99, Member::Ring, Member::Sun, 2500.0).unwrap();
/// assert!((set.mesh_frequency_hz - 883.93).abs() < 0.01);
/// assert!((set.speeds_rpm.carrier - 535.71).abs() < 0.01);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Kinematics {
    /// Z_s.
    pub teeth_sun: u32,
    /// Z_p.
    pub teeth_planet: u32,
    /// Z_r.
    pub teeth_ring: u32,
    /// The member that stands still.
    pub fixed: Member,
    /// The member whose speed is given.
    pub input: Member,
    /// The member that is neither held nor driven.
    pub output: Member,
    /// Speeds, rpm.
    pub speeds_rpm: MemberSpeeds,
    /// Speeds, rad/s.
    pub speeds_rad_per_s: MemberSpeeds,
    /// ω_out / ω_in; defined by the teeth alone, also at rest.
    pub speed_ratio: f64,
    /// Mesh frequency f_m, the same in both meshes, Hz.
    pub mesh_frequency_hz: f64,
}

impl Kinematics {
    /// Motion with `fixed` held and `input` turning at `speed_rpm`.
    ///
    /// `[eq:willis]` Seen from the carrier the set is an ordinary gear train with equal pitch-line speeds in both
    /// meshes:
    /// ```text
    /// Z_s (ω_s − ω_c) = −Z_p (ω_p − ω_c) of the external mesh,
    /// Z_r (ω_r − ω_c) = Z_p (ω_p − ω_c) of the internal mesh,
    /// Z_s ω_s + Z_r ω_r = (Z_s + Z_r) ω_c as their sum.
    /// ```
    /// Source: Willis; no edition cited.
    /// Checked by: `gearset/tests/kinematics.rs::both_mesh_equations_hold_for_every_drive`,
    /// `gearset/tests/kinematics.rs::a_common_speed_added_to_all_members_changes_no_mesh`.
    ///
    /// `[eq:mesh-frequency]` f_m = Z_s |ω_s − ω_c|/2π = Z_r |ω_r − ω_c|/2π.
    /// Source: definition.
    /// Checked by: `gearset/tests/kinematics.rs::both_mesh_equations_hold_for_every_drive`, `table1.mesh_frequency`.
    ///
    /// # Errors
    /// [`KinematicsError`] if `input` is `fixed`, the speed is not finite or a gear has no teeth.
    pub fn new(
        teeth_sun: u32,
        teeth_planet: u32,
        teeth_ring: u32,
        fixed: Member,
        input: Member,
        speed_rpm: f64,
    ) -> Result<Self, KinematicsError> {
        for (gear, teeth) in [("sun", teeth_sun), ("planet", teeth_planet), ("ring", teeth_ring)] {
            if teeth == 0 {
                return Err(KinematicsError::NoTeeth(gear));
            }
        }
        if !speed_rpm.is_finite() {
            return Err(KinematicsError::SpeedNotFinite(speed_rpm));
        }
        let output = third(fixed, input).ok_or(KinematicsError::InputIsFixed(fixed))?;

        let z = |member| torque_share(member, teeth_sun, teeth_ring);
        // ω_fixed = 0 leaves Z_in ω_in + Z_out ω_out = 0, with "Z_c" = −(Z_s + Z_r).
        let speed_ratio = -z(input) / z(output);
        let of = |member| match member {
            m if m == fixed => 0.0,
            m if m == input => speed_rpm,
            _ => speed_ratio * speed_rpm,
        };
        let (sun, ring, carrier) = (of(Member::Sun), of(Member::Ring), of(Member::Carrier));

        // Z_s (ω_s − ω_c) = −Z_r (ω_r − ω_c), from the side on which the held member's ω = 0 leaves one
        // term, so that no speeds are subtracted.
        let (z_s, z_p, z_r) =
            (f64::from(teeth_sun), f64::from(teeth_planet), f64::from(teeth_ring));
        let passing = match fixed {
            Member::Sun => -z_s * carrier,
            Member::Ring => z_r * carrier,
            Member::Carrier => z_s * sun,
        };
        // ω_p − ω_c = −(Z_s/Z_p)(ω_s − ω_c)
        let planet_relative_to_carrier = -passing / z_p;
        let planet = carrier + planet_relative_to_carrier;
        let speeds_rpm = MemberSpeeds { sun, ring, carrier, planet, planet_relative_to_carrier };

        Ok(Self {
            teeth_sun,
            teeth_planet,
            teeth_ring,
            fixed,
            input,
            output,
            speeds_rpm,
            speeds_rad_per_s: speeds_rpm.scaled(RAD_PER_S_IN_RPM),
            speed_ratio,
            // One rpm is 1/60 turn a second.
            mesh_frequency_hz: passing.abs() / 60.0,
        })
    }

    /// `[eq:member-torques]` External torques in equilibrium when the input member gets `input_torque_nm`:
    /// T_s : T_r : T_c = Z_s : Z_r : −(Z_s + Z_r).
    ///
    /// Source: Willis; no edition cited.
    /// Checked by: `gearset/tests/kinematics.rs::external_torques_balance_and_lose_no_power`, `sweep.member_torques`.
    ///
    /// They sum to zero, and so does their power. Friction and dynamics are left out.
    pub fn torques_nm(&self, input_torque_nm: f64) -> MemberTorques {
        let z = |member| torque_share(member, self.teeth_sun, self.teeth_ring);
        let torque = |member| input_torque_nm * (z(member) / z(self.input));
        MemberTorques {
            sun: torque(Member::Sun),
            ring: torque(Member::Ring),
            carrier: torque(Member::Carrier),
        }
    }
}

/// Coefficients of Σ z ω = 0, which are also the shares of torque: Z_s, Z_r, −(Z_s + Z_r).
fn torque_share(member: Member, teeth_sun: u32, teeth_ring: u32) -> f64 {
    match member {
        Member::Sun => f64::from(teeth_sun),
        Member::Ring => f64::from(teeth_ring),
        Member::Carrier => -(f64::from(teeth_sun) + f64::from(teeth_ring)),
    }
}

/// The central member that is neither `fixed` nor `input`; `None` if these are the same.
fn third(fixed: Member, input: Member) -> Option<Member> {
    [Member::Sun, Member::Ring, Member::Carrier]
        .into_iter()
        .find(|&m| m != fixed && m != input)
        .filter(|_| fixed != input)
}
