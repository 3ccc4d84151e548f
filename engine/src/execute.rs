//! The interface of everything that evaluates the methods of a model.

use bryant_generator::program::Methods;
use bryant_runtime::Real;

/// The inputs of a method, besides the parameters and the values derived from them.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a, T> {
    /// t \[s\].
    pub time: T,
    /// The state y: q, v, z, m; empty for methods that need only parameters.
    pub state: &'a [T],
}

impl<T: Real> Given<'_, T> {
    /// Empty inputs, for methods that need only parameters.
    pub fn nothing() -> Self {
        Given {
            time: T::from_f64(0.0),
            state: &[],
        }
    }
}

/// Evaluates the lists of one model over one scalar.
pub trait Execute<T: Real> {
    /// Sets the parameters, and the values derived from them, for all later calls. `derived` is empty before a call of
    /// [`Method::Derived`](bryant_generator::program::Method::Derived), which computes the derived values.
    fn set_constants(&mut self, parameters: &[T], derived: &[T]);
    /// Evaluates methods and returns true. `results` takes the results of the methods, one after the other, and is at
    /// least as long. Returns false and writes nothing if there are too many sets of several methods; never for one
    /// method.
    /// Nothing is allocated but when a set is used for the first time.
    fn run(&self, methods: Methods, given: Given<'_, T>, results: &mut [T]) -> bool;
    /// Evaluates a function that was asked for. The state is followed by the accelerations if the function needs them.
    fn run_function(&self, index: usize, given: Given<'_, T>, results: &mut [T]);
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
