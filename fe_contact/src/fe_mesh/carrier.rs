//! Mesh of the carrier: an annulus with a round, rigid seat for each planet's pin.
//!
//! Each seat is surrounded by a box; four blocks fill the space between the seat's circle and its
//! box, and polar blocks the space between the boxes. Lattices count half elements, as on the
//! gears; all elements have eight nodes.

use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_4, TAU};

use gearset::CarrierInput;

use super::outline::polar;
use crate::element::{MOST, Shape};

/// What holds a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// Nothing.
    Free,
    /// The bore, which is the race.
    Race,
    /// The rigid seat of this planet.
    Seat(usize),
}

/// Mesh of the carrier.
#[derive(Debug, Clone)]
pub struct FeCarrierMesh {
    /// Nodes, m.
    pub points: Vec<[f64; 2]>,
    /// What holds each node.
    pub holds: Vec<Hold>,
    /// Nodes of each element, eight-node order.
    pub elements: Vec<[usize; MOST]>,
    /// Centres of the seats, in the planets' order, m.
    pub seats: Vec<[f64; 2]>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Place {
    /// Radial line between two blocks.
    Line(usize, usize),
    /// Around a seat, by perimeter and layer.
    Box(usize, usize, usize),
    /// Between two boxes.
    Fill(usize, usize, usize),
}

/// Elements on one side of a box, and layers from box to seat.
const SIDE: usize = 8;
const LAYERS: usize = 5;

impl FeCarrierMesh {
    /// Meshes the carrier for planets at ψ (rad) on the radius `center_distance` (m).
    pub fn new(carrier: &CarrierInput, center_distance: f64, psi: &[f64]) -> Self {
        let (inner, outer) = (carrier.bore_radius_m, carrier.outer_radius_m);
        let mut order: Vec<usize> = (0..psi.len()).collect();
        order.sort_by(|a, b| psi[*a].rem_euclid(TAU).total_cmp(&psi[*b].rem_euclid(TAU)));
        let at = |i: usize| psi[order[i % order.len()]].rem_euclid(TAU);
        let count = order.len();
        let gap = |i: usize| match count {
            1 => TAU,
            _ => (at(i + 1) - at(i)).rem_euclid(TAU),
        };
        let widest = 0.5 * (outer - inner) / center_distance;
        let least = 1.4 * carrier.pin_seat_radius_m / center_distance;
        let half = (0..count).map(|i| 0.5 * gap(i)).fold(widest.max(least), f64::min);
        let mut mesh = Self {
            points: Vec::new(),
            holds: Vec::new(),
            elements: Vec::new(),
            seats: psi.iter().map(|angle| polar(center_distance, *angle)).collect(),
        };
        let mut ids: HashMap<Place, usize> = HashMap::new();
        let radius = |j: usize| inner + (outer - inner) * j as f64 / (2 * SIDE) as f64;
        for (i, &planet) in order.iter().enumerate() {
            let before = (i + count - 1) % count;
            let touches = |i: usize| gap(i) - 2.0 * half < 1e-9;
            // Lines 2i and 2i + 1 bound the box; where boxes touch they share one.
            let left = if touches(before) { 2 * before + 1 } else { 2 * i };
            let right = 2 * i + 1;
            let (low, high) = (at(i) - half, at(i) + half);
            let boundary = |s: usize| -> [f64; 2] {
                let (side, t) = (s / (2 * SIDE), (s % (2 * SIDE)) as f64 / (2 * SIDE) as f64);
                match side {
                    0 => polar(inner, low + t * (high - low)),
                    1 => polar(inner + t * (outer - inner), high),
                    2 => polar(outer, high - t * (high - low)),
                    _ => polar(outer - t * (outer - inner), low),
                }
            };
            let perimeter = 8 * SIDE;
            let centre = mesh.seats[planet];
            let mut node = |s: usize, layer: usize| -> usize {
                let s = s % perimeter;
                let (side, along) = (s / (2 * SIDE), s % (2 * SIDE));
                let place = match (layer, side, along) {
                    (0, 0, 0) => Place::Line(left, 0),
                    (0, 1, j) => Place::Line(right, j),
                    (0, 2, 0) => Place::Line(right, 2 * SIDE),
                    (0, 3, j) => Place::Line(left, 2 * SIDE - j),
                    _ => Place::Box(planet, s, layer),
                };
                *ids.entry(place).or_insert_with(|| {
                    let t = layer as f64 / (2 * LAYERS) as f64;
                    // Directions of seat and box agree at the four corners.
                    let turn = TAU * s as f64 / perimeter as f64 - 3.0 * FRAC_PI_4;
                    let (radial, tangential) = (turn.sin(), turn.cos());
                    let (sin, cos) = at(i).sin_cos();
                    let r = carrier.pin_seat_radius_m;
                    let on_seat = [
                        centre[0] + r * (radial * cos - tangential * sin),
                        centre[1] + r * (radial * sin + tangential * cos),
                    ];
                    let on_box = boundary(s);
                    mesh.points.push([0, 1].map(|k| (1.0 - t) * on_box[k] + t * on_seat[k]));
                    mesh.holds.push(match (layer, side) {
                        (l, _) if l == 2 * LAYERS => Hold::Seat(planet),
                        (0, 0) => Hold::Race,
                        (0, 1) if along == 0 => Hold::Race,
                        _ => Hold::Free,
                    });
                    mesh.points.len() - 1
                })
            };
            let mut quads = Vec::new();
            for layer in (0..2 * LAYERS).step_by(2) {
                for s in (0..perimeter).step_by(2) {
                    // The perimeter runs clockwise in space.
                    let corner = [(2, 0), (0, 0), (0, 2), (2, 2)];
                    let middle = [(1, 0), (0, 1), (1, 2), (2, 1)];
                    let list = corner.iter().chain(&middle);
                    quads.push(list.map(|(a, b)| node(s + a, layer + b)).collect::<Vec<_>>());
                }
            }
            // The stretch up to the next box.
            let width = gap(i) - 2.0 * half;
            if width >= 1e-9 {
                let next = 2 * ((i + 1) % count);
                let size = (outer - inner) / SIDE as f64;
                let columns = ((width * center_distance / size).round() as usize).max(1);
                let mut node = |c: usize, j: usize| -> usize {
                    let place = match c {
                        0 => Place::Line(right, j),
                        c if c == 2 * columns => Place::Line(next, j),
                        c => Place::Fill(i, c, j),
                    };
                    *ids.entry(place).or_insert_with(|| {
                        let angle = high + width * c as f64 / (2 * columns) as f64;
                        mesh.points.push(polar(radius(j), angle));
                        mesh.holds.push(if j == 0 { Hold::Race } else { Hold::Free });
                        mesh.points.len() - 1
                    })
                };
                for c in (0..2 * columns).step_by(2) {
                    for j in (0..2 * SIDE).step_by(2) {
                        let corner = [(2, 0), (0, 0), (0, 2), (2, 2)];
                        let middle = [(1, 0), (0, 1), (1, 2), (2, 1)];
                        let list = corner.iter().chain(&middle);
                        quads.push(list.map(|(a, b)| node(c + a, j + b)).collect::<Vec<_>>());
                    }
                }
            }
            for list in quads {
                let mut nodes = [0; MOST];
                nodes[..8].copy_from_slice(&list);
                mesh.elements.push(nodes);
            }
        }
        mesh
    }

    /// Shape of every element.
    pub fn shape() -> Shape {
        Shape::QUADRATIC
    }
}
