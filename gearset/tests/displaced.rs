//! Displaced meshes checked against rigid flanks placed explicitly and measured as polylines, without use of
//! operating angles or ends of the path; their derivatives checked against difference quotients.

use std::f64::consts::TAU;
use std::path::Path;

use gearset::{
    DisplacedMesh, Displacements, Flank, Geometry, Mesh, MeshKind, MeshMember, PairLocation,
    ToothSide,
};
use scene::Scene;

const MESHES: [MeshKind; 2] = [MeshKind::SunPlanet, MeshKind::RingPlanet];

/// How far beyond the ends of the path corner contacts are followed, m.
const CORNER_REACH: f64 = 0.6e-3;

fn oh58() -> Geometry {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/oh58_4p.toml");
    Scene::from_file(&path).unwrap().tooth_geometry().unwrap()
}

/// Linear congruential generator (Knuth's MMIX constants).
struct Random(u64);

impl Random {
    /// Uniform in ±`limit`.
    fn within(&mut self, limit: f64) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        limit * ((self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
    }

    /// Phase, and displacements up to 1 mm and 20 mrad with the driven gear turned to an approach
    /// within ±50 µm.
    fn place(&mut self, mesh: &Mesh) -> (f64, Displacements) {
        let phase = 0.5 + self.within(0.5);
        let mut x: Displacements =
            std::array::from_fn(|i| self.within(if i % 3 == 2 { 20e-3 } else { 1e-3 }));
        turn_driven_to(mesh, phase, &mut x, self.within(50e-6));
        (phase, x)
    }
}

/// Turns the driven gear until the mesh has this approach.
fn turn_driven_to(mesh: &Mesh, phase: f64, x: &mut Displacements, approach: f64) {
    let off = approach - mesh.displaced(phase, x).unwrap().approach;
    x[5] += off / mesh.gear(MeshMember::Driven).base_radius;
}

fn moved<'g>(flank: Flank<'g>, x: &[f64]) -> Flank<'g> {
    let centre = [flank.centre[0] + x[0], flank.centre[1] + x[1]];
    Flank { centre, origin_angle: flank.origin_angle + x[2], ..flank }
}

/// The pair that touches nominally at the driver's roll length, its gears displaced rigidly.
fn front_flanks<'m>(mesh: &'m Mesh, roll_length: f64, x: &Displacements) -> [Flank<'m>; 2] {
    let (driver, driven) = mesh.flanks(roll_length);
    [moved(driver, &x[..3]), moved(driven, &x[3..])]
}

/// Backside flanks of the pair of teeth whose working flanks touch, chosen so that their mirror image
/// (y → −y) stands at the driver's `roll_length`. The gears are displaced to the mirror image of `x`, but the
/// rotation of the driven gear counts from contact of the backside flanks, `gap` (m) from that of the working
/// flanks.
fn backside_flanks<'m>(
    mesh: &'m Mesh,
    gap: f64,
    roll_length: f64,
    x: &Displacements,
) -> [Flank<'m>; 2] {
    let driver = mesh.gear(MeshMember::Driver);
    // Both flanks of the driver's lobe: −α + s/r_b and α − s'/r_b, two half angles apart.
    let lobe = 2.0 * driver.base_radius * (mesh.pressure_angle + driver.half_angle_base);
    let (driver, driven) = mesh.flanks(lobe - roll_length);
    let other = |f: Flank<'m>| Flank {
        origin_angle: f.origin_angle - 2.0 * f.facing.sign() * f.gear.half_angle_base,
        facing: f.facing.opposite(),
        ..f
    };
    let (driver, mut driven) = (other(driver), other(driven));
    if driven.gear.side == ToothSide::External {
        // The driver's tooth stands in a space: its backside flank faces the next tooth.
        driven.origin_angle += driven.gear.pitch_angle();
    }
    let slack = gap / driven.gear.base_radius;
    [moved(driver, &[x[0], -x[1], -x[2]]), moved(driven, &[x[3], -x[4], -x[5] - slack])]
}

/// Turns one flank about its gear's centre until it touches the other, by the smallest angle between points
/// of the two polylines at the same radius; the polylines are refined about the point found. Returns the turn
/// times the base radius (m, positive if the flanks were apart) and the roll lengths of the touching points;
/// `None` if one of these is at a form circle.
fn touch(still: &Flank<'_>, turned: &Flank<'_>) -> Option<(f64, [f64; 2])> {
    let polar = |p: [f64; 2]| {
        let [x, y] = [p[0] - turned.centre[0], p[1] - turned.centre[1]];
        [x.hypot(y), y.atan2(x)]
    };
    let wrapped = |angle: f64| angle - TAU * (angle / TAU).round();
    let outside = turned.gear.side == ToothSide::External;
    let free_side = if outside { 1.0 } else { -1.0 } * turned.facing.sign();
    let forms = [still, turned].map(|f| f.gear.form_roll_length().unwrap());
    let tips = [still, turned].map(|f| f.gear.tip_roll_length());
    let whole = [0, 1].map(|i| [forms[i].min(tips[i]), forms[i].max(tips[i])]);
    let (mut parts, mut best) = (whole, None);
    for _ in 0..7 {
        let [roll_lengths, on_turned] = parts.map(|[low, high]| {
            (0..=80).map(|i| low + (high - low) * f64::from(i) / 80.0).collect::<Vec<_>>()
        });
        let at = |s: f64| [s, polar(turned.point(s))[0], polar(turned.point(s))[1]];
        let line: Vec<_> = on_turned.into_iter().map(at).collect();
        best = None;
        for s in roll_lengths {
            let [r, angle] = polar(still.point(s));
            let segment = line.windows(2).find(|w| (w[0][1]..w[1][1]).contains(&r));
            let Some(&[[s0, r0, a0], [s1, r1, a1]]) = segment else { continue };
            let t = (r - r0) / (r1 - r0);
            let gap = free_side * wrapped(angle - a0 - t * wrapped(a1 - a0));
            if best.is_none_or(|(least, _)| gap < least) {
                best = Some((gap, [s, s0 + t * (s1 - s0)]));
            }
        }
        let (_, at) = best?;
        parts = std::array::from_fn(|i| {
            let wide = (parts[i][1] - parts[i][0]) / 10.0;
            [(at[i] - wide).max(whole[i][0]), (at[i] + wide).min(whole[i][1])]
        });
    }
    let (gap, roll_lengths) = best?;
    let on_flank = (0..2).all(|i| (roll_lengths[i] - forms[i]).abs() > 1e-5);
    on_flank.then_some((gap * turned.gear.base_radius, roll_lengths))
}

/// Deviations of one pair from its polylines: clearance and roll length where the flanks touch.
fn deviations(mesh: &Mesh, d: &DisplacedMesh, k: i64, flanks: &[Flank<'_>; 2]) -> Option<[f64; 2]> {
    let [driver, driven] = flanks;
    let turns = [touch(driver, driven)?, touch(driven, driver)?];
    let [end, start] = d.beyond(k);
    // The gear whose tip corner is nearer to, or farther beyond, its end of the path stands still; its
    // mate is turned.
    let standing = usize::from(start > end);
    let (clearance, roll_lengths) = turns[standing];
    let roll_length = match end.max(start) {
        past if past > 0.0 => roll_lengths[0] - flanks[standing].gear.tip_roll_length(),
        past if past > -0.1e-3 => 0.0,
        // Half-way between turning one gear and turning the other.
        _ => {
            let expected = d.touching_roll_length() + k as f64 * mesh.base_pitch;
            0.5 * (turns[0].1[0] + turns[1].1[1]) - expected
        }
    };
    Some([clearance - d.clearance(mesh, k).unwrap(), roll_length])
}

/// Checks one mesh at many random displacements.
fn agrees_with_polylines(
    mesh: &Mesh,
    place: impl for<'m> Fn(&'m Mesh, f64, &Displacements) -> [Flank<'m>; 2],
) {
    let (mut random, mut met, mut off_flank, mut worst) = (Random(58), [0; 3], 0, [0.0f64; 2]);
    for _ in 0..3000 {
        let (phase, x) = random.place(mesh);
        let d = mesh.displaced(phase, &x).unwrap();
        for k in (-2..=3).filter(|&k| d.beyond(k).iter().all(|&b| b < CORNER_REACH)) {
            let roll_length = mesh.path_start + (phase + k as f64) * mesh.base_pitch;
            let off = deviations(mesh, &d, k, &place(mesh, roll_length, &x));
            off_flank += usize::from(off.is_none());
            let Some(off) = off else { continue };
            met[match d.location(k) {
                PairLocation::Path => 0,
                PairLocation::Corner(tip) => 1 + tip as usize,
            }] += 1;
            worst = std::array::from_fn(|i| worst[i].max(off[i].abs()));
        }
    }
    println!("{:?}: path, corners {met:?}, off the flanks {off_flank}: {worst:?} m", mesh.kind);
    assert!(met.iter().all(|&n| n > 100), "{met:?}");
    assert!(worst[0] < 1e-13 && worst[1] < 1e-6, "{worst:?}");
}

/// Clearances of displaced pairs, on the path and at the tip corners, are those of polylines
/// displaced rigidly, and the flanks touch at the roll lengths that the mesh gives.
#[test]
fn clearances_are_those_of_displaced_polylines() {
    let geometry = oh58();
    for kind in MESHES {
        agrees_with_polylines(geometry.mesh(kind).unwrap(), front_flanks);
    }
}

/// The backside flanks of the same teeth, a backlash away, have the clearances of the mesh at mirrored
/// displacements.
#[test]
fn backside_flanks_are_the_mirror_image() {
    let geometry = oh58();
    for kind in MESHES {
        let backlash = geometry.normal_backlash(kind).unwrap();
        agrees_with_polylines(geometry.mesh(kind).unwrap(), |mesh, roll_length, x| {
            backside_flanks(mesh, backlash, roll_length, x)
        });
    }
}

/// First derivatives of approach, touching roll length and centre distance are the difference quotients
/// of the displaced mesh, second derivatives those of the first.
#[test]
fn derivatives_are_difference_quotients() {
    let geometry = oh58();
    let (mut random, mut worst) = (Random(3), [0.0f64; 2]);
    for mesh in MESHES.map(|kind| geometry.mesh(kind).unwrap()) {
        for _ in 0..100 {
            let (phase, x) = random.place(mesh);
            // Each quantity, then its gradient.
            let at = |i: usize, step: f64| {
                let mut x = x;
                x[i] += step;
                let d = mesh.displaced(phase, &x).unwrap();
                let g = d.gradients();
                let roll_length = d.touching_roll_length();
                [
                    (d.approach, g.approach),
                    (roll_length, g.roll_length),
                    (d.center_distance, g.center_distance),
                ]
            };
            // Richardson extrapolation from two steps cancels the leading error.
            let slope = |i: usize, of: &dyn Fn([(f64, [f64; 6]); 3]) -> f64| {
                let quotient = |h: f64| (of(at(i, h)) - of(at(i, -h))) / (2.0 * h);
                (4.0 * quotient(1e-5) - quotient(2e-5)) / 3.0
            };
            let h = mesh.displaced(phase, &x).unwrap().hessians();
            for (q, second) in [h.approach, h.roll_length, h.center_distance].iter().enumerate() {
                for (i, row) in second.iter().enumerate() {
                    let off = slope(i, &|all| all[q].0) - at(0, 0.0)[q].1[i];
                    worst[0] = worst[0].max(off.abs());
                    for (j, value) in row.iter().enumerate() {
                        let off = slope(i, &|all| all[q].1[j]) - value;
                        worst[1] = worst[1].max(off.abs());
                    }
                }
            }
        }
    }
    println!("gradients within {:.1e}, hessians within {:.1e} 1/m", worst[0], worst[1]);
    assert!(worst[0] < 1e-9 && worst[1] < 1e-6, "{worst:?}");
}

/// Carrier turned by κ, gears rolling without slip: no approach, and the phase moves by
/// Z_s (θ_s − κ)/2π at the sun's mesh, by −Z_r (θ_r − κ)/2π at the ring's.
#[test]
fn rolling_moves_the_phase_only() {
    let geometry = oh58();
    let mut random = Random(4);
    for mesh in MESHES.map(|kind| geometry.mesh(kind).unwrap()) {
        for _ in 0..1000 {
            let (kappa, central) = (random.within(0.3), random.within(0.1));
            let [ox, oy] = [random.within(1e-3), random.within(1e-3)];
            let a = mesh.center_distance;
            let planet = [ox + a * (kappa.cos() - 1.0), oy + a * kappa.sin()];
            // Relative to the carrier: external gears turn against, internal ones with each other.
            let (teeth, sense) = match mesh.kind {
                MeshKind::SunPlanet => (27.0, 1.0),
                MeshKind::RingPlanet => (99.0, -1.0),
            };
            let turn = kappa - sense * teeth / 35.0 * (central - kappa);
            let x = match mesh.kind {
                MeshKind::SunPlanet => [ox, oy, central, planet[0], planet[1], turn],
                MeshKind::RingPlanet => [planet[0], planet[1], turn, ox, oy, central],
            };
            let d = mesh.displaced(0.4, &x).unwrap();
            let phase = 0.4 + sense * teeth * (central - kappa) / TAU;
            assert!(d.approach.abs() < 1e-15, "{:e}", d.approach);
            assert!((d.phase() - phase).abs() < 1e-12, "{} {phase}", d.phase());
        }
    }
}

/// The same gears mounted at the displaced centre distance have the same path, and touch at the
/// touching roll length; centres too close are refused.
#[test]
fn mounting_at_the_displaced_centre_distance_gives_the_same_path() {
    let geometry = oh58();
    let mut random = Random(5);
    for mesh in MESHES.map(|kind| geometry.mesh(kind).unwrap()) {
        for _ in 0..1000 {
            let (phase, x) = random.place(mesh);
            let d = mesh.displaced(phase, &x).unwrap();
            let there = mesh.at_center_distance(d.center_distance).unwrap();
            let again = there.displaced(d.phase(), &[0.0; 6]).unwrap();
            for (one, other) in [
                (d.path()[0], there.path_start),
                (d.path()[1], there.path_end),
                (d.touching_roll_length(), again.driver_roll_length),
                (0.0, again.approach),
            ] {
                assert!((one - other).abs() < 1e-15, "{one} {other}");
            }
            // The driver's flank is that of the mounted mesh at roll length s₁, the driven gear's that at
            // s₁ − δ.
            let (driver, driven) = d.flanks(mesh, 1);
            let roll_length = d.driver_roll_length + mesh.base_pitch;
            let (own, mate) =
                (there.flanks(roll_length).0, there.flanks(roll_length - d.approach).1);
            for (one, other) in [(driver, own), (driven, mate)] {
                assert!((one.origin_angle - other.origin_angle).abs() < 1e-14);
                assert!(one.centre == other.centre && one.facing == other.facing);
            }
        }
        // Least centre distance: where the operating angle vanishes.
        let least = mesh.center_distance * mesh.pressure_angle.cos();
        let mut x = [0.0; 6];
        let planet = if mesh.kind == MeshKind::SunPlanet { 3 } else { 0 };
        x[planet] = least - mesh.center_distance + 1e-9;
        assert!(mesh.displaced(0.0, &x).is_ok());
        x[planet] -= 2e-9;
        let refused = mesh.displaced(0.0, &x).unwrap_err();
        assert!(refused.kind == mesh.kind && (refused.least - least).abs() < 1e-15);
        assert!(mesh.at_center_distance(least - 1e-9).is_err());
        assert!(mesh.displaced(0.0, &[f64::NAN; 6]).is_err());
    }
}

/// Negative control: kinematics linearised about the unloaded position is off the polylines by more than
/// 0.5 µm for pairs 0.4 mm and more beyond the path, if both gears are turned by 0.7 mm along the line of
/// action.
#[test]
fn linear_kinematics_misses_the_corners_of_a_wound_up_mesh() {
    let geometry = oh58();
    for mesh in MESHES.map(|kind| geometry.mesh(kind).unwrap()) {
        // The driver is turned by 0.7 mm along the line of action, the driven gear to an approach of 20 µm.
        let mut x = [0.0; 6];
        x[2] = 0.7e-3 / mesh.gear(MeshMember::Driver).base_radius;
        turn_driven_to(mesh, 0.0, &mut x, 20e-6);
        let mut least = [f64::INFINITY; 2];
        for phase in (0..200).map(|i| f64::from(i) / 200.0) {
            let [rest, d] = [[0.0; 6], x].map(|x| mesh.displaced(phase, &x).unwrap());
            let slope = rest.gradients().approach;
            let closing: f64 = slope.iter().zip(&x).map(|(g, x)| g * x).sum();
            for k in -2..=3 {
                let PairLocation::Corner(tip) = d.location(k) else { continue };
                if !(0.4e-3..CORNER_REACH).contains(&d.beyond(k)[tip as usize]) {
                    continue;
                }
                let roll_length = mesh.path_start + (phase + k as f64) * mesh.base_pitch;
                let mut flanks = front_flanks(mesh, roll_length, &x);
                if tip == MeshMember::Driven {
                    flanks.reverse();
                }
                let linear = rest.clearance(mesh, k).unwrap() - closing;
                let off = linear - touch(&flanks[0], &flanks[1]).unwrap().0;
                least[tip as usize] = least[tip as usize].min(off.abs());
            }
        }
        println!("{:?}: linear kinematics off by at least {least:?} m", mesh.kind);
        assert!(least.iter().all(|&off| off > 0.5e-6 && off < 1e-3), "{least:?}");
    }
}

/// The gap of a tip corner grows by the closed form: exact kinematics at a distance e beyond the path give ½ G'' e² but
/// for a part of the order of e over the radii of curvature, which halves with e.
#[test]
fn corner_gaps_start_with_the_curvature_of_the_closed_form() {
    let geometry = oh58();
    for mesh in MESHES.map(|kind| geometry.mesh(kind).unwrap()) {
        for corner in [MeshMember::Driver, MeshMember::Driven] {
            let off = [0.2e-3, 0.1e-3].map(|e: f64| {
                // Pair 0 rolled on to e beyond the end of the path, or back to e before its start.
                let phase = match corner {
                    MeshMember::Driver => mesh.contact_ratio + e / mesh.base_pitch,
                    MeshMember::Driven => -e / mesh.base_pitch,
                };
                let there = mesh.displaced(phase, &[0.0; 6]).unwrap();
                assert_eq!(there.location(0), PairLocation::Corner(corner));
                assert!((there.beyond(0)[corner as usize] - e).abs() < 1e-12);
                let gap = there.clearance(mesh, 0).unwrap();
                gap / (0.5 * mesh.corner_gap_curvature(corner) * e * e) - 1.0
            });
            assert!(off[1].abs() < 0.02, "{:?} {corner:?}: {off:?}", mesh.kind);
            assert!((off[0] / off[1] - 2.0).abs() < 0.1, "{:?} {corner:?}: {off:?}", mesh.kind);
        }
    }
}
