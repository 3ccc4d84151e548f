//! Channels of a test: outputs in the axes and signs of SAE J211-1 and ISO 6487.
//!
//! This is the one place that knows these signs. An output whose channel code says a direction, or that the criteria name, is a channel; its
//! column is then that of the standard, in every table, file and verdict.
//!
//! - **Axes** \[SAE J1733, J211-1\]: of a body that stands upright, x points forward, y from left to right, z down. They turn with each part. A
//!   sensor reads along the axes of the part that it is in.
//! - **Loads** \[SAE J211: of a dummy that is sectioned below the load cell, positive loads are applied to its bottom surface\]: the wrench of
//!   the lower part on the upper one, of a body that stands. So tension of neck and femur is positive along z, and the moment of a chin that is
//!   pressed to the sternum is positive about y.
//! - **Which side of a joint is the upper one** follows from the centres of gravity: it does not matter which element carries the other.

use super::Resolver;
use crate::description::element::{Anatomy as Written, Direction, Neck};
use crate::description::output::Output as WrittenOutput;
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::law::joint::outputs::{JointOutput, JointQuantity};
use crate::model::{
    Asked, Body, Channel, Component, ElementId, ForceKind, JointLoadQuantity, Number,
    PointQuantity, Projection, Quantity, RotationQuantity,
};

/// Centres of gravity that differ in height by less do not say which part is the upper one \[m\].
const LEVEL: f64 = 1e-6;
/// The cosine of the largest angle between the axis of a freedom and the direction of its code: 2.5°.
const ALONG: f64 = 0.999;

/// Which axes of a body are those of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Anatomy {
    forward: [i8; 3],
    up: [i8; 3],
}

/// x forward, z up: y is to the left.
impl Default for Anatomy {
    fn default() -> Self {
        Anatomy {
            forward: Direction::X.vector(),
            up: Direction::Z.vector(),
        }
    }
}

impl Anatomy {
    /// As the text says it; `None` if its two directions are not at right angles, or not in the plane.
    pub(crate) fn of(written: &Written, planar: bool) -> Option<Self> {
        let usual = Anatomy::default();
        let anatomy = Anatomy {
            forward: written.forward.map_or(usual.forward, Direction::vector),
            up: written.up.map_or(usual.up, Direction::vector),
        };
        let across = anatomy.right().iter().any(|x| *x != 0);
        let in_plane = anatomy.forward[1] == 0 && anatomy.up[1] == 0;
        (across && (in_plane || !planar)).then_some(anatomy)
    }

    /// From left to right: forward × up.
    fn right(&self) -> [i8; 3] {
        let ([a, b, c], [d, e, f]) = (self.forward, self.up);
        [b * f - c * e, c * d - a * f, a * e - b * d]
    }

    /// The local axis of a component of the standard, and whether it points the other way.
    fn axis(&self, component: Component) -> Option<(usize, bool)> {
        let direction = match component {
            Component::X => self.forward,
            Component::Y => self.right(),
            Component::Z => self.up.map(|x| -x),
            Component::Resultant => return None,
        };
        let axis = direction.iter().position(|x| *x != 0)?;
        Some((axis, direction[axis] < 0))
    }
}

/// What an element is of a body, as far as the text says it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BodyPart {
    pub anatomy: Anatomy,
    pub neck: Option<Neck>,
}

/// The direction that a channel code says: its 15th character.
pub(super) fn direction(code: &str) -> Option<Component> {
    match code.as_bytes().get(14)? {
        b'X' => Some(Component::X),
        b'Y' => Some(Component::Y),
        b'Z' => Some(Component::Z),
        b'R' => Some(Component::Resultant),
        _ => None,
    }
}

/// Whether a channel code is that of the load cell at the upper neck.
pub(super) fn is_upper_neck(code: &str) -> bool {
    code.get(2..8) == Some("NECKUP")
}

/// An output with a code, along the axes of its own body if it is a sensor and the text does not say along which.
pub(super) fn with_axes(resolver: &Resolver<'_>, written: &WrittenOutput) -> WrittenOutput {
    let sensors = [
        "acceleration",
        "accelerometer",
        "angular_velocity",
        "angular_acceleration",
    ];
    let (of, what) = (written.of.as_str(), written.what.as_str());
    let is_load = of.starts_with("joint ") && ["force", "moment"].contains(&what);
    let vehicle = of.strip_prefix("vehicle ").unwrap_or(of);
    let of_vehicle = resolver.vehicles.iter().any(|one| one.name == vehicle);
    let of_element = of.contains('/') && !of.contains(' ');
    let of_sensor = (of_element || of_vehicle) && sensors.contains(&what);
    let mut with = written.clone();
    if with.axes.is_none() && (is_load || of_sensor) {
        with.axes = Some("local".to_owned());
    }
    with
}

/// What a channel is asked to be.
#[derive(Clone, Copy)]
pub(super) struct Wanted<'a> {
    /// The direction of the standard.
    pub direction: Component,
    /// Whether it is the load cell at the upper neck.
    pub upper_neck: bool,
    /// Whether the text says along whose axes.
    pub says_axes: bool,
    /// Who asks for it, in messages: `the channel code 11NECKUP00H3FOZA`.
    pub by: &'a str,
    /// Where.
    pub at: At<'a>,
}

/// A quantity as a channel of the standard; what cannot be one is reported.
pub(super) fn channel(
    resolver: &Resolver<'_>,
    mut quantity: Quantity,
    wanted: Wanted<'_>,
) -> Option<(Quantity, Channel)> {
    let reversed = match &mut quantity {
        Quantity::Point {
            body,
            what,
            projection,
            ..
        } => {
            let is_sensor = matches!(
                what,
                PointQuantity::Acceleration | PointQuantity::Accelerometer
            );
            sits_in(resolver, is_sensor, *body, *projection, wanted)?;
            project(resolver, projection, wanted)?
        }
        Quantity::Rotation {
            body,
            what: RotationQuantity::Angle,
            relative_to,
            projection,
        } => {
            let ours = [*body, *relative_to].map(|body| anatomy(resolver, body));
            if !resolver.planar && ours.iter().any(|one| *one != Anatomy::default()) {
                resolver.problems.add(wanted.at.problem(
                    "Bryant angles about turned axes are no angles of the standard",
                    "give angular velocities, or frames whose x is forward and whose z is up",
                ));
                return None;
            }
            projection_of(resolver, projection.component, wanted)?;
            ours[0]
                .axis(projection.component)
                .is_some_and(|(_, back)| back)
        }
        Quantity::Rotation {
            body, projection, ..
        } => {
            sits_in(resolver, true, *body, *projection, wanted)?;
            project(resolver, projection, wanted)?
        }
        Quantity::JointLoad {
            element,
            what,
            on_carrier,
            projection,
        } => {
            return load(
                resolver,
                (*element, *what, *on_carrier, *projection),
                wanted,
            );
        }
        Quantity::ForceOn { projection, .. }
        | Quantity::ForceOnPoints { projection, .. }
        | Quantity::System { projection, .. } => project(resolver, projection, wanted)?,
        Quantity::Freedom {
            element, freedom, ..
        } => of_freedom(resolver, *element, *freedom, wanted)?,
        Quantity::OfForce { force, what } => of_law(resolver, *force, what, wanted)?,
        Quantity::Switch { .. } | Quantity::Formula(_) => false,
    };
    let remark = match &quantity {
        Quantity::Point {
            body: Body::Element(id),
            what: PointQuantity::Acceleration | PointQuantity::Accelerometer,
            ..
        } if resolver.part(*id).neck.is_some() => {
            Some("the head has the neck in it: at their common centre of gravity")
        }
        Quantity::Formula(_) => Some("a formula: with the sign that the model gives it"),
        _ => None,
    };
    Some((quantity, Channel { reversed, remark }))
}

fn anatomy(resolver: &Resolver<'_>, body: Body) -> Anatomy {
    match body {
        Body::Element(id) => resolver.part(id).anatomy,
        Body::Frame | Body::Vehicle(_) => Anatomy::default(),
    }
}

/// Reports a component that is not the direction of the code.
fn projection_of(
    resolver: &Resolver<'_>,
    component: Component,
    wanted: Wanted<'_>,
) -> Option<Component> {
    if component == wanted.direction {
        return Some(component);
    }
    let named = |component: Component| match component {
        Component::X => "x",
        Component::Y => "y",
        Component::Z => "z",
        Component::Resultant => "resultant",
    };
    resolver.problems.add(wanted.at.problem(
        format!(
            "{} wants the component {}, and the output is the component {}",
            wanted.by,
            named(wanted.direction),
            named(component)
        ),
        format!("give it `component: {}`", named(wanted.direction)),
    ));
    None
}

/// Turns a projection into that of the standard; returns whether it is the opposite.
fn project(
    resolver: &Resolver<'_>,
    projection: &mut Projection,
    wanted: Wanted<'_>,
) -> Option<bool> {
    projection_of(resolver, projection.component, wanted)?;
    let Some((axis, back)) = anatomy(resolver, projection.axes).axis(projection.component) else {
        return Some(false);
    };
    projection.component = [Component::X, Component::Y, Component::Z][axis];
    Some(back)
}

/// Reports a sensor in an element that reads along the axes of another body.
fn sits_in(
    resolver: &Resolver<'_>,
    is_sensor: bool,
    body: Body,
    projection: Projection,
    wanted: Wanted<'_>,
) -> Option<()> {
    let Body::Element(id) = body else {
        return Some(());
    };
    // in the plane all axes y are one
    let across = resolver.planar && projection.component == Component::Y;
    let whole = projection.component == Component::Resultant;
    if !is_sensor || across || whole || projection.axes == body {
        return Some(());
    }
    let path = quoted(&resolver.path(id));
    resolver.problems.add(wanted.at.problem(
        format!(
            "{} is of a sensor that turns with {path}, and the output is along other axes",
            wanted.by
        ),
        "write `axes: local`",
    ));
    None
}

/// The wrench in a joint: of the lower part on the upper one.
fn load(
    resolver: &Resolver<'_>,
    (element, what, on_carrier, mut projection): (ElementId, JointLoadQuantity, bool, Projection),
    wanted: Wanted<'_>,
) -> Option<(Quantity, Channel)> {
    let mut remark = None;
    let mut upper_is_carrier = false;
    if wanted.direction != Component::Resultant || wanted.upper_neck {
        let carried = Body::Element(element);
        let carrier = carrier(resolver, element);
        upper_is_carrier = !carried_is_upper(resolver, element, wanted)?;
        let upper = if upper_is_carrier { carrier } else { carried };
        if wanted.upper_neck && !wanted.says_axes {
            projection.axes = upper;
        }
        let fits = match wanted.upper_neck {
            true => projection.axes == upper,
            false => [carried, carrier].contains(&projection.axes),
        };
        let across = resolver.planar && what == JointLoadQuantity::Moment;
        if !fits && !across && wanted.direction != Component::Resultant {
            resolver.problems.add(wanted.at.problem(
                format!(
                    "{} is of a load cell that turns with the {}, and the output is along other axes",
                    wanted.by,
                    match wanted.upper_neck {
                        true => "head",
                        false => "parts that it joins",
                    }
                ),
                "leave `axes` out",
            ));
            return None;
        }
        if wanted.upper_neck {
            remark = neck(resolver, upper, wanted)?;
        }
    }
    let back = project(resolver, &mut projection, wanted)?;
    // on the carrier is the opposite of on the carried
    let on_upper = on_carrier == upper_is_carrier;
    let reversed = wanted.direction != Component::Resultant && (back == on_upper);
    let quantity = Quantity::JointLoad {
        element,
        what,
        on_carrier,
        projection,
    };
    Some((quantity, Channel { reversed, remark }))
}

/// What is to be known of the upper neck of a head; a dummy that has no such load cell is reported.
fn neck(resolver: &Resolver<'_>, head: Body, wanted: Wanted<'_>) -> Option<Option<&'static str>> {
    let Body::Element(id) = head else {
        return Some(None);
    };
    match resolver.part(id).neck {
        None => Some(None),
        Some(Neck::Within) => Some(Some("at C7/T1: the head has the neck in it")),
        Some(Neck::Lower) => {
            resolver.problems.add(wanted.at.problem(
                format!(
                    "{} wants the load cell at the upper neck, and the joint of {} is at C7/T1: head and neck are one element",
                    wanted.by,
                    quoted(&resolver.path(id))
                ),
                "it is the place of the lower load cell: write NECKLO in its code, and name no neck in `criteria`; Nij is of the upper one, so there is none of this body",
            ));
            None
        }
    }
}

/// The body that carries an element.
fn carrier(resolver: &Resolver<'_>, id: ElementId) -> Body {
    use crate::model::Reference;
    let system = &resolver.systems[id.system];
    match (system.elements[id.element].parent, &system.reference) {
        (Some(element), _) => Body::Element(ElementId { element, ..id }),
        (None, Reference::Riding { vehicle, .. }) => Body::Vehicle(*vehicle),
        (None, _) => Body::Frame,
    }
}

/// Whether the element that a joint carries is the upper one of the two, of a body that stands: its centre of gravity is higher above the joint than that of
/// its carrier.
fn carried_is_upper(resolver: &Resolver<'_>, id: ElementId, wanted: Wanted<'_>) -> Option<bool> {
    let value = |number: &Number| number.value(&resolver.defaults);
    let height = |id: ElementId, from: Option<&[Number; 3]>| -> f64 {
        let element = &resolver.systems[id.system].elements[id.element];
        let up = resolver.part(id).anatomy.up;
        let along = |i: usize| {
            let origin = from.map_or(0.0, |from| value(&from[i]));
            f64::from(up[i]) * (value(&element.cg[i]) - origin)
        };
        (0..3).map(along).sum()
    };
    let element = &resolver.systems[id.system].elements[id.element];
    let of_carrier = element.parent.map_or(0.0, |parent| {
        let parent = ElementId {
            element: parent,
            ..id
        };
        height(parent, Some(&element.at))
    });
    let above = height(id, None) - of_carrier;
    if above.abs() < LEVEL {
        resolver.problems.add(wanted.at.problem(
            format!(
                "{} is the load of the lower part on the upper one, and the centres of gravity do not say which side of the joint of {} is the upper one",
                wanted.by,
                quoted(&resolver.path(id))
            ),
            "leave the code out, or give the elements their centres of gravity",
        ));
        return None;
    }
    Some(above > 0.0)
}

/// Whether the coordinate of a freedom is the opposite of that about or along an axis of the standard.
fn of_freedom(
    resolver: &Resolver<'_>,
    id: ElementId,
    freedom: usize,
    wanted: Wanted<'_>,
) -> Option<bool> {
    let Some((axis, back)) = anatomy(resolver, carrier(resolver, id)).axis(wanted.direction) else {
        return Some(false);
    };
    let element = &resolver.systems[id.system].elements[id.element];
    let freedom = &element.joint.freedoms()[freedom];
    let along = freedom.axis[axis].value(&resolver.defaults) * if back { -1.0 } else { 1.0 };
    if along.abs() < ALONG {
        resolver.problems.add(wanted.at.problem(
            format!(
                "{} says another direction than the axis of this freedom",
                wanted.by
            ),
            "write the direction of the axis into the code, or 0 where there is none",
        ));
        return None;
    }
    Some(along < 0.0)
}

/// Whether a quantity of a law is the opposite of that of the standard. What has no direction is what it is.
fn of_law(resolver: &Resolver<'_>, force: usize, what: &Asked, wanted: Wanted<'_>) -> Option<bool> {
    let Asked::Joint(JointOutput { about, what: asked }) = what else {
        let Some(component) = what.component() else {
            return Some(false);
        };
        projection_of(resolver, component, wanted)?;
        return Some(
            Anatomy::default()
                .axis(component)
                .is_some_and(|(_, back)| back),
        );
    };
    let (child, back) = match &resolver.forces[force].kind {
        ForceKind::Freedom(law) => {
            let back = of_freedom(resolver, law.child, law.freedom, wanted)?;
            (law.child, back)
        }
        ForceKind::Joint(law) => {
            let component = match *about {
                0 => Component::X,
                1 => Component::Y,
                2 => Component::Z,
                _ => Component::Resultant,
            };
            projection_of(resolver, component, wanted)?;
            let axes = anatomy(resolver, carrier(resolver, law.child));
            let (axis, back) = axes.axis(component)?;
            if axis != *about {
                projection_of(resolver, Component::Resultant, wanted)?;
            }
            (law.child, back)
        }
        _ => return Some(false),
    };
    match asked {
        JointQuantity::Torque => Some(back == carried_is_upper(resolver, child, wanted)?),
        _ => Some(back),
    }
}
