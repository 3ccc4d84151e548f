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

#[cfg(test)]
mod tests {
    use super::{Array2, Array4, Array8, Layout};
    use crate::real::lanes::{OfAnyWidth, Several, with_width, with_width_of_singles};
    use crate::{Dual, Real, Width};

    /// Compares the layout of a scalar with its properties.
    struct Compare;

    impl<F: Real> OfAnyWidth<F> for Compare {
        type Output = bool;
        fn run<T: Several<One = F>>(self) -> bool {
            let layout = Layout::of::<T>().unwrap();
            assert_eq!(layout.lanes, T::LANES);
            assert_eq!(size_of::<T>(), T::LANES * size_of::<F>());
            assert_eq!(layout.single, size_of::<F>() == 4);
            let dual = Layout::of::<Dual<T>>().unwrap();
            assert_eq!(
                dual,
                Layout {
                    slopes: true,
                    ..layout
                }
            );
            assert_eq!(size_of::<Dual<T>>(), 2 * size_of::<T>());
            assert_eq!(core::mem::offset_of!(Dual<T>, slope), size_of::<T>());
            assert_eq!(Layout::of::<Dual<Dual<T>>>(), None);
            layout.fused
        }
    }

    #[test]
    fn lanes_lie_side_by_side() {
        for width in Width::ALL {
            let fused = with_width(width, Compare);
            assert!(fused.is_none_or(|fused| fused == width.fuses()));
            let fused = with_width_of_singles(width, Compare);
            assert!(fused.is_none_or(|fused| fused == width.fuses()));
        }
    }

    #[test]
    fn numbers_do_not_fuse() {
        let (four, eight) = (Layout::of::<Array4>(), Layout::of::<Array8>());
        let all = [Layout::of::<f64>(), Layout::of::<f32>(), four, eight];
        let all = all.map(Option::unwrap);
        assert_eq!(all.map(|layout| layout.fused), [false; 4]);
        assert_eq!(all.map(|layout| layout.single), [false, true, false, false]);
        assert_eq!(
            Layout::of::<Array2>().map(|two| (8 * two.lanes, two.fused)),
            Some((size_of::<Array2>(), false))
        );
        assert_eq!(all[2].lanes * 8, size_of::<Array4>());
        assert_eq!(all[3].lanes * 8, size_of::<Array8>());
        let pair = Layout::of::<Dual<Array8>>().unwrap();
        assert!(pair.slopes && pair.lanes == 8 && !pair.fused);
    }
}
