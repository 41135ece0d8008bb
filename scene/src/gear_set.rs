//! The gear set that a scene describes, as the crate `gearset` computes it: teeth, motion, excitation.

use gearset::{
    ExcitationStrengths, Geometry, Kinematics, KinematicsError, NoMesh, Operation, Spacing,
    excitation,
};

use crate::scene::{Scene, SceneKind};

/// Why a scene has no tooth geometry.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// The scene gives parameters only.
    #[error("{0} is absent: the scene has no tooth geometry")]
    Absent(&'static str),
    /// The base circles do not fit the centre distance.
    #[error(transparent)]
    NoMesh(#[from] NoMesh),
}

impl Scene {
    /// Gears and meshes of the scene.
    ///
    /// # Errors
    /// [`GeometryError::Absent`] for parameter-only sets; otherwise as [`Geometry::new`].
    pub fn tooth_geometry(&self) -> Result<Geometry, GeometryError> {
        let input = self.geometry.as_ref().ok_or(GeometryError::Absent("[geometry]"))?;
        let teeth = self.teeth.as_ref().ok_or(GeometryError::Absent("[teeth]"))?;
        Ok(Geometry::new(input, teeth)?)
    }

    /// Motion at the operating point.
    ///
    /// # Errors
    /// [`KinematicsError::Absent`] unless the scene is a whole set with teeth and an operating point;
    /// otherwise as [`Kinematics::new`].
    pub fn kinematics(&self) -> Result<Kinematics, KinematicsError> {
        use KinematicsError::Absent;
        if self.kind != SceneKind::Planetary {
            return Err(Absent("kind = \"planetary\""));
        }
        let teeth = self.teeth.ok_or(Absent("[teeth]"))?;
        let (sun, ring) = teeth.sun_ring().ok_or(Absent("teeth.sun or teeth.ring"))?;
        let Operation { fixed, input, speed_rpm, .. } =
            self.operation.ok_or(Absent("[operation]"))?;
        Kinematics::new(sun, teeth.planet, ring, fixed, input, speed_rpm)
    }
}

/// Strengths of harmonics 1…`harmonics` of a scene; `None` unless it is a whole set with sun teeth
/// and usable positions.
pub fn excitation_of_scene(scene: &Scene, harmonics: u32) -> Option<Vec<ExcitationStrengths>> {
    if scene.kind != SceneKind::Planetary {
        return None;
    }
    let sun_teeth = scene.teeth?.sun?;
    let spacing = Spacing::of(&scene.planets, scene.teeth).ok()?;
    Some((1..=harmonics).map(|l| excitation(&spacing, sun_teeth, l)).collect())
}
