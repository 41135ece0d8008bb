//! Tooth geometry as it is given: circles, rack, relief and backlash or profile shift. [`Geometry`](crate::Geometry)
//! is worked out from it.

use serde::{Deserialize, Serialize};

/// Tooth geometry as given in the scene; `Geometry` is worked out from it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GeometryInput {
    /// a, m.
    pub center_distance_m: f64,
    /// p_b, the one base pitch of all gears, m.
    pub base_pitch_m: f64,
    /// Generating rack, when the scene gives one.
    pub rack: Option<Rack>,
    /// Face width b, m.
    pub face_width_m: f64,
    /// Sun, if the scene has one.
    pub sun: Option<GearInput>,
    /// Planet.
    pub planet: GearInput,
    /// Ring, if the scene has one.
    pub ring: Option<GearInput>,
    /// Carrier, if its shape is given; rigid otherwise.
    pub carrier: Option<CarrierInput>,
    /// Where the tooth thicknesses come from.
    pub thickness: ThicknessInput,
}

/// The carrier as an annulus with round pin seats at the planets' centres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CarrierInput {
    /// Radius of the bore, which is its race, m.
    pub bore_radius_m: f64,
    /// Outer radius, m.
    pub outer_radius_m: f64,
    /// Radius of the rigid, material-filled pin seats, m.
    pub pin_seat_radius_m: f64,
    /// Whether it is taken as rigid between bore and seats.
    pub is_rigid: bool,
}

/// Generating rack.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rack {
    /// Module m, m.
    pub module_m: f64,
    /// Pressure angle of the rack, rad.
    pub pressure_angle_rad: f64,
}

/// Circles and edges of one gear.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GearInput {
    /// Tip radius, m.
    pub tip_radius_m: f64,
    /// Root radius, m.
    pub root_radius_m: f64,
    /// Bore radius of an external gear, rim radius of the ring, m.
    pub body_radius_m: Option<f64>,
    /// Root fillet radius, m.
    pub fillet_radius_m: f64,
    /// Tip relief, if any.
    pub tip_relief: Option<TipRelief>,
}

/// Material taken off the flank near the tip; scene key `geometry.<gear>.tip_relief`.
///
/// The relief at a point is measured normal to the unrelieved flank, that is along the line of
/// action when the point is in contact. With s the roll length of the point, s₀ that at the start
/// and s_a that at the tip circle, it is amount · (s − s₀)/(s_a − s₀) with the shape `Linear`,
/// amount · ((s − s₀)/(s_a − s₀))² with `Parabolic`, and 0 between the root and the start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TipRelief {
    /// Radius where the relief starts, m; key `start_diameter_mm`.
    pub start_radius_m: f64,
    /// Amount at the tip circle, m; key `amount_um`.
    pub amount_m: f64,
    /// Growth from start to tip.
    pub shape: ReliefShape,
}

/// How tip relief grows with roll length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReliefShape {
    /// Proportional to the roll length past the start.
    Linear,
    /// Proportional to its square.
    Parabolic,
}

/// Where the tooth thicknesses come from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ThicknessInput {
    /// From circumferential backlash at the operating pitch circles.
    Backlash {
        /// Sun–planet backlash, m.
        sun_planet_m: f64,
        /// Ring–planet backlash, m.
        ring_planet_m: f64,
        /// Planet's share of the sum of sun and planet thicknesses.
        planet_share: f64,
    },
    /// From profile shifts of the generating rack, each positive outwards: that of the ring widens its tooth spaces.
    ProfileShift {
        /// x_s.
        sun: f64,
        /// x_p.
        planet: f64,
        /// x_r.
        ring: f64,
        /// By how much teeth are thinner than the shifts say.
        #[serde(default)]
        thinning: Thinning,
    },
}

/// By how much the teeth of each gear are thinner than their profile shift says, m of arc on the reference circle; the
/// spaces of the ring are as much wider.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Thinning {
    /// Teeth of the sun.
    pub sun_m: f64,
    /// Teeth of the planet.
    pub planet_m: f64,
    /// Teeth of the ring.
    pub ring_m: f64,
}
