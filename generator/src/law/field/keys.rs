//! The keys of a field.

use crate::description::curve::OverTime;
use crate::description::force::Acting;
use crate::description::measure::Acceleration;
use crate::description::place::At;
use crate::description::shape::{Flat, Key, record};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Keys, record};

record! {
    /// A uniform acceleration field.
    Field as "a field" {
        /// name, unique among the fields
        field: String,
        /// when it acts
        acting: Flat<Acting>,
        /// per absolute axis: a number, or a curve of time (s → m/s²)
        acceleration: Vec<OverTime<Acceleration>>,
        /// list of systems and elements that feel it
        on: Option<Vec<String>> = "all elements",
    }
}

impl Keys for Field {
    const KEY: &'static str = "field";
    const OBSERVABLE: bool = false;

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::field(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, Vec<Key>)> {
        vec![record::<Field>()]
    }
}
