//! γ, the mesh phases and their signs, checked with rigid polygons: gears are placed from the phases alone,
//! and their gaps are measured between polylines, without use of phases or base pitch.

use std::path::Path;

use gearset::{Facing, Flank, Gear, Geometry, MeshKind, Phasing, PlanetPositions};
use scene::Scene;

fn oh58(name: &str) -> (Scene, Geometry) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
    let scene = Scene::from_file(&path).unwrap();
    let geometry = scene.tooth_geometry().unwrap();
    (scene, geometry)
}

type Point = [f64; 2];

/// A gear placed in the plane.
struct Placed<'g> {
    gear: &'g Gear,
    centre: Point,
    angle: f64,
}

impl<'g> Placed<'g> {
    /// Flanks of the five lobes nearest to a direction.
    fn flanks_near(&self, direction: f64, facing: Facing) -> Vec<Flank<'g>> {
        let lobe = ((direction - self.angle) / self.gear.pitch_angle()).round() as i64;
        (lobe - 2..=lobe + 2)
            .map(|i| Flank::of_lobe(self.gear, self.centre, self.angle, i, facing))
            .collect()
    }
}

/// Flank points from form circle to tip, the roll length between two limits.
fn polyline(flank: &Flank<'_>, low: f64, high: f64, count: usize) -> Vec<(f64, Point)> {
    (0..=count)
        .map(|i| low + (high - low) * i as f64 / count as f64)
        .map(|s| (s, flank.point(s)))
        .collect()
}

/// Distance from a point to the nearest segment of a polyline.
fn distance(point: Point, line: &[(f64, Point)]) -> (f64, f64) {
    let mut best = (f64::INFINITY, 0.0);
    for pair in line.windows(2) {
        let ((s0, p), (s1, q)) = (pair[0], pair[1]);
        let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
        let t = ((point[0] - p[0]) * dx + (point[1] - p[1]) * dy) / (dx * dx + dy * dy);
        let t = t.clamp(0.0, 1.0);
        let d = (point[0] - p[0] - t * dx).hypot(point[1] - p[1] - t * dy);
        if d < best.0 {
            best = (d, s0 + t * (s1 - s0));
        }
    }
    best
}

/// Smallest distance between two flanks: polylines refined about their closest points.
fn flank_distance(a: &Flank<'_>, b: &Flank<'_>) -> f64 {
    let limits = |f: &Flank<'_>| {
        let form = f.gear.form_roll_length().unwrap();
        let tip = f.gear.tip_roll_length();
        (form.min(tip), form.max(tip))
    };
    let ((mut a0, mut a1), (mut b0, mut b1)) = (limits(a), limits(b));
    let ((a_low, a_high), (b_low, b_high)) = (limits(a), limits(b));
    let mut best = f64::INFINITY;
    for _ in 0..7 {
        let (line_a, line_b) = (polyline(a, a0, a1, 40), polyline(b, b0, b1, 40));
        let mut at = (0.0, 0.0);
        best = f64::INFINITY;
        for &(s, p) in &line_a {
            let (d, t) = distance(p, &line_b);
            if d < best {
                (best, at) = (d, (s, t));
            }
        }
        let (wide_a, wide_b) = ((a1 - a0) / 10.0, (b1 - b0) / 10.0);
        (a0, a1) = ((at.0 - wide_a).max(a_low), (at.0 + wide_a).min(a_high));
        (b0, b1) = ((at.1 - wide_b).max(b_low), (at.1 + wide_b).min(b_high));
    }
    best
}

/// Smallest distance between the flanks of one facing, over the lobes near the line of centres.
fn mesh_gap(a: &Placed<'_>, b: &Placed<'_>, facing: Facing, towards: [f64; 2]) -> f64 {
    let (on_a, on_b) = (a.flanks_near(towards[0], facing), b.flanks_near(towards[1], facing));
    let mut best = f64::INFINITY;
    for fa in &on_a {
        for fb in &on_b {
            // Only flanks that could be mates: within 3 mm of each other, by coarse polylines.
            best = best.min(if screen(fa, fb) < 3e-3 { flank_distance(fa, fb) } else { best });
        }
    }
    best
}

fn screen(a: &Flank<'_>, b: &Flank<'_>) -> f64 {
    let line = polyline(b, b.gear.form_roll_length().unwrap(), b.gear.tip_roll_length(), 8);
    polyline(a, a.gear.form_roll_length().unwrap(), a.gear.tip_roll_length(), 8)
        .iter()
        .map(|&(_, p)| distance(p, &line).0)
        .fold(f64::INFINITY, f64::min)
}

/// Checks every mesh of a set at `count` positions over one sun pitch.
fn both_flanks_show_the_backlash(
    geometry: &Geometry,
    positions: &PlanetPositions,
    loaded: Facing,
    count: usize,
) -> f64 {
    let phasing = Phasing::new(geometry, positions).unwrap();
    let (sun, ring) = (geometry.sun.as_ref().unwrap(), geometry.ring.as_ref().unwrap());
    let a = geometry.center_distance;
    let mut worst = 0.0f64;
    for i in 0..count {
        let sun_angle = 0.123 + sun.pitch_angle() * i as f64 / count as f64;
        let angles = phasing.gear_angles(sun_angle, loaded);
        let sun = Placed { gear: sun, centre: [0.0, 0.0], angle: angles.sun };
        let ring = Placed { gear: ring, centre: [0.0, 0.0], angle: angles.ring };
        for (n, &psi) in positions.psi_rad.iter().enumerate() {
            let centre = [a * psi.cos(), a * psi.sin()];
            let planet = Placed { gear: &geometry.planet, centre, angle: angles.planets[n] };
            // The sun's loaded flank drives the planet, whose opposite flank drives the ring.
            let back = psi + std::f64::consts::PI;
            for (kind, other, facing, towards) in [
                (MeshKind::SunPlanet, &sun, loaded, [psi, back]),
                (MeshKind::RingPlanet, &ring, loaded.opposite(), [psi, psi]),
            ] {
                let touching = mesh_gap(other, &planet, facing, towards);
                let open = mesh_gap(other, &planet, facing.opposite(), towards);
                let backlash = geometry.normal_backlash(kind).unwrap();
                worst = worst.max(touching.abs()).max((open - backlash).abs());
            }
        }
    }
    worst
}

#[test]
fn set_backlash_shows_on_both_flanks_of_every_mesh() {
    let (scene, geometry) = oh58("oh58_4p.toml");
    let drive = Facing::CounterClockwise;
    let worst = both_flanks_show_the_backlash(&geometry, &scene.planets, drive, 100);
    println!("worst deviation from the set backlash: {worst:.2e} m");
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn mirrored_set_gives_the_mirrored_result() {
    let (scene, geometry) = oh58("oh58_4p.toml");
    let mirrored = PlanetPositions {
        psi_rad: scene.planets.psi_rad.iter().map(|psi| -psi).collect(),
        steps: scene.planets.steps.as_ref().map(|s| s.iter().map(|k| -k).collect()),
    };
    let phasing = Phasing::new(&geometry, &scene.planets).unwrap();
    let mirror = Phasing::new(&geometry, &mirrored).unwrap();
    for i in 0..20 {
        let theta = 0.01 * f64::from(i);
        let forward = phasing.phases(theta, Facing::CounterClockwise);
        let backward = mirror.phases(-theta, Facing::Clockwise);
        let sun = forward.sun_planet.iter().zip(&backward.sun_planet);
        let ring = forward.ring_planet.iter().zip(&backward.ring_planet);
        for (f, b) in sun.chain(ring) {
            assert!((f - b - (f - b).round()).abs() < 1e-13, "{f} {b}");
        }
    }
    for loaded in [Facing::CounterClockwise, Facing::Clockwise] {
        let worst = both_flanks_show_the_backlash(&geometry, &mirrored, loaded, 10);
        assert!(worst < 1e-9, "{worst:e}");
    }
}

#[test]
fn reversed_load_uses_the_other_flanks() {
    let (scene, geometry) = oh58("oh58_4p.toml");
    let worst = both_flanks_show_the_backlash(&geometry, &scene.planets, Facing::Clockwise, 10);
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn a_wrong_gamma_or_a_planet_off_its_step_does_not_pass() {
    let (scene, mut geometry) = oh58("oh58_4p.toml");
    // Literal −88.6° instead of −31 steps.
    let mut printed = scene.planets.clone();
    printed.steps = None;
    printed.psi_rad[1] = (-88.6f64).to_radians();
    let drive = Facing::CounterClockwise;
    let worst = both_flanks_show_the_backlash(&geometry, &printed, drive, 3);
    assert!(worst > 1e-5, "{worst:e}");
    // A planet 10 µm thicker than the thickness γ was worked out from.
    let right = Phasing::new(&geometry, &scene.planets).unwrap().gamma();
    geometry.planet.half_angle_base += 1e-5 / (2.0 * geometry.planet.base_radius);
    let wrong = Phasing::new(&geometry, &scene.planets).unwrap().gamma();
    assert!((right - wrong).abs() > 1e-4);
}

#[test]
fn phases_follow_their_closed_form_and_start_the_path() {
    let (scene, geometry) = oh58("oh58_4p.toml");
    let phasing = Phasing::new(&geometry, &scene.planets).unwrap();
    let gamma = phasing.gamma();
    let phases = phasing.phases(0.3, Facing::CounterClockwise);
    let near = |x: f64| (x - x.round()).abs();
    for (n, psi) in scene.planets.psi_rad.iter().enumerate() {
        // φ_sn = φ_s0 − Z_s ψ_n/2π and φ_rn = φ_r0 + Z_r ψ_n/2π, both modulo one cycle.
        let turn = psi / std::f64::consts::TAU;
        let sun = phases.sun_planet[n] - phases.sun_planet[0] + 27.0 * turn;
        let ring = phases.ring_planet[n] - phases.ring_planet[0] - 99.0 * turn;
        assert!(near(sun) < 1e-12 && near(ring) < 1e-12);
        assert!(near(phases.ring_planet[n] - phases.sun_planet[n] - gamma) < 1e-12);
    }
    // At phase 0 the driven tip corner touches the driver's flank: path start by polygons.
    let mesh = geometry.sun_planet.as_ref().unwrap();
    let (driver, driven) = mesh.flanks(mesh.path_start);
    let corner = driven.point(driven.gear.tip_roll_length());
    let line = polyline(&driver, mesh.path_start - 1e-5, mesh.path_start + 1e-5, 400);
    assert!(distance(corner, &line).0 < 1e-12);
}

#[test]
fn tip_gaps_are_distances_from_corner_to_polygon() {
    use gearset::MeshMember::{Driven, Driver};
    let (_, geometry) = oh58("oh58_4p.toml");
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let mesh = geometry.mesh(kind).unwrap();
        for (tip, roll_length) in [
            (Driven, mesh.path_start - 0.1 * mesh.base_pitch),
            (Driver, mesh.path_end + 0.1 * mesh.base_pitch),
        ] {
            let (driver, driven) = mesh.flanks(roll_length);
            let (own, mate) = if tip == Driver { (driver, driven) } else { (driven, driver) };
            let corner = own.point(own.gear.tip_roll_length());
            let form = mate.gear.form_roll_length().unwrap();
            let line = polyline(&mate, form, mate.gear.tip_roll_length(), 20_000);
            let gap = mesh.tip_gap(tip, 0.1 * mesh.base_pitch).unwrap();
            assert!((distance(corner, &line).0 - gap).abs() < 1e-10, "{kind:?} {tip:?}");
        }
    }
}

#[test]
fn three_planets_share_one_phase() {
    let (scene, geometry) = oh58("oh58_3p.toml");
    let phases =
        Phasing::new(&geometry, &scene.planets).unwrap().phases(0.2, Facing::CounterClockwise);
    assert!(phases.sun_planet.iter().all(|p| (p - phases.sun_planet[0]).abs() < 1e-14));
}
