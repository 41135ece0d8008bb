//! Criterion benches of the lumped model: assembly, eigensolution, classification, N = 3 to 12.
//!
//! Purpose: to see the time of each part of an analysis, and its growth with the number of planets. The
//! LAPACK route has the same sizes in `lapack_route/benches`. Noise: about 5 % on a shared 2-core machine;
//! smaller differences are not significant. Time: about a minute.

use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use gearset::PlanetPositions;
use lumped::{LumpedModel, NaturalModes};
use scene::Scene;

fn benches(c: &mut Criterion) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lin_parker_1999_3p.toml");
    let template = Scene::from_file(&path).expect("a scene of the repository");
    let mut group = c.benchmark_group("lumped");
    group.warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
    for planets in 3..=12 {
        let mut scene = template.clone();
        scene.planets = PlanetPositions::equally_spaced(planets);
        let model = LumpedModel::from_scene(&scene).expect("a complete scene");
        let k = model.stiffness();
        group.bench_function(BenchmarkId::new("assembly", planets), |b| {
            b.iter(|| LumpedModel::from_scene(black_box(&scene)).map(|m| m.stiffness()));
        });
        group.bench_function(BenchmarkId::new("eigensolution", planets), |b| {
            b.iter(|| dynamics::generalized_symmetric(black_box(&k), &model.mass));
        });
        group.bench_function(BenchmarkId::new("with_classification", planets), |b| {
            b.iter(|| NaturalModes::with_stiffness(black_box(&model), &k));
        });
    }
    group.finish();
}

criterion_group!(lumped_model, benches);
criterion_main!(lumped_model);
