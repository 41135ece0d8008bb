//! No contradiction is found in results of this project's models: written as a folder of tables, read back, held
//! against themselves. Sets whose ring or carrier drives, mirrored and clockwise ones and a gear pair are among them.

use experiments::models::{FeContact, Lumped, Recorded};
use experiments::sweep::{Coordinate, Line, Part, SteadyState};
use experiments::torque::TorquePeak;
use experiments::{
    MeshCycle, MeshStiffness, ModalModel, NaturalMode, RestState, SpeedRequest, StaticModel,
    SteadyStateModel,
};
use gearset::{Facing, MeshKind};
use lumped::ModeType;
use scene::{LoadCase, Scene};
use validation::results::ResultsFolder;
use validation::variants::mirrored;
use validation::{PublishedScene, scene};

/// Holds what a folder says against itself; `scene_file` is put beside the tables.
fn has_no_contradiction(record: &Recorded, kind: &str, own: Option<&Scene>) {
    let folder = tempfile::tempdir().unwrap();
    record.write(folder.path()).unwrap();
    let manifest = format!("format = 1\nkind = \"{kind}\"\n");
    std::fs::write(folder.path().join("results.toml"), manifest).unwrap();
    if let Some(scene) = own {
        std::fs::write(folder.path().join("own.toml"), scene.to_toml()).unwrap();
    }
    let read = ResultsFolder::read(folder.path()).unwrap();
    let rows = read.modes.len() + read.mesh_cycle.len() + read.steady_states.len();
    assert!(rows > 0);
    let found: Vec<String> = read.contradictions(None).iter().map(ToString::to_string).collect();
    assert!(found.is_empty(), "{found:#?}");
    assert!(read.remarks.is_empty(), "{:?}", read.remarks);
}

fn turning(set: &Scene, case: &LoadCase, speeds_rpm: &[f64]) -> Recorded {
    let request = SpeedRequest { speeds_rpm, harmonics: 5, tolerance: 1e-6 };
    let states = FeContact::default().steady_states(set, case, &request).unwrap();
    let steady_states = states.into_iter().map(|state| (set.title.clone(), state)).collect();
    Recorded { steady_states, ..Recorded::default() }
}

#[test]
fn natural_modes_of_lumped_models() {
    use PublishedScene::{
        LinParkerFourPlanets, LinParkerThreePlanets, Oh58FourPlanetsAsPublished,
        Oh58ThreePlanetsAsPublished,
    };
    for which in [
        LinParkerFourPlanets,
        LinParkerThreePlanets,
        Oh58FourPlanetsAsPublished,
        Oh58ThreePlanetsAsPublished,
    ] {
        let set = scene(which).unwrap();
        let modes = Lumped::default().natural_modes(&set, &LoadCase::standing(1.0)).unwrap();
        let modes = modes.into_iter().map(|mode| (set.title.clone(), mode)).collect();
        has_no_contradiction(&Recorded { modes, ..Recorded::default() }, "lumped", None);
    }
}

#[test]
fn natural_modes_and_mesh_cycles_of_elastic_sets_in_both_senses() {
    let set = scene(PublishedScene::Oh58FourPlanets).unwrap();
    let case = LoadCase::of_scene(&set).unwrap();
    let model = FeContact::default();
    let modes = model.natural_modes(&set, &case).unwrap();
    let mut record = Recorded {
        modes: modes.into_iter().map(|mode| (set.title.clone(), mode)).collect(),
        ..Recorded::default()
    };
    for torque in [1413.0, -1413.0] {
        let cycle = model.mesh_cycle(&set, &case.with_sun_torque(torque), 28).unwrap();
        record.mesh_cycles.push((set.title.clone(), cycle));
    }
    has_no_contradiction(&record, "fe_contact", None);
    let mirrored = mirrored(&set);
    let cycle = model.mesh_cycle(&mirrored, &case, 28).unwrap();
    let mesh_cycles = vec![(mirrored.title.clone(), cycle)];
    let record = Recorded { mesh_cycles, ..Recorded::default() };
    has_no_contradiction(&record, "fe_contact", Some(&mirrored));
}

#[test]
fn mesh_cycles_of_five_planets_and_of_sets_driven_at_carrier_and_ring() {
    use PublishedScene::{AutomaticTransmissionSet, FivePlanets, WindTurbineStage};
    for which in [FivePlanets, WindTurbineStage, AutomaticTransmissionSet] {
        let set = scene(which).unwrap();
        let case = LoadCase::of_scene(&set).unwrap();
        let cycle = FeContact::default().mesh_cycle(&set, &case, 28).unwrap();
        let mesh_cycles = vec![(set.title.clone(), cycle)];
        has_no_contradiction(&Recorded { mesh_cycles, ..Recorded::default() }, "fe_contact", None);
    }
}

/// Play so small that vibration takes it up: forces of the driving flanks are then more than the torque.
#[test]
fn steady_states_of_a_gear_pair_with_backside_contact() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/pair_50_50.toml");
    let text = std::fs::read_to_string(file).unwrap();
    let text = text.replace("backlash_mm = 0.1", "backlash_mm = 0.00002");
    let mut set = Scene::from_toml(&text).unwrap();
    set.title = "A gear pair with little play".to_owned();
    let case = LoadCase::of_scene(&set).unwrap().with_sun_torque(2.0);
    let record = turning(&set, &case, &[1600.0, 1800.0, 2000.0]);
    let lines = record.steady_states.iter().flat_map(|(_, state)| &state.lines);
    let behind = lines.filter(|line| line.coordinate == Coordinate::BacksideContact);
    assert!(behind.map(|line| line.amplitude).fold(0.0, f64::max) > 0.1);
    has_no_contradiction(&record, "fe_contact", Some(&set));
}

/// A model that is wrong, and whose tables do not contradict themselves.
#[test]
fn natural_modes_that_are_wrong_without_contradiction() {
    let set = scene(PublishedScene::LinParkerFourPlanets).unwrap();
    let mut modes = Lumped::default().natural_modes(&set, &LoadCase::standing(1.0)).unwrap();
    modes.iter_mut().for_each(|mode| mode.frequency_hz *= 1.3);
    let modes = modes.into_iter().map(|mode| (set.title.clone(), mode)).collect();
    has_no_contradiction(&Recorded { modes, ..Recorded::default() }, "lumped", None);
}

#[test]
fn what_is_written_is_read_back() {
    let title = || scene(PublishedScene::Oh58FourPlanets).unwrap().title;
    let mode = |frequency_hz, mode_type| (title(), NaturalMode { frequency_hz, mode_type });
    let rest = |position: f64| RestState {
        position,
        sun: [1e-6, -2e-6, 3e-5 + position],
        sun_mesh_n: vec![100.25, 99.0],
        ring_mesh_n: vec![98.0, 97.0],
    };
    let line = |harmonic| Line {
        part: Part::SunMesh(1),
        coordinate: Coordinate::Force,
        harmonic,
        amplitude: 0.1 * harmonic as f64,
        phase_rad: -1.0,
    };
    let state = |rpm: f64| SteadyState {
        case: LoadCase::turning(1130.0, rpm, 0.35 * rpm),
        lines: vec![line(0), line(3)],
    };
    let case = LoadCase::standing(1130.0);
    let cycle = MeshCycle { case, states: [0.0, 0.25, 0.5, 0.75].map(rest).to_vec() };
    let stiffness = MeshStiffness {
        case,
        kind: MeshKind::RingPlanet,
        positions: vec![0.0, 0.5],
        secant_n_per_m: vec![8e8, 7e8],
    };
    let peak = TorquePeak {
        sun_torque_nm: 565.0,
        sun_turns: Some(Facing::Clockwise),
        part: Part::SUN,
        coordinate: Coordinate::Rotation,
        harmonic: 2,
        frequency_hz: 1150.25,
        amplitude: 1e-5,
    };
    let record = Recorded {
        modes: vec![mode(770.0, ModeType::Translational), mode(1156.5, ModeType::Rotational)],
        mesh_cycles: vec![(title(), cycle)],
        steady_states: [500.0, 510.0].map(|rpm| (title(), state(rpm))).to_vec(),
        mesh_stiffness: vec![(title(), stiffness)],
        torque_peaks: vec![(title(), peak)],
    };
    let folder = tempfile::tempdir().unwrap();
    record.write(folder.path()).unwrap();
    assert_eq!(ResultsFolder::read(folder.path()).unwrap().recorded(), record);
}
