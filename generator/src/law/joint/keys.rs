//! The keys of a joint force: laws about rotations, of flexion and torsion, of the coordinates of freedoms.

use crate::description::curve::Function;
use crate::description::expand::{Expander, Node};
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::description::shape::{Key, record, words};
use crate::description::short::Each;
use crate::description::short::LongAxis;
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Header, Keys, record};

record! {
    /// Torque in a joint.
    Joint as "a joint force" {
        /// The element that the joint carries, as `system/element`.
        joint: Each<String>,
        /// Of a joint with several freedoms of its own: which.
        freedom: Option<String>,
        /// Where the joint has several forces: which this is.
        name: Option<String>,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
        /// In the plane: torque against the relative angle \[rad\] → \[N m\].
        elastic: Option<Function>,
        /// In the plane: its slope, where it is a line through 0 \[N m/rad\].
        stiffness: Option<Quantity>,
        /// In the plane: the same while it falls \[rad\] → \[N m\].
        unloading: Option<Function>,
        /// In the plane: slope of the line between the two \[N m/rad\].
        unloading_slope: Option<Quantity>,
        /// In the plane: relative angle at which the curve has its zero \[rad\].
        neutral: Option<Quantity>,
        /// In the plane: viscous coefficient \[N m s/rad\].
        damping: Option<Quantity>,
        /// In the plane: Coulomb torque \[N m\].
        friction: Option<Quantity>,
        /// In the plane: speed at which friction is fully there \[rad/s\].
        friction_speed: Option<Quantity>,
        /// In the plane: angle at which friction that holds is fully there \[rad\].
        friction_displacement: Option<Quantity>,
        /// In the plane: where the rotation ends.
        stop: Option<Stop>,
        /// In the plane: what holds the relative angle once a switch acts.
        lock: Option<Lock>,
        /// In the plane: torque of a motor, a number or a curve of time \[N m\].
        motor: Option<Function>,
        /// In the plane: what drives the relative angle to one that is given.
        drive: Option<Drive>,
        /// In space: the laws about the three relative rotations.
        about: Option<About>,
        /// In space: the long axis of both elements, for flexion and torsion.
        axis: Option<LongAxis>,
        /// In space: the law of the angle between the long axes.
        flexion: Option<Flexion>,
        /// In space: the law of the turn about the long axes.
        torsion: Option<Torque>,
    }
}

words! {
    /// In which order the element turns about its axes: the first is an axis of the carrier, the third one of the element.
    Order {
        /// x, then y, then z: Bryant angles.
        Xyz = "xyz",
        /// x, then z, then y.
        Xzy = "xzy",
        /// y, then x, then z.
        Yxz = "yxz",
        /// y, then z, then x.
        Yzx = "yzx",
        /// z, then x, then y.
        Zxy = "zxy",
        /// z, then y, then x.
        Zyx = "zyx",
    }
}

record! {
    /// Laws per relative Bryant angle.
    About as "the rotations of a joint" {
        /// About the first relative angle.
        x: Option<Torque>,
        /// About the second.
        y: Option<Torque>,
        /// About the third.
        z: Option<Torque>,
        /// One law about the first and one about the second.
        xy: Option<Torque>,
        /// The same about the first and the third.
        xz: Option<Torque>,
        /// The same about the second and the third.
        yz: Option<Torque>,
        /// The same about all three.
        xyz: Option<Torque>,
        /// The order of the three turns; the middle one must stay below 90°.
        order: Option<Order>,
    }
}

record! {
    /// The law about one relative rotation.
    Torque as "a torque" {
        /// Torque against the relative angle \[rad\] → \[N m\].
        elastic: Option<Function>,
        /// Its slope, where it is a line through 0 \[N m/rad\].
        stiffness: Option<Quantity>,
        /// The same while it falls \[rad\] → \[N m\].
        unloading: Option<Function>,
        /// Slope of the line between the two \[N m/rad\].
        unloading_slope: Option<Quantity>,
        /// Relative angle at which the curve has its zero \[rad\].
        neutral: Option<Quantity>,
        /// Viscous coefficient \[N m s/rad\].
        damping: Option<Quantity>,
        /// Coulomb torque \[N m\].
        friction: Option<Quantity>,
        /// Speed at which friction is fully there \[rad/s\].
        friction_speed: Option<Quantity>,
        /// Angle at which friction that holds is fully there \[rad\].
        friction_displacement: Option<Quantity>,
        /// Where the rotation ends.
        stop: Option<Stop>,
        /// What holds the relative angle once a switch acts.
        lock: Option<Lock>,
        /// Torque of a motor, a number or a curve of time \[N m\].
        motor: Option<Function>,
        /// What drives the relative angle to one that is given.
        drive: Option<Drive>,
    }
}

record! {
    /// The law of the angle between two long axes.
    Flexion as "a flexion" {
        /// Torque against the angle \[rad\] → \[N m\].
        elastic: Option<Function>,
        /// Its slope, where it is a line through 0 \[N m/rad\].
        stiffness: Option<Quantity>,
        /// The same while it falls \[rad\] → \[N m\].
        unloading: Option<Function>,
        /// Slope of the line between the two \[N m/rad\].
        unloading_slope: Option<Quantity>,
        /// Viscous coefficient \[N m s/rad\].
        damping: Option<Quantity>,
        /// Coulomb torque \[N m\].
        friction: Option<Quantity>,
        /// Speed at which friction is fully there \[rad/s\].
        friction_speed: Option<Quantity>,
        /// Where the bending ends.
        stop: Option<Stop>,
    }
}

record! {
    /// The ends of a rotation.
    Stop as "a stop" {
        /// Smallest relative angle that is free \[rad\].
        from: Option<Quantity>,
        /// Largest \[rad\].
        to: Option<Quantity>,
        /// Torque per angle beyond \[N m/rad\].
        stiffness: Quantity,
        /// Viscous coefficient beyond \[N m s/rad\].
        damping: Option<Quantity>,
        /// Angle beyond at which damping is fully there \[rad\].
        damping_angle: Option<Quantity>,
    }
}

record! {
    /// What holds a relative angle from a switch on.
    Lock as "a lock" {
        /// The switch.
        by: String,
        /// Torque per angle from that of the switch \[N m/rad\].
        stiffness: Quantity,
        /// Viscous coefficient \[N m s/rad\].
        damping: Option<Quantity>,
    }
}

record! {
    /// What drives a coordinate to one that is given, by a spring and a damper.
    Drive as "a drive" {
        /// The coordinate to drive to, a number or a curve of time \[rad\].
        to: Function,
        /// Torque per angle from there \[N m/rad\].
        stiffness: Quantity,
        /// Torque per difference of the rates \[N m s/rad\].
        damping: Option<Quantity>,
        /// Largest torque \[N m\].
        limit: Option<Quantity>,
    }
}

impl Joint {
    /// By which outputs and messages call it: the element, and behind it the name where there is one.
    pub fn path(&self) -> String {
        match &self.name {
            Some(name) => format!("{}/{name}", *self.joint),
            None => self.joint.0.clone(),
        }
    }
}

impl Keys for Joint {
    const KEY: &'static str = "joint";
    const TWICE: Option<&'static str> =
        Some("give one of them a name: `name: broken`; it then is `joint SYSTEM/ELEMENT/broken`");

    fn header(&self) -> Header<'_> {
        Header {
            name: self.path(),
            called: self.name.as_deref().map(|name| ("name", name)),
            enabled: self.enabled,
            since: self.since.as_deref(),
            until: self.until.as_deref(),
        }
    }

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::joint(resolver, self, at)
    }

    fn records() -> Vec<(&'static str, &'static [Key])> {
        vec![
            record::<Joint>(),
            record::<About>(),
            record::<Torque>(),
            record::<Flexion>(),
            record::<Stop>(),
            record::<Lock>(),
            record::<Drive>(),
        ]
    }

    fn image(expander: &mut Expander<'_>, joint: &Node, image: &mut Node) -> Option<()> {
        expander.mirrored_joint_force(joint, image)
    }
}
