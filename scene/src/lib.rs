#![doc = include_str!("../README.md")]

mod check;
mod choices;
mod gear_set;
mod idle;
mod keys;
mod load;
mod needs;
mod read;
mod scene;
mod templates;
mod warnings;
mod write;

pub use choices::*;
pub use gear_set::{GeometryError, excitation_of_scene};
pub use keys::bound::Bound;
pub use keys::{KeyKind, Presence, SceneKey, scene_key_page, scene_keys, scene_schema};
pub use load::case::LoadCase;
pub use load::estimates::{estimated_inertias, estimated_mesh_stiffness};
pub use load::size::{LoadSize, SPEEDS_RPM, is_speed};
pub use load::torque_path::NoTorquePath;
pub use needs::{Lack, Verb};
pub use read::MOST_SCENE_BYTES;
pub use read::fault::{Fault, SceneError, SceneFaults};
pub use read::remarks::{Chosen, Remarks};
pub use read::text_file::read_text;
pub use scene::*;
pub use templates::template;
pub use warnings::{Warning, warnings};
