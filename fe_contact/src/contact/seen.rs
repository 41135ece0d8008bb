//! FE part of the compliance between contact cells: the cells of a pair as one body sees them.

use gearset::MeshMember;
use nalgebra::DMatrix;

use super::pair::PairFrame;
use super::table::Matching;
use crate::body::{Deep, FlankPoint, GearBody};
use crate::fe_mesh::Side;

/// The cells of one pair on one body.
pub(super) struct Seen {
    /// Flank on which the pair presses.
    side: Side,
    /// Normal in the tooth's frame.
    normal: [f64; 2],
    /// Where the force of each cell acts.
    loads: Vec<FlankPoint>,
    /// First columns of all functions of the flank that the loads need, ascending, and the places there
    /// of each load's functions.
    columns: Vec<usize>,
    load_places: Vec<[usize; 4]>,
    /// Matching points with their weights, those of each cell in turn.
    deep: Vec<(Deep, f64)>,
    /// Nodes that the matching points need, ascending, and the places there of each point's nodes.
    nodes: Vec<usize>,
    deep_places: Vec<[usize; crate::element::MOST]>,
}

fn ordered(mut list: Vec<usize>) -> Vec<usize> {
    list.sort_unstable();
    list.dedup();
    list
}

impl Seen {
    /// The cells of one pair in one body's tooth frame; `points`: those of both flanks at the cells'
    /// middles, mesh frame, with their roll lengths. `None` if a matching point falls outside.
    pub(super) fn new(
        frame: &PairFrame<'_>,
        points: &[[([f64; 2], f64); 2]],
        member: MeshMember,
        body: &GearBody,
        matching: &Matching,
    ) -> Option<Self> {
        let tooth = frame.tooth(member);
        let (sin, cos) = (-tooth.axis).sin_cos();
        let into = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
        let normal = into(frame.normal);
        // The driver's material lies behind the normal, the driven gear's ahead of it.
        let inwards = if member == MeshMember::Driver { -1.0 } else { 1.0 };
        let weights = matching.weights();
        let mut loads = Vec::with_capacity(points.len());
        let mut deep = Vec::with_capacity(points.len() * weights.len());
        // Where the points of one depth were found last: the next one is near.
        let mut last = vec![None; weights.len()];
        for ends in points {
            let (p, roll_length) = ends[member as usize];
            let at = into([p[0] - tooth.centre[0], p[1] - tooth.centre[1]]);
            for (i, weight) in weights.iter().enumerate() {
                let depth = inwards * matching.depth(i);
                let point = [at[0] + depth * normal[0], at[1] + depth * normal[1]];
                let (found, place) = body.locate_near(point, last[i])?;
                last[i] = Some(place);
                deep.push((found, *weight));
            }
            let along = body.mesh.outline.flank_parameter(roll_length);
            loads.push(body.flank_point(tooth.side, along));
        }
        let mut columns: Vec<usize> = Vec::with_capacity(4 * loads.len());
        let mut nodes: Vec<usize> = Vec::with_capacity(8 * deep.len());
        // Neighbours mostly share stretch and element.
        for (i, load) in loads.iter().enumerate() {
            if i == 0 || load.columns != loads[i - 1].columns {
                columns.extend(load.columns);
            }
        }
        for (i, (point, _)) in deep.iter().enumerate() {
            if i < weights.len() || point.element != deep[i - weights.len()].0.element {
                nodes.extend(&point.nodes[..point.count]);
            }
        }
        let (columns, nodes) = (ordered(columns), ordered(nodes));
        let place = |list: &[usize], value: usize| list.partition_point(|own| *own < value);
        let load_places =
            loads.iter().map(|load: &FlankPoint| load.columns.map(|c| place(&columns, c)));
        let deep_places = deep.iter().map(|(point, _): &(Deep, f64)| {
            let mut places = [0; crate::element::MOST];
            for (at, node) in places.iter_mut().zip(point.nodes).take(point.count) {
                *at = place(&nodes, node);
            }
            places
        });
        let (load_places, deep_places) = (load_places.collect(), deep_places.collect());
        let side = tooth.side;
        Some(Self { side, normal, loads, columns, load_places, deep, nodes, deep_places })
    }

    /// FE part of eq. (1): adds the displacement of the matching points of these cells along their
    /// normal n under unit forces along m on the cells `on`, whose tooth is `offset` teeth back, to the
    /// compliance from `first` (row, column) on. With R the response between the nodes that the matching
    /// points need and the functions of the flank that the loads need, each a few elements,
    ///
    /// ```text
    /// C = D H Lᵀ,   H = nᵀ R m
    /// ```
    ///
    /// D: weights of matching points times values of the elements' functions there, by cells and nodes;
    /// L: values of the flank's functions, by cells and functions.
    pub(super) fn add_under(
        &self,
        on: &Self,
        body: &GearBody,
        offset: i64,
        compliance: &mut DMatrix<f64>,
        first: (usize, usize),
    ) {
        let Some((response, start)) = body.response_under(offset, on.side) else { return };
        let (n, m) = (self.normal, on.normal);
        let width = on.columns.len();
        // H; side by side in memory are the functions of one node.
        let mut middle = vec![0.0; self.nodes.len() * width];
        for (c, column) in on.columns.iter().enumerate() {
            let at = column - start;
            let (x, y) = (response.column(at), response.column(at + 1));
            let (x, y) = (x.as_slice(), y.as_slice());
            for (r, node) in self.nodes.iter().enumerate() {
                let moved = |k: usize| m[0] * x[2 * node + k] + m[1] * y[2 * node + k];
                middle[r * width + c] = n[0] * moved(0) + n[1] * moved(1);
            }
        }
        // D H; side by side in memory are the cells.
        let cells = self.cells();
        let mut fields = vec![0.0; width * cells];
        let mut field = vec![0.0; width];
        let depths = self.deep.len() / cells;
        let points = self.deep.chunks_exact(depths).zip(self.deep_places.chunks_exact(depths));
        for (i, (points, places)) in points.enumerate() {
            field.fill(0.0);
            for ((deep, weight), places) in points.iter().zip(places) {
                for (r, value) in places[..deep.count].iter().zip(deep.weights) {
                    let w = weight * value;
                    let near = &middle[r * width..(r + 1) * width];
                    field.iter_mut().zip(near).for_each(|(field, near)| *field += w * near);
                }
            }
            field.iter().enumerate().for_each(|(c, value)| fields[c * cells + i] = *value);
        }
        for (j, (load, places)) in on.loads.iter().zip(&on.load_places).enumerate() {
            let [p, q, r, s] = places.map(|c| fields[c * cells..(c + 1) * cells].iter());
            let [a, b, c, d] = load.weights;
            let mut column = compliance.column_mut(first.1 + j);
            let own = &mut column.as_mut_slice()[first.0..first.0 + cells];
            for (((own, p), q), (r, s)) in own.iter_mut().zip(p).zip(q).zip(r.zip(s)) {
                *own += (a * p + b * q) + (c * r + d * s);
            }
        }
    }

    /// Number of cells.
    fn cells(&self) -> usize {
        self.loads.len()
    }
}

/// Numbers of the loaded teeth of one gear, counted from that of the first pair.
pub(super) fn tooth_numbers(
    frames: &[PairFrame<'_>],
    member: MeshMember,
    body: &GearBody,
) -> Vec<i64> {
    let pitch = body.mesh.outline.gear().pitch_angle();
    let first = frames.first().map_or(0.0, |f| f.tooth(member).axis);
    frames.iter().map(|f| ((f.tooth(member).axis - first) / pitch).round() as i64).collect()
}

#[cfg(test)]
mod tests {
    use gearset::MeshKind;
    use scene::Scene;

    use super::super::pair::candidates;
    use super::*;
    use crate::statics::Bodies;

    /// The product D H Lᵀ is the sum over load, response and matching points, cell by cell.
    #[test]
    fn the_block_is_the_flexibility_of_each_cell() {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let mut scene = Scene::from_file(path.as_ref()).unwrap();
        scene.fe_contact.flank_elements = 8;
        let bodies = Bodies::new(&scene).unwrap();
        let mut compared = 0;
        for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
            let (mesh, pair) = bodies.joined(kind).unwrap();
            for member in [MeshMember::Driver, MeshMember::Driven] {
                let body = pair[member as usize];
                let frames = candidates(mesh, 0.37, 1e-4);
                let numbers = tooth_numbers(&frames, member, body);
                let matching = &bodies.settings.matching;
                let see = |frame: &PairFrame<'_>| {
                    let [low, high] = frame.extent();
                    let x = (0..7).map(|i| 0.1 * (low + f64::from(i) / 6.0 * (high - low)));
                    let points: Vec<_> = x.map(|x| frame.flank_points(x)).collect();
                    Seen::new(frame, &points, member, body, matching).unwrap()
                };
                let seen: Vec<Seen> = frames.iter().map(see).collect();
                for (a, on) in seen.iter().enumerate() {
                    for (b, of) in seen.iter().enumerate() {
                        let (mut block, offset) = (DMatrix::zeros(8, 9), numbers[b] - numbers[a]);
                        of.add_under(on, body, offset, &mut block, (1, 2));
                        let depths = matching.weights().len();
                        let single = DMatrix::from_fn(8, 9, |i, j| {
                            if i == 0 || j < 2 {
                                return 0.0;
                            }
                            let load = (&on.loads[j - 2], on.normal);
                            let points = of.deep[depths * (i - 1)..depths * i].iter();
                            let moved = |(deep, w): &(Deep, f64)| {
                                w * body.flexibility(load, offset, (deep, of.normal))
                            };
                            points.map(moved).sum()
                        });
                        assert!(single.amax() > 0.0);
                        let off = (&block - &single).amax() / single.amax();
                        assert!(off < 1e-13, "{kind:?} {member:?} {a} {b}: {off:e}");
                        compared += 1;
                    }
                }
            }
        }
        assert!(compared >= 16, "{compared}");
    }
}
