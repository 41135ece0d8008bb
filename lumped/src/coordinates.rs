//! The numbering of the free coordinates.

use gearset::{Axis, Body};
use serde::Serialize;

/// Map from (body, axis) to the index of a free coordinate; as JSON the free coordinates in order.
#[derive(Debug, Clone, Serialize)]
#[serde(transparent)]
pub struct Coordinates {
    #[serde(skip)]
    index: Vec<Option<usize>>,
    free: Vec<(Body, Axis)>,
}

impl Coordinates {
    /// Numbers the coordinates that `is_free` admits, body by body.
    pub fn new(planets: usize, is_free: impl Fn(Body, Axis) -> bool) -> Self {
        let mut index = Vec::with_capacity(3 * (3 + planets));
        let mut free = Vec::with_capacity(3 * (3 + planets));
        for body in Body::all(planets) {
            for axis in Axis::ALL {
                let number = is_free(body, axis).then_some(free.len());
                if number.is_some() {
                    free.push((body, axis));
                }
                index.push(number);
            }
        }
        Self { index, free }
    }

    /// Index of a coordinate; `None` if it is held or there is no such planet.
    pub fn of(&self, body: Body, axis: Axis) -> Option<usize> {
        self.index.get(3 * body.index() + axis as usize).copied().flatten()
    }

    /// The free coordinates in order.
    pub fn free(&self) -> &[(Body, Axis)] {
        &self.free
    }

    /// Number of free coordinates.
    pub fn count(&self) -> usize {
        self.free.len()
    }
}
