//! Mode types by the words that tables use.

use lumped::ModeType;

/// The type a word names; anything else is `Mixed`, of which no sound published set has any.
pub(crate) fn type_named(name: &str) -> ModeType {
    [ModeType::Rotational, ModeType::Translational, ModeType::Planet]
        .into_iter()
        .find(|t| t.name() == name)
        .unwrap_or(ModeType::Mixed)
}
