//! The layout of a scalar in memory.

use super::{Array2, Array4, Array8, Dual, Real};
use core::any::TypeId;

/// The layout of a scalar that machine code can work on: numbers side by side in memory, followed, for a dual number,
/// by its slopes in the same arrangement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Number of lanes, without those of slopes.
    pub lanes: usize,
    /// Whether numbers are `f32` instead of `f64`.
    pub single: bool,
    /// Whether [`Real::mul_add`] rounds only once.
    pub fused: bool,
    /// Whether it is a dual number.
    pub slopes: bool,
}

impl Layout {
    /// The layout of `f64`, `f32`, [`Array2`], [`Array4`], [`Array8`], of the registers of [`lanes`](super::lanes), and
    /// of [`Dual`] over these; `None` for any other scalar.
    ///
    /// Every operation of these scalars, except the elementary functions, is an operation of IEEE 754 in each lane.
    pub fn of<T: Real>() -> Option<Layout> {
        Layout::of_type(TypeId::of::<T>())
    }

    /// [`Layout::of`], compiled once for all scalars.
    fn of_type(scalar: TypeId) -> Option<Layout> {
        let numbers = |lanes, single| Layout {
            lanes,
            single,
            fused: false,
            slopes: false,
        };
        (numbers(1, false).if_over::<f64>(scalar))
            .or_else(|| numbers(1, true).if_over::<f32>(scalar))
            .or_else(|| numbers(2, false).if_over::<Array2>(scalar))
            .or_else(|| numbers(4, false).if_over::<Array4>(scalar))
            .or_else(|| numbers(8, false).if_over::<Array8>(scalar))
            .or_else(|| super::lanes::layout(scalar))
    }

    /// This layout if the scalar is `N`; the one with slopes if it is a dual number over `N`.
    pub(super) fn if_over<N: Real>(self, scalar: TypeId) -> Option<Layout> {
        let slopes = scalar == TypeId::of::<Dual<N>>();
        (slopes || scalar == TypeId::of::<N>()).then_some(Layout { slopes, ..self })
    }
}
