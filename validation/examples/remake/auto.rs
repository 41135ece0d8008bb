//! Choices of `auto` on drawn scenes, their true errors and costs: `kept/auto.csv`. Half an hour on one core.
//!
//! `cargo run --release -p validation --example remake -- auto > auto.csv && mv auto.csv kept/`
//!
//! `AUTO_SEEDS=1..9` runs other seeds: those of the record served no other purpose, and 1 to 12 were used when the
//! estimates were programmed. 1001 to 1073 are those of an earlier record, whose misses were read before the estimates were
//! changed, so that the record has others.

use validation::{AutoRow, ResponseRow, auto_row, auto_tables, response_row};

use super::Outcome;

/// Seeds of the record, and how many sets it holds: those that FE/contact refuses have no truth and are left out.
const SEEDS: std::ops::Range<u64> = 5001..6001;
const SETS: usize = 60;

/// Seeds of the record of responses, apart from those of natural frequencies and from 1 to 75 and 1001 to 1016, on which
/// its estimates were programmed, and from 3001 on, whose record was read before they were changed. The second range was drawn
/// later, to see whether the first, of which no answer is off by more than its tolerance, was lucky. Each gives [`SETS`].
const RESPONSE_SEEDS: [std::ops::Range<u64>; 2] = [7001..9001, 9001..10001];

/// Seeds of the record, or those that `AUTO_SEEDS` asks for.
fn seeds(
    own: &[std::ops::Range<u64>],
) -> Result<Vec<std::ops::Range<u64>>, Box<dyn std::error::Error + Send + Sync>> {
    let Ok(text) = std::env::var("AUTO_SEEDS") else { return Ok(own.to_vec()) };
    let (from, to) = text.split_once("..").ok_or("AUTO_SEEDS is not of the form 1..9")?;
    let asked = from.parse()?..to.parse()?;
    Ok([asked].into())
}

/// Prints the row of each seed that has a truth, up to [`SETS`] of a range; then the seeds without a truth.
fn print_rows(
    ranges: Vec<std::ops::Range<u64>>,
    row: &dyn Fn(u64) -> Result<Option<String>, experiments::ExperimentError>,
) -> Outcome {
    let mut refused = Vec::new();
    for range in ranges {
        let mut done = 0;
        for seed in range {
            if done == SETS {
                break;
            }
            match row(seed)? {
                Some(line) => {
                    done += 1;
                    println!("{line}");
                }
                None => refused.push(seed.to_string()),
            }
        }
    }
    println!("# without a truth, because FE/contact refuses the set: seeds {}", refused.join(" "));
    Ok(())
}

/// `kept/auto_responses.csv`: transmission errors at rest, and amplitudes.
pub(super) fn remake_responses() -> Outcome {
    println!(
        "# What auto chose for transmission errors and amplitudes of drawn sets (docs/auto.md), error and cost."
    );
    println!(
        "# Own computation: validation/src/auto_response_record.rs; cost_ratio is a ratio of CPU times of one run"
    );
    println!(
        "# cargo run --release -p validation --example remake -- auto_responses > r.csv && mv r.csv kept/auto_responses.csv"
    );
    println!(
        "seed,planets,quantity,tolerance_percent,chosen,estimated_percent,value_um,truth_um,error_percent,\
         cheapest_within_tolerance,cost_ratio,miss"
    );
    // One thread, so that CPU times are those of the whole work.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    print_rows(seeds(&RESPONSE_SEEDS)?, &|seed| {
        let row = pool.install(|| response_row(seed))?;
        Ok((!row.truth_um.is_nan()).then(|| response_line(&row)))
    })
}

/// Tables of `docs/auto.md`.
pub(super) fn remake_tables() -> Outcome {
    let kept = concat!(env!("CARGO_MANIFEST_DIR"), "/../kept");
    let [frequencies, responses] = ["auto.csv", "auto_responses.csv"]
        .map(|name| std::fs::read_to_string(format!("{kept}/{name}")));
    let tables = auto_tables(&frequencies?, &responses?);
    print!(
        "{}",
        tables.ok_or("a line of kept/auto.csv or kept/auto_responses.csv is not of its form")?
    );
    Ok(())
}

fn number(x: Option<f64>, digits: usize) -> String {
    x.map_or(String::new(), |x| format!("{x:.digits$}"))
}

fn settings(s: Option<&experiments::auto::AutoSettings>, none: &str) -> String {
    s.map_or(none.to_owned(), |s| s.to_string().replace(',', ""))
}

fn response_line(row: &ResponseRow) -> String {
    let choice = row.found.as_ref().ok();
    [
        row.drawn.seed.to_string(),
        row.drawn.scene.planets.count().to_string(),
        row.asked.to_string().replace(',', ""),
        row.asked.tolerance_percent().to_string(),
        settings(choice.map(|c| &c.settings), "refused"),
        number(choice.map(|c| c.estimated_error_percent), 4),
        number(choice.map(|c| c.value), 6),
        format!("{:.6}", row.truth_um),
        number(row.error_percent(), 4),
        settings(row.cheapest.as_ref(), "none"),
        number(row.cost_ratio, 2),
        row.miss().unwrap_or("").to_owned(),
    ]
    .join(",")
}

pub(super) fn remake() -> Outcome {
    let seeds = seeds(std::slice::from_ref(&SEEDS))?;
    println!("# What auto chose on drawn sets (docs/auto.md), its true error and its cost.");
    println!(
        "# Own computation: validation/src/auto_record.rs; cost_ratio is a ratio of CPU times of one run"
    );
    println!(
        "# cargo run --release -p validation --example remake -- auto > auto.csv && mv auto.csv kept/"
    );
    println!(
        "seed,planets,quantity,tolerance_percent,chosen,estimated_percent,value_hz,truth_hz,error_percent,\
         cheapest_within_tolerance,cost_ratio,fe_cost_ratio,miss"
    );
    // One thread, so that CPU times are those of the whole work.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    print_rows(seeds, &|seed| {
        let row = pool.install(|| auto_row(seed))?;
        Ok((!row.truth_hz.is_nan()).then(|| line(&row)))
    })
}

fn line(row: &AutoRow) -> String {
    let request = &row.drawn.request;
    let choice = row.found.as_ref().ok();
    [
        row.drawn.seed.to_string(),
        row.drawn.scene.planets.count().to_string(),
        request.to_string(),
        request.tolerance_percent.to_string(),
        settings(choice.map(|c| &c.settings), "refused"),
        number(choice.map(|c| c.estimated_error_percent), 4),
        number(choice.map(|c| c.value), 4),
        format!("{:.4}", row.truth_hz),
        number(row.error_percent(), 4),
        settings(row.cheapest.as_ref(), "none"),
        number(row.cost_ratio, 2),
        number(row.fe_cost_ratio, 2),
        row.miss().unwrap_or("").to_owned(),
    ]
    .join(",")
}
