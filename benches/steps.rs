//! Computing time of one time step at each fidelity, with four planets at 1600 rpm under 1413 N·m, once the
//! contact maps of a cycle are known. The numbers of solutions and of new maps per step are printed first.

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};

use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::{Loading, NominalRotation, VibratingSet};
use gearset::{Facing, PathDirection};
use scene::{Fidelity, Scene};

const STEPS: usize = 140;
const TORQUE: f64 = 1413.0;

fn steps(c: &mut Criterion) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(&root.join("scenes/oh58_4p.toml")).unwrap();
    // A coarse flank: only `full` and the set-up depend on the FE mesh.
    scene.fe_contact.flank_elements = 8;
    let bodies = Bodies::new(&scene).unwrap();
    let force = TORQUE / 4.0 / bodies.geometry.sun.as_ref().unwrap().base_radius;
    let mut group = c.benchmark_group("step");
    group.sample_size(10);
    let fidelities = [
        ("quasi_static", Fidelity::QuasiStatic, Some(60)),
        ("modal_2", Fidelity::Modal(2), Some(60)),
        ("modal_10", Fidelity::Modal(10), Some(60)),
        ("full_standing", Fidelity::Full, None),
    ];
    for (name, fidelity, cycles) in fidelities {
        scene.dynamics.fidelity = fidelity;
        // A turning set at `full` needs a solution for each port at every position, a standing set at one.
        let rotation = match cycles {
            Some(_) => NominalRotation::Turning {
                mesh_frequency: 565.714,
                steps_per_cycle: STEPS,
                direction: PathDirection::Forward,
            },
            None => NominalRotation::Standing { position: 0.0, step: 12.6e-6 },
        };
        let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
        let loading = Loading { torque_nm: TORQUE, mesh_force: force };
        let mut set = VibratingSet::new(&scene, &bodies, sense, none, rotation, loading).unwrap();
        set.rest(TORQUE).unwrap();
        for _ in 0..cycles.map_or(2, |c| c * STEPS) {
            set.step().unwrap();
        }
        let before = set.counts;
        for _ in 0..cycles.map_or(2, |_| STEPS) {
            set.step().unwrap();
        }
        let (after, [solved, maps]) = (set.counts, set.contact_counts());
        let [tables, kept, frames] = set.bytes().map(|b| b as f64 / 1e6);
        println!(
            "{name}: {} elastic unknowns; per step {:.2} solutions of all pairs, {:.3} new combinations; \
             {solved} contact problems and {maps} maps so far; {tables:.1} MB tables, {kept:.1} MB maps, \
             {frames:.1} MB positions",
            set.elastic_unknowns(),
            (after.solutions - before.solutions) as f64 / (after.steps - before.steps) as f64,
            (after.combinations - before.combinations) as f64 / (after.steps - before.steps) as f64,
        );
        group.bench_function(name, |b| b.iter(|| black_box(&mut set).step().unwrap()));
    }
    group.finish();
}

criterion_group!(benches, steps);
criterion_main!(benches);
