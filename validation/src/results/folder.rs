//! A results folder, read whole.

use std::path::{Path, PathBuf};

use scene::Scene;

use super::contradictions::{self, Contradiction, Facts};
use super::known_scenes::KnownScenes;
use super::manifest::{Manifest, ManifestError};
use super::matrices::{self, MatrixError, SceneMatrices};
use super::rows::{CycleRow, ModeRow, PeakRow, RuleRow, SceneNames, StateRow, StiffnessRow};
use super::table::{Remark, TableError};
use crate::model_kind::ModelKind;
use crate::nearest::did_you_mean;

/// Longest scene file that is read, bytes.
const MOST_BYTES: u64 = 1_000_000;

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
    /// `mesh_stiffness.csv`.
    pub mesh_stiffness: Vec<StiffnessRow>,
    /// `torque_peaks.csv`.
    pub torque_peaks: Vec<PeakRow>,
    /// `rules.csv`.
    pub rules: Vec<RuleRow>,
    /// `matrices/`, scene by scene.
    pub matrices: Vec<SceneMatrices>,
    /// Every file that was read, in order.
    pub files: Vec<PathBuf>,
    /// What was read in another way than it is written.
    pub remarks: Vec<Remark>,
}

/// Tables of a folder, of which it must have one.
pub(super) const TABLES: [&str; 6] = [
    "modes.csv",
    "mesh_cycle.csv",
    "mesh_stiffness.csv",
    "steady_states.csv",
    "torque_peaks.csv",
    "rules.csv",
];

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
    /// A scene file that is called as a shipped scene and differs from it: tables would mean either.
    #[error("{}: is called as a shipped scene and is another: give the file a name of its own", path.display())]
    SharedId {
        /// The file.
        path: PathBuf,
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
    #[error("{}: none of {} and matrices/ is there", path.display(), TABLES.join(", "))]
    Empty {
        /// The folder.
        path: PathBuf,
    },
    /// A path that is no folder.
    #[error("{}: is no folder: allowed is a folder with tables, as `epicyclic results new` makes one{hint}", path.display())]
    NoFolder {
        /// The path.
        path: PathBuf,
        /// `; did you mean …`, if a folder with a name like it is beside it.
        hint: String,
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
        if !folder.is_dir() {
            let (path, hint) = (folder.to_owned(), similar_folder(folder));
            return Err(FolderError::NoFolder { path, hint });
        }
        let path = folder.join("results.toml");
        let mut files = Vec::new();
        let mut remarks = Vec::new();
        let manifest = if path.exists() {
            files.push(path.clone());
            Manifest::read(&path)?
        } else {
            Manifest::default()
        };
        let known = scenes(folder, &mut files, &mut remarks)?;
        if let Some(name) = &manifest.scene {
            let unknown = |source| FolderError::UnknownScene { path, name: name.clone(), source };
            known.find(name).map_err(unknown)?;
        }
        let standard = manifest.scene.as_deref();
        let names = || SceneNames::new(&known, standard);
        let mut read = Tables { folder, files: &mut files, remarks: &mut remarks };
        let modes = read.table("modes.csv", |path| ModeRow::read(path, names()))?;
        let mesh_cycle = read.table("mesh_cycle.csv", |path| CycleRow::read(path, names()))?;
        let mesh_stiffness =
            read.table("mesh_stiffness.csv", |path| StiffnessRow::read(path, names()))?;
        let steady_states =
            read.table("steady_states.csv", |path| StateRow::read(path, names()))?;
        let torque_peaks = read.table("torque_peaks.csv", |path| PeakRow::read(path, names()))?;
        let rules = read.table("rules.csv", |path| RuleRow::read(path, names()))?;
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
        remarks.extend(strangers(folder));
        let path = folder.to_owned();
        let is_table = |path: &PathBuf| TABLES.iter().any(|name| path.ends_with(name));
        // A table that was read has rows.
        if matrices.is_empty() && !files.iter().any(is_table) {
            return Err(FolderError::Empty { path });
        }
        Ok(Self {
            path,
            manifest,
            modes,
            mesh_cycle,
            steady_states,
            mesh_stiffness,
            torque_peaks,
            rules,
            matrices,
            files,
            remarks,
        })
    }

    /// Everything in the tables that cannot be true, in the order of tables; empty for results that can be judged.
    /// `kind` stands before that of `results.toml`.
    pub fn contradictions(&self, kind: Option<ModelKind>) -> Vec<Contradiction> {
        let mut facts = Facts::new(kind.or(self.manifest.kind));
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
        found.extend(contradictions::mesh_stiffness(
            &self.path.join("mesh_stiffness.csv"),
            &self.mesh_stiffness,
            self.manifest.positions,
            &mut facts,
        ));
        found.extend(contradictions::steady_states(
            &self.path.join("steady_states.csv"),
            &self.steady_states,
            &mut facts,
        ));
        found.extend(contradictions::torque_peaks(
            &self.path.join("torque_peaks.csv"),
            &self.torque_peaks,
            &mut facts,
        ));
        found.extend(contradictions::rules(&self.path.join("rules.csv"), &self.rules));
        found
    }
}

/// Tables that are being read.
struct Tables<'f> {
    folder: &'f Path,
    files: &'f mut Vec<PathBuf>,
    remarks: &'f mut Vec<Remark>,
}

impl Tables<'_> {
    /// One table of the folder; no rows if there is no such file.
    fn table<T>(
        &mut self,
        name: &str,
        read: impl Fn(&Path) -> Rows<T>,
    ) -> Result<Vec<T>, TableError> {
        let path = self.folder.join(name);
        if !path.exists() {
            return Ok(Vec::new());
        }
        let (rows, found) = read(&path)?;
        self.files.push(path);
        self.remarks.extend(found);
        Ok(rows)
    }
}

/// Remarks on CSV files that no table is called so.
fn strangers(folder: &Path) -> Vec<Remark> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let is_strange = |name: &String| name.ends_with(".csv") && !TABLES.contains(&name.as_str());
    let mut names: Vec<String> = names.filter(is_strange).collect();
    names.sort();
    let remark = |name: String| {
        let hint = did_you_mean(&name, TABLES);
        let text = format!("kept aside, no table is called so{hint}");
        Remark { path: folder.join(name), line: 1, columns: Vec::new(), text }
    };
    names.into_iter().map(remark).collect()
}

/// `; did you mean …` of a folder whose name is like the last part of `path`; nothing if there is none.
fn similar_folder(path: &Path) -> String {
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(parent).into_iter().flatten().flatten();
    let folders = entries.filter(|entry| entry.path().is_dir());
    let mut names: Vec<String> =
        folders.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    did_you_mean(&name, names.iter().map(String::as_str))
}

/// Whether a TOML file is meant to be a scene; what is no TOML is, so that its fault is named.
fn is_scene(path: &Path) -> bool {
    let text = scene::read_text(path, MOST_BYTES).unwrap_or_default();
    let is_key = |key: &&str| ["title", "kind", "teeth"].contains(key);
    let table = text.parse::<toml::Table>();
    table.map_or(true, |table| table.keys().map(String::as_str).any(|key| is_key(&key)))
}

/// Shipped scenes and those in the folder.
fn scenes(
    folder: &Path,
    read: &mut Vec<PathBuf>,
    remarks: &mut Vec<Remark>,
) -> Result<KnownScenes, FolderError> {
    let shipped = KnownScenes::shipped();
    let mut known = shipped.clone();
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_toml = |path: &PathBuf| {
        path.extension().is_some_and(|end| end == "toml") && !path.ends_with("results.toml")
    };
    let mut files: Vec<PathBuf> = files.filter(is_toml).collect();
    files.sort();
    for path in files {
        let Some(id) = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()) else {
            continue;
        };
        if !is_scene(&path) {
            let text = "kept aside: a scene has `title`, `kind` or `teeth`".to_owned();
            remarks.push(Remark { path, line: 1, columns: Vec::new(), text });
            continue;
        }
        read.push(path.clone());
        let scene = Scene::from_file(&path)
            .map_err(|source| FolderError::Scene { path: path.clone(), source })?;
        if let Ok(shipped) = shipped.find(&scene.title)
            && shipped.scene.title == scene.title
            && shipped.scene != scene
        {
            return Err(FolderError::SharedTitle { path, title: scene.title });
        }
        if shipped.iter().any(|other| other.id == id && other.scene != scene) {
            return Err(FolderError::SharedId { path });
        }
        known.add(id, scene);
    }
    Ok(known)
}
