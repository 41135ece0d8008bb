//! Forces of meshes against the torque.

use std::path::Path;

use experiments::sweep::Part;
use gearset::MeshKind;

use super::contradiction::{Columns, Contradiction};
use super::facts::SceneFacts;

/// Largest part of the torque that the forces may miss.
pub(super) const TOLERANCE: f64 = 0.01;

/// The same where teeth part: the motion may not repeat, so that its mean changes the momentum of the set.
pub(super) const PARTING_TOLERANCE: f64 = 0.5;

/// One force: line, mesh, N.
pub(super) type Force = (u64, Part, f64);

/// Lines and torque of forces that do not carry the torque: Σ_n F_n r_bs against |T_s|; `None` if they do, or if
/// forces of some planets are not there.
pub(super) struct Imbalance {
    pub(super) lines: [u64; 2],
    pub(super) kind: MeshKind,
    pub(super) carried_nm: f64,
    pub(super) torque_nm: f64,
}

/// The worse imbalance of sun and ring meshes in one state.
pub(super) fn imbalance(
    facts: &SceneFacts,
    sun_torque_nm: f64,
    forces: &[Force],
    tolerance: f64,
) -> Option<Imbalance> {
    let radius = facts.sun_base_radius?;
    let of_kind = |(kind, carries_all): (MeshKind, bool)| {
        let is_kind = |(_, part, _): &&Force| match part {
            Part::SunMesh(_) => kind == MeshKind::SunPlanet,
            Part::RingMesh(_) => kind == MeshKind::RingPlanet,
            _ => false,
        };
        let list: Vec<&Force> = forces.iter().filter(is_kind).collect();
        // With forces of every planet the sum has a meaning.
        if !carries_all || list.len() != facts.planets {
            return None;
        }
        let lines = [list.first()?.0, list.last()?.0];
        let carried_nm = radius * list.iter().map(|(_, _, force)| force).sum::<f64>();
        let torque_nm = sun_torque_nm.abs();
        let misses = (carried_nm - torque_nm).abs() > tolerance * torque_nm;
        misses.then_some(Imbalance { lines, kind, carried_nm, torque_nm })
    };
    let kinds = [MeshKind::SunPlanet, MeshKind::RingPlanet].into_iter().zip(facts.carries_all);
    kinds.filter_map(of_kind).max_by(|a, b| a.missed_nm().total_cmp(&b.missed_nm()))
}

impl Imbalance {
    /// What the forces miss, N m.
    pub(super) fn missed_nm(&self) -> f64 {
        (self.carried_nm - self.torque_nm).abs()
    }

    pub(super) fn contradiction(
        &self,
        path: &Path,
        columns: Columns,
        state: &str,
    ) -> Contradiction {
        let meshes = match self.kind {
            MeshKind::SunPlanet => "sun",
            MeshKind::RingPlanet => "ring",
        };
        let statement = format!(
            "forces of the {meshes} meshes times the base radius of the sun are {:.4} N·m {state}, the torque is {:.4} N·m",
            self.carried_nm, self.torque_nm
        );
        let remedy =
            "give forces along the line of action in N, positive where pressed, of every planet";
        Contradiction::new(path, self.lines, columns, statement, remedy)
    }
}
