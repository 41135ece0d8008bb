//! Time of static solutions: the bodies of a whole set, one mesh cycle of 140 positions, one position.
//!
//! `RAYON_NUM_THREADS=1 cargo bench --bench statics`; counts of iterations are printed by
//! `epicyclic static`.

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::{Facing, Scene};

fn statics(c: &mut Criterion) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/oh58_4p.toml");
    let scene = Scene::from_file(&path).expect("a scene of the repository");
    let bodies = Bodies::new(&scene).expect("bodies");
    let sense = Facing::CounterClockwise;
    let set = StaticSet::new(&scene, &bodies, sense, Imperfections::default()).expect("set");
    let mut group = c.benchmark_group("oh58_4p");
    group.sample_size(10);
    group.bench_function("bodies", |b| b.iter(|| Bodies::new(black_box(&scene))));
    group.bench_function("cycle_of_140_positions", |b| {
        b.iter(|| set.cycle(black_box(1413.0), 140, &ActiveSet));
    });
    group.bench_function("one_position", |b| {
        b.iter(|| set.cycle(black_box(1413.0), 1, &ActiveSet));
    });
    group.finish();
}

criterion_group!(benches, statics);
criterion_main!(benches);
