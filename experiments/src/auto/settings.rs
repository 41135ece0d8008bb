//! Settings among which `auto` chooses.

use gearset::{ElementFamily, Fidelity, Scene};
use schemars::JsonSchema;
use serde::Serialize;

/// Model of the bodies and meshes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AutoModel {
    /// The lumped model with the parameters of the scene.
    Lumped,
    /// FE/contact with bodies that have no elastic inertia.
    QuasiStatic,
    /// FE/contact with modes of each body.
    Modal,
}

/// One candidate; what a model does not have is absent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
pub struct AutoSettings {
    /// Model.
    pub model: AutoModel,
    /// Modes of each body with its race held.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub modes: Option<u32>,
    /// Elements along one flank, of eight nodes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flank_elements: Option<u32>,
    /// Contact cells of one tooth pair.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_cells: Option<u32>,
}

impl AutoSettings {
    /// The lumped model.
    pub const LUMPED: Self =
        Self { model: AutoModel::Lumped, modes: None, flank_elements: None, contact_cells: None };

    /// FE/contact with quasi-static bodies.
    pub const fn quasi_static(flank_elements: u32, contact_cells: u32) -> Self {
        Self {
            model: AutoModel::QuasiStatic,
            modes: None,
            flank_elements: Some(flank_elements),
            contact_cells: Some(contact_cells),
        }
    }

    /// FE/contact with modes of each body.
    pub const fn modal(modes: u32, flank_elements: u32, contact_cells: u32) -> Self {
        Self {
            model: AutoModel::Modal,
            modes: Some(modes),
            ..Self::quasi_static(flank_elements, contact_cells)
        }
    }

    /// The same mesh and cells with quasi-static bodies.
    pub(super) fn without_modes(self) -> Self {
        Self { model: AutoModel::QuasiStatic, modes: None, ..self }
    }

    /// The scene with these settings, its other keys unchanged.
    pub fn applied_to(&self, scene: &Scene) -> Scene {
        let mut own = scene.clone();
        if let (Some(elements), Some(cells)) = (self.flank_elements, self.contact_cells) {
            own.fe_contact.element = ElementFamily::Quadratic;
            own.fe_contact.flank_elements = elements;
            own.fe_contact.contact_cells = cells;
            // The default depth follows the size of the elements.
            own.fe_contact.matching_depth = None;
        }
        own.dynamics.auto = None;
        own.dynamics.fidelity = match self.modes {
            Some(modes) => Fidelity::Modal(modes),
            None => Fidelity::QuasiStatic,
        };
        own
    }
}

impl std::fmt::Display for AutoSettings {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.modes, self.flank_elements, self.contact_cells) {
            (None, Some(n), Some(cells)) => {
                write!(f, "quasi_static, {n} flank elements, {cells} contact cells")
            }
            (Some(modes), Some(n), Some(cells)) => {
                write!(f, "modal with {modes} modes, {n} flank elements, {cells} contact cells")
            }
            _ => f.write_str("lumped"),
        }
    }
}
