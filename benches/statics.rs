//! Time of static solutions: the bodies of a whole set, one mesh cycle of 140 positions, also with tip relief, one
//! position.
//!
//! `RAYON_NUM_THREADS=1 cargo bench --bench statics`; counts of iterations are printed by
//! `epicyclic static`.

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::{Facing, Gear, ReliefShape, TipRelief};
use scene::Scene;

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
    let relieved = with_relief(&scene);
    let own = Bodies::new(&relieved).expect("bodies");
    let set = StaticSet::new(&relieved, &own, sense, Imperfections::default()).expect("set");
    group.bench_function("cycle_with_tip_relief", |b| {
        b.iter(|| set.cycle(black_box(1413.0), 140, &ActiveSet));
    });
    group.finish();
}

/// The same gears with 10 µm taken off from a quarter of the tooth's depth below the tip.
fn with_relief(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let geometry = scene.tooth_geometry().expect("teeth");
    let relief = |gear: &Gear| {
        let start_radius = gear.tip_radius - 0.25 * (gear.tip_radius - gear.root_radius);
        Some(TipRelief {
            start_radius_m: start_radius,
            amount_m: 10e-6,
            shape: ReliefShape::Linear,
        })
    };
    if let Some(own) = scene.geometry.as_mut() {
        own.sun.as_mut().expect("sun").tip_relief = geometry.sun.as_ref().and_then(relief);
        own.planet.tip_relief = relief(&geometry.planet);
        own.ring.as_mut().expect("ring").tip_relief = geometry.ring.as_ref().and_then(relief);
    }
    scene
}

criterion_group!(benches, statics);
criterion_main!(benches);
