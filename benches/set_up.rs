//! CPU time and memory of what a sweep needs before its first step: the bodies of four planets, the contact
//! tables of a mesh cycle with the loaded configuration, and a set on them. Prints one line for each part, and last the
//! same bodies from the assembled stiffness of whole gears.
//!
//! `RAYON_NUM_THREADS=1 cargo bench --bench set_up`

use std::path::Path;

use fe_contact::body::GearBody;
use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::{Loading, NominalRotation, Prepared, VibratingSet};
use gearset::{Facing, PathDirection};
use scene::Scene;

const TORQUE: f64 = 1413.0;

/// Mesh force that sweeps lay tables out for, over that of a planet's even share.
const HEADROOM: f64 = 2.0;

/// CPU time of this process so far, s, from clock ticks of 10 ms.
fn cpu() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
    let (_, after_name) = stat.rsplit_once(')').unwrap();
    let field = |n: usize| after_name.split_whitespace().nth(n).unwrap().parse::<f64>().unwrap();
    // User and system time: fields 14 and 15, the third is the first after the name.
    0.01 * (field(11) + field(12))
}

/// Largest resident memory so far, MB.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmHWM")).unwrap();
    1.024e-3 * line.split_whitespace().nth(1).unwrap().parse::<f64>().unwrap()
}

fn main() {
    // `cargo bench … -- --test` only tests that benches start.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/oh58_4p.toml");
    let scene = Scene::from_file(&path).expect("a scene of the repository");
    let steps_per_cycle = scene.dynamics.steps_per_cycle as usize;
    let rotation = NominalRotation::Turning {
        mesh_frequency: 700.0,
        steps_per_cycle,
        direction: PathDirection::Forward,
    };
    let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
    let mut before = cpu();
    let mut report = |part: &str| {
        let now = cpu();
        if part.is_empty() {
            before = now;
            return;
        }
        println!("{part:<22} {:6.2} CPU-s   peak {:7.1} MB", now - before, peak());
        before = now;
    };
    report("start");
    let bodies = Bodies::new(&scene).expect("bodies");
    report("bodies");
    let share = TORQUE / 4.0 / bodies.geometry.sun.as_ref().unwrap().base_radius;
    let loading = Loading { torque_nm: TORQUE, mesh_force: HEADROOM * share };
    let prepared = Prepared::new(&scene, &bodies, sense, none, rotation, loading).expect("tables");
    report("tables, configuration");
    let mut set = VibratingSet::on(&scene, &prepared, rotation).expect("set");
    set.rest(TORQUE).expect("equilibrium");
    report("set at rest");
    for _ in 0..steps_per_cycle {
        set.step().expect("step");
    }
    report("first cycle of steps");
    let [tables, maps, frames] = set.bytes().map(|b| b as f64 / 1e6);
    println!("tables {tables:.1} MB, maps {maps:.1} MB, frames {frames:.1} MB");
    drop((set, prepared));
    report("");
    for body in
        [bodies.ring.as_ref(), bodies.sun.as_ref(), Some(&bodies.planet)].into_iter().flatten()
    {
        let whole = GearBody::of_whole_gear(body.mesh.clone(), body.material, body.face_width);
        assert_eq!(whole.expect("body").unknowns, body.unknowns);
    }
    report("bodies of whole gears");
}
