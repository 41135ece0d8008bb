//! What the steps in a folder of branches were computed from, and how two such descriptions differ; the folder itself.

use std::path::Path;

use experiments::branches::{BranchSettings, BranchStore, KeptPart, Search};
use experiments::sweep::StoreError;
use serde::{Deserialize, Serialize};

use crate::error::CommandError;

use super::branches_output::Fixed;
use super::kept_files::KeptFiles;
use super::result_folder::{Claim, Layout, Manifest, PLAN};
use super::sweep_manifest::of_scenes;

/// Format of the folder; another one is refused.
const FORMAT: u32 = 1;

/// Folder of finished steps.
const STEPS: &str = "steps";

/// Results that the end of a run writes: the tidy table, and everything.
pub(super) const RESULTS: [&str; 2] = ["branches.csv", "branches.json"];

/// What branches write.
const LAYOUT: Layout =
    Layout { run: "branches", results: &RESULTS, others: &[STEPS], lock: "branches.lock" };

/// What the steps in a folder were computed from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct BranchesManifest {
    /// Format of the folder.
    format: u32,
    /// Version of the program that computed the steps.
    version: String,
    /// The scene file's text.
    scene: String,
    /// Name of the fidelity or model.
    fidelity: String,
    /// Torque on the sun, N m; over torque, the one under which the model is set up.
    sun_torque_nm: f64,
    /// Speed of the input member, rpm; over speed, that of the scene.
    speed_rpm: f64,
    /// Factor on every damping of the scene.
    damping_factor: f64,
    /// Parameter, range, first point and steps.
    branches: BranchSettings,
    /// Which branches are looked for beside the first one.
    search: Search,
}

impl BranchesManifest {
    /// Of this version of the program.
    pub(super) fn new(
        scene: String,
        fidelity: String,
        fixed: &Fixed,
        branches: BranchSettings,
        search: Search,
    ) -> Self {
        Self {
            format: FORMAT,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scene,
            fidelity,
            sun_torque_nm: fixed.case.sun_torque_nm,
            speed_rpm: fixed.case.speed_rpm,
            damping_factor: fixed.damping_factor,
            branches,
            search,
        }
    }

    /// Takes a folder for these branches: a claim, which must be held as long as the store is used.
    ///
    /// # Errors
    /// If the folder is of something else or cannot be written.
    pub(super) fn open(&self, folder: &Path) -> Result<(Claim, Steps), CommandError> {
        let claim = Claim::of(folder, self, &LAYOUT, |_| Ok(()))?;
        let files = KeptFiles::open(folder, (PLAN, STEPS), self)?;
        Ok((claim, Steps(files)))
    }
}

impl Manifest for BranchesManifest {
    fn difference(&self, text: &str) -> Option<String> {
        let Ok(value) = serde_json::from_str::<serde_json::Value>(text) else {
            return Some("its manifest is no JSON".into());
        };
        if value.get("branches").is_none() {
            return Some("it is of a sweep or of something else, not of branches".into());
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
        let (theirs, ours) = (&found.branches, &self.branches);
        let with = |is: bool| if is { "with" } else { "without" }.to_owned();
        let numbers = |a: f64, b: f64| [format!("{a}"), format!("{b}")];
        let [low, high] = theirs.range;
        let [own_low, own_high] = ours.range;
        let list = [
            ("the model (--model)", [found.fidelity, self.fidelity.clone()]),
            ("--over", [theirs.over, ours.over].map(|over| over.argument().to_owned())),
            ("a range", [format!("{low}:{high}"), format!("{own_low}:{own_high}")]),
            ("--start", numbers(theirs.start, ours.start)),
            ("--sun-torque-nm", numbers(found.sun_torque_nm, self.sun_torque_nm)),
            ("--rpm", numbers(found.speed_rpm, self.speed_rpm)),
            ("--damping-factor", numbers(found.damping_factor, self.damping_factor)),
            ("--max-points", [theirs.most_points, ours.most_points].map(|n| n.to_string())),
            ("harmonics up to", [theirs.harmonics, ours.harmonics].map(|n| n.to_string())),
            ("steps of at most", numbers(theirs.longest_step, ours.longest_step)),
            ("--switch:", [found.search.switch, self.search.switch].map(with)),
        ];
        let differs = list.into_iter().find(|(_, [theirs, ours])| theirs != ours);
        differs.map(|(what, [theirs, ours])| format!("computed with {what} {theirs}, not {ours}"))
    }
}

/// Finished steps in a folder.
#[derive(Debug)]
pub(super) struct Steps(KeptFiles);

impl BranchStore for Steps {
    fn load(&self, place: &str, number: usize) -> Result<Option<KeptPart>, StoreError> {
        self.0.load(place, number)
    }

    fn save(&self, place: &str, number: usize, part: &KeptPart) -> Result<(), StoreError> {
        self.0.save(place, number, part)
    }
}

#[cfg(test)]
mod tests {
    use experiments::branches::BranchParameter;
    use scene::LoadCase;

    use super::*;

    #[test]
    fn what_differs_is_named() {
        let settings = BranchSettings::over([100.0, 200.0]);
        let fixed = Fixed { case: LoadCase::turning(50.0, 150.0, 60.0), damping_factor: 1.0 };
        let (scene, name) = ("a = 1\nb = 2\n".to_owned(), "lumped".to_owned());
        let own = BranchesManifest::new(scene, name, &fixed, settings.clone(), Search::default());
        let of = |found: &BranchesManifest| own.difference(&serde_json::to_string(found).unwrap());
        assert_eq!(of(&own), None);
        let with = |branches| BranchesManifest { branches, ..own.clone() };
        let over = BranchParameter::Torque;
        for (found, words) in [
            (BranchesManifest { scene: "a = 1\n".into(), ..own.clone() }, "line 2 was absent"),
            (
                BranchesManifest { fidelity: "mesh-law".into(), ..own.clone() },
                "mesh-law, not lumped",
            ),
            (BranchesManifest { sun_torque_nm: 5.0, ..own.clone() }, "--sun-torque-nm 5, not 50"),
            (BranchesManifest { speed_rpm: 5.0, ..own.clone() }, "--rpm 5, not 150"),
            (BranchesManifest { damping_factor: 2.0, ..own.clone() }, "--damping-factor 2, not 1"),
            (BranchesManifest { version: "0.0.0".into(), ..own.clone() }, "version 0.0.0"),
            (
                BranchesManifest { search: Search { switch: true }, ..own.clone() },
                "--switch: with, not without",
            ),
            (with(BranchSettings { over, ..settings.clone() }), "--over torque, not speed"),
            (with(BranchSettings { start: 120.0, ..settings.clone() }), "--start 120, not 150"),
            (
                with(BranchSettings { range: [100.0, 250.0], ..settings.clone() }),
                "a range 100:250, not 100:200",
            ),
            (
                with(BranchSettings { most_points: 7, ..settings.clone() }),
                "--max-points 7, not 500",
            ),
        ] {
            let reason = of(&found).unwrap();
            assert!(reason.contains(words), "{words}: {reason}");
        }
        let sweep = own.difference("{\"format\": 4, \"plan\": {}}").unwrap();
        assert!(sweep.contains("not of branches"), "{sweep}");
    }
}
