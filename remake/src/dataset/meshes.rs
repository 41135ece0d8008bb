//! The two meshes of elements on which values of the FE/contact model are computed.

use scene::Scene;

pub(super) type Found<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

/// What of the scene's model is made finer or coarser.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Mesh {
    /// Elements along a flank.
    pub(super) flank_elements: u32,
    /// Contact cells over those of the scene.
    pub(super) cells: f64,
    /// Steps in a mesh cycle, of motions.
    pub(super) steps: u32,
}

/// The finer and the coarser one.
pub(super) const MESHES: [Mesh; 2] = [
    Mesh { flank_elements: 28, cells: 1.5, steps: 280 },
    Mesh { flank_elements: 20, cells: 1.0, steps: 140 },
];

impl Mesh {
    /// A scene with this mesh and these steps.
    pub(super) fn given_to(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        scene.fe_contact.flank_elements = self.flank_elements;
        let cells = f64::from(scene.fe_contact.contact_cells) * self.cells;
        scene.fe_contact.contact_cells = cells.round() as u32;
        scene.dynamics.steps_per_cycle = self.steps;
        scene
    }

    /// Both as routes of values at rest.
    pub(super) fn routes() -> String {
        MESHES.map(|mesh| format!("epicyclic: {} flank elements", mesh.flank_elements)).join("; ")
    }

    /// Both as routes of motions.
    pub(super) fn routes_in_time(scene: &Scene) -> String {
        MESHES.map(|mesh| route_in_time(&mesh.given_to(scene))).join("; ")
    }
}

/// The mesh and the steps of a scene as a route of its motions.
pub(super) fn route_in_time(scene: &Scene) -> String {
    let (elements, steps) = (scene.fe_contact.flank_elements, scene.dynamics.steps_per_cycle);
    format!("epicyclic: {elements} flank elements and {steps} steps")
}
