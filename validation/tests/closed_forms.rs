//! How far the parameters in closed form of the lumped model (`lumped::AnalyticSet`) are from what FE/contact computes
//! on meshes of the same bodies: masses, pin seats and mesh stiffnesses; and the transmission errors of
//! `lumped::AnalyticCycle`. `auto` estimates its errors from these.

use experiments::auto::{
    AutoSettings, BodyInertia, CycleQuestion, CycleValue, FrequencyQuestion, Question,
};
use experiments::modal::{Preload, linear_modes, majority, preloaded};
use fe_contact::body::CarrierBody;
use fe_contact::statics::Bodies;
use lumped::{AnalyticCycle, AnalyticSet, ModeType, SpringId};
use scene::{AutoModeType, CellLayout, FlankLayer, LoadCase, Scene};
use validation::drawn_set;

/// Ratios of one set, closed forms over FE/contact.
#[derive(Debug, Default)]
struct Ratios {
    /// Of all masses and inertias, the farthest from 1.
    mass: f64,
    /// Of the flexibility of a seat: radial, tangential.
    seats: [f64; 2],
    /// What the flexibility between seats is off, largest entry, over the largest entry.
    between: f64,
    /// Of the stiffness of sun and of ring meshes where no pair may or may not touch.
    meshes: [Vec<f64>; 2],
    /// Meshes where one may.
    handing_over: usize,
}

fn ratios(scene: &Scene, positions: &[f64]) -> Option<Ratios> {
    // What the closed forms were fitted beside: 10 whole elements, 30 even cells.
    let mut own = AutoSettings::fe_contact(1, BodyInertia::None).applied_to(scene);
    own.fe_contact.flank_layer = FlankLayer::Whole;
    own.fe_contact.contact_cells = 30;
    own.fe_contact.cell_layout_at_rest = CellLayout::Even;
    let (bodies, load) = (Bodies::new(&own).ok()?, LoadCase::of_scene(scene).ok()?);
    let mut all = Ratios { mass: 1.0, ..Ratios::default() };
    for &position in positions {
        let set = preloaded(&own, &bodies, &Preload { load, position, step_s: 5e-6 }).ok()?;
        let linear = set.linearised().ok()?;
        let closed = AnalyticSet::new(scene, &load, position).ok()?;
        let farther = |a: f64, b: f64| if (b - 1.0).abs() > (a - 1.0).abs() { b } else { a };
        let fe_mass = linear.mass.diagonal();
        let masses = closed.model.mass.iter().zip(fe_mass.iter());
        all.mass = masses.map(|(own, fe)| own / fe).fold(all.mass, farther);
        let planets = closed.model.psi.len();
        for spring in &closed.model.springs {
            let (kind, mesh) = match spring.id {
                SpringId::SunMesh(n) => (0, n),
                SpringId::RingMesh(n) => (1, planets + n),
                _ => continue,
            };
            match closed.hand_overs[mesh] == 0.0 {
                true => all.meshes[kind].push(spring.stiffness / linear.mesh_tangents[mesh]),
                false => all.handing_over += 1,
            }
        }
        let geometry = scene.geometry.as_ref()?;
        let (input, psi) = (geometry.carrier?, &scene.planets.psi_rad);
        let (a, b) = (geometry.center_distance_m, geometry.face_width_m);
        let fe = CarrierBody::new(&input, a, psi, &bodies.material, b).ok()?.flexibility;
        all.seats = [0, 1].map(|i| closed.seats[(i, i)] / fe[(i, i)]);
        all.between = (&closed.seats - &fe).amax() / fe.amax();
    }
    Some(all)
}

fn scene(name: &str) -> Scene {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Scene::from_file(std::path::Path::new(&path)).unwrap()
}

fn holds(name: &str, all: &Ratios) {
    assert!((all.mass - 1.0).abs() < 3e-4, "{name}: {all:?}");
    let [radial, tangential] = all.seats;
    assert!((radial - 1.0).abs() < 0.05 && (tangential - 1.0).abs() < 0.02, "{name}: {all:?}");
    assert!(all.between < 0.03, "{name}: {all:?}");
    for own in &all.meshes {
        assert!(own.iter().all(|k| (k - 1.0).abs() < 0.12), "{name}: {all:?}");
        let mean = own.iter().sum::<f64>() / own.len() as f64;
        assert!((mean - 1.0).abs() < 0.06, "{name}: {all:?}");
    }
}

/// Shipped sets, whose teeth are none of those to which the foundation of the teeth was fitted.
#[test]
fn closed_forms_hold_on_shipped_sets() {
    for name in ["oh58_4p", "oh58_3p", "five_planets"] {
        let all = ratios(&scene(name), &[0.0, 0.4]).unwrap();
        println!("{name} {all:?}");
        holds(name, &all);
    }
}

/// Modes in which planets hardly press their meshes change with the torque by how flanks lean as they roll on and as
/// their centres move apart, and by forces that turn: alike in the closed form and in FE/contact. Without the slope
/// over the centre distance they were apart by about 0.1 %.
#[test]
fn modes_hardly_pressed_follow_the_load() {
    for (name, scene) in [("OH-58", scene("oh58_4p")), ("18037", drawn_set(18037).unwrap())] {
        let over_contact = |part: f64| {
            let mut scene = scene.clone();
            scene.operation.as_mut().unwrap().torque_nm *= part;
            let case = LoadCase::of_scene(&scene).unwrap();
            let question = FrequencyQuestion::new(&scene, &case, AutoModeType::Planet, 1);
            let contact = question.answer(&AutoSettings::fe_contact(1, BodyInertia::None));
            question.in_closed_form().unwrap().unwrap().0 / contact.unwrap()
        };
        let [loaded, light] = [1.0, 0.03].map(over_contact);
        let apart = 100.0 * (loaded / light - 1.0);
        println!("{name}: under load {apart:+.3} %");
        assert!(apart.abs() < 0.04, "{name}: {apart}");
    }
}

/// OH-58 with another bore of the carrier: outer over inner radius.
fn with_bore(ratio: f64) -> Scene {
    let mut scene = scene("oh58_4p");
    let carrier = scene.geometry.as_mut().unwrap().carrier.as_mut().unwrap();
    carrier.bore_radius_m = carrier.outer_radius_m / ratio;
    scene
}

/// The first frequencies of each type, Hz, that are wanted: in closed form with their stated error, and of FE/contact
/// with modes of each body.
fn beside_modes_of_bodies(scene: &Scene, modes: u32, wanted: usize) -> Vec<[f64; 3]> {
    let load = LoadCase::of_scene(scene).unwrap();
    let own = AutoSettings::fe_contact(0, BodyInertia::Modes(modes)).applied_to(scene);
    let bodies = Bodies::new(&own).unwrap();
    let set = preloaded(&own, &bodies, &Preload { load, position: 0.0, step_s: 5e-6 }).unwrap();
    let contact = linear_modes(&set, &set.linearised().unwrap()).unwrap();
    let closed = AnalyticSet::new(scene, &load, 0.0).unwrap();
    let groups = closed.modes().unwrap().groups;
    let mut found = Vec::new();
    for mode_type in [ModeType::Rotational, ModeType::Translational, ModeType::Planet] {
        let of_contact = contact.iter().filter(|mode| mode.mode_type == mode_type);
        let of_type = groups.iter().filter(|g| majority(&g.participation) == mode_type);
        let each = of_type.flat_map(|g| std::iter::repeat_n(g, g.multiplicity));
        for (group, mode) in each.zip(of_contact).take(wanted) {
            let own = group.frequency_hz * (1.0 + closed.inertia_change(group));
            let stated = closed.frequency_errors(group).iter().map(|error| error.share).sum();
            found.push([own, stated, mode.frequency_hz]);
        }
    }
    found
}

fn within_what_is_stated(ratios: &[f64], modes: u32, wanted: usize) {
    for ratio in ratios {
        for [own, stated, contact] in beside_modes_of_bodies(&with_bore(*ratio), modes, wanted) {
            let off = own / contact - 1.0;
            println!("{ratio}: {own:.1} Hz, {:+.3} %, stated {:.3} %", 100.0 * off, 100.0 * stated);
            assert!(off.abs() < stated, "{ratio}: {own} {contact} {stated}");
        }
    }
}

/// Frequencies of a set with a slender carrier, which moves between its bore and the pins, are within what is stated
/// of them.
#[test]
#[ignore = "long: .ci/full runs it"]
fn stated_errors_hold_with_a_slender_carrier() {
    within_what_is_stated(&[2.9], 20, 2);
}

/// The same of other carriers, more modes of the bodies and those of the set that meshes govern.
#[test]
#[ignore = "two minutes"]
fn stated_errors_hold_with_modes_of_the_bodies() {
    within_what_is_stated(&[1.7, 2.0, 2.5, 2.9], 40, 4);
}

/// Mean transmission error at rest in closed form over that of FE/contact, less 1, with its estimate, and the ratio of
/// peak to peak; percent.
fn means(scene: &Scene) -> Option<[f64; 3]> {
    let case = LoadCase::of_scene(scene).ok()?;
    let mean = CycleQuestion { scene, case: &case, value: CycleValue::Mean };
    let contact = AutoSettings::fe_contact(1, BodyInertia::None).at_positions(scene, 0);
    let positions = contact.positions?;
    let (in_closed_form, parts) = mean.in_closed_form().ok()??;
    let estimate = parts.iter().map(|part| part.percent).sum();
    let by_contact = mean.answer(&contact).ok()?;
    let range_by_contact = by_contact.above + by_contact.below;
    let all: Vec<f64> = (0..positions).map(|i| f64::from(i) / f64::from(positions)).collect();
    let rest = AnalyticCycle::new(scene, &case).and_then(|cycle| cycle.at_rest(&all)).ok()?;
    let curve = rest.iter().map(|own| 1e6 * own.transmission_error);
    let [low, high] = curve.fold([f64::INFINITY, 0.0], |[a, b], x| [a.min(x), b.max(x)]);
    let percent = |ratio: f64| 100.0 * (ratio - 1.0);
    let of_range = percent((high - low) / range_by_contact);
    Some([percent(in_closed_form / by_contact.mean), estimate, of_range])
}

/// The mean transmission error at rest is within its estimate on shipped sets; peak to peak, which has none, is within
/// a third.
#[test]
fn mean_transmission_errors_hold_on_shipped_sets() {
    for name in ["oh58_4p", "oh58_3p", "five_planets"] {
        let [off, estimate, of_range] = means(&scene(name)).unwrap();
        println!(
            "{name}: mean {off:+.2} % (estimate {estimate:.2}), peak to peak {of_range:+.1} %"
        );
        assert!(off.abs() < estimate && estimate < 2.0, "{name}: {off} {estimate}");
        assert!(of_range.abs() < 33.0, "{name}: {of_range}");
    }
}

/// The same on drawn sets that the closed forms were not fitted to.
#[test]
#[ignore = "one minute"]
fn mean_transmission_errors_hold_on_drawn_sets() {
    let (mut off, mut ranges, mut beyond) = (Vec::new(), Vec::new(), 0);
    for seed in 13001..13061 {
        let Some(drawn) = drawn_set(seed) else { continue };
        let Some([own, estimate, of_range]) = means(&drawn) else { continue };
        beyond += usize::from(own.abs() > estimate);
        off.push(own);
        ranges.push(of_range);
    }
    let quantiles = |list: &mut Vec<f64>| {
        list.sort_by(f64::total_cmp);
        [0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0]
            .map(|share| list[(share * (list.len() - 1) as f64).round() as usize])
    };
    let (count, of_means) = (off.len(), quantiles(&mut off));
    println!("{count} sets, {beyond} beyond their estimate; mean {of_means:+.2?} %");
    println!("peak to peak {:+.1?} %", quantiles(&mut ranges));
    assert!(beyond * 20 <= count, "{beyond} of {count}");
}

/// The figures of `docs/closed_forms.md`: on the drawn sets to which the foundation of the teeth was fitted, and on
/// others.
#[test]
#[ignore = "seven minutes"]
fn closed_forms_hold_on_drawn_sets() {
    let mut all = Vec::new();
    for (name, seeds) in [("fitted", 1..120), ("other", 120..250)] {
        let (mut suns, mut rings) = (Vec::new(), Vec::new());
        let (mut handing_over, mut sets) = (0, 0);
        for seed in seeds {
            let Some(drawn) = drawn_set(seed) else { continue };
            let Some(own) = ratios(&drawn, &[0.0, 0.2, 0.4, 0.6, 0.8]) else { continue };
            holds(&format!("set {seed}"), &Ratios { meshes: [vec![1.0], vec![1.0]], ..own });
            sets += 1;
            handing_over += own.handing_over;
            let [sun, ring] = own.meshes;
            suns.extend(sun);
            rings.extend(ring);
        }
        println!("{name}: {sets} sets, {handing_over} meshes with pairs that may or may not touch");
        for (kind, mut own) in [("sun", suns), ("ring", rings)] {
            own.sort_by(f64::total_cmp);
            let at = |share: f64| own[(share * (own.len() - 1) as f64).round() as usize];
            let quantiles = [0.0, 0.025, 0.05, 0.25, 0.5, 0.75, 0.95, 0.975, 1.0].map(at);
            // A pair that touches in one and not in the other changes the stiffness by a third.
            let misjudged = own.iter().filter(|k| (*k - 1.0).abs() > 0.2).count();
            println!(
                "  {kind} meshes: {}, {misjudged} of them misjudged, {quantiles:.3?}",
                own.len()
            );
            all.push((format!("{name} {kind}"), misjudged, own.len(), quantiles));
        }
    }
    for (name, misjudged, count, [_, _, low, _, _, _, high, _, _]) in all {
        assert!(low > 0.96 && high < 1.06, "{name}: {low} {high}");
        assert!(misjudged * 200 <= count, "{name}: {misjudged} of {count}");
    }
}
