//! Bushings: two frames, and a law for each direction.

use super::keys::{Bushing as Written, Direction as WrittenDirection, Mount as End, Rotations};
use crate::description::measure::{
    ANGLE, ANGULAR_DAMPING, ANGULAR_STIFFNESS, Expected, FORCE, LENGTH, LINEAR_DAMPING, STIFFNESS,
    TORQUE,
};
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::resolve::{AXES, NOWHERE, Resolver};
use crate::model::{Attachment, Number, ScaledCurve};
use serde::Serialize;

/// Springs and dampers in six directions between frames of two bodies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bushing {
    /// The frame whose axes define the directions of the laws.
    pub from: Mount,
    /// The frame that moves relative to `from`.
    pub to: Mount,
    /// Laws of the displacement along each axis; in the plane the first and third are used.
    pub along: [Direction; 3],
    /// Laws of the rotation, one for each Bryant angle; in the plane the second is used.
    pub about: [Direction; 3],
    /// Law of the angle φ of the whole rotation about its axis, in space. It excludes laws of Bryant angles.
    pub turn: Direction,
}

/// A frame on a body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mount {
    /// The origin of the frame.
    pub on: Attachment,
    /// Bryant angles of the axes of the frame relative to the body's frame \[rad\]. In the plane only the second is
    /// used.
    pub axes: [Number; 3],
}

/// The law of one direction.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Direction {
    /// Force as a function of the displacement \[m\] → \[N\], or moment of the angle \[rad\] → \[N m\].
    pub elastic: Option<ScaledCurve>,
    /// Viscous coefficient \[N s/m\] or \[N m s/rad\].
    pub damping: Option<Number>,
}

/// The physical quantities of a direction's numbers: abscissa, ordinate and slope of the curve; the damping.
type Measures = ([Expected; 3], Expected);

/// For a law along an axis.
const ALONG: Measures = ([LENGTH, FORCE, STIFFNESS], LINEAR_DAMPING);

/// For a law about an axis.
const ABOUT: Measures = ([ANGLE, TORQUE, ANGULAR_STIFFNESS], ANGULAR_DAMPING);

/// The checked form of a bushing.
pub(crate) fn bushing(
    resolver: &mut Resolver<'_>,
    written: &Written,
    at: At<'_>,
) -> Option<Bushing> {
    let name = &written.bushing;
    let from = mount(resolver, &written.from, at.key("from"));
    let to = mount(resolver, &written.to, at.key("to"));
    if let (Some(a), Some(b)) = (&from, &to)
        && a.on.on == b.on.on
    {
        resolver.problems.add(at.key("to").problem(
            format!("both ends of bushing {} are on the same body", quoted(name)),
            "a bushing stands between two bodies; `frame` is the absolute frame",
        ));
    }
    let along = written.along.as_ref().map(|w| [&w.x, &w.y, &w.z]);
    let about = written.about.as_ref().map(|w| [&w.x, &w.y, &w.z]);
    let along = directions(resolver, along, "along", ALONG, at);
    let about = directions(resolver, about, "about", ABOUT, at);
    let turn = turn(resolver, written.about.as_ref(), at.key("about"));
    Some(Bushing {
        from: from?,
        to: to?,
        along,
        about,
        turn,
    })
}

/// The law of the whole rotation.
fn turn(resolver: &mut Resolver<'_>, written: Option<&Rotations>, at: At<'_>) -> Direction {
    let Some((about, law)) = written.and_then(|about| Some((about, about.turn.as_ref()?))) else {
        return Direction::default();
    };
    let place = at.key("turn");
    if resolver.planar {
        resolver.problems.add(place.key_problem(
            "in the plane a rotation has one angle, that about y",
            "write `about: { y: … }`",
        ));
        return Direction::default();
    }
    if about.x.is_some() || about.y.is_some() || about.z.is_some() {
        resolver.problems.add(place.key_problem(
            "there are a law of the whole rotation and laws about single axes",
            "keep `turn`, the same law about any axis, or `x`, `y` and `z`, a law for each Bryant angle",
        ));
    }
    let written = WrittenDirection {
        elastic: None,
        stiffness: law.stiffness.as_ref().map(|number| number.measured_in()),
        damping: law.damping.as_ref().map(|number| number.measured_in()),
    };
    direction(resolver, &written, ABOUT, place)
}

fn mount(resolver: &Resolver<'_>, written: &End, at: At<'_>) -> Option<Mount> {
    let axes = match &written.axes {
        Some(axes) => resolver.rotation(axes, at.key("axes")),
        None => NOWHERE,
    };
    let position = resolver.vector(&written.at, at.key("at"));
    let on = resolver.body(&written.on, at.key("on"))?;
    Some(Mount {
        on: Attachment { on, at: position },
        axes,
    })
}

/// The laws under `key` of the bushing called `name`.
fn directions(
    resolver: &mut Resolver<'_>,
    written: Option<[&Option<WrittenDirection>; 3]>,
    key: &str,
    measures: Measures,
    at: At<'_>,
) -> [Direction; 3] {
    let mut laws: [Direction; 3] = Default::default();
    for (axis, law) in written.into_iter().flatten().enumerate() {
        let place = at.key(key).key(AXES[axis]);
        let Some(law) = law else { continue };
        if resolver.planar && (axis == 1) != (key == "about") {
            resolver.problems.add(place.key_problem(
                "in the plane nothing moves along y, nor turns about x and z",
                "a planar bushing has `along: { x: …, z: … }` and `about: { y: … }`",
            ));
            continue;
        }
        laws[axis] = direction(resolver, law, measures, place);
    }
    laws
}

fn direction(
    resolver: &mut Resolver<'_>,
    written: &WrittenDirection,
    (curve, damping): Measures,
    at: At<'_>,
) -> Direction {
    let elastic = ("elastic", written.elastic.as_deref());
    Direction {
        elastic: resolver.elastic_in(elastic, written.stiffness.as_deref(), at, curve),
        damping: resolver.coefficient_in(written.damping.as_deref(), at.key("damping"), damping),
    }
}
