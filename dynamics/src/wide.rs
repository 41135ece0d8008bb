//! Loops over many numbers, compiled for the vectors of the processor at hand.

use pulp::{Arch, Simd, WithSimd};

/// A computation that is compiled once for each kind of processor.
pub trait Computation {
    /// What it gives.
    type Output;

    /// Computes. Only what is inlined here is compiled for the processor: implementations are `#[inline(always)]`.
    fn run(self) -> Self::Output;
}

struct Dispatched<C>(C);

impl<C: Computation> WithSimd for Dispatched<C> {
    type Output = C::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> C::Output {
        self.0.run()
    }
}

/// Runs a computation as compiled for AVX2, where the processor has it, instead of the baseline of the target.
///
/// Results are the same bits on every processor of a target: wider vectors change neither the order of a sum nor the
/// rounding of a product, as the compiler fuses none.
pub fn wide<C: Computation>(computation: C) -> C::Output {
    Arch::new().dispatch(Dispatched(computation))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of products, of which fused ones would differ in the last digits.
    struct Sums<'s>(&'s [f64], &'s mut [f64]);

    impl Computation for Sums<'_> {
        type Output = ();

        #[inline(always)]
        fn run(self) {
            for k in 0..self.1.len() {
                for (x, own) in self.1[k..].iter_mut().zip(self.0) {
                    *x += own * self.0[k];
                }
            }
        }
    }

    #[test]
    fn wide_vectors_give_the_same_bits() {
        let numbers: Vec<f64> = (1..1000).map(|k| 1.0 / f64::from(k)).collect();
        let (mut plain, mut vectors) = (vec![0.1; 999], vec![0.1; 999]);
        Sums(&numbers, &mut plain).run();
        wide(Sums(&numbers, &mut vectors));
        assert_eq!(plain, vectors);
    }
}
