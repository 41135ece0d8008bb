//! Tip relief: contact lies where the gap of the relieved flanks is least.
//!
//! What is compared: places and amounts with closed forms (the vertex of the relieved gap, Hertz's pressure); static
//! transmission errors and shares of load, from 60 to 6,000 N, with the same contact problem laid out in another way
//! (grids of unrelieved flanks, longer, with gaps to which relief is added from its definition), to 0.5 %. The
//! flexibility of the FE bodies is the same on both sides; `resolved_pair` holds relieved teeth to a calculation
//! without this program's bodies, contact and relief.

use std::sync::OnceLock;

use fe_contact::complementarity::ActiveSet;
use fe_contact::contact::hertz::{self, Hertz};
use fe_contact::contact::{CellSettings, MeshTable, PairFrame};
use fe_contact::statics::{Bodies, Imperfections, StaticSet, at_phase, pair_cycle, press};
use fe_contact::vibration::{
    Loading, MeshLawSet, MeshLawSettings, NominalRotation, VibratingSet, mesh_law,
};
use gearset::{Facing, Gear, MeshKind, MeshMember, PathDirection, ReliefShape, TipRelief};
use scene::{Fidelity, Scene};

const KIND: MeshKind = MeshKind::SunPlanet;

/// Two equal gears of 50 teeth: module 3 mm, 20°, face 20 mm, addendum 1.0 and dedendum 1.25 modules.
const EQUAL_GEARS: &str = r#"
format = 1
kind = "gear_pair"
mesh = "sun_planet"
title = "Two equal gears"
source = "a standard rack"

[teeth]
sun = 50
planet = 50

[geometry]
center_distance_mm = 150.0
face_width_mm = 20.0
rack = { module_mm = 3.0, pressure_angle_deg = 20.0 }

[geometry.sun]
tip_diameter_mm = 156.0
root_diameter_mm = 142.5
bore_diameter_mm = 120.0
fillet_radius_mm = 0.9

[geometry.planet]
tip_diameter_mm = 156.0
root_diameter_mm = 142.5
bore_diameter_mm = 120.0
fillet_radius_mm = 0.9

[geometry.thickness]
sun_planet_backlash_mm = 0.1
planet_share = 0.5

[material]
young_modulus_pa = 207e9
poisson_ratio = 0.3
density_kg_per_m3 = 7800

[fe_contact]
flank_elements = 8
"#;

fn equal_gears() -> Scene {
    Scene::from_toml(EQUAL_GEARS).unwrap()
}

/// The bodies without relief, meshed once; the FE mesh does not know of relief.
fn plain() -> &'static Bodies {
    static MADE: OnceLock<Bodies> = OnceLock::new();
    MADE.get_or_init(|| Bodies::new(&equal_gears()).unwrap())
}

fn relief(start_diameter_mm: f64, amount_um: f64, shape: ReliefShape) -> TipRelief {
    TipRelief { start_radius_m: 0.5e-3 * start_diameter_mm, amount_m: 1e-6 * amount_um, shape }
}

/// The same bodies with relief on driver and driven gear.
fn relieved(of: [Option<TipRelief>; 2]) -> Bodies {
    let mut scene = equal_gears();
    let geometry = scene.geometry.as_mut().unwrap();
    geometry.sun.as_mut().unwrap().tip_relief = of[0];
    geometry.planet.tip_relief = of[1];
    Bodies { geometry: scene.tooth_geometry().unwrap(), ..plain().clone() }
}

/// Relief at a roll length from its definition: 0 at the start, the amount at the tip.
fn removed(gear: &Gear, relief: Option<TipRelief>, roll_length: f64) -> f64 {
    let Some(relief) = relief else { return 0.0 };
    let at = |r: f64| (r * r - gear.base_radius * gear.base_radius).sqrt();
    let (start, tip) = (at(relief.start_radius_m), at(gear.tip_radius));
    let share = ((roll_length - start) / (tip - start)).max(0.0);
    match relief.shape {
        ReliefShape::Linear => relief.amount_m * share,
        ReliefShape::Parabolic => relief.amount_m * share * share,
    }
}

/// δ (m) and the force of every loaded pair (N) from the grids of the unrelieved flanks, four times
/// as long with cells of the same width, whose gaps the relief is added to.
fn on_wide_grids(
    plain: &Bodies,
    kind: MeshKind,
    of: [Option<TipRelief>; 2],
    force: f64,
    phase: f64,
) -> (f64, Vec<(i64, f64)>) {
    let (mesh, pair) = plain.joined(kind).unwrap();
    let mut settings = plain.cells(16.0 * force);
    settings.cells *= 4;
    settings.window = plain.cells(force).window + 60e-6;
    let mut table = MeshTable::new(mesh, pair, phase, &settings).unwrap();
    for cells in &table.pairs {
        let frame = PairFrame::new(mesh, phase, cells.index).unwrap();
        for (i, x) in cells.x.iter().enumerate() {
            for (member, own) in [MeshMember::Driver, MeshMember::Driven].into_iter().zip(of) {
                let (_, roll_length) = frame.flank_point(member, *x);
                table.gaps[cells.first + i] += removed(mesh.gear(member), own, roll_length);
            }
        }
    }
    let (deflection, answer) = press(&table, mesh, force, &ActiveSet).unwrap();
    let pairs = table.pairs.iter().zip(answer.pair_forces);
    (deflection, pairs.filter(|p| p.1 > 0.0).map(|(cells, p)| (cells.index, p)).collect())
}

/// Relieved flanks on their own grids, and unrelieved ones whose gaps the relief is added to on grids four
/// times as long, deflect alike. Both have cells of the same width in different places: 0.5 % is what
/// results may depend on the cells.
#[test]
fn relief_on_its_own_grid_is_relief_added_to_a_wide_grid() {
    use ReliefShape::{Linear, Parabolic};
    let third = |amount| Some(relief(151.5, amount, Linear));
    let deep = |amount| Some(relief(147.0, amount, Linear));
    let cases = [
        ([third(20.0), third(20.0)], 6000.0),
        ([deep(20.0), deep(20.0)], 6000.0),
        ([deep(20.0), None], 6000.0),
        ([None, third(20.0)], 3000.0),
        ([third(13.0), third(13.0)], 200.0),
        ([deep(13.0), deep(13.0)], 200.0),
        ([Some(relief(151.5, 40.0, Parabolic)), deep(30.0)], 2000.0),
        ([third(60.0), third(60.0)], 1000.0),
    ];
    let apart = |(of, force)| cycle_off_wide_grids(plain(), &relieved(of), KIND, of, force);
    println!("largest difference of δ: {:e}", cases.map(apart).into_iter().fold(0.0, f64::max));
}

/// Largest difference of δ over a mesh cycle between relieved flanks on their own grids and on wide ones; it and
/// the differences of the pairs' forces are at most 0.5 %.
fn cycle_off_wide_grids(
    plain: &Bodies,
    relieved: &Bodies,
    kind: MeshKind,
    of: [Option<TipRelief>; 2],
    force: f64,
) -> f64 {
    let at = |i: u32| {
        let phase = f64::from(i) / 12.0;
        let found = at_phase(relieved, kind, force, phase, &ActiveSet);
        let found = found.unwrap_or_else(|e| panic!("{of:?} {force} {phase}: {e}"));
        let (deflection, pairs) = on_wide_grids(plain, kind, of, force, phase);
        let off = (found.deflection / deflection - 1.0).abs();
        assert!(off < 5e-3, "{of:?} {force} N at {phase}: {off:e}");
        for (index, expected) in pairs {
            let own = found.pairs.iter().find(|p| p.index == index).map_or(0.0, |p| p.force);
            let off = (own - expected).abs() / force;
            assert!(off < 5e-3, "{of:?} {force} N at {phase}, pair {index}: {off:e}");
        }
        off
    };
    (0..12).map(at).fold(0.0, f64::max)
}

/// The same of an internal mesh: the planet of OH-58 in its ring, with relief on either and on both.
#[test]
fn relief_of_a_ring_pair_on_its_own_grid_is_relief_added_to_a_wide_grid() {
    let kind = MeshKind::RingPlanet;
    let path = format!("{}/../scenes/oh58_ring_planet_pair.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    scene.fe_contact.flank_elements = 8;
    let plain = Bodies::new(&scene).unwrap();
    let of_planet = |amount| Some(relief(102.0, amount, ReliefShape::Linear));
    // The ring's tip circle is its smallest.
    let of_ring = |amount| Some(relief(275.0, amount, ReliefShape::Linear));
    let cases = [
        ([of_planet(20.0), of_ring(20.0)], 8000.0),
        ([of_planet(20.0), None], 8000.0),
        ([None, of_ring(20.0)], 2000.0),
        ([of_planet(13.0), of_ring(13.0)], 300.0),
    ];
    for (of, force) in cases {
        let mut scene = scene.clone();
        let geometry = scene.geometry.as_mut().unwrap();
        geometry.planet.tip_relief = of[0];
        geometry.ring.as_mut().unwrap().tip_relief = of[1];
        let relieved = Bodies { geometry: scene.tooth_geometry().unwrap(), ..plain.clone() };
        let off = cycle_off_wide_grids(&plain, &relieved, kind, of, force);
        // Relief is no small matter: somewhere in the cycle δ is another without it.
        let changed = (0..12).map(|i| {
            let of = |bodies: &Bodies| {
                at_phase(bodies, kind, force, f64::from(i) / 12.0, &ActiveSet).unwrap().deflection
            };
            (of(&relieved) / of(&plain) - 1.0).abs()
        });
        let changed = changed.fold(0.0, f64::max);
        println!("{of:?}, {force} N: {off:e}; relief changes δ by up to {changed:e}");
        assert!(changed > 0.02, "{changed:e}");
    }
}

/// A sun and a planet of a set with addenda of 0.95 modules.
const SUN_28_PLANET_29: &str = r#"
format = 1
kind = "gear_pair"
mesh = "sun_planet"
title = "28/29"
source = "made for this test"

[teeth]
sun = 28
planet = 29

[geometry]
center_distance_mm = 57.0
face_width_mm = 14.33
rack = { module_mm = 2.0, pressure_angle_deg = 25.0 }

[geometry.sun]
tip_diameter_mm = 59.8
root_diameter_mm = 51.0
bore_diameter_mm = 33.5
fillet_radius_mm = 0.6

[geometry.planet]
tip_diameter_mm = 61.8
root_diameter_mm = 53.0
bore_diameter_mm = 35.5
fillet_radius_mm = 0.6

[geometry.thickness]
sun_planet_backlash_mm = 0.08
planet_share = 0.52

[material]
young_modulus_pa = 206e9
poisson_ratio = 0.3
density_kg_per_m3 = 7850
"#;

/// Pairs so far off the path that their flanks do not face each other are never taken for touching ones: with 1 µm of
/// relief a mesh gives way by at most 1 µm more than without, at every phase.
#[test]
fn a_micrometre_of_relief_brings_no_far_pair_into_contact() {
    let mut scene = Scene::from_toml(SUN_28_PLANET_29).unwrap();
    scene.fe_contact.flank_elements = 8;
    let plain = Bodies::new(&scene).unwrap();
    let planet = &mut scene.geometry.as_mut().unwrap().planet;
    planet.tip_relief = Some(relief(59.8, 1.0, ReliefShape::Linear));
    let relieved = Bodies { geometry: scene.tooth_geometry().unwrap(), ..plain.clone() };
    let deflections = |bodies: &Bodies| -> Vec<f64> {
        let cycle = pair_cycle(bodies, KIND, 2000.0, 100, &ActiveSet).unwrap();
        cycle.positions.iter().map(|p| p.deflection).collect()
    };
    for (own, without) in deflections(&relieved).iter().zip(deflections(&plain)) {
        let more = own - without;
        assert!((-1e-8..1e-6).contains(&more), "{more:e} of {without:e}");
    }
}

/// Largest distance of a loaded cell from the unrelieved flanks' contact point, over half the length of the grid that
/// they would have there, over a mesh cycle.
fn farthest_over_reach(bodies: &Bodies, force: f64) -> f64 {
    let (mesh, pair) = bodies.joined(KIND).unwrap();
    let at = |i: u32| {
        let phase = f64::from(i) / 24.0;
        let table = MeshTable::new(mesh, pair, phase, &bodies.cells(force)).unwrap();
        let (_, answer) = press(&table, mesh, force, &ActiveSet).unwrap();
        let of = |cells: &fe_contact::contact::PairCells| {
            let frame = PairFrame::new(mesh, phase, cells.index).unwrap();
            let hertz = Hertz::new(force / table.face_width, frame.radius(), &bodies.material);
            // One and a half half-widths of one pair alone under the whole force.
            let reach = 1.5 * hertz.half_width;
            let loaded = cells.x.iter().zip(&answer.cell_forces[cells.first..]);
            loaded.filter(|c| *c.1 > 0.0).map(|c| c.0.abs() / reach).fold(0.0, f64::max)
        };
        table.pairs.iter().map(of).fold(0.0, f64::max)
    };
    (0..24).map(at).fold(0.0, f64::max)
}

/// On grids about the contact point of the unrelieved flanks, relieved flanks touch beyond the end; unrelieved flanks
/// do not. Relief of the slope g′ moves contact by R g′, whatever the load, and the grid's length follows from the
/// load.
#[test]
fn relieved_flanks_touch_beyond_the_grid_of_unrelieved_ones() {
    let third = |amount| Some(relief(151.5, amount, ReliefShape::Linear));
    for (amount, force) in [(20.0, 6000.0), (13.0, 200.0)] {
        let [without, with] =
            [None, third(amount)].map(|own| farthest_over_reach(&relieved([own, own]), force));
        println!("{amount} µm, {force} N: {without:.2} and {with:.2} of the reach");
        assert!(without < 0.9, "{force} N: {without}");
        assert!(with > 1.0, "{amount} µm, {force} N: {with}");
    }
}

/// Every position of a mesh cycle can be computed, from light to heavy load.
#[test]
fn ordinary_relief_passes_through_the_whole_cycle() {
    for (start, amount) in [(151.5, 13.0), (151.5, 20.0), (147.0, 13.0), (147.0, 20.0)] {
        let own = Some(relief(start, amount, ReliefShape::Linear));
        for of in [[own, own], [own, None], [None, own]] {
            for force in [60.0, 600.0, 6000.0] {
                let cycle = pair_cycle(&relieved(of), KIND, force, 40, &ActiveSet);
                let cycle = cycle.unwrap_or_else(|e| panic!("{of:?} under {force} N: {e}"));
                assert!(cycle.positions.iter().all(|p| p.deflection.is_finite()));
            }
        }
    }
}

/// Where relief has the slope g′ the flanks touch like two cylinders displaced by R g′, with the gap
/// reduced by R g′²/2 (the vertex of the parabola x²/(2R) + g′x), and under a light load with Hertz's
/// pressure. Terms left out are of the order of the shift over the roll length (0.05 mm in 26 mm) and of
/// the curvature of relief over x (0.5 %): 2 % of the shift. A light load tilts the tooth by another 1 %.
#[test]
fn a_linear_relief_displaces_the_contact_of_cylinders() {
    let (roll_length, force) = (26e-3, 60.0);
    let own = relief(147.0, 20.0, ReliefShape::Linear);
    let bodies = relieved([Some(own), None]);
    let (mesh, pair) = bodies.joined(KIND).unwrap();
    let phase = (roll_length - mesh.path_start) / mesh.base_pitch;
    let frame = PairFrame::new(mesh, phase, 0).unwrap();
    let gear = mesh.gear(MeshMember::Driver);
    let at = |r: f64| (r * r - gear.base_radius * gear.base_radius).sqrt();
    // ds/dx = r_b/s: a flank is s long per radian of its roll angle s/r_b.
    let by_roll_length = own.amount_m / (at(gear.tip_radius) - at(own.start_radius_m));
    let slope = by_roll_length * gear.base_radius / roll_length;
    let towards_tip = (frame.roll_length_at(MeshMember::Driver, 1e-5) - roll_length).signum();
    let shift = -towards_tip * frame.radius() * slope;
    assert!((frame.least_gap_at() / shift - 1.0).abs() < 0.02, "{shift:e}");
    let reduced = frame.gap_at(0.0) - frame.gap_at(frame.least_gap_at());
    let expected = 0.5 * frame.radius() * slope * slope;
    assert!((reduced / expected - 1.0).abs() < 0.04, "{reduced:e} {expected:e}");
    // Wide enough for the pair on the path, whose relief is larger than the gap of the corner before it.
    let settings = CellSettings { window: 40e-6, ..bodies.cells(force) };
    let table = MeshTable::new(mesh, pair, phase, &settings).unwrap().only(0).unwrap();
    let (_, answer) = press(&table, mesh, force, &ActiveSet).unwrap();
    let carried: f64 = answer.cell_forces.iter().sum();
    let centre = table.pairs[0].x.iter().zip(&answer.cell_forces).map(|(x, p)| x * p).sum::<f64>();
    assert!((centre / carried / shift - 1.0).abs() < 0.03, "{} {shift:e}", centre / carried);
    let fitted = hertz::fit(&table.pairs[0].x, &table.pressures(0, &answer.cell_forces)).unwrap();
    let hertz = Hertz::new(force / table.face_width, frame.radius(), &bodies.material);
    // Cells an eighth of the half-width wide give the peak pressure within 1 %.
    assert!((fitted.peak_pressure / hertz.peak_pressure - 1.0).abs() < 0.01);
}

/// Without relief the grid is centred at the contact point of the involutes; relief that starts beyond
/// the ends of the grid moves nothing by more than the next term of the gap's series, x/s.
#[test]
fn without_relief_the_grid_is_centred_at_the_contact_point() {
    let (mesh, pair) = plain().joined(KIND).unwrap();
    let own = Some(relief(155.9, 20.0, ReliefShape::Linear));
    let late = relieved([own, own]);
    let (late_mesh, late_pair) = late.joined(KIND).unwrap();
    let settings = plain().cells(3000.0);
    let phase = 0.9;
    let one = MeshTable::new(mesh, pair, phase, &settings).unwrap();
    let other = MeshTable::new(late_mesh, late_pair, phase, &settings).unwrap();
    let path = |table: &MeshTable| table.pairs.iter().find(|p| p.index == 0).unwrap().clone();
    let (one, other) = (&path(&one), &path(&other));
    assert_eq!((one.centre, one.relief), (0.0, 0.0));
    assert!((one.x[0] + one.x[one.x.len() - 1]).abs() < 1e-12);
    assert_eq!(one.index, other.index);
    assert!(other.centre.abs() < 1e-9 && other.relief.abs() < 1e-12);
    assert!((other.length / one.length - 1.0).abs() < 0.03);
}

fn set_scene(amount_um: f64, fidelity: Fidelity) -> Scene {
    let path = format!("{}/../scenes/oh58_3p.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    scene.fe_contact.flank_elements = 8;
    scene.dynamics.fidelity = fidelity;
    let geometry = scene.geometry.as_mut().unwrap();
    let own = |start| Some(relief(start, amount_um, ReliefShape::Linear));
    geometry.sun.as_mut().unwrap().tip_relief = own(81.0);
    geometry.planet.tip_relief = own(102.0);
    geometry.ring.as_mut().unwrap().tip_relief = own(275.0);
    scene
}

/// A set with relief on all gears: linear kinematics about the loaded configuration and exact kinematics
/// agree, and the forces of its meshes are the gradient of their energy, at light and full torque.
#[test]
fn a_set_with_relief_on_all_gears_is_in_equilibrium() {
    let scene = set_scene(20.0, Fidelity::QuasiStatic);
    let bodies = Bodies::new(&scene).unwrap();
    let set = StaticSet::new(&scene, &bodies, Facing::CounterClockwise, Imperfections::default());
    let set = set.unwrap();
    let radius = bodies.geometry.sun.as_ref().unwrap().base_radius;
    for torque in [200.0, 1130.0] {
        let linear = set.cycle(torque, 6, &ActiveSet).unwrap();
        let about = set.clone().under(torque).unwrap();
        let exact = about.exact_cycle(torque, 6).unwrap();
        for (a, b) in linear.states.iter().zip(&exact.states) {
            let (a, b) = (a.transmission_error(radius), b.transmission_error(radius));
            assert!((a / b - 1.0).abs() < 5e-3, "{torque} N·m: {a:e} {b:e}");
        }
        let q = about.reference().q.clone();
        let (_, gradient) = about.mesh_potential(torque, 0.3, &q).unwrap();
        let along = gradient.normalize();
        let step = 2e-7;
        let energy =
            |sign: f64| about.mesh_potential(torque, 0.3, &(&q + sign * step * &along)).unwrap().0;
        let slope = (energy(1.0) - energy(-1.0)) / (2.0 * step);
        assert!((slope / gradient.norm() - 1.0).abs() < 5e-3, "{torque} N·m: {slope:e}");
    }
}

/// A turning set with relief on all gears runs at every fidelity that solves contact.
#[test]
fn a_turning_set_with_relief_keeps_its_patches_on_their_grids() {
    for fidelity in [Fidelity::QuasiStatic, Fidelity::Modal(2)] {
        let scene = set_scene(20.0, fidelity);
        let bodies = Bodies::new(&scene).unwrap();
        let torque_nm = 1130.0;
        let force = torque_nm / 3.0 / bodies.geometry.sun.as_ref().unwrap().base_radius;
        let rotation = NominalRotation::Turning {
            mesh_frequency: 300.0,
            steps_per_cycle: 28,
            direction: PathDirection::Forward,
        };
        let loading = Loading { torque_nm, mesh_force: 2.0 * force };
        let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
        let mut set = VibratingSet::new(&scene, &bodies, sense, none, rotation, loading).unwrap();
        set.rest(torque_nm).unwrap();
        for _ in 0..84 {
            set.step().unwrap_or_else(|e| panic!("{fidelity:?}: {e}"));
        }
    }
}

/// Largest difference of a harmonic (0 to 5) of the sun's rotation between mesh law and quasi-static fidelity, over the
/// largest harmonic from 1; harmonic 0 over itself.
fn law_off_contact(amount_um: f64) -> [f64; 2] {
    const STEPS: usize = 140;
    const MESH_FREQUENCY: f64 = 565.714;
    const TORQUE: f64 = 1413.0;
    let mut scene = set_scene(amount_um, Fidelity::QuasiStatic);
    if amount_um == 0.0 {
        let geometry = scene.geometry.as_mut().unwrap();
        geometry.planet.tip_relief = None;
        for gear in [&mut geometry.sun, &mut geometry.ring] {
            gear.as_mut().unwrap().tip_relief = None;
        }
    }
    let bodies = Bodies::new(&scene).unwrap();
    let sense = Facing::CounterClockwise;
    let law = mesh_law(&scene, &bodies, sense, STEPS, &MeshLawSettings::at(TORQUE)).unwrap();
    let mut fast = MeshLawSet::new(&scene, &bodies, sense, MESH_FREQUENCY, TORQUE, law).unwrap();
    fast.rest(TORQUE).unwrap();
    let mesh_force = TORQUE / 3.0 / bodies.geometry.sun.as_ref().unwrap().base_radius;
    let rotation = NominalRotation::Turning {
        mesh_frequency: MESH_FREQUENCY,
        steps_per_cycle: STEPS,
        direction: PathDirection::Forward,
    };
    let (none, loading) = (Imperfections::default(), Loading { torque_nm: TORQUE, mesh_force });
    let mut full = VibratingSet::new(&scene, &bodies, sense, none, rotation, loading).unwrap();
    full.rest(TORQUE).unwrap();
    let mut rotations = [Vec::new(), Vec::new()];
    for k in 0..60 * STEPS {
        fast.step().unwrap();
        full.step().unwrap();
        if k >= 59 * STEPS {
            rotations[0].push(fast.displacements().0[2][2]);
            rotations[1].push(full.displacements().0[2][2]);
        }
    }
    assert!(fast.is_within_tables());
    let harmonic = |list: &[f64], h: usize| {
        let turn = |i: usize| std::f64::consts::TAU * (h * i) as f64 / STEPS as f64;
        let sum = |of: fn(f64) -> f64| -> f64 {
            list.iter().enumerate().map(|(i, x)| x * of(turn(i))).sum()
        };
        [sum(f64::cos), sum(f64::sin)].map(|z| z * 2.0 / STEPS as f64)
    };
    let size = |z: [f64; 2]| z[0].hypot(z[1]);
    let apart = |h: usize| {
        let [a, b] = [0, 1].map(|which| harmonic(&rotations[which], h));
        size([a[0] - b[0], a[1] - b[1]])
    };
    let largest = (1..=5).map(|h| size(harmonic(&rotations[1], h))).fold(0.0, f64::max);
    let mean = size(harmonic(&rotations[1], 0));
    println!("{amount_um} µm: mean {mean:e} rad, largest harmonic {largest:e} rad");
    [apart(0) / mean, (1..=5).map(apart).fold(0.0, f64::max) / largest]
}

/// Tabulated mesh forces of relieved teeth are as near to solved contact as those of unrelieved ones, within the limits
/// that hold for the latter in `mesh_law.rs`.
#[test]
fn a_mesh_law_with_relief_is_as_near_to_contact_as_one_without() {
    for amount_um in [0.0, 20.0] {
        let [mean, harmonics] = law_off_contact(amount_um);
        println!("{amount_um} µm: {mean:e} of the mean, {harmonics:e} of the largest harmonic");
        assert!(mean < 2e-3 && harmonics < 0.15, "{amount_um} µm: {mean:e} {harmonics:e}");
    }
}
