//! The layouts of scalars in memory.

use bryant_runtime::real::lanes::{OfAnyWidth, Several, with_width, with_width_of_singles};
use bryant_runtime::real::{Array2, Array4, Array8, Layout};
use bryant_runtime::{Dual, Real, Width};

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
        assert!(fused.is_none_or(|fused| fused));
        let fused = with_width_of_singles(width, Compare);
        assert!(fused.is_none_or(|fused| fused));
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
