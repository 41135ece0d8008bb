//! Choices of the FE/contact model and of simulation in time, as a scene gives them.

use serde::{Deserialize, Serialize};

use crate::scene::PerMesh;

/// Level of detail of the bodies behind the teeth when the set vibrates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fidelity {
    /// As `QuasiStatic`, but each mesh force is read from a table over deflection and phase.
    MeshLaw,
    /// Rigid inertia, FE flexibility without inertia of its own.
    QuasiStatic,
    /// As `QuasiStatic`, and this number of modes of each body with its race held.
    Modal(u32),
    /// Every FE degree of freedom, with its inertia.
    Full,
}

/// Choices for simulation in time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DynamicsInput {
    /// Level of detail of the bodies.
    pub fidelity: Fidelity,
    /// Time steps in a mesh cycle.
    pub steps_per_cycle: u32,
    /// Whether the carrier frame's gyroscopic and centripetal terms act.
    pub gyroscopic: bool,
    /// How approaches of tooth pairs follow from displacements of the gears in a sweep.
    pub kinematics: MeshKinematics,
    /// With `fidelity = "auto"`: what the settings are to be chosen for. `fidelity` is then `QuasiStatic` until they
    /// are.
    pub auto: Option<AutoInput>,
}

/// A quantity and how accurate it is to be: settings are chosen for it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AutoInput {
    /// The quantity.
    pub quantity: AutoQuantity,
    /// Largest error that is allowed, percent of the quantity.
    pub tolerance_percent: f64,
}

/// A quantity for which settings can be chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AutoQuantity {
    /// A natural frequency about the operating torque at position 0 of the mesh cycle.
    NaturalFrequency {
        /// Type of the mode.
        mode_type: AutoModeType,
        /// Number among the modes of that type by ascending frequency, from 1; a frequency that occurs twice counts
        /// twice.
        number: u32,
    },
    /// Largest less smallest loaded transmission error r_b θ of the sun over a mesh cycle at rest.
    TransmissionError,
    /// Mean of the same.
    MeanTransmissionError,
    /// Root mean square of a response in its harmonics, the largest over the speeds of a sweep.
    Amplitude {
        /// Which response.
        response: AutoResponse,
    },
}

impl AutoQuantity {
    /// Its name as key `dynamics.quantity`, and the verb that gives it.
    pub fn names(&self) -> (&'static str, &'static str) {
        match self {
            Self::NaturalFrequency { .. } => ("natural_frequency", "modes"),
            Self::TransmissionError => ("transmission_error", "static"),
            Self::MeanTransmissionError => ("mean_transmission_error", "static"),
            Self::Amplitude { .. } => ("amplitude", "sweep"),
        }
    }
}

/// Response of a turning set whose amplitude is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AutoResponse {
    /// Dynamic transmission error r_b θ of the sun.
    TransmissionError,
    /// Translation of the sun.
    SunTranslation,
}

/// Type of a mode, by the larger part of its kinetic energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AutoModeType {
    /// Central members rotate, planets move alike.
    Rotational,
    /// Central members translate.
    Translational,
    /// Planets move against each other.
    Planet,
}

/// How approaches of tooth pairs follow from displacements of the gears.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MeshKinematics {
    /// Exact in the mean configuration under load; linear (at tip corners quadratic) in the displacements
    /// from it.
    AboutMean,
    /// Exact at every time step; slow.
    Exact,
}

/// State of a two-dimensional continuum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PlaneState {
    /// No strain along the face width.
    Strain,
    /// No stress along the face width.
    Stress,
}

/// Displacement field of the quadrilaterals behind the Hermite flanks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ElementFamily {
    /// Four nodes, bilinear, as in Parker, Agashe & Vijayakar (2000); too stiff in bending.
    Linear,
    /// Four nodes and incompatible bending modes.
    Incompatible,
    /// Eight nodes.
    Quadratic,
}

/// Contact cells of a tooth pair: in tables of which forces and their slopes are asked, in time and beside a position
/// for the slopes of the flanks, and in those of a set at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CellLayout {
    /// Narrower towards the end of a flank where the grid ends there, a quarter of a cell off the
    /// middle elsewhere; slopes from cells laid out for the load at rest.
    Graded,
    /// All of one width about the contact point; slopes from cells laid out for the largest load.
    Even,
}

/// Elements next to the flanks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FlankLayer {
    /// As large as the others.
    Whole,
    /// Divided in three along and across the flanks, with a transition to those behind.
    Divided,
}

/// Choices of the FE/contact model; a value of `None` is derived from the geometry.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FeContactInput {
    /// Plane strain or plane stress.
    pub plane: PlaneState,
    /// Element family behind the flanks.
    pub element: ElementFamily,
    /// Elements along one flank; the rest of the mesh follows their size.
    pub flank_elements: u32,
    /// What becomes of those next to the flank.
    pub flank_layer: FlankLayer,
    /// Contact cells of one tooth pair.
    pub contact_cells: u32,
    /// Where these cells are, in tables of which forces and their slopes are asked.
    pub cell_layout: CellLayout,
    /// The same in tables of a set at rest, of which pressures are asked as well.
    pub cell_layout_at_rest: CellLayout,
    /// Depth below the flank at which half-plane and FE are matched, m.
    pub matching_depth_m: Option<f64>,
    /// Least depth of the default, elements along a flank.
    pub matching_depth_elements: Option<f64>,
    /// Matching points below each cell: 1 as in eq. (1) of Parker, Agashe & Vijayakar (2000), 2 to
    /// extrapolate to the surface.
    pub matching_points: u32,
    /// Number of positions of the mesh cycle over which the loaded configuration is averaged.
    pub mean_positions: Option<u32>,
    /// Factors on the FE part of each mesh's flexibility; the half-plane part is unchanged.
    pub flexibility_factor: PerMesh,
}

impl FeContactInput {
    /// Number of elements that touch the surface of a flank.
    pub fn elements_on_flank(&self) -> u32 {
        match self.flank_layer {
            FlankLayer::Whole => self.flank_elements,
            FlankLayer::Divided => 3 * self.flank_elements,
        }
    }
}
