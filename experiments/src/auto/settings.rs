//! Settings among which `auto` chooses.

use gearset::{Facing, Phasing};
use scene::{CellLayout, ElementFamily, Fidelity, FlankLayer, Scene};
use schemars::JsonSchema;
use serde::Serialize;

/// Model of the bodies and meshes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AutoModel {
    /// The lumped model with parameters from the geometry in closed form.
    Lumped,
    /// FE/contact with bodies that have no elastic inertia.
    QuasiStatic,
    /// FE/contact with modes of each body.
    Modal,
}

/// How FE/contact takes the inertia of the bodies behind the teeth into account.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodyInertia {
    /// Not at all.
    None,
    /// To first order, added to a frequency of quasi-static bodies.
    FirstOrder,
    /// By so many modes of each body with its race held.
    Modes(u32),
}

/// Number of discretisations.
pub const LEVELS: usize = 3;

/// Elements along a flank, from coarse to fine: their ratio is that of everything else.
pub(super) const FLANK_ELEMENTS: [u32; LEVELS] = [6, 10, 16];

/// Contact cells of a tooth pair.
const CONTACT_CELLS: [u32; LEVELS] = [30, 45, 70];

/// Positions of a mesh cycle at rest, at least.
const POSITIONS: [u32; LEVELS] = [60, 100, 160];

/// Time steps in a mesh cycle, at least.
const STEPS: [u32; LEVELS] = [90, 150, 240];

/// Least depth, in elements, at which half-planes and finite elements are matched
/// (`fe_contact.matching_depth_elements`). At the default of 0.85 both points of the match lie in the first two
/// elements on every mesh, and meshes agree on a stiffness that is too high.
const MATCHING_DEPTH_ELEMENTS: f64 = 1.3;

/// Scene keys that every FE/contact candidate has besides the numbers it differs by.
pub const SHARED_KEYS: &str = "fe_contact.matching_depth_elements = 1.3, flank_layer = \"divided\", cell_layout_at_rest = \"graded\"";

/// One candidate; what a model does not have is absent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct AutoSettings {
    /// Model.
    pub model: AutoModel,
    /// Modes of each body with its race held.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub modes: Option<u32>,
    /// Whether what the inertia of elastic displacements changes of a frequency to first order, which quasi-static
    /// bodies lack, is added.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub elastic_inertia: bool,
    /// Elements along one flank, of eight nodes, those next to the flank divided in three along and across it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flank_elements: Option<u32>,
    /// Contact cells of one tooth pair, graded at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_cells: Option<u32>,
    /// Evenly spaced positions of a mesh cycle at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub positions: Option<u32>,
    /// Time steps in a mesh cycle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps_per_cycle: Option<u32>,
}

impl AutoSettings {
    /// The lumped model with parameters in closed form.
    pub const LUMPED: Self = Self {
        model: AutoModel::Lumped,
        modes: None,
        elastic_inertia: false,
        flank_elements: None,
        contact_cells: None,
        positions: None,
        steps_per_cycle: None,
    };

    /// FE/contact with the elements and cells of a level (0 is the coarsest).
    pub fn fe_contact(level: usize, inertia: BodyInertia) -> Self {
        let modes = match inertia {
            BodyInertia::Modes(modes) => Some(modes),
            _ => None,
        };
        Self {
            model: if modes.is_some() { AutoModel::Modal } else { AutoModel::QuasiStatic },
            modes,
            elastic_inertia: inertia == BodyInertia::FirstOrder,
            flank_elements: Some(FLANK_ELEMENTS[level]),
            contact_cells: Some(CONTACT_CELLS[level]),
            ..Self::LUMPED
        }
    }

    /// The same at the positions of a level at rest.
    pub fn at_positions(self, scene: &Scene, level: usize) -> Self {
        Self { positions: Some(divided(scene, POSITIONS[level])), ..self }
    }

    /// The same with the time steps of a level.
    pub fn with_steps(self, scene: &Scene, level: usize) -> Self {
        Self { steps_per_cycle: Some(divided(scene, STEPS[level])), ..self }
    }

    /// The scene with these settings, its other keys unchanged.
    pub fn applied_to(&self, scene: &Scene) -> Scene {
        let mut own = scene.clone();
        if let (Some(elements), Some(cells)) = (self.flank_elements, self.contact_cells) {
            own.fe_contact.element = ElementFamily::Quadratic;
            own.fe_contact.flank_elements = elements;
            own.fe_contact.flank_layer = FlankLayer::Divided;
            own.fe_contact.contact_cells = cells;
            own.fe_contact.cell_layout_at_rest = CellLayout::Graded;
            own.fe_contact.matching_depth_m = None;
            own.fe_contact.matching_depth_elements = Some(MATCHING_DEPTH_ELEMENTS);
        }
        own.dynamics.auto = None;
        own.dynamics.fidelity = self.modes.map_or(Fidelity::QuasiStatic, Fidelity::Modal);
        if let Some(steps) = self.steps_per_cycle {
            own.dynamics.steps_per_cycle = steps;
        }
        own
    }
}

impl std::fmt::Display for AutoSettings {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.flank_elements, self.contact_cells) {
            (Some(n), Some(cells)) => {
                match self.modes {
                    None => f.write_str("quasi_static")?,
                    Some(modes) => write!(f, "modal with {modes} modes")?,
                }
                write!(f, ", {n} flank elements, {cells} contact cells")?;
            }
            _ => f.write_str("lumped with parameters in closed form")?,
        }
        if let Some(positions) = self.positions {
            write!(f, ", {positions} positions")?;
        }
        if let Some(steps) = self.steps_per_cycle {
            write!(f, ", {steps} steps per mesh cycle")?;
        }
        match self.elastic_inertia {
            true => f.write_str(", inertia of elastic displacements to first order"),
            false => Ok(()),
        }
    }
}

/// Most positions or steps into which a mesh cycle is divided evenly so that phases of all planets fall on them.
const MOST_PARTS: usize = 60;

/// `least` or a little more parts of a mesh cycle, so that all planets pass through the same phases and share tables;
/// `least` itself for planets whose phases have no such number.
fn divided(scene: &Scene, least: u32) -> u32 {
    let of_phases = || -> Option<u32> {
        let geometry = scene.tooth_geometry().ok()?;
        let phasing = Phasing::new(&geometry, &scene.planets)?;
        let phases = phasing.phases(0.0, Facing::CounterClockwise).sun_planet;
        let is_whole = |parts: &usize| {
            let of = |phase: &f64| (phase - phases[0]) * *parts as f64;
            phases.iter().map(of).all(|x| (x - x.round()).abs() < 1e-9)
        };
        (1..=MOST_PARTS).find(is_whole).map(|parts| parts as u32)
    };
    let parts = of_phases().unwrap_or(1);
    least.div_ceil(parts) * parts
}
