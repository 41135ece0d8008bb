//! Two equal gears pressed together: pressures of hat shape on flanks whose elements resolve the patch.
//!
//! The driven gear is the driving one turned by 180° about the pitch point. The driving gear is turned by an angle θ
//! from where the flanks would touch without relief, and the gaps are measured between the true curves in that
//! position. The weak form of contact is met by pressures p ≥ 0 on hats N_i along the driving flank: ∫ N_i (gap +
//! relative displacement) dl ≥ 0, complementary to p_i. Pressures act along the mean of both flanks' normals, equal and
//! opposite, and have the arms about the gears' centres that follow from where they act.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use crate::elastic::{Flexibility, GAUSS, parabolas};
use crate::gear::{ExternalGear, Point, dot, moved, turned};

pub(crate) struct Pair<'a> {
    pub(crate) gear: &'a ExternalGear,
    pub(crate) centre_distance: f64,
    pub(crate) pressure_angle: f64,
    pub(crate) flexibility: &'a Flexibility,
}

/// Equilibrium of the pair at one position.
#[derive(Debug, Clone)]
pub(crate) struct Answer {
    /// r_b θ, mm.
    pub(crate) deflection: f64,
    /// (pair, force in N per mm of face): sums of contact forces.
    pub(crate) forces: Vec<(i32, f64)>,
    /// Torques on driving and driven gear over the base radius, N/mm.
    pub(crate) torques: [f64; 2],
    /// Loaded hats.
    pub(crate) loaded: usize,
    /// Largest pressure, MPa.
    pub(crate) peak: f64,
}

/// Weights of flank nodes, in the tooth's frame: as the loaded tooth is divided, and as its neighbours are.
#[derive(Default)]
struct Weights {
    fine: Vec<(usize, Point)>,
    coarse: Vec<(usize, Point)>,
}

struct Hat {
    pair: i32,
    driver: Weights,
    driven: Weights,
    /// ∫ N gap, ∫ N, and ∫ N arm / r_b of both gears.
    gap: f64,
    size: f64,
    arms: [f64; 2],
}

/// Where both flanks face each other.
struct Facing {
    s: [f64; 2],
    gap: f64,
    /// From the driving to the driven flank.
    normal: Point,
    point: Point,
}

impl Pair<'_> {
    fn base_pitch(&self) -> f64 {
        self.gear.base * self.gear.pitch_angle()
    }

    /// Answer at a mesh phase (cycles, 0 where pair 0 begins the path of contact); `force` is the torque on the driving
    /// gear over its base radius, N per mm of face.
    ///
    /// # Panics
    /// If no position is found in 200 steps.
    pub(crate) fn at(&self, phase: f64, force: f64) -> Answer {
        // The force grows with the angle: bisection on an interval that grows until it is enough.
        let (mut low, mut high) = (0.0, 1e-3);
        while self.pressed(phase, high).torques[0] < force {
            (low, high) = (high, 2.0 * high);
            assert!(high < 1.0, "no load at phase {phase}");
        }
        let (mut f_low, mut f_high) = (-force, f64::NAN);
        for step in 0..200 {
            // Regula falsi with a bisection every third step.
            let middle = if step % 3 == 0 || f_high.is_nan() {
                0.5 * (low + high)
            } else {
                low + (high - low) * (-f_low) / (f_high - f_low)
            };
            let answer = self.pressed(phase, middle);
            let off = answer.torques[0] - force;
            if off.abs() < 1e-9 * force {
                return answer;
            }
            if off < 0.0 {
                (low, f_low) = (middle, off);
            } else {
                (high, f_high) = (middle, off);
            }
        }
        panic!("no equilibrium at phase {phase} under {force} N/mm")
    }

    /// Answer with the driving gear turned by `approach`/r_b.
    fn pressed(&self, phase: f64, approach: f64) -> Answer {
        let hats: Vec<Hat> = (-2..=2).flat_map(|k| self.hats(phase, approach, k)).collect();
        let n = hats.len();
        let mut compliance = DMatrix::<f64>::zeros(n, n);
        for (i, a) in hats.iter().enumerate() {
            for (j, b) in hats.iter().enumerate().take(i + 1) {
                let value = self.moved_by(a, b);
                compliance[(i, j)] = value;
                compliance[(j, i)] = value;
            }
        }
        let gaps = DVector::from_iterator(n, hats.iter().map(|h| h.gap));
        let pressures = complementary(&compliance, &gaps);
        let mut answer = Answer {
            deflection: approach,
            forces: Vec::new(),
            torques: [0.0; 2],
            loaded: pressures.iter().filter(|p| **p > 0.0).count(),
            peak: pressures.iter().copied().fold(0.0, f64::max),
        };
        for (hat, p) in hats.iter().zip(pressures.iter()) {
            match answer.forces.iter_mut().find(|f| f.0 == hat.pair) {
                Some(found) => found.1 += p * hat.size,
                None => answer.forces.push((hat.pair, p * hat.size)),
            }
            for (torque, arm) in answer.torques.iter_mut().zip(hat.arms) {
                *torque += p * arm;
            }
        }
        answer.forces.retain(|f| f.1 > 0.0);
        answer
    }

    /// Weak opening at hat `a` per unit of pressure on hat `b`.
    fn moved_by(&self, a: &Hat, b: &Hat) -> f64 {
        let apart = a.pair - b.pair;
        if apart.abs() > 1 {
            return 0.0;
        }
        let at = |w: &Weights| if apart == 0 { w.fine.clone() } else { w.coarse.clone() };
        // The driven gear turns the other way: its next tooth into contact has the smaller angle.
        self.flexibility.work(apart, &at(&a.driver), &b.driver.fine)
            + self.flexibility.work(-apart, &at(&a.driven), &b.driven.fine)
    }

    /// Angles of the frames of both gears' teeth of pair k.
    fn turns(&self, phase: f64, approach: f64, k: i32) -> ([f64; 2], [f64; 2]) {
        let path = self.centre_distance * self.pressure_angle.sin();
        let first = path - self.gear.tip_roll_length() + (phase + f64::from(k)) * self.base_pitch();
        let s = [first, path - first];
        let mut turns = s.map(|s| s / self.gear.base - self.pressure_angle - self.gear.origin);
        turns[0] += approach / self.gear.base;
        (turns, s)
    }

    /// Hats of pair k whose flanks overlap in the turned position; the others cannot be loaded.
    fn hats(&self, phase: f64, approach: f64, k: i32) -> Vec<Hat> {
        let gear = self.gear;
        let (turns, s) = self.turns(phase, approach, k);
        let (form, tip) = (gear.form_roll_length(), gear.tip_roll_length());
        if s[0] < form - 1.0 || s[1] < form - 1.0 || s[0] > tip + 3.0 || s[1] > tip + 3.0 {
            return Vec::new();
        }
        // Beyond its tip a flank touches with the corner, which has the other flank's normal.
        let own = if s[0] > tip {
            Some(1)
        } else if s[1] > tip {
            Some(0)
        } else {
            None
        };
        let start = gear.arc(form);
        let elements = self.flexibility.elements(0);
        let width = (gear.arc(tip) - start) / elements as f64;
        let mut hats = BTreeMap::new();
        for cell in 0..elements {
            let middle = start + (cell as f64 + 0.5) * width;
            // Far from the contact point nothing overlaps: the gap there is x²/(2R).
            if (middle - gear.arc(s[0].min(tip))).abs() > 1.5 {
                continue;
            }
            for (x, w) in GAUSS
                .into_iter()
                .flat_map(|(x, w)| [-0.5, 0.5].map(|half| (half + 0.5 * x, 0.5 * w)))
            {
                let mine = gear.roll_length_at_arc(middle + 0.5 * x * width);
                let along = [mine, s[0] + s[1] - mine];
                let Some(facing) = facing(gear, self.centre_distance, turns, along, own) else {
                    continue;
                };
                if facing.s[1] > tip || facing.s[1] < form {
                    continue;
                }
                for (which, share) in [(cell, 0.5 - 0.5 * x), (cell + 1, 0.5 + 0.5 * x)] {
                    let hat = hats.entry(which).or_insert_with(|| Hat::of(k));
                    self.add(hat, &facing, turns, 0.5 * w * width * share);
                }
            }
        }
        hats.into_values().filter(|hat| hat.gap < 0.0).collect()
    }

    /// Adds a point of quadrature of weight `w` to a hat.
    fn add(&self, hat: &mut Hat, facing: &Facing, turns: [f64; 2], w: f64) {
        hat.gap += w * facing.gap;
        hat.size += w;
        let n = facing.normal;
        let cross = |p: Point| p[0] * n[1] - p[1] * n[0];
        hat.arms[0] += w * cross(facing.point) / self.gear.base;
        let from_driven = [facing.point[0] - self.centre_distance, facing.point[1]];
        hat.arms[1] -= w * cross(from_driven) / self.gear.base;
        // An outward movement of either flank closes the gap, a pressure moves both inwards: in frames of the
        // teeth pressures act along −n on the driving one and, it being turned by 180°, along −n on the driven one too.
        let sides = [&mut hat.driver, &mut hat.driven];
        for ((weights, s), turn) in sides.into_iter().zip(facing.s).zip(turns) {
            let along = turned(n, -turn);
            for (tooth, list) in [(0, &mut weights.fine), (1, &mut weights.coarse)] {
                for (node, share) in self.nodes_at(tooth, s) {
                    let part = [w * share * along[0], w * share * along[1]];
                    match list.iter_mut().find(|e| e.0 == node) {
                        Some(found) => found.1 = moved(found.1, 1.0, part),
                        None => list.push((node, part)),
                    }
                }
            }
        }
    }

    /// Nodes of the flank element at a roll length, with their shares.
    fn nodes_at(&self, tooth: i32, s: f64) -> [(usize, f64); 3] {
        let gear = self.gear;
        let start = gear.arc(gear.form_roll_length());
        let elements = self.flexibility.elements(tooth);
        let at =
            (gear.arc(s) - start) / (gear.arc(gear.tip_roll_length()) - start) * elements as f64;
        let element = (at.max(0.0) as usize).min(elements - 1);
        let (shares, _) = parabolas(2.0 * (at - element as f64) - 1.0);
        std::array::from_fn(|i| (2 * element + i, shares[i]))
    }
}

/// The place of the driven flank that the driving one's point at roll length `s` faces, along the mean of both normals
/// or along that of one of the two gears; the search starts at roll length `guess`.
fn facing(
    gear: &ExternalGear,
    centre_distance: f64,
    turns: [f64; 2],
    [s, guess]: [f64; 2],
    normal_of: Option<usize>,
) -> Option<Facing> {
    let point = turned(gear.flank(s), turns[0]);
    let mine = turned(gear.normal(s), turns[0]);
    let mut t = guess;
    for _ in 0..40 {
        let theirs = turned(gear.normal(t), turns[1]);
        let sum = match normal_of {
            None => moved(mine, 1.0, theirs),
            Some(0) => mine,
            Some(_) => theirs,
        };
        let size = sum[0].hypot(sum[1]);
        let normal = [sum[0] / size, sum[1] / size];
        let there = turned(gear.flank(t), turns[1]);
        let between = [centre_distance - there[0] - point[0], -there[1] - point[1]];
        let gap = dot(between, normal);
        // Along the driven flank its arc grows against the driving one's.
        let along = dot(between, [-normal[1], normal[0]]);
        if along.abs() < 1e-12 {
            return Some(Facing { s: [s, t], gap, normal, point });
        }
        t = (t - along * gear.base / t).max(1e-3);
    }
    None
}

/// Gap of a driving flank's point at roll length `s` on the line of action, with nothing turned.
pub(crate) fn gap_on_the_line_of_action(gear: &ExternalGear, pressure_angle: f64, s: f64) -> f64 {
    let path = 2.0 * gear.base * pressure_angle.tan();
    let turns = [s, path - s].map(|s| s / gear.base - pressure_angle - gear.origin);
    let centre_distance = 2.0 * gear.base / pressure_angle.cos();
    facing(gear, centre_distance, turns, [s, path - s], None).map_or(f64::NAN, |f| f.gap)
}

impl Hat {
    fn of(pair: i32) -> Self {
        let (driver, driven) = Default::default();
        Self { pair, driver, driven, gap: 0.0, size: 0.0, arms: [0.0; 2] }
    }
}

/// p ≥ 0 with C p + g ≥ 0 and pᵀ(C p + g) = 0: all cells that pull are dropped, all that overlap are taken in, until
/// none does.
///
/// # Panics
/// If the set does not settle in a hundred rounds.
fn complementary(c: &DMatrix<f64>, g: &DVector<f64>) -> DVector<f64> {
    let n = g.len();
    if n == 0 {
        return DVector::zeros(0);
    }
    let mut active: Vec<usize> = (0..n).collect();
    for _ in 0..100 {
        let part = DMatrix::from_fn(active.len(), active.len(), |i, j| c[(active[i], active[j])]);
        let right = DVector::from_fn(active.len(), |i, _| -g[active[i]]);
        let found = part.cholesky().expect("compliance is positive definite").solve(&right);
        let mut p = DVector::zeros(n);
        for (i, x) in active.iter().zip(found.iter()) {
            p[*i] = *x;
        }
        let opening = c * &p + g;
        let scale = g.amax();
        let next: Vec<usize> = (0..n)
            .filter(|&i| p[i] > 0.0 || (p[i] == 0.0 && opening[i] < -1e-12 * scale))
            .collect();
        if next == active {
            return p;
        }
        active = next;
    }
    panic!("the contact does not settle")
}
