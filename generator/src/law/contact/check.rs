//! Contacts of an ellipsoid with a plane or another ellipsoid.

use super::keys::Contact as Written;
use crate::description::measure::{FORCE, FRICTION, LENGTH, SPEED, STIFFNESS};
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::resolve::Resolver;
use crate::model::resolve::hysteresis::Unloading;
use crate::model::resolve::surface::{EDGE_WIDTH, degree, ellipsoid, plane};
use crate::model::{
    Attachment, Bristle, EdgeRule, Ellipsoid, Extent, Friction, Hysteresis, Number, Plane,
    ScaledCurve,
};
use serde::Serialize;

/// Sliding speed from which on contact friction has its full size, if the user gives none \[m/s\].
const FRICTION_SPEED: f64 = 0.01;

/// Penetration from which on damping has its full size, if the user gives none \[m\].
const DAMPING_DEPTH: f64 = 1e-3;

/// Contact of an ellipsoid with a plane or another ellipsoid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contact {
    /// Centre of the ellipsoid.
    pub ellipsoid: Attachment,
    /// Semi-axes along the ellipsoid's own axes \[m\], positive. In the plane the first and third (x, z) are used.
    pub semi_axes: [Number; 3],
    /// Bryant angles of the ellipsoid's axes relative to the body's frame \[rad\]. In the plane only the second is
    /// used.
    pub axes: [Number; 3],
    /// Exponent n of the surface Σ |x_i/a_i|ⁿ = 1, even: 2 is an ellipsoid, larger numbers are rounded boxes.
    pub degree: u32,
    /// The plane or ellipsoid that the ellipsoid meets, on another body.
    pub against: Against,
    /// Elastic force as a function of the perpendicular penetration: \[m\] → \[N\].
    pub elastic: Option<ScaledCurve>,
    /// A different curve for unloading, against the penetration \[m\].
    pub hysteresis: Option<Hysteresis>,
    /// Viscous coefficient on the penetration rate \[N s/m\]; the sum of elastic and viscous force is never negative.
    pub damping: Option<Number>,
    /// Penetration up to which damping grows from 0 to its full size \[m\]; `None` for full damping at once.
    pub damping_depth: Option<Number>,
    /// Coulomb friction on the normal force.
    pub friction: Option<Friction>,
    /// The bristle by which friction holds; without one, friction only resists motion.
    pub bristle: Option<Bristle>,
}

/// The surface that an ellipsoid meets.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Against {
    /// A plane.
    Plane(Plane),
    /// An ellipsoid. Both ellipsoids must then be of degree 2.
    Ellipsoid(Ellipsoid),
}

impl Against {
    /// The body of the surface and a point on it: a point of the plane, or the centre of the ellipsoid.
    pub fn place(&self) -> &Attachment {
        match self {
            Against::Plane(plane) => &plane.at,
            Against::Ellipsoid(ellipsoid) => &ellipsoid.center,
        }
    }

    /// Like [`place`](Self::place), mutable.
    pub fn place_mut(&mut self) -> &mut Attachment {
        match self {
            Against::Plane(plane) => &mut plane.at,
            Against::Ellipsoid(ellipsoid) => &mut ellipsoid.center,
        }
    }

    /// The plane; `None` for an ellipsoid.
    pub fn plane(&self) -> Option<&Plane> {
        match self {
            Against::Plane(plane) => Some(plane),
            Against::Ellipsoid(_) => None,
        }
    }
}

/// The checked form of a contact.
pub(crate) fn contact(
    resolver: &mut Resolver<'_>,
    written: &Written,
    at: At<'_>,
) -> Option<Contact> {
    let round = at.key("ellipsoid");
    let ellipsoid = ellipsoid(resolver, &written.ellipsoid, round);
    let degree = degree(
        resolver,
        written.ellipsoid.degree.as_ref(),
        round.key("degree"),
    );
    let (mut against, other) = against(resolver, written, degree, at);
    if let (Some(first), Some(second)) = (&ellipsoid, &against) {
        check_bodies(resolver, &written.contact, first, second, other);
    }
    let elastic = resolver.elastic(
        ("elastic", written.elastic.as_ref()),
        written.stiffness.as_ref(),
        at,
    );
    let hysteresis = resolver.hysteresis(
        elastic.as_ref(),
        Unloading {
            curve: written.unloading.as_deref(),
            slope: written.unloading_slope.as_deref(),
            loading: (
                "elastic",
                written.elastic.is_some() || written.stiffness.is_some(),
            ),
            at,
            expected: [LENGTH, FORCE, STIFFNESS],
        },
    );
    let damping = resolver.coefficient(written.damping.as_ref(), at.key("damping"));
    let damping_depth = resolver.fade(
        (written.damping.as_deref(), damping.is_some()),
        (written.damping_depth.as_deref(), at.key("damping_depth")),
        (LENGTH, DAMPING_DEPTH),
    );
    let limit = written.friction.as_deref();
    let friction = resolver.friction(
        limit,
        written.friction_speed.as_deref(),
        at,
        (FRICTION, SPEED, FRICTION_SPEED),
    );
    let displacement = written.friction_displacement.as_deref();
    let bristle = resolver.bristle((limit, friction.is_some()), displacement, at, LENGTH);
    if let (Some(first), Some(Against::Plane(flat)), Some(edge)) =
        (&ellipsoid, &mut against, &written.plane)
        && edge.edge.as_ref().is_none_or(|edge| edge.width.is_none())
        && let Some(extent) = &mut flat.extent
    {
        fade_over_depth(resolver, extent, &first.semi_axes, elastic.as_ref());
    }
    check_fading_edge(
        resolver,
        against.as_ref(),
        hysteresis.as_ref(),
        degree,
        at.key("plane").key("extent"),
    );
    let Ellipsoid {
        center,
        semi_axes,
        axes,
    } = ellipsoid?;
    Some(Contact {
        ellipsoid: center,
        semi_axes,
        axes,
        degree,
        against: against?,
        elastic,
        hysteresis,
        damping,
        damping_depth,
        friction,
        bristle,
    })
}

/// The surface that an ellipsoid of degree `of_first` meets, and the place where it is written.
fn against<'w>(
    resolver: &Resolver<'_>,
    written: &Written,
    of_first: u32,
    at: At<'w>,
) -> (Option<Against>, At<'w>) {
    match (&written.plane, &written.with) {
        (Some(written), None) => {
            let place = at.key("plane");
            (plane(resolver, written, place).map(Against::Plane), place)
        }
        (None, Some(with)) => {
            let place = at.key("with");
            let of_second = degree(resolver, with.degree.as_ref(), place.key("degree"));
            for (degree, place) in [(of_first, at.key("ellipsoid")), (of_second, place)] {
                if degree > 2 {
                    resolver.problems.add(place.key("degree").problem(
                        "ellipsoids of higher degree meet planes only",
                        "leave `degree` out, or write `plane` instead of `with`",
                    ));
                }
            }
            let second = ellipsoid(resolver, with, place);
            (second.map(Against::Ellipsoid), place)
        }
        (Some(_), Some(_)) => {
            resolver.problems.add(at.key("with").key_problem(
                "the contact is with a plane and with an ellipsoid",
                "write two contacts, one with `plane` and one with `with`",
            ));
            (None, at)
        }
        (None, None) => {
            resolver.problems.add(at.key("contact").problem(
                format!(
                    "the ellipsoid of contact {} meets nothing",
                    quoted(&written.contact)
                ),
                "add `plane: …`, or `with: …` for another ellipsoid",
            ));
            (None, at)
        }
    }
}

/// Reports a contact of two surfaces on the same body; the second is written at `place`.
fn check_bodies(
    resolver: &Resolver<'_>,
    name: &str,
    first: &Ellipsoid,
    second: &Against,
    place: At<'_>,
) {
    if first.center.on != second.place().on {
        return;
    }
    let both = match second {
        Against::Plane(_) => "the ellipsoid and the plane",
        Against::Ellipsoid(_) => "both ellipsoids",
    };
    resolver.problems.add(place.key("on").problem(
        format!("{both} of contact {} are on the same body", quoted(name)),
        "put them on two bodies; `frame` is the absolute frame",
    ));
}

/// Sets the width of a fading edge for which the user gives none to the penetration that is to be expected, but to no
/// less than [`EDGE_WIDTH`] and no more than the half-lengths. This penetration is the last point of the elastic curve,
/// or the smallest semi-axis of the ellipsoid if that is less. The push of the edge, E S'/width with S' ≤ 3/2, is then
/// at most 3/4 of the force f of the surface up to this penetration δ, if the curve of f does not bend down: its energy
/// E is at most f δ/2.
fn fade_over_depth(
    resolver: &Resolver<'_>,
    extent: &mut Extent,
    semi_axes: &[Number; 3],
    elastic: Option<&ScaledCurve>,
) {
    let EdgeRule::Fade(width) = &mut extent.rule else {
        return;
    };
    let [x, y, z] = semi_axes.clone();
    let mut depth = Number::smaller(x, z);
    if !resolver.planar {
        depth = Number::smaller(depth, y);
    }
    let Some(elastic) = elastic else {
        // without an elastic force no energy is stored, and the edge does not push
        return;
    };
    let curve = resolver.curves.get(elastic.curve).and_then(Option::as_ref);
    if let Some(curve) = curve.map(|measured| &measured.curve)
        && let (false, Some([last, _])) = (curve.is_proportional(), curve.points.last())
    {
        let last = Number::product(elastic.stretch.clone(), (*last).into());
        depth = Number::smaller(depth, last);
    }
    let negative = |number| Number::negative(number);
    let least = Number::smaller(negative(depth), negative(EDGE_WIDTH.into()));
    let halves = extent.half_lengths.iter().cloned();
    *width = halves.fold(negative(least), Number::smaller);
}

/// Reports a fading edge where the force has no energy as a function of the penetration, or its point of application
/// leaps.
fn check_fading_edge(
    resolver: &Resolver<'_>,
    against: Option<&Against>,
    hysteresis: Option<&Hysteresis>,
    degree: u32,
    place: At<'_>,
) {
    let extent = against
        .and_then(Against::plane)
        .and_then(|plane| plane.extent.as_ref());
    if !extent.is_some_and(|extent| matches!(extent.rule, EdgeRule::Fade(_))) {
        return;
    }
    if hysteresis.is_some_and(|law| law.unloading.is_some()) {
        resolver.problems.add(place.key_problem(
            "an edge that fades must know the energy that unloading gives back, which of a curve `unloading` it does not",
            "write `edge: { rule: cut }`, or `unloading_slope` alone",
        ));
    }
    if degree > 2 {
        resolver.problems.add(place.key_problem(
            "the deepest point of an ellipsoid of higher degree leaps from corner to corner, and an edge cannot fade under it",
            "write `edge: { rule: cut }`, or leave `degree` out",
        ));
    }
}
