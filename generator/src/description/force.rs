//! Forces as written: joint, field, contact, belt, spring, airbag, load, user. The key that names a force says which it is.

use super::curve::Function;
use super::place::At;
use super::point::Point;
use super::quantity::{OneOrThree, Quantity};
use super::shape::{Problems, Shape, check_record, record, words};
use super::short::{ByName, Each};
use super::tree::Kind;
use crate::diagnostic::{nearest, quoted};
use crate::law::user::keys::User;
use serde::de::{Deserialize, Deserializer, Error};

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
    /// A local axis.
    LongAxis {
        /// The local x axis.
        X = "x",
        /// The local y axis.
        Y = "y",
        /// The local z axis.
        Z = "z",
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

record! {
    /// A uniform acceleration field.
    Field as "a field" {
        /// Name, unique among the fields.
        field: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// Per absolute axis \[m/s²\]: a number or a curve of time.
        acceleration: Vec<Function>,
        /// Systems and elements that feel it.
        on: Option<Vec<String>>,
    }
}

record! {
    /// Contact of an ellipsoid with a plane or another ellipsoid.
    Contact as "a contact" {
        /// Name, unique among the contacts.
        contact: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
        /// The ellipsoid; an ellipse in the plane.
        ellipsoid: ByName<Ellipsoid>,
        /// The plane that it meets; a line in the plane.
        plane: Option<ByName<Plane>>,
        /// Or the other ellipsoid.
        with: Option<ByName<Ellipsoid>>,
        /// Force against penetration \[m\] → \[N\].
        elastic: Option<Function>,
        /// Its slope, where it is a line through 0 \[N/m\].
        stiffness: Option<Quantity>,
        /// The same while it falls \[m\] → \[N\].
        unloading: Option<Function>,
        /// Slope of the line between the two \[N/m\].
        unloading_slope: Option<Quantity>,
        /// Viscous coefficient \[N s/m\].
        damping: Option<Quantity>,
        /// Penetration at which damping is fully there \[m\].
        damping_depth: Option<Quantity>,
        /// Coefficient of friction.
        friction: Option<Quantity>,
        /// Sliding speed at which friction is fully there \[m/s\].
        friction_speed: Option<Quantity>,
        /// Displacement at which friction that holds is fully there \[m\].
        friction_displacement: Option<Quantity>,
    }
}

record! {
    /// An ellipsoid on a body.
    Ellipsoid as "an ellipsoid" {
        /// `frame`, or an element as `system/element`.
        on: String,
        /// Centre, local frame \[m\].
        center: Vec<Quantity>,
        /// Semi-axes \[m\].
        semi_axes: Vec<Quantity>,
        /// Bryant angles of its axes relative to the local frame \[rad\].
        axes: Option<OneOrThree>,
        /// Even exponent of its equation.
        degree: Option<Quantity>,
        /// Of a named surface: whether it has a mirror image.
        mirror: Option<bool>,
    }
}

record! {
    /// A plane on a body.
    Plane as "a plane" {
        /// `frame`, or an element as `system/element`.
        on: String,
        /// A point of it, local frame \[m\].
        at: Vec<Quantity>,
        /// Direction to the side of the ellipsoid, local frame; of any length.
        normal: Vec<Quantity>,
        /// In space: direction of its first edge, local frame; of any length.
        along: Option<Vec<Quantity>>,
        /// Half its lengths \[m\]: one in the plane, two in space.
        extent: Option<OneOrThree>,
        /// What happens where it ends.
        edge: Option<Edge>,
        /// Of a named surface: whether it has a mirror image.
        mirror: Option<bool>,
    }
}

record! {
    /// Where a plane ends.
    Edge as "an edge" {
        /// What becomes of the force there.
        rule: Option<EdgeRule>,
        /// Width over which it fades \[m\].
        width: Option<Quantity>,
    }
}

words! {
    /// What becomes of a contact's force at an edge.
    EdgeRule {
        /// It ends.
        Cut = "cut",
        /// It fades.
        Fade = "fade",
    }
}

record! {
    /// A belt between two points.
    Belt as "a belt" {
        /// Name, unique among the belts.
        belt: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
        /// One end.
        from: Attachment,
        /// The other end.
        to: Attachment,
        /// The rings that it runs through on the way, in order from `from`.
        through: Option<Vec<Ring>>,
        /// Tension against relative elongation \[1\] → \[N\].
        force: Option<Function>,
        /// Its slope, where it is a line through 0 \[N\]; with a given length also \[N/m\].
        stiffness: Option<Quantity>,
        /// The same while it falls \[1\] → \[N\].
        unloading: Option<Function>,
        /// Slope of the line between the two \[N\].
        unloading_slope: Option<Quantity>,
        /// Initial distance of the ends less than the untensioned length \[m\].
        slack: Option<Quantity>,
        /// Tension at the start \[N\].
        pretension: Option<Quantity>,
        /// Untensioned length \[m\].
        length: Option<Quantity>,
        /// Viscous coefficient \[N s/m\].
        damping: Option<Quantity>,
        /// Stretch at which damping is fully there \[m\].
        damping_stretch: Option<Quantity>,
        /// Pays out webbing until it locks.
        retractor: Option<Retractor>,
        /// Takes webbing in once it fires.
        pretensioner: Option<Pretensioner>,
        /// Pays out webbing where the tension would pass a force.
        limiter: Option<Limiter>,
    }
}

record! {
    /// A spring and a damper between two points.
    Spring as "a spring" {
        /// Name, unique among the springs.
        spring: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
        /// One end.
        from: Attachment,
        /// The other end.
        to: Attachment,
        /// Force against elongation \[m\] → \[N\].
        elastic: Option<Function>,
        /// Its slope, where it is a line through 0 \[N/m\].
        stiffness: Option<Quantity>,
        /// Length without force \[m\].
        length: Option<Quantity>,
        /// Viscous coefficient \[N s/m\].
        damping: Option<Quantity>,
    }
}

record! {
    /// A point on a body.
    Attachment as "an attachment" {
        /// `frame`, or an element as `system/element`.
        on: String,
        /// The point, local frame \[m\].
        at: Vec<Quantity>,
    }
}

record! {
    /// A ring that a belt slips through.
    Ring as "a ring" {
        /// Name, unique in its belt.
        ring: String,
        /// `frame`, a vehicle, or an element as `system/element`.
        on: String,
        /// The ring, local frame \[m\].
        at: Vec<Quantity>,
        /// Coefficient of friction.
        friction: Option<Quantity>,
        /// Resistance to slip beside friction \[N s/m\].
        resistance: Option<Quantity>,
    }
}

record! {
    /// A reel that pays out and takes in webbing until it locks.
    Retractor as "a retractor" {
        /// The switch that locks it.
        lock: String,
        /// Tension until then \[N\].
        spool: Option<Quantity>,
        /// Once locked: by what the tension exceeds the spool's while webbing tightens on the reel, against its length \[m\] → \[N\].
        film_spool: Option<Function>,
    }
}

record! {
    /// A device that takes webbing in.
    Pretensioner as "a pretensioner" {
        /// The switch that fires it.
        fire: String,
        /// Time from then until it begins to retract \[s\].
        delay: Option<Quantity>,
        /// Length taken in against the time since it began \[s\] → \[m\].
        retract: Function,
    }
}

record! {
    /// A device that pays out webbing under load.
    Limiter as "a limiter" {
        /// Largest tension \[N\].
        force: Quantity,
    }
}

record! {
    /// A bag that gas fills, and that pushes what it meets.
    Airbag as "an airbag" {
        /// Name, unique among the airbags.
        airbag: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
        /// Its shape when full.
        ellipsoid: ByName<Ellipsoid>,
        /// What it meets, by names of ellipsoids or groups, or in place.
        against: Vec<ByName<Ellipsoid>>,
        /// Gas that flows in.
        inflow: Option<Inflow>,
        /// What the gas is.
        gas: Option<Gas>,
        /// Where it flows out.
        vent: Option<Vent>,
        /// What is around it.
        ambient: Option<Air>,
        /// Of a bag that is full at the start: its gas.
        start: Option<Air>,
    }
}

record! {
    /// A source of gas.
    Inflow as "an inflow" {
        /// The switch that fires it.
        fire: String,
        /// Mass of gas per time against the time since then \[s\] → \[kg/s\].
        flow: Function,
        /// Its absolute temperature \[K\].
        temperature: Quantity,
    }
}

record! {
    /// A perfect gas.
    Gas as "a gas" {
        /// R \[J/(kg K)\].
        constant: Option<Quantity>,
        /// Ratio of its specific heats.
        gamma: Option<Quantity>,
    }
}

record! {
    /// A hole that gas flows out of.
    Vent as "a vent" {
        /// Its area \[m²\].
        area: Quantity,
        /// Part of the area that the jet takes.
        coefficient: Option<Quantity>,
    }
}

record! {
    /// A state of a gas.
    Air as "the state of a gas" {
        /// Absolute pressure \[Pa\].
        pressure: Option<Quantity>,
        /// Absolute temperature \[K\].
        temperature: Option<Quantity>,
    }
}

record! {
    /// A given force and moment on an element.
    Load as "a load" {
        /// Name, unique among the loads.
        load: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Acts from this switch on.
        since: Option<String>,
        /// Acts up to this switch.
        until: Option<String>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
        /// The element, as `system/element`.
        on: String,
        /// Where the force acts, local frame \[m\].
        at: Option<Point>,
        /// Per absolute axis \[N\]: a number or a curve of time.
        force: Option<Vec<Function>>,
        /// About y, or per absolute axis \[N m\]: a number or a curve of time.
        moment: Option<OneOrThree<Function>>,
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

/// A force of any kind.
#[derive(Clone, Debug)]
pub enum Force {
    /// Torque in a joint.
    Joint(Box<Joint>),
    /// Acceleration field.
    Field(Field),
    /// Contact.
    Contact(Box<Contact>),
    /// Belt.
    Belt(Box<Belt>),
    /// Spring and damper.
    Spring(Box<Spring>),
    /// Airbag.
    Airbag(Box<Airbag>),
    /// Given force and moment.
    Load(Box<Load>),
    /// By a function of the user's.
    User(Box<User>),
}

/// The keys that say which force it is.
pub const KINDS: [&str; 8] = [
    "joint", "field", "contact", "belt", "spring", "airbag", "load", "user",
];

impl Shape for Force {
    fn check(at: At<'_>, problems: &Problems) {
        const HELP: &str = "a force begins with one of `joint:`, `field:`, `contact:`, `belt:`, `spring:`, `airbag:`, `load:`, `user:`";
        let Kind::Map(entries) = &at.node.kind else {
            problems.add(at.problem(
                format!("here stands {}, but a force has keys", at.node.article()),
                HELP,
            ));
            return;
        };
        let kinds: Vec<&str> = KINDS
            .into_iter()
            .filter(|kind| entries.iter().any(|e| e.key == *kind))
            .collect();
        match kinds[..] {
            ["joint"] => check_record::<Joint>(at, problems),
            ["field"] => check_record::<Field>(at, problems),
            ["contact"] => check_record::<Contact>(at, problems),
            ["belt"] => check_record::<Belt>(at, problems),
            ["spring"] => check_record::<Spring>(at, problems),
            ["airbag"] => check_record::<Airbag>(at, problems),
            ["load"] => check_record::<Load>(at, problems),
            ["user"] => check_record::<User>(at, problems),
            [] => {
                let near = entries
                    .iter()
                    .find_map(|e| nearest(&e.key, KINDS).map(|kind| (e, kind)));
                problems.add(match near {
                    Some((entry, kind)) => at.problem_at(
                        entry.span,
                        format!("{} is no kind of force", quoted(&entry.key)),
                        format!("did you mean `{kind}`?"),
                    ),
                    None => at.problem("the force has no kind", HELP),
                });
            }
            _ => problems.add(at.key(kinds[1]).key_problem(
                format!("the force has two kinds, {} and {}", kinds[0], kinds[1]),
                "write two forces, each begun with `- `",
            )),
        }
    }
}

impl<'de> Deserialize<'de> for Force {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = serde_yaml::Value::deserialize(deserializer)?;
        let has = |key: &str| value.get(key).is_some();
        if has("joint") {
            Joint::deserialize(value).map(|j| Force::Joint(Box::new(j)))
        } else if has("field") {
            Field::deserialize(value).map(Force::Field)
        } else if has("contact") {
            Contact::deserialize(value).map(|c| Force::Contact(Box::new(c)))
        } else if has("belt") {
            Belt::deserialize(value).map(|b| Force::Belt(Box::new(b)))
        } else if has("spring") {
            Spring::deserialize(value).map(|s| Force::Spring(Box::new(s)))
        } else if has("airbag") {
            Airbag::deserialize(value).map(|a| Force::Airbag(Box::new(a)))
        } else if has("load") {
            Load::deserialize(value).map(|l| Force::Load(Box::new(l)))
        } else {
            User::deserialize(value).map(|u| Force::User(Box::new(u)))
        }
        .map_err(D::Error::custom)
    }
}
