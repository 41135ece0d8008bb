//! Time of one natural-mode solution, with vectors, for 3 to 12 planets: LAPACK's `dsygv` and the project's
//! own route (nalgebra).
//!
//! Purpose: to see whether the project's own route is a good default at these sizes. Noise: 5 % on a quiet
//! machine. Time: about a minute.

use std::hint::black_box;
use std::path::Path;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use gearset::PlanetPositions;
use lapack_route::dsygv_pairs;
use lumped::{LumpedModel, NaturalModes};
use scene::Scene;

fn eigen(criterion: &mut Criterion) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/lin_parker_1999_4p.toml");
    let mut scene = Scene::from_file(&path).expect("a scene of the project is valid");
    let mut group = criterion.benchmark_group("natural_modes");
    group.warm_up_time(std::time::Duration::from_secs(1));
    group.measurement_time(std::time::Duration::from_secs(2));
    for planets in 3..=12 {
        scene.planets = PlanetPositions::equally_spaced(planets);
        let model = LumpedModel::from_scene(&scene).expect("the scene has lumped parameters");
        let k = model.stiffness();
        let m = model.mass_matrix();
        group.bench_function(BenchmarkId::new("dsygv", planets), |b| {
            b.iter(|| dsygv_pairs(black_box(&k), black_box(&m)));
        });
        // Includes the mode types, which `dsygv` does not give.
        group.bench_function(BenchmarkId::new("faer_and_mode_types", planets), |b| {
            b.iter(|| NaturalModes::with_stiffness(black_box(&model), black_box(&k)));
        });
    }
    group.finish();
}

criterion_group!(benches, eigen);
criterion_main!(benches);
