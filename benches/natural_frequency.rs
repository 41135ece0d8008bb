//! CPU time of a natural frequency from the scene to the number: lumped model with the parameters of the scene, the
//! same with parameters in closed form, and FE/contact on the coarsest mesh that `auto` tries. Medians of interleaved
//! runs, as ratios to the first, and what the last two differ by.
//!
//! `RAYON_NUM_THREADS=1 cargo bench --bench natural_frequency`

use std::path::Path;

use experiments::auto::{AutoSettings, BodyInertia, FrequencyQuestion, Question};
use experiments::study::{CpuTime, Stopwatch};
use lumped::{LumpedModel, ModeType, NaturalModes};
use scene::{LoadCase, Scene};

/// Runs of each lumped model beside one of FE/contact.
const RUNS: usize = 40;

const ROUNDS: usize = 5;

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn main() {
    // `cargo bench … -- --test` only tests that benches start.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    for name in ["oh58_4p", "five_planets"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"));
        let scene = Scene::from_file(&path).expect("a scene of the repository");
        let case = LoadCase::of_scene(&scene).expect("a load");
        let (scene, case) = (&scene, &case);
        let question = |mode_type, number| FrequencyQuestion { scene, case, mode_type, number };
        let first = question(ModeType::Rotational, 1);
        let closed = |asked: &FrequencyQuestion<'_>| {
            asked.in_closed_form().expect("closed forms").expect("a frequency").0
        };
        let coarse = AutoSettings::fe_contact(0, BodyInertia::None);
        let mut times = [const { Vec::new() }; 3];
        let mut clock = CpuTime::default();
        let mut timed = |list: &mut Vec<f64>, work: &dyn Fn()| {
            let start = clock.seconds();
            work();
            list.push(clock.seconds() - start);
        };
        for _ in 0..ROUNDS {
            for _ in 0..RUNS {
                timed(&mut times[0], &|| {
                    let model = LumpedModel::from_scene(scene).expect("parameters");
                    std::hint::black_box(NaturalModes::of(&model)).expect("modes");
                });
                timed(&mut times[1], &|| {
                    std::hint::black_box(closed(&first));
                });
            }
            timed(&mut times[2], &|| {
                std::hint::black_box(first.answer(&coarse)).expect("bodies");
            });
        }
        let [given, of_closed, finite] = times.map(median);
        println!(
            "{name}: lumped as given 1 ({:.0} µs), in closed form {:.2}, FE/contact {:.0}",
            1e6 * given,
            of_closed / given,
            finite / given
        );
        for (mode_type, number) in [
            (ModeType::Rotational, 1),
            (ModeType::Rotational, 3),
            (ModeType::Translational, 1),
            (ModeType::Translational, 5),
            (ModeType::Planet, 1),
            (ModeType::Planet, 2),
        ] {
            let asked = question(mode_type, number);
            let words = asked.words();
            match (asked.in_closed_form(), asked.answer(&coarse)) {
                (Ok(Some((own, _))), Ok(fe)) => {
                    let off = 100.0 * (own / fe - 1.0);
                    println!("  {words}: {own:.1} Hz, {off:+.2} % of {fe:.1} Hz");
                }
                // A mode that is of two types by nearly halves has no number.
                (Err(e), _) | (_, Err(e)) => println!("  {words}: {e}"),
                _ => (),
            }
        }
    }
}
