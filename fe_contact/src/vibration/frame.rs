//! Everything of a vibrating set at one position of the mesh cycle that is the same in every cycle.

use std::ops::Range;
use std::sync::Arc;

use dynamics::{Computation, wide};
use nalgebra::{DMatrix, DVector};

use super::body::Port;
use super::frame_pattern::{FramePattern, PatternBend, PatternMesh};
use super::gear::VibratingGear;
use super::lag::PairSlot;
use super::packed::Packed;
use super::teeth::fill_port;
use crate::contact::{ContactMap, ContactMaps, Held};
use crate::error::FeError;
use crate::short_row::ShortRow;
use crate::statics::StaticSet;

/// Solved combinations of contact maps that a frame keeps.
const MOST_COMBINATIONS: usize = 6;

/// One mesh of a frame: its pairs are `first..first + count`.
#[derive(Debug, Clone)]
pub(super) struct FrameMesh {
    /// Index of its table and of the table's contact maps.
    pub(super) table: usize,
    pub(super) first: usize,
    pub(super) count: usize,
    /// Map last found to hold.
    pub(super) held: Held,
}

impl FrameMesh {
    /// The map last found to hold; `None` if none was found or it was replaced since.
    #[inline]
    pub(super) fn map<'m>(&self, maps: &'m [ContactMaps]) -> Option<&'m ContactMap> {
        maps[self.table].held(&self.held)
    }
}

/// Approaches of all pairs for given approaches b without pair forces, valid while certain maps
/// hold: δ = W b + w.
#[derive(Debug, Clone)]
pub(super) struct Combination {
    /// Ids of the maps, one per mesh.
    pub(super) maps: Vec<u64>,
    pub(super) slope: Packed,
    pub(super) offset: Vec<f64>,
    /// P = S δ + P₀ of each pair within its mesh: P₀, then its row of S.
    pub(super) laws: Vec<f64>,
    /// Pairs that touch: those with a force that changes with the approaches.
    pub(super) touching: Vec<usize>,
    /// S W between the touching pairs: change of their forces with the approaches b, N/m.
    pub(super) response: DMatrix<f64>,
}

/// Second-order term of the gap of a pair in corner contact, as `Bend` in `statics/placed.rs`.
#[derive(Debug, Clone)]
pub(super) struct FrameBend {
    /// Index among all pairs of the frame.
    pub(super) pair: usize,
    pub(super) mesh: usize,
    pub(super) slot: PairSlot,
    pub(super) row: ShortRow,
    pub(super) offset: f64,
    pub(super) curvature: f64,
    /// Δe in the present step, m.
    pub(super) moved: f64,
    /// Pair force expected at its end, N.
    pub(super) force: f64,
    /// ½ G'' Δe² in the present step, m.
    pub(super) opened: f64,
}

/// All pairs of a set at one position.
#[derive(Debug)]
pub(super) struct Frame {
    /// What depends on the position only.
    pub(super) pattern: Arc<FramePattern>,
    /// Front meshes, then the backside ones where they may touch.
    pub(super) meshes: Vec<FrameMesh>,
    /// Offset of each pair, tooth errors included, m: its approach is b·x − offset.
    pub(super) offsets: Vec<f64>,
    /// Approach on the races' coordinates within a step.
    pub(super) rows: Vec<ShortRow>,
    /// Y: reduction of the approach of one pair by a unit force on another within a step, beyond
    /// the compliance of the cells, m/N.
    pub(super) receptance: DMatrix<f64>,
    /// Static FE flexibility that no body's elastic state represents, m/N: between pairs of one
    /// mesh and, on bodies with elastic states, between pairs of different meshes.
    pub(super) lagging: DMatrix<f64>,
    /// The same by columns: rows of all pairs, or of those of the same mesh where meshes are not
    /// coupled.
    pub(super) lags: Vec<f64>,
    /// Whether the columns hold all pairs.
    pub(super) is_coupled: bool,
    /// Second-order terms of the gaps of pairs in corner contact.
    pub(super) bends: Vec<FrameBend>,
    pub(super) combinations: Vec<Combination>,
    /// Index of the combination that held in the last step.
    pub(super) used: usize,
    /// Index of the combination that is replaced next.
    pub(super) oldest: usize,
}

/// What a frame is built from.
pub(super) struct FrameInputs<'g> {
    pub(super) statics: &'g StaticSet<'g>,
    pub(super) gears: &'g [VibratingGear<'g>],
    /// A⁻¹ of the races, n×n.
    pub(super) inverse: &'g DMatrix<f64>,
    /// Weight of the forces at the end of a step in their lagged value P̃.
    pub(super) lag_end: f64,
}

impl Frame {
    /// Frame of a pattern whose meshes' tables have the indices `places`. `turned`: mesh cycles since the start.
    pub(super) fn new(
        inputs: &FrameInputs<'_>,
        pattern: Arc<FramePattern>,
        places: &[usize],
        turned: f64,
    ) -> Result<Self, FeError> {
        let count = pattern.perfect.len();
        let many = || FeError::NoEquilibrium("a tooth pair meets more than two bodies".into());
        let mesh = |(of, table): (&PatternMesh, &usize)| FrameMesh {
            table: *table,
            first: of.first,
            count: of.count,
            held: Held::default(),
        };
        let bend = |of: &PatternBend| FrameBend {
            pair: of.pair,
            mesh: of.mesh,
            slot: of.slot,
            row: of.row,
            offset: of.offset,
            curvature: of.curvature,
            moved: 0.0,
            force: 0.0,
            opened: 0.0,
        };
        let is_coupled = inputs.gears.iter().any(|gear| gear.vibrating.unknowns() > 0);
        let mut frame = Self {
            meshes: pattern.meshes.iter().zip(places).map(mesh).collect(),
            offsets: pattern.offsets.clone(),
            rows: pattern.rows.clone(),
            receptance: DMatrix::zeros(count, count),
            lagging: pattern.within.clone(),
            lags: Vec::new(),
            is_coupled,
            bends: pattern.bends.iter().map(bend).collect(),
            combinations: Vec::with_capacity(MOST_COMBINATIONS),
            used: 0,
            oldest: 0,
            pattern,
        };
        if is_coupled {
            let mut rows = frame.pattern.rigid.clone();
            for (k, gear) in inputs.gears.iter().enumerate() {
                frame.add_elastic_body(inputs, k + 1, gear, turned, &mut rows);
            }
            frame.receptance += &rows * (inputs.inverse * rows.transpose());
            let short = rows.row_iter().map(|row| ShortRow::new(row.iter().copied()));
            frame.rows = short.collect::<Option<_>>().ok_or_else(many)?;
        } else {
            // Y = R A⁻¹ Rᵀ with rows of a few entries.
            let out = frame.receptance.as_mut_slice();
            wide(Receptance { out, rows: &frame.rows, inverse: inputs.inverse });
        }
        let known = inputs.lag_end - 1.0;
        frame.receptance.zip_apply(&frame.lagging, |y, lagging| *y += known * lagging);
        // By columns: of all pairs, or of those of the same mesh.
        frame.lags = match is_coupled {
            true => frame.lagging.as_slice().to_vec(),
            false => frame.pattern.within_meshes.clone(),
        };
        Ok(frame)
    }

    /// Pairs whose approach depends on the past forces of a mesh.
    pub(super) fn lagged_by(&self, mesh: &FrameMesh) -> Range<usize> {
        if self.is_coupled { 0..self.offsets.len() } else { mesh.first..mesh.first + mesh.count }
    }

    /// Adds the elastic part of one gear, if it has elastic states: couplings, receptances between its ports, and
    /// the flexibility that these states do not represent.
    fn add_elastic_body(
        &mut self,
        inputs: &FrameInputs<'_>,
        body: usize,
        gear: &VibratingGear<'_>,
        turned: f64,
        rows: &mut DMatrix<f64>,
    ) {
        if gear.vibrating.unknowns() == 0 {
            return;
        }
        let pattern = Arc::clone(&self.pattern);
        let count = gear.body.mesh.outline.gear().teeth as i64;
        let (angle, own) = (gear.angle(turned), &pattern.own[body - 1]);
        let mut ports = vec![Port::default(); own.len()];
        for (port, (pair, e)) in ports.iter_mut().zip(own) {
            let (Some(ends), Some(teeth)) = (&pattern.ends[*pair], &pattern.teeth[*pair]) else {
                continue;
            };
            let tooth = teeth[*e].rem_euclid(count) as usize;
            fill_port(port, (gear.body, &gear.unknown_of), &ends[*e], tooth);
        }
        for ((pair, _), port) in own.iter().zip(&ports) {
            for (axis, c) in gear.vibrating.coupling(port, angle).into_iter().enumerate() {
                if let Some(i) = inputs.statics.races.of(body, axis) {
                    rows[(*pair, i)] += c;
                }
            }
        }
        let receptance = gear.vibrating.receptance(&ports);
        let carried = gear.vibrating.carried_flexibility(&ports);
        let across = &pattern.across(inputs.gears)[body - 1];
        let width = own.len();
        for (i, (a, _)) in own.iter().enumerate() {
            for (j, (b, _)) in own.iter().enumerate() {
                // `across` is 0 within a mesh, where the cells' compliance has the flexibility.
                self.lagging[(*a, *b)] += across[(i, j)] - carried[i * width + j];
                self.receptance[(*a, *b)] +=
                    receptance[i * width + j] + across[(i, j)] - carried[i * width + j];
            }
        }
    }

    /// Offsets of all pairs with the races at x (m), second-order terms of corner gaps included, m.
    pub(super) fn opened_at(&self, x: &[f64]) -> DVector<f64> {
        let mut offsets = DVector::from_column_slice(&self.offsets);
        for bend in &self.bends {
            let moved = bend.row.dot(x) - bend.offset;
            offsets[bend.pair] += 0.5 * bend.curvature * moved * moved;
        }
        offsets
    }

    /// Stores a solved combination in place of the oldest if there are too many; returns its index.
    pub(super) fn keep(&mut self, combination: Combination) -> usize {
        if self.combinations.len() < MOST_COMBINATIONS {
            self.combinations.push(combination);
            return self.combinations.len() - 1;
        }
        let place = self.oldest;
        self.oldest = (self.oldest + 1) % MOST_COMBINATIONS;
        self.combinations[place] = combination;
        place
    }

    /// Memory, bytes.
    pub(super) fn bytes(&self) -> usize {
        let matrices = [&self.receptance, &self.lagging];
        let own: usize = matrices.iter().map(|m| 8 * m.len()).sum();
        let rows = self.rows.len() * size_of::<ShortRow>();
        let of = |c: &Combination| {
            let lists = c.offset.len() + c.laws.len() + c.touching.len() + c.response.len();
            c.slope.bytes() + 8 * lists
        };
        own + rows + 8 * self.lags.len() + self.combinations.iter().map(of).sum::<usize>()
    }
}

/// R A⁻¹ Rᵀ of some rows R, to be written by columns.
struct Receptance<'r> {
    out: &'r mut [f64],
    rows: &'r [ShortRow],
    inverse: &'r DMatrix<f64>,
}

impl Computation for Receptance<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { out, rows, inverse } = self;
        let mut answer = vec![0.0; inverse.nrows()];
        for (column, on) in out.chunks_exact_mut(rows.len().max(1)).zip(rows) {
            answer.fill(0.0);
            for (i, r) in on.entries() {
                let own = inverse.as_slice()[i * answer.len()..].iter();
                answer.iter_mut().zip(own).for_each(|(x, a)| *x += r * a);
            }
            for (y, of) in column.iter_mut().zip(rows) {
                *y = of.dot(&answer);
            }
        }
    }
}
