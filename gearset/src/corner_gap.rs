//! The gap of a tip corner beyond its end of the path.

use crate::mesh::Mesh;
use crate::mesh_kind::{MeshKind, MeshMember};

impl Mesh {
    /// G'', 1/m: the gap of the tip corner of `corner` grows as ½ G'' e² with its distance e beyond its end of the
    /// path, e in roll length of the corner's own gear.
    ///
    /// At the end of the path the flanks touch at the corner, with radii of curvature equal to their roll lengths s₁,
    /// s₂. Rolled on by e, they would touch s₁ e/r₁ of the corner's own flank beyond the corner, so that the corner is
    /// away from the mating flank by the gap:
    ///
    /// `[eq:corner-gap-curvature]` ½ G'' e² = ½ (s₁ e/r₁)² (1/s₁ ± 1/s₂), + external, − internal (the larger radius
    /// is the ring's).
    /// Source: derived here.
    /// Checked by: `gearset/tests/displaced.rs::corner_gaps_start_with_the_curvature_of_the_closed_form`.
    pub fn corner_gap_curvature(&self, corner: MeshMember) -> f64 {
        let gear = self.gear(corner);
        let own = gear.tip_roll_length();
        let reach = self.center_distance * self.pressure_angle.sin();
        let mate = match (self.kind, corner) {
            (MeshKind::SunPlanet, _) => reach - own,
            (MeshKind::RingPlanet, MeshMember::Driver) => own + reach,
            (MeshKind::RingPlanet, MeshMember::Driven) => own - reach,
        };
        // Both centres of curvature on one side: the curvatures are subtracted.
        let relative = match self.kind {
            MeshKind::SunPlanet => 1.0 / own + 1.0 / mate,
            MeshKind::RingPlanet => (1.0 / own - 1.0 / mate).abs(),
        };
        (own / gear.base_radius).powi(2) * relative
    }
}
