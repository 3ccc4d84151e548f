//! The surfaces of a description: ellipsoids, and planes with their directions and edges.

use super::name::Style;
use super::{NOWHERE, Resolver, unit};
use crate::description::measure::Pure;
use crate::description::place::At;
use crate::description::quantity::{Number as WrittenNumber, OneOrThree};
use crate::description::surface::{
    EdgeRule as WrittenRule, Ellipsoid as WrittenEllipsoid, Plane as Written, Surface,
};
use crate::model::{Attachment, EdgeRule, Ellipsoid, Extent, Number, Plane, Shown};

/// Largest degree of an ellipsoid: its corners then have a radius of a hundredth of its size.
const MAX_DEGREE: f64 = 100.0;

/// Smallest default of the width over which a force fades at an edge \[m\].
pub(crate) const EDGE_WIDTH: f64 = 10e-3;

/// Checks a named surface, even if no contact names it.
pub(crate) fn surface(
    resolver: &Resolver<'_>,
    name: &str,
    written: &Surface,
    at: At<'_>,
) -> Option<Shown> {
    resolver.check_name(name, "a surface", Style::Either, at.on_key());
    match written {
        Surface::Ellipsoid(written) => {
            let round = ellipsoid(resolver, written, at);
            let degree = degree(resolver, written.degree.as_ref(), at.key("degree"));
            round.map(|round| Shown::Round(round, degree))
        }
        Surface::Plane(written) => plane(resolver, written, at).map(Shown::Plane),
    }
}

/// The checked form of an ellipsoid. The caller must check the degree.
pub(crate) fn ellipsoid(
    resolver: &Resolver<'_>,
    written: &WrittenEllipsoid,
    at: At<'_>,
) -> Option<Ellipsoid> {
    let center = Attachment {
        on: resolver.body(&written.on, at.key("on"))?,
        at: resolver.vector(&written.center, at.key("center")),
    };
    let semi_axes = resolver.vector(&written.semi_axes, at.key("semi_axes"));
    let axes = match &written.axes {
        Some(axes) => resolver.rotation(axes, at.key("axes")),
        None => NOWHERE,
    };
    Some(Ellipsoid {
        center,
        semi_axes,
        axes,
    })
}

/// The degree of an ellipsoid; 2 if none is written.
pub(crate) fn degree(
    resolver: &Resolver<'_>,
    written: Option<&WrittenNumber<Pure>>,
    at: At<'_>,
) -> u32 {
    let Some(quantity) = written else { return 2 };
    let (number, value) = resolver.valued(quantity, at);
    let Some(value) = value else { return 2 };
    let even = value % 2.0 == 0.0 && (2.0..=MAX_DEGREE).contains(&value);
    if number.constant().is_none() {
        resolver.problems.add(at.problem(
            "the degree depends on a parameter",
            "give a number: it decides which code is generated",
        ));
    } else if !even {
        resolver.problems.add(at.problem(
            format!("the degree of an ellipsoid is {value}"),
            format!(
                "give an even number from 2, the ellipsoid itself, to {MAX_DEGREE}, nearly a box"
            ),
        ));
    } else {
        return value as u32;
    }
    2
}

/// The checked form of a plane.
pub(crate) fn plane(resolver: &Resolver<'_>, written: &Written, at: At<'_>) -> Option<Plane> {
    let on = resolver.body(&written.on, at.key("on"));
    let point = resolver.vector(&written.at, at.key("at"));
    let normal = normal(resolver, written, at.key("normal"));
    let tangent = tangent(resolver, &normal, written, at);
    let extent = extent(resolver, written, at);
    Some(Plane {
        at: Attachment { on: on?, at: point },
        normal,
        tangent,
        extent,
    })
}

/// The normal, scaled to length 1. Its components may be lengths or pure numbers, as only their ratio matters.
fn normal(resolver: &Resolver<'_>, plane: &Written, at: At<'_>) -> [Number; 3] {
    let before = resolver.problems.count();
    let vector = resolver.vector(&plane.normal, at);
    match resolver.problems.count() > before {
        true => vector,
        false => unit(resolver, vector),
    }
}

/// In space, the direction along the plane: that of the key `along`, or the direction in the plane that is nearest to
/// an axis.
fn tangent(
    resolver: &Resolver<'_>,
    normal: &[Number; 3],
    plane: &Written,
    at: At<'_>,
) -> [Number; 3] {
    let place = at.key("along");
    if resolver.planar {
        if plane.along.is_some() {
            resolver.problems.add(place.key_problem(
                "in the plane x–z a contact plane is a line and has one direction",
                "remove `along`",
            ));
        }
        return NOWHERE;
    }
    let before = resolver.problems.count();
    let along = match &plane.along {
        Some(along) => resolver.vector(along, place),
        None => {
            let size = |axis: &usize| normal[*axis].value(&resolver.defaults).abs();
            let across = (0..3).min_by(|a, b| size(a).total_cmp(&size(b)));
            let mut axis = NOWHERE;
            axis[across.unwrap_or_default()] = Number::Constant(1.0);
            axis
        }
    };
    if resolver.problems.count() > before {
        return NOWHERE;
    }
    // a − (a·n) n
    let products = (0..3).map(|i| Number::product(along[i].clone(), normal[i].clone()));
    let part = products.fold(Number::ZERO, Number::sum);
    let tangent: [Number; 3] = std::array::from_fn(|i| {
        let normal = Number::product(part.clone(), normal[i].clone());
        Number::difference(along[i].clone(), normal)
    });
    if plane.along.is_some() {
        return unit(resolver, tangent);
    }
    // if the normal has no direction, there is none along the plane
    let squares = tangent.iter().map(|n| {
        let n = n.value(&resolver.defaults);
        n * n
    });
    match squares.sum::<f64>() > 0.0 {
        true => unit(resolver, tangent),
        false => NOWHERE,
    }
}

/// The edges of a plane.
fn extent(resolver: &Resolver<'_>, plane: &Written, at: At<'_>) -> Option<Extent> {
    let (extent_at, edge_at) = (at.key("extent"), at.key("edge"));
    let Some(written) = &plane.extent else {
        if plane.edge.is_some() {
            resolver.problems.add(edge_at.key_problem(
                "a plane without `extent` has no edge",
                "add `extent: …`, half the length of the plane, or remove `edge`",
            ));
        }
        return None;
    };
    let right = if resolver.planar { 1 } else { 2 };
    let lengths = written.each(extent_at);
    if lengths.len() != right || (resolver.planar && matches!(written, OneOrThree::List(_))) {
        resolver.problems.add(if resolver.planar {
            extent_at.problem(
                "in the plane x–z a contact plane is a line with one length",
                "give half of it, without brackets",
            )
        } else {
            extent_at.problem(
                "a plane in space has two lengths",
                "write `[a, b]`: half its length along the first tangent and along the second",
            )
        });
        return None;
    }
    let before = resolver.problems.count();
    let half_lengths: Vec<Number> = lengths
        .into_iter()
        .map(|(length, place)| resolver.number(length, place))
        .collect();
    let (rule, width) = match &plane.edge {
        Some(edge) => (edge.rule, edge.width.as_ref()),
        None => (None, None),
    };
    let width_at = edge_at.key("width");
    let rule = match (rule, width) {
        (Some(WrittenRule::Cut), Some(_)) => {
            resolver.problems.add(width_at.key_problem(
                "an edge that cuts has no width",
                "remove `width`, or write `rule: fade`",
            ));
            EdgeRule::Cut
        }
        (Some(WrittenRule::Cut), None) => EdgeRule::Cut,
        (_, None) => {
            let narrow = |width, half: &Number| Number::smaller(width, half.clone());
            EdgeRule::Fade(half_lengths.iter().fold(EDGE_WIDTH.into(), narrow))
        }
        (_, Some(width)) => EdgeRule::Fade(resolver.number(width, width_at)),
    };
    (resolver.problems.count() == before).then_some(Extent { half_lengths, rule })
}
