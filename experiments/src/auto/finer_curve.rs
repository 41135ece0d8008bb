//! The transmission error on a finer mesh, from that on a coarser one and the difference of both at some positions.
//!
//! Between positions at which both meshes are computed the difference d is taken to be linear, with the doubt
//!
//! ```text
//! r max(|d[i,j,k]|, |d[j,k,l]|) (x − x_j)(x_k − x),   r = (x_l − x_i)/(x_k − x_j) + 1,   x_i < x_j ≤ x ≤ x_k < x_l
//! ```
//!
//! where d[·,·,·] are divided differences of second order. One corner of d between x_j and x_k, where its slope changes by s at a share
//! θ of the interval w, makes them s(1 − θ)/(x_k − x_i) and sθ/(x_l − x_j), of which the larger is at least s/(r w), and the error at most
//! sθ(1 − θ)w: no more than the doubt there, and equal to it at worst. The remainder of linear interpolation where d is smooth is a part 1/r of
//! the doubt, a quarter at even positions. The positions must be close enough to show how d swings: at three in its period the doubt is too
//! small, four are enough.

use super::cycle_curve::{Curve, missing};
use crate::error::ExperimentError;

/// Positions on either side of an extreme that are computed on the finer mesh: the lines that the curve follows there need two.
const BESIDE: usize = 2;

/// What is read from a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sought {
    /// The extremes, with positions added about them to the spacing of so many in a period; of the even ones, none.
    Extremes {
        about: u32,
    },
    Mean,
}

/// The curve of a finer mesh at the even positions of a candidate and those added.
#[derive(Debug, Clone)]
pub(super) struct Corrected {
    /// Position (periods) and value (m).
    pub(super) points: Vec<[f64; 2]>,
    /// How far the value that is sought may be off by positions at which the finer mesh was not computed, m.
    pub(super) doubt: f64,
}

/// Adds positions on the finer mesh until what is sought of its curve at `even` positions, which the coarser mesh has, is known to
/// `share` of it.
///
/// Of extremes, positions are added where the curve may be beyond the highest or lowest value on the finer mesh by the doubt of the
/// difference there; beside these values, because the difference changes within a position or two where pairs begin and end to
/// touch; and about them to the spacing asked for. Of the mean, they are added where the doubt is largest.
///
/// # Errors
/// If contact cannot be solved on the finer mesh.
pub(super) fn corrected(
    (coarse, even): (&Curve<'_>, u32),
    finer: &mut Curve<'_>,
    sought: Sought,
    share: f64,
) -> Result<Corrected, ExperimentError> {
    let finest = coarse.finest();
    loop {
        let all = estimated((coarse, even), finer);
        let points = all.iter().map(|own| [f64::from(own.position) / f64::from(finest), own.value]);
        let points: Vec<[f64; 2]> = points.collect();
        let (doubt, size, wanted) = match sought {
            Sought::Extremes { .. } => beyond(&all),
            Sought::Mean => about_mean(&all),
        };
        let wanted = match (doubt <= share * size, sought) {
            (false, _) => wanted,
            (true, Sought::Mean) => Vec::new(),
            (true, Sought::Extremes { about }) => match beside_extremes(&all) {
                beside if beside.is_empty() => missing(&points, finest, about),
                beside => beside,
            },
        };
        if wanted.is_empty() {
            return Ok(Corrected { points, doubt });
        }
        finer.at(&wanted)?;
    }
}

/// The finer mesh's value at a position, m.
#[derive(Debug, Clone, Copy)]
struct Estimated {
    position: u32,
    value: f64,
    doubt: f64,
    /// Whether it was computed on the finer mesh.
    is_known: bool,
}

/// At the even positions and at those of the finer mesh, ascending.
fn estimated((coarse, even): (&Curve<'_>, u32), finer: &Curve<'_>) -> Vec<Estimated> {
    let (a, b) = (coarse.known(), finer.known());
    let spacing = coarse.finest() / even;
    let differences = b.iter().filter_map(|(x, b)| Some((*x, b - a.get(x)?)));
    let differences: Vec<(u32, f64)> = differences.collect();
    let by_coarse = a.iter().filter(|(x, _)| x.is_multiple_of(spacing) && !b.contains_key(x));
    let by_coarse = by_coarse.map(|(position, a)| {
        let [difference, doubt] = between(&differences, coarse.finest(), *position);
        let value = a + difference;
        Estimated { position: *position, value, doubt, is_known: false }
    });
    let known = b.iter().map(|(position, value)| {
        let (position, value) = (*position, *value);
        Estimated { position, value, doubt: 0.0, is_known: true }
    });
    let mut all: Vec<Estimated> = known.chain(by_coarse).collect();
    all.sort_unstable_by_key(|own| own.position);
    all
}

/// By how much the curve may be beyond its extremes on the finer mesh, above and below together; these extremes' distance; and
/// where it may be farthest beyond each.
fn beyond(all: &[Estimated]) -> (f64, f64, Vec<u32>) {
    let of = |sign: f64| {
        let known = all.iter().filter(|own| own.is_known);
        let known = known.fold(f64::NEG_INFINITY, |high, own| high.max(sign * own.value));
        let reach = |own: &Estimated| sign * own.value + own.doubt - known;
        let others = all.iter().filter(|own| !own.is_known);
        let farthest = others.max_by(|a, b| reach(a).total_cmp(&reach(b)));
        let farthest = farthest.map(|own| (own.position, reach(own)));
        (known, farthest.filter(|(_, reach)| *reach > 0.0))
    };
    let ((high, above), (low, below)) = (of(1.0), of(-1.0));
    let both: Vec<(u32, f64)> = above.into_iter().chain(below).collect();
    let mut wanted: Vec<u32> = both.iter().map(|(position, _)| *position).collect();
    wanted.dedup();
    (both.iter().fold(0.0, |sum, (_, reach)| sum + reach), high + low, wanted)
}

/// Positions to either side of the extremes on the finer mesh at which it was not computed.
fn beside_extremes(all: &[Estimated]) -> Vec<u32> {
    let n = all.len();
    let place = |sign: f64| {
        let known = (0..n).filter(|k| all[*k].is_known);
        known.max_by(|a, b| (sign * all[*a].value).total_cmp(&(sign * all[*b].value)))
    };
    let about = |at: usize| (0..=2 * BESIDE).map(move |k| (at + n + k - BESIDE.min(n)) % n);
    let extremes = [place(1.0), place(-1.0)].into_iter().flatten();
    let wanted = extremes.flat_map(about).filter(|k| !all[*k].is_known);
    let mut wanted: Vec<u32> = wanted.map(|k| all[k].position).collect();
    wanted.sort_unstable();
    wanted.dedup();
    wanted
}

/// Mean doubt, mean value, and where the doubt is largest.
fn about_mean(all: &[Estimated]) -> (f64, f64, Vec<u32>) {
    let mean = |of: fn(&Estimated) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
    let largest = all.iter().max_by(|a, b| a.doubt.total_cmp(&b.doubt));
    let largest = largest.filter(|own| own.doubt > 0.0);
    let wanted = largest.map(|own| own.position).into_iter().collect();
    (mean(|own| own.doubt), mean(|own| own.value).abs(), wanted)
}

/// The difference at a position between those at which it is known (ascending, in parts of a period), and its doubt. One or two
/// positions tell nothing of the doubt.
fn between(known: &[(u32, f64)], period: u32, position: u32) -> [f64; 2] {
    let n = known.len();
    let right = known.partition_point(|(x, _)| *x < position);
    if let Some((_, d)) = known.get(right).filter(|(x, _)| *x == position) {
        return [*d, 0.0];
    }
    if n < 3 {
        return [known.first().map_or(0.0, |(_, d)| *d), f64::INFINITY];
    }
    // Positions relative to the one that is asked for, those to the left negative.
    let place = |steps: usize, is_left: bool| {
        let (x, d) = known[(right + n + steps - usize::from(is_left) * 2 * steps) % n];
        let ahead = f64::from((x + period - position) % period);
        [if is_left { ahead - f64::from(period) } else { ahead }, d]
    };
    let [i, j, k, l] = [place(2, true), place(1, true), place(0, false), place(1, false)];
    let slope = |a: [f64; 2], b: [f64; 2]| (b[1] - a[1]) / (b[0] - a[0]);
    let bend = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (slope(b, c) - slope(a, b)) / (c[0] - a[0]);
    let curved = bend(i, j, k).abs().max(bend(j, k, l).abs());
    let of_corner = (l[0] - i[0]) / (k[0] - j[0]) + 1.0;
    // x − x_j = −x_j and x_k − x = x_k
    [j[1] - slope(j, k) * j[0], of_corner * curved * -j[0] * k[0]]
}

#[cfg(test)]
mod tests {
    use fe_contact::statics::Bodies;
    use gearset::{LoadCase, Scene, SceneKind, template};

    use super::super::cycle_curve::{mean, range};
    use super::super::settings::AutoSettings;
    use super::*;

    const PERIOD: u32 = 1200;

    fn known(step: usize, of: &dyn Fn(f64) -> f64) -> Vec<(u32, f64)> {
        (0..PERIOD).step_by(step).map(|x| (x, of(f64::from(x) / f64::from(PERIOD)))).collect()
    }

    /// Off by no more than the doubt everywhere, at one corner wherever it lies and where the difference is smooth; for a smooth one
    /// the doubt is of second order and no more than some four times too large.
    #[test]
    fn doubts_bound_the_error_at_a_corner_and_where_the_difference_is_smooth() {
        let worst = |step: usize, of: &dyn Fn(f64) -> f64| {
            let nodes = known(step, of);
            (0..PERIOD).fold([0.0f64; 2], |[error, doubt], x| {
                let [value, own] = between(&nodes, PERIOD, x);
                let off = (value - of(f64::from(x) / f64::from(PERIOD))).abs();
                assert!(off <= own * (1.0 + 1e-9) + 1e-12, "{step} {x}: {off} {own}");
                [error.max(off), doubt.max(own)]
            })
        };
        // At even positions, and with one more beside the corner.
        for (place, more) in
            [(0.5, 0), (0.503, 0), (0.5208, 0), (0.54, 0), (0.503, 610), (0.515, 610), (0.54, 640)]
        {
            let corner = move |x: f64| (x - place).abs().min(0.25);
            let mut nodes = known(50, &corner);
            if more > 0 {
                nodes.push((more, corner(f64::from(more) / f64::from(PERIOD))));
                nodes.sort_unstable_by_key(|(x, _)| *x);
            }
            let near = (480..720).map(|x| {
                let [value, doubt] = between(&nodes, PERIOD, x);
                ((value - corner(f64::from(x) / f64::from(PERIOD))).abs(), doubt)
            });
            for (off, doubt) in near {
                assert!(off <= doubt * (1.0 + 1e-9) + 1e-12, "{place} {more}: {off} {doubt}");
            }
        }
        let smooth = |x: f64| (std::f64::consts::TAU * (x - 0.123)).sin();
        let [coarse, fine] = [60, 30].map(|step| worst(step, &smooth));
        assert!(coarse[1] < 4.5 * coarse[0], "{coarse:?}");
        assert!((coarse[1] / fine[1] - 4.0).abs() < 0.2, "{coarse:?} {fine:?}");
    }

    /// Left of the first position and right of the last one the difference goes on at the other end.
    #[test]
    fn differences_are_periodic() {
        let of = |x: f64| (std::f64::consts::TAU * (x + 0.01)).cos();
        let nodes: Vec<_> = known(60, &of).into_iter().filter(|(x, _)| *x > 0).collect();
        for x in [0, 1, 59, 1141, 1199] {
            let [value, doubt] = between(&nodes, PERIOD, x);
            let off = (value - of(f64::from(x) / f64::from(PERIOD))).abs();
            assert!(off > 1e-6 && off <= doubt, "{x}: {off} {doubt}");
        }
    }

    /// Extremes and mean of the finer mesh, from some of its positions (at first four in the period of the curve), are those of all of them
    /// within the doubt, which is as small as is asked for; and about the extremes those of a refinement on the finer mesh alone.
    #[test]
    fn few_positions_of_a_finer_mesh_stand_for_all() {
        let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap();
        let scenes = [(6, 20), (10, 30)].map(|(elements, cells)| {
            AutoSettings::quasi_static(elements, cells).applied_to(&scene)
        });
        let bodies = scenes.each_ref().map(|own| Bodies::new(own).unwrap());
        let mut coarse = Curve::new(&scenes[0], &bodies[0], &case, (1, 240)).unwrap();
        coarse.at(&coarse.even(80)).unwrap();
        let mut whole = coarse.on_bodies(&bodies[1]);
        whole.at(&whole.even(80)).unwrap();
        let rounding = 1e-12 * mean(&whole.points());
        for share in [1e-2, 1e-3] {
            for (sought, of) in [
                (Sought::Extremes { about: 80 }, &range as &dyn Fn(&[[f64; 2]]) -> f64),
                (Sought::Mean, &mean),
            ] {
                let mut finer = coarse.on_bodies(&bodies[1]);
                finer.at(&finer.even(8)).unwrap();
                let found = corrected((&coarse, 80), &mut finer, sought, share).unwrap();
                let (value, exact) = (of(&found.points), of(&whole.points()));
                let off = (value - exact).abs();
                assert!(
                    off <= found.doubt + rounding,
                    "{sought:?} {share}: {off:e} {:e}",
                    found.doubt
                );
                assert!(found.doubt <= share * exact, "{sought:?} {share}: {:e}", found.doubt);
                assert!(finer.known().len() <= 24, "{sought:?}: {}", finer.known().len());
            }
        }
        let mut finer = coarse.on_bodies(&bodies[1]);
        finer.at(&finer.even(8)).unwrap();
        let found =
            corrected((&coarse, 80), &mut finer, Sought::Extremes { about: 240 }, 1e-3).unwrap();
        whole.refine(80, 240).unwrap();
        let off = (range(&found.points) - range(&whole.points())).abs();
        assert!(off <= found.doubt + rounding, "{off:e} {:e}", found.doubt);
    }
}
