//! Sets that are themselves again after a part of a mesh cycle, turned about their axis with the planets renumbered.
//!
//! Of N equally spaced planets with phases that advance evenly, planet n + s stands after T/N as planet n stood
//! before; of two opposed pairs of planets each planet after T/2 as its opposite. A motion of the period T that is
//! excited so repeats, if it is stable, after that part already:
//!
//! ```text
//! x_{n+s}(t + T/p) = x_n(t),   X(t + T/p) = Rot(φ) X(t) of the central members
//! ```

use std::f64::consts::TAU;

use crate::body::{Axis, Body};

/// Largest difference of equal angles, in turns.
const EQUAL: f64 = 1e-9;

/// Entries of a matrix that are not zero: row, column, value.
pub type Entries = Vec<(usize, usize, f64)>;

/// The renumbering after which a set is itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Symmetry {
    /// Parts of the mesh cycle p, at least 2.
    pub parts: usize,
    /// Planet n + shift (modulo N) stands after a part as planet n stood before.
    pub shift: usize,
    /// Angle from planet n to planet n + shift, counter-clockwise, rad.
    pub angle_rad: f64,
}

impl Symmetry {
    /// Those that the planets' angles (rad) and the number of steps in a mesh cycle allow, more parts first. Whether
    /// the set has one of them depends on its phases and on all else it is made of.
    pub fn candidates(psi_rad: &[f64], steps: usize) -> Vec<Self> {
        let planets = psi_rad.len();
        let fits = |parts: &usize| planets.is_multiple_of(*parts) && steps.is_multiple_of(*parts);
        let shifts = |parts: usize| {
            (1..planets).filter(move |shift| (shift * parts).is_multiple_of(planets))
        };
        let of = |parts: usize, shift: usize| {
            let ahead = |n: usize| psi_rad[(n + shift) % planets] - psi_rad[n];
            let turns = |n: usize| (ahead(n) - ahead(0)) / TAU;
            let is_even = (1..planets).all(|n| (turns(n) - turns(n).round()).abs() < EQUAL);
            is_even.then(|| Self { parts, shift, angle_rad: ahead(0) })
        };
        let all = (2..=planets).rev().filter(fits);
        all.flat_map(|parts| shifts(parts).filter_map(move |shift| of(parts, shift))).collect()
    }

    /// The same mesh, sun (0 to N−1) or ring (N to 2N−1), of the planet `shift` numbers further on.
    pub fn later(&self, mesh: usize, planets: usize) -> usize {
        mesh / planets * planets + (mesh % planets + self.shift) % planets
    }

    /// The candidates with what they do to coordinates (P as in [`renumbering`](Self::renumbering)) and to `couplings`
    /// couplings that are meshes of the sun and of the ring in turn (the place after a part of each).
    pub fn renumberings(
        psi_rad: &[f64],
        steps: usize,
        couplings: usize,
        place: impl Fn(Body, Axis) -> Option<usize>,
    ) -> Vec<(Self, Entries, Vec<usize>)> {
        let planets = psi_rad.len();
        let one = |own: Self| {
            let entries = own.renumbering(planets, &place)?;
            Some((own, entries, (0..couplings).map(|k| own.later(k, planets)).collect()))
        };
        Self::candidates(psi_rad, steps).into_iter().filter_map(one).collect()
    }

    /// The same set seen from the other side for `sign` = −1: planets turn the other way.
    pub fn seen_with(self, sign: f64) -> Self {
        Self { angle_rad: sign * self.angle_rad, ..self }
    }

    /// P of x(start of the next part) = P x(end of a part), by row, column and value of its entries that are not
    /// zero: planets take the numbers of those `shift` before them, central members turn back by the angle. `place`
    /// gives the place of a body's axis among the coordinates. `None` if a central member is held in one direction
    /// only, or one planet and not another.
    pub fn renumbering(
        &self,
        planets: usize,
        place: impl Fn(Body, Axis) -> Option<usize>,
    ) -> Option<Entries> {
        let mut entries = Vec::new();
        let (sin, cos) = self.angle_rad.sin_cos();
        for body in Body::CENTRAL {
            match Axis::TRANSLATIONS.map(|axis| place(body, axis)) {
                [Some(x), Some(y)] => {
                    entries.extend([(x, x, cos), (x, y, sin), (y, x, -sin), (y, y, cos)]);
                }
                [None, None] => {}
                _ => return None,
            }
            entries.extend(place(body, Axis::Rotation).map(|u| (u, u, 1.0)));
        }
        for planet in 0..planets {
            for axis in Axis::ALL {
                let of = |planet: usize| place(Body::Planet(planet), axis);
                match (of(planet), of((planet + self.shift) % planets)) {
                    (Some(to), Some(from)) => entries.push((to, from, 1.0)),
                    (None, None) => {}
                    _ => return None,
                }
            }
        }
        Some(entries)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evenly_spaced_and_opposed_planets_are_told_from_others() {
        let even: Vec<f64> = (0..5).map(|n| f64::from(n) * TAU / 5.0).collect();
        let found = Symmetry::candidates(&even, 100);
        assert_eq!(
            found.iter().map(|own| (own.parts, own.shift)).collect::<Vec<_>>(),
            [(5, 1), (5, 2), (5, 3), (5, 4)]
        );
        // 101 steps have no fifth part.
        assert!(Symmetry::candidates(&even, 101).is_empty());
        let opposed = [0.0, 1.6, 0.5 * TAU, 1.6 + 0.5 * TAU];
        let found = Symmetry::candidates(&opposed, 100);
        // Each planet can take the place of its opposite alone; whether after T/4 or T/2, phases decide.
        let list: Vec<_> = found.iter().map(|own| (own.parts, own.shift, own.angle_rad)).collect();
        assert_eq!(list, [(4, 2, 0.5 * TAU), (2, 2, 0.5 * TAU)]);
        let uneven = [0.0, 1.6, 3.0, 4.9];
        assert!(Symmetry::candidates(&uneven, 100).is_empty());
    }

    #[test]
    fn a_renumbering_taken_as_often_as_there_are_parts_changes_nothing() {
        let even: Vec<f64> = (0..3).map(|n| f64::from(n) * TAU / 3.0).collect();
        for own in Symmetry::candidates(&even, 30) {
            let entries =
                own.renumbering(3, |body, axis| Some(3 * body.index() + axis as usize)).unwrap();
            let x: Vec<f64> = (0..18).map(|i| (0.7 * f64::from(i)).sin()).collect();
            let mut turned = x.clone();
            for _ in 0..own.parts {
                let mut next = vec![0.0; 18];
                entries.iter().for_each(|(i, j, c)| next[*i] += c * turned[*j]);
                turned = next;
            }
            assert!(x.iter().zip(&turned).all(|(a, b)| (a - b).abs() < 1e-14));
        }
    }
}
