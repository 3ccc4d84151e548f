//! Functions of the user as an engine calls them: with plain numbers, so any compiler may have made them.

use bryant_runtime::Real;
use bryant_runtime::real::Form;
use std::cell::Cell;
use std::fmt::Debug;

/// The functions of a model's user forces. They take and return plain numbers, the words of a scalar ([`Form`]), so
/// they serve all scalars.
pub trait UserFunctions: Debug + Send + Sync {
    /// True if there is a function for the force with this index in the model.
    fn knows(&self, force: usize) -> bool;
    /// Calls the function of a force, lane by lane: `arguments` has the words of all arguments, `results` takes the
    /// words of all results, those of the first lane first. A function that fails writes NaN to all results, and
    /// reports the reason elsewhere.
    fn call(&self, force: usize, form: Form, arguments: &[f64], results: &mut [f64]);
}

thread_local! {
    /// A buffer for words, kept so that later calls do not allocate.
    static PLACE: Cell<Vec<f64>> = const { Cell::new(Vec::new()) };
}

impl dyn UserFunctions {
    /// Calls the function of a force over a scalar that has a [form](Real::FORM). Over any other scalar all results are
    /// NaN.
    #[inline(always)]
    pub fn call_over<T: Real>(&self, force: usize, arguments: &[T], results: &mut [T]) {
        let Some(form) = T::FORM else {
            results.fill(T::from_f64(f64::NAN));
            return;
        };
        let words = form.words();
        let [given, returned] = [arguments.len(), results.len()].map(|length| length * words);
        let mut place = PLACE.take();
        let wanted = (given + returned) * form.lanes;
        if place.len() < wanted {
            place.resize(wanted, 0.0);
        }
        let (given_words, rest) = place.split_at_mut(given * form.lanes);
        let returned_words = &mut rest[..returned * form.lanes];
        for (index, argument) in arguments.iter().enumerate() {
            argument.put(given, &mut given_words[index * words..]);
        }
        self.call(force, form, given_words, returned_words);
        for (index, result) in results.iter_mut().enumerate() {
            *result = T::of_words(returned, &returned_words[index * words..]);
        }
        PLACE.set(place);
    }
}

#[cfg(test)]
mod tests {
    use super::UserFunctions;
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
}
