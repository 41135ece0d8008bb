//! Real numbers in double or single precision, and vectors of them.

use faer::traits::ComplexField;
use nalgebra::RealField;
use pulp::Simd;

/// A real number in which a computation that both precisions suffice for is carried out.
pub trait Number: RealField + ComplexField + Copy + Default {
    /// A multiple of the lanes of every vector in use.
    const MOST_LANES: usize;

    /// A vector of them.
    type Vector<S: Simd>: Copy;

    /// The nearest one.
    fn of(x: f64) -> Self;

    /// The same in double precision.
    fn double(self) -> f64;

    /// The nearest ones of a list: itself in double precision, else written to `room`.
    fn nearest<'l>(list: &'l [f64], room: &'l mut Vec<Self>) -> &'l [Self];

    /// The whole vectors of a list.
    fn vectors<S: Simd>(list: &[Self]) -> &[Self::Vector<S>];

    /// The same, to be changed.
    fn vectors_mut<S: Simd>(list: &mut [Self]) -> &mut [Self::Vector<S>];

    /// The vector with `x` in every lane.
    fn spread<S: Simd>(simd: S, x: Self) -> Self::Vector<S>;

    /// a b.
    fn product<S: Simd>(simd: S, a: Self::Vector<S>, b: Self::Vector<S>) -> Self::Vector<S>;

    /// a b + c, rounded once.
    fn fused<S: Simd>(
        simd: S,
        a: Self::Vector<S>,
        b: Self::Vector<S>,
        c: Self::Vector<S>,
    ) -> Self::Vector<S>;

    /// c − a b, rounded once.
    fn fused_less<S: Simd>(
        simd: S,
        a: Self::Vector<S>,
        b: Self::Vector<S>,
        c: Self::Vector<S>,
    ) -> Self::Vector<S>;

    /// a b − c, rounded once.
    fn fused_from<S: Simd>(
        simd: S,
        a: Self::Vector<S>,
        b: Self::Vector<S>,
        c: Self::Vector<S>,
    ) -> Self::Vector<S>;
}

/// What differs between the two precisions in name only.
macro_rules! vectors {
    (
        $lanes:literal, $vector:ident, $list:ident, $list_mut:ident, $splat:ident, $product:ident, $fused:ident,
        $fused_less:ident, $negative:ident
    ) => {
        const MOST_LANES: usize = $lanes;

        type Vector<S: Simd> = S::$vector;

        #[inline(always)]
        fn vectors<S: Simd>(list: &[Self]) -> &[S::$vector] {
            S::$list(list).0
        }

        #[inline(always)]
        fn vectors_mut<S: Simd>(list: &mut [Self]) -> &mut [S::$vector] {
            S::$list_mut(list).0
        }

        #[inline(always)]
        fn spread<S: Simd>(simd: S, x: Self) -> S::$vector {
            simd.$splat(x)
        }

        #[inline(always)]
        fn product<S: Simd>(simd: S, a: S::$vector, b: S::$vector) -> S::$vector {
            simd.$product(a, b)
        }

        #[inline(always)]
        fn fused<S: Simd>(simd: S, a: S::$vector, b: S::$vector, c: S::$vector) -> S::$vector {
            simd.$fused(a, b, c)
        }

        #[inline(always)]
        fn fused_less<S: Simd>(simd: S, a: S::$vector, b: S::$vector, c: S::$vector) -> S::$vector {
            simd.$fused_less(a, b, c)
        }

        #[inline(always)]
        fn fused_from<S: Simd>(simd: S, a: S::$vector, b: S::$vector, c: S::$vector) -> S::$vector {
            simd.$fused(a, b, simd.$negative(c))
        }
    };
}

impl Number for f64 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn double(self) -> f64 {
        self
    }

    #[inline(always)]
    fn nearest<'l>(list: &'l [f64], _: &'l mut Vec<Self>) -> &'l [Self] {
        list
    }

    vectors!(
        4,
        f64s,
        as_simd_f64s,
        as_mut_simd_f64s,
        splat_f64s,
        mul_f64s,
        mul_add_f64s,
        negate_mul_add_f64s,
        neg_f64s
    );
}

impl Number for f32 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x as f32
    }

    #[inline(always)]
    fn double(self) -> f64 {
        f64::from(self)
    }

    #[inline(always)]
    fn nearest<'l>(list: &'l [f64], room: &'l mut Vec<Self>) -> &'l [Self] {
        room.resize(list.len(), 0.0);
        room.iter_mut().zip(list).for_each(|(own, x)| *own = *x as f32);
        room
    }

    vectors!(
        8,
        f32s,
        as_simd_f32s,
        as_mut_simd_f32s,
        splat_f32s,
        mul_f32s,
        mul_add_f32s,
        negate_mul_add_f32s,
        neg_f32s
    );
}
