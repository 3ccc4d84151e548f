//! How the methods of a model are evaluated, apart from what they are.

use bryant_generator::program::{Combination, Method};
use bryant_runtime::Real;

/// What a method starts from, besides parameters and what is derived from them.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a, T> {
    /// t \[s\].
    pub time: T,
    /// The state y: q, v, z, m; nothing for methods that need parameters alone.
    pub state: &'a [T],
    /// Accelerations or guards, where the method starts from them; else nothing.
    pub before: &'a [T],
}

impl<T: Real> Given<'_, T> {
    /// Nothing: for methods that need parameters alone.
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
    /// Takes the parameters and what is derived from them, for all that is run from now on. [`Method::Derived`] is run with parameters
    /// alone: `derived` is then empty.
    fn set_constants(&mut self, parameters: &[T], derived: &[T]);
    /// Evaluates a method. `results` is as long as the results of its list. Nothing is allocated.
    fn run(&self, method: Method, given: Given<'_, T>, results: &mut [T]);
    /// Evaluates several methods at once, where that is possible; false where it is not, and nothing is written then. `results` is at least as
    /// long as those of the methods, which stand there one behind the other. No method needs anything from before.
    fn run_combined(
        &self,
        combination: Combination,
        given: Given<'_, T>,
        results: &mut [T],
    ) -> bool {
        let _ = (combination, given, results);
        false
    }
    /// Evaluates these outputs, by their index, where several methods at once are possible; false where they are not, and nothing is written
    /// then. `results` is as long as `wanted`, which is the same at every call until [`Execute::forget_outputs`].
    fn run_outputs(&self, wanted: &[usize], given: Given<'_, T>, results: &mut [T]) -> bool {
        let _ = (wanted, given, results);
        false
    }
    /// Other outputs will be wanted.
    fn forget_outputs(&mut self) {}
}
