//! Joint forces: laws of relative rotations and of freedoms; in space also of flexion and torsion.

pub use super::keys::{Drive, JointTorque, Lock, Stop};
use super::keys::{Flexion, Joint as Written, Order as WrittenOrder};
use crate::description::place::At;
use crate::description::short_forms::LongAxis;
use crate::diagnostic::quoted;
use crate::model::declared::{Declared, Written as Keys};
use crate::model::law;
use crate::model::part::AXES;
use crate::model::resolve::Resolver;
use crate::model::resolve::joint::freedom_named;
use crate::model::{ElementId, Freedom as KinematicFreedom, Joint as KinematicJoint};
use serde::Serialize;

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
    about[1] = torque(resolver, &written.torque, at, false);
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
                *law = torque(resolver, written, at, false);
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
    let slides = !freedoms[freedom].kind.turns();
    let law = torque(resolver, &written.torque, at, slides);
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
            Some(torsion) => torque(resolver, torsion, at.key("torsion"), false),
            None => JointTorque::default(),
        },
    };
    let none = JointTorque::default();
    (bending.flexion != none || bending.torsion != none).then_some(bending)
}

/// The law of the angle between the long axes. Where it is 0 the plane of bending is not determined, and so there
/// must be no elastic torque.
fn flexion(resolver: &mut Resolver<'_>, written: &Flexion, at: At<'_>) -> JointTorque {
    let torque = torque(resolver, &written.0, at, false);
    let curve = torque.elastic.as_ref().and_then(|e| resolver.curve_of(e));
    if curve.is_some_and(|(curve, _)| !curve.points.contains(&[0.0, 0.0])) {
        resolver.problems.add(at.key("elastic").problem(
            "where the long axes are parallel a torque of flexion has no direction, and so must be 0",
            "let the curve pass through the point [0, 0]",
        ));
    }
    if at
        .node
        .get("stop")
        .is_some_and(|stop| stop.get("from").is_some())
    {
        resolver
            .problems
            .add(at.key("stop").key("from").key_problem(
                "the angle of flexion is never negative, and at 0 there is nothing to stop",
                "remove `from`; `to` is where the bending ends",
            ));
    }
    torque
}

/// The law of one coordinate, which slides or turns.
fn torque(
    resolver: &mut Resolver<'_>,
    written: &Keys<JointTorque>,
    at: At<'_>,
    slides: bool,
) -> JointTorque {
    let mut reader = written.reader(resolver, at);
    reader.slides = slides;
    JointTorque::read(&mut reader).unwrap_or_default()
}
