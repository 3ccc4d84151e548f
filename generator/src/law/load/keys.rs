//! The keys of a given load.

use crate::description::curve::Function;
use crate::description::expand::{Expander, Node};
use crate::description::place::At;
use crate::description::point::Point;
use crate::description::quantity::OneOrThree;
use crate::description::shape::{Key, record};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Header, Keys, record};

record! {
    /// A given force and moment on an element.
    Load as "a load" {
        /// Name, unique among the loads.
        load: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
        /// The element, as `system/element`.
        on: String,
        /// Where the force acts, local frame \[m\].
        at: Option<Point>,
        /// Per absolute axis \[N\]: a number or a curve of time.
        force: Option<Vec<Function>>,
        /// About y, or per absolute axis \[N m\]: a number or a curve of time.
        moment: Option<OneOrThree<Function>>,
    }
}

impl Keys for Load {
    const KEY: &'static str = "load";
    const OBSERVABLE: bool = false;

    fn header(&self) -> Header<'_> {
        Header {
            name: self.load.clone(),
            called: Some((Self::KEY, &self.load)),
            enabled: self.enabled,
            since: self.since.as_deref(),
            until: self.until.as_deref(),
        }
    }

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::load(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, &'static [Key])> {
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
