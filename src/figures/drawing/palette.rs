//! Colours and pens that mean the same in every figure.

use lumped::ModeType;

use super::canvas::Pen;

/// Natural frequencies that were found, across a chart.
pub(crate) const FOUND: Pen = Pen::new("#9aa0a6", 0.8).dotted();

/// Colours that stay apart for colour-blind eyes (Okabe & Ito).
const COLOURS: [&str; 8] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#b8a800"];

/// Colour of curve i of a figure.
pub(crate) fn colour(i: usize) -> &'static str {
    COLOURS[i % COLOURS.len()]
}

/// Pen of curve i of a figure.
pub(crate) fn curve(i: usize) -> Pen {
    Pen::new(colour(i), 1.5)
}

/// Colour of a mode type.
pub(crate) fn colour_of(mode_type: ModeType) -> &'static str {
    match mode_type {
        ModeType::Translational => "#1b6ca8",
        ModeType::Rotational => "#c0392b",
        ModeType::Planet => "#2e8b57",
        ModeType::Mixed => "#6b4c9a",
    }
}
