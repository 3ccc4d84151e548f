//! Over lanes of every width that the processor has, every method of every bundled model has the bits of the generated Rust.

use super::common::{self, InLanes};
use bryant_runtime::real::lanes::{OfAnyWidth, with_width};
use bryant_runtime::{Model, Several, Width};
use std::marker::PhantomData;

/// Compares one model.
struct Check<'a, M>(&'a str, PhantomData<M>);

impl<M: Model<f64>> OfAnyWidth for Check<'_, M> {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        common::check::<M, T, InLanes>(self.0);
    }
}

fn check<M: Model<f64>>(name: &str) {
    for width in Width::ALL {
        with_width(width, Check::<M>(name, PhantomData));
    }
}

models!(check);
