//! Rows on the displacements (x, y, θ) of driver and driven gear of a mesh: change of frame, and
//! decomposition into derivatives with respect to δ, σ and a'.

use gearset::{MeshGradients, MeshKind};

/// Derivatives of a pair's approach with respect to δ, σ and a', from its row on driver and driven in
/// the displaced frame.
///
/// The entries of the rotations give A_δ and A_σ, the planet's entry along the line of centres then
/// A_a.
pub(crate) fn invariants(kind: MeshKind, gradients: &MeshGradients, row: &[f64; 6]) -> [f64; 3] {
    let (delta, roll_length) = (&gradients.approach, &gradients.roll_length);
    let determinant = delta[2] * roll_length[5] - delta[5] * roll_length[2];
    let by_approach = (row[2] * roll_length[5] - row[5] * roll_length[2]) / determinant;
    let by_roll_length = (delta[2] * row[5] - delta[5] * row[2]) / determinant;
    let planet = match kind {
        MeshKind::SunPlanet => 3,
        MeshKind::RingPlanet => 0,
    };
    [
        by_approach,
        by_roll_length,
        row[planet] - by_approach * delta[planet] - by_roll_length * roll_length[planet],
    ]
}

/// A row on (x, y, θ) of driver and driven in a frame turned by `angle` (rad), transformed into the
/// unturned frame.
pub(crate) fn turned(row: &[f64; 6], angle: f64) -> [f64; 6] {
    let (sin, cos) = angle.sin_cos();
    let one = |x: f64, y: f64| [cos * x - sin * y, sin * x + cos * y];
    let ([a, b], [c, d]) = (one(row[0], row[1]), one(row[3], row[4]));
    [a, b, row[2], c, d, row[5]]
}

/// A row on (x, y, θ) of driver and driven, or their displacements, mirrored at the line of
/// centres: y and θ change sign.
pub(crate) fn mirrored(row: &[f64; 6]) -> [f64; 6] {
    [row[0], -row[1], -row[2], row[3], -row[4], -row[5]]
}
