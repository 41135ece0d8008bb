//! Real numbers in double or single precision.

use faer::traits::ComplexField;
use nalgebra::RealField;

/// A real number in which a computation that both precisions suffice for is carried out.
pub trait Number: RealField + ComplexField + Copy + Default {
    /// The nearest one.
    fn of(x: f64) -> Self;

    /// The same in double precision.
    fn double(self) -> f64;

    /// The nearest ones of a list; `room` receives them unless they are the list itself.
    fn all<'a>(list: &'a [f64], room: &'a mut Vec<Self>) -> &'a [Self];
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
    fn all<'a>(list: &'a [f64], _: &'a mut Vec<Self>) -> &'a [Self] {
        list
    }
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
    fn all<'a>(list: &'a [f64], room: &'a mut Vec<Self>) -> &'a [Self] {
        room.resize(list.len(), 0.0);
        room.iter_mut().zip(list).for_each(|(own, x)| *own = *x as f32);
        room
    }
}
