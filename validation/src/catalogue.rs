//! The scenes that checks run on, built into the program.

use crate::reference_file::embedded;
use scene::{Scene, SceneError};

/// A scene of the catalogue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PublishedScene {
    /// OH-58, four planets, consistent geometry, true spacing.
    Oh58FourPlanets,
    /// The same with the tooth thickness for which masses and inertias agree best.
    Oh58BestThickness,
    /// OH-58, three planets, consistent geometry.
    Oh58ThreePlanets,
    /// Three planets, meshes as soft on average as the printed lumped ones.
    Oh58ThreePlanetsPublishedStiffness,
    /// Four planets, the same.
    Oh58FourPlanetsPublishedStiffness,
    /// Four planets, softer bearings, inertia added to the planets: the paper's section 4.2.
    Oh58SecondSystem,
    /// Five equally spaced planets.
    FivePlanets,
    /// A wind turbine's first stage: the carrier drives, the ring stands still.
    WindTurbineStage,
    /// A set of an automatic transmission: the ring drives, the sun stands still.
    AutomaticTransmissionSet,
    /// OH-58 lumped model as published: 24.6° twice, equal spacing, four planets.
    Oh58FourPlanetsAsPublished,
    /// The same with three planets.
    Oh58ThreePlanetsAsPublished,
    /// Lin & Parker (1999), three planets.
    LinParkerThreePlanets,
    /// Lin & Parker (1999), four planets.
    LinParkerFourPlanets,
}

/// Reads one of them.
///
/// # Errors
/// If the file built in is not a valid scene.
pub fn scene(which: PublishedScene) -> Result<Scene, SceneError> {
    macro_rules! file {
        ($name:literal) => {
            embedded!(concat!("scenes/", $name))
        };
    }
    Scene::from_toml(match which {
        PublishedScene::Oh58FourPlanets => file!("oh58_4p.toml"),
        PublishedScene::Oh58BestThickness => file!("oh58_4p_best_thickness.toml"),
        PublishedScene::Oh58ThreePlanets => file!("oh58_3p.toml"),
        PublishedScene::Oh58ThreePlanetsPublishedStiffness => {
            file!("oh58_3p_published_stiffness.toml")
        }
        PublishedScene::Oh58FourPlanetsPublishedStiffness => {
            file!("oh58_4p_published_stiffness.toml")
        }
        PublishedScene::Oh58SecondSystem => file!("oh58_4p_second_system.toml"),
        PublishedScene::FivePlanets => file!("five_planets.toml"),
        PublishedScene::WindTurbineStage => file!("wind_turbine_stage.toml"),
        PublishedScene::AutomaticTransmissionSet => file!("automatic_transmission_set.toml"),
        PublishedScene::Oh58FourPlanetsAsPublished => file!("oh58_4p_as_published.toml"),
        PublishedScene::Oh58ThreePlanetsAsPublished => file!("oh58_3p_as_published.toml"),
        PublishedScene::LinParkerThreePlanets => file!("lin_parker_1999_3p.toml"),
        PublishedScene::LinParkerFourPlanets => file!("lin_parker_1999_4p.toml"),
    })
}
