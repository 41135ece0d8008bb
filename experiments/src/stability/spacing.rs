//! Unequal spacing of planets: modes of equal frequency split, and modes lose their type.
//!
//! Theory is that of [`lumped::SpacingChange`]. The lumped model has no teeth to assemble, so that any angle is
//! allowed; a set of gears assembles at whole multiples of 2π/(Z_s + Z_r), and between them within the errors of its
//! pins.

use std::f64::consts::TAU;

use lumped::{LumpedModel, ModeType, NaturalModes, SpacingChange};
use scene::Scene;

use super::changed_group::ChangedGroup;
use super::map::{Map, MapError, MapOf, StabilityMap, logarithms};

pub(super) const MAP: Map = Map {
    name: "spacing",
    about: "Splits and types of modes when planets are displaced in angle",
    meaning: "with a planet displaced in angle by this a mode has lost its type, and modes of equal frequency have split to \
         first or second order by the pattern of the displacement",
    of: MapOf::Planets(map),
};

/// Displacements at which orders and coefficients are taken, rad: small enough for leading order, large enough for
/// splits of second order to stand out from rounding.
const SMALL: [f64; 2] = [1e-4, 2e-4];

/// Least displacement of the curves and steps of a decade.
const FROM: f64 = 1e-6;
const PER_DECADE: f64 = 4.0;

/// The largest displacement where no teeth are given, rad.
const LARGEST: f64 = 0.05;

/// Most curves of one pattern in a panel.
const SPLITS_DRAWN: usize = 1;
const SHARES_DRAWN: usize = 2;

const SPLIT: &str = "log₁₀ of the split (λ₂ − λ₁)/λ of modes of equal frequency";
const SHARE: &str = "log₁₀ of the share outside the mode's kind";

/// Patterns a_n of the displacements, the largest 1.
fn patterns(model: &LumpedModel) -> Vec<(&'static str, Vec<f64>)> {
    let along = |of: &dyn Fn(f64) -> f64| -> Vec<f64> {
        let all: Vec<f64> = model.psi.iter().map(|psi| of(*psi)).collect();
        let most = all.iter().fold(0.0f64, |a, x| a.max(x.abs()));
        all.into_iter().map(|x| x / most).collect()
    };
    let mut one = vec![0.0; model.psi.len()];
    if let Some(first) = one.first_mut() {
        *first = 1.0;
    }
    vec![
        ("planet 0", one),
        ("planets by cos ψ", along(&f64::cos)),
        ("planets by cos 2ψ", along(&|psi| (2.0 * psi).cos())),
    ]
}

fn map(scene: &Scene) -> Result<StabilityMap, MapError> {
    let axis = "log₁₀ of the displacement in angle, rad";
    let mut map = StabilityMap::of(&MAP, scene.title.clone(), axis);
    let model = LumpedModel::from_scene(scene)?;
    let modes = NaturalModes::of(&model)?;
    let geometry = scene.tooth_geometry().ok();
    let gears = geometry.as_ref().and_then(|g| g.sun.as_ref().zip(g.ring.as_ref()));
    let teeth = gears.map(|(sun, ring)| f64::from(sun.teeth + ring.teeth));
    let largest = teeth.map_or(LARGEST, |teeth| TAU / teeth);
    if teeth.is_some() {
        let quantity = "least angle between places where a planet can be assembled";
        map.compare_in("rad", "planets", quantity, largest, None);
    }
    for (words, pattern) in patterns(&model) {
        let displaced = Displaced { model: &model, pattern: &pattern };
        let mut changes = model.spacing_changes(&modes, &pattern)?;
        for change in &changes {
            borders(&mut map, &displaced, words, change, largest)?;
        }
        // Planet modes leave the central members at rest wherever the planets are.
        let unmoved: Vec<_> = changes
            .iter()
            .filter(|c| c.mode_type == ModeType::Planet && c.multiplicity > 1)
            .collect();
        let splits: Vec<f64> =
            unmoved.iter().map(|c| displaced.split(c, largest)).collect::<Result<_, _>>()?;
        if let Some(most) = splits.into_iter().reduce(f64::max) {
            let of = format!("{words}: planet modes");
            let quantity =
                format!("largest split (λ₂ − λ₁)/λ at a displacement of {largest:.4} rad");
            map.compare(of, quantity, most, Some(0.0));
        }
        changes.sort_by(|a, b| b.split.total_cmp(&a.split));
        let split: Vec<_> = changes.iter().filter(|c| c.split > 0.0).take(SPLITS_DRAWN).collect();
        curves(&mut map, &displaced, words, &split, (SPLIT, largest))?;
        changes.sort_by(|a, b| b.lost.total_cmp(&a.lost));
        let mixing: Vec<_> = changes.iter().filter(|c| c.lost > 0.0).take(SHARES_DRAWN).collect();
        curves(&mut map, &displaced, words, &mixing, (SHARE, largest))?;
    }
    Ok(map)
}

fn of(words: &str, change: &SpacingChange) -> String {
    format!("{words}: {:.1} Hz ({})", change.frequency_hz, change.mode_type.name())
}

fn borders(
    map: &mut StabilityMap,
    displaced: &Displaced<'_>,
    words: &str,
    change: &SpacingChange,
    largest: f64,
) -> Result<(), MapError> {
    let of = of(words, change);
    let [near, far] = SMALL;
    if change.multiplicity > 1 && change.split > 0.0 {
        let order = change.split_order;
        let [at_near, at_far] = [displaced.split(change, near)?, displaced.split(change, far)?];
        let found = (at_far / at_near).ln() / (far / near).ln();
        let quantity = "order of the split in the displacement";
        map.compare(&of, quantity, found, Some(f64::from(order)));
        let quantity = format!("split (λ₂ − λ₁)/λ over the displacement to the power {order}");
        map.compare(&of, quantity, at_near / near.powi(order), Some(change.split));
    }
    if change.lost > 0.0 && change.pure_up_to < largest {
        let quantity = "amplitude outside its kind over the displacement";
        // There it is a thousandth: of leading order, and splits of second order stand out.
        let found = displaced.group(change).lost(change.pure_up_to)?.sqrt() / change.pure_up_to;
        map.compare_in("1/rad", &of, quantity, found, Some(change.lost));
        let quantity = "listed as mixed from a displacement of";
        map.compare_in(
            "rad",
            &of,
            quantity,
            displaced.group(change).border()?,
            Some(change.pure_up_to),
        );
        if change.half_up_to < largest {
            let quantity = "half outside its kind by a displacement of";
            map.compare_in("rad", of, quantity, None, Some(change.half_up_to));
        }
    }
    Ok(())
}

fn curves(
    map: &mut StabilityMap,
    displaced: &Displaced<'_>,
    words: &str,
    changes: &[&SpacingChange],
    (panel, largest): (&str, f64),
) -> Result<(), MapError> {
    let count = (PER_DECADE * (largest / FROM).log10()).floor() as i32;
    let at = |k: i32| FROM * 10f64.powf(f64::from(k) / PER_DECADE);
    for change in changes {
        let (mut measured, mut theory) = (Vec::new(), Vec::new());
        for by in (0..=count).map(at) {
            let (found, exact) = match panel {
                SPLIT => (displaced.split(change, by)?, change.split * by.powi(change.split_order)),
                _ => (displaced.group(change).lost(by)?, (change.lost * by).powi(2)),
            };
            // Below, splits and shares are rounding.
            measured.extend((found > 1e-12).then_some((by, found)));
            theory.extend((exact > 1e-12 && exact < 1.0).then_some((by, exact)));
        }
        let [measured, theory] = [measured, theory].map(|points| logarithms(points, 0.0));
        map.draw_beside(panel, &of(words, change), measured, theory);
    }
    Ok(())
}

/// A model whose planets are displaced in a pattern.
struct Displaced<'m> {
    model: &'m LumpedModel,
    pattern: &'m [f64],
}

impl Displaced<'_> {
    fn modes(&self, by: f64) -> Result<NaturalModes, MapError> {
        let angles: Vec<f64> = self.pattern.iter().map(|a| by * a).collect();
        Ok(NaturalModes::of(&self.model.with_displaced_planets(&angles)?)?)
    }

    /// (λ_max − λ_min)/λ of the modes that a group has become: the nearest, as many as it had.
    fn split(&self, change: &SpacingChange, by: f64) -> Result<f64, MapError> {
        let own = (TAU * change.frequency_hz).powi(2);
        let mut all = self.modes(by)?.lambda;
        all.sort_by(|a, b| (a - own).abs().total_cmp(&(b - own).abs()));
        let group = all.iter().take(change.multiplicity);
        let (low, high) = group
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
        Ok((high - low) / own)
    }

    /// A group of modes while the displacement grows.
    fn group(
        &self,
        change: &SpacingChange,
    ) -> ChangedGroup<impl Fn(f64) -> Result<NaturalModes, MapError>> {
        let SpacingChange { frequency_hz, mode_type, multiplicity, pure_up_to, .. } = *change;
        let modes = |by| self.modes(by);
        ChangedGroup { frequency_hz, mode_type, multiplicity, pure_up_to, modes }
    }
}
