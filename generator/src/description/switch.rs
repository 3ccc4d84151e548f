//! Switches as written: what makes them fire.

use super::measure::{NotNegative, OfTheQuantity, Time};
use super::output::{Axis, Component};
use super::point::Point;
use super::quantity::Number;
use super::shape::record;

record! {
    /// Something that happens once, and from then on has happened.
    Switch as "a switch" {
        /// name, unique among the switches
        switch: String,
        /// [what makes it fire](#a-trigger)
        when: Trigger,
        /// time from the trigger until the switch acts
        after: Option<Number<NotNegative<Time>>> = "0",
    }
}

record! {
    /// A time, or a quantity as of an output that passes a threshold.
    Trigger as "a trigger" {
        /// fires at this time of the run
        time: Option<Number<Time>>,
        /// the thing that has the quantity, as in an output
        of: Option<String>,
        /// which quantity, as in an output
        what: Option<String>,
        /// as in an output
        at: Option<Point> = "`cg`",
        /// as in an output
        component: Option<Component> = "`resultant`",
        /// as in an output
        axes: Option<String> = "absolute",
        /// as in an output
        relative_to: Option<String> = "`frame`",
        /// as in an output
        on: Option<String> = "the first body",
        /// as in an output
        segment: Option<u32>,
        /// as in an output
        ring: Option<String>,
        /// as in an output
        about: Option<Axis> = "none in the plane",
        /// as in an output
        freedom: Option<String>,
        /// fires when the quantity is larger than this
        above: Option<Number<OfTheQuantity>>,
        /// fires when the quantity is smaller than this
        below: Option<Number<OfTheQuantity>>,
    }
}
