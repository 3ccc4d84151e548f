//! How a scalar lies in memory.

use super::Real;
use core::any::TypeId;

/// A scalar that is nothing but numbers side by side, as they lie in memory: what machine code can work on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// How many numbers.
    pub lanes: usize,
    /// `f32` instead of `f64`.
    pub single: bool,
    /// Whether [`Real::mul_add`] rounds once.
    pub fused: bool,
}

impl Layout {
    /// That of `f64`, `f32`, and of the registers of [`lanes`](super::lanes); `None` of any other scalar.
    ///
    /// Every operation of these scalars but the elementary functions is one of IEEE 754 in each lane.
    pub fn of<T: Real>() -> Option<Layout> {
        let number = |single| Layout {
            lanes: 1,
            single,
            // as in `mul_add`
            fused: cfg!(any(target_feature = "fma", target_arch = "aarch64")),
        };
        if TypeId::of::<T>() == TypeId::of::<f64>() {
            return Some(number(false));
        }
        if TypeId::of::<T>() == TypeId::of::<f32>() {
            return Some(number(true));
        }
        super::lanes::layout::<T>()
    }
}

#[cfg(test)]
mod tests {
    use super::Layout;
    use crate::real::lanes::{OfAnyWidth, Several, with_width, with_width_of_singles};
    use crate::{Dual, Real, Width};

    /// Compares the layout of a scalar with what it says of itself.
    struct Compare;

    impl<F: Real> OfAnyWidth<F> for Compare {
        type Output = bool;
        fn run<T: Several<One = F>>(self) -> bool {
            let layout = Layout::of::<T>().unwrap();
            assert_eq!(layout.lanes, T::LANES);
            assert_eq!(size_of::<T>(), T::LANES * size_of::<F>());
            assert_eq!(layout.single, size_of::<F>() == 4);
            assert_eq!(Layout::of::<Dual<T>>(), None);
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
    fn numbers_fuse_where_the_target_does() {
        let third = 1.0 / 3.0_f64;
        let fused = Real::mul_add(third, 3.0, -1.0) != 0.0;
        assert_eq!(Layout::of::<f64>().unwrap().fused, fused);
        assert_eq!(Layout::of::<f32>().unwrap().fused, fused);
        assert!(!Layout::of::<f64>().unwrap().single);
        assert!(Layout::of::<f32>().unwrap().single);
    }
}
