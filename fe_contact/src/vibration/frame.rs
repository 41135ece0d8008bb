//! Everything of a vibrating set at one position of the mesh cycle that is the same in every cycle.

use std::ops::Range;
use std::sync::Arc;

use gearset::Body;
use nalgebra::{DMatrix, DVector};

use super::body::Port;
use super::combination::Combination;
use super::frame_pattern::{FramePattern, PatternBend, PatternMesh};
use super::gear::VibratingGear;
use super::lag::PairSlot;
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
    /// What elastic states of the bodies change; `None` without any.
    elastic: Option<ElasticPairs>,
    /// 1 less the weight of the forces at the end of a step in their lagged value P̃.
    pub(super) lag_known: f64,
    /// Second-order terms of the gaps of pairs in corner contact.
    pub(super) bends: Vec<FrameBend>,
    pub(super) combinations: Vec<Combination>,
    /// Index of the combination that held in the last step.
    pub(super) used: usize,
    /// Index of the combination that is replaced next.
    pub(super) oldest: usize,
}

/// Rows and compliances of the pairs of a frame where bodies have elastic states.
#[derive(Debug)]
struct ElasticPairs {
    /// Approach on the races' coordinates within a step.
    rows: Vec<ShortRow>,
    /// Static FE flexibility that no body's elastic state represents, between all pairs, m/N.
    lagging: DMatrix<f64>,
    /// Compliance between all pairs within a step beyond that of the cells, m/N.
    excess: DMatrix<f64>,
}

/// What a frame is built from.
pub(super) struct FrameInputs<'g> {
    pub(super) statics: &'g StaticSet<'g>,
    pub(super) gears: &'g [VibratingGear<'g>],
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
        let mut frame = Self {
            meshes: pattern.meshes.iter().zip(places).map(mesh).collect(),
            offsets: pattern.offsets.clone(),
            elastic: None,
            lag_known: 1.0 - inputs.lag_end,
            bends: pattern.bends.iter().map(bend).collect(),
            combinations: Vec::new(),
            used: 0,
            oldest: 0,
            pattern,
        };
        if inputs.gears.iter().any(|gear| gear.vibrating.unknowns() > 0) {
            let mut rows = frame.pattern.rigid.clone();
            let mut lagging = frame.pattern.within.clone();
            let mut excess = DMatrix::zeros(count, count);
            for (k, gear) in inputs.gears.iter().enumerate() {
                let into = [&mut rows, &mut lagging, &mut excess];
                frame.add_elastic_body(inputs, Body::from_index(k + 1), gear, turned, into);
            }
            excess.zip_apply(&lagging, |e, lagging| *e -= frame.lag_known * lagging);
            let short = rows.row_iter().map(|row| ShortRow::new(row.iter().copied()));
            let rows = short.collect::<Option<_>>().ok_or_else(many)?;
            frame.elastic = Some(ElasticPairs { rows, lagging, excess });
        }
        Ok(frame)
    }

    /// Approach of each pair on the races' coordinates within a step.
    #[inline]
    pub(super) fn rows(&self) -> &[ShortRow] {
        self.elastic.as_ref().map_or(&self.pattern.rows, |own| &own.rows)
    }

    /// Static FE flexibility that no body's elastic state represents, m/N: between pairs of one mesh and, on bodies
    /// with elastic states, between pairs of different meshes.
    pub(super) fn lagging(&self) -> &DMatrix<f64> {
        self.elastic.as_ref().map_or(&self.pattern.within, |own| &own.lagging)
    }

    /// The same by columns: rows of all pairs, or of those of the same mesh where meshes are not coupled.
    #[inline]
    pub(super) fn lags(&self) -> &[f64] {
        match &self.elastic {
            Some(own) => own.lagging.as_slice(),
            None => &self.pattern.within_meshes,
        }
    }

    /// Compliance E between pairs within a step beyond that of the cells, m/N, as a factor and the numbers that it
    /// multiplies: of each [group](Self::groups) the columns of its pairs, with their rows. Where no body has an
    /// elastic state, E is that of the forces which the lag holds back: −(1 − end) F.
    #[inline]
    pub(super) fn excess(&self) -> (f64, &[f64]) {
        match &self.elastic {
            Some(own) => (1.0, own.excess.as_slice()),
            None => (-self.lag_known, &self.pattern.within_meshes),
        }
    }

    /// Pairs whose approaches depend on each other's forces within a step beside those of the races' motion: the pairs
    /// of each mesh, or all pairs where bodies have elastic states.
    #[inline]
    pub(super) fn groups(&self) -> impl Iterator<Item = Range<usize>> {
        let whole = self.elastic.as_ref().map(|_| 0..self.offsets.len());
        let meshes = if whole.is_some() { &[] } else { self.meshes.as_slice() };
        whole.into_iter().chain(meshes.iter().map(|mesh| mesh.first..mesh.first + mesh.count))
    }

    /// Pairs whose approach depends on the past forces of a mesh.
    pub(super) fn lagged_by(&self, mesh: &FrameMesh) -> Range<usize> {
        match self.elastic {
            Some(_) => 0..self.offsets.len(),
            None => mesh.first..mesh.first + mesh.count,
        }
    }

    /// Adds the elastic part of one gear, if it has elastic states: couplings, receptances between its ports, and
    /// the flexibility that these states do not represent.
    fn add_elastic_body(
        &self,
        inputs: &FrameInputs<'_>,
        body: Body,
        gear: &VibratingGear<'_>,
        turned: f64,
        [rows, lagging, excess]: [&mut DMatrix<f64>; 3],
    ) {
        if gear.vibrating.unknowns() == 0 {
            return;
        }
        let pattern = Arc::clone(&self.pattern);
        let count = gear.body.mesh.outline.gear().teeth as i64;
        let (angle, own) = (gear.angle(turned), &pattern.own[body.index() - 1]);
        let mut ports = vec![Port::default(); own.len()];
        for (port, (pair, e)) in ports.iter_mut().zip(own) {
            let (Some(ends), Some(teeth)) = (&pattern.ends[*pair], &pattern.teeth[*pair]) else {
                continue;
            };
            let tooth = teeth[*e].rem_euclid(count) as usize;
            fill_port(port, (gear.body, &gear.unknown_of), &ends[*e], tooth);
        }
        for ((pair, _), port) in own.iter().zip(&ports) {
            let places = inputs.statics.races.places(body);
            for (place, c) in places.into_iter().zip(gear.vibrating.coupling(port, angle)) {
                if let Some(i) = place {
                    rows[(*pair, i)] += c;
                }
            }
        }
        let receptance = gear.vibrating.receptance(&ports);
        let carried = gear.vibrating.carried_flexibility(&ports);
        let across = &pattern.across(inputs.gears)[body.index() - 1];
        let width = own.len();
        for (i, (a, _)) in own.iter().enumerate() {
            for (j, (b, _)) in own.iter().enumerate() {
                // `across` is 0 within a mesh, where the cells' compliance has the flexibility.
                lagging[(*a, *b)] += across[(i, j)] - carried[i * width + j];
                excess[(*a, *b)] +=
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
        let of = |own: &ElasticPairs| {
            own.rows.len() * size_of::<ShortRow>() + 8 * (own.lagging.len() + own.excess.len())
        };
        let elastic = self.elastic.as_ref().map_or(0, of);
        8 * self.offsets.len()
            + elastic
            + self.combinations.iter().map(Combination::bytes).sum::<usize>()
    }
}
