//! Sweeps: a plan gives the same numbers however it is run; a pitch error repeats with the sun's teeth.

use std::collections::HashMap;
use std::sync::Mutex;

use experiments::sweep::{
    Chain, Coordinate, Direction, FeModel, Kept, Memory, Part, Plan, PointStore, SteadyMethod,
    SteadySettings, StoreError, Sweep, SweepModel, run,
};
use fe_contact::statics::{Bodies, Imperfections, PitchError};
use scene::{LoadCase, Scene};

fn scene(steps: u32) -> Scene {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/oh58_4p.toml");
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    scene.fe_contact.flank_elements = 8;
    scene.dynamics.steps_per_cycle = steps;
    scene
}

fn under(scene: &Scene) -> LoadCase {
    LoadCase::of_scene(scene).unwrap().with_sun_torque(1130.0)
}

fn settings() -> SteadySettings {
    SteadySettings {
        method: SteadyMethod::Shooting,
        tolerance: 1e-6,
        most_cycles: 400,
        harmonics: 4,
        between_cycles: 4,
        whole_cycles: false,
        keeps_steps: false,
    }
}

/// Keeps points as text, and refuses further ones after `most`.
struct Breaking {
    kept: Mutex<HashMap<(String, usize), String>>,
    most: usize,
}

impl PointStore for Breaking {
    fn load(&self, chain: &Chain, index: usize) -> Result<Option<Kept>, StoreError> {
        let kept = self.kept.lock().unwrap();
        Ok(kept.get(&(chain.name.clone(), index)).map(|text| serde_json::from_str(text).unwrap()))
    }

    fn save(&self, chain: &Chain, index: usize, point: &Kept) -> Result<(), StoreError> {
        let mut kept = self.kept.lock().unwrap();
        if kept.len() >= self.most {
            return Err(StoreError { message: "broken off".into() });
        }
        kept.insert((chain.name.clone(), index), serde_json::to_string(point).unwrap());
        Ok(())
    }
}

#[test]
fn broken_off_or_on_one_thread_the_numbers_are_the_same() {
    let scene = scene(28);
    let bodies = Bodies::new(&scene).unwrap();
    let model = FeModel::new(&scene, &bodies, Imperfections::default(), under(&scene));
    let mut plan = Plan::new(&[900.0, 1000.0, 1100.0], &[Direction::Up], settings()).unwrap();
    plan.chains
        .extend(Plan::new(&[1500.0, 1600.0], &[Direction::Down], settings()).unwrap().chains);
    let of = |store: &dyn PointStore| run(&model, &plan, store, &|_| ());
    let whole = of(&Memory).unwrap();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(one.install(|| of(&Memory)).unwrap(), whole);
    let mut store = Breaking { kept: Mutex::default(), most: 0 };
    for most in [1, 3] {
        store.most = most;
        assert!(of(&store).is_err());
    }
    store.most = 5;
    let resumed = of(&store).unwrap();
    assert_eq!(serde_json::to_string(&resumed).unwrap(), serde_json::to_string(&whole).unwrap());
}

fn single(model: &dyn SweepModel, settings: SteadySettings) -> Sweep {
    let plan = Plan::new(&[1600.0], &[Direction::Up], settings).unwrap();
    run(model, &plan, &Memory, &|_| ()).unwrap()
}

/// With a pitch error of one sun tooth the motion repeats only with the teeth of the sun, and there is energy
/// between mesh harmonics; without it there is none.
#[test]
fn a_tooth_out_of_place_makes_sidebands() {
    let scene = scene(28);
    let bodies = Bodies::new(&scene).unwrap();
    let perfect = FeModel::new(&scene, &bodies, Imperfections::default(), under(&scene));
    let point = &single(&perfect, settings()).chains[0].1[0];
    assert!(point.is_steady && point.between.unwrap() < 1e-11, "{:?}", point.between);
    assert!(point.state.amplitude(Part::SUN, Coordinate::Rotation, 2) > 1e-5);
    let errors = vec![PitchError { tooth: 5, amount: 10e-6 }];
    let faulty = Imperfections { pitch_errors: errors, ..Imperfections::default() };
    let model = FeModel::new(&scene, &bodies, faulty, under(&scene));
    let settings = SteadySettings { most_cycles: 54, between_cycles: 27, ..settings() };
    let point = &single(&model, settings).chains[0].1[0];
    assert!(!point.is_steady && point.between.unwrap() > 1e-4, "{:?}", point.between);
}
