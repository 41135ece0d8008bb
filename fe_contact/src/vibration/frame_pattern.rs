//! The part of a frame that depends on the position in the mesh cycle alone, not on speed, fidelity or damping:
//! sets of one scene share it.

use std::sync::{Arc, OnceLock};

use gearset::Symmetry;
use nalgebra::DMatrix;

use super::gear::VibratingGear;
use super::lag::PairSlot;
use super::teeth::{ToothPoint, tooth_points};
use crate::contact::MeshTable;
use crate::error::FeError;
use crate::short_row::ShortRow;
use crate::statics::{LinearMesh, PlacedMesh, StaticSet};

/// One mesh of a pattern: its pairs are `first..first + count`.
#[derive(Debug, Clone)]
pub(super) struct PatternMesh {
    pub(super) first: usize,
    pub(super) count: usize,
    /// Factor on the FE part of its flexibility.
    pub(super) flexibility_factor: f64,
}

/// Second-order term of the gap of a pair in corner contact, as `Bend` in `statics/placed.rs`.
#[derive(Debug, Clone)]
pub(super) struct PatternBend {
    /// Index among all pairs.
    pub(super) pair: usize,
    pub(super) mesh: usize,
    pub(super) slot: PairSlot,
    pub(super) row: ShortRow,
    pub(super) offset: f64,
    pub(super) curvature: f64,
}

/// All pairs of a set at one position.
#[derive(Debug)]
pub(super) struct FramePattern {
    /// Front meshes, then the backside ones where they may touch.
    pub(super) meshes: Vec<PatternMesh>,
    /// Tables of the backside meshes.
    pub(super) backside: Vec<Arc<MeshTable>>,
    /// Offset of each pair without tooth errors, m.
    pub(super) perfect: Vec<f64>,
    /// The same with them, m.
    pub(super) offsets: Vec<f64>,
    /// Ends of each pair on the teeth; none for backside flanks.
    pub(super) ends: Vec<Option<[ToothPoint; 2]>>,
    /// Number of the tooth of each end during the first mesh cycle.
    pub(super) teeth: Vec<Option<[i64; 2]>>,
    /// (Pair, end) of the ports of each gear.
    pub(super) own: Vec<Vec<(usize, usize)>>,
    /// Approach on the races' coordinates with rigid bodies, pairs×n.
    pub(super) rigid: DMatrix<f64>,
    /// The same, short.
    pub(super) rows: Vec<ShortRow>,
    /// Second-order terms of the gaps of pairs in corner contact.
    pub(super) bends: Vec<PatternBend>,
    /// Index of each pair in the state of the lag.
    pub(super) slots: Vec<PairSlot>,
    /// Static FE flexibility of all gears between pairs of the same mesh, m/N, others 0.
    pub(super) within: DMatrix<f64>,
    /// Its columns, of each only the rows of the pairs of the same mesh.
    pub(super) within_meshes: Vec<f64>,
    /// Between ports of different meshes, others 0; for bodies with elastic states only.
    across: OnceLock<Vec<DMatrix<f64>>>,
    /// The front meshes by linear kinematics, without the slopes of deformed flanks; only where the kinematic rest is
    /// asked for.
    linear: OnceLock<Vec<LinearMesh>>,
}

impl FramePattern {
    /// Pattern of the meshes `placed`, of which the first `front` are front flanks. `turned`: mesh cycles since the
    /// start.
    pub(super) fn new(
        statics: &StaticSet<'_>,
        gears: &[VibratingGear<'_>],
        placed: Vec<PlacedMesh<'_>>,
        front: usize,
        turned: f64,
    ) -> Result<Self, FeError> {
        let count: usize = placed.iter().map(|p| p.rows.len()).sum();
        let many = || FeError::NoEquilibrium("a tooth pair meets more than two bodies".into());
        let mut pattern = Self {
            meshes: Vec::with_capacity(placed.len()),
            backside: Vec::new(),
            perfect: Vec::with_capacity(count),
            offsets: Vec::with_capacity(count),
            ends: Vec::with_capacity(count),
            teeth: Vec::with_capacity(count),
            own: vec![Vec::new(); gears.len()],
            rigid: DMatrix::zeros(count, statics.races.count),
            rows: Vec::new(),
            bends: Vec::new(),
            slots: Vec::with_capacity(count),
            within: DMatrix::zeros(count, count),
            within_meshes: Vec::new(),
            across: OnceLock::new(),
            linear: OnceLock::new(),
        };
        for (which, mesh) in placed.iter().enumerate() {
            let first = pattern.perfect.len();
            for (k, row) in mesh.rows.iter().enumerate() {
                pattern.rigid.row_mut(first + k).tr_copy_from(row);
            }
            pattern.perfect.extend(&mesh.offsets);
            pattern.offsets.extend(mesh.offsets.iter().zip(&mesh.errors).map(|(o, e)| o + e));
            for bend in &mesh.bends {
                let (row, offset) = (bend.row.iter().copied(), bend.offset);
                pattern.bends.push(PatternBend {
                    pair: first + bend.pair,
                    mesh: which,
                    slot: PairSlot::of(mesh.table.pairs[bend.pair].index),
                    row: ShortRow::new(row).ok_or_else(many)?,
                    offset,
                    curvature: bend.curvature,
                });
            }
            pattern.slots.extend(mesh.table.pairs.iter().map(|pair| PairSlot::of(pair.index)));
            if which < front {
                for ends in tooth_points(statics, which, mesh)? {
                    let teeth = ends.each_ref().map(|end| {
                        let gear = &gears[end.body.index() - 1];
                        gear.tooth_at(end.axis, turned)
                    });
                    for (e, end) in ends.iter().enumerate() {
                        pattern.own[end.body.index() - 1].push((pattern.ends.len(), e));
                    }
                    pattern.ends.push(Some(ends));
                    pattern.teeth.push(Some(teeth));
                }
            } else {
                pattern.ends.extend(mesh.rows.iter().map(|_| None));
                pattern.teeth.extend(mesh.rows.iter().map(|_| None));
            }
            pattern.meshes.push(PatternMesh {
                first,
                count: mesh.rows.len(),
                flexibility_factor: statics.bodies.flexibility_factor(mesh.kind),
            });
        }
        let short = pattern.rigid.row_iter().map(|row| ShortRow::new(row.iter().copied()));
        pattern.rows = short.collect::<Option<_>>().ok_or_else(many)?;
        for (own, flexibility) in pattern.own.iter().zip(&pattern.flexibility(gears, true)) {
            for (j, (b, _)) in own.iter().enumerate() {
                for (i, (a, _)) in own.iter().enumerate() {
                    pattern.within[(*a, *b)] += flexibility[(i, j)];
                }
            }
        }
        for mesh in &pattern.meshes {
            let pairs = mesh.first..mesh.first + mesh.count;
            for j in pairs.clone() {
                pattern.within_meshes.extend(pairs.clone().map(|i| pattern.within[(i, j)]));
            }
        }
        pattern.backside =
            placed.into_iter().skip(front).map(|p| Arc::new(p.table.into_owned())).collect();
        Ok(pattern)
    }

    /// Static FE flexibility of each gear between ports of different meshes, m/N.
    pub(super) fn across(&self, gears: &[VibratingGear<'_>]) -> &[DMatrix<f64>] {
        self.across.get_or_init(|| self.flexibility(gears, false))
    }

    /// The front meshes by linear kinematics, made by `make` at the first time of asking.
    pub(super) fn linear(
        &self,
        make: impl FnOnce() -> Result<Vec<LinearMesh>, FeError>,
    ) -> Result<&[LinearMesh], FeError> {
        kept(&self.linear, make).map(Vec::as_slice)
    }

    /// Mesh of each pair.
    pub(super) fn mesh_of(&self, pair: usize) -> usize {
        self.meshes.iter().position(|m| pair < m.first + m.count).unwrap_or(0)
    }

    /// Flexibility of all gears between ports of the same mesh, or of different ones, with the factor of the mesh,
    /// as in the compliance of the cells.
    fn flexibility(&self, gears: &[VibratingGear<'_>], same: bool) -> Vec<DMatrix<f64>> {
        let of = |(gear, own): (&VibratingGear<'_>, &Vec<(usize, usize)>)| {
            let port = |(pair, e): &(usize, usize)| {
                let (ends, teeth) = (self.ends[*pair].as_ref()?, self.teeth[*pair]?);
                Some((&ends[*e].end, teeth[*e], self.mesh_of(*pair)))
            };
            let ports: Vec<_> = own.iter().map(port).collect();
            let whole = |i: usize, j: usize| {
                let (Some((of, tooth_of, mesh)), Some((on, tooth_on, other))) =
                    (ports[i], ports[j])
                else {
                    return 0.0;
                };
                if (mesh == other) != same {
                    return 0.0;
                }
                gear.body.surface_flexibility(
                    (&on.load, on.direction),
                    tooth_of - tooth_on,
                    (&of.load, of.direction),
                )
            };
            let mut all = DMatrix::zeros(own.len(), own.len());
            for j in 0..own.len() {
                for i in 0..own.len() {
                    // Between different meshes the one half is the other, by reciprocity.
                    all[(i, j)] = if same || i >= j { whole(i, j) } else { all[(j, i)] };
                }
            }
            for (port, mut row) in ports.iter().zip(all.row_iter_mut()) {
                row *= port.map_or(0.0, |(.., mesh)| self.meshes[mesh].flexibility_factor);
            }
            all
        };
        gears.iter().zip(&self.own).map(of).collect()
    }
}

/// The patterns of a mesh cycle, made at the first visit of a position.
#[derive(Debug)]
pub(super) struct FramePatterns {
    /// By step in the cycle: front flanks alone, and with backside flanks.
    list: Vec<[OnceLock<Arc<FramePattern>>; 2]>,
    /// Angle of tooth 0 of every body at the start (carrier first, 0), rad.
    start_angles: OnceLock<Vec<f64>>,
    /// By step in the cycle: meshes whose phase is less than at the step before.
    restarts: OnceLock<Arc<[Vec<usize>]>>,
    /// The symmetries under which all positions are those of a part of the cycle.
    symmetries: OnceLock<Vec<Symmetry>>,
}

impl FramePatterns {
    /// None yet, for a cycle of `count` steps.
    pub(super) fn new(count: usize) -> Self {
        Self {
            list: (0..count).map(|_| [const { OnceLock::new() }; 2]).collect(),
            start_angles: OnceLock::new(),
            restarts: OnceLock::new(),
            symmetries: OnceLock::new(),
        }
    }

    /// Number of steps in the cycle.
    pub(super) fn count(&self) -> usize {
        self.list.len()
    }

    /// The pattern of a step, made by `make` at the first time of asking.
    pub(super) fn at(
        &self,
        step_in_cycle: usize,
        with_backside: bool,
        make: impl FnOnce() -> Result<FramePattern, FeError>,
    ) -> Result<Arc<FramePattern>, FeError> {
        let place = &self.list[step_in_cycle][usize::from(with_backside)];
        if let Some(pattern) = place.get() {
            return Ok(Arc::clone(pattern));
        }
        let made = Arc::new(make()?);
        Ok(Arc::clone(place.get_or_init(|| made)))
    }

    /// Angles of the bodies at the start, made by `make` at the first time of asking.
    pub(super) fn start_angles(
        &self,
        make: impl FnOnce() -> Result<Vec<f64>, FeError>,
    ) -> Result<&[f64], FeError> {
        kept(&self.start_angles, make).map(Vec::as_slice)
    }

    /// Meshes that start again at each step, made by `make` at the first time of asking.
    pub(super) fn restarts(&self, make: impl FnOnce() -> Arc<[Vec<usize>]>) -> Arc<[Vec<usize>]> {
        Arc::clone(self.restarts.get_or_init(make))
    }

    /// The symmetries of all positions, made by `make` at the first time of asking.
    pub(super) fn symmetries(
        &self,
        make: impl FnOnce() -> Result<Vec<Symmetry>, FeError>,
    ) -> Result<&[Symmetry], FeError> {
        kept(&self.symmetries, make).map(Vec::as_slice)
    }
}

/// What a place holds, made at the first time of asking.
fn kept<T>(place: &OnceLock<T>, make: impl FnOnce() -> Result<T, FeError>) -> Result<&T, FeError> {
    match place.get() {
        Some(known) => Ok(known),
        None => {
            let made = make()?;
            Ok(place.get_or_init(|| made))
        }
    }
}
