//! Makes `kept/parameter_bands.toml`: how far the parameters that the paper leaves open (tooth thickness,
//! fillets, pin seats, plane state) move tabled frequencies, masses and mesh stiffnesses.

use validation::Reference;

use self::study::study;

mod intervals;
mod study;

const COMMAND: &str =
    "cargo run --release -p remake -- parameter_bands > kept/parameter_bands.toml";

pub(crate) fn remake() -> crate::Outcome {
    let reference = Reference::load()?;
    let bands = study(&reference, COMMAND, &|parameter| eprintln!("{parameter}"))?;
    println!("# How far open parameters move what is held against the paper.");
    print!("{}", toml::to_string(&bands)?);
    for row in &bands.row {
        let [low, high] = row.band_percent;
        let [low_all, high_all] = row.band_with_state_percent;
        let off = 100.0 * (row.printed / row.ours - 1.0);
        let verdict = |holds: bool| if holds { "inside" } else { "outside" };
        eprintln!(
            "{:28} ours {:<12.6} printed {:<10} {off:+7.3} %  band {low:+.3} to {high:+.3} {:7}  with state {low_all:+.3} to {high_all:+.3} {}",
            row.id,
            row.ours,
            row.printed,
            verdict(row.holds()),
            verdict(row.holds_with_state()),
        );
    }
    Ok(())
}
