//! A results folder that is ready to be filled.

use std::fmt::Write;

use experiments::sweep::Part;
use scene::{LoadCase, Scene, excitation_of_scene};

use super::scene_file::SceneFile;
use crate::catalogue::{PublishedScene, scene};
use crate::error::ValidationError;
use crate::model_kind::ModelKind;
use crate::registry::Registry;
use crate::results::known_scenes::KnownScenes;
use crate::results::manifest::{ORDER, POSITIONS};
use crate::suites::fe::torque::TORQUES;
use crate::suites::pair_stiffness::has_geometry;
use crate::suites::{ASKABLE, Askable, AskedCycle, Question};

/// Files of a folder whose tables have every row that suites ask for and no values.
#[derive(Debug, Clone, PartialEq)]
pub struct Template {
    /// Name and content of each file.
    pub files: Vec<(String, String)>,
    /// Suites that ask about the scenes, each once.
    pub suites: Vec<&'static str>,
}

impl Template {
    /// For results about some scenes from a kind of model: the tables for which suites of that kind ask; of a test rig,
    /// which no suite judges, those of every kind. Scenes of which nothing is asked are left out: where that is all of
    /// them, there is no suite and no table.
    ///
    /// # Errors
    /// If the registry or a scene of the catalogue cannot be used: a defect of the program.
    pub fn new(scenes: &[SceneFile], kind: ModelKind) -> Result<Self, ValidationError> {
        let judging = (kind != ModelKind::Measured).then_some(kind);
        let all = askable(judging)?;
        let registry = Registry::load()?;
        let judges = |suite: &str| {
            let mut named = registry.suite.iter().filter(|entry| entry.name == suite);
            judging.is_none_or(|kind| named.any(|entry| entry.models.contains(&kind)))
        };
        let mut tables = Tables::default();
        let mut suites: Vec<&'static str> = Vec::new();
        let mut asked = Vec::new();
        for file in scenes {
            let before = suites.len();
            let of_scene = all.iter().filter(|(_, asked)| asked.contains(&file.scene.title));
            for (askable, _) in of_scene {
                tables.ask(file, &askable.question);
                suites.push(askable.suite);
            }
            for suite in ANY_SCENE.into_iter().filter(|suite| judges(suite)) {
                suites.extend(tables.ask_of_any_scene(file, suite).then_some(suite));
            }
            asked.extend((suites.len() > before).then(|| file.clone()));
        }
        let scenes = asked;
        let mut seen = Vec::new();
        suites.retain(|suite| {
            !seen.contains(suite) && {
                seen.push(suite);
                true
            }
        });
        let mut files = vec![("results.toml".to_owned(), manifest(&scenes, kind))];
        let mut beside = scenes;
        beside.extend(tables.variants.iter().cloned());
        files.extend(beside.iter().map(|file| (format!("{}.toml", file.id), file.text.clone())));
        files.extend(tables.files());
        files.push(("README.txt".to_owned(), README.to_owned()));
        Ok(Self { files, suites })
    }
}

impl SceneFile {
    /// All scenes that suites of a kind of model ask about; if there are none, those of every kind.
    ///
    /// # Errors
    /// As [`Template::new`].
    pub fn asked_about(kind: ModelKind) -> Result<Vec<Self>, ValidationError> {
        let of_kind = askable(Some(kind))?;
        // Of rotations alone and of rigs no suite asks by the name of a scene.
        let all = if of_kind.is_empty() { askable(None)? } else { of_kind };
        let is_asked = |title: &String| all.iter().any(|(_, titles)| titles.contains(title));
        let known = KnownScenes::shipped();
        Ok(known.iter().filter(|k| is_asked(&k.scene.title)).map(|k| Self::of_known(k)).collect())
    }
}

/// Suites that judge a kind of model, or all, with the titles of the scenes that they ask about.
fn askable(kind: Option<ModelKind>) -> Result<Vec<(Askable, Vec<String>)>, ValidationError> {
    let registry = Registry::load()?;
    let judges = |askable: &Askable| {
        let mut suites = registry.suite.iter().filter(|suite| suite.name == askable.suite);
        kind.is_none_or(|kind| suites.any(|suite| suite.models.contains(&kind)))
    };
    let titles = |askable: Askable| {
        let title = |which: &PublishedScene| scene(*which).map(|scene| scene.title);
        let titles = askable.question.scenes().iter().map(title).collect::<Result<Vec<_>, _>>();
        Ok((askable, titles?))
    };
    ASKABLE.into_iter().filter(judges).map(titles).collect()
}

/// Suites that ask about every scene that has what they need.
const ANY_SCENE: [&str; 3] = ["lumped_model", "rules", "pair_stiffness"];

/// Harmonics of the mesh frequency for which rules are asked.
const HARMONICS: usize = 10;

/// What is asked for, table by table.
#[derive(Default)]
struct Tables {
    /// Ids of scenes.
    modes: Vec<String>,
    cycles: Vec<Cycle>,
    stiffness: Vec<Cycle>,
    /// Ids of scenes.
    peaks: Vec<String>,
    /// Ids of scenes with numbers of teeth.
    rules: Vec<String>,
    /// Ids of scenes.
    steady_states: Vec<String>,
    /// Variants of the scenes.
    variants: Vec<SceneFile>,
}

/// A mesh cycle of `planets` planets.
#[derive(PartialEq)]
struct Cycle {
    /// Of the scene.
    id: String,
    planets: usize,
    sun_torque_nm: f64,
    positions: usize,
}

/// Adds an entry that is not there yet.
fn once<T: PartialEq>(list: &mut Vec<T>, entry: T) {
    if !list.contains(&entry) {
        list.push(entry);
    }
}

impl Tables {
    fn ask(&mut self, file: &SceneFile, question: &Question) {
        match question {
            Question::Modes(..) => once(&mut self.modes, file.id.clone()),
            Question::SteadyStates(..) => once(&mut self.steady_states, file.id.clone()),
            Question::MeshStiffness(.., (sun_torque_nm, positions)) => {
                let (id, planets) = (file.id.clone(), file.scene.planets.count());
                let (sun_torque_nm, positions) = (*sun_torque_nm, *positions);
                once(&mut self.stiffness, Cycle { id, planets, sun_torque_nm, positions });
            }
            Question::TorquePeaks(..) => once(&mut self.peaks, file.id.clone()),
            Question::MeshCycle(_, _, cycles) => {
                for AskedCycle { set, sun_torque_nm, positions } in cycles(&file.scene) {
                    let (id, planets) = (self.id(file, &set), set.planets.count());
                    once(&mut self.cycles, Cycle { id, planets, sun_torque_nm, positions });
                }
            }
        }
    }

    /// Asks for the table of a suite about every scene, if the scene has what it needs.
    fn ask_of_any_scene(&mut self, file: &SceneFile, suite: &str) -> bool {
        let (id, scene) = (file.id.clone(), &file.scene);
        match suite {
            "lumped_model" if scene.lumped.is_some() => once(&mut self.modes, id),
            "rules" if excitation_of_scene(scene, 1).is_some() => once(&mut self.rules, id),
            "pair_stiffness" if has_geometry(scene) => {
                let case = LoadCase::of_scene(scene).ok().filter(|case| case.sun_torque_nm != 0.0);
                let Some(LoadCase { sun_torque_nm, .. }) = case else { return false };
                let (planets, positions) = (scene.planets.count(), POSITIONS);
                once(&mut self.stiffness, Cycle { id, planets, sun_torque_nm, positions });
            }
            _ => return false,
        }
        true
    }

    /// Id of a scene or of its variant, whose file is kept.
    fn id(&mut self, file: &SceneFile, set: &Scene) -> String {
        match SceneFile::shipped(&set.title) {
            Ok(variant) if set.title != file.scene.title => {
                let id = variant.id.clone();
                once(&mut self.variants, variant);
                id
            }
            _ => file.id.clone(),
        }
    }

    fn files(&self) -> Vec<(String, String)> {
        let mut files = Vec::new();
        let mut file = |name: &str, titles: &str, rows: String| {
            if !rows.is_empty() {
                files.push((name.to_owned(), format!("{titles}\n{rows}")));
            }
        };
        let rows = |ids: &[String], cells: &str| -> String {
            ids.iter().map(|id| format!("{}{cells}\n", quoted(id))).collect()
        };
        file("modes.csv", "scene,frequency_hz,mode_type,multiplicity", rows(&self.modes, ",,,"));
        let titles = "scene,sun_torque_nm,position,body,coordinate,value";
        file("mesh_cycle.csv", titles, self.cycles.iter().map(Cycle::rows).collect());
        let titles = "scene,sun_torque_nm,body,position,stiffness_n_per_m";
        file(
            "mesh_stiffness.csv",
            titles,
            self.stiffness.iter().map(Cycle::stiffness_rows).collect(),
        );
        let titles = "scene,sun_torque_nm,body,coordinate,harmonic,frequency_hz,amplitude";
        file("torque_peaks.csv", titles, self.peaks.iter().map(|id| peak_rows(id)).collect());
        let rules = self
            .rules
            .iter()
            .flat_map(|id| (1..=HARMONICS).map(|harmonic| format!("{},{harmonic},\n", quoted(id))));
        file("rules.csv", "scene,harmonic,excites", rules.collect());
        let titles = "scene,sun_torque_nm,speed_rpm,mesh_frequency_hz,body,coordinate,harmonic,amplitude,phase_rad,\
                      sun_turns";
        file("steady_states.csv", titles, rows(&self.steady_states, ",,,,,,,,,"));
        files
    }
}

/// A cell of text.
fn quoted(text: &str) -> String {
    match text.contains([',', '"', ';', '\t', '#']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

impl Cycle {
    /// Rows without values.
    fn rows(&self) -> String {
        let Self { id, planets, sun_torque_nm, positions } = self;
        let axes = ["x", "y", "rotation"].map(|axis| (Part::SUN, axis));
        let meshes = [Part::SunMesh as fn(usize) -> Part, Part::RingMesh];
        let forces = |mesh: fn(usize) -> Part| (0..*planets).map(move |n| (mesh(n), "force"));
        let quantities: Vec<_> =
            axes.into_iter().chain(meshes.into_iter().flat_map(forces)).collect();
        let mut rows = String::new();
        for k in 0..*positions {
            let position = k as f64 / *positions as f64;
            for (part, coordinate) in &quantities {
                let (id, name) = (quoted(id), part.name());
                // Writing to a text cannot fail.
                let _ = writeln!(rows, "{id},{sun_torque_nm},{position},{name},{coordinate},");
            }
        }
        rows
    }

    /// Rows of mesh stiffness without values.
    fn stiffness_rows(&self) -> String {
        let Self { id, sun_torque_nm, positions, .. } = self;
        let mut rows = String::new();
        for mesh in ["sun_mesh_0", "ring_mesh_0"] {
            for position in (0..*positions).map(|k| k as f64 / *positions as f64) {
                let _ = writeln!(rows, "{},{sun_torque_nm},{mesh},{position},", quoted(id));
            }
        }
        rows
    }
}

/// Rows of the resonant peaks of the sun and planet 0 that suites ask for, without values.
fn peak_rows(id: &str) -> String {
    let mut rows = String::new();
    for (sun_torque_nm, body) in TORQUES.iter().flat_map(|t| [(t, "sun"), (t, "planet_0")]) {
        for (coordinate, harmonic) in [
            ("translation", 1),
            ("translation", 3),
            ("rotation", 2),
            ("rotation", 4),
            ("translation", 3),
            ("translation", 5),
        ] {
            // Writing to a text cannot fail.
            let _ =
                writeln!(rows, "{},{sun_torque_nm},{body},{coordinate},{harmonic},,", quoted(id));
        }
    }
    rows
}

/// `results.toml` with every key.
fn manifest(scenes: &[SceneFile], kind: ModelKind) -> String {
    let kinds = ModelKind::ALL.map(ModelKind::name).join(", ");
    let scene = match scenes {
        [one] => format!("scene = {}", toml::Value::from(one.id.as_str())),
        _ => "# scene = \"oh58_4p\"".to_owned(),
    };
    let order = ORDER.map(|body| format!("\"{body}\"")).join(", ");
    format!(
        r#"# Where these results come from, and how their numbers are to be read (docs/results.md).
format = 1
kind = "{}"   # of model: {kinds}
program = "my program"
version = "0"
# The scene of rows whose cell `scene` is empty or absent: an id, that is, the name of a scene file without `.toml`.
{scene}
# Members held in the model beside those that the scene holds: sun, ring, carrier.
# held = ["ring"]
# Least number of positions in a mesh cycle.
# positions = {POSITIONS}

# Of vectors in modes.csv and of matrices/ID.M.mtx and matrices/ID.K.mtx; these are the defaults.
[convention]
order = [{order}]
planets = "radial_tangential" # translations of planets; or "x_y"
rotation = "arc"              # u = r θ; or "angle", θ
radius = "base"               # r of u = r θ, of the carrier the centre distance; or "pitch"
sense = "counter_clockwise"   # positive rotation; or "clockwise"
"#,
        kind.name()
    )
}

const README: &str = "\
Results of a model of planetary gears, to be filled in and judged.

1. Say in results.toml which program computed them, and with which kind of model.
2. Compute the scenes (*.toml) and fill in the tables (*.csv). Rows of modes.csv and steady_states.csv are examples:
   write a row for each natural frequency, and one for each speed, quantity and harmonic. The other tables have every
   row that is asked for. Delete rows and tables that your model cannot give. An empty cell of a number is refused.
3. epicyclic results check .        what is there, what can be asked, what is lacking
   epicyclic validate --recorded .  the verdict

Units are in the titles; of `value` and `amplitude` they are m, rad and N. The scenes *_mirrored and *_renumbered are
variants of a set that must give the same results seen in a mirror, and with planets numbered in another order.
Columns, signs and a complete example: docs/results.md.
";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::ResultsFolder;
    use std::path::Path;

    fn written(template: &Template) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in &template.files {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        folder
    }

    fn refusal(folder: &Path) -> String {
        let refusal = ResultsFolder::read(folder).unwrap_err().to_string();
        refusal.replace(&format!("{}/", folder.display()), "")
    }

    #[test]
    fn nothing_passes_before_it_is_filled() {
        for kind in ModelKind::ALL {
            for file in SceneFile::asked_about(kind).unwrap() {
                let template = Template::new(std::slice::from_ref(&file), kind).unwrap();
                let message = refusal(written(&template).path());
                let is_placed =
                    message.contains(".csv:2: column `") && message.contains("is empty");
                assert!(is_placed, "{} {}: {message}", kind.name(), file.id);
            }
        }
    }

    #[test]
    fn a_filled_mesh_cycle_is_all_that_its_suite_asks_for() {
        let file = SceneFile::shipped("oh58_4p").unwrap();
        let template = Template::new(&[file], ModelKind::Lumped).unwrap();
        assert!(template.suites.contains(&"fe.sets") && !template.suites.contains(&"fe.fig12"));
        let folder = written(&template);
        for name in ["modes.csv", "steady_states.csv", "rules.csv"] {
            std::fs::remove_file(folder.path().join(name)).unwrap();
        }
        assert!(refusal(folder.path()).starts_with("mesh_cycle.csv:2: column `value` is empty"));
        // Equal forces that carry the torque, and a sun that turns.
        let force = 1413.0 / (4.0 * 0.5 * 0.09126 * 27.0 / 35.0);
        let path = folder.path().join("mesh_cycle.csv");
        let filled = std::fs::read_to_string(&path).unwrap();
        let value = |line: &str| match line {
            _ if line.ends_with("force,") => format!("{line}{force}\n"),
            _ if line.contains("_mirrored") && line.ends_with("rotation,") => {
                format!("{line}-1e-3\n")
            }
            _ if line.ends_with("rotation,") => format!("{line}1e-3\n"),
            _ if line.ends_with("x,") || line.ends_with("y,") => format!("{line}0\n"),
            _ => format!("{line}\n"),
        };
        let filled: String = filled.lines().map(value).collect();
        std::fs::write(&path, filled).unwrap();
        let read = ResultsFolder::read(folder.path()).unwrap();
        assert_eq!(read.mesh_cycle.len(), 3 * POSITIONS * 11);
        let questions = read.questions(None).unwrap();
        let asked: Vec<&str> = questions.asked.iter().map(|suite| suite.suite.as_str()).collect();
        assert_eq!(asked, ["fe.sets"]);
        assert_eq!((questions.asked[0].checks, questions.asked[0].judged), (3, true));
        assert!(questions.not_asked.iter().any(|suite| suite.suite == "table3.lumped"));
    }

    #[test]
    fn variants_are_read_as_the_sets_that_suites_ask_for() {
        for id in ["oh58_4p_mirrored", "oh58_4p_renumbered"] {
            let file = SceneFile::shipped(id).unwrap();
            let read = Scene::from_toml(&file.text).unwrap();
            assert_eq!(read.title, file.scene.title);
            assert_eq!(read.planets, file.scene.planets);
        }
    }

    #[test]
    fn only_tables_that_a_suite_of_the_kind_judges_are_written() {
        use ModelKind::{FeContact, Lumped, Torsional};
        let tables = |id: &str, kind| {
            let file = SceneFile::shipped(id).unwrap();
            let Template { files, suites } = Template::new(&[file], kind).unwrap();
            let names = files.into_iter().map(|(name, _)| name);
            (names.filter(|name| name.ends_with(".csv")).collect::<Vec<_>>(), suites)
        };
        for (id, kind, names, suites) in [
            (
                "coinciding_modes",
                Lumped,
                &["modes.csv", "rules.csv"][..],
                &["lumped_model", "rules"][..],
            ),
            ("oh58_4p", Torsional, &["modes.csv", "rules.csv"], &["lumped_model", "rules"]),
            (
                "wind_turbine_stage",
                FeContact,
                &["mesh_stiffness.csv", "rules.csv"],
                &["rules", "pair_stiffness"],
            ),
            (
                "oh58_4p_second_system",
                FeContact,
                &["mesh_stiffness.csv", "torque_peaks.csv", "rules.csv"],
                &["torque", "rules", "pair_stiffness"],
            ),
            ("lin_parker_1999_3p", FeContact, &[], &[]),
            ("lin_parker_1999_3p", Torsional, &["modes.csv"], &["lumped_model"]),
        ] {
            let (found, asking) = tables(id, kind);
            assert_eq!(
                (found.iter().map(String::as_str).collect::<Vec<_>>(), asking.as_slice()),
                (names.to_vec(), suites),
                "{id}"
            );
        }
        let (measured, _) = tables("oh58_3p", ModelKind::Measured);
        assert!(measured.len() >= 5, "{measured:?}");
    }
}
