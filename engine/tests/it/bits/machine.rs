//! Machine code and the interpreter, of every bundled model, over every scalar.

use super::common::{InLanes, Near, Single, compare, engine};
use bryant_engine::Engine;
use bryant_engine::internals::for_batch;
use bryant_generated::MODELS;
use bryant_runtime::real::lanes::{OfAnyWidth, with_width, with_width_of_singles};
use bryant_runtime::{Dual, Fast, Several, Width};

/// Compares all models over one scalar.
fn check<T: Near>() {
    for bundled in MODELS {
        let engine = engine(bundled.entry.info.name, true);
        let mut expected = engine.interpreted::<T>();
        compare::<T, Single>(&mut expected, &mut Engine::over::<T>(&engine));
    }
}

#[test]
fn doubles() {
    check::<f64>();
}

#[test]
fn singles() {
    check::<f32>();
}

#[test]
fn fast() {
    check::<Fast>();
}

#[test]
fn duals() {
    for bundled in MODELS {
        let engine = engine(bundled.entry.info.name, true);
        let [mut expected, mut found] = for_batch::<Dual<f64>>(&engine);
        compare::<Dual<f64>, Single>(&mut *expected, &mut *found);
    }
}

/// Compares all models over lanes, and over dual numbers of lanes.
struct OfLanes;

impl OfAnyWidth for OfLanes {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        for bundled in MODELS {
            let engine = engine(bundled.entry.info.name, true);
            let [mut expected, mut found] = for_batch::<T>(&engine);
            compare::<T, InLanes>(&mut *expected, &mut *found);
            let [mut expected, mut found] = for_batch::<Dual<T>>(&engine);
            compare::<Dual<T>, InLanes>(&mut *expected, &mut *found);
        }
    }
}

#[test]
fn lanes_of_every_width() {
    for width in Width::ALL {
        with_width(width, OfLanes);
    }
}

/// Compares all models over lanes of singles.
struct OfSingles;

impl OfAnyWidth<f32> for OfSingles {
    type Output = ();
    fn run<T: Several<One = f32>>(self) {
        for bundled in MODELS {
            // the forces of a user have no lanes of singles here
            let name = bundled.entry.info.name;
            if matches!(name, "skydiver" | "elbow") {
                continue;
            }
            let engine = engine(name, true);
            let [mut expected, mut found] = for_batch::<T>(&engine);
            compare::<T, InLanes>(&mut *expected, &mut *found);
        }
    }
}

#[test]
fn lanes_of_singles_of_every_width() {
    for width in Width::ALL {
        with_width_of_singles(width, OfSingles);
    }
}
