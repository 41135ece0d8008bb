//! A results folder, read whole.

use std::path::{Path, PathBuf};

use scene::Scene;

use super::contradictions::{self, Contradiction, Facts};
use super::known_scenes::KnownScenes;
use super::manifest::{Manifest, ManifestError};
use super::matrices::{self, MatrixError, SceneMatrices};
use super::rows::{CycleRow, ModeRow, RuleRow, SceneNames, StateRow};
use super::table::{Remark, TableError};
use crate::model_kind::ModelKind;

/// What a folder holds.
#[derive(Debug, Clone)]
pub struct ResultsFolder {
    /// The folder.
    pub path: PathBuf,
    /// `results.toml`, or its defaults.
    pub manifest: Manifest,
    /// `modes.csv`, in the order of the file; empty without the file, as the other tables.
    pub modes: Vec<ModeRow>,
    /// `mesh_cycle.csv`.
    pub mesh_cycle: Vec<CycleRow>,
    /// `steady_states.csv`.
    pub steady_states: Vec<StateRow>,
    /// `rules.csv`.
    pub rules: Vec<RuleRow>,
    /// `matrices/`, scene by scene.
    pub matrices: Vec<SceneMatrices>,
    /// Every file that was read, in order.
    pub files: Vec<PathBuf>,
    /// What was read in another way than it is written.
    pub remarks: Vec<Remark>,
}

/// Why a folder cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// A table.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A matrix.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
    /// `results.toml`.
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    /// A scene file in the folder.
    #[error("{}: {source}", path.display())]
    Scene {
        /// The file.
        path: PathBuf,
        /// Its faults.
        #[source]
        source: scene::SceneError,
    },
    /// A scene file with the title of a shipped scene that differs from it: suites would take one for the other.
    #[error("{}: `title` is `{title}`, and the shipped scene of that title is another: give it a title of its own", path.display())]
    SharedTitle {
        /// The file.
        path: PathBuf,
        /// The title.
        title: String,
    },
    /// A scene file that is no text.
    #[error("{}: cannot be read: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the reader said.
        #[source]
        source: std::io::Error,
    },
    /// A name of a scene in `results.toml` that no scene has.
    #[error("{}: `scene` is `{name}`: allowed is {source}", path.display())]
    UnknownScene {
        /// The file.
        path: PathBuf,
        /// The name.
        name: String,
        /// What is allowed.
        #[source]
        source: super::known_scenes::UnknownScene,
    },
    /// A folder without any table or matrix.
    #[error("{}: none of modes.csv, mesh_cycle.csv, steady_states.csv, rules.csv and matrices/ is there", path.display())]
    Empty {
        /// The folder.
        path: PathBuf,
    },
}

/// The rows of a table and its remarks.
type Rows<T> = Result<(Vec<T>, Vec<Remark>), TableError>;

impl ResultsFolder {
    /// Reads the folder; scene files in it are known by their stems and titles.
    ///
    /// # Errors
    /// [`FolderError`] with the first fault.
    pub fn read(folder: &Path) -> Result<Self, FolderError> {
        let path = folder.join("results.toml");
        let mut files = Vec::new();
        let manifest = if path.exists() {
            files.push(path.clone());
            Manifest::read(&path)?
        } else {
            Manifest::default()
        };
        let known = scenes(folder, &mut files)?;
        if let Some(name) = &manifest.scene {
            let unknown = |source| FolderError::UnknownScene { path, name: name.clone(), source };
            known.find(name).map_err(unknown)?;
        }
        let mut remarks = Vec::new();
        let standard = manifest.scene.as_deref();
        let names = || SceneNames::new(&known, standard);
        let modes =
            table(folder, "modes.csv", &mut files, &mut remarks, |p| ModeRow::read(p, names()))?;
        let mesh_cycle = table(folder, "mesh_cycle.csv", &mut files, &mut remarks, |p| {
            CycleRow::read(p, names())
        })?;
        let steady_states = table(folder, "steady_states.csv", &mut files, &mut remarks, |p| {
            StateRow::read(p, names())
        })?;
        let rules =
            table(folder, "rules.csv", &mut files, &mut remarks, |p| RuleRow::read(p, names()))?;
        let matrices = matrices::matrices(folder, &known, standard)?;
        for set in &matrices {
            files.extend(set.each().map(|(_, matrix)| matrix.path.clone()));
            let is_listed = modes.iter().any(|row| row.scene.id == set.scene.id);
            if let (Some((_, k)), false) = (set.both(), is_listed) {
                let text = format!(
                    "frequencies and types of `{}` are those of M and K, for modes.csv has none of it",
                    set.scene.id
                );
                remarks.push(Remark {
                    path: k.path.clone(),
                    line: k.size_line(),
                    columns: vec![],
                    text,
                });
            }
        }
        let path = folder.to_owned();
        let rows = modes.len() + mesh_cycle.len() + steady_states.len() + rules.len();
        if rows + matrices.len() == 0 {
            return Err(FolderError::Empty { path });
        }
        Ok(Self {
            path,
            manifest,
            modes,
            mesh_cycle,
            steady_states,
            rules,
            matrices,
            files,
            remarks,
        })
    }

    /// Everything in the tables that cannot be true, in the order of tables; empty for results that can be judged.
    /// `kind` stands before that of `results.toml`.
    pub fn contradictions(&self, kind: Option<ModelKind>) -> Vec<Contradiction> {
        let mut facts = Facts::default();
        let mut found = contradictions::modes(
            &self.path.join("modes.csv"),
            &self.modes,
            kind.or(self.manifest.kind),
            &mut facts,
        );
        let (path, kind) = (self.path.join("modes.csv"), self.kind(kind));
        found.extend(contradictions::vectors(&path, &self.modes, &self.manifest, kind));
        let (sets, manifest) = (&self.matrices, &self.manifest);
        found.extend(contradictions::matrices(sets, &path, &self.modes, manifest, kind));
        found.extend(contradictions::mesh_cycle(
            &self.path.join("mesh_cycle.csv"),
            &self.mesh_cycle,
            self.manifest.positions,
            &mut facts,
        ));
        found.extend(contradictions::steady_states(
            &self.path.join("steady_states.csv"),
            &self.steady_states,
            &mut facts,
        ));
        found.extend(contradictions::rules(&self.path.join("rules.csv"), &self.rules));
        found
    }
}

/// One table of the folder; no rows if there is no such file.
fn table<T>(
    folder: &Path,
    name: &str,
    files: &mut Vec<PathBuf>,
    remarks: &mut Vec<Remark>,
    read: impl Fn(&Path) -> Rows<T>,
) -> Result<Vec<T>, TableError> {
    let path = folder.join(name);
    if !path.exists() {
        return Ok(Vec::new());
    }
    let (rows, found) = read(&path)?;
    files.push(path);
    remarks.extend(found);
    Ok(rows)
}

/// Shipped scenes and those in the folder.
fn scenes(folder: &Path, read: &mut Vec<PathBuf>) -> Result<KnownScenes, FolderError> {
    let shipped = KnownScenes::shipped();
    let mut known = shipped.clone();
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_scene = |path: &PathBuf| {
        path.extension().is_some_and(|end| end == "toml") && !path.ends_with("results.toml")
    };
    let mut files: Vec<PathBuf> = files.filter(is_scene).collect();
    files.sort();
    for path in files {
        let Some(id) = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()) else {
            continue;
        };
        read.push(path.clone());
        let scene = Scene::from_file(&path)
            .map_err(|source| FolderError::Scene { path: path.clone(), source })?;
        if let Ok(shipped) = shipped.find(&scene.title)
            && shipped.scene.title == scene.title
            && shipped.scene != scene
        {
            return Err(FolderError::SharedTitle { path, title: scene.title });
        }
        known.add(id, scene);
    }
    Ok(known)
}
