//! What every model of a planetary gear set shares: the scene file, involute geometry, assembly,
//! kinematics, mesh phases, tables of mesh forces and excitation rules.

pub mod assembly;
mod check;
mod displaced;
mod fault;
mod gear;
mod geometry;
pub mod involute;
pub mod iso6336;
mod kinematics;
mod load_case;
mod mesh;
mod mesh_curve;
mod mesh_kind;
mod mesh_law;
mod pair_springs;
mod parse;
mod parse_dynamics;
mod parse_fe_contact;
mod parse_geometry;
mod parse_lumped;
mod phasing;
mod reader;
mod rules;
mod scene;
mod template;
mod text_file;

pub use displaced::{DisplacedMesh, Displacements, MeshGradients, MeshHessians, PairLocation};
pub use fault::{Fault, SceneError};
pub use gear::{Facing, Flank, Gear, ToothSide};
pub use geometry::{Geometry, GeometryError, ProfileShiftSums};
pub use kinematics::*;
pub use load_case::LoadCase;
pub use mesh::{Mesh, NoMesh};
pub use mesh_curve::{CurveError, CurvePoint, MeshCurve};
pub use mesh_kind::{MeshKind, MeshMember};
pub use mesh_law::{CurveKey, FlankSide, MeshLaw, MeshLawError, MeshLawPlan, MeshStart};
pub use pair_springs::PairSprings;
pub use phasing::{GearAngles, MeshPhases, Phasing};
pub use rules::*;
pub use scene::*;
pub use template::template;
pub use text_file::read_text;
