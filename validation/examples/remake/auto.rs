//! Choices of `auto` on drawn scenes, their true errors and costs: `kept/auto.csv`. An hour on one core.
//!
//! `cargo run --release -p validation --example remake -- auto > auto.csv && mv auto.csv kept/`
//!
//! `AUTO_SEEDS=1..9` runs other seeds: those of the record served no other purpose. 1 to 249 were used when the estimates were
//! programmed, and 1001 to 1073, 5001 to 5066, 17001 to 17068 and 18001 to 18166 are those of earlier records, whose misses were
//! read before inertia was added to frequencies.

use validation::{
    Asked, AutoRow, ResponseRow, auto_row, auto_tables, drawn_response, response_row,
};

use super::Outcome;

/// Seeds of the record, and how many sets it holds: those that FE/contact refuses have no truth and are left out.
const SEEDS: std::ops::Range<u64> = 18201..19001;
const SETS: usize = 60;

/// Seeds of the record of transmission errors at rest, and of that of amplitudes: each has what is asked of its kind. Lower ones were read
/// while `auto` was made cheaper, those at rest up to 19980 and those of amplitudes up to 24100 and from 26001 to 26180; these by nobody before the record was made.
const SEEDS_AT_REST: std::ops::Range<u64> = 26001..26181;
const SEEDS_IN_MOTION: std::ops::Range<u64> = 25001..25101;

/// Seeds that `AUTO_SEEDS` asks for, if it is set.
fn asked_seeds() -> Result<Option<std::ops::Range<u64>>, Box<dyn std::error::Error + Send + Sync>> {
    let Ok(text) = std::env::var("AUTO_SEEDS") else { return Ok(None) };
    let (from, to) = text.split_once("..").ok_or("AUTO_SEEDS is not of the form 1..9")?;
    Ok(Some(from.parse()?..to.parse()?))
}

/// Prints the row of each seed that has a truth, up to `most`; then the seeds without a truth.
fn print_rows(
    seeds: impl Iterator<Item = u64> + Clone,
    most: usize,
    row: &dyn Fn(u64) -> Result<Row, experiments::ExperimentError>,
) -> Outcome {
    let (mut refused, mut done) = (Vec::new(), 0);
    // A process pays once for its first set, which would be a cost of what is run first.
    for seed in seeds.clone() {
        if !matches!(row(seed)?, Row::OtherKind) {
            break;
        }
    }
    for seed in seeds {
        if done == most {
            break;
        }
        match row(seed)? {
            Row::Line(line) => {
                done += 1;
                println!("{line}");
            }
            Row::NoTruth => refused.push(seed.to_string()),
            Row::OtherKind => {}
        }
    }
    println!("# without a truth, because FE/contact refuses the set: seeds {}", refused.join(" "));
    Ok(())
}

/// What a seed gives.
enum Row {
    Line(String),
    NoTruth,
    /// Something is asked of it that this part of the record is not about.
    OtherKind,
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
    let row = |seed: u64| {
        let row = pool.install(|| response_row(seed))?;
        let has_truth = !row.truth_um.is_nan();
        Ok(if has_truth { Row::Line(response_line(&row)) } else { Row::NoTruth })
    };
    let asked = asked_seeds()?;
    for (is_at_rest, seeds) in [(true, SEEDS_AT_REST), (false, SEEDS_IN_MOTION)] {
        print_rows(asked.clone().unwrap_or(seeds), usize::MAX, &|seed| {
            let (_, asked) = drawn_response(seed)?;
            match matches!(asked, Asked::Cycle(_)) == is_at_rest {
                true => row(seed),
                false => Ok(Row::OtherKind),
            }
        })?;
    }
    Ok(())
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
    let (seeds, most) = asked_seeds()?.map_or((SEEDS, SETS), |asked| (asked, usize::MAX));
    print_rows(seeds, most, &|seed| {
        let row = pool.install(|| auto_row(seed))?;
        Ok(if row.truth_hz.is_nan() { Row::NoTruth } else { Row::Line(line(&row)) })
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
