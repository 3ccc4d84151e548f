//! Functions of the user are called for every lane.

use bryant_engine::UserFunctions;
use bryant_runtime::real::Form;
use bryant_runtime::real::lanes::{OfAnyWidth, Several, with_width};
use bryant_runtime::{Dual, Width};

/// (a, b) → (b, 2 a), for values and slopes alike.
#[derive(Debug)]
struct Swap;

impl UserFunctions for Swap {
    fn knows(&self, force: usize) -> bool {
        force == 3
    }

    fn call(&self, force: usize, form: Form, arguments: &[f64], results: &mut [f64]) {
        assert_eq!(force, 3);
        let words = form.words();
        assert_eq!(arguments.len(), 2 * words * form.lanes);
        for (from, to) in arguments
            .chunks_exact(2 * words)
            .zip(results.chunks_exact_mut(2 * words))
        {
            for k in 0..words {
                to[k] = from[words + k];
                to[words + k] = 2.0 * from[k];
            }
        }
    }
}

struct Check;

impl OfAnyWidth for Check {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        let mut a = T::from_f64(0.0);
        for lane in 0..T::LANES {
            a = a.with_lane(lane, lane as f64 + 0.5);
        }
        let b = T::from_f64(9.0);
        let dual = |value, slope| Dual { value, slope };
        let mut results = [dual(a, a); 2];
        let swap: &dyn UserFunctions = &Swap;
        swap.call_over(3, &[dual(a, b), dual(b, a)], &mut results);
        assert_eq!(results, [dual(b, a), dual(a + a, b + b)]);
    }
}

#[test]
fn every_lane_is_called() {
    for width in Width::ALL {
        with_width(width, Check);
    }
    let mut results = [0.0f32; 2];
    let swap: &dyn UserFunctions = &Swap;
    swap.call_over(3, &[1.5_f32, 4.0], &mut results);
    assert_eq!(results, [4.0, 3.0]);
}
