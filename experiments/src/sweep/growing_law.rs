//! Tables of mesh force that are made anew for twice the force where a motion exceeds them.

use std::sync::{Arc, OnceLock};

use fe_contact::FeError;
use fe_contact::statics::Bodies;
use fe_contact::vibration::{MeshLawSettings, mesh_law};
use gearset::MeshLaw;
use scene::{LoadCase, Scene};

use super::error::SweepError;
use super::set_shape::SetShape;
use crate::table_growth::SIZES;

/// A mesh law, and those for larger forces. Beyond the last node of a table forces are extrapolated by a straight line:
/// where teeth hammer on both flanks that can be a tenth of an amplitude and more.
#[derive(Debug)]
pub(super) struct GrowingLaw<'s> {
    first: Arc<MeshLaw>,
    /// What larger laws are made from; `None` of a law that is given as it is, and holds at every force.
    source: Option<Source<'s>>,
    larger: [OnceLock<Arc<MeshLaw>>; SIZES],
}

#[derive(Debug)]
struct Source<'s> {
    scene: Scene,
    bodies: &'s Bodies,
    case: LoadCase,
}

impl Source<'_> {
    fn settings(&self, size: usize) -> MeshLawSettings {
        MeshLawSettings::at(self.case.sun_load_nm()).for_times_the_force(1 << size)
    }

    fn law(&self, steps: usize, size: usize) -> Result<Arc<MeshLaw>, FeError> {
        let (scene, settings) = (&self.scene, self.settings(size));
        let law = mesh_law(scene, self.bodies, self.case.sense(), steps, &settings)?;
        Ok(law.in_direction(self.case.direction()).into())
    }

    /// Largest force of the tables, N.
    fn largest_n(&self, size: usize) -> Result<f64, SweepError> {
        let sun = self.bodies.geometry.sun.as_ref();
        let radius = sun.ok_or(SweepError::Incomplete("sun"))?.base_radius;
        let share = self.case.sun_load_nm() / radius / SetShape::of(&self.scene).planets as f64;
        Ok(self.settings(size).reach * share)
    }
}

impl<'s> GrowingLaw<'s> {
    /// Under the torque of a load case, with as many steps in a mesh cycle.
    ///
    /// # Errors
    /// If the law cannot be made.
    pub(super) fn new(
        scene: &Scene,
        bodies: &'s Bodies,
        case: LoadCase,
        steps: usize,
    ) -> Result<Self, SweepError> {
        let source = Source { scene: scene.clone(), bodies, case };
        let first = source.law(steps, 0)?;
        Ok(Self { first, source: Some(source), larger: [const { OnceLock::new() }; SIZES] })
    }

    /// The same law with another number of steps in a mesh cycle; `None` of a law that is given as it is.
    ///
    /// # Errors
    /// If the law cannot be made.
    pub(super) fn with_steps(&self, steps: usize) -> Result<Option<Self>, SweepError> {
        let own = self.source.as_ref();
        own.map(|own| Self::new(&own.scene, own.bodies, own.case, steps)).transpose()
    }

    /// A law that is given.
    pub(super) fn given(law: Arc<MeshLaw>) -> Self {
        Self { first: law, source: None, larger: [const { OnceLock::new() }; SIZES] }
    }

    /// The law for the mean force and three times as much.
    pub(super) fn first(&self) -> &Arc<MeshLaw> {
        &self.first
    }

    /// The law that was found too small `size` times, and the force up to which it holds.
    ///
    /// # Errors
    /// If the law cannot be made.
    pub(super) fn of_size(&self, size: usize) -> Result<(Arc<MeshLaw>, Range), SweepError> {
        let Some(source) = &self.source else {
            return Ok((Arc::clone(&self.first), Range { largest_n: f64::INFINITY }));
        };
        let range = Range { largest_n: source.largest_n(size)? };
        let law = match (size, self.larger.get(size).and_then(OnceLock::get)) {
            (0, _) => Arc::clone(&self.first),
            (_, Some(made)) => Arc::clone(made),
            _ => {
                let made = source.law(self.first.steps(), size)?;
                match self.larger.get(size) {
                    Some(slot) => Arc::clone(slot.get_or_init(|| made)),
                    None => made,
                }
            }
        };
        Ok((law, range))
    }
}

/// Forces that the tables of a law contain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    largest_n: f64,
}

impl Range {
    /// Refuses mesh forces (N) beyond the tables.
    #[inline]
    pub(super) fn check(self, forces: &[f64]) -> Result<(), FeError> {
        let force_n = forces.iter().fold(0.0, |a: f64, b| a.max(*b));
        if force_n <= self.largest_n {
            return Ok(());
        }
        Err(FeError::TableExceeded { force_n, largest_n: self.largest_n })
    }
}
