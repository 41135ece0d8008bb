//! Single changes whose effect on the tabled frequencies is asked for.

use experiments::modal::Preload;
use fe_contact::statics::Bodies;
use gearset::{PlanetPositions, ThicknessInput};
use scene::{LoadCase, PlaneState, Scene};
use serde::Serialize;

use crate::error::ValidationError;

/// What a change is measured against.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Base {
    /// The FE/contact set, linearised.
    FeContact,
    /// The lumped model with parameters from it.
    LumpedFromFe,
}

/// One change.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Variant {
    /// A rigid carrier.
    RigidCarrier,
    /// Another radius of the carrier's pin seats, m.
    PinSeat(f64),
    /// Plane stress instead of plane strain, carrier included.
    PlaneStress,
    /// Another share of the planet in the tooth thicknesses.
    PlanetShare(f64),
    /// Another torque on the sun, N m.
    Torque(f64),
    /// Another position of the mesh cycle, cycles.
    Position(f64),
    /// Planets at equal angles; four planets with these tooth numbers cannot be assembled so.
    EqualSpacing,
    /// 24.6° for both meshes, as the printed lumped frequencies have it.
    PrintedAngles,
    /// Masses and inertias of Table 1.
    PrintedMasses,
    /// 350e6 N/m for every mesh.
    PrintedMeshes,
    /// Gyroscopic and centripetal terms of the carrier's rotation at the scene's speed.
    Gyroscopic,
}

/// The pressure angle that the printed lumped frequencies have in both meshes, degrees.
const PRINTED_ANGLE_DEG: f64 = 24.6;

impl Variant {
    /// All changes, in the order of the table.
    pub const ALL: [Self; 17] = [
        Self::RigidCarrier,
        Self::PinSeat(7.5e-3),
        Self::PinSeat(15e-3),
        Self::PlaneStress,
        Self::PlanetShare(0.45),
        Self::PlanetShare(0.55),
        Self::Torque(565.0),
        Self::Torque(2260.0),
        Self::Position(0.25),
        Self::Position(0.5),
        Self::Position(0.75),
        // The position at which corner contact starts in all meshes of three planets at once.
        Self::Position(0.836),
        Self::PrintedAngles,
        Self::EqualSpacing,
        Self::PrintedMasses,
        Self::PrintedMeshes,
        Self::Gyroscopic,
    ];

    /// The changes that together turn the lumped model with parameters from FE into the published one.
    pub const TO_PUBLISHED: [Self; 4] =
        [Self::PrintedAngles, Self::EqualSpacing, Self::PrintedMasses, Self::PrintedMeshes];

    /// Name of its row in the tables.
    pub fn name(&self) -> String {
        match self {
            Self::RigidCarrier => "rigid carrier".into(),
            Self::PinSeat(radius) => format!("pin seats of {} mm radius", 1e3 * radius),
            Self::PlaneStress => "plane stress".into(),
            Self::PlanetShare(share) => format!("planet's share of thickness {share}"),
            Self::Torque(torque) => format!("{torque} N·m"),
            Self::Position(position) => format!("position {position}"),
            Self::EqualSpacing => "equal spacing".into(),
            Self::PrintedAngles => "24.6° in both meshes".into(),
            Self::PrintedMasses => "printed masses and inertias".into(),
            Self::PrintedMeshes => "350e6 N/m in every mesh".into(),
            Self::Gyroscopic => "gyroscopic terms at 1600 rpm".into(),
        }
    }

    /// What it is measured against.
    pub fn base(&self) -> Base {
        match self {
            Self::EqualSpacing
            | Self::PrintedAngles
            | Self::PrintedMasses
            | Self::PrintedMeshes
            | Self::Gyroscopic => Base::LumpedFromFe,
            _ => Base::FeContact,
        }
    }

    /// Whether new finite-element meshes of the gears are needed.
    pub fn needs_bodies(&self) -> bool {
        matches!(self, Self::PlaneStress | Self::PlanetShare(_))
    }

    /// The scene and preload so changed; `printed` is a scene with the lumped parameters of the
    /// paper.
    pub fn applied(&self, scene: &Scene, printed: &Scene, preload: Preload) -> (Scene, Preload) {
        let (mut scene, mut preload) = (scene.clone(), preload);
        let published = printed.lumped.as_ref();
        match (*self, scene.geometry.as_mut(), scene.lumped.as_mut()) {
            (Self::RigidCarrier, Some(g), _) => {
                g.carrier.iter_mut().for_each(|c| c.is_rigid = true);
            }
            (Self::PinSeat(radius), Some(g), _) => {
                g.carrier.iter_mut().for_each(|c| c.pin_seat_radius_m = radius);
            }
            (Self::PlanetShare(share), Some(g), _) => {
                if let ThicknessInput::Backlash { planet_share, .. } = &mut g.thickness {
                    *planet_share = share;
                }
            }
            (Self::PlaneStress, _, _) => scene.fe_contact.plane = PlaneState::Stress,
            (Self::Torque(torque), _, _) => preload.load = LoadCase::standing(torque),
            (Self::Position(position), _, _) => preload.position = position,
            (Self::EqualSpacing, _, _) => {
                scene.planets = PlanetPositions::equally_spaced(scene.planets.count());
            }
            (Self::PrintedAngles, _, Some(lumped)) => {
                let angle = PRINTED_ANGLE_DEG.to_radians();
                lumped.pressure_angle_rad.sun_planet = angle;
                lumped.pressure_angle_rad.ring_planet = angle;
            }
            (Self::PrintedMasses, _, Some(lumped)) => {
                if let Some(published) = published {
                    lumped.mass_kg = published.mass_kg;
                    lumped.inertia_over_r2_kg = published.inertia_over_r2_kg;
                }
            }
            (Self::PrintedMeshes, _, Some(lumped)) => {
                if let Some(published) = published {
                    lumped.mesh_n_per_m = published.mesh_n_per_m;
                }
                for own in &mut scene.overrides {
                    (own.sun_mesh_n_per_m, own.ring_mesh_n_per_m) = (None, None);
                }
            }
            _ => {}
        }
        (scene, preload)
    }

    /// Makes the bodies of every variant that needs its own; they serve any number of planets.
    ///
    /// # Errors
    /// If a variant cannot be meshed.
    pub fn own_bodies(scene: &Scene) -> Result<Vec<(Self, Bodies)>, ValidationError> {
        let anywhere = Preload { load: LoadCase::standing(0.0), position: 0.0, step_s: 0.0 };
        let own = Self::ALL.into_iter().filter(Self::needs_bodies);
        own.map(|variant| {
            let (scene, _) = variant.applied(scene, scene, anywhere);
            Ok((variant, Bodies::new(&scene)?))
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use scene::PlanetOverride;

    use super::*;
    use crate::catalogue::{PublishedScene, scene};
    use experiments::modal::lumped_frequencies;

    /// A scene with parameters from FE differs from the published one by the four changes only.
    #[test]
    fn all_changes_to_published_give_the_published_frequencies() {
        let set = scene(PublishedScene::Oh58FourPlanets).unwrap();
        let mut from_fe = set.clone();
        let own = |planet| PlanetOverride {
            planet,
            sun_mesh_n_per_m: Some(7e8 + 1e7 * planet as f64),
            ring_mesh_n_per_m: Some(9e8),
            ..PlanetOverride::default()
        };
        from_fe.overrides = (0..4).map(own).collect();
        from_fe.lumped.as_mut().unwrap().mass_kg.planet = Some(0.7);
        from_fe.lumped.as_mut().unwrap().inertia_over_r2_kg.sun = Some(0.5);
        let nowhere = Preload { load: LoadCase::standing(0.0), position: 0.0, step_s: 0.0 };
        for variant in Variant::TO_PUBLISHED {
            from_fe = variant.applied(&from_fe, &set, nowhere).0;
        }
        let published = scene(PublishedScene::Oh58FourPlanetsAsPublished).unwrap();
        let (ours, theirs) =
            (lumped_frequencies(&from_fe).unwrap(), lumped_frequencies(&published).unwrap());
        assert_eq!(ours.len(), theirs.len());
        for (a, b) in ours.iter().zip(&theirs) {
            // Radii printed to 0.01 mm.
            assert!((a.frequency_hz / b.frequency_hz - 1.0).abs() < 2e-4, "{a:?} {b:?}");
        }
    }
}
