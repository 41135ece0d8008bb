//! Arithmetic with bundles: some vectors of numbers that pass through the same steps together, so that a factor is read
//! once for all of them and their sums do not wait for each other.

use std::marker::PhantomData;

use crate::number::Number;
use crate::wide::Simd;

/// Most vectors in a bundle: the sums of two bundles and what is added to them then fit 16 registers.
pub const MOST: usize = 5;

/// Vectors of T on the processor S.
pub type Bundle<S, T, const U: usize> = [<T as Number>::Vector<S>; U];

/// Arithmetic with bundles of U vectors of T.
#[derive(Debug, Clone, Copy)]
pub struct Bundles<S, T> {
    simd: S,
    number: PhantomData<T>,
}

/// A computation in which all vectors of a list undergo the same, U of them at a time.
pub trait InBundles {
    /// Computes for the vectors from `at` on.
    fn run<const U: usize>(&mut self, at: usize);
}

/// Runs a computation for some vectors in bundles as even as may be.
#[inline(always)]
pub fn in_bundles(count: usize, of: &mut impl InBundles) {
    let mut at = 0;
    while at < count {
        let left = count - at;
        let own = left.div_ceil(left.div_ceil(MOST));
        match own {
            1 => of.run::<1>(at),
            2 => of.run::<2>(at),
            3 => of.run::<3>(at),
            4 => of.run::<4>(at),
            _ => of.run::<MOST>(at),
        }
        at += own;
    }
}

impl<S: Simd, T: Number> Bundles<S, T> {
    /// On a processor.
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        Self { simd, number: PhantomData }
    }

    /// Numbers in a vector.
    pub const fn lanes() -> usize {
        size_of::<T::Vector<S>>() / size_of::<T>()
    }

    /// The vector with x in every lane.
    #[inline(always)]
    pub fn spread(self, x: T) -> T::Vector<S> {
        T::spread(self.simd, x)
    }

    /// The bundle of zeros.
    #[inline(always)]
    pub fn zero<const U: usize>(self) -> Bundle<S, T, U> {
        [self.spread(T::of(0.0)); U]
    }

    /// The bundle at a place of a list.
    #[inline(always)]
    pub fn at<const U: usize>(self, list: &[T::Vector<S>], place: usize) -> Bundle<S, T, U> {
        let mut own = [list[place]; U];
        own.copy_from_slice(&list[place..place + U]);
        own
    }

    /// Writes a bundle to a place of a list.
    #[inline(always)]
    pub fn put<const U: usize>(
        self,
        list: &mut [T::Vector<S>],
        place: usize,
        own: &Bundle<S, T, U>,
    ) {
        list[place..place + U].copy_from_slice(own);
    }

    /// a x.
    #[inline(always)]
    pub fn times<const U: usize>(self, a: T::Vector<S>, mut x: Bundle<S, T, U>) -> Bundle<S, T, U> {
        for x in &mut x {
            *x = T::product(self.simd, a, *x);
        }
        x
    }

    /// y + a x, rounded once.
    #[inline(always)]
    pub fn plus<const U: usize>(
        self,
        a: T::Vector<S>,
        x: &Bundle<S, T, U>,
        mut y: Bundle<S, T, U>,
    ) -> Bundle<S, T, U> {
        for u in 0..U {
            y[u] = T::fused(self.simd, a, x[u], y[u]);
        }
        y
    }

    /// y − a x, rounded once.
    #[inline(always)]
    pub fn minus<const U: usize>(
        self,
        a: T::Vector<S>,
        x: &Bundle<S, T, U>,
        mut y: Bundle<S, T, U>,
    ) -> Bundle<S, T, U> {
        for u in 0..U {
            y[u] = T::fused_less(self.simd, a, x[u], y[u]);
        }
        y
    }

    /// a x − y, rounded once.
    #[inline(always)]
    pub fn times_less<const U: usize>(
        self,
        a: T::Vector<S>,
        x: &Bundle<S, T, U>,
        mut y: Bundle<S, T, U>,
    ) -> Bundle<S, T, U> {
        for u in 0..U {
            y[u] = T::fused_from(self.simd, a, x[u], y[u]);
        }
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wide::{Computation, wide};

    /// y + a x − (b y − x) at every place of lists of some vectors.
    struct Sums<'s, T> {
        x: &'s [T],
        y: &'s mut [T],
        factors: [T; 2],
    }

    struct Running<'s, S: Simd, T: Number> {
        own: Bundles<S, T>,
        x: &'s [T::Vector<S>],
        y: &'s mut [T::Vector<S>],
        factors: [T; 2],
        bundles: Vec<usize>,
    }

    impl<S: Simd, T: Number> InBundles for Running<'_, S, T> {
        #[inline(always)]
        fn run<const U: usize>(&mut self, at: usize) {
            let own = self.own;
            let [a, b] = self.factors.map(|x| own.spread(x));
            let (x, y) = (own.at::<U>(self.x, at), own.at(self.y, at));
            let less = own.times_less(b, &y, x);
            let sum = own.minus(own.spread(T::of(1.0)), &less, own.plus(a, &x, y));
            own.put(self.y, at, &sum);
            self.bundles.push(U);
        }
    }

    impl<T: Number> Computation for Sums<'_, T> {
        type Output = Vec<usize>;

        #[inline(always)]
        fn run<S: Simd>(self, simd: S) -> Vec<usize> {
            let (x, y) = (T::vectors::<S>(self.x), T::vectors_mut::<S>(self.y));
            let (own, factors) = (Bundles::new(simd), self.factors);
            let mut running = Running { own, x, y, factors, bundles: Vec::new() };
            in_bundles(x.len(), &mut running);
            running.bundles
        }
    }

    fn every_vector_is_reached_once<T: Number>(precision: f64) {
        for count in 1..=3 * MOST {
            let n = count * T::MOST_LANES;
            let x: Vec<T> = (0..n).map(|i| T::of((i as f64).sin())).collect();
            let start: Vec<T> = (0..n).map(|i| T::of((2.0 * i as f64).cos())).collect();
            let mut y = start.clone();
            let factors = [T::of(0.3), T::of(-1.7)];
            let bundles = wide(Sums { x: &x, y: &mut y, factors });
            assert!(bundles.iter().max().unwrap() - bundles.iter().min().unwrap() <= 1);
            for i in 0..n {
                let (x, start) = (x[i].double(), start[i].double());
                let exact = start + 0.3 * x - (-1.7 * start - x);
                assert!((y[i].double() - exact).abs() < precision, "{count} {i}");
            }
        }
    }

    #[test]
    fn every_vector_is_reached_once_in_both_precisions() {
        every_vector_is_reached_once::<f64>(1e-14);
        every_vector_is_reached_once::<f32>(1e-5);
    }
}
