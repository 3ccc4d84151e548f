//! A force of the user's own as written: the function, what it looks at, what it acts on, what it is given.

use crate::description::curve::{FunctionOf, OverTime};
use crate::description::force::{Acting, Attachment};
use crate::description::measure::{Any, Time};
use crate::description::place::At;
use crate::description::point::Point;
use crate::description::quantity::Number;
use crate::description::shape::{Flat, Key, Named, record};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Keys, record};

record! {
    /// A force computed by a Rust function of the user's.
    User as "a user force" {
        /// name, unique among the user forces
        user: String,
        /// when it acts
        acting: Flat<Acting>,
        /// the function: its name in `source`; without `source` its path in the crate that includes the module, such as
        /// `crate::aero::drag`
        function: Option<String> = "the name of the force",
        /// the Rust file with the function, relative to this file
        source: Option<String>,
        /// the shortest time in which the force changes by much: no step of the adaptive methods is longer
        scale: Option<Number<Time>> = "`every` of the run",
        /// by name: [points](#a-point-of-a-user-force) whose motion it is given and on which it returns forces
        points: Option<Named<UserPoint>>,
        /// by name: elements (`head: man/head`) whose rotation it is given and on which it returns moments, in absolute
        /// axes
        bodies: Option<Named<String>>,
        /// by name: [lines](#a-line-of-a-user-force) along which it pulls
        lines: Option<Named<UserLine>>,
        /// by name: elements (`elbow: man/forearm`) in whose joints it acts, on the element and, opposite, on its
        /// carrier
        joints: Option<Named<String>>,
        /// by name: [freedoms](#a-freedom-of-a-user-force) (degrees of freedom) of joints with coordinates of their
        /// own, along which it acts
        freedoms: Option<Named<UserFreedom>>,
        /// by name: numbers, expressions of parameters, and curves of time, whose value at the current time is given
        parameters: Option<Named<OverTime<Any>>>,
        /// by name: curves (named, scaled, or written here) that the function evaluates at any abscissa
        curves: Option<Named<FunctionOf<Any, Any>>>,
        /// by name: [state variables](#a-state-of-a-user-force), integrated with the motion
        states: Option<Named<UserState>>,
    }
}

record! {
    /// A point that the function looks at and acts on.
    UserPoint as "a point of a user force" {
        /// `frame`, a vehicle, or an element as `system/element`; a force on `frame` or a vehicle moves nothing
        on: String,
        /// `cg`, or coordinates in the local frame
        at: Point,
    }
}

record! {
    /// A straight line between two points.
    UserLine as "a line of a user force" {
        /// one [end](#an-attachment)
        from: Attachment,
        /// the other end, on another body
        to: Attachment,
    }
}

record! {
    /// A freedom of a joint.
    UserFreedom as "a freedom of a user force" {
        /// the element that the joint carries, as `system/element`
        joint: String,
        /// required if the joint has several freedoms: which one
        freedom: Option<String>,
    }
}

record! {
    /// A state variable.
    UserState as "a state of a user force" {
        /// value at the start of a run
        initial: Number<Any>,
    }
}

impl Keys for User {
    const KEY: &'static str = "user";
    const HAS_PORTS: bool = true;
    const SOURCE: Option<&'static str> = Some("source");

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::user(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, Vec<Key>)> {
        vec![
            record::<User>(),
            record::<UserPoint>(),
            record::<UserLine>(),
            record::<UserFreedom>(),
            record::<UserState>(),
        ]
    }
}
