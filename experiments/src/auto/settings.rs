//! Settings among which `auto` chooses.

use std::f64::consts::TAU;

use gearset::{CellLayout, ElementFamily, Facing, Fidelity, FlankLayer, Geometry, Phasing, Scene};
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

/// Least matching depth of every candidate in elements of a flank (`fe_contact.matching_depth_elements`): with the default
/// of 0.85 amplitudes are 0.8 % too small on six and ten elements alike (`docs/auto.md`).
const MATCHING_DEPTH_ELEMENTS: f64 = 1.3;

/// One candidate; what a model does not have is absent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct AutoSettings {
    /// Model.
    pub model: AutoModel,
    /// Modes of each body with its race held.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub modes: Option<u32>,
    /// Elements along one flank, of eight nodes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flank_elements: Option<u32>,
    /// Whether those next to the flanks are divided in three along and across them (`fe_contact.flank_layer`).
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub divided_flank_layer: bool,
    /// Contact cells of one tooth pair.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_cells: Option<u32>,
    /// Whether they are graded at rest (`fe_contact.cell_layout_at_rest`).
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub graded_at_rest: bool,
    /// Least depth, elements of a flank, at which half-planes and finite elements are matched.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub matching_depth_elements: Option<f64>,
    /// Evenly spaced positions of a mesh cycle at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub positions: Option<u32>,
    /// Positions of a mesh cycle at the spacing to which the surroundings of the extremes are refined.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub positions_about_extremes: Option<u32>,
    /// Time steps in a mesh cycle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps_per_cycle: Option<u32>,
    /// Whether an amplitude has what the inertia of the bodies' elastic displacements, which quasi-static bodies lack, changes of it to
    /// first order.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub elastic_inertia: bool,
}

impl AutoSettings {
    /// The lumped model with parameters in closed form.
    pub const LUMPED: Self = Self {
        model: AutoModel::Lumped,
        modes: None,
        flank_elements: None,
        divided_flank_layer: false,
        contact_cells: None,
        graded_at_rest: false,
        matching_depth_elements: None,
        positions: None,
        positions_about_extremes: None,
        steps_per_cycle: None,
        elastic_inertia: false,
    };

    /// FE/contact with quasi-static bodies.
    pub const fn quasi_static(flank_elements: u32, contact_cells: u32) -> Self {
        Self {
            model: AutoModel::QuasiStatic,
            flank_elements: Some(flank_elements),
            contact_cells: Some(contact_cells),
            matching_depth_elements: Some(MATCHING_DEPTH_ELEMENTS),
            ..Self::LUMPED
        }
    }

    /// The same with the layer of elements next to the flanks divided.
    pub const fn with_divided_layer(self) -> Self {
        Self { divided_flank_layer: true, ..self }
    }

    /// The same with graded contact cells at rest.
    pub const fn with_graded_cells_at_rest(self) -> Self {
        Self { graded_at_rest: true, ..self }
    }

    /// The same at so many positions of a mesh cycle at rest.
    pub const fn at_positions(self, positions: u32) -> Self {
        Self { positions: Some(positions), ..self }
    }

    /// The same with the surroundings of the extremes refined to the spacing of so many positions.
    pub const fn about_extremes(self, positions: u32) -> Self {
        Self { positions_about_extremes: Some(positions), ..self }
    }

    /// The same with so many time steps in a mesh cycle.
    pub const fn with_steps(self, steps_per_cycle: u32) -> Self {
        Self { steps_per_cycle: Some(steps_per_cycle), ..self }
    }

    /// The same with the inertia of the bodies' elastic displacements to first order.
    pub const fn with_elastic_inertia(self) -> Self {
        Self { elastic_inertia: true, ..self }
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
            own.fe_contact.flank_layer = match self.divided_flank_layer {
                true => FlankLayer::Divided,
                false => FlankLayer::Whole,
            };
            own.fe_contact.contact_cells = cells;
            own.fe_contact.cell_layout_at_rest = match self.graded_at_rest {
                true => CellLayout::Graded,
                false => CellLayout::Even,
            };
            own.fe_contact.matching_depth = None;
            own.fe_contact.matching_depth_elements = self.matching_depth_elements;
        }
        own.dynamics.auto = None;
        own.dynamics.fidelity = match self.modes {
            Some(modes) => Fidelity::Modal(modes),
            None => Fidelity::QuasiStatic,
        };
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
                let layer = if self.divided_flank_layer { " divided in three" } else { "" };
                let layout = if self.graded_at_rest { "graded " } else { "" };
                write!(f, ", {n} flank elements{layer}, {cells} {layout}contact cells")?;
            }
            _ => f.write_str("lumped with parameters in closed form")?,
        }
        if let Some(positions) = self.positions {
            write!(f, ", {positions} positions")?;
        }
        if let Some(positions) = self.positions_about_extremes {
            write!(f, ", about the extremes as close as {positions}")?;
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

/// `least` or a little more parts of a mesh cycle, so that all planets pass through the same phases: tables are then
/// shared. `least` itself for planets whose phases have no such number.
pub(super) fn divided(scene: &Scene, least: u32) -> u32 {
    let parts = phase_parts(scene);
    least.div_ceil(parts) * parts
}

/// Number of times that the transmission error at rest repeats itself in a mesh cycle.
///
/// A set of equal planets that turns into itself by a part 1/m of a turn is there the same set at another position: further on by the
/// phase Z_s/m by which the planets differ, of which m/gcd(m, Z_s) make whole cycles.
pub(super) fn repeats(scene: &Scene) -> u32 {
    let psi = &scene.planets.psi_rad;
    let Ok(Geometry { sun: Some(sun), .. }) = Geometry::from_scene(scene) else { return 1 };
    let is_planet_at = |angle: f64| {
        let off = psi.iter().map(|own| (own - angle).rem_euclid(TAU));
        off.map(|off| off.min(TAU - off)).any(|off| off < SPACED)
    };
    let turns = |m: &u32| psi.iter().all(|own| is_planet_at(own + TAU / f64::from(*m)));
    let most = if scene.overrides.is_empty() { psi.len() as u32 } else { 1 };
    let order = (1..=most).rev().find(turns).unwrap_or(1);
    // m/gcd(m, Z_s)
    (1..=order).find(|parts| (sun.teeth * parts).is_multiple_of(order)).unwrap_or(1)
}

/// Planets that are closer than this to where others were stand there, rad.
const SPACED: f64 = 1e-9;

/// Least number of parts of a mesh cycle of which the phases of all planets are multiples, 1 if there is none.
pub(super) fn phase_parts(scene: &Scene) -> u32 {
    let Ok(geometry) = Geometry::from_scene(scene) else { return 1 };
    let Some(phasing) = Phasing::new(&geometry, &scene.planets) else { return 1 };
    let phases = phasing.phases(0.0, Facing::CounterClockwise).sun_planet;
    let is_whole = |parts: &usize| {
        let of = |phase: &f64| (phase - phases[0]) * *parts as f64;
        phases.iter().map(of).all(|x| (x - x.round()).abs() < 1e-9)
    };
    (1..=MOST_PARTS).find(is_whole).map_or(1, |parts| parts as u32)
}
