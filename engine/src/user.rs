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
