//! Rows with non-zero entries on the coordinates of two bodies only, as a tooth pair's approach has
//! them.

use nalgebra::DVector;

/// A row with at most six non-zero entries, stored as places and values.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ShortRow {
    places: [u16; Self::MOST],
    values: [f64; Self::MOST],
    /// How many entries are not zero.
    count: u16,
}

impl ShortRow {
    /// Most entries that are not zero: of three coordinates of each of the two bodies of a tooth pair.
    pub(crate) const MOST: usize = 6;

    /// `None` if more than six entries are non-zero.
    pub(crate) fn new(row: impl Iterator<Item = f64>) -> Option<Self> {
        let mut short = Self::default();
        let nonzero = row.enumerate().filter(|(_, value)| *value != 0.0);
        for (k, (place, value)) in nonzero.enumerate() {
            *short.places.get_mut(k)? = u16::try_from(place).ok()?;
            short.values[k] = value;
            short.count += 1;
        }
        Some(short)
    }

    /// All n entries.
    pub(crate) fn full(&self, n: usize) -> DVector<f64> {
        let mut row = DVector::zeros(n);
        self.add_to(1.0, row.as_mut_slice());
        row
    }

    /// (Place, value) of six terms; those beyond the entries have the value 0.
    #[inline(always)]
    pub(crate) fn terms(&self) -> impl Iterator<Item = (usize, f64)> {
        self.places.iter().zip(&self.values).map(|(i, r)| (usize::from(*i), *r))
    }

    /// (Place, value) of the entries that are not zero.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (usize, f64)> {
        self.terms().take(self.count())
    }

    /// How many entries are not zero: they are the first of the [terms](Self::terms).
    pub(crate) fn count(&self) -> usize {
        usize::from(self.count)
    }

    pub(crate) fn dot(&self, x: &[f64]) -> f64 {
        self.places.iter().zip(&self.values).map(|(i, r)| x[usize::from(*i)] * r).sum()
    }

    /// x += factor rowᵀ.
    pub(crate) fn add_to(&self, factor: f64, x: &mut [f64]) {
        for (i, r) in self.places.iter().zip(&self.values) {
            x[usize::from(*i)] += factor * r;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_rows_hold_six_coordinates() {
        let row = [0.0, 2.0, 0.0, -1.0, 0.5];
        let x = [7.0, 3.0, 9.0, 4.0, 2.0];
        let short = ShortRow::new(row.into_iter()).unwrap();
        assert_eq!(short.dot(&x), 3.0);
        assert_eq!(short.count(), 3);
        assert!(short.entries().eq(short.terms().take(3)));
        let mut sum = x;
        short.add_to(2.0, &mut sum);
        assert_eq!(sum, [7.0, 7.0, 9.0, 2.0, 3.0]);
        assert!(ShortRow::new([1.0; 7].into_iter()).is_none());
    }
}
