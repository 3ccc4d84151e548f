//! The keys of a joint force: laws about rotations, of flexion and torsion, of the coordinates of freedoms.

use crate::description::curve::FunctionOf;
use crate::description::expand::{Expander, Node};
use crate::description::force::Acting;
use crate::description::measure::{
    self, Angle, AngularDamping, AngularStiffness, Either, Force, Length, LinearDamping,
    NotNegative, Positive, Rate, Speed,
};
use crate::description::place::At;
use crate::description::quantity::Number;
use crate::description::schema::Schema;
use crate::description::shape::{
    Flat, Key, Misfit, Problems, Record, Shape, check_record, record, words,
};
use crate::description::short_forms::{Each, LongAxis};
use crate::model;
use crate::model::declared::{
    Coefficient, CoulombFriction, Declaration, Declared, Elastic, Fade, FrictionBristle, Given,
    HysteresisOf, Reader, Required, RequiredOverTime, SwitchName, TermOverTime, Written, declare,
};
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
        torque: Flat<Written<JointTorque>>,
        /// in space, instead of the keys above: a law for each [rotation](#the-rotations-of-a-joint)
        about: Option<About>,
        /// in space: the long axis of both elements, `x`, `y` or `z`, for the two keys below
        axis: Option<LongAxis> = "`z`",
        /// in space: a [law](#a-flexion) of the angle between the long axes
        flexion: Option<Flexion>,
        /// in space: a [law](#a-torque) of the turn about the long axes
        torsion: Option<Written<JointTorque>>,
    }
}

words! {
    /// In which order the element turns about its axes: the first is an axis of the carrier, the third one of the
    /// element.
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
        x: Option<Written<JointTorque>>,
        /// law about the second
        y: Option<Written<JointTorque>>,
        /// law about the third
        z: Option<Written<JointTorque>>,
        /// one law about the first and the same about the second
        xy: Option<Written<JointTorque>>,
        /// the same about the first and the third
        xz: Option<Written<JointTorque>>,
        /// the same about the second and the third
        yz: Option<Written<JointTorque>>,
        /// the same about all three
        xyz: Option<Written<JointTorque>>,
        /// the order of the turns that the angles are of: `xyz`, `xzy`, `yxz`, `yzx`, `zxy` or `zyx`
        order: Option<Order> = "`xyz`",
    }
}

/// A coordinate of a joint: a length of one that slides, else an angle.
type Coordinate = Either<Length, Angle>;

/// Its rate.
type CoordinateRate = Either<Speed, Rate>;

/// What acts along or about it.
type Effort = Either<Force, measure::Torque>;

/// Effort per coordinate.
type Stiffness = Either<measure::Stiffness, AngularStiffness>;

/// Effort per rate.
type Damping = NotNegative<Either<LinearDamping, AngularDamping>>;

declare! {
    /// The law about one relative rotation θ, or of one freedom: −f(θ − θ₀) is the elastic torque on the element.
    #[derive(Default)]
    JointTorque as "a torque" {
        /// curve of the relative angle; the torque resists with its negative
        elastic: Elastic<Coordinate, Effort, Stiffness> {
            /// instead of `elastic`: torque per angle, [a straight curve](#a-stiffness)
            stiffness: Option<Number<NotNegative<Stiffness>>>,
        },
        /// relative angle at which the abscissa of the curve is 0
        neutral: Coefficient<Coordinate> as "neutral angle" needs "there is no elastic torque" = "0",
        /// the unloading law of the elastic curve, on both sides of its zero
        hysteresis: HysteresisOf<Coordinate, Effort, Stiffness> {
            /// curve of the torque during unloading, between 0 and `elastic`; see [hysteresis of
            /// joints](#hysteresis-of-joints)
            unloading: Option<FunctionOf<Coordinate, Effort>>,
            /// slope of the line between the two curves
            unloading_slope: Option<Number<NotNegative<Stiffness>>> = "ten times the steepest slope of `elastic`",
        } as "hysteresis" needs "there is no elastic torque",
        /// viscous coefficient
        damping: Coefficient<Damping> = "0",
        /// Coulomb torque
        friction: CoulombFriction<Effort, CoordinateRate> {
            /// friction grows in proportion to speed up to this one, and is constant beyond
            friction_speed: Option<Number<Positive<CoordinateRate>>> = "0.1",
        } = "0",
        /// the bristle by which friction holds; without one, friction is a function of speed
        bristle: FrictionBristle<Coordinate> {
            /// with it friction [holds](#friction-that-holds-a-joint): the angle at which it acts in full
            friction_displacement: Option<Number<NotNegative<Coordinate>>>,
        } as "friction holds" needs "there is no friction",
        /// [where the rotation ends](#a-stop)
        stop: Option<Stop>,
        /// [a lock](#a-lock), which holds the angle from a switch on
        lock: Option<Lock>,
        /// torque of a motor, a number or a curve of time (s → N·m); a positive one drives the angle up
        motor: TermOverTime<Effort> = "0",
        /// [a drive](#a-drive) towards a given angle
        drive: Option<Drive>,
    }
}

impl Declared for JointTorque {
    fn check_keys(reader: &Reader<'_, '_, '_>) {
        reader.check_needs(
            "neutral",
            &["elastic", "stiffness"],
            "a neutral angle means nothing without an elastic curve",
            "add `elastic: …` or `stiffness: …`, or remove `neutral`",
        );
    }

    fn finish(mut self, _: &mut Reader<'_, '_, '_>) -> Option<Self> {
        self.settle();
        Some(self)
    }
}

impl JointTorque {
    /// Removes terms that have no effect without another term that is absent.
    pub(super) fn settle(&mut self) {
        if self.elastic.is_none() {
            self.neutral = None;
            self.hysteresis = None;
        }
        if self.friction.is_none() {
            self.bristle = None;
        }
    }
}

/// The law of the angle between two long axes: a torque with fewer keys.
#[derive(Clone, Debug)]
pub struct Flexion(pub Written<JointTorque>);

/// The keys of a flexion.
const OF_FLEXION: [&str; 8] = [
    "elastic",
    "stiffness",
    "unloading",
    "unloading_slope",
    "damping",
    "friction",
    "friction_speed",
    "stop",
];

impl Record for Flexion {
    const TITLE: &'static str = "a flexion";

    fn keys() -> Vec<Key> {
        let keys = JointTorque::keys().into_iter();
        let mut keys: Vec<Key> = keys.filter(|key| OF_FLEXION.contains(&key.name)).collect();
        for key in &mut keys {
            match key.name {
                "elastic" => {
                    key.meaning = "curve of the angle, through `[0, 0]`; the torque resists with its negative";
                }
                "stop" => key.meaning = "[where the bending ends](#a-stop); only with `to`",
                _ => {}
            }
        }
        keys
    }

    fn among(value: &Value) -> Result<Self, Misfit> {
        Written::among(value).map(Flexion)
    }
}

impl Shape for Flexion {
    fn schema(to: &mut Schema) -> Value {
        to.record::<Flexion>()
    }

    fn check(at: At<'_>, problems: &Problems) {
        check_record::<Flexion>(at, problems);
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        Self::among(value)
    }
}

declare! {
    /// The ends of a rotation. At a depth δ > 0 beyond an end, N(δ) = max(0, stiffness δ + damping min(δ/fade, 1) δ̇)
    /// pushes back.
    Stop as "a stop" {
        /// smallest angle without a stop torque
        from: Given<Coordinate>,
        /// largest angle without a stop torque
        to: Given<Coordinate>,
        /// torque per angle beyond
        stiffness: Required<NotNegative<Stiffness>>,
        /// viscous coefficient on the rate, beyond
        damping: Coefficient<Damping> = "0",
        /// damping grows in proportion to the angle beyond up to this one, so that no torque jumps; 0: it acts in full
        /// at once
        damping_angle: Fade<Coordinate> = "1°",
    }
}

impl Declared for Stop {
    fn check_keys(reader: &Reader<'_, '_, '_>) {
        if !reader.has("from") && !reader.has("to") {
            reader.resolver.problems.add(reader.at.problem(
                "the stop does not say where the rotation ends",
                "add `from: …`, `to: …`, or both",
            ));
        }
    }

    fn finish(mut self, _: &mut Reader<'_, '_, '_>) -> Option<Self> {
        if self.damping.is_none() {
            self.damping_angle = None;
        }
        acts(&self.stiffness, &self.damping).then_some(self)
    }
}

/// True if a spring or a damper acts.
fn acts(stiffness: &model::Number, damping: &Option<model::Number>) -> bool {
    !stiffness.is_zero() || damping.is_some()
}

declare! {
    /// What holds a relative angle, at its value at the moment when a switch began to act.
    Lock as "a lock" {
        /// the [switch](#a-switch)
        by: SwitchName,
        /// torque per angle from there
        stiffness: Required<NotNegative<Stiffness>>,
        /// viscous coefficient on the rate
        damping: Coefficient<Damping> = "0",
    }
}

impl Declared for Lock {
    fn finish(self, _: &mut Reader<'_, '_, '_>) -> Option<Self> {
        acts(&self.stiffness, &self.damping).then_some(self)
    }
}

declare! {
    /// What drives a coordinate θ to a given one c: N = stiffness (c(t) − θ) + damping (ċ(t) − θ̇), limited to ±
    /// `limit`.
    Drive as "a drive" {
        /// the coordinate to drive to: a number, or a curve of time (s → rad), whose slope is c'
        to: RequiredOverTime<Coordinate>,
        /// torque per difference of the angles
        stiffness: Required<NotNegative<Stiffness>>,
        /// torque per difference of the rates
        damping: Coefficient<Damping> = "0",
        /// largest torque
        limit: Given<Positive<Effort>>,
    }
}

impl Declared for Drive {
    fn finish(self, _: &mut Reader<'_, '_, '_>) -> Option<Self> {
        acts(&self.stiffness, &self.damping).then_some(self)
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
    const SAME_NAME_ADVICE: Option<&'static str> =
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
            record::<Written<JointTorque>>(),
            record::<Flexion>(),
            record::<Written<Stop>>(),
            record::<Written<Lock>>(),
            record::<Written<Drive>>(),
        ]
    }

    fn image(expander: &mut Expander<'_>, joint: &Node, image: &mut Node) -> Option<()> {
        expander.mirrored_joint_force(joint, image)
    }
}
