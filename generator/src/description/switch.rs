//! Switches as written: what makes them fire.

use super::output::{Axis, Component};
use super::point::Point;
use super::quantity::Quantity;
use super::shape::record;

record! {
    /// Something that happens once, and from then on has happened.
    Switch as "a switch" {
        /// Name, unique among the switches.
        switch: String,
        /// What makes it fire.
        when: Trigger,
        /// Time from there until it acts \[s\].
        after: Option<Quantity>,
    }
}

record! {
    /// A time, or a quantity as of an output that passes a threshold.
    Trigger as "a trigger" {
        /// The time \[s\].
        time: Option<Quantity>,
        /// What is looked at, as in an output.
        of: Option<String>,
        /// What of it.
        what: Option<String>,
        /// The point of an element, local frame \[m\].
        at: Option<Point>,
        /// Which component of a vector.
        component: Option<Component>,
        /// The body along whose axes: `frame`, `local`, a vehicle or an element.
        axes: Option<String>,
        /// The body that the observer rides on.
        relative_to: Option<String>,
        /// Of a joint, a contact or a belt: the body on which the force acts.
        on: Option<String>,
        /// Of a belt that runs through rings: which segment, counted from its end `from`.
        segment: Option<u32>,
        /// Of a belt that runs through rings: which ring.
        ring: Option<String>,
        /// In space: which relative rotation of a joint.
        about: Option<Axis>,
        /// Of a joint with several freedoms of its own: which.
        freedom: Option<String>,
        /// Fires when the quantity is larger than this.
        above: Option<Quantity>,
        /// Fires when the quantity is smaller than this.
        below: Option<Quantity>,
    }
}
