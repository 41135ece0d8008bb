//! The key that an unknown one means: by its words and by what its unit measures, and by letters only within that.

use strsim::levenshtein;

/// Names in use elsewhere and the key here; where several fit, the first that the table has.
const ALIASES: [(&str, &str); 24] = [
    ("alpha", "mass_proportional_per_s"),
    ("alpha", "pressure_angle_deg"),
    ("alpha_deg", "pressure_angle_deg"),
    ("beta", "stiffness_proportional_s"),
    ("pinion", "sun"),
    ("wheel", "planet"),
    ("gear", "planet"),
    ("annulus", "ring"),
    ("arm", "carrier"),
    ("k_p", "bearing_n_per_m"),
    ("kp", "bearing_n_per_m"),
    ("k_sp", "sun_planet"),
    ("ksp", "sun_planet"),
    ("k_rp", "ring_planet"),
    ("krp", "ring_planet"),
    ("rpm", "speed_rpm"),
    ("e", "young_modulus_pa"),
    ("nu", "poisson_ratio"),
    ("rho", "density_kg_per_m3"),
    ("m", "module_mm"),
    ("b", "face_width_mm"),
    ("a", "center_distance_mm"),
    ("backlash_mm", "sun_planet_backlash_mm"),
    ("n_planets", "count"),
];

/// Units at the end of a key, longer ones first where one ends as another, and what they measure.
const UNITS: [(&str, &str); 44] = [
    ("nm_per_rad", "torsional stiffness"),
    ("nm_per_deg", "torsional stiffness"),
    ("n_per_mm", "stiffness"),
    ("n_per_um", "stiffness"),
    ("kn_per_m", "stiffness"),
    ("kn_per_mm", "stiffness"),
    ("mn_per_m", "stiffness"),
    ("n_per_m", "stiffness"),
    ("kg_per_m3", "density"),
    ("g_per_cm3", "density"),
    ("rad_per_s", "speed"),
    ("deg_per_s", "speed"),
    ("rpm", "speed"),
    ("rps", "speed"),
    ("per_s", "rate"),
    ("kg_m2", "inertia"),
    ("kg_mm2", "inertia"),
    ("kg_cm2", "inertia"),
    ("g_mm2", "inertia"),
    ("knm", "torque"),
    ("nmm", "torque"),
    ("nm", "torque"),
    ("kn", "force"),
    ("n", "force"),
    ("khz", "frequency"),
    ("hz", "frequency"),
    ("mm", "length"),
    ("um", "length"),
    ("cm", "length"),
    ("m", "length"),
    ("in", "length"),
    ("inch", "length"),
    ("deg", "angle"),
    ("rad", "angle"),
    ("kg", "mass"),
    ("g", "mass"),
    ("t", "mass"),
    ("gpa", "pressure"),
    ("mpa", "pressure"),
    ("pa", "pressure"),
    ("ms", "time"),
    ("us", "time"),
    ("s", "time"),
    ("percent", "part"),
];

/// Words that say what the unit says, or nothing.
const IDLE: [&str; 7] = ["stiffness", "the", "of", "value", "total", "gear", "rate"];

/// Words of the trade and the word that keys here have.
const WORDS: [(&str, &str); 19] = [
    ("centre", "center"),
    ("outside", "tip"),
    ("addendum", "tip"),
    ("dedendum", "root"),
    ("youngs", "young"),
    ("elastic", "young"),
    ("axis", "center"),
    ("moment", "torque"),
    ("facewidth", "width"),
    ("breadth", "width"),
    ("teeth", "tooth"),
    ("number", "count"),
    ("num", "count"),
    ("n", "count"),
    ("steps", "step"),
    ("angular", ""),
    ("type", "kind"),
    ("radius", "diameter"),
    ("dia", "diameter"),
];

/// The words of a key and its unit with what that measures.
struct Meaning {
    words: Vec<String>,
    stem: String,
    unit: Option<(&'static str, &'static str)>,
}

impl Meaning {
    fn of(key: &str) -> Self {
        let key = key.to_ascii_lowercase();
        let is_unit = |(unit, _): &&(&str, &str)| {
            key.strip_suffix(unit).is_some_and(|stem| stem.ends_with('_'))
        };
        let unit = UNITS.iter().filter(is_unit).max_by_key(|(unit, _)| unit.len()).copied();
        let stem = unit.map_or(key.as_str(), |(unit, _)| &key[..key.len() - unit.len() - 1]);
        let word = |word: &str| {
            let known = WORDS.iter().find(|(other, _)| *other == word);
            known.map_or(word, |(_, word)| word).to_owned()
        };
        let words = stem.split(['_', '-']).filter(|word| !IDLE.contains(word)).map(word);
        let mut words: Vec<String> = words.filter(|word| !word.is_empty()).collect();
        words.sort();
        Self { words, stem: stem.to_owned(), unit }
    }

    fn measures(&self) -> Option<&'static str> {
        self.unit.map(|(_, quantity)| quantity)
    }
}

/// The known key that an unknown one means, and what differs beside the spelling.
pub(crate) fn nearest<'k>(key: &str, known: &[&'k str]) -> Option<(&'k str, &'static str)> {
    let lower = key.to_ascii_lowercase();
    let mut aliases = ALIASES.iter().filter(|(other, _)| *other == lower);
    let alias = aliases.find_map(|(_, meant)| known.iter().find(|known| *known == meant));
    if let Some(alias) = alias {
        return Some((alias, ""));
    }
    let asked = Meaning::of(key);
    let distance = |other: &Meaning| {
        if asked.words == other.words {
            return Some(0);
        }
        let letters = levenshtein(&asked.stem, &other.stem);
        (letters <= 1 + asked.stem.len() / 3).then_some(1 + letters)
    };
    let fits = |candidate: &'k str| {
        let other = Meaning::of(candidate);
        let same = match (asked.measures(), other.measures()) {
            (Some(a), Some(b)) => a == b,
            // A unit is easily left out, or misspelt with the rest.
            _ => true,
        };
        let distance = distance(&other).filter(|_| same).or_else(|| {
            let letters = levenshtein(candidate, key);
            (same && letters <= 1 + key.len() / 3).then_some(1 + letters)
        })?;
        Some((distance, candidate, difference(&asked, &other)))
    };
    let best = known.iter().filter_map(|candidate| fits(candidate)).min_by_key(|(d, ..)| *d);
    let parts = with_these_words(&asked, known);
    match (best, &parts[..]) {
        (Some((0, key, difference)), _) => Some((key, difference)),
        // Of several diameters none is meant.
        (_, [_, _, ..]) => None,
        (Some((_, key, difference)), _) => Some((key, difference)),
        (None, [one]) => Some((one, difference(&asked, &Meaning::of(one)))),
        (None, []) => None,
    }
}

/// The known keys of the same quantity that have all words of the key asked for, or of which it has all.
fn with_these_words<'k>(asked: &Meaning, known: &[&'k str]) -> Vec<&'k str> {
    let is_part = |a: &Meaning, b: &Meaning| {
        !a.words.is_empty() && a.words.iter().all(|word| b.words.contains(word))
    };
    let is_near = |candidate: &&'k str| {
        let other = Meaning::of(candidate);
        asked.measures() == other.measures() && (is_part(asked, &other) || is_part(&other, asked))
    };
    let mut found: Vec<&str> = known.iter().copied().filter(is_near).collect();
    found.sort_unstable();
    found.dedup();
    found
}

fn difference(asked: &Meaning, other: &Meaning) -> &'static str {
    let has = |meaning: &Meaning, word: &str| meaning.stem.split('_').any(|w| w == word);
    if has(asked, "radius") && has(other, "diameter") {
        return ", which is twice the radius";
    }
    if has(asked, "diameter") && has(other, "radius") {
        return ", which is half the diameter";
    }
    match (asked.unit, other.unit) {
        (Some((a, _)), Some((b, _))) if a != b => ", in another unit",
        _ => "",
    }
}
