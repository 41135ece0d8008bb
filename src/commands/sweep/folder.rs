//! The folder of a sweep: what is in it, and whether that belongs to a sweep with this refinement.

use std::path::Path;

use experiments::sweep::Plan;
use scene::read_text;
use serde::Serialize;
use serde_json::Value;

use crate::error::Result;
use crate::folder::{Claim, MOST_BYTES, Manifest, RunKind, other_results};

/// Manifest of the speeds about peaks.
pub(super) const PEAKS: &str = "plan_peaks.json";

/// Sweeps, whose points say what shows that they attract (format 5).
static SWEEP: RunKind = RunKind {
    run: "a sweep",
    format: 5,
    key: "plan",
    settings: &[
        ("/plan/steady/method", "--method"),
        ("/plan/steady/tolerance", "--tolerance"),
        ("/plan/steady/most_cycles", "--most-cycles"),
        ("/plan/steady/harmonics", "--harmonics"),
        ("/plan/steady/between_cycles", "--between-cycles"),
        ("/plan/steady/whole_cycles", "--whole-cycles"),
    ],
    contents: speeds,
    results: &["sweep.csv", "sweep.json", "sweep.parquet"],
    others: &[PEAKS],
    parts: "points",
    lock: "sweep.lock",
};

/// Number and range of the speeds of a manifest's plan, and its chains.
fn speeds(manifest: &Value) -> String {
    let chains: Vec<&Value> = manifest["plan"]["chains"].as_array().into_iter().flatten().collect();
    let each = chains.iter().flat_map(|chain| chain["speeds_rpm"].as_array().into_iter().flatten());
    let all: Vec<f64> = each.filter_map(Value::as_f64).collect();
    let (low, high) = (all.iter().copied().reduce(f64::min), all.iter().copied().reduce(f64::max));
    let ways =
        match chains.iter().any(|c| c["name"].as_str().is_some_and(|n| n.starts_with("down"))) {
            true => " both ways (--both-ways)",
            false => "",
        };
    let [low, high] = [low, high].map(|end| end.unwrap_or(f64::NAN));
    format!("{} speeds from {low} to {high} rpm{ways}", all.len())
}

/// What the points of a plan are computed from.
pub(super) fn manifest(subject: (&str, &str, f64), plan: &Plan) -> Result<Manifest> {
    #[derive(Serialize)]
    struct Settings<'p> {
        plan: &'p Plan,
    }
    Manifest::new(&SWEEP, subject, &Settings { plan })
}

/// Takes a folder for a sweep. `refine`: speeds about each peak, 0 for none.
///
/// # Errors
/// As [`Claim::of`], or if the folder holds speeds about peaks of another refinement.
pub(super) fn claim(folder: &Path, wanted: &Manifest, refine: u32) -> Result<Claim> {
    Claim::of(folder, wanted, |folder| match refine {
        0 => Ok(()),
        refine => check_refinement(&folder.join(PEAKS), refine),
    })
}

/// Refuses speeds about peaks that an earlier run laid out for another number of them.
fn check_refinement(path: &Path, refine: u32) -> Result<()> {
    let Ok(text) = read_text(path, MOST_BYTES) else { return Ok(()) };
    let plan = serde_json::from_str::<Value>(&text).unwrap_or_default();
    let Some(chains) = plan.pointer("/plan/chains").and_then(Value::as_array) else {
        return Err(other_results(path.to_owned(), "it is not the manifest of a sweep"));
    };
    let found = chains.first().and_then(|chain| chain["speeds_rpm"].as_array()).map(Vec::len);
    match found {
        Some(found) if found != refine as usize => {
            let reason = format!("made with --refine {found}, not --refine {refine}");
            Err(other_results(path.to_owned(), &reason))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use experiments::sweep::{Direction, SteadySettings};

    const SPEEDS: [f64; 3] = [100.0, 150.0, 200.0];

    fn plan(directions: &[Direction], speeds: &[f64], harmonics: usize) -> Plan {
        let steady = SteadySettings { harmonics, ..SteadySettings::default() };
        Plan::new(speeds, directions, steady).unwrap()
    }

    #[test]
    fn what_differs_is_named() {
        let (up, both) = ([Direction::Up], [Direction::Up, Direction::Down]);
        let scene = "a = 1\nb = 2\n";
        let made =
            |scene, model, torque, plan: &Plan| manifest((scene, model, torque), plan).unwrap();
        let usual = plan(&up, &SPEEDS, 5);
        let wanted = made(scene, "quasi-static", 1130.0, &usual);
        let difference = |found: &Manifest| wanted.difference(&found.text);
        assert_eq!(difference(&made(scene, "quasi-static", 1130.0, &usual)), None);
        for (scene, words) in [
            ("a = 1\nb = 3\n", "line 2 was `b = 3` and is `b = 2`"),
            ("a = 1\n", "line 2 was absent and is `b = 2`"),
            ("a = 1\r\nb = 2\n", "other ends of lines"),
        ] {
            let reason = difference(&made(scene, "quasi-static", 1130.0, &usual)).unwrap();
            assert!(reason.contains(words), "{words}: {reason}");
        }
        for (plan, words) in [
            (plan(&up, &SPEEDS, 4), "computed with --harmonics 4, not 5"),
            (
                plan(&both, &SPEEDS, 5),
                "of 6 speeds from 100 to 200 rpm both ways (--both-ways), not 3",
            ),
            (plan(&up, &[100.0], 5), "of 1 speeds from 100 to 100 rpm, not 3"),
            (plan(&up, &[100.0, 160.0, 200.0], 5), "of other 3 speeds from 100 to 200 rpm"),
        ] {
            let reason = difference(&made(scene, "quasi-static", 1130.0, &plan)).unwrap();
            assert!(reason.contains(words), "{words}: {reason}");
        }
        let reason = difference(&made(scene, "quasi-static", 5.0, &usual)).unwrap();
        assert_eq!(reason, "computed with --sun-torque-nm 5, not 1130");
        let reason = difference(&made(scene, "lumped", 1130.0, &usual)).unwrap();
        assert_eq!(reason, "computed with the model (--model) lumped, not quasi-static");
        let older = wanted.text.replace(env!("CARGO_PKG_VERSION"), "0.0.0");
        assert!(wanted.difference(&older).unwrap().contains("version 0.0.0"));
        let other = wanted.difference("{\"branches\": {}}").unwrap();
        assert_eq!(other, "it is of something else, not of a sweep");
    }
}
