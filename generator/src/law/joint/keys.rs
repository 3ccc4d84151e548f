//! The keys of a joint force: laws about rotations, of flexion and torsion, of the coordinates of freedoms.

use crate::description::curve::{FunctionOf, OverTime};
use crate::description::expand::{Expander, Node};
use crate::description::force::Acting;
use crate::description::measure::{self, Angle, AngularDamping, AngularStiffness, Rate};
use crate::description::place::At;
use crate::description::quantity::Number;
use crate::description::shape::{Flat, Key, record, words};
use crate::description::short::Each;
use crate::description::short::LongAxis;
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Header, Keys, record};
use serde_yaml::Value;

record! {
    /// Torque in a joint.
    Joint as "a joint force" {
        /// the element that the joint carries, as `system/element`; or a list: the same force in several joints
        joint: Each<String>,
        /// required if the joint has several freedoms: the name of the freedom that the force acts on
        freedom: Option<String>,
        /// tells [several forces in one joint](#several-forces-in-one-joint) apart
        name: Option<String>,
        /// when it acts
        acting: Flat<Acting>,
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
        /// in the plane, and for a freedom: the law of the one coordinate
        torque: Flat<Torque>,
        /// in space, instead of the keys above: a law for each [rotation](#the-rotations-of-a-joint)
        about: Option<About>,
        /// in space: the long axis of both elements, `x`, `y` or `z`, for the two keys below
        axis: Option<LongAxis> = "`z`",
        /// in space: a [law](#a-flexion) of the angle between the long axes
        flexion: Option<Flexion>,
        /// in space: a [law](#a-torque) of the turn about the long axes
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
        /// [law](#a-torque) about the first relative angle
        x: Option<Torque>,
        /// law about the second
        y: Option<Torque>,
        /// law about the third
        z: Option<Torque>,
        /// one law about the first and the same about the second
        xy: Option<Torque>,
        /// the same about the first and the third
        xz: Option<Torque>,
        /// the same about the second and the third
        yz: Option<Torque>,
        /// the same about all three
        xyz: Option<Torque>,
        /// the order of the turns that the angles are of: `xyz`, `xzy`, `yxz`, `yzx`, `zxy` or `zyx`
        order: Option<Order> = "`xyz`",
    }
}

record! {
    /// The law about one relative rotation.
    Torque as "a torque" {
        /// curve of the relative angle; the torque resists with its negative
        elastic: Option<FunctionOf<Angle, measure::Torque>>,
        /// instead of `elastic`: torque per angle, [a straight curve](#a-stiffness)
        stiffness: Option<Number<AngularStiffness>>,
        /// curve of the torque during unloading, between 0 and `elastic`; see [hysteresis of
        /// joints](#hysteresis-of-joints)
        unloading: Option<FunctionOf<Angle, measure::Torque>>,
        /// slope of the line between the two curves
        unloading_slope: Option<Number<AngularStiffness>> = "ten times the steepest slope of `elastic`",
        /// relative angle at which the abscissa of the curve is 0
        neutral: Option<Number<Angle>> = "0",
        /// viscous coefficient
        damping: Option<Number<AngularDamping>> = "0",
        /// Coulomb torque
        friction: Option<Number<measure::Torque>> = "0",
        /// friction grows in proportion to speed up to this one, and is constant beyond
        friction_speed: Option<Number<Rate>> = "0.1",
        /// with it friction [holds](#friction-that-holds-a-joint): the angle at which it acts in full
        friction_displacement: Option<Number<Angle>>,
        /// [where the rotation ends](#a-stop)
        stop: Option<Stop>,
        /// [a lock](#a-lock), which holds the angle from a switch on
        lock: Option<Lock>,
        /// torque of a motor, a number or a curve of time (s → N·m); a positive one drives the angle up
        motor: Option<OverTime<measure::Torque>> = "0",
        /// [a drive](#a-drive) towards a given angle
        drive: Option<Drive>,
    }
}

record! {
    /// The law of the angle between two long axes.
    Flexion as "a flexion" {
        /// curve of the angle, through `[0, 0]`; the torque resists with its negative
        elastic: Option<FunctionOf<Angle, measure::Torque>>,
        /// instead of `elastic`: torque per angle, [a straight curve](#a-stiffness)
        stiffness: Option<Number<AngularStiffness>>,
        /// curve of the torque during unloading, between 0 and `elastic`; see [hysteresis of
        /// joints](#hysteresis-of-joints)
        unloading: Option<FunctionOf<Angle, measure::Torque>>,
        /// slope of the line between the two curves
        unloading_slope: Option<Number<AngularStiffness>> = "ten times the steepest slope of `elastic`",
        /// viscous coefficient
        damping: Option<Number<AngularDamping>> = "0",
        /// Coulomb torque
        friction: Option<Number<measure::Torque>> = "0",
        /// friction grows in proportion to speed up to this one, and is constant beyond
        friction_speed: Option<Number<Rate>> = "0.1",
        /// [where the bending ends](#a-stop); only with `to`
        stop: Option<Stop>,
    }
}

record! {
    /// The ends of a rotation.
    Stop as "a stop" {
        /// smallest angle without a stop torque
        from: Option<Number<Angle>>,
        /// largest angle without a stop torque
        to: Option<Number<Angle>>,
        /// torque per angle beyond
        stiffness: Number<AngularStiffness>,
        /// viscous coefficient on the rate, beyond
        damping: Option<Number<AngularDamping>> = "0",
        /// damping grows in proportion to the angle beyond up to this one, so that no torque jumps; 0: it acts in full
        /// at once
        damping_angle: Option<Number<Angle>> = "1°",
    }
}

record! {
    /// What holds a relative angle from a switch on.
    Lock as "a lock" {
        /// the [switch](#a-switch)
        by: String,
        /// torque per angle from there
        stiffness: Number<AngularStiffness>,
        /// viscous coefficient on the rate
        damping: Option<Number<AngularDamping>> = "0",
    }
}

record! {
    /// What drives a coordinate to one that is given, by a spring and a damper.
    Drive as "a drive" {
        /// the coordinate to drive to: a number, or a curve of time (s → rad), whose slope is c'
        to: OverTime<Angle>,
        /// torque per difference of the angles
        stiffness: Number<AngularStiffness>,
        /// torque per difference of the rates
        damping: Option<Number<AngularDamping>> = "0",
        /// largest torque
        limit: Option<Number<measure::Torque>>,
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

    fn header<'v>(&'v self, value: &'v Value) -> Header<'v> {
        let name = self.name.as_deref();
        Header {
            name: self.path(),
            called: name.map(|name| ("name", name)),
            ..Header::read(value, Self::KEY)
        }
    }

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::joint(resolver, self, at)
    }

    fn records() -> Vec<(&'static str, Vec<Key>)> {
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
