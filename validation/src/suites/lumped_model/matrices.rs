//! Given matrices beside those of the lumped model.

use lumped::Coordinates;
use lumped::nalgebra::DMatrix;

use crate::check::Check;
use crate::error::ValidationError;
use crate::reference::Reference;

/// Part of the largest entry of the diagonal that stands for a smaller one.
const NIL: f64 = 1e-12;

/// A given matrix, on the coordinates of the lumped model, beside the model's own.
pub(crate) struct Beside<'m> {
    /// `mass` or `stiffness`.
    pub(crate) name: &'static str,
    /// kg or N/m.
    pub(crate) unit: &'static str,
    pub(crate) coordinates: &'m Coordinates,
    pub(crate) given: &'m DMatrix<f64>,
    pub(crate) model: &'m DMatrix<f64>,
}

/// The largest difference of two matrices A and B.
#[derive(Clone, Copy)]
pub(crate) struct Difference {
    /// max |ΔA_ij| / √(B_ii B_jj), percent.
    pub(crate) percent: f64,
    /// i and j.
    place: (usize, usize),
}

impl Difference {
    /// Of `given` from `model`; what is no number or beyond every number counts as the largest number.
    pub(crate) fn new(given: &DMatrix<f64>, model: &DMatrix<f64>) -> Self {
        let least = NIL * model.diagonal().amax();
        let root: Vec<f64> = model.diagonal().iter().map(|d| d.abs().max(least).sqrt()).collect();
        let mut worst = Self { percent: 0.0, place: (0, 0) };
        for place @ (i, j) in (0..root.len()).flat_map(|j| (0..=j).map(move |i| (i, j))) {
            let difference = (given[place] - model[place]).abs();
            let percent = (100.0 * difference / (root[i] * root[j])).min(f64::MAX);
            if percent > worst.percent {
                worst = Self { percent, place };
            }
        }
        worst
    }
}

impl Beside<'_> {
    /// The check of the scene `id`; `agreeing` says, for a largest difference in percent, with which other convention
    /// all entries agree.
    pub(crate) fn check(
        &self,
        id: &str,
        title: &str,
        reference: &Reference,
        agreeing: impl FnOnce(f64) -> Option<String>,
    ) -> Result<Check, ValidationError> {
        let check = format!("lumped_model.{id}.{}", self.name);
        let title = format!("{title}: largest difference of the {} matrix", self.name);
        let worst = Difference::new(self.given, self.model);
        let mut about = reference.about(&check, &title)?;
        let tolerance = reference.tolerance(&check, 0.0)?.absolute;
        if worst.percent > tolerance {
            let (i, j) = worst.place;
            let word = |k: usize| {
                let (body, axis) = self.coordinates.free()[k];
                let axis = axis.displacement(body).trim_end_matches(" displacement");
                format!("{} {axis}", body.name().replace('_', " "))
            };
            let mut note = format!(
                "largest at {} × {}: yours {:.4e}, reference {:.4e} {}",
                word(i),
                word(j),
                self.given[(i, j)],
                self.model[(i, j)],
                self.unit
            );
            if let Some(convention) = agreeing(tolerance) {
                note += &format!("; all entries agree with {convention}");
            }
            about = about.note(note);
        }
        Ok(about.at_most(worst.percent))
    }
}
