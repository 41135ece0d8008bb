//! The scenes that checks run on, built into the program.

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

impl PublishedScene {
    /// Stem of its file, by which results name it.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Oh58FourPlanets => "oh58_4p",
            Self::Oh58BestThickness => "oh58_4p_best_thickness",
            Self::Oh58ThreePlanets => "oh58_3p",
            Self::Oh58ThreePlanetsPublishedStiffness => "oh58_3p_published_stiffness",
            Self::Oh58FourPlanetsPublishedStiffness => "oh58_4p_published_stiffness",
            Self::Oh58SecondSystem => "oh58_4p_second_system",
            Self::FivePlanets => "five_planets",
            Self::WindTurbineStage => "wind_turbine_stage",
            Self::AutomaticTransmissionSet => "automatic_transmission_set",
            Self::Oh58FourPlanetsAsPublished => "oh58_4p_as_published",
            Self::Oh58ThreePlanetsAsPublished => "oh58_3p_as_published",
            Self::LinParkerThreePlanets => "lin_parker_1999_3p",
            Self::LinParkerFourPlanets => "lin_parker_1999_4p",
        }
    }
}

/// Reads one of them.
///
/// # Errors
/// If the file built in is not a valid scene.
pub fn scene(which: PublishedScene) -> Result<Scene, SceneError> {
    let path = format!("scenes/{}.toml", which.id());
    let file = epicyclic_data::FILES.iter().find(|(name, _)| *name == path);
    Scene::from_toml(file.map_or("", |(_, text)| text))
}
