//! Circles of gears that follow from the rack where a scene leaves them open: root, tip, root fillet, bore or rim.
//!
//! The rack gives root and tip. A tip is then lowered to what the mating gears allow: the bottom clearance of the rack,
//! a land of 0.2 modules, and the mate's involute. A fillet is made smaller where it does not fit into the tooth space,
//! or where the mating tip would touch it.

use crate::gear::{Gear, ToothSide};
use crate::geometry::Geometry;
use crate::geometry_input::{GearInput, GeometryInput, ThicknessInput};
use crate::mesh::{Mesh, NoMesh};
use crate::mesh_kind::{MeshKind, MeshMember};
use crate::teeth::Teeth;

/// Least thickness of a tooth at its tip circle, modules; the usual limit for hardened teeth.
const TIP_LAND: f64 = 0.2;
/// Least fillet that is chosen, modules.
const LEAST_FILLET: f64 = 0.1;
/// Thickness of the rim between root circle and bore or outer circle, modules.
const RIM: f64 = 3.5;
/// Least bore over the root circle.
const LEAST_BORE: f64 = 0.5;
/// Least roll angle at which a chosen tip touches an external tooth, rad: towards the base circle the involute's
/// radius of curvature vanishes and the pressure grows without bound.
const LEAST_ROLL_ANGLE: f64 = 0.05;
/// Room that is left where two circles would just touch, m: more than rounding, less than any tolerance.
const ROOM: f64 = 1e-9;

/// Heights of the rack from its datum line, in modules.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RackProfile {
    /// h_aP.
    pub addendum: f64,
    /// h_fP.
    pub dedendum: f64,
}

/// What of a gear's circles is left open.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct OpenCircles {
    /// Tip circle.
    pub tip: bool,
    /// Root circle.
    pub root: bool,
    /// Radius of the root fillet: the one given is the largest that is taken.
    pub fillet: bool,
    /// Bore of an external gear, rim of the ring.
    pub body: bool,
}

/// The gears of a set in the order sun, planet, ring.
const GEARS: [usize; 3] = [0, 1, 2];
const RING: usize = 2;

/// Fills what is open of sun, planet and ring for a rack of module m (m), and nothing else; the shifts are those of
/// `input.thickness`.
///
/// `[eq:rack-circles]` d_f = m (Z − 2 h_fP + 2x), d_a = m (Z + 2 h_aP + 2x), of the ring with the other signs of h_fP
/// and h_aP; bore d_f − 7 m, at least d_f/2, rim d_f + 7 m.
///
/// Source: closed form.
/// Checked by: `gearset/tests/rack_circles.rs::circles_are_those_of_a_printed_report`.
///
/// # Errors
/// If the base circles leave no operating pressure angle at the centre distance.
pub fn fill_circles(
    input: &mut GeometryInput,
    teeth: &Teeth,
    module: f64,
    profile: &RackProfile,
    open: &[OpenCircles; 3],
) -> Result<(), NoMesh> {
    let (m, a) = (module, input.center_distance_m);
    let (shifts, counts) = (shifts(input), [teeth.sun, Some(teeth.planet), teeth.ring]);
    for gear in GEARS {
        let (Some(circles), Some(count)) = (circles(input, gear), counts[gear]) else { continue };
        let middle = m * (0.5 * f64::from(count) + shifts[gear]);
        let outwards = if gear == RING { -m } else { m };
        if open[gear].root {
            circles.root_radius_m = middle - outwards * profile.dedendum;
        }
        if open[gear].tip {
            circles.tip_radius_m = middle + outwards * profile.addendum;
        }
        if open[gear].body {
            let root = circles.root_radius_m;
            let body = root - outwards * RIM;
            circles.body_radius_m =
                Some(if gear == RING { body } else { body.max(LEAST_BORE * root) });
        }
    }
    // Bottom clearance of the rack.
    let clearance = m * (profile.dedendum - profile.addendum);
    let root =
        |input: &GeometryInput, gear| given(input, gear).map(|circles| circles.root_radius_m);
    let [sun, planet, ring] = GEARS.map(|gear| root(input, gear));
    let highest = [
        planet.map(|root| a - root - clearance),
        sun.map(|root| a - root - clearance)
            .into_iter()
            .chain(ring.map(|root| root - a - clearance))
            .reduce(f64::min),
        planet.map(|root| a + root + clearance),
    ];
    for gear in GEARS {
        if let Some(limit) = highest[gear] {
            lower_tip(input, gear, open, limit, ROOM);
        }
    }
    let set = Geometry::new(input, teeth)?;
    for gear in GEARS {
        if open[gear].tip
            && let Some(shape) = of_set(&set, gear)
        {
            let land = |tip: f64| shape.tooth_thickness(tip) - TIP_LAND * m;
            if land(shape.tip_radius) < 0.0 && land(shape.root_radius) > 0.0 {
                let limit = border(shape.root_radius, shape.tip_radius, |tip| land(tip) >= 0.0);
                lower_tip(input, gear, open, limit, 0.0);
            }
        }
    }
    for gear in GEARS {
        if open[gear].fillet {
            fit_fillet(input, teeth, gear, LEAST_FILLET * m)?;
        }
    }
    let set = Geometry::new(input, teeth)?;
    for (kind, member, gear) in [
        (MeshKind::SunPlanet, MeshMember::Driver, 0),
        (MeshKind::SunPlanet, MeshMember::Driven, 1),
        (MeshKind::RingPlanet, MeshMember::Driver, 1),
        (MeshKind::RingPlanet, MeshMember::Driven, RING),
    ] {
        let limit = set.mesh(kind).and_then(|mesh| {
            let mate = mesh.mate(member);
            let form = mate.form_roll_length().unwrap_or(0.0);
            let least = match mate.side {
                ToothSide::External => form.max(LEAST_ROLL_ANGLE * mate.base_radius),
                ToothSide::Internal => form,
            };
            mesh.tip_radius_reaching(member, least)
        });
        if let Some(limit) = limit {
            lower_tip(
                input,
                gear,
                open,
                if gear == RING { limit + ROOM } else { limit - ROOM },
                0.0,
            );
        }
    }
    Ok(())
}

fn shifts(input: &GeometryInput) -> [f64; 3] {
    match input.thickness {
        ThicknessInput::ProfileShift { sun, planet, ring, .. } => [sun, planet, ring],
        ThicknessInput::Backlash { .. } => [0.0; 3],
    }
}

fn circles(input: &mut GeometryInput, gear: usize) -> Option<&mut GearInput> {
    match gear {
        0 => input.sun.as_mut(),
        1 => Some(&mut input.planet),
        _ => input.ring.as_mut(),
    }
}

fn given(input: &GeometryInput, gear: usize) -> Option<&GearInput> {
    match gear {
        0 => input.sun.as_ref(),
        1 => Some(&input.planet),
        _ => input.ring.as_ref(),
    }
}

fn of_set(set: &Geometry, gear: usize) -> Option<&Gear> {
    match gear {
        0 => set.sun.as_ref(),
        1 => Some(&set.planet),
        _ => set.ring.as_ref(),
    }
}

/// Takes an open tip back to a limit that it exceeds by more than `room`, seen from the root.
fn lower_tip(
    input: &mut GeometryInput,
    gear: usize,
    open: &[OpenCircles; 3],
    limit: f64,
    room: f64,
) {
    let Some(circles) = circles(input, gear).filter(|_| open[gear].tip) else { return };
    let beyond = circles.tip_radius_m - limit;
    if (if gear == RING { -beyond } else { beyond }) > room {
        circles.tip_radius_m = limit;
    }
}

/// Makes the fillet of a gear as large as it may be, from the radius that it has down to `least`: it fits into the
/// tooth space, leaves a flank, and no mating tip touches it more than one of radius `least`.
fn fit_fillet(
    input: &mut GeometryInput,
    teeth: &Teeth,
    gear: usize,
    least: f64,
) -> Result<(), NoMesh> {
    let Some(nominal) = given(input, gear).map(|circles| circles.fillet_radius_m) else {
        return Ok(());
    };
    let set = Geometry::new(input, teeth)?;
    let with = |radius: f64| {
        let mut shape = of_set(&set, gear)?.clone();
        shape.fillet_radius = radius;
        Some(shape)
    };
    let touch =
        |radius: f64| with(radius).map_or(f64::NAN, |shape| interference(&set, gear, shape));
    let is_fit = |radius: f64, most: f64| {
        with(radius).is_some_and(|shape| leaves_flank(&shape, gear)) && touch(radius) <= most
    };
    if nominal > least && !is_fit(nominal, touch(least).max(0.0)) {
        let fitting = border(least, nominal, |radius| is_fit(radius, touch(least).max(-ROOM)));
        if let Some(circles) = circles(input, gear) {
            circles.fillet_radius_m = fitting;
        }
    }
    Ok(())
}

/// Whether two fillets fit into a tooth space and leave a flank.
fn leaves_flank(shape: &Gear, gear: usize) -> bool {
    let form = shape.form_radius();
    let has_flank = if gear == RING {
        form > shape.tip_radius && shape.root_radius - shape.fillet_radius >= shape.base_radius
    } else {
        form < shape.tip_radius
    };
    has_flank && shape.root_land_angle() >= 0.0
}

/// Largest interference of a gear in its meshes, were it of this shape, m.
fn interference(set: &Geometry, gear: usize, shape: Gear) -> f64 {
    use MeshMember::{Driven, Driver};
    let a = set.center_distance;
    let (sun, planet, ring) = (set.sun.as_ref(), &set.planet, set.ring.as_ref());
    let in_sun_mesh = |sun: &Gear, planet: &Gear, member| {
        Mesh::sun_planet(sun, planet, a).map(|mesh| mesh.interference(member)).ok()
    };
    let in_ring_mesh = |ring: &Gear, planet: &Gear, member| {
        Mesh::ring_planet(ring, planet, a).map(|mesh| mesh.interference(member)).ok()
    };
    let found = match gear {
        0 => [in_sun_mesh(&shape, planet, Driver), None],
        1 => [
            sun.and_then(|sun| in_sun_mesh(sun, &shape, Driven)),
            ring.and_then(|ring| in_ring_mesh(ring, &shape, Driver)),
        ],
        _ => [in_ring_mesh(&shape, planet, Driven), None],
    };
    found.into_iter().flatten().fold(f64::NEG_INFINITY, f64::max)
}

/// The farthest value from `good` towards `bad` of which `holds` is true, by bisection; `good` where it never is.
fn border(good: f64, bad: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut good, mut bad) = (good, bad);
    for _ in 0..50 {
        let middle = 0.5 * (good + bad);
        if holds(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    good
}
