//! Meshed gears with their flexibility, made once for all scenes that share them.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use fe_contact::FeError;
use fe_contact::statics::Bodies;
use scene::Scene;

/// Gears by the scene data they depend on: scenes that differ only in planet positions, supports or load
/// share them.
#[derive(Debug, Default)]
pub struct BodiesCache {
    known: Mutex<HashMap<String, Arc<Bodies>>>,
}

impl BodiesCache {
    /// The gears of a scene, computed if they are not in the cache.
    ///
    /// # Errors
    /// As [`Bodies::new`].
    pub fn of(&self, scene: &Scene) -> Result<Arc<Bodies>, FeError> {
        // All that Bodies::new reads; numbers are printed to their last digit.
        let key = format!(
            "{:?} {:?} {:?} {:?} {:?}",
            scene.teeth, scene.geometry, scene.material, scene.fe_contact, scene.pair
        );
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(bodies) = known().get(&key) {
            return Ok(Arc::clone(bodies));
        }
        // Not under the lock: threads of the pool that computes gears may be waiting for it.
        let bodies = Arc::new(Bodies::new(scene)?);
        Ok(Arc::clone(known().entry(key).or_insert(bodies)))
    }

    /// Drops gears that are not in use elsewhere.
    pub fn drop_unused(&self) {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        known.retain(|_, bodies| Arc::strong_count(bodies) > 1);
    }
}
