//! Values of the command line with their bounds.

use std::ops::RangeInclusive;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use experiments::branches::BranchParameter;
use experiments::stability::{MAPS, Map};
use experiments::sweep::VariedKey;

/// One of some words, each with its help and the value that it stands for.
pub(super) fn one_of<T, const N: usize>(
    words: [(&'static str, &'static str, T); N],
) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let shown = words.map(|(word, help, _)| PossibleValue::new(word).help(help));
    PossibleValuesParser::new(shown).try_map(move |name| {
        let found = words.iter().find(|(word, ..)| *word == name);
        found.map(|(.., value)| *value).ok_or("no such word")
    })
}

/// A stability map by its name.
pub(super) fn map() -> impl TypedValueParser<Value = &'static Map> {
    let value = |map: &'static Map| PossibleValue::new(map.name).help(map.about);
    PossibleValuesParser::new(MAPS.map(value)).try_map(|name| Map::named(&name).ok_or("no map"))
}

/// A number within bounds, which `allowed` says.
pub(super) fn number(
    bounds: RangeInclusive<f64>,
    allowed: &'static str,
) -> impl Fn(&str) -> Result<f64, &'static str> + Clone {
    move |text| text.parse().ok().filter(|x| bounds.contains(x)).ok_or(allowed)
}

/// So many numbers between colons, which `allowed` says.
pub(super) fn numbers<const N: usize>(
    allowed: &'static str,
) -> impl Fn(&str) -> Result<[f64; N], &'static str> + Clone {
    move |text| {
        let parts: Result<Vec<f64>, _> = text.split(':').map(|part| part.trim().parse()).collect();
        parts.ok().and_then(|parts| parts.try_into().ok()).ok_or(allowed)
    }
}

/// First, last and step of speeds, rpm; one alone is first and last.
pub(super) fn speeds(text: &str) -> Result<[f64; 3], &'static str> {
    match text.trim().parse::<f64>() {
        Ok(speed) => Ok([speed, speed, 1.0]),
        Err(_) => numbers("one speed, or three numbers as FROM:TO:STEP, in rpm")(text),
    }
}

/// A whole number from `LOW` to `HIGH`.
pub(super) fn whole<const LOW: u32, const HIGH: u32>(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(n) if (LOW..=HIGH).contains(&n) => Ok(n),
        _ => Err(format!("a whole number from {LOW} to {HIGH}")),
    }
}

/// Least and greatest factor on every damping of a scene: with a millionth of it a set is undamped for all purposes.
pub(crate) const DAMPING_FACTORS: RangeInclusive<f64> = 1e-6..=100.0;

/// What is varied along a branch: a word, or the path of a scene key.
pub(super) fn over(text: &str) -> Result<BranchParameter, String> {
    match text {
        "speed" => Ok(BranchParameter::Speed),
        "torque" => Ok(BranchParameter::Torque),
        "damping" => Ok(BranchParameter::Damping),
        path if path.contains('.') => {
            VariedKey::named(path).map(BranchParameter::Key).map_err(|e| e.to_string())
        }
        _ => Err("speed, torque, damping, or a scene key with its table".into()),
    }
}
