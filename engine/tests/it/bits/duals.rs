//! Over dual numbers, every method of every bundled model has the bits of the generated Rust. Over dual numbers of lanes, it has the bits
//! of the interpreter.

use super::common::{self, InLanes, Single, compare, engine};
use bryant_engine::Engine;
use bryant_runtime::real::lanes::{OfAnyWidth, with_width};
use bryant_runtime::{Dual, Model, Several, Width};

/// Compares one model over dual numbers of lanes.
struct OfLanes<'a>(&'a Engine);

impl OfAnyWidth for OfLanes<'_> {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        let mut expected = self.0.interpreted::<Dual<T>>();
        compare::<Dual<T>, InLanes>(&mut expected, &mut Engine::over::<Dual<T>>(self.0));
    }
}

/// Compares one model.
fn check<M: Model<f64>>(name: &str) {
    common::check::<M, Dual<f64>, Single>(name);
    let engine = engine(name, true);
    for width in Width::ALL {
        with_width(width, OfLanes(&engine));
    }
}

models!(check);
