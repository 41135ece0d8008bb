//! Biquadratic elements over a few teeth of a gear, the flank of the middle tooth finely divided.

use std::collections::HashMap;

use crate::gear::{ExternalGear, Point, moved, turned, unit};

/// Numbers of elements; each finer one is the coarser with every element divided into four.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Division {
    /// Along the flank of the loaded tooth.
    pub(crate) flank: usize,
    /// Along the flanks of the other teeth.
    pub(crate) other_flanks: usize,
    /// Across every tooth, narrow at its counter-clockwise flank: widths grow e^λ times.
    pub(crate) across: usize,
    pub(crate) growth: f64,
    /// Along either half of a fillet.
    pub(crate) fillet: usize,
    /// From the bore to the root.
    pub(crate) rim: usize,
    /// Whole teeth beside the loaded one on either side; the gear is cut beyond them.
    pub(crate) neighbours: i32,
}

pub(crate) struct Mesh {
    pub(crate) nodes: Vec<Point>,
    /// Nodes of an element row by row, 3 × 3.
    pub(crate) elements: Vec<[usize; 9]>,
    /// Of the loaded tooth and the next ones on either side: (number of the tooth, nodes of the counter-clockwise flank
    /// from the fillet to the tip, whose arc lengths are equally spaced).
    pub(crate) flanks: Vec<(i32, Vec<usize>)>,
    /// Nodes on the bore.
    pub(crate) bore: Vec<usize>,
}

/// A block of elements: rows of points, odd numbers of rows and of points in a row.
type Block = Vec<Vec<Point>>;

impl Mesh {
    pub(crate) fn new(gear: &ExternalGear, division: &Division) -> Self {
        let mut mesh = Merging::default();
        let mut flanks = Vec::new();
        let mut bore = Vec::new();
        for tooth in -division.neighbours..=division.neighbours {
            let along = if tooth == 0 { division.flank } else { division.other_flanks };
            let turn = f64::from(tooth) * gear.pitch_angle();
            let [blade, beneath, left, right] = sector(gear, division, along);
            let blade = mesh.add(&blade, turn);
            if tooth.abs() <= 1 {
                let first = 2 * division.fillet;
                flanks.push((tooth, blade[first..].iter().map(|row| row[0]).collect()));
            }
            for block in [beneath, left, right] {
                bore.extend_from_slice(&mesh.add(&block, turn)[0]);
            }
        }
        bore.sort_unstable();
        bore.dedup();
        Self { nodes: mesh.nodes, elements: mesh.elements, flanks, bore }
    }
}

/// Fractions from 0 to 1 whose steps grow e^λ times.
fn graded(elements: usize, growth: f64) -> Vec<f64> {
    let n = 2 * elements;
    let at = |i: usize| (growth * i as f64 / n as f64).exp_m1() / growth.exp_m1();
    (0..=n).map(|i| if growth == 0.0 { i as f64 / n as f64 } else { at(i) }).collect()
}

fn mirrored(p: Point) -> Point {
    [p[0], -p[1]]
}

fn between(a: Point, b: Point, f: f64) -> Point {
    [a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1])]
}

/// Tooth, rim beneath it, and half a tooth space with the rim beneath it on either side.
fn sector(gear: &ExternalGear, division: &Division, flank: usize) -> [Block; 4] {
    let form = gear.arc(gear.form_roll_length());
    let whole = gear.arc(gear.tip_roll_length()) - form;
    let upper = graded(division.fillet, 0.0).into_iter().map(|f| gear.fillet_point(0.5 - 0.5 * f));
    let on_flank = |f: f64| gear.flank(gear.roll_length_at_arc(form + f * whole));
    let flank = graded(flank, 0.0).into_iter().skip(1).map(on_flank);
    let ccw: Vec<Point> = upper.chain(flank).collect();
    let cw: Vec<Point> = ccw.iter().map(|&p| mirrored(p)).collect();
    let u = graded(division.across, division.growth);
    let (foot, tip) = (ccw[0], ccw[ccw.len() - 1]);
    let angle_of = |p: Point| p[1].atan2(p[0]);
    let root_line: Vec<Point> = u.iter().map(|&f| between(foot, mirrored(foot), f)).collect();
    let arc = |radius: f64, from: f64, to: f64, f: f64| {
        let [c, s] = unit(from + f * (to - from));
        [radius * c, radius * s]
    };
    let tip_radius = tip[0].hypot(tip[1]);
    let land = |f: &f64| arc(tip_radius, angle_of(tip), -angle_of(tip), *f);
    let tip_line: Vec<Point> = u.iter().map(land).collect();
    let blade = transfinite(&root_line, &tip_line, &ccw, &cw);

    // Beneath the tooth, from the bore upwards.
    let rim = graded(division.rim, 0.0);
    let seat = angle_of(foot);
    let bore_line: Vec<Point> = u.iter().map(|f| arc(gear.bore, seat, -seat, *f)).collect();
    let column = |top: Point, angle: f64| {
        let bottom = arc(gear.bore, angle, angle, 0.0);
        rim.iter().map(|&f| between(bottom, top, f)).collect::<Vec<Point>>()
    };
    let (ccw, cw) = (column(foot, seat), column(mirrored(foot), -seat));
    let beneath = transfinite(&bore_line, &root_line, &ccw, &cw);

    // Beneath half a tooth space: the lower half of the fillet, then the root circle.
    let cut = 0.5 * gear.pitch_angle();
    let lower = graded(division.fillet, 0.0).into_iter().map(|f| gear.fillet_point(0.5 + 0.5 * f));
    let lowest = angle_of(gear.fillet_point(1.0));
    let land = graded(division.fillet, 0.0).into_iter().skip(1);
    let mut top: Vec<Point> = lower.chain(land.map(|f| arc(gear.root, lowest, cut, f))).collect();
    top.reverse();
    let n = top.len() - 1;
    let bottom: Vec<Point> =
        (0..=n).map(|i| arc(gear.bore, cut, seat, i as f64 / n as f64)).collect();
    let left = transfinite(&bottom, &top, &column(top[0], cut), &ccw);
    let flip = |row: &Vec<Point>| row.iter().rev().map(|&p| mirrored(p)).collect();
    let right = left.iter().map(flip).collect();
    [blade, beneath, left, right]
}

/// Fractions of the length of a line of points.
fn fractions(line: &[Point]) -> Vec<f64> {
    let mut sum = vec![0.0];
    for pair in line.windows(2) {
        sum.push(sum[sum.len() - 1] + (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]));
    }
    let whole = sum[sum.len() - 1];
    sum.iter().map(|s| s / whole).collect()
}

/// Points between four sides by transfinite interpolation; rows run from `first` to `last`.
fn transfinite(bottom: &[Point], top: &[Point], first: &[Point], last: &[Point]) -> Block {
    let (u, v) = (fractions(top), fractions(first));
    let end = bottom.len() - 1;
    let rows = v.iter().enumerate().map(|(j, &v)| {
        let point = |(i, &u): (usize, &f64)| {
            let sides = between(first[j], last[j], u);
            let ends = between(bottom[i], top[i], v);
            let corners =
                between(between(bottom[0], bottom[end], u), between(top[0], top[end], u), v);
            moved(moved(sides, 1.0, ends), -1.0, corners)
        };
        u.iter().enumerate().map(point).collect()
    });
    rows.collect()
}

/// Blocks joined where their points coincide.
#[derive(Default)]
struct Merging {
    nodes: Vec<Point>,
    elements: Vec<[usize; 9]>,
    cells: HashMap<(i64, i64), usize>,
}

/// Points nearer than this are one node, mm.
const SAME: f64 = 1e-6;

impl Merging {
    fn node(&mut self, p: Point) -> usize {
        let cell = p.map(|x| (x / SAME).round() as i64);
        for i in -1..=1 {
            for j in -1..=1 {
                if let Some(&found) = self.cells.get(&(cell[0] + i, cell[1] + j)) {
                    return found;
                }
            }
        }
        self.nodes.push(p);
        self.cells.insert((cell[0], cell[1]), self.nodes.len() - 1);
        self.nodes.len() - 1
    }

    /// Adds a block, turned about the gear's centre; returns the numbers of its nodes.
    fn add(&mut self, block: &Block, turn: f64) -> Vec<Vec<usize>> {
        let row = |row: &Vec<Point>, own: &mut Self| {
            row.iter().map(|&p| own.node(turned(p, turn))).collect::<Vec<usize>>()
        };
        let numbers: Vec<Vec<usize>> = block.iter().map(|r| row(r, self)).collect();
        for j in (0..numbers.len() - 1).step_by(2) {
            for i in (0..numbers[0].len() - 1).step_by(2) {
                let at = |k: usize| numbers[j + k / 3][i + k % 3];
                self.elements.push(std::array::from_fn(at));
            }
        }
        numbers
    }
}
