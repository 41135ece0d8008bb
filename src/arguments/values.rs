//! Values of the command line with their bounds.

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

pub(super) fn elements(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(x) if (1.0..=100.0).contains(&x) => Ok(x),
        _ => Err("a number from 1 to 100".into()),
    }
}

/// A whole number from `LOW` to `HIGH`.
pub(super) fn whole<const LOW: u32, const HIGH: u32>(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(n) if (LOW..=HIGH).contains(&n) => Ok(n),
        _ => Err(format!("a whole number from {LOW} to {HIGH}")),
    }
}

pub(super) fn two(text: &str) -> Result<[f64; 2], String> {
    let parts: Vec<Option<f64>> = text.split(':').map(|part| part.trim().parse().ok()).collect();
    match parts[..] {
        [Some(low), Some(high)] => Ok([low, high]),
        _ => Err("two frequencies as LOW:HIGH, in Hz".into()),
    }
}

pub(super) fn span(text: &str) -> Result<[f64; 2], String> {
    two(text).map_err(|_| "two numbers as FROM:TO".into())
}

pub(super) fn range(text: &str) -> Result<[f64; 3], String> {
    let parts: Vec<Option<f64>> = text.split(':').map(|part| part.trim().parse().ok()).collect();
    match parts[..] {
        [Some(from), Some(to), Some(step)] => Ok([from, to, step]),
        _ => Err("three numbers as FROM:TO:STEP, in rpm".into()),
    }
}

pub(super) fn small(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(x) if f64::is_finite(x) && (1e-12..=0.1).contains(&x) => Ok(x),
        _ => Err("a number from 1e-12 to 0.1".into()),
    }
}

/// Least and greatest factor on every damping of a scene: with a millionth of it a set is undamped for all purposes.
pub(crate) const DAMPING_FACTORS: [f64; 2] = [1e-6, 100.0];

pub(super) fn damping_factor(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(x) if (DAMPING_FACTORS[0]..=DAMPING_FACTORS[1]).contains(&x) => Ok(x),
        _ => Err("a number from 1e-6 to 100".into()),
    }
}

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

pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(x) if f64::is_finite(x) && x > 0.0 && x <= 100.0 => Ok(x),
        _ => Err("a number above 0, at most 100".into()),
    }
}
