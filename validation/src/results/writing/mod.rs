//! A results folder ready to be filled.

mod scene_file;
mod template;

pub use scene_file::SceneFile;
pub use template::Template;
