//! What the keys of a scene file are: one list, from which the reader, a JSON schema and a page follow.

pub(crate) mod bound;
mod key;
#[rustfmt::skip]
mod list;
mod page;
mod path;
mod schema;

pub use key::{KeyKind, Presence, SceneKey};
pub use page::scene_key_page;
pub use schema::scene_schema;

pub(crate) use list::KEYS;
pub(crate) use path::{is_within, without_indices};

/// Every key of a scene file, each table before its keys.
pub fn scene_keys() -> &'static [SceneKey] {
    &KEYS
}

#[cfg(test)]
mod tests;
