//! Mode types by the words that tables use, and of vectors as tables print them.

use lumped::{ModeType, Participation};

/// The type a word names; anything else is `Mixed`, of which no sound published set has any.
pub(crate) fn type_named(name: &str) -> ModeType {
    [ModeType::Rotational, ModeType::Translational, ModeType::Planet]
        .into_iter()
        .find(|t| t.name() == name)
        .unwrap_or(ModeType::Mixed)
}

/// Share of a kind that a vector with few digits may lack.
const IMPURE: f64 = 1e-3;

/// The share of a kind in a motion; of `Mixed`, what the largest share leaves.
pub(crate) fn share(of: &Participation, mode_type: ModeType) -> f64 {
    match mode_type {
        ModeType::Rotational => of.rotational,
        ModeType::Translational => of.translational,
        ModeType::Planet => of.planet,
        ModeType::Mixed => 1.0 - of.rotational.max(of.translational).max(of.planet),
    }
}

/// The type of a motion: that of which all but [`IMPURE`] of its energy is.
pub(crate) fn type_of(shares: &Participation) -> ModeType {
    let is_pure = |mode_type: &ModeType| share(shares, *mode_type) >= 1.0 - IMPURE;
    let kinds = [ModeType::Rotational, ModeType::Translational, ModeType::Planet];
    kinds.into_iter().find(is_pure).unwrap_or(ModeType::Mixed)
}
