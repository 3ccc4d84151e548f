//! Channels of a test: outputs in the axes and signs of SAE J211-1 and ISO 6487.
//!
//! Only this module knows these signs. An output becomes a channel if its channel code gives a direction, or if the
//! criteria name it. Its column then follows the standard in every table, file and verdict.
//!
//! - **Axes** \[SAE J1733, J211-1\]: for a body that stands upright, x points forward, y from left to right, z down.
//!   The axes turn with each part. A sensor reads along the axes of the part that contains it.
//! - **Loads** \[SAE J211: of a dummy that is sectioned below the load cell, positive loads are applied to its bottom
//!   surface\]: the wrench of the lower part on the upper part of a body that stands upright. So tension of neck and
//!   femur is positive along z, and the moment that presses the chin to the sternum is positive about y.
//! - **Upper and lower part** of a joint follow from the centres of gravity: it does not matter which element carries
//!   the other.

use super::Resolver;
use crate::description::element::{Anatomy as Written, Direction, Neck};
use crate::description::output::Output as WrittenOutput;
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::law::{Measured, OfLaw, Side};
use crate::model::{
    Body, Channel, Component, ElementId, JointLoadQuantity, Number, PointQuantity, Projection,
    Quantity, RotationQuantity,
};

/// Smallest difference in height of two centres of gravity that decides which part is the upper one \[m\].
const LEVEL: f64 = 1e-6;
/// Cosine of the largest angle allowed between the axis of a freedom and the direction in its code: 2.5°.
const ALONG: f64 = 0.999;

/// The local axes of a body that point forward and up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Anatomy {
    forward: [i8; 3],
    up: [i8; 3],
}

/// x forward, z up; so y points to the left.
impl Default for Anatomy {
    fn default() -> Self {
        Anatomy {
            forward: Direction::X.vector(),
            up: Direction::Z.vector(),
        }
    }
}

impl Anatomy {
    /// The anatomy as written; `None` if its two directions are not perpendicular, or in a planar model not in the
    /// plane.
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

    /// The direction from left to right: forward × up.
    fn right(&self) -> [i8; 3] {
        let ([a, b, c], [d, e, f]) = (self.forward, self.up);
        [b * f - c * e, c * d - a * f, a * e - b * d]
    }

    /// The local axis of a component of the standard, and true if it points in the opposite direction.
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

/// The part of a human body that an element represents, as far as the text says it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BodyPart {
    pub anatomy: Anatomy,
    pub neck: Option<Neck>,
}

/// The direction that a channel code gives in its 15th character.
pub(super) fn direction(code: &str) -> Option<Component> {
    match code.as_bytes().get(14)? {
        b'X' => Some(Component::X),
        b'Y' => Some(Component::Y),
        b'Z' => Some(Component::Z),
        b'R' => Some(Component::Resultant),
        _ => None,
    }
}

/// True if a channel code is that of the load cell at the upper neck.
pub(super) fn is_upper_neck(code: &str) -> bool {
    code.get(2..8) == Some("NECKUP")
}

/// An output with a channel code. If it is a sensor and the text names no axes, it gets the axes of its own body.
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

/// The properties that a channel must have.
#[derive(Clone, Copy)]
pub(super) struct Wanted<'a> {
    /// The direction of the standard.
    pub direction: Component,
    /// True for the load cell at the upper neck.
    pub upper_neck: bool,
    /// True if the text names a body for the axes.
    pub says_axes: bool,
    /// The origin of this demand, for messages: `the channel code 11NECKUP00H3FOZA`.
    pub by: &'a str,
    /// Its place in the text.
    pub at: At<'a>,
}

/// A quantity as a channel of the standard; reports a quantity that cannot be one.
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
        Quantity::OfForce { force, what } => of_law(resolver, *force, &**what, wanted)?,
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

/// The component, if it is the wanted direction; otherwise reports it.
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

/// Replaces a projection by that of the standard. Returns true if the quantity then has the opposite sign.
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

/// Reports a sensor in an element whose axes are those of another body.
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
    // in the plane, the axes y of all bodies coincide
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

/// The load in a joint as a channel: the wrench of the lower part on the upper part.
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
    // the load on the carrier is the opposite of that on the carried element
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

/// The remark on the upper neck of a head; reports a dummy that has no such load cell.
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

/// True if the element that a joint carries is the upper one of the two parts, for a body that stands upright: its
/// centre of gravity is higher above the joint than that of its carrier.
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

/// True if the coordinate of a freedom has the opposite sign of that about or along an axis of the standard.
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

/// True if a quantity of a law has the opposite sign of that of the standard. False for a quantity without direction.
fn of_law(
    resolver: &Resolver<'_>,
    force: usize,
    what: &dyn OfLaw,
    wanted: Wanted<'_>,
) -> Option<bool> {
    let (child, back, side) = match resolver.forces[force].law.direction(what) {
        Measured::Undirected => return Some(false),
        Measured::Component(component) => {
            projection_of(resolver, component, wanted)?;
            let axis = Anatomy::default().axis(component);
            return Some(axis.is_some_and(|(_, back)| back));
        }
        Measured::Freedom(child, freedom, side) => {
            (child, of_freedom(resolver, child, freedom, wanted)?, side)
        }
        Measured::About(child, about, side) => {
            let component = match about {
                0 => Component::X,
                1 => Component::Y,
                2 => Component::Z,
                _ => Component::Resultant,
            };
            projection_of(resolver, component, wanted)?;
            let axes = anatomy(resolver, carrier(resolver, child));
            let (axis, back) = axes.axis(component)?;
            if axis != about {
                projection_of(resolver, Component::Resultant, wanted)?;
            }
            (child, back, side)
        }
    };
    match side {
        Side::Load => Some(back == carried_is_upper(resolver, child, wanted)?),
        Side::Motion => Some(back),
    }
}
