//! Loops over many numbers, compiled for the vectors of the processor at hand.

use pulp::{Arch, WithSimd};

pub use pulp::Simd;

/// A computation that is compiled once for each kind of processor.
///
/// Loops that the compiler would leave in scalars or shuffles name the vectors of `simd` themselves. A sum of products
/// written with
/// `mul_add_f64s` is fused on every processor, where it has no such instruction by a library function.
pub trait Computation {
    /// What it gives.
    type Output;

    /// Computes. Only what is inlined here is compiled for the processor: implementations are `#[inline(always)]`.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

struct Dispatched<C>(C);

impl<C: Computation> WithSimd for Dispatched<C> {
    type Output = C::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> C::Output {
        self.0.run(simd)
    }
}

/// Runs a computation as compiled for AVX2, where the processor has it, instead of the baseline of the target.
///
/// Results are the same bits on every processor of a target: wider vectors change neither the order of a sum nor the
/// rounding of a product, as the compiler fuses none of itself.
pub fn wide<C: Computation>(computation: C) -> C::Output {
    Arch::new().dispatch(Dispatched(computation))
}

#[cfg(test)]
mod tests {
    use pulp::Scalar;

    use super::*;

    /// Sums of products, of which fused ones would differ in the last digits.
    struct Sums<'s>(&'s [f64], &'s mut [f64]);

    impl Computation for Sums<'_> {
        type Output = ();

        #[inline(always)]
        fn run<S: Simd>(self, _: S) {
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
        Sums(&numbers, &mut plain).run(Scalar);
        wide(Sums(&numbers, &mut vectors));
        assert_eq!(plain, vectors);
    }

    /// Numbers, each times itself and a third, added to itself.
    struct Fused<'s>(&'s mut [f64]);

    impl Computation for Fused<'_> {
        type Output = ();

        #[inline(always)]
        fn run<S: Simd>(self, simd: S) {
            let (own, _) = S::as_mut_simd_f64s(self.0);
            for x in own {
                let third = simd.splat_f64s(1.0 / 3.0);
                *x = simd.mul_add_f64s(simd.mul_f64s(third, *x), *x, *x);
            }
        }
    }

    #[test]
    fn fused_products_are_the_same_bits_in_scalars_and_in_vectors() {
        let numbers: Vec<f64> = (1..=1000).map(|k| 1.0 / f64::from(k)).collect();
        let (mut scalars, mut vectors) = (numbers.clone(), numbers);
        Fused(&mut scalars).run(Scalar);
        wide(Fused(&mut vectors));
        assert_eq!(scalars, vectors);
    }
}
