//! Branches, step by step.

use std::f64::consts::FRAC_PI_2;

use super::branch::{Branch, BranchPoint, End, PointKind};
use super::error::ContinuationError;
use super::family::Family;
use super::kept_step::{KeptStep, StepEnd, StepStore, Unkept};
use super::kink::past_kink;
use super::locate::{Judged, crossed, locate, value};
use super::options::{ContinuationOptions, Scales};
use super::space::{Corrected, Space, Stop, dot, norm};

/// Which way a branch is followed from its first point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// λ grows at first.
    Up,
    /// λ falls at first.
    Down,
}

/// Most factor by which a step grows from one point to the next.
const GROWTH: f64 = 1.6;

/// A turn that stays within these shares of itself when the step is halved is a kink of the branch, as equations with
/// kinks have them: no shorter step would avoid it. That onto another stretch of the branch, beside this one, grows
/// instead.
const KINK: [f64; 2] = [0.75, 1.1];

/// Least steps from which on the chord counts: nearer to a kink a point may be beyond it already.
const CHORD: f64 = 1e3;

/// Share of its values at both ends of a step below which a test function has vanished between, rather than jumped at a
/// kink.
const VANISHED: f64 = 1e-2;

/// Least steps before a kink at which the sense of the branch is taken: nearer to it a point may be beyond it already.
const FAR: f64 = 100.0;

/// Follows a branch from a solution near `start` at λ = `lambda`.
///
/// # Errors
/// If sizes or options are out of range, or there is no solution near the start. Whatever happens later ends the
/// branch and stands in [`Branch::ends`].
pub fn trace<F: Family>(
    family: &mut F,
    start: &[f64],
    lambda: f64,
    direction: Direction,
    scales: &Scales,
    options: &ContinuationOptions,
) -> Result<Branch<F::Error>, ContinuationError<F::Error>> {
    let mut space = Space::new(family, scales)?;
    let first = begin(&mut space, start, lambda, options)?;
    let first = if direction == Direction::Down { first.turned_back() } else { first };
    let (points, end) = follow(&mut space, first, options, (direction, &mut Unkept))?;
    Ok(Branch { points, ends: [End::Start, end] })
}

/// Follows a branch both ways from a solution near `start` = (y, λ), with every step kept in `store` and those found
/// there not taken again: the same start, scales and options must have been used. Points are in order from the end
/// reached downwards to that reached upwards, with tangents and arc lengths (negative below the start) in that sense.
///
/// # Errors
/// As [`trace`], or if the store fails.
pub fn trace_both<F: Family>(
    family: &mut F,
    start: (&[f64], f64),
    scales: &Scales,
    options: &ContinuationOptions,
    store: &mut dyn StepStore<F>,
) -> Result<Branch<F::Error>, ContinuationError<F::Error>> {
    let mut space = Space::new(family, scales)?;
    let (first, back) = match loaded(store, Direction::Down, (0, start.1))?.and_then(reached) {
        Some(Judged { at: back, .. }) => (back.turned_back(), back),
        None => {
            let first = begin(&mut space, start.0, start.1, options)?;
            (first.clone(), first.turned_back())
        }
    };
    let (mut points, down) = follow(&mut space, back, options, (Direction::Down, store))?;
    points.reverse();
    for point in &mut points {
        point.arc = -point.arc;
        point.tangent.iter_mut().for_each(|t| *t = -*t);
    }
    if matches!(down, End::Closed) {
        return Ok(Branch { points, ends: [End::Closed, End::Closed] });
    }
    let (further, up) = follow(&mut space, first, options, (Direction::Up, store))?;
    points.extend(further.into_iter().skip(1));
    Ok(Branch { points, ends: [down, up] })
}

/// Factors on the first step at which a solution beside a branch point is sought.
const BESIDE: [f64; 6] = [1.0, 0.3, 0.1, 0.03, 0.01, 0.003];

/// Follows the branch that crosses another one at `from`, one way: to the side of `direction`, a null vector of ∂F/∂y
/// there (n entries), with every step kept in `store`, as by [`trace_both`]; its direction is [`Direction::Up`]. Its
/// first point is the first step away from `from`.
///
/// # Errors
/// As [`trace`], if there is no solution off the known branch to that side, or if the store fails.
pub fn branch_off<F: Family>(
    family: &mut F,
    (from, direction): (&BranchPoint, &[f64]),
    scales: &Scales,
    options: &ContinuationOptions,
    store: &mut dyn StepStore<F>,
) -> Result<Branch<F::Error>, ContinuationError<F::Error>> {
    options.check()?;
    let mut space = Space::new(family, scales)?;
    let wanted = scales.unknowns.len();
    for (what, got) in [("the direction", direction.len()), ("the branch point", from.y.len())] {
        if got != wanted {
            return Err(ContinuationError::Size { what, got, wanted });
        }
    }
    let (u, t) = (space.scaled(&from.y, from.lambda), &from.tangent);
    let off = space.scaled(direction, 0.0);
    // Across the known branch, so that it meets the hyperplane of the first step at the branch point alone.
    let along = dot(&off, t);
    let off: Vec<f64> = off.iter().zip(t).map(|(o, t)| o - along * t).collect();
    let length = norm(&off);
    if !(length > 0.0 && length.is_finite()) {
        return Err(ContinuationError::NoTangent { lambda: from.lambda });
    }
    let off: Vec<f64> = off.iter().map(|o| o / length).collect();
    let towards = Direction::Up;
    if let Some(first) = loaded(store, towards, (0, from.lambda))?.and_then(reached) {
        let (points, end) = follow(&mut space, first.at, options, (towards, store))?;
        return Ok(Branch { points, ends: [End::Start, end] });
    }
    let mut last = ContinuationError::NoTangent { lambda: from.lambda };
    for share in BESIDE {
        let h = share * options.first_step;
        let predicted: Vec<f64> = u.iter().zip(&off).map(|(u, o)| u + h * o).collect();
        match space.correct(&predicted, &off, stop(options)) {
            Ok(mut first) if distance(&first.u, &predicted) <= h => {
                space.orient(&mut first, &off)?;
                let (points, end) = follow(&mut space, first, options, (towards, store))?;
                return Ok(Branch { points, ends: [End::Start, end] });
            }
            Ok(_) => {}
            Err(error) => last = error,
        }
    }
    Err(last)
}

/// First point of a branch, its tangent towards greater λ.
fn begin<F: Family>(
    space: &mut Space<'_, F>,
    start: &[f64],
    lambda: f64,
    options: &ContinuationOptions,
) -> Result<Corrected, ContinuationError<F::Error>> {
    options.check()?;
    let [low, high] = options.bounds;
    if !(low <= lambda && lambda <= high) {
        let (what, allowed) = ("the first parameter", "it must be within the bounds");
        return Err(ContinuationError::Option { what, value: lambda, allowed });
    }
    let (got, wanted) = (start.len(), space.family.dimension());
    if got != wanted {
        return Err(ContinuationError::Size { what: "the start", got, wanted });
    }
    let (stop, u) = (stop(options), space.scaled(start, lambda));
    let fixed = space.fixed_parameter();
    let (mut at, border) = match space.correct(&u, &fixed, stop) {
        Ok(at) => (at, fixed),
        Err(error) => {
            // At a fold λ cannot be kept: it may move with all unknowns.
            let even = vec![(u.len() as f64).sqrt().recip(); u.len()];
            let at = space.correct(&u, &even, stop).map_err(|_| error)?;
            (at, even)
        }
    };
    space.orient(&mut at, &border)?;
    Ok(if at.tangent.last().is_some_and(|t| *t < 0.0) { at.turned_back() } else { at })
}

fn stop(options: &ContinuationOptions) -> Stop {
    Stop { correction: options.correction, most_iterations: options.most_iterations }
}

/// A step that was kept; `at`: its number, and a parameter for messages.
fn loaded<F: Family>(
    store: &mut dyn StepStore<F>,
    towards: Direction,
    (number, lambda): (usize, f64),
) -> Result<Option<KeptStep>, ContinuationError<F::Error>> {
    let found = store.load(towards, number);
    found.map_err(|cause| ContinuationError::Family { lambda, cause })
}

/// The point that a kept step ends at.
fn reached(step: KeptStep) -> Option<Judged> {
    let BranchPoint { tangent, judgement, iterations, .. } = step.points.into_iter().next_back()?;
    let (u, orientation) = (step.scaled, step.orientation);
    Some(Judged { at: Corrected { u, tangent, orientation, iterations }, judgement })
}

/// Points along a branch from its first one, and why they end. Steps that are in the store are not taken again.
#[allow(clippy::type_complexity)]
fn follow<F: Family>(
    space: &mut Space<'_, F>,
    first: Corrected,
    options: &ContinuationOptions,
    (towards, store): (Direction, &mut dyn StepStore<F>),
) -> Result<(Vec<BranchPoint>, End<F::Error>), ContinuationError<F::Error>> {
    let stop = stop(options);
    let (first, first_tangent, at_first) = (first.u.clone(), first.tangent.clone(), first);
    let mut points: Vec<BranchPoint> = Vec::new();
    let mut h = options.first_step.clamp(options.steps[0], options.steps[1]);
    let mut was_away = false;
    let (mut kept, mut number) = (None, 0);
    while let Some(step) = loaded(store, towards, (number, space.lambda(&first)))? {
        points.extend(step.points.iter().cloned());
        (h, was_away, number) = (step.next_step, step.was_away, number + 1);
        match step.end {
            Some(StepEnd::Bound) => return Ok((points, End::Bound)),
            Some(StepEnd::Closed) => return Ok((points, End::Closed)),
            None => kept = reached(step),
        }
    }
    let mut save = |space: &mut Space<'_, F>, last: &Judged, step: KeptStep| {
        let lambda = space.lambda(&last.at.u);
        let saved = store.save(space.family, towards, number, &step);
        number += 1;
        saved.map_err(|cause| ContinuationError::Family { lambda, cause })
    };
    let mut last = match kept {
        Some(last) => last,
        None => {
            let last = judge(space, at_first)?;
            points = vec![point(space, &last, PointKind::Regular, 0.0)];
            let (points, scaled) = (points.clone(), last.at.u.clone());
            let (orientation, next_step, end) = (last.at.orientation, h, None);
            let step = KeptStep { points, scaled, orientation, next_step, was_away, end };
            save(space, &last, step)?;
            last
        }
    };
    let mut arc = points.last().map_or(0.0, |p| p.arc);
    // Turn of the last step refused, and that allowed.
    let (mut refused, mut most_turn) = (f64::INFINITY, options.most_turn);
    let end = loop {
        if points.len() >= options.most_points {
            break End::MostPoints;
        }
        let (next, is_last) = match advance(space, &last, (h, most_turn), options, stop) {
            Ok(Step::To(next)) => (next, false),
            Ok(Step::Bound(Some(next))) => (next, true),
            Ok(Step::Bound(None)) => break End::Bound,
            Ok(Step::TooLong(turn)) if is_kink(turn, refused) => {
                most_turn = FRAC_PI_2;
                continue;
            }
            Ok(Step::TooLong(turn)) if h > options.steps[0] => {
                (refused, h) = (turn, (0.5 * h).max(options.steps[0]));
                continue;
            }
            Err(_) if h > options.steps[0] => {
                (refused, h) = (f64::INFINITY, (0.5 * h).max(options.steps[0]));
                continue;
            }
            refused => {
                let lambda = space.lambda(&last.at.u);
                let why = match refused {
                    Err(error) => error,
                    Ok(Step::TooLong(turn)) => ContinuationError::Turn { lambda, turn },
                    Ok(_) => ContinuationError::NoTangent { lambda },
                };
                let reach = [options.steps[0], options.first_step.min(options.steps[1])];
                let sense = sense_before(space, &points, arc - FAR * options.steps[0]);
                match past_kink(space, &last.at, sense, reach, stop) {
                    Some(next) if is_within(space, &next.u, options) => match judge(space, next) {
                        Ok(next) => (next, false),
                        Err(error) => break End::Stuck(error),
                    },
                    _ => break End::Stuck(why),
                }
            }
        };
        let turn = turn(&last.at, &next.at, options.steps[0]);
        let whole = distance(&next.at.u, &last.at.u);
        let (mut between, before) = (Vec::new(), points.len());
        let mut meets_branch = false;
        for kind in crossed(&last, &next) {
            match locate(space, (&last, &next), kind, options.location, stop) {
                Ok((found, along)) => {
                    let at = arc + along.abs().min(whole);
                    let largest = [&last, &next].map(|end| value(kind, end).abs());
                    meets_branch |= kind != PointKind::Fold
                        && value(kind, &found).abs() <= VANISHED * largest[0].max(largest[1]);
                    between.push((along, point(space, &found, kind, at)));
                }
                // At a kink the last point is as near to the fold as steps lead.
                Err(_) if kind == PointKind::Fold => {
                    between.push((0.0, point(space, &last, kind, arc)));
                }
                // One that cannot be located leaves its neighbours, whose signs still tell of it.
                Err(_) => {}
            }
        }
        // The sign stays along a branch, but for branch points: the step has led to another branch, or back along this
        // one.
        let is_other = next.at.orientation * last.at.orientation < 0.0;
        if is_other && !meets_branch && h > options.steps[0] {
            (refused, h) = (f64::INFINITY, (0.5 * h).max(options.steps[0]));
            continue;
        }
        (refused, most_turn) = (f64::INFINITY, options.most_turn);
        between.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.extend(between.into_iter().map(|(_, p)| p));
        arc += whole;
        let iterations = next.at.iterations;
        points.push(point(space, &next, PointKind::Regular, arc));
        let near = distance(&next.at.u, &first);
        let crossed_first = dot(&minus(&first, &last.at.u), &minus(&next.at.u, &first)) > 0.0;
        last = next;
        was_away |= near > 4.0 * options.steps[1].min(whole.max(options.first_step));
        // Beyond a sharp turn the branch may pass its first point closely, in the other sense.
        let is_along_first = dot(&last.at.tangent, &first_tangent) > 0.0;
        let is_closed = was_away && near <= whole && crossed_first && is_along_first;
        // Longer where Newton's method is quick and the branch straight.
        let by_iterations = options.wanted_iterations as f64 / iterations as f64;
        let by_turn = 0.5 * options.most_turn / turn.max(1e-12);
        h = (h * by_iterations.min(by_turn).clamp(0.5, GROWTH))
            .clamp(options.steps[0], options.steps[1]);
        let end = match (is_last, is_closed) {
            (true, _) => Some(StepEnd::Bound),
            (false, true) => Some(StepEnd::Closed),
            (false, false) => None,
        };
        let (points, scaled) = (points[before..].to_vec(), last.at.u.clone());
        let (orientation, next_step) = (last.at.orientation, h);
        save(space, &last, KeptStep { points, scaled, orientation, next_step, was_away, end })?;
        match end {
            Some(StepEnd::Bound) => break End::Bound,
            Some(StepEnd::Closed) => break End::Closed,
            None => {}
        }
    };
    Ok((points, end))
}

/// Sign of det [∂F/∂u; tᵀ] at the last regular point up to an arc length, or at the first point; 0 if it cannot be
/// told.
fn sense_before<F: Family>(space: &mut Space<'_, F>, points: &[BranchPoint], arc: f64) -> f64 {
    let is_before = |p: &&BranchPoint| p.kind == PointKind::Regular && p.arc <= arc;
    let Some(p) = points.iter().rev().find(is_before).or(points.first()) else { return 0.0 };
    let u = space.scaled(&p.y, p.lambda);
    space.orientation(&u, &p.tangent).unwrap_or(0.0)
}

/// One step.
enum Step {
    /// To a point further along.
    To(Judged),
    /// To the bound of the parameter; without a point if the last one is there.
    Bound(Option<Judged>),
    /// The branch turns too far for this step: by this angle, rad.
    TooLong(f64),
}

fn advance<F: Family>(
    space: &mut Space<'_, F>,
    last: &Judged,
    (h, most_turn): (f64, f64),
    options: &ContinuationOptions,
    stop: Stop,
) -> Result<Step, ContinuationError<F::Error>> {
    let (u, t) = (&last.at.u, &last.at.tangent);
    let predicted: Vec<f64> = u.iter().zip(t).map(|(u, t)| u + h * t).collect();
    let mut next = space.correct(&predicted, t, stop)?;
    // Infinite where the correction led far away.
    let turn = |next: &Corrected| match distance(&next.u, u) <= 2.0 * h {
        true => turn(&last.at, next, options.steps[0]),
        false => f64::INFINITY,
    };
    if turn(&next) > most_turn {
        return Ok(Step::TooLong(turn(&next)));
    }
    let [low, high] = options.bounds;
    let lambda = space.lambda(&next.u);
    if is_within(space, &next.u, options) {
        return Ok(Step::To(judge(space, next)?));
    }
    // The point at the bound, from the chord to the one beyond it.
    let bound = if lambda < low { low } else { high };
    let part = (bound - space.lambda(u)) / (lambda - space.lambda(u));
    if part <= 0.0 {
        return Ok(Step::Bound(None));
    }
    let mut start: Vec<f64> = u.iter().zip(&next.u).map(|(a, b)| a + part * (b - a)).collect();
    if let Some(own) = start.last_mut() {
        *own = bound / space.parameter_scale();
    }
    let iterations = next.iterations;
    next = space.correct(&start, &space.fixed_parameter(), stop)?;
    space.orient(&mut next, t)?;
    next.iterations += iterations;
    if turn(&next) > most_turn {
        return Ok(Step::TooLong(turn(&next)));
    }
    Ok(Step::Bound(Some(judge(space, next)?)))
}

/// Angle by which a branch turns from one point to another: from the tangent at the first to the chord, and on to the
/// tangent at the other, rad. The tangents alone are parallel again where a step has skipped two folds; they count
/// alone within a thousand
/// `least` steps, where a point may be beyond a kink already and the chord says nothing.
fn turn(from: &Corrected, to: &Corrected, least: f64) -> f64 {
    let chord = minus(&to.u, &from.u);
    let length = norm(&chord);
    if length < CHORD * least {
        return dot(&from.tangent, &to.tangent).clamp(-1.0, 1.0).acos();
    }
    let angle = |t: &[f64]| (dot(&chord, t) / length).clamp(-1.0, 1.0).acos();
    angle(&from.tangent) + angle(&to.tangent)
}

/// Whether a turn is that of a kink, after one that was `refused` with twice the step.
fn is_kink(turn: f64, refused: f64) -> bool {
    turn > KINK[0] * refused && turn < KINK[1] * refused && turn < FRAC_PI_2
}

fn judge<F: Family>(
    space: &mut Space<'_, F>,
    at: Corrected,
) -> Result<Judged, ContinuationError<F::Error>> {
    let (y, lambda) = space.plain(&at.u);
    let judgement = space.family.judge(&y, lambda);
    let judgement = judgement.map_err(|cause| ContinuationError::Family { lambda, cause })?;
    Ok(Judged { at, judgement })
}

fn point<F: Family>(space: &Space<'_, F>, of: &Judged, kind: PointKind, arc: f64) -> BranchPoint {
    let (y, lambda) = space.plain(&of.at.u);
    let (tangent, iterations) = (of.at.tangent.clone(), of.at.iterations);
    BranchPoint { y, lambda, tangent, arc, kind, judgement: of.judgement.clone(), iterations }
}

fn is_within<F: Family>(space: &Space<'_, F>, u: &[f64], options: &ContinuationOptions) -> bool {
    let [low, high] = options.bounds;
    (low..=high).contains(&space.lambda(u))
}

fn minus(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    norm(&minus(a, b))
}
