//! Contact of one mesh as affine maps, one for each set of touching cells met so far.
//!
//! With a given set A of touching cells the cells' forces follow the pairs' approaches δ linearly ([`ContactMap`]).
//! The map holds while p_A ≥ 0 and the other cells' gaps g − E δ + C p ≥ 0; only when none of the known ones does is
//! contact solved anew.

use std::sync::{Arc, PoisonError, RwLock};

use nalgebra::{Cholesky, DMatrix, Dyn};

use super::rooms::Rooms;
use super::table::{CellSettings, MeshTable};
use crate::complementarity::{ComplementaritySolver, Problem};
use crate::error::FeError;

/// Maps that one set keeps of one mesh at one phase; the oldest gives way.
const MOST_MAPS: usize = 64;

/// Maps that sets share of one mesh at one phase; those found later are not shared.
const MOST_SHARED: usize = 64;

/// Most pairs of a mesh whose approaches are remembered; with more, cells are always looked at. Four come
/// near at the usual load, five at twice that.
const REMEMBERED: usize = 8;

/// Affine law of one set of touching cells.
///
/// `[eq:contact-map]` With E, which pair a cell belongs to, and the gaps g at δ = 0:
/// ```text
/// p_A = C_AA⁻¹ (E_A δ − g_A),   P = E_Aᵀ p_A = S δ + P₀,   ½ pᵀCp = ½ δᵀ S δ + P₀ᵀ δ + ½ g_Aᵀ C_AA⁻¹ g_A.
/// ```
/// Source: derived here.
/// Checked by: `fe_contact/src/contact/maps.rs::maps_answer_as_the_solver_does`.
#[derive(Debug, Clone)]
pub struct ContactMap {
    /// δ at which the set was found (k, m), P₀ (k, N), S (k×k by rows, N/m), then how far δ may change before the set
    /// does: all in one place, because what a map that was not asked for lately costs is the way to the memory.
    numbers: Vec<f64>,
    /// Number k of pairs.
    pairs: usize,
    /// Lanes of cells among the numbers.
    lanes: usize,
    /// What slack makes of a room at least and at most, m.
    slack: [f64; 2],
    /// ½ g_Aᵀ C_AA⁻¹ g_A, J.
    energy: f64,
    /// Cells that touch.
    active: Vec<bool>,
    /// Pair whose patch reaches the end of its grid.
    pub overflows: Option<usize>,
}

/// Which map was found to hold, at which approaches, and how far from them it does: whoever asks
/// again keeps one of these.
#[derive(Debug, Clone, Copy, Default)]
pub struct Held {
    place: Option<usize>,
    id: u64,
    /// The first k, m.
    at: [f64; REMEMBERED],
    /// Largest change of any of them, m.
    within: f64,
}

impl Held {
    /// Id of the map.
    pub fn id(&self) -> u64 {
        self.id
    }

    /// Keeps the smallest room (m) that a map has at approaches δ.
    fn keep_room(&mut self, map: &ContactMap, delta: &[f64], room: f64) {
        self.at.iter_mut().zip(delta).for_each(|(at, d)| *at = *d);
        // Half the slack is far above rounding: looked at cell by cell, the map would hold as well.
        self.within = room - 0.5 * map.slack[0];
    }
}

/// Maps of one mesh at one phase that all sets with the same table share.
///
/// The contact problem has one solution, so inside the range where a map holds it is the map that a set would
/// find by itself: who shares gets the same bits as who does not, whatever others found before.
#[derive(Debug, Default)]
pub struct SharedMaps(RwLock<FoundMaps>);

/// Maps, and the approaches at which they were found, one after another.
#[derive(Debug, Default)]
struct FoundMaps {
    maps: Vec<Arc<ContactMap>>,
    found_at: Vec<f64>,
}

impl SharedMaps {
    /// The map that holds at approaches δ (less gap offsets), and not merely by its slack, with its smallest room (m).
    fn inside(&self, delta: &[f64]) -> Option<(Arc<ContactMap>, f64)> {
        let FoundMaps { maps, found_at } = &*self.0.read().unwrap_or_else(PoisonError::into_inner);
        let inside = |place: usize| {
            let map = maps.get(place)?;
            let room = map.rooms().least_at(delta).filter(|room| *room > 2.0 * map.slack[1])?;
            Some((Arc::clone(map), room))
        };
        // At most one map holds beyond its slack, so that the order of the search is a matter of time only: the one
        // that was found nearest is the likeliest.
        let away = |at: &[f64]| -> f64 {
            at.iter().zip(delta).fold(0.0, |most, (at, d)| most.max((at - d).abs()))
        };
        let all = found_at.chunks_exact(delta.len().max(1)).map(away).enumerate();
        let nearest = all.min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(place, _)| place);
        inside(nearest)
            .or_else(|| (0..maps.len()).filter(|place| *place != nearest).find_map(inside))
    }

    fn add(&self, map: &Arc<ContactMap>) {
        let FoundMaps { maps, found_at } =
            &mut *self.0.write().unwrap_or_else(PoisonError::into_inner);
        if maps.len() < MOST_SHARED && maps.iter().all(|own| own.active != map.active) {
            maps.push(Arc::clone(map));
            found_at.extend(map.found_at());
        }
    }
}

/// A map under the number that one set gives it, unlike that of any other of the mesh.
#[derive(Debug, Clone)]
struct Numbered {
    id: u64,
    map: Arc<ContactMap>,
}

/// The maps that one set keeps of one mesh at one phase.
#[derive(Debug, Clone)]
pub struct ContactMaps {
    maps: Vec<Numbered>,
    shared: Arc<SharedMaps>,
    next: u64,
    /// Most that are kept, and which gives way next when there are too many.
    most: usize,
    oldest: usize,
    /// Load (N) and window (m) of the tables: what slack is a part of.
    scale: (f64, f64),
    /// Contact problems that none of the set's maps answered.
    pub solved: usize,
}

impl ContactMap {
    /// δ at which the set was found, k, m.
    fn found_at(&self) -> &[f64] {
        &self.numbers[..self.pairs]
    }

    /// S, k×k by rows, N/m.
    #[inline]
    pub fn stiffness(&self) -> &[f64] {
        &self.numbers[2 * self.pairs..][..self.pairs * self.pairs]
    }

    /// P₀, k, N.
    #[inline]
    pub fn forces(&self) -> &[f64] {
        &self.numbers[self.pairs..2 * self.pairs]
    }

    /// By how much δ may change before the set does.
    #[inline]
    fn rooms(&self) -> Rooms<'_> {
        let written = &self.numbers[(2 + self.pairs) * self.pairs..];
        Rooms::read(self.found_at(), self.lanes, written)
    }

    /// ½ pᵀ C p at approaches δ, J.
    pub fn energy(&self, delta: &[f64]) -> f64 {
        let k = delta.len();
        let mut sum = self.energy;
        for (i, d) in delta.iter().enumerate() {
            let row = &self.stiffness()[i * k..(i + 1) * k];
            let along: f64 = row.iter().zip(delta).map(|(s, d)| s * d).sum();
            sum += d * (0.5 * along + self.forces()[i]);
        }
        sum
    }

    /// The map of a set of touching cells that was found at approaches δ (less gap offsets).
    fn new(
        table: &MeshTable,
        owner: &[usize],
        (active, delta): (Vec<bool>, &[f64]),
        factor: Option<Cholesky<f64, Dyn>>,
        scale: (f64, f64),
    ) -> Option<Self> {
        let k = table.pairs.len();
        let n = table.gaps.len();
        let set: Vec<usize> = (0..n).filter(|i| active[*i]).collect();
        // Columns: −g_A, then E_A.
        let mut right = DMatrix::from_fn(set.len(), k + 1, |i, c| match c {
            0 => -table.gaps[set[i]],
            c => f64::from(u8::from(owner[set[i]] == c - 1)),
        });
        if !set.is_empty() {
            let block = || {
                DMatrix::from_fn(set.len(), set.len(), |i, j| table.compliance[(set[i], set[j])])
            };
            let factor = match factor {
                Some(known) => known,
                None => Cholesky::new(block())?,
            };
            factor.solve_mut(&mut right);
        }
        let mut cells = vec![0.0; n * (k + 1)];
        for i in 0..n {
            cells[i * (k + 1)] = table.gaps[i];
            cells[i * (k + 1) + 1 + owner[i]] = -1.0;
        }
        for (a, cell) in set.iter().enumerate() {
            for c in 0..=k {
                cells[cell * (k + 1) + c] = right[(a, c)];
            }
        }
        for i in (0..n).filter(|i| !active[*i]) {
            for c in 0..=k {
                let sum: f64 = set
                    .iter()
                    .enumerate()
                    .map(|(a, j)| table.compliance[(i, *j)] * right[(a, c)])
                    .sum();
                cells[i * (k + 1) + c] += sum;
            }
        }
        let (mut stiffness, mut forces) = (vec![0.0; k * k], vec![0.0; k]);
        let mut energy = 0.0;
        for (a, cell) in set.iter().enumerate() {
            forces[owner[*cell]] += right[(a, 0)];
            energy -= 0.5 * table.gaps[*cell] * right[(a, 0)];
            for c in 0..k {
                stiffness[owner[*cell] * k + c] += right[(a, c + 1)];
            }
        }
        // Rounding must not spoil symmetry.
        for i in 0..k {
            for j in 0..i {
                let mean = 0.5 * (stiffness[i * k + j] + stiffness[j * k + i]);
                (stiffness[i * k + j], stiffness[j * k + i]) = (mean, mean);
            }
        }
        let overflows = table.pairs.iter().position(|pair| {
            let own = &active[pair.first..pair.first + pair.x.len()];
            let ends = [own[0], own[own.len() - 1]];
            (0..2).any(|i| ends[i] && !pair.ends_at_tip[i])
        });
        let mut numbers = [delta, &forces, &stiffness].concat();
        let (lanes, slack) = Rooms::write(&cells, &active, delta, scale, &mut numbers);
        numbers.shrink_to_fit();
        Some(Self { numbers, pairs: k, lanes, slack, energy, active, overflows })
    }
}

impl ContactMaps {
    /// None yet, for a table of such cells whose maps are `shared` with other sets.
    pub fn new(settings: &CellSettings, shared: Arc<SharedMaps>) -> Self {
        let scale = (settings.force, settings.window);
        Self { maps: Vec::new(), shared, next: 0, most: MOST_MAPS, oldest: 0, scale, solved: 0 }
    }

    /// The same, for few maps.
    #[cfg(test)]
    pub(crate) fn keep(&mut self, most: usize) {
        self.most = most;
    }

    /// Memory of the maps, bytes.
    pub fn bytes(&self) -> usize {
        self.maps.iter().map(|Numbered { map, .. }| 8 * map.numbers.len() + map.active.len()).sum()
    }

    /// Number of maps.
    pub fn count(&self) -> usize {
        self.maps.len()
    }

    /// The map that held, unless it gave way to another.
    #[inline]
    pub fn held(&self, held: &Held) -> Option<&ContactMap> {
        let own = self.maps.get(held.place?).filter(|own| own.id == held.id)?;
        Some(&own.map)
    }

    /// Whether the map that held still does at approaches δ (less gap offsets), one for each pair.
    #[inline]
    pub fn holds(&self, held: &mut Held, delta: &[f64]) -> bool {
        let Some(place) = held.place.filter(|_| self.held(held).is_some()) else { return false };
        // No number is within anything.
        let is_near = delta.len() <= REMEMBERED
            && delta.iter().zip(&held.at).all(|(d, at)| (d - at).abs() <= held.within);
        is_near || self.holds_cell_by_cell(place, held, delta)
    }

    fn holds_cell_by_cell(&self, place: usize, held: &mut Held, delta: &[f64]) -> bool {
        let Some(Numbered { id, map }) = self.maps.get(place) else { return false };
        let Some(room) = map.rooms().least_at(delta) else { return false };
        (held.place, held.id) = (Some(place), *id);
        held.keep_room(map, delta, room);
        true
    }

    /// Puts a map that holds at approaches δ (less gap offsets) into `held`: the one that did first, then
    /// the others, then a new one, which may turn out not to.
    ///
    /// # Errors
    /// If the contact solver fails.
    pub fn find(
        &mut self,
        table: &MeshTable,
        delta: &[f64],
        held: &mut Held,
        solver: &dyn ComplementaritySolver,
    ) -> Result<(), FeError> {
        debug_assert_eq!(delta.len(), table.pairs.len());
        if self.holds(held, delta) {
            return Ok(());
        }
        let asked = held.place.filter(|_| self.held(held).is_some());
        let mut others = (0..self.maps.len()).filter(|place| Some(*place) != asked);
        if others.any(|place| self.holds_cell_by_cell(place, held, delta)) {
            return Ok(());
        }
        self.solved += 1;
        if let Some((map, room)) = self.shared.inside(delta) {
            self.take(Arc::clone(&map), held);
            held.keep_room(&map, delta, room);
            return Ok(());
        }
        let owner = table.pair_of_cells();
        let gaps: Vec<f64> = table.gaps.iter().zip(&owner).map(|(g, k)| g - delta[*k]).collect();
        let mut factor = None;
        let active = if gaps.iter().all(|g| *g >= 0.0) {
            vec![false; gaps.len()]
        } else {
            let problem = Problem { compliance: &table.compliance, gaps: &gaps };
            let before = self.held(held);
            let warm = before.map(|m| m.active.as_slice());
            let (solution, of_active) = solver
                .solve_with_factor(&problem, warm)
                .map_err(|cause| FeError::Contact { phase: table.phase, cause })?;
            // A touching cell without force belongs to either set.
            let touching: Vec<bool> =
                solution.active.iter().zip(&solution.forces).map(|(a, p)| *a && *p > 0.0).collect();
            factor = of_active.filter(|_| touching == solution.active);
            touching
        };
        if let Some(place) = self.maps.iter().position(|own| own.map.active == active) {
            // Known, and at the border of what it holds for.
            *held = Held { place: Some(place), id: self.maps[place].id, within: -1.0, ..*held };
            return Ok(());
        }
        let set = (active, delta);
        let map = ContactMap::new(table, &owner, set, factor, self.scale).ok_or_else(|| {
            let cause = crate::complementarity::ComplementarityError::Inaccurate {
                residual: f64::INFINITY,
            };
            FeError::Contact { phase: table.phase, cause }
        })?;
        let map = Arc::new(map);
        self.shared.add(&map);
        self.take(map, held);
        Ok(())
    }

    /// Keeps a map that the set did not have, in the place of the oldest if there are too many.
    fn take(&mut self, map: Arc<ContactMap>, held: &mut Held) {
        let id = self.next;
        self.next += 1;
        let own = Numbered { id, map };
        let place = if self.maps.len() < self.most {
            self.maps.push(own);
            self.maps.len() - 1
        } else {
            let place = self.oldest;
            self.oldest = (self.oldest + 1) % self.most;
            self.maps[place] = own;
            place
        };
        // No approaches are known to be within its range before its cells were looked at.
        *held = Held { place: Some(place), id, within: -1.0, ..*held };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::complementarity::ActiveSet;
    use crate::contact::{CellSettings, Matching};

    /// Maps and the solver's own answer agree wherever contact stands.
    #[test]
    fn maps_answer_as_the_solver_does() {
        let scene = scene::Scene::from_file(
            concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/oh58_sun_planet_pair.toml").as_ref(),
        )
        .unwrap();
        let mut scene = scene;
        scene.fe_contact.flank_elements = 8;
        let bodies = crate::statics::Bodies::new(&scene).unwrap();
        let (mesh, pair) = bodies.joined(gearset::MeshKind::SunPlanet).unwrap();
        let settings: CellSettings = bodies.cells(8000.0);
        let _: Matching = settings.matching;
        for phase in [0.02, 0.3, 0.7] {
            let table = MeshTable::new(mesh, pair, phase, &settings).unwrap();
            let k = table.pairs.len();
            let mut maps = ContactMaps::new(&settings, Arc::default());
            let mut held = Held::default();
            for step in 0..40 {
                // From apart to pressed, the pairs unevenly.
                let delta: Vec<f64> =
                    (0..k).map(|i| (step as f64 - 4.0 + 0.3 * i as f64) * 0.5e-6).collect();
                maps.find(&table, &delta, &mut held, &ActiveSet).unwrap();
                let map = maps.held(&held).unwrap();
                let answer = table.answer(&delta, &vec![0.0; k], &ActiveSet, None).unwrap();
                let total: f64 = answer.pair_forces.iter().sum();
                for i in 0..k {
                    let force: f64 = map.forces()[i]
                        + (0..k).map(|j| map.stiffness()[i * k + j] * delta[j]).sum::<f64>();
                    assert!((force - answer.pair_forces[i]).abs() <= 1e-9 * total.max(1.0));
                }
                assert!((map.energy(&delta) - answer.energy).abs() <= 1e-9 * answer.energy + 1e-15);
            }
            let (count, solved) = (maps.count(), maps.solved);
            let delta: Vec<f64> = (0..k).map(|i| (15.0 + 0.3 * i as f64) * 0.5e-6).collect();
            maps.find(&table, &delta, &mut held, &ActiveSet).unwrap();
            assert_eq!((maps.count(), maps.solved), (count, solved), "a known set is not solved");
        }
    }
}
