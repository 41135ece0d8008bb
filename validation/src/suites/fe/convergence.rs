//! Matching depth, contact cells and elements: what the result owes to each.

use fe_contact::complementarity::{ActiveSet, ComplementaritySolver, InteriorPoint, Lemke};
use fe_contact::statics::{Bodies, PairCycle, at_phase};

use super::{Lab, MESHES};
use crate::check::{Check, ReferenceKind};
use crate::error::ValidationError;

/// Positions of the mesh cycle; corners and single contact are among them.
const POSITIONS: usize = 20;

/// Depths over the default one: a plateau of a factor 2.
const DEPTHS: [f64; 4] = [0.7, 0.9, 1.15, 1.4];

/// Grid convergence index of the middle of three grids (Roache, J. Fluids Eng. 116 (1994) 405–413):
/// F_s |ε| r^p/(r^p − 1), an estimate of the distance of its value to the limit, as a share.
///
/// The observed order with F_s = 1.25 where the values approach monotonically at an order between 1
/// and 4; else, as for two grids, the formal order with F_s = 3. Formal is order 2: the fields hold a
/// point load, for which no element does better in the mean.
pub(crate) fn grid_convergence_index(values: [f64; 3], ratios: [f64; 2]) -> (Option<f64>, f64) {
    let [coarse, middle, fine] = values;
    let (first, second) = (middle - coarse, fine - middle);
    // With unequal ratios the order solves p = ln|ε₃₂/ε₂₁ · (r₂₁^p − 1)/(r₃₂^p − 1)|/ln r₂₁.
    let mut order = None;
    if first * second > 0.0 {
        let mut p: f64 = 2.0;
        for _ in 0..100 {
            let balance = (ratios[1].powf(p) - 1.0) / (ratios[0].powf(p) - 1.0);
            p = ((first / second * balance).abs().ln() / ratios[1].ln()).clamp(0.1, 10.0);
        }
        order = Some(p);
    }
    let usable = order.filter(|p| (1.0..=4.0).contains(p));
    let (p, safety) = usable.map_or((2.0, 3.0), |p| (p, 1.25));
    // From the finer pair: the middle grid is r^p times as far from the limit as the fine one.
    let grown = ratios[1].powf(p);
    (order, safety * (second / fine).abs() * grown / (grown - 1.0))
}

fn largest_change(a: &PairCycle, b: &PairCycle) -> f64 {
    let pairs = a.positions.iter().zip(&b.positions);
    pairs.map(|(p, q)| (p.deflection / q.deflection - 1.0).abs()).fold(0.0, f64::max)
}

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let mut checks = Vec::new();
    let with_elements = |flank: u32| {
        let mut scene = lab.four.clone();
        scene.fe_contact.flank_elements = flank;
        scene.fe_contact.matching_depth = Some(lab.bodies.settings.matching.depth);
        Bodies::new(&scene)
    };
    let default = lab.four.fe_contact.flank_elements;
    let grids = [10, default, 20];
    let (coarse, fine) = (with_elements(grids[0])?, with_elements(grids[2])?);
    for kind in MESHES {
        let name = kind.name();
        let base = lab.pair(&lab.bodies, kind, POSITIONS)?;
        let mut varied = lab.bodies.clone();
        let mut stiffness = Vec::new();
        for times in DEPTHS {
            varied.settings.matching.depth = times * lab.bodies.settings.matching.depth;
            stiffness.push(lab.pair(&varied, kind, POSITIONS)?.mean_secant_stiffness());
        }
        let least = stiffness.iter().fold(f64::INFINITY, |a, k| a.min(*k));
        let largest = stiffness.iter().fold(0.0f64, |a, k| a.max(*k));
        let id = format!("fe.convergence.depth.{name}");
        let title = format!(
            "{name} mesh: change of the mean stiffness over matching depths from 0.7 to 1.4 of the default"
        );
        checks.push(lab.at_most(&id, &title, "%", 100.0 * (largest / least - 1.0))?);

        let mut varied = lab.bodies.clone();
        varied.settings.input.contact_cells *= 2;
        let finer = lab.pair(&varied, kind, POSITIONS)?;
        let id = format!("fe.convergence.cells.{name}");
        let title =
            format!("{name} mesh: largest change of δ at any position with twice the cells");
        checks.push(lab.at_most(&id, &title, "%", 100.0 * largest_change(&base, &finer))?);

        let ends = [lab.pair(&coarse, kind, POSITIONS)?, lab.pair(&fine, kind, POSITIONS)?];
        let mean = |cycle: &PairCycle| cycle.mean_secant_stiffness();
        let values = [mean(&ends[0]), mean(&base), mean(&ends[1])];
        let ratio = |a: u32, b: u32| f64::from(b) / f64::from(a);
        let ratios = [ratio(grids[0], default), ratio(default, grids[2])];
        let (_, gci) = grid_convergence_index(values, ratios);
        let id = format!("fe.convergence.gci.{name}");
        let title = format!(
            "{name} mesh: grid convergence index of the mean stiffness at the default mesh, from 10, {default} and 20 flank elements"
        );
        checks.push(lab.at_most(&id, &title, "%", 100.0 * gci)?);
        let worst = largest_change(&base, &ends[1]);
        let id = format!("fe.convergence.elements.{name}");
        let title = format!(
            "{name} mesh: largest change of δ at any position from the default to 20 flank elements"
        );
        checks.push(lab.at_most(&id, &title, "%", 100.0 * worst)?);

        // Three solvers on the same teeth, a corner in contact.
        let phase = 0.95;
        let solve = |solver: &dyn ComplementaritySolver| {
            Ok::<_, ValidationError>(
                at_phase(&lab.bodies, kind, lab.force, phase, solver)?.answer.cell_forces,
            )
        };
        let active = solve(&ActiveSet)?;
        let peak = active.iter().fold(0.0f64, |a, p| a.max(*p));
        let others: [(&str, &dyn ComplementaritySolver); 2] =
            [("lemke", &Lemke), ("interior_point", &InteriorPoint)];
        for (other, solver) in others {
            let forces = solve(solver)?;
            let off = active.iter().zip(&forces).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let id = format!("fe.convergence.solvers.{other}.{name}");
            let title = format!(
                "{name} mesh at phase {phase}: cell forces by active set and by {other}, over the peak"
            );
            let source = "the same problem by another method";
            let kind = ReferenceKind::Analytic;
            checks.push(lab.number(&id, &title, kind, source, "", 0.0, off / peak)?);
        }
    }
    Ok(checks)
}

#[cfg(test)]
mod tests {
    use super::grid_convergence_index;

    #[test]
    fn a_known_order_is_found_and_bounds_the_error() {
        // 1 + h² at h = 2, 1.4, 1.
        let values = [2.0f64, 1.4, 1.0].map(|h| 1.0 + 0.01 * h * h);
        let (order, gci) = grid_convergence_index(values, [2.0 / 1.4, 1.4]);
        assert!((order.unwrap() - 2.0).abs() < 1e-6);
        let error = values[1] - 1.0;
        assert!(gci > error && gci < 1.4 * error, "{gci} {error}");
    }

    #[test]
    fn values_that_swing_are_judged_with_care() {
        let (order, gci) = grid_convergence_index([1.0, 1.01, 1.005], [1.4, 1.4]);
        assert!(order.is_none() && gci > 0.02);
    }
}
