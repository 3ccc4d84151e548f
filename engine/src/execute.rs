//! The interface of everything that evaluates the methods of a model.

use bryant_generator::program::{Combination, Method};
use bryant_runtime::Real;

/// The inputs of a method, besides the parameters and the values derived from them.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a, T> {
    /// t \[s\].
    pub time: T,
    /// The state y: q, v, z, m; empty for methods that need only parameters.
    pub state: &'a [T],
    /// The results of an earlier method, for methods that need them: accelerations or event functions; otherwise empty.
    pub before: &'a [T],
}

impl<T: Real> Given<'_, T> {
    /// Empty inputs, for methods that need only parameters.
    pub fn nothing() -> Self {
        Given {
            time: T::from_f64(0.0),
            state: &[],
            before: &[],
        }
    }
}

/// Evaluates the lists of one model over one scalar.
pub trait Execute<T: Real> {
    /// Sets the parameters, and the values derived from them, for all later calls. `derived` is empty before a call of
    /// [`Method::Derived`], which computes the derived values.
    fn set_constants(&mut self, parameters: &[T], derived: &[T]);
    /// Evaluates a method. `results` is as long as the results of its list. Nothing is allocated.
    fn run(&self, method: Method, given: Given<'_, T>, results: &mut [T]);
    /// Evaluates several methods at once and returns true; returns false and writes nothing if this is not possible.
    /// `results` takes the results of the methods, one after the other, and is at least as long. No method of a
    /// combination has inputs from an earlier method.
    fn run_combined(
        &self,
        combination: Combination,
        given: Given<'_, T>,
        results: &mut [T],
    ) -> bool {
        let _ = (combination, given, results);
        false
    }
    /// Evaluates the outputs with these indices and returns true; returns false and writes nothing if there is no
    /// machine code for them. `results` is as long as `wanted`, which is the same at every call until
    /// [`Execute::forget_outputs`].
    fn run_outputs(&self, wanted: &[usize], given: Given<'_, T>, results: &mut [T]) -> bool {
        let _ = (wanted, given, results);
        false
    }
    /// Discards the machine code for outputs, because other outputs will be wanted.
    fn forget_outputs(&mut self) {}
}
