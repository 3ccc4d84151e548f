//! Joint forces: laws of relative rotations and of freedoms; in space also of flexion and torsion.

use super::keys::{
    Drive as WrittenDrive, Flexion, Joint as Written, Lock as WrittenLock, Order as WrittenOrder,
    Stop as WrittenStop, Torque,
};
use crate::description::measure::{
    ANGLE, ANGULAR_DAMPING, ANGULAR_STIFFNESS, Expected, FORCE, LENGTH, LINEAR_DAMPING, RATE,
    SPEED, STIFFNESS, TORQUE,
};
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::description::short::LongAxis;
use crate::diagnostic::quoted;
use crate::model::law;
use crate::model::part::{AXES, Part};
use crate::model::resolve::Resolver;
use crate::model::resolve::hysteresis::Unloading;
use crate::model::resolve::joint::freedom_named;
use crate::model::{Bristle, ElementId, FieldComponent, Friction, Hysteresis, Number, ScaledCurve};
use crate::model::{Freedom as KinematicFreedom, Joint as KinematicJoint};
use serde::Serialize;

/// Speed from which on joint friction has its full size, if the user gives none \[rad/s\].
const FRICTION_SPEED: f64 = 0.1;

/// Speed from which on the friction of a slider has its full size, if the user gives none \[m/s\].
const SLIDING_SPEED: f64 = 0.01;

/// Depth behind a stop from which on its damping has its full size, if the user gives none \[m\].
const DAMPING_LENGTH: f64 = 1e-3;

/// Angle behind a stop from which on its damping has its full size, if the user gives none: 1° \[rad\].
const DAMPING_ANGLE: f64 = std::f64::consts::PI / 180.0;

/// The physical quantities of the numbers of a law, and its default values.
#[derive(Clone, Copy)]
struct Measures {
    coordinate: Expected,
    rate: Expected,
    force: Expected,
    stiffness: Expected,
    damping: Expected,
    /// Speed from which on friction has its full size, if the user gives none.
    friction_speed: f64,
    /// Depth behind a stop from which on damping has its full size, if the user gives none.
    damping_depth: f64,
}

/// For a law of an angle.
const OF_ANGLE: Measures = Measures {
    coordinate: ANGLE,
    rate: RATE,
    force: TORQUE,
    stiffness: ANGULAR_STIFFNESS,
    damping: ANGULAR_DAMPING,
    friction_speed: FRICTION_SPEED,
    damping_depth: DAMPING_ANGLE,
};

/// For a law of a length.
const OF_LENGTH: Measures = Measures {
    coordinate: LENGTH,
    rate: SPEED,
    force: FORCE,
    stiffness: STIFFNESS,
    damping: LINEAR_DAMPING,
    friction_speed: SLIDING_SPEED,
    damping_depth: DAMPING_LENGTH,
};

/// Keys that are refused for a ball joint in space, as they do not say which rotation they belong to.
const OF_ONE_ROTATION: [&str; 13] = [
    "elastic",
    "stiffness",
    "unloading",
    "unloading_slope",
    "neutral",
    "damping",
    "friction",
    "friction_speed",
    "friction_displacement",
    "stop",
    "lock",
    "motor",
    "drive",
];

/// Torques in the joint that carries `child`, between `child` and its parent (or the absolute frame, for a root).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Joint {
    /// The element outboard of the joint.
    pub child: ElementId,
    /// Laws about the axes x, y, z of the relative rotation A_parentᵀ A_child. In the plane only the second is used;
    /// its angle is φ_child − φ_parent.
    pub about: [JointTorque; 3],
    /// The order of the three turns that these angles describe, in space.
    pub order: Order,
    /// Flexion and torsion, in space.
    pub bending: Option<Box<Bending>>,
}

/// The axes of three successive turns that make up a relative rotation: the first is an axis of the parent, the third
/// an axis of the element. 0 is x, 1 is y, 2 is z; each occurs once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Order(pub [usize; 3]);

/// x, y, z: the order of Bryant angles.
impl Default for Order {
    fn default() -> Self {
        Order([0, 1, 2])
    }
}

impl Order {
    /// 1 if the axes in this order are a right-handed system, otherwise −1.
    pub fn hand(self) -> f64 {
        match (self.0[1] + 3 - self.0[0]) % 3 {
            1 => 1.0,
            _ => -1.0,
        }
    }

    /// The name of the middle axis.
    pub fn middle(self) -> &'static str {
        AXES[self.0[1]]
    }
}

/// Torque or force on the coordinate of one freedom of the joint that carries `child`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Freedom {
    /// The element outboard of the joint.
    pub child: ElementId,
    /// Index of the freedom among those of the joint.
    pub freedom: usize,
    /// The law of the coordinate. For a sliding freedom its units are \[m\] and \[N\].
    pub law: Box<JointTorque>,
}

/// Torque about one relative rotation.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct JointTorque {
    /// Elastic torque as a function of the relative angle less `neutral`; the torque on the child is −curve. \[rad\] →
    /// \[N m\].
    pub elastic: Option<ScaledCurve>,
    /// Relative angle at which the abscissa of the elastic curve is zero \[rad\]; `None` for 0.
    pub neutral: Option<Number>,
    /// The unloading law of the elastic curve, on both sides of its zero.
    pub hysteresis: Option<Hysteresis>,
    /// Viscous coefficient \[N m s/rad\]; `None` for 0.
    pub damping: Option<Number>,
    /// Coulomb friction torque; `None` for 0.
    pub friction: Option<Friction>,
    /// The bristle by which friction holds; without one, friction is a function of speed.
    pub bristle: Option<Bristle>,
    /// The ends of the rotation.
    pub stop: Option<Stop>,
    /// A lock that holds the angle as soon as a switch acts.
    pub lock: Option<Lock>,
    /// Torque of a motor \[N m\]; `None` for 0.
    pub motor: Option<FieldComponent>,
    /// A drive that moves the angle to a given one.
    pub drive: Option<Drive>,
}

/// The ends of a relative rotation. At a depth δ > 0 beyond an end, N(δ) = max(0, stiffness δ + damping min(δ/fade, 1)
/// δ̇) pushes back.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stop {
    /// Lower end of the free angles \[rad\].
    pub from: Option<Number>,
    /// Upper end of the free angles \[rad\].
    pub to: Option<Number>,
    /// \[N m/rad\]
    pub stiffness: Number,
    /// \[N m s/rad\]; `None` for 0.
    pub damping: Option<Number>,
    /// Depth up to which damping grows from 0 to its full size \[rad\]; `None` for full damping at once.
    pub damping_angle: Option<Number>,
}

/// Holds the relative angle at its value at the moment when a switch began to act.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Lock {
    /// Index into [`Model::switches`](crate::model::Model::switches).
    pub by: usize,
    /// \[N m/rad\]
    pub stiffness: Number,
    /// \[N m s/rad\]; `None` for 0.
    pub damping: Option<Number>,
}

/// Drives a coordinate θ to a given one c: N = stiffness (c(t) − θ) + damping (ċ(t) − θ̇), limited to ± `limit`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Drive {
    /// c, a constant or a curve of time \[rad\].
    pub to: FieldComponent,
    /// \[N m/rad\]
    pub stiffness: Number,
    /// \[N m s/rad\]; `None` for 0.
    pub damping: Option<Number>,
    /// Largest torque \[N m\]; `None` if it is not limited.
    pub limit: Option<Number>,
}

impl Bending {
    /// True if a term has a direction that is undefined at a flexion of 180°.
    pub fn directs(&self) -> bool {
        let JointTorque { elastic, stop, .. } = &self.flexion;
        elastic.is_some() || stop.is_some() || self.torsion != JointTorque::default()
    }
}

/// Flexion and torsion of a ball joint, in space.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bending {
    /// Index of the local axis that is the long one, in both bodies.
    pub axis: usize,
    /// The law of the angle between the long axes. It has no neutral angle and no lock, and at most one end.
    pub flexion: JointTorque,
    /// The law of the twist about the long axes.
    pub torsion: JointTorque,
}

/// The checked form of a joint force: laws of relative rotations, or of one freedom.
pub(crate) fn joint(
    resolver: &mut Resolver<'_>,
    written: &Written,
    at: At<'_>,
) -> Option<Box<dyn law::Law>> {
    let child = resolver.element_id(&written.joint, at.key("joint"));
    if let Some(id) = child
        && let joint @ KinematicJoint::Freedoms(_) = joint_at(resolver, id)
    {
        let law = law_of_freedom(resolver, written, id, joint.freedoms(), at);
        return law.map(|law| Box::new(law) as Box<dyn law::Law>);
    }
    if written.freedom.is_some() && child.is_some() {
        resolver.problems.add(at.key("freedom").key_problem(
            format!(
                "{} is on a ball joint, which has no freedoms of its own",
                quoted(&written.joint)
            ),
            match resolver.planar {
                true => "remove the key",
                false => {
                    "write `about: { x: … }` with one of x, y, z, or give the element a `joint:`"
                }
            },
        ));
    }
    let (about, bending) = match resolver.planar {
        true => (in_plane(resolver, written, at), None),
        false => (
            about_axes(resolver, written, at),
            bending(resolver, written, at),
        ),
    };
    Some(Box::new(Joint {
        child: child?,
        about,
        order: order(written),
        bending: bending.map(Box::new),
    }))
}

/// In the plane: the law of the one rotation, which is about y.
fn in_plane(resolver: &mut Resolver<'_>, written: &Written, at: At<'_>) -> [JointTorque; 3] {
    for key in of_several_rotations(written) {
        resolver.problems.add(at.key(key).key_problem(
            "in the plane a joint has one rotation",
            format!("write `elastic`, `damping`, … directly, without `{key}`"),
        ));
    }
    let mut about: [JointTorque; 3] = Default::default();
    about[1] = torque(resolver, &written.torque, at, OF_ANGLE);
    about
}

/// In space: the laws about the Bryant angles.
fn about_axes(resolver: &mut Resolver<'_>, written: &Written, at: At<'_>) -> [JointTorque; 3] {
    for key in OF_ONE_ROTATION {
        if at.node.get(key).is_some() {
            resolver.problems.add(at.key(key).key_problem(
                format!("in space a joint has three rotations, and \"{key}\" does not say which"),
                format!("write `about: {{ y: {{ {key}: … }} }}` with one of x, y, z"),
            ));
        }
    }
    let mut about: [JointTorque; 3] = Default::default();
    if let Some(a) = &written.about {
        let axes = [(&a.x, "x"), (&a.y, "y"), (&a.z, "z")];
        for (law, (written, axis)) in about.iter_mut().zip(axes) {
            if let Some(written) = written {
                let at = at.key("about").key(axis);
                *law = torque(resolver, written, at, OF_ANGLE);
            }
        }
    }
    about
}

/// The order of the turns; x, y, z if none is written.
fn order(written: &Written) -> Order {
    let order = written.about.as_ref().and_then(|about| about.order);
    Order(match order {
        None | Some(WrittenOrder::Xyz) => [0, 1, 2],
        Some(WrittenOrder::Xzy) => [0, 2, 1],
        Some(WrittenOrder::Yxz) => [1, 0, 2],
        Some(WrittenOrder::Yzx) => [1, 2, 0],
        Some(WrittenOrder::Zxy) => [2, 0, 1],
        Some(WrittenOrder::Zyx) => [2, 1, 0],
    })
}

/// The written keys that only a ball joint in space may have.
fn of_several_rotations(written: &Written) -> impl Iterator<Item = &'static str> {
    [
        ("about", written.about.is_some()),
        ("axis", written.axis.is_some()),
        ("flexion", written.flexion.is_some()),
        ("torsion", written.torsion.is_some()),
    ]
    .into_iter()
    .filter_map(|(key, is_there)| is_there.then_some(key))
}

/// The joint that carries an element.
fn joint_at(resolver: &Resolver<'_>, id: ElementId) -> KinematicJoint {
    resolver.systems[id.system].elements[id.element]
        .joint
        .clone()
}

/// The law of one freedom of a joint.
fn law_of_freedom(
    resolver: &mut Resolver<'_>,
    written: &Written,
    child: ElementId,
    freedoms: &[KinematicFreedom],
    at: At<'_>,
) -> Option<Freedom> {
    for key in of_several_rotations(written) {
        resolver.problems.add(at.key(key).key_problem(
            format!(
                "the joint of {} is no ball: its laws are of its own coordinates",
                quoted(&written.joint)
            ),
            format!("write `elastic`, `damping`, … directly, without `{key}`"),
        ));
    }
    let name = written.freedom.as_deref();
    let freedom = freedom_named(resolver, name, &written.joint, freedoms, at)?;
    let measures = match freedoms[freedom].kind.turns() {
        true => OF_ANGLE,
        false => OF_LENGTH,
    };
    let law = torque(resolver, &written.torque, at, measures);
    Some(Freedom {
        child,
        freedom,
        law: Box::new(law),
    })
}

/// Flexion and torsion; `None` where neither has a law.
fn bending(resolver: &mut Resolver<'_>, written: &Written, at: At<'_>) -> Option<Bending> {
    if written.axis.is_some() && written.flexion.is_none() && written.torsion.is_none() {
        resolver.problems.add(at.key("axis").key_problem(
            "a long axis means nothing without flexion and torsion",
            "add `flexion: …` or `torsion: …`, or remove `axis`",
        ));
    }
    let bending = Bending {
        axis: match written.axis {
            Some(LongAxis::X) => 0,
            Some(LongAxis::Y) => 1,
            Some(LongAxis::Z) | None => 2,
        },
        flexion: match &written.flexion {
            Some(written) => flexion(resolver, written, at.key("flexion")),
            None => JointTorque::default(),
        },
        torsion: match &written.torsion {
            Some(torsion) => torque(resolver, torsion, at.key("torsion"), OF_ANGLE),
            None => JointTorque::default(),
        },
    };
    let none = JointTorque::default();
    (bending.flexion != none || bending.torsion != none).then_some(bending)
}

/// The law of the angle between the long axes. Where it is 0 the plane of bending is not determined, and so there
/// must be no elastic torque.
fn flexion(resolver: &mut Resolver<'_>, written: &Flexion, at: At<'_>) -> JointTorque {
    let law = Torque {
        elastic: written.elastic.clone(),
        stiffness: written.stiffness.clone(),
        unloading: written.unloading.clone(),
        unloading_slope: written.unloading_slope.clone(),
        neutral: None,
        damping: written.damping.clone(),
        friction: written.friction.clone(),
        friction_speed: written.friction_speed.clone(),
        friction_displacement: None,
        stop: written.stop.clone(),
        lock: None,
        motor: None,
        drive: None,
    };
    let torque = torque(resolver, &law, at, OF_ANGLE);
    let curve = torque.elastic.as_ref().and_then(|e| resolver.curve_of(e));
    if curve.is_some_and(|(curve, _)| !curve.points.contains(&[0.0, 0.0])) {
        resolver.problems.add(at.key("elastic").problem(
            "where the long axes are parallel a torque of flexion has no direction, and so must be 0",
            "let the curve pass through the point [0, 0]",
        ));
    }
    if let Some(stop) = &written.stop {
        let place = at.key("stop");
        if stop.from.is_some() {
            resolver.problems.add(place.key("from").key_problem(
                "the angle of flexion is never negative, and at 0 there is nothing to stop",
                "remove `from`; `to` is where the bending ends",
            ));
        }
    }
    torque
}

/// The law of one coordinate.
fn torque(resolver: &mut Resolver<'_>, law: &Torque, at: At<'_>, of: Measures) -> JointTorque {
    let elastic = resolver.elastic_in(
        ("elastic", law.elastic.as_deref()),
        law.stiffness.as_deref(),
        at,
        [of.coordinate, of.force, of.stiffness],
    );
    let neutral = law.neutral.as_deref();
    let neutral = neutral.map(|n| resolver.number_in(n, at.key("neutral"), of.coordinate));
    if law.neutral.is_some() && law.elastic.is_none() && law.stiffness.is_none() {
        resolver.problems.add(at.key("neutral").key_problem(
            "a neutral angle means nothing without an elastic curve",
            "add `elastic: …` or `stiffness: …`, or remove `neutral`",
        ));
    }
    let hysteresis = resolver.hysteresis(
        elastic.as_ref(),
        Unloading {
            curve: law.unloading.as_deref(),
            slope: law.unloading_slope.as_deref(),
            loading: ("elastic", law.elastic.is_some() || law.stiffness.is_some()),
            at,
            expected: [of.coordinate, of.force, of.stiffness],
        },
    );
    let friction = resolver.friction(
        law.friction.as_deref(),
        law.friction_speed.as_deref(),
        at,
        (of.force, of.rate, of.friction_speed),
    );
    let bristle = resolver.bristle(
        (law.friction.as_deref(), friction.is_some()),
        law.friction_displacement.as_deref(),
        at,
        of.coordinate,
    );
    let motor = law.motor.as_deref();
    let motor = motor.map(|motor| resolver.component_in(motor, at.key("motor"), of.force));
    let drive = law.drive.as_ref();
    let drive = drive.and_then(|d| self::drive(resolver, d, at.key("drive"), of));
    JointTorque {
        neutral: neutral.filter(|n| !n.is_zero() && elastic.is_some()),
        elastic,
        hysteresis,
        damping: resolver.coefficient_in(law.damping.as_deref(), at.key("damping"), of.damping),
        friction,
        bristle,
        stop: law
            .stop
            .as_ref()
            .and_then(|s| stop(resolver, s, at.key("stop"), of)),
        lock: law
            .lock
            .as_ref()
            .and_then(|l| lock(resolver, l, at.key("lock"), of)),
        motor: motor.filter(Part::is_in),
        drive,
    }
}

/// The checked form of a drive; `None` if it has no effect.
fn drive(
    resolver: &mut Resolver<'_>,
    written: &WrittenDrive,
    at: At<'_>,
    of: Measures,
) -> Option<Drive> {
    let to: FieldComponent = resolver.component_in(&written.to, at.key("to"), of.coordinate);
    let place = at.key("stiffness");
    let stiffness = resolver.coefficient_in(Some(&written.stiffness), place, of.stiffness);
    let damping =
        resolver.coefficient_in(written.damping.as_deref(), at.key("damping"), of.damping);
    let place = at.key("limit");
    let limit = written.limit.as_deref();
    let limit = limit.map(|limit| resolver.number_in(limit, place, of.force));
    (stiffness.is_some() || damping.is_some()).then_some(Drive {
        to,
        stiffness: stiffness.unwrap_or(Number::ZERO),
        damping,
        limit,
    })
}

/// The checked form of the ends of a rotation; `None` if they have no effect.
fn stop(resolver: &Resolver<'_>, written: &WrittenStop, at: At<'_>, of: Measures) -> Option<Stop> {
    let bound = |quantity: Option<&Quantity>, key| {
        Some(resolver.number_in(quantity?, at.key(key), of.coordinate))
    };
    let from = bound(written.from.as_deref(), "from");
    let to = bound(written.to.as_deref(), "to");
    if from.is_none() && to.is_none() {
        resolver.problems.add(at.problem(
            "the stop does not say where the rotation ends",
            "add `from: …`, `to: …`, or both",
        ));
    }
    let place = at.key("stiffness");
    let stiffness = resolver.coefficient_in(Some(&written.stiffness), place, of.stiffness);
    let damping =
        resolver.coefficient_in(written.damping.as_deref(), at.key("damping"), of.damping);
    let damping_angle = resolver.fade(
        (written.damping.as_deref(), damping.is_some()),
        (written.damping_angle.as_deref(), at.key("damping_angle")),
        (of.coordinate, of.damping_depth),
    );
    (stiffness.is_some() || damping.is_some()).then_some(Stop {
        from,
        to,
        stiffness: stiffness.unwrap_or(Number::ZERO),
        damping,
        damping_angle,
    })
}

/// The checked form of a lock; `None` if it has no effect.
fn lock(resolver: &Resolver<'_>, written: &WrittenLock, at: At<'_>, of: Measures) -> Option<Lock> {
    let by = resolver.switch_id(&written.by, at.key("by"));
    let place = at.key("stiffness");
    let stiffness = resolver.coefficient_in(Some(&written.stiffness), place, of.stiffness);
    let damping =
        resolver.coefficient_in(written.damping.as_deref(), at.key("damping"), of.damping);
    (stiffness.is_some() || damping.is_some()).then_some(Lock {
        by: by?,
        stiffness: stiffness.unwrap_or(Number::ZERO),
        damping,
    })
}
