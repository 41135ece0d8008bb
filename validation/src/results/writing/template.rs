//! A results folder that is ready to be filled.

use std::fmt::Write;

use experiments::sweep::Part;
use scene::Scene;

use super::scene_file::SceneFile;
use crate::catalogue::{PublishedScene, scene};
use crate::error::ValidationError;
use crate::model_kind::ModelKind;
use crate::registry::Registry;
use crate::results::known_scenes::KnownScenes;
use crate::results::manifest::{ORDER, POSITIONS};
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
    /// For results about some scenes from a kind of model: the tables for which the suites of that kind ask, or, if
    /// there are none, those of every kind. Where no suite asks, the table of natural frequencies alone.
    ///
    /// # Errors
    /// If the registry or a scene of the catalogue cannot be used: a defect of the program.
    pub fn new(scenes: &[SceneFile], kind: ModelKind) -> Result<Self, ValidationError> {
        let of_kind = askable(Some(kind))?;
        let all = if of_kind.is_empty() { askable(None)? } else { of_kind };
        let mut tables = Tables::default();
        let mut suites: Vec<&'static str> = Vec::new();
        for file in scenes {
            let of_scene = all.iter().filter(|(_, asked)| asked.contains(&file.scene.title));
            for (askable, _) in of_scene {
                tables.ask(file, &askable.question);
                suites.push(askable.suite);
            }
        }
        let mut seen = Vec::new();
        suites.retain(|suite| {
            !seen.contains(suite) && {
                seen.push(suite);
                true
            }
        });
        if suites.is_empty() {
            tables.modes.extend(scenes.iter().map(|file| file.id.clone()));
        }
        let mut files = vec![("results.toml".to_owned(), manifest(scenes, kind))];
        let mut beside = scenes.to_vec();
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

/// What is asked for, table by table.
#[derive(Default)]
struct Tables {
    /// Ids of scenes.
    modes: Vec<String>,
    cycles: Vec<Cycle>,
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
            Question::MeshCycle(_, _, cycles) => {
                for AskedCycle { set, sun_torque_nm, positions } in cycles(&file.scene) {
                    let (id, planets) = (self.id(file, &set), set.planets.count());
                    once(&mut self.cycles, Cycle { id, planets, sun_torque_nm, positions });
                }
            }
        }
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
   write a row for each natural frequency, and one for each speed, quantity and harmonic. mesh_cycle.csv has every row
   that is asked for. Delete rows and tables that your model cannot give. An empty cell of a number is refused.
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
        for name in ["modes.csv", "steady_states.csv"] {
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
    fn a_scene_that_no_suite_asks_about_has_the_table_of_frequencies() {
        let file = SceneFile::shipped("coinciding_modes").unwrap();
        let template = Template::new(&[file], ModelKind::Lumped).unwrap();
        assert!(template.suites.is_empty());
        let names: Vec<&str> = template.files.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["results.toml", "coinciding_modes.toml", "modes.csv", "README.txt"]);
    }
}
