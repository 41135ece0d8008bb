//! Where one tooth pair may touch, and the gap between its flanks.
//!
//! Everything is taken in the mesh frame of [`Mesh`]: central gear at the origin, planet at (a, 0),
//! the central input turning counter-clockwise.

use std::sync::OnceLock;

use gearset::involute::{radius_at, roll_length_at};
use gearset::{Facing, Flank, Mesh, MeshKind, MeshMember, ToothSide};

use crate::fe_mesh::Side;

/// Where the point of contact lies with respect to the theoretical path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Location {
    /// On the path: flank on flank.
    Path,
    /// Beyond it: the tip corner of this member on the other's flank.
    Corner(MeshMember),
}

/// The line along which one pair presses, and the cells' frame on it.
#[derive(Debug, Clone)]
pub struct PairFrame<'m> {
    /// Pair k stands k base pitches on from pair 0.
    pub index: i64,
    /// On the path or at a corner.
    pub location: Location,
    /// Reference point, m.
    pub origin: [f64; 2],
    /// Unit normal from the driver's material to the driven gear's: direction of the force on the
    /// driven gear.
    pub normal: [f64; 2],
    /// Gap at the reference point along `normal`, unloaded, m.
    pub gap: f64,
    driver: Flank<'m>,
    driven: Flank<'m>,
    /// Tangential coordinate of the least gap, once it was asked for, m.
    least_gap_at: OnceLock<f64>,
}

/// One flank in its own tooth's frame.
#[derive(Debug, Clone, Copy)]
pub struct ToothFrame {
    /// Centre of the gear, m.
    pub centre: [f64; 2],
    /// Angle of the tooth's axis, rad.
    pub axis: f64,
    /// Which flank of the tooth.
    pub side: Side,
}

impl<'m> PairFrame<'m> {
    /// Pair `index` of a mesh at `phase` (cycles); `None` where a corner cannot reach the mating
    /// involute.
    ///
    /// Beyond the path the force follows the normal of the flank the corner presses on.
    pub fn new(mesh: &'m Mesh, phase: f64, index: i64) -> Option<Self> {
        let roll_length = mesh.path_start + (phase + index as f64) * mesh.base_pitch;
        let (driver, driven) = mesh.flanks(roll_length);
        let on_driver = |flank: &Flank<'_>, angle: f64| outward(flank, angle);
        let at = |location, origin, normal, gap| {
            let least_gap_at = OnceLock::new();
            Some(Self { index, location, origin, normal, gap, driver, driven, least_gap_at })
        };
        if roll_length < mesh.path_start {
            let tip = driven.point(driven.gear.tip_roll_length());
            let (angle, gap) = foot(&driver, tip)?;
            at(Location::Corner(MeshMember::Driven), tip, on_driver(&driver, angle), gap)
        } else if roll_length > mesh.path_end {
            let tip = driver.point(driver.gear.tip_roll_length());
            let (angle, gap) = foot(&driven, tip)?;
            let [x, y] = outward(&driven, angle);
            at(Location::Corner(MeshMember::Driver), tip, [-x, -y], gap)
        } else {
            let angle =
                driver.origin_angle - driver.facing.sign() * roll_length / driver.gear.base_radius;
            at(Location::Path, driver.point(roll_length), outward(&driver, angle), 0.0)
        }
        .map(|mut pair: Self| {
            pair.gap += pair.relief_at_origin();
            pair
        })
    }

    /// Pair `index` of gears that overlap by `approach` (m): each gear is turned by half of it
    /// towards the other from the position at `phase` (cycles) where the flanks just touch. Path or
    /// corner, normal, arms and gap are those of the turned gears; the position of a corner is that
    /// on its own gear.
    pub(crate) fn pressed(mesh: &'m Mesh, phase: f64, approach: f64, index: i64) -> Option<Self> {
        let half = 0.5 * approach / mesh.base_pitch;
        let ends = [(MeshMember::Driver, half), (MeshMember::Driven, -half)];
        for (member, turned) in ends {
            match Self::new(mesh, phase + turned, index) {
                Some(frame) if frame.location == Location::Corner(member) => return Some(frame),
                _ => {}
            }
        }
        // Neither tip corner is beyond its end of the path.
        Self::new(mesh, phase, index).map(|frame| match frame.location {
            Location::Path => frame,
            Location::Corner(_) => Self { gap: frame.relief_at_origin(), ..frame },
        })
    }

    /// ∂²G/∂e² of a corner's gap G, where e is the distance of the corner beyond its end of the
    /// path, 1/m; 0 on the path.
    pub(crate) fn curvature(&self, mesh: &'m Mesh, phase: f64, approach: f64) -> f64 {
        const STEP: f64 = 2e-6;
        let Location::Corner(member) = self.location else { return 0.0 };
        let half = 0.5 * approach;
        let own = if member == MeshMember::Driver { half } else { -half };
        let gap = |step: f64| {
            let at = Self::new(mesh, phase + (own + step) / mesh.base_pitch, self.index)?;
            Some(at.rigid_gap())
        };
        match (gap(STEP), gap(0.0), gap(-STEP)) {
            (Some(on), Some(here), Some(back)) => (on - 2.0 * here + back) / (STEP * STEP),
            _ => 0.0,
        }
    }

    /// Gap at the reference point without tip relief, m.
    pub(crate) fn rigid_gap(&self) -> f64 {
        self.gap - self.relief_at_origin()
    }

    /// Gap that tip relief adds at the pair's reference point, m.
    pub(crate) fn relief_at_origin(&self) -> f64 {
        let roll_length = |flank: &Flank<'_>| {
            let [x, y] = [self.origin[0] - flank.centre[0], self.origin[1] - flank.centre[1]];
            roll_length_at(flank.gear.base_radius, x.hypot(y))
        };
        self.driver.gear.relief_at(roll_length(&self.driver))
            + self.driven.gear.relief_at(roll_length(&self.driven))
    }

    /// Tangent: the normal turned counter-clockwise by 90°.
    pub fn tangent(&self) -> [f64; 2] {
        [-self.normal[1], self.normal[0]]
    }

    /// Approach of the pair for unit displacements of driver (x, y, θ) and driven (x, y, θ) about
    /// their centres, mesh frame; m, m, m/rad.
    pub fn approach_row(&self) -> [f64; 6] {
        let n = self.normal;
        let arm = |centre: [f64; 2]| {
            (self.origin[0] - centre[0]) * n[1] - (self.origin[1] - centre[1]) * n[0]
        };
        let (a, b) = (arm(self.driver.centre), arm(self.driven.centre));
        [n[0], n[1], a, -n[0], -n[1], -b]
    }

    /// The tooth of one member, and which of its flanks it is.
    pub fn tooth(&self, member: MeshMember) -> ToothFrame {
        let flank = self.flank(member);
        let (gear, sign) = (flank.gear, flank.facing.sign());
        let lobe = flank.origin_angle - sign * gear.half_angle_base;
        let ccw = flank.facing == Facing::CounterClockwise;
        let (axis, is_ccw) = match gear.side {
            ToothSide::External => (lobe, ccw),
            // The flank of a tooth space is the opposite flank of the tooth beside it, whose axis
            // is half a pitch from that of the space.
            ToothSide::Internal => (lobe + sign * 0.5 * gear.pitch_angle(), !ccw),
        };
        ToothFrame { centre: flank.centre, axis, side: if is_ccw { Side::Ccw } else { Side::Cw } }
    }

    fn flank(&self, member: MeshMember) -> &Flank<'m> {
        match member {
            MeshMember::Driver => &self.driver,
            MeshMember::Driven => &self.driven,
        }
    }

    /// Tangential coordinate of a point of the mesh frame.
    fn across(&self, p: [f64; 2]) -> f64 {
        let t = self.tangent();
        (p[0] - self.origin[0]) * t[0] + (p[1] - self.origin[1]) * t[1]
    }

    /// Tangential range in which both flanks exist, form circle to tip.
    pub fn extent(&self) -> [f64; 2] {
        let of = |flank: &Flank<'_>| {
            let ends = [flank.gear.form_roll_length().unwrap_or(0.0), flank.gear.tip_roll_length()]
                .map(|s| self.across(flank.point(s)));
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        };
        let (a, b) = (of(&self.driver), of(&self.driven));
        [a[0].max(b[0]), a[1].min(b[1])]
    }

    /// Relative radius of curvature R at the reference point, 1/R = 1/ρ₁ ± 1/ρ₂ with the roll
    /// lengths there as ρ, or at the base circle those over which a contact patch spreads, m.
    pub fn radius(&self) -> f64 {
        let curvature = |flank: &Flank<'_>| {
            let [x, y] = [self.origin[0] - flank.centre[0], self.origin[1] - flank.centre[1]];
            let s = roll_length_at(flank.gear.base_radius, x.hypot(y));
            let sign = if flank.gear.side == ToothSide::External { 1.0 } else { -1.0 };
            sign / s.max(LEAST_CURVATURE * flank.gear.base_radius)
        };
        1.0 / (curvature(&self.driver) + curvature(&self.driven))
    }

    /// Roll length of one flank where its tangential coordinate is `x`.
    pub fn roll_length_at(&self, member: MeshMember, x: f64) -> f64 {
        let flank = self.flank(member);
        let [ox, oy] = [self.origin[0] - flank.centre[0], self.origin[1] - flank.centre[1]];
        let r_b = flank.gear.base_radius;
        let t = self.tangent();
        let mut s = roll_length_at(r_b, ox.hypot(oy));
        if s < NEAR_BASE * r_b {
            // Where dP/ds vanishes Newton's method finds nothing; to first order (s² − s₀²)/(2 r_b) e·t = x.
            let (p, e) = flank.point_and_radial(s);
            let along = e[0] * t[0] + e[1] * t[1];
            s = (s * s + 2.0 * r_b * (x - self.across(p)) / along).max(0.0).sqrt();
        }
        let mut last = f64::INFINITY;
        for _ in 0..20 {
            let (p, e) = flank.point_and_radial(s);
            // dP/ds = (s/r_b) e
            let slope = s / r_b * (e[0] * t[0] + e[1] * t[1]);
            let step = (self.across(p) - x) / slope;
            if !step.is_finite() {
                break;
            }
            s = (s - step).max(0.1 * s);
            // Steps that small are of rounding once they no longer shrink: a step of Newton's method squares the error.
            if step.abs() < 1e-15 || (step.abs() < ROUNDED && step.abs() > 0.25 * last) {
                break;
            }
            last = step.abs();
        }
        s
    }

    /// Point of one flank at tangential coordinate `x`, mesh frame, m, with its roll length.
    pub fn flank_point(&self, member: MeshMember, x: f64) -> ([f64; 2], f64) {
        let s = self.roll_length_at(member, x);
        (self.flank(member).point(s), s)
    }

    /// Points of both flanks at tangential coordinate `x`, driver first: see [`Self::flank_point`].
    pub(crate) fn flank_points(&self, x: f64) -> [([f64; 2], f64); 2] {
        [MeshMember::Driver, MeshMember::Driven].map(|member| self.flank_point(member, x))
    }

    /// Gap at tangential coordinate `x` along the normal, tip relief included, m.
    pub fn gap_at(&self, x: f64) -> f64 {
        self.gap_between(&self.flank_points(x))
    }

    /// Gap along the normal between points of both flanks, tip relief included, m.
    pub(crate) fn gap_between(&self, [(p, s), (q, u)]: &[([f64; 2], f64); 2]) -> f64 {
        let n = self.normal;
        (q[0] - p[0]) * n[0]
            + (q[1] - p[1]) * n[1]
            + self.driver.gear.relief_at(*s)
            + self.driven.gear.relief_at(*u)
    }
}

impl PairFrame<'_> {
    /// Whether either flank has tip relief.
    fn is_relieved(&self) -> bool {
        let has = |flank: &Flank<'_>| flank.gear.tip_relief.is_some_and(|r| r.amount_m > 0.0);
        has(&self.driver) || has(&self.driven)
    }

    /// Tangential coordinate of the least gap between the unloaded flanks, m.
    ///
    /// Without tip relief it is 0, the reference point. With relief the gap about the reference
    /// point is
    ///
    /// ```text
    /// g(x) = g₀ + x²/(2R) + relief(x),   least where x/R + relief′(x) = 0
    /// ```
    ///
    /// that is x = −R g′ where the relief has the slope g′, and the start of relief itself where the
    /// slope of g changes its sign there. g is convex, so that its slope changes sign once between the ends
    /// of the flanks.
    pub fn least_gap_at(&self) -> f64 {
        *self.least_gap_at.get_or_init(|| {
            let [low, high] = self.extent();
            if !self.is_relieved() || high <= low {
                return 0.0;
            }
            let rises = |x: f64| self.gap_slope_at(x) > 0.0;
            let start = 0.0f64.clamp(low, high);
            match rises(start) {
                true => outwards(start, low, |x| !rises(x)).unwrap_or(low),
                false => outwards(start, high, rises).unwrap_or(high),
            }
        })
    }

    /// Derivative of the gap with respect to the tangential coordinate x, m/m. With the tangent t and, on either flank,
    /// the radial direction e and the roll length s,
    ///
    /// ```text
    /// g = (q − p)·n + Σ relief,   dp/ds = (s/r_b) e,   d(p·n)/dx = (e·n)/(e·t),   ds/dx = r_b/(s e·t)
    /// ```
    fn gap_slope_at(&self, x: f64) -> f64 {
        let (n, t) = (self.normal, self.tangent());
        let of = |member: MeshMember, sign: f64| {
            let (flank, s) = (self.flank(member), self.roll_length_at(member, x));
            let (_, e) = flank.point_and_radial(s);
            let [on_n, on_t] = [n, t].map(|d| e[0] * d[0] + e[1] * d[1]);
            let [_, relief] = flank.gear.relief_and_slope_at(s);
            // Relief begins above the base circle, where s > 0.
            let relief = if relief == 0.0 { 0.0 } else { relief * flank.gear.base_radius / s };
            (sign * on_n + relief) / on_t
        };
        of(MeshMember::Driver, -1.0) + of(MeshMember::Driven, 1.0)
    }

    /// Least gap between the unloaded flanks along the normal, tip relief included, m.
    pub(crate) fn least_gap(&self) -> f64 {
        if self.is_relieved() { self.gap_at(self.least_gap_at()) } else { self.gap }
    }

    /// Ends of the grid of contact cells (tangential coordinates, m), and whether the grid ends there
    /// because a flank does.
    ///
    /// Without tip relief the grid is `reach` (m) long to either side of the reference point, where
    /// the gap has grown by reach²/(2R). With relief it holds all points at which the gap is at most
    /// that much larger than the least gap. Since tip relief makes the gap more curved, never less,
    /// a load has a shorter patch on relieved flanks than on unrelieved ones, and this grid holds it on
    /// either side of the start of relief.
    pub(crate) fn grid(&self, reach: f64) -> ([f64; 2], [bool; 2]) {
        let [low, high] = self.extent();
        if !self.is_relieved() {
            let ends_at_tip = [low > -reach, high < reach];
            return ([low.max(-reach), high.min(reach)], ends_at_tip);
        }
        let centre = self.least_gap_at();
        // g(x) − g_least = reach²/(2R)
        let most = self.gap_at(centre) + 0.5 * reach * reach / self.radius();
        let is_beyond = |x: f64| self.gap_at(x) > most;
        let ends = [low, high].map(|end| (end, outwards(centre, end, is_beyond)));
        (ends.map(|(end, grown)| grown.unwrap_or(end)), ends.map(|(_, grown)| grown.is_none()))
    }

    /// How much graded cells crowd at either end of a grid of this `reach` (m): not where the flanks continue, and
    /// where a flank ends
    ///
    /// ```text
    /// c = 1 − (g_end − g_least)/(reach²/(2R))
    /// ```
    ///
    /// 0 if the grid just reaches that end, 1 if the gap is least there: in corner contact.
    pub(super) fn crowding(&self, reach: f64, ends: [f64; 2], ends_at_tip: [bool; 2]) -> [f64; 2] {
        let most = 0.5 * reach * reach / self.radius();
        [0, 1].map(|i| match ends_at_tip[i] {
            true => (1.0 - (self.gap_at(ends[i]) - self.least_gap()) / most).clamp(0.0, 1.0),
            false => 0.0,
        })
    }
}

/// Steps of a roll length that may be of rounding, m: a millionth of the width of a contact cell.
const ROUNDED: f64 = 1e-11;

/// Least roll length over base radius that stands for the radius of curvature: a patch that begins at the base circle
/// reaches to about (16 F r_b²/πbE*)^⅓, some hundredths of r_b, where flanks are as flat as that.
const LEAST_CURVATURE: f64 = 0.03;

/// Roll length over base radius below which a flank is so near to the start of its involute that its tangential
/// coordinate is no longer nearly linear in the roll length.
const NEAR_BASE: f64 = 0.01;

/// A least gap is this far below the gap without relief only where it was not found, m.
const LOST: f64 = 1e-9;

/// Width of the interval at which a search along a flank ends, m: rounding of coordinates of the order of 0.1 m.
const FOUND: f64 = 1e-16;

/// First step of a search along a flank, m: a tenth of the width of a contact cell.
const FIRST_STEP: f64 = 1e-6;

/// Place at which a statement begins to hold on the way from `start` to `end`; `None` if it holds
/// nowhere on the way. The steps grow twofold, so that the flank's far end, which may lie on the base
/// circle where an involute has no curvature, is looked at last.
fn outwards(start: f64, end: f64, holds: impl Fn(f64) -> bool) -> Option<f64> {
    let (length, sense) = ((end - start).abs(), (end - start).signum());
    let (mut near, mut far) = (0.0, FIRST_STEP.min(length));
    while !holds(start + sense * far) {
        if far >= length {
            return None;
        }
        (near, far) = (far, (2.0 * far).min(length));
    }
    // Halved until nothing but rounding is left.
    while far - near > FOUND.max(f64::EPSILON * far) {
        let middle = 0.5 * (near + far);
        match holds(start + sense * middle) {
            true => far = middle,
            false => near = middle,
        }
    }
    Some(start + sense * 0.5 * (near + far))
}

/// Outward normal of a flank's material where its base tangent leaves the base circle at `angle`.
fn outward(flank: &Flank<'_>, angle: f64) -> [f64; 2] {
    // The base tangent points out of the lobe; the lobe of a ring is its tooth space.
    let mut sign = flank.facing.sign();
    if flank.gear.side == ToothSide::Internal {
        sign = -sign;
    }
    [-sign * angle.sin(), sign * angle.cos()]
}

/// Angle where the base tangent through `point` leaves the flank's base circle, and the gap from flank to
/// point along it.
fn foot(flank: &Flank<'_>, point: [f64; 2]) -> Option<(f64, f64)> {
    let gap = flank.gap_to(point)?;
    let [x, y] = [point[0] - flank.centre[0], point[1] - flank.centre[1]];
    let r_b = flank.gear.base_radius;
    let r = x.hypot(y);
    let alpha = (roll_length_at(r_b, r) / r_b).atan();
    debug_assert!((radius_at(r_b, r_b * alpha.tan()) - r).abs() < 1e-9);
    // The point is at the angle α from the tangent point, in the sense of the flank's facing.
    Some((y.atan2(x) - flank.facing.sign() * alpha, gap))
}

/// Pairs that may touch: all whose least gap is at most `window` (m) at this phase (cycles).
pub fn candidates(mesh: &Mesh, phase: f64, window: f64) -> Vec<PairFrame<'_>> {
    // A pair more than two base pitches off the path is out of reach of any deflection.
    let last = mesh.contact_ratio.ceil() as i64 + 2;
    (-2..=last)
        .filter_map(|k| PairFrame::new(mesh, phase, k))
        .filter(|pair| pair.gap >= -1e-9 && pair.least_gap() <= window)
        .filter(|pair| {
            let [low, high] = pair.extent();
            high > low
        })
        // Relief only adds to a gap. A lesser one is of flanks so far apart that their points were not found.
        .filter(|pair| pair.least_gap() >= pair.rigid_gap() - LOST)
        .collect()
}

/// Which gears a mesh joins, driver first.
pub fn members(kind: MeshKind) -> [&'static str; 2] {
    match kind {
        MeshKind::SunPlanet => ["sun", "planet"],
        MeshKind::RingPlanet => ["planet", "ring"],
    }
}
