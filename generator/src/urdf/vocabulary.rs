//! What a URDF file may say: every element and attribute, how often, and what becomes of it.
//!
//! The names are those of the readers of ROS (urdfdom), with the extensions of Gazebo, Drake and others that public
//! files have. What stands in no table here is listed as unknown; what is misspelt is refused.

/// What becomes of a part of a file.
#[derive(Clone, Copy)]
pub enum Fate {
    /// It is taken over, or checked.
    Read,
    /// It has no influence on the motion: it is listed under this name.
    Idle(&'static str),
    /// The motion depends on it, and the model does not have it: it is listed under this name.
    Missing(&'static str),
    /// Some of it may be taken over; the code that does so lists it where nothing is.
    Partly,
    /// It is refused: what it is, and what to do.
    Refused(&'static str, &'static str),
}

/// An element.
pub struct Element {
    pub tag: &'static str,
    /// Whether its parent has it once at most.
    pub once: bool,
    pub fate: Fate,
    pub attributes: &'static [(&'static str, Fate)],
    /// What may stand in it. In an element that is read, everything else is unknown; in others it is listed with the
    /// element.
    pub children: &'static [Element],
}

use Fate::{Idle, Missing, Partly, Read, Refused};

const NOTHING: &[(&str, Fate)] = &[];

/// An element that is read, once at most.
const fn once(
    tag: &'static str,
    attributes: &'static [(&'static str, Fate)],
    children: &'static [Element],
) -> Element {
    Element {
        tag,
        once: true,
        fate: Read,
        attributes,
        children,
    }
}

/// An element that is not read, with its attributes.
const fn other(tag: &'static str, fate: Fate, children: &'static [Element]) -> Element {
    Element {
        tag,
        once: false,
        fate,
        attributes: NOTHING,
        children,
    }
}

const ORIGIN: Element = once(
    "origin",
    &[("xyz", Read), ("rpy", Read), ("quat_xyzw", Read)],
    &[],
);

const INERTIA: &[(&str, Fate)] = &[
    ("ixx", Read),
    ("ixy", Read),
    ("ixz", Read),
    ("iyy", Read),
    ("iyz", Read),
    ("izz", Read),
    // The lower triangle, which some exporters write, too.
    ("iyx", Read),
    ("izx", Read),
    ("izy", Read),
];

const LINK: Element = Element {
    tag: "link",
    once: false,
    fate: Read,
    attributes: &[("name", Read), ("type", Idle("types of links"))],
    children: &[
        once(
            "inertial",
            NOTHING,
            &[
                ORIGIN,
                once("mass", &[("value", Read)], &[]),
                once("inertia", INERTIA, &[]),
            ],
        ),
        other("visual", Partly, &[]),
        other("collision", Idle("collision shapes"), &[]),
        other("self_collision_checking", Idle("collision shapes"), &[]),
        other("contact", Idle("contacts of links"), &[]),
        other("contact_coefficients", Idle("contacts of links"), &[]),
        other("gravity", Missing("gravity of single links"), &[]),
    ],
};

/// Springs that some files have and URDF does not.
const SPRINGS: &str = "springs of joints";

const DYNAMICS: Element = once(
    "dynamics",
    &[
        ("damping", Read),
        ("friction", Read),
        ("spring_stiffness", Missing(SPRINGS)),
        ("spring_reference", Missing(SPRINGS)),
        ("stiffness", Missing(SPRINGS)),
        ("armature", Missing("rotors of joints")),
    ],
    &[],
);

const JOINT: Element = Element {
    tag: "joint",
    once: false,
    fate: Read,
    attributes: &[("name", Read), ("type", Read)],
    children: &[
        ORIGIN,
        once("parent", &[("link", Read)], &[]),
        once("child", &[("link", Read)], &[]),
        once("axis", &[("xyz", Read)], &[]),
        once(
            "limit",
            &[
                ("lower", Read),
                ("upper", Read),
                ("effort", Read),
                ("velocity", Read),
                ("acceleration", Idle("limits of acceleration")),
                ("deceleration", Idle("limits of acceleration")),
                ("jerk", Idle("limits of acceleration")),
                ("drake:acceleration", Idle("limits of acceleration")),
            ],
            &[],
        ),
        DYNAMICS,
        once(
            "mimic",
            &[("joint", Read), ("multiplier", Read), ("offset", Read)],
            &[],
        ),
        Element {
            tag: "safety_controller",
            once: true,
            fate: Idle("safety controllers"),
            attributes: NOTHING,
            children: &[],
        },
        Element {
            tag: "calibration",
            once: true,
            fate: Idle("calibrations"),
            attributes: NOTHING,
            children: &[],
        },
        other(
            "joint_properties",
            Missing("<joint_properties>, an old form of <dynamics>"),
            &[],
        ),
        other("traits", Missing(SPRINGS), &[]),
    ],
};

/// What closes a loop of links.
const OPEN: &str = "the model is a tree of links; remove the element if the open tree is meant: it has more freedoms";

/// Extensions of Gazebo that change the motion.
const GAZEBO: &[Element] = &[
    other(
        "joint",
        Missing("joints of Gazebo, which close loops or replace others"),
        &[],
    ),
    other(
        "joint:hinge",
        Missing("joints of Gazebo, which close loops or replace others"),
        &[],
    ),
    other(
        "joint:slider",
        Missing("joints of Gazebo, which close loops or replace others"),
        &[],
    ),
    other("link", Missing("links of Gazebo"), &[]),
    other("springStiffness", Missing(SPRINGS), &[]),
    other("springReference", Missing(SPRINGS), &[]),
    other("gravity", Missing("gravity of single links"), &[]),
    other("turnGravityOff", Missing("gravity of single links"), &[]),
    other("dampingFactor", Missing("damping of links"), &[]),
    other(
        "plugin",
        Idle("plugins of Gazebo, which may couple or drive joints"),
        &[],
    ),
];

/// The whole file.
pub const ROBOT: Element = Element {
    tag: "robot",
    once: true,
    fate: Read,
    attributes: &[("name", Read), ("version", Read)],
    children: &[
        LINK,
        JOINT,
        other("material", Idle("materials"), &[]),
        other("transmission", Partly, &[]),
        other("gazebo", Idle("settings of Gazebo"), GAZEBO),
        other("ros2_control", Idle("settings of ros2_control"), &[]),
        other("mujoco", Idle("settings of MuJoCo"), &[]),
        other("sensor", Idle("sensors"), &[]),
        other("frame", Idle("frames"), &[]),
        other("loop_joint", Refused("closes a loop of links", OPEN), &[]),
        other(
            "constraint",
            Refused("constrains links or joints", OPEN),
            &[],
        ),
        other(
            "drake:ball_constraint",
            Refused("closes a loop of links", OPEN),
            &[],
        ),
        other(
            "drake:tendon_constraint",
            Refused("constrains joints", OPEN),
            &[],
        ),
        other(
            "drake:joint",
            Refused(
                "is a joint of Drake, which URDF does not have",
                "write it as a <joint> of URDF, or the model in YAML",
            ),
            &[],
        ),
        other("force_element", Missing("forces of Drake"), &[]),
        other("drake:linear_bushing_rpy", Missing("forces of Drake"), &[]),
        other(
            "drake:linear_spring_damper",
            Missing("forces of Drake"),
            &[],
        ),
        other("cable", Missing("cables"), &[]),
        other(
            "drake:collision_filter_group",
            Idle("groups of collisions"),
            &[],
        ),
        other("collision_filter_group", Idle("groups of collisions"), &[]),
    ],
};
