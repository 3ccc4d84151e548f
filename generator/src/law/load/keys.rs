//! The keys of a given load.

use crate::description::curve::OverTime;
use crate::description::expand::{Expander, Node};
use crate::description::force::Acting;
use crate::description::measure::{Force, Moment};
use crate::description::place::At;
use crate::description::point::Point;
use crate::description::quantity::OneOrThree;
use crate::description::shape::{Flat, Key, record};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Keys, record};

record! {
    /// A given force and moment on an element.
    Load as "a load" {
        /// name, unique among the loads
        load: String,
        /// when it acts
        acting: Flat<Acting>,
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
        /// the element, as `system/element`
        on: String,
        /// where the force acts: `cg`, or coordinates in the local frame
        at: Option<Point> = "the joint of the element",
        /// per absolute axis: a number, or a curve of time (s → N)
        force: Option<Vec<OverTime<Force>>> = "0",
        /// a number, or a curve of time (s → N·m): about +y in the plane; `[x, y, z]` in absolute axes in space
        moment: Option<OneOrThree<OverTime<Moment>>> = "0",
    }
}

impl Keys for Load {
    const KEY: &'static str = "load";
    const OBSERVABLE: bool = false;

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::load(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, Vec<Key>)> {
        vec![record::<Load>()]
    }

    fn mirror(expander: &Expander<'_>, image: &mut Node) {
        image.change("on", |n| expander.body(n));
        image.change("at", |n| expander.polar(n));
        image.change("force", |n| {
            expander.reversed(
                n,
                |axis, mirror| axis == mirror,
                expander.negated_function(),
            )
        });
        image.change("moment", |n| {
            expander.reversed(
                n,
                |axis, mirror| axis != mirror,
                expander.negated_function(),
            )
        });
    }
}
