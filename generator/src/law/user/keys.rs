//! A force of the user's own as written: the function, what it looks at, what it acts on, what it is given.

use crate::description::curve::Function;
use crate::description::force::Attachment;
use crate::description::place::At;
use crate::description::point::Point;
use crate::description::quantity::Quantity;
use crate::description::shape::{Key, Named, record};
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Header, Keys, record};

record! {
    /// A force computed by a Rust function of the user's.
    User as "a user force" {
        /// Name, unique among the user forces.
        user: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// The function: its name in `source`, or its path in the crate that the module is generated for.
        function: Option<String>,
        /// The Rust file with the function, relative to this one.
        source: Option<String>,
        /// The shortest time in which the force changes by much: no step is longer; without one that is `every` of the run.
        scale: Option<Quantity>,
        /// Points: their position and velocity, and a force on each.
        points: Option<Named<UserPoint>>,
        /// Elements: their orientation and angular velocity, and a moment on each.
        bodies: Option<Named<String>>,
        /// Lines between two points: their length and its rate, and a tension in each.
        lines: Option<Named<UserLine>>,
        /// Joints, by the element that they carry: the relative angles and rates, and torques.
        joints: Option<Named<String>>,
        /// Freedoms of joints: their coordinates and rates, and a torque or force along each.
        freedoms: Option<Named<UserFreedom>>,
        /// Numbers and curves of time.
        parameters: Option<Named<Function>>,
        /// Curves that the function looks up.
        curves: Option<Named<Function>>,
        /// Variables of its own, integrated with the motion.
        states: Option<Named<UserState>>,
    }
}

record! {
    /// A point that the function looks at and acts on.
    UserPoint as "a point of a user force" {
        /// `frame`, or an element as `system/element`.
        on: String,
        /// `cg`, or the point in the local frame \[m\].
        at: Point,
    }
}

record! {
    /// A straight line between two points.
    UserLine as "a line of a user force" {
        /// One end.
        from: Attachment,
        /// The other end.
        to: Attachment,
    }
}

record! {
    /// A freedom of a joint.
    UserFreedom as "a freedom of a user force" {
        /// The element that the joint carries, as `system/element`.
        joint: String,
        /// Of a joint with several freedoms: which.
        freedom: Option<String>,
    }
}

record! {
    /// A state variable.
    UserState as "a state of a user force" {
        /// Value at the start of a run.
        initial: Quantity,
    }
}

impl Keys for User {
    const KEY: &'static str = "user";
    const HAS_PORTS: bool = true;
    const SOURCE: Option<&'static str> = Some("source");

    fn header(&self) -> Header<'_> {
        Header {
            name: self.user.clone(),
            called: Some((Self::KEY, &self.user)),
            enabled: self.enabled,
            since: self.since.as_deref(),
            until: self.until.as_deref(),
        }
    }

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::user(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, &'static [Key])> {
        vec![
            record::<User>(),
            record::<UserPoint>(),
            record::<UserLine>(),
            record::<UserFreedom>(),
            record::<UserState>(),
        ]
    }
}
