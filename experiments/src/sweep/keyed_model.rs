//! A model whose scene has one number varied.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use fe_contact::statics::{Bodies, Imperfections};
use scene::{Fidelity, LoadCase, Scene};
use toml::{Table, Value};

use super::error::SweepError;
use super::fixed_basis::{FixedBasis, shapes};
use super::marching::Marching;
use super::mesh_law_model::MeshLawModel;
use super::set_shape::SetShape;
use super::sweep_model::{FeModel, SweepModel, damped};
use super::varied_key::VariedKey;
use crate::scene_keys::{nested, scene_with};

/// Models at other values that are kept: those at a value and beside it, for its derivative, and of the value before.
const MOST_MODELS: usize = 4;

/// A model made for one value of the key.
#[derive(Debug)]
enum Made<'s> {
    Fe(Box<FeModel<'s>>),
    Law(Box<MeshLawModel<'s>>),
}

impl<'s> Made<'s> {
    fn model(&self) -> &dyn SweepModel {
        match self {
            Self::Fe(model) => model.as_ref(),
            Self::Law(model) => model.as_ref(),
        }
    }

    fn set(
        &self,
        scene: &Scene,
        case: &LoadCase,
        size: usize,
    ) -> Result<Box<dyn Marching + 's>, SweepError> {
        match self {
            Self::Fe(model) => model.set_of(scene, case, size),
            Self::Law(model) => model.set_of(scene, case, size),
        }
    }
}

/// A model of a scene with one number varied: at every value it is that of a scene with so much, on the same bodies.
/// The loaded configuration, contact tables and mesh laws are made at each value again where they depend on the key.
pub struct KeyedModel<'s> {
    base: Table,
    key: VariedKey,
    /// Factor on every damping of the scene.
    damping_factor: f64,
    bodies: &'s Bodies,
    case: LoadCase,
    is_lumped: bool,
    /// At the value that the model was begun with.
    first: Arc<Made<'s>>,
    others: Mutex<VecDeque<(f64, Arc<Made<'s>>)>>,
}

impl<'s> KeyedModel<'s> {
    /// Of the scene file `text`, whose bodies are `bodies`, under the torque and at the speed of a load case; `at`: the
    /// first value of the key, with its unit in the scene. `is_lumped`: the lumped model, with the law of the
    /// finite-element set.
    ///
    /// # Errors
    /// If the scene does not allow the value, or the model cannot be made.
    pub fn new(
        text: &str,
        (key, at): (VariedKey, f64),
        damping_factor: f64,
        bodies: &'s Bodies,
        case: LoadCase,
        is_lumped: bool,
    ) -> Result<Self, SweepError> {
        let base: Table = toml::from_str(text).map_err(|e| SweepError::KeyValue {
            key: key.path(),
            value: at,
            reason: e.to_string(),
        })?;
        let scene = varied(&base, key, at, damping_factor)?;
        let first = Arc::new(made(&scene, bodies, case, is_lumped)?);
        let others = Mutex::default();
        Ok(Self { base, key, damping_factor, bodies, case, is_lumped, first, others })
    }

    /// Refuses values that the scene does not allow.
    ///
    /// # Errors
    /// [`SweepError::KeyValue`] with the scene's own faults.
    pub fn check(text: &str, key: VariedKey, value: f64) -> Result<(), SweepError> {
        let base: Table = toml::from_str(text).map_err(|e| SweepError::KeyValue {
            key: key.path(),
            value,
            reason: e.to_string(),
        })?;
        varied(&base, key, value, 1.0).map(|_| ())
    }

    /// The model for a scene with a value of the key.
    fn at(&self, scene: &Scene, value: f64) -> Result<Arc<Made<'s>>, SweepError> {
        if !self.key.enters_statics() {
            return Ok(Arc::clone(&self.first));
        }
        let lock = || self.others.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, own)) = lock().iter().find(|(v, _)| *v == value) {
            return Ok(Arc::clone(own));
        }
        let own = Arc::new(made(scene, self.bodies, self.case, self.is_lumped)?);
        let mut others = lock();
        others.push_back((value, Arc::clone(&own)));
        if others.len() > MOST_MODELS {
            others.pop_front();
        }
        Ok(own)
    }
}

/// The scene with a value of the key.
fn varied(base: &Table, key: VariedKey, value: f64, factor: f64) -> Result<Scene, SweepError> {
    let scene = scene_with(base, &[&nested(key.path(), Value::Float(value))]);
    let scene = scene.map_err(|faults| SweepError::KeyValue {
        key: key.path(),
        value,
        reason: faults.to_string(),
    })?;
    Ok(damped(&scene, factor))
}

fn made<'s>(
    scene: &Scene,
    bodies: &'s Bodies,
    case: LoadCase,
    is_lumped: bool,
) -> Result<Made<'s>, SweepError> {
    Ok(match (is_lumped, scene.dynamics.fidelity) {
        (true, _) => Made::Law(Box::new(MeshLawModel::new(scene, bodies, case)?.lumped())),
        (false, Fidelity::MeshLaw) => Made::Law(Box::new(MeshLawModel::new(scene, bodies, case)?)),
        (false, _) => {
            Made::Fe(Box::new(FeModel::new(scene, bodies, Imperfections::default(), case)))
        }
    })
}

impl SweepModel for KeyedModel<'_> {
    fn name(&self) -> String {
        self.first.model().name()
    }

    fn case(&self) -> LoadCase {
        self.case
    }

    fn shape(&self) -> SetShape {
        self.first.model().shape()
    }

    fn first_planet_rad(&self) -> f64 {
        self.first.model().first_planet_rad()
    }

    fn steps_per_cycle(&self) -> usize {
        self.first.model().steps_per_cycle()
    }

    fn prepare(&self) -> Result<(), SweepError> {
        self.first.model().prepare()
    }

    fn in_short_cycles(
        &self,
        case: &LoadCase,
        damping_factor: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        self.first.model().in_short_cycles(case, damping_factor, size)
    }

    fn turning_damped(
        &self,
        case: &LoadCase,
        damping_factor: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        self.first.model().turning_damped(case, damping_factor, size)
    }

    fn turning_with(
        &self,
        key: VariedKey,
        value: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        if key != self.key {
            return Err(SweepError::Incomplete("varied key of this name"));
        }
        let scene = varied(&self.base, self.key, value, self.damping_factor)?;
        let made = self.at(&scene, value)?;
        let set = made.set(&scene, &self.case, size)?;
        match *made {
            Made::Fe(_) => Ok(set),
            Made::Law(_) => {
                let mut first = self.first.model().turning(&self.case, size)?;
                Ok(Box::new(FixedBasis::new(&shapes(first.as_mut())?, set)?))
            }
        }
    }
}
