//! Everything of a vibrating set that depends on the position in the mesh cycle only.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::body::Port;
use super::gear::VibratingGear;
use super::lag::PairSlot;
use super::packed::Packed;
use super::teeth::{ToothPoint, fill_port, tooth_points};
use crate::contact::{ContactMap, ContactMaps, Held};
use crate::error::FeError;
use crate::short_row::ShortRow;
use crate::statics::{PlacedMesh, StaticSet};

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
    /// Factor on the FE part of its flexibility.
    pub(super) flexibility_factor: f64,
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
    /// ½ G'' Δe² in the present step, m.
    pub(super) opened: f64,
}

/// All pairs of a set at one position.
#[derive(Debug)]
pub(super) struct Frame {
    /// Front meshes, then the backside ones where they may touch.
    pub(super) meshes: Vec<FrameMesh>,
    /// Offset of each pair, tooth errors included, m: its approach is b·x − offset.
    pub(super) offsets: Vec<f64>,
    /// The same without tooth errors, m.
    pub(super) perfect: Vec<f64>,
    /// Ends of each pair on the teeth; none for backside flanks.
    pub(super) ends: Vec<Option<[ToothPoint; 2]>>,
    /// Number of the tooth of each end during the first mesh cycle.
    pub(super) teeth: Vec<Option<[i64; 2]>>,
    /// (Pair, end) of the ports of each gear.
    pub(super) own: Vec<Vec<(usize, usize)>>,
    /// Approach on the races' coordinates with rigid bodies, pairs×n.
    pub(super) rigid: DMatrix<f64>,
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
    /// Index of each pair in the state of the lag.
    pub(super) slots: Vec<PairSlot>,
    pub(super) combinations: Vec<Combination>,
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
    /// Frame of the meshes `placed`, whose tables have the indices `places`; the first `front` are
    /// front flanks. `turned`: mesh cycles since the start.
    pub(super) fn new(
        inputs: &FrameInputs<'_>,
        placed: &[PlacedMesh<'_>],
        places: &[usize],
        front: usize,
        turned: f64,
    ) -> Result<Self, FeError> {
        let count: usize = placed.iter().map(|p| p.rows.len()).sum();
        let many = || FeError::NoEquilibrium("a tooth pair meets more than two bodies".into());
        let n = inputs.statics.races.count;
        let mut frame = Self {
            meshes: Vec::with_capacity(placed.len()),
            offsets: Vec::with_capacity(count),
            perfect: Vec::with_capacity(count),
            ends: Vec::with_capacity(count),
            teeth: Vec::with_capacity(count),
            own: vec![Vec::new(); inputs.gears.len()],
            rigid: DMatrix::zeros(count, n),
            rows: Vec::new(),
            receptance: DMatrix::zeros(count, count),
            lagging: DMatrix::zeros(count, count),
            lags: Vec::new(),
            is_coupled: inputs.gears.iter().any(|gear| gear.vibrating.unknowns() > 0),
            bends: Vec::new(),
            slots: Vec::with_capacity(count),
            combinations: Vec::with_capacity(MOST_COMBINATIONS),
            oldest: 0,
        };
        for (which, (mesh, table)) in placed.iter().zip(places).enumerate() {
            let first = frame.offsets.len();
            for (k, row) in mesh.rows.iter().enumerate() {
                frame.rigid.row_mut(first + k).tr_copy_from(row);
            }
            frame.perfect.extend(&mesh.offsets);
            frame.offsets.extend(mesh.offsets.iter().zip(&mesh.errors).map(|(o, e)| o + e));
            for bend in &mesh.bends {
                let (row, offset) = (bend.row.iter().copied(), bend.offset);
                frame.bends.push(FrameBend {
                    pair: first + bend.pair,
                    mesh: which,
                    slot: PairSlot::of(mesh.table.pairs[bend.pair].index),
                    row: ShortRow::new(row).ok_or_else(many)?,
                    offset,
                    curvature: bend.curvature,
                    opened: 0.0,
                });
            }
            frame.slots.extend(mesh.table.pairs.iter().map(|pair| PairSlot::of(pair.index)));
            if which < front {
                for ends in tooth_points(inputs.statics, which, mesh)? {
                    let teeth = ends.each_ref().map(|end| {
                        let gear = &inputs.gears[end.body - 1];
                        gear.tooth_at(end.axis, turned)
                    });
                    frame.ends.push(Some(ends));
                    frame.teeth.push(Some(teeth));
                }
            } else {
                frame.ends.extend(mesh.rows.iter().map(|_| None));
                frame.teeth.extend(mesh.rows.iter().map(|_| None));
            }
            frame.meshes.push(FrameMesh {
                table: *table,
                first,
                count: mesh.rows.len(),
                held: Held::default(),
                flexibility_factor: inputs.statics.bodies.flexibility_factor(mesh.kind),
            });
        }
        let mut rows = frame.rigid.clone();
        for (k, gear) in inputs.gears.iter().enumerate() {
            frame.add_body(inputs, k + 1, gear, turned, &mut rows);
        }
        frame.receptance += &rows * (inputs.inverse * rows.transpose());
        let short = rows.row_iter().map(|row| ShortRow::new(row.iter().copied()));
        frame.rows = short.collect::<Option<_>>().ok_or_else(many)?;
        frame.receptance -= (1.0 - inputs.lag_end) * &frame.lagging;
        for mesh in &frame.meshes {
            let lagged = frame.lagged_by(mesh);
            for j in mesh.first..mesh.first + mesh.count {
                frame.lags.extend(lagged.clone().map(|i| frame.lagging[(i, j)]));
            }
        }
        Ok(frame)
    }

    /// Pairs whose approach depends on the past forces of a mesh.
    pub(super) fn lagged_by(&self, mesh: &FrameMesh) -> Range<usize> {
        if self.is_coupled { 0..self.offsets.len() } else { mesh.first..mesh.first + mesh.count }
    }

    /// Mesh of each pair.
    pub(super) fn mesh_of(&self, pair: usize) -> usize {
        self.meshes.iter().position(|m| pair < m.first + m.count).unwrap_or(0)
    }

    /// Adds the elastic part of one gear: couplings, receptances between its ports, lagging
    /// flexibility.
    fn add_body(
        &mut self,
        inputs: &FrameInputs<'_>,
        body: usize,
        gear: &VibratingGear<'_>,
        turned: f64,
        rows: &mut DMatrix<f64>,
    ) {
        let mut places: Vec<usize> = Vec::new();
        let mut own: Vec<(ToothPoint, i64)> = Vec::new();
        for (pair, (ends, teeth)) in self.ends.iter().zip(&self.teeth).enumerate() {
            let (Some(ends), Some(teeth)) = (ends, teeth) else { continue };
            for (e, (end, tooth)) in ends.iter().zip(teeth).enumerate() {
                if end.body == body {
                    self.own[body - 1].push((pair, e));
                    places.push(pair);
                    own.push((end.clone(), *tooth));
                }
            }
        }
        let count = gear.body.mesh.outline.gear().teeth as i64;
        let carries = gear.vibrating.unknowns() > 0;
        let (receptance, carried) = if carries {
            let angle = gear.angle(turned);
            let mut ports = vec![Port::default(); own.len()];
            for (port, (end, tooth)) in ports.iter_mut().zip(&own) {
                let tooth = tooth.rem_euclid(count) as usize;
                fill_port(port, (gear.body, &gear.unknown_of), end, tooth);
            }
            for (pair, port) in places.iter().zip(&ports) {
                for (axis, c) in gear.vibrating.coupling(port, angle).into_iter().enumerate() {
                    if let Some(i) = inputs.statics.races.of(body, axis) {
                        rows[(*pair, i)] += c;
                    }
                }
            }
            (gear.vibrating.receptance(&ports), gear.vibrating.carried_flexibility(&ports))
        } else {
            (Vec::new(), Vec::new())
        };
        let width = own.len();
        for (i, a) in places.iter().enumerate() {
            for (j, b) in places.iter().enumerate() {
                let same = self.mesh_of(*a) == self.mesh_of(*b);
                if !same && !carries {
                    // Quasi-static bodies do not couple different meshes, as in statics.
                    continue;
                }
                let ((on, tooth_on), (of, tooth_of)) = (&own[j], &own[i]);
                let whole = gear.body.surface_flexibility(
                    (&on.end.load, on.end.direction),
                    tooth_of - tooth_on,
                    (&of.end.load, of.end.direction),
                );
                // With the factor, as in the compliance of the cells, which covers the pairs of one
                // mesh.
                let whole = whole * self.meshes[self.mesh_of(*a)].flexibility_factor;
                self.lagging[(*a, *b)] += whole;
                if carries {
                    self.lagging[(*a, *b)] -= carried[i * width + j];
                    let beyond_cells = if same { 0.0 } else { whole };
                    self.receptance[(*a, *b)] +=
                        receptance[i * width + j] + beyond_cells - carried[i * width + j];
                }
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
        let matrices = [&self.rigid, &self.receptance, &self.lagging];
        let own: usize = matrices.iter().map(|m| 8 * m.len()).sum();
        let rows = self.rows.len() * size_of::<ShortRow>();
        let of = |c: &Combination| c.slope.bytes() + 8 * (c.offset.len() + c.laws.len());
        own + rows + 8 * self.lags.len() + self.combinations.iter().map(of).sum::<usize>()
    }
}
