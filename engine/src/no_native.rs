//! Replaces machine code on systems that have none, and where `--cfg bryant_interpret` leaves it out.

use crate::execute::Given;
use bryant_generator::expression::Function;
use bryant_generator::program::{Curve, List};
use bryant_runtime::Real;
use std::cell::RefCell;
use std::marker::PhantomData;

/// A function that a list calls.
#[allow(dead_code, reason = "machine code alone calls it")]
pub trait Call<T> {
    /// Writes the results.
    fn call(&self, arguments: &[T], results: &mut [T]);
}

/// Machine code, which cannot exist here.
#[derive(Debug)]
pub struct Compiled<T, C>(std::convert::Infallible, PhantomData<fn(T, C)>);

impl<T: Real, C: Call<T>> Compiled<T, C> {
    /// Cannot be called.
    pub fn bytes(&self) -> usize {
        match self.0 {}
    }

    /// Never happens.
    pub fn run(&self, _: Given<T>, _: (&[T], &[T]), _: &RefCell<Vec<T>>, _: &mut [T]) {
        match self.0 {}
    }
}

/// Returns `None`: no scalar has a target.
pub fn target<T: Real>() -> Option<std::convert::Infallible> {
    None
}

/// Returns false: no scalar has machine code.
pub fn has_machine_code<T: Real>() -> bool {
    false
}

/// Returns `None`: there is no machine code.
pub fn compile<T: Real, C: Call<T>>(
    _: &List,
    _: &[Curve],
    _: impl FnMut(Function) -> C,
) -> Option<Compiled<T, C>> {
    None
}
