//! Generated Rust and machine code over every scalar: for the nightly checks.

use super::common::{InLanes, Single, check};
use bryant_runtime::real::lanes::{OfAnyWidth, with_width};
use bryant_runtime::{DoubleDouble, Dual, Fast, Model, Several, Width};
use std::marker::PhantomData;

/// Compares one model over lanes.
struct OfLanes<'a, M>(&'a str, PhantomData<M>);

impl<M: Model<f64>> OfAnyWidth for OfLanes<'_, M> {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        check::<M, T, InLanes>(self.0);
    }
}

/// Compares one model over every scalar.
fn over_every_scalar<M: Model<f64>>(name: &str) {
    check::<M, f32, Single>(name);
    check::<M, Fast, Single>(name);
    check::<M, DoubleDouble, Single>(name);
    check::<M, Dual<f64>, Single>(name);
    for width in Width::ALL {
        with_width(width, OfLanes::<M>(name, PhantomData));
    }
}

macro_rules! models {
    ($($module:ident $name:literal;)*) => {
        $(
            #[test]
            fn $module() {
                over_every_scalar::<bryant_generated::$module::Mechanism<f64>>($name);
            }
        )*

        #[test]
        fn every_bundled_model_is_compared() {
            let names = [$($name),*];
            for model in bryant_generated::MODELS {
                assert!(names.contains(&model.entry.info.name), "{}", model.entry.info.name);
            }
        }
    };
}

models! {
    child_seat "child-seat";
    dummy15 "dummy15";
    elbow "elbow";
    robot_arm "robot-arm";
    skydiver "skydiver";
    sled_pendulum "sled-pendulum";
}
