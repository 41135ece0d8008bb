//! Symmetries of statics: roles of the gears, numbering, threads; bodies; faults.

use std::path::Path;
use std::sync::OnceLock;

use fe_contact::complementarity::{ActiveSet, ComplementaritySolver, InteriorPoint, Lemke};
use fe_contact::contact::{MeshTable, PairFrame};
use fe_contact::statics::{Bodies, Imperfections, StaticSet, at_phase, pair_cycle};
use fe_contact::{Elastic, FeError};
use gearset::{Facing, Mesh, MeshKind};
use scene::{CellLayout, ElementFamily, Scene};

fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
    Scene::from_file(&path).unwrap()
}

const FORCE: f64 = 10_700.67;

/// The set's bodies on a coarse mesh, made once.
fn bodies() -> &'static Bodies {
    static BODIES: OnceLock<Bodies> = OnceLock::new();
    BODIES.get_or_init(|| {
        let mut scene = scene("oh58_4p.toml");
        scene.fe_contact.flank_elements = 8;
        Bodies::new(&scene).unwrap()
    })
}

/// The sun mesh described from the planet's side: planet driving, path run through backwards.
#[test]
fn the_result_does_not_depend_on_which_flank_is_the_reference() {
    let b = bodies();
    let mesh = b.geometry.mesh(MeshKind::SunPlanet).unwrap();
    let (sun, planet) = (b.geometry.sun.as_ref().unwrap(), &b.geometry.planet);
    let swapped = Mesh::sun_planet(planet, sun, b.geometry.center_distance).unwrap();
    let settings = b.cells(FORCE);
    let [on_sun, on_planet] = b.pair(MeshKind::SunPlanet).unwrap();
    for phase in [0.0, 0.13, 0.5, 0.7, 0.93] {
        let roll_length = mesh.path_start + phase * mesh.base_pitch;
        let mirrored =
            (mesh.driven_roll_length(roll_length) - swapped.path_start) / swapped.base_pitch;
        let one = MeshTable::new(mesh, [on_sun, on_planet], phase, &settings).unwrap();
        let two = MeshTable::new(&swapped, [on_planet, on_sun], mirrored, &settings).unwrap();
        // The same approach of every pair: torques would differ, as the two gears' arms do at a
        // corner.
        let forces = |table: &MeshTable| {
            let n = table.pairs.len();
            let found = table.answer(&vec![18e-6; n], &vec![0.0; n], &ActiveSet, None);
            let mut list = found.unwrap().pair_forces;
            list.sort_by(f64::total_cmp);
            list
        };
        let (first, second) = (forces(&one), forces(&two));
        assert_eq!(first.len(), second.len());
        for (p, q) in first.iter().zip(&second) {
            assert!((p - q).abs() < 1e-9 * FORCE, "{phase}: {p} {q}");
        }
    }
}

/// The three solvers through the whole chain.
#[test]
fn solvers_agree_on_teeth() {
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let solve = |solver: &dyn ComplementaritySolver| {
            at_phase(bodies(), kind, FORCE, 0.52, solver).unwrap().deflection
        };
        let base = solve(&ActiveSet);
        assert!((solve(&Lemke) / base - 1.0).abs() < 1e-10);
        assert!((solve(&InteriorPoint) / base - 1.0).abs() < 1e-7);
    }
}

/// The table of docs/fe_contact.md from which the default element was chosen: mean secant stiffness of the sun mesh,
/// 1e6 N/m, with 7, 14 and 28 elements along a flank.
#[test]
fn stiffness_by_element_is_as_tabled() {
    let table = [
        (ElementFamily::Linear, [648.6, 631.5, 621.7]),
        (ElementFamily::Incompatible, [639.3, 628.9, 620.8]),
        (ElementFamily::Quadratic, [620.6, 618.3, 617.3]),
    ];
    for (element, stiffness) in table {
        for (flank_elements, expected) in [7, 14, 28].into_iter().zip(stiffness) {
            let mut scene = scene("oh58_4p.toml");
            scene.fe_contact.element = element;
            scene.fe_contact.flank_elements = flank_elements;
            (scene.fe_contact.matching_points, scene.fe_contact.matching_depth_m) =
                (1, Some(0.98e-3));
            let bodies = Bodies::new(&scene).unwrap();
            let cycle = pair_cycle(&bodies, MeshKind::SunPlanet, FORCE, 40, &ActiveSet).unwrap();
            let mean = cycle.mean_secant_stiffness() / 1e6;
            assert!((mean - expected).abs() < 0.051, "{element:?} {flank_elements}: {mean}");
        }
    }
}

/// The Hermite edges of the sun's flanks are within 45 nm of the involute with ten elements along a flank, within 15 nm
/// with fourteen.
#[test]
fn flanks_follow_the_involute() {
    for (flank_elements, stated) in [(10, 45e-9), (14, 15e-9)] {
        let mut scene = scene("oh58_4p.toml");
        scene.fe_contact.flank_elements = flank_elements;
        let bodies = Bodies::new(&scene).unwrap();
        let error = bodies.sun.as_ref().unwrap().mesh.flank_error();
        assert!((error - stated).abs() < 0.5e-9, "{flank_elements}: {error}");
    }
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let scene = scene("oh58_4p.toml");
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let set = StaticSet::new(
                &scene,
                bodies(),
                Facing::CounterClockwise,
                Imperfections::default(),
            );
            let cycle = set.unwrap().cycle(1413.0, 14, &ActiveSet).unwrap();
            cycle.states.iter().flat_map(|s| s.central[2].map(f64::to_bits)).collect::<Vec<_>>()
        })
    };
    assert_eq!(run(1), run(2));
}

/// A force along the normal of a gear's flank has that gear's base radius as its moment arm, at
/// every point of the flank.
#[test]
fn arms_are_base_radii_on_the_path_and_the_opposing_flanks_at_corners() {
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let mesh = bodies().geometry.mesh(kind).unwrap();
        let [driver, driven] =
            [gearset::MeshMember::Driver, gearset::MeshMember::Driven].map(|m| mesh.gear(m));
        for i in 0..40 {
            let phase = f64::from(i) / 40.0;
            for k in -1..=2 {
                let Some(frame) = PairFrame::new(mesh, phase, k) else { continue };
                let row = frame.approach_row();
                let (a, b) = (row[2].abs() / driver.base_radius, row[5].abs() / driven.base_radius);
                use fe_contact::contact::Location;
                match frame.location {
                    Location::Path => assert!((a - 1.0).abs() < 1e-12 && (b - 1.0).abs() < 1e-12),
                    // The arm of the gear whose flank is pressed on is its base radius.
                    Location::Corner(gearset::MeshMember::Driver) => {
                        assert!((b - 1.0).abs() < 1e-12);
                    }
                    Location::Corner(gearset::MeshMember::Driven) => {
                        assert!((a - 1.0).abs() < 1e-12);
                    }
                }
                assert!(frame.gap >= -1e-12);
            }
        }
    }
}

/// Gaps across the flanks are those of two circles of the curvature radii.
#[test]
fn gaps_follow_the_relative_curvature() {
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let mesh = bodies().geometry.mesh(kind).unwrap();
        for phase in [0.3, 0.7] {
            let frame = PairFrame::new(mesh, phase, 0).unwrap();
            for x in [-2e-4, -1e-4, 1e-4, 2e-4] {
                let (gap, expected) = (frame.gap_at(x), x * x / (2.0 * frame.radius()));
                assert!((gap / expected - 1.0).abs() < 0.03, "{kind:?} {gap:e} {expected:e}");
            }
            assert!(frame.gap_at(0.0).abs() < 1e-15);
        }
    }
}

/// Maxwell–Betti: before its symmetric part is taken, the matched compliance is symmetric to within
/// 2 % of its largest entry; afterwards it is positive definite.
#[test]
fn compliance_is_nearly_reciprocal() {
    let b = bodies();
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let (mesh, pair) = (b.geometry.mesh(kind).unwrap(), b.pair(kind).unwrap());
        for phase in [0.1, 0.6] {
            let table = MeshTable::new(mesh, pair, phase, &b.cells(FORCE)).unwrap();
            assert!(table.asymmetry < 0.02, "{}", table.asymmetry);
            assert!(nalgebra::Cholesky::new(table.compliance.clone()).is_some());
        }
    }
}

#[test]
fn a_grid_too_coarse_for_the_load_is_refused_with_its_remedy() {
    let mut coarse = bodies().clone();
    coarse.settings.input.contact_cells = 8;
    let refused = pair_cycle(&coarse, MeshKind::SunPlanet, FORCE, 20, &ActiveSet);
    let error = refused.map(|_| ()).unwrap_err();
    assert!(matches!(error, FeError::GridTooCoarse { .. }), "{error}");
    let message = error.to_string();
    assert!(message.contains("contact_cells"), "{message}");
}

#[test]
fn a_set_that_nothing_holds_is_refused() {
    let mut free = scene("oh58_4p.toml");
    free.supports.carrier.motion = scene::Freedom::Free;
    let set = StaticSet::new(&free, bodies(), Facing::CounterClockwise, Imperfections::default());
    let refused = set.unwrap().cycle(1000.0, 1, &ActiveSet);
    let error = refused.map(|_| ()).unwrap_err();
    assert!(matches!(error, FeError::NoEquilibrium(_)), "{error}");
}

#[test]
fn without_a_bore_there_is_no_race() {
    let mut boreless = scene("oh58_sun_planet_pair.toml");
    boreless.geometry.as_mut().unwrap().planet.body_radius_m = None;
    let refused = Bodies::new(&boreless).unwrap_err().to_string();
    assert!(refused.contains("geometry.planet.bore_diameter_mm"), "{refused}");
}

/// Coupling through the rim decays from tooth to tooth. The four teeth kept on either side contain
/// all pairs of a mesh. Other meshes of the same gear are at least six teeth away; their influence
/// is left out.
#[test]
fn coupling_through_the_rim_dies_out() {
    let b = bodies();
    let depth = b.settings.matching.depth;
    for body in [b.sun.as_ref().unwrap(), &b.planet, b.ring.as_ref().unwrap()] {
        for side in [fe_contact::fe_mesh::Side::Ccw, fe_contact::fe_mesh::Side::Cw] {
            let at = |offset: i64| body.mid_flank_flexibility(side, depth, offset);
            let own = at(0);
            for sign in [-1, 1] {
                let list = [1, 2, 3, 4].map(|k| at(sign * k) / own);
                assert!(list[0] > 0.03 && list[0] < 0.15, "{list:?}");
                assert!(list.windows(2).all(|w| w[1] < 0.7 * w[0]), "{list:?}");
                assert!(list[3] < 0.025, "{list:?}");
            }
        }
    }
}

#[test]
fn a_ring_of_material_weighs_what_it_should() {
    let b = bodies();
    let m: &Elastic = &b.material;
    let ring = b.ring.as_ref().unwrap();
    let gear = ring.mesh.outline.gear();
    let area = |inner: f64, outer: f64| std::f64::consts::PI * (outer * outer - inner * inner);
    let unit = m.density * b.geometry.face_width;
    // Between the mass of the rim alone and that of the rim with its tooth spaces filled.
    let rim = gear.body_radius.unwrap();
    let (least, most) = (unit * area(gear.root_radius, rim), unit * area(gear.tip_radius, rim));
    assert!(ring.mass > least && ring.mass < most);
}

/// A planet displaced by 300 µm towards the sun touches it on both flanks, whose backlash is 91 µm;
/// a planet in its nominal place touches it on the loaded flanks only.
#[test]
fn backside_flanks_press_where_the_backlash_is_used_up() {
    let scene = scene("oh58_3p.toml");
    let run = |shift: f64| {
        let imperfections =
            Imperfections { displaced_planets: vec![(1, shift, 0.0)], ..Imperfections::default() };
        let set = StaticSet::new(&scene, bodies(), Facing::CounterClockwise, imperfections);
        set.unwrap().cycle(200.0, 3, &ActiveSet).unwrap()
    };
    let (nominal, displaced) = (run(0.0), run(-300e-6));
    assert_eq!((nominal.backside_contact(), displaced.backside_contact()), (0.0, 1.0));
    for state in &nominal.states {
        assert!(state.backside.is_empty());
    }
    for state in &displaced.states {
        assert!(state.residual < 1e-9);
        let jammed: Vec<_> = state.backside.iter().filter(|m| m.force > 0.0).collect();
        assert!(jammed.iter().any(|m| m.kind == MeshKind::SunPlanet && m.planet == 1));
        // Opposite flanks press against each other: both carry more than the torque requires.
        let front = state.meshes.iter().find(|m| m.kind == MeshKind::SunPlanet && m.planet == 1);
        assert!(front.unwrap().force > 200.0 / 3.0 / 35.2e-3);
    }
}

/// Sun and ring with no backlash at all: in the nominal place every backside flank touches as well, and a
/// load opens them.
#[test]
fn without_backlash_the_load_opens_the_backside_flanks() {
    let mut tight = scene("oh58_3p.toml");
    let geometry = tight.geometry.as_mut().unwrap();
    geometry.thickness = gearset::ThicknessInput::Backlash {
        sun_planet_m: 0.0,
        ring_planet_m: 0.0,
        planet_share: 0.5,
    };
    tight.fe_contact.flank_elements = 8;
    let b = Bodies::new(&tight).unwrap();
    let set = StaticSet::new(&tight, &b, Facing::CounterClockwise, Imperfections::default());
    for state in &set.unwrap().cycle(1130.0, 4, &ActiveSet).unwrap().states {
        assert!(state.residual < 1e-9);
        let backside: f64 = state.backside.iter().map(|m| m.force).sum();
        let front: f64 = state.meshes.iter().map(|m| m.force).sum();
        assert!(backside < 0.2 * front, "{backside} {front}");
    }
}

/// A flexibility factor scales the FE part of the compliance, also between pairs, and leaves the
/// part of the half-planes, which acts within one pair only; a factor of 1 changes no bit.
#[test]
fn a_factor_scales_the_fe_part_of_one_mesh_alone() {
    let b = bodies();
    let with = |factor: f64, kind: MeshKind| {
        let mut settings = b.cells(FORCE);
        settings.flexibility_factor.sun_planet = factor;
        let (mesh, pair) = b.joined(kind).unwrap();
        MeshTable::new(mesh, pair, 0.1, &settings).unwrap()
    };
    let [one, two, three] = [1.0, 2.0, 3.0].map(|f| with(f, MeshKind::SunPlanet));
    let (mesh, pair) = b.joined(MeshKind::SunPlanet).unwrap();
    let plain = MeshTable::new(mesh, pair, 0.1, &b.cells(FORCE)).unwrap();
    assert_eq!(one.compliance, plain.compliance);
    let fe = &two.compliance - &one.compliance;
    let largest = one.compliance.amax();
    assert!((&three.compliance - &one.compliance - 2.0 * &fe).amax() < 1e-14 * largest);
    let half_planes = &one.compliance - &fe;
    let pair_of = one.pair_of_cells();
    assert!(one.pairs.len() > 1);
    for (i, p) in pair_of.iter().enumerate() {
        for (j, q) in pair_of.iter().enumerate() {
            if p != q {
                assert!(half_planes[(i, j)].abs() < 1e-14 * largest);
            }
        }
    }
    assert!(half_planes.amax() > 0.1 * largest && fe.amax() > 0.1 * largest);
    let [ring, same] = [1.0, 2.0].map(|f| with(f, MeshKind::RingPlanet));
    assert_eq!(ring.compliance, same.compliance);
}

#[test]
fn a_factor_that_is_no_flexibility_is_refused() {
    for factor in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut soft = scene("oh58_4p.toml");
        soft.fe_contact.flexibility_factor.ring_planet = factor;
        let refused = Bodies::new(&soft).unwrap_err().to_string();
        assert!(refused.contains("fe_contact.flexibility_factor.ring_planet"), "{refused}");
    }
}

/// The figures of one mesh are consistent with its cells: pressures add up to the pair's force, and
/// the forces over the passage of one tooth pair are those of all pairs.
#[test]
fn pressures_and_loads_of_tooth_pairs_add_up() {
    let cycle = pair_cycle(bodies(), MeshKind::SunPlanet, FORCE, 8, &ActiveSet).unwrap();
    let (p, k) = cycle.heaviest_pair().unwrap();
    let profile = p.pressure_profile(k).unwrap();
    let cells = &p.table.pairs[k];
    let per_width = profile.pressures.iter().zip(&cells.widths).map(|(p, w)| p * w);
    let force = per_width.sum::<f64>() * p.table.face_width;
    assert!((force / p.answer.pair_forces[k] - 1.0).abs() < 1e-12);
    let peak = profile.pressures.iter().copied().fold(0.0, f64::max);
    let load = p.pairs.iter().find(|l| l.index == profile.index).unwrap();
    assert!((peak / load.peak_pressure - 1.0).abs() < 1e-12);
    assert!(profile.places.iter().all(|x| x.abs() < profile.half_length));
    assert!((profile.ellipse.unwrap().peak_pressure / peak - 1.0).abs() < 0.1);
    assert!(p.pressure_profile(p.table.pairs.len()).is_none());

    let way = cycle.load_of_one_pair();
    assert!(way.windows(2).all(|w| w[0].0 <= w[1].0));
    let total: f64 = cycle.positions.iter().flat_map(|p| &p.pairs).map(|l| l.force).sum();
    assert!((way.iter().map(|w| w.1).sum::<f64>() / total - 1.0).abs() < 1e-12);
    assert!(way.iter().all(|w| w.1 <= load.force));
    let secants = cycle.positions.iter().map(|p| cycle.secant_stiffness(p)).sum::<f64>();
    assert!((secants / 8.0 / cycle.mean_secant_stiffness() - 1.0).abs() < 1e-12);
}

#[test]
fn ranges_over_the_cycle_of_a_set_hold_its_positions() {
    let scene = scene("oh58_4p.toml");
    let perfect = Imperfections::default();
    let set = StaticSet::new(&scene, bodies(), Facing::CounterClockwise, perfect).unwrap();
    let cycle = set.cycle(1130.0, 4, &ActiveSet).unwrap();
    let radius = bodies().geometry.sun.as_ref().unwrap().base_radius;
    let error = cycle.transmission_error(radius);
    let list: Vec<f64> = cycle.states.iter().map(|s| s.transmission_error(radius)).collect();
    assert!(list.contains(&error.least) && list.contains(&error.largest));
    assert!(error.least < error.mean && error.mean < error.largest);
    assert_eq!(error.peak_to_peak(), error.largest - error.least);
    // The mean over the sun meshes of the four planets is the mean of the set.
    let own = (0..4).map(|mesh| cycle.mesh_secant_stiffness(mesh).mean).sum::<f64>() / 4.0;
    assert!((own / cycle.mean_secant_stiffness(MeshKind::SunPlanet) - 1.0).abs() < 1e-12);
    let force = cycle.mesh_force(0);
    assert!((force.mean / (1130.0 / 4.0 / radius) - 1.0).abs() < 1e-2);
    let tangent = cycle.mesh_tangent_stiffness(0);
    assert!(tangent.least > 0.0 && tangent.mean > cycle.mesh_secant_stiffness(0).mean);
}

/// Mean forces over T/r_b: corners and the slopes of the deformed flanks press beside the line of action, so that the
/// sum of the pair forces is a little larger than that along it.
#[test]
fn mean_mesh_forces_exceed_those_along_the_line_of_action_by_less_than_a_thousandth() {
    let scene = scene("oh58_4p.toml");
    let perfect = Imperfections::default();
    let set = StaticSet::new(&scene, bodies(), Facing::CounterClockwise, perfect).unwrap();
    let cycle = set.under(1413.0).unwrap().cycle(1413.0, 28, &ActiveSet).unwrap();
    let even = 1413.0 / 4.0 / bodies().geometry.sun.as_ref().unwrap().base_radius;
    for (meshes, least) in [(0..4, 2e-4), (4..8, 1e-4)] {
        let above = meshes.map(|mesh| cycle.mesh_force(mesh).mean / even - 1.0).sum::<f64>() / 4.0;
        println!("{:.4} % above T/r_b", 100.0 * above);
        assert!(above > least && above < 1e-3, "{above:e}");
    }
}

/// Graded contact cells at rest (`fe_contact.cell_layout_at_rest`): twenty are nearer to many even ones than twenty
/// even ones are, position by position over the mesh cycle, on the same bodies.
#[test]
fn twenty_graded_cells_at_rest_are_nearer_than_twenty_even_ones() {
    let with = |cells: u32, layout: CellLayout| {
        let mut own = bodies().clone();
        own.settings.input.contact_cells = cells;
        own.settings.input.cell_layout_at_rest = layout;
        let cycle = pair_cycle(&own, MeshKind::SunPlanet, FORCE, 60, &ActiveSet).unwrap();
        cycle.positions.iter().map(|at| at.deflection).collect::<Vec<_>>()
    };
    let fine = with(120, CellLayout::Even);
    let [even, graded] = [CellLayout::Even, CellLayout::Graded].map(|layout| {
        let off = with(20, layout).into_iter().zip(&fine).map(|(own, fine)| own - fine);
        let off: Vec<f64> = off.collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        off.iter().map(|x| (x - mean).abs()).fold(0.0, f64::max)
    });
    println!("off by {even:e} m on even cells, by {graded:e} m on graded ones");
    assert!(graded < 0.7 * even, "{graded:e} {even:e}");
}
