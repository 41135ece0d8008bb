//! What the points in a folder of a sweep were computed from, and how two such descriptions differ.

use experiments::sweep::{Plan, SteadyMethod};
use serde::{Deserialize, Serialize};

use super::result_folder::Manifest;

/// Format of the folder; another one is refused. 5: points say what shows that they attract.
pub(super) const FORMAT: u32 = 5;

/// Longest part of a line of the scene that a message repeats, characters.
const LONGEST: usize = 60;

/// What the points in a folder were computed from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct SweepManifest {
    /// Format of the folder.
    format: u32,
    /// Version of the program that computed the points.
    version: String,
    /// The scene file's text.
    scene: String,
    /// Name of the fidelity or model.
    fidelity: String,
    /// Torque on the sun, N m.
    sun_torque_nm: f64,
    /// Speeds by chain, and when a state counts as steady.
    pub(super) plan: Plan,
}

impl SweepManifest {
    /// Of this version of the program.
    pub(super) fn new(scene: String, fidelity: String, sun_torque_nm: f64, plan: Plan) -> Self {
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Self { format: FORMAT, version, scene, fidelity, sun_torque_nm, plan }
    }
}

impl Manifest for SweepManifest {
    fn difference(&self, text: &str) -> Option<String> {
        let Ok(value) = serde_json::from_str::<serde_json::Value>(text) else {
            return Some("its manifest is no JSON".into());
        };
        if value.get("branches").is_some() {
            return Some("it is of branches, not of a sweep".into());
        }
        let format = value.get("format").and_then(serde_json::Value::as_u64);
        if format != Some(u64::from(FORMAT)) {
            let found = format.map_or("none".to_owned(), |f| f.to_string());
            return Some(format!("format {found} where this program writes {FORMAT}"));
        }
        let Ok(found) = serde_json::from_value::<Self>(value) else {
            return Some("its manifest lacks keys".into());
        };
        if found.version != self.version {
            return Some(format!("written by version {}, this is {}", found.version, self.version));
        }
        if found.scene != self.scene {
            return Some(of_scenes(&found.scene, &self.scene));
        }
        if found.fidelity != self.fidelity {
            let (found, own) = (found.fidelity, &self.fidelity);
            return Some(format!("of the model {found}, not {own} (argument --model)"));
        }
        if found.sun_torque_nm != self.sun_torque_nm {
            let (found, own) = (found.sun_torque_nm, self.sun_torque_nm);
            return Some(format!("under {found} N·m on the sun, not {own} N·m"));
        }
        of_plans(&found.plan, &self.plan)
    }
}

/// The first line in which the scene files differ.
pub(super) fn of_scenes(found: &str, own: &str) -> String {
    let shown = |line: Option<&str>| match line {
        Some(line) if line.chars().count() > LONGEST => {
            format!("`{}…`", line.chars().take(LONGEST).collect::<String>())
        }
        Some(line) => format!("`{line}`"),
        None => "absent".into(),
    };
    let (mut theirs, mut ours) = (found.lines(), own.lines());
    let mut number = 0;
    loop {
        number += 1;
        let (theirs, ours) = (theirs.next(), ours.next());
        if theirs != ours {
            return format!(
                "the scene file has another text: line {number} was {} and is {}",
                shown(theirs),
                shown(ours)
            );
        }
        if theirs.is_none() {
            return "the scene file has other ends of lines".into();
        }
    }
}

/// The first setting in which plans differ, by its argument.
fn of_plans(found: &Plan, own: &Plan) -> Option<String> {
    if found == own {
        return None;
    }
    let (theirs, ours) = (&found.steady, &own.steady);
    if theirs.method != ours.method {
        let name = |method: SteadyMethod| match method {
            SteadyMethod::Shooting => "shooting",
            SteadyMethod::Marching => "marching",
        };
        let (theirs, ours) = (name(theirs.method), name(ours.method));
        return Some(format!("computed with --method {theirs}, not {ours}"));
    }
    let settings = [
        ("--tolerance", theirs.tolerance, ours.tolerance),
        ("--most-cycles", theirs.most_cycles as f64, ours.most_cycles as f64),
        ("--harmonics", theirs.harmonics as f64, ours.harmonics as f64),
        ("--between-cycles", theirs.between_cycles as f64, ours.between_cycles as f64),
    ];
    if let Some((argument, theirs, ours)) = settings.into_iter().find(|(_, a, b)| a != b) {
        return Some(format!("computed with {argument} {theirs}, not {ours}"));
    }
    let ways = |plan: &Plan| plan.chains.iter().any(|chain| chain.name.starts_with("down"));
    if ways(found) != ways(own) {
        let with = |both: bool| if both { "with" } else { "without" };
        return Some(format!(
            "computed {} --both-ways, this is {} it",
            with(ways(found)),
            with(ways(own))
        ));
    }
    let speeds = |plan: &Plan| {
        let all = || plan.chains.iter().flat_map(|chain| &chain.speeds_rpm);
        let low = all().fold(f64::INFINITY, |a, b| a.min(*b));
        let high = all().fold(0.0f64, |a, b| a.max(*b));
        format!("{} speeds from {low} to {high} rpm", plan.points())
    };
    if speeds(found) != speeds(own) {
        return Some(format!("of {}, not {}", speeds(found), speeds(own)));
    }
    let mut each = found.chains.iter().zip(&own.chains).flat_map(|(a, b)| {
        let pairs = a.speeds_rpm.iter().zip(&b.speeds_rpm);
        pairs.map(|(theirs, ours)| (&a.name, theirs, ours))
    });
    Some(match each.find(|(_, theirs, ours)| theirs != ours) {
        Some((name, theirs, ours)) => {
            format!("of other speeds: {theirs} rpm in chain {name}, not {ours} rpm")
        }
        None => "of speeds in other chains".into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use experiments::sweep::{Direction, SteadySettings};

    fn manifest(
        scene: &str,
        directions: &[Direction],
        speeds: &[f64],
        harmonics: usize,
    ) -> SweepManifest {
        let steady = SteadySettings { harmonics, ..SteadySettings::default() };
        let plan = Plan::new(speeds, directions, steady).unwrap();
        SweepManifest::new(scene.into(), "quasi-static".into(), 1130.0, plan)
    }

    #[test]
    fn what_differs_is_named() {
        let (up, both) = ([Direction::Up], [Direction::Up, Direction::Down]);
        let own = manifest("a = 1\nb = 2\n", &up, &[100.0, 150.0, 200.0], 5);
        let of = |found: &SweepManifest| own.difference(&serde_json::to_string(found).unwrap());
        assert_eq!(of(&own), None);
        let speeds = [100.0, 150.0, 200.0];
        for (found, words) in [
            (manifest("a = 1\nb = 3\n", &up, &speeds, 5), "line 2 was `b = 3` and is `b = 2`"),
            (manifest("a = 1\n", &up, &speeds, 5), "line 2 was absent and is `b = 2`"),
            (manifest("a = 1\r\nb = 2\n", &up, &speeds, 5), "other ends of lines"),
            (manifest("a = 1\nb = 2\n", &up, &speeds, 4), "--harmonics 4, not 5"),
            (manifest("a = 1\nb = 2\n", &both, &speeds, 5), "computed with --both-ways"),
            (
                manifest("a = 1\nb = 2\n", &up, &[100.0], 5),
                "of 1 speeds from 100 to 100 rpm, not 3",
            ),
            (
                manifest("a = 1\nb = 2\n", &up, &[100.0, 160.0, 200.0], 5),
                "160 rpm in chain up_00, not 150",
            ),
            (
                SweepManifest { sun_torque_nm: 5.0, ..own.clone() },
                "under 5 N·m on the sun, not 1130",
            ),
            (SweepManifest { fidelity: "lumped".into(), ..own.clone() }, "the model lumped"),
            (SweepManifest { version: "0.0.0".into(), ..own.clone() }, "version 0.0.0"),
        ] {
            let reason = of(&found).unwrap();
            assert!(reason.contains(words), "{words}: {reason}");
        }
    }
}
