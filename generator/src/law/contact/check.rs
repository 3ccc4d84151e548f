//! What a contact is made of, and which surfaces may meet.

pub use super::keys::Contact;
use crate::description::expand::{Expander, Node};
use crate::description::short_forms::ByName;
use crate::description::surface::{Ellipsoid as WrittenEllipsoid, Plane as WrittenPlane};
use crate::diagnostic::quoted;
use crate::model::declared::{Kind, Names, NoKey, Reader};
use crate::model::part::{Field, Term, attachment, finite};
use crate::model::resolve::surface::{self, EDGE_WIDTH};
use crate::model::rule::Rule;
use crate::model::{Attachment, Body, EdgeRule, Ellipsoid, Extent, Number, Plane};
use serde::Serialize;

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

    /// Of a plane whose force fades at its edges: the half-lengths, and the width over which it fades.
    fn fading_edge(&mut self) -> Option<(&[Number], &mut Number)> {
        match self {
            Against::Plane(Plane {
                extent:
                    Some(Extent {
                        half_lengths,
                        rule: EdgeRule::Fade(width),
                    }),
                ..
            }) => Some((half_lengths, width)),
            _ => None,
        }
    }
}

/// The exponent of the ellipsoid at the key `ellipsoid`.
pub struct Degree;

impl Kind for Degree {
    type Written = NoKey;
    type Kept = u32;

    fn keep(reader: &mut Reader<'_, '_, '_>, _: &'static str) -> Option<u32> {
        let written: ByName<WrittenEllipsoid> = reader.written("ellipsoid")?;
        let at = reader.at.key("ellipsoid").key("degree");
        Some(surface::degree(
            reader.resolver,
            written.degree.as_ref(),
            at,
        ))
    }
}

/// What the ellipsoid meets: the keys `plane` and `with`, of which one is written.
pub struct OtherSurface;

impl Kind for OtherSurface {
    type Written = NoKey;
    type Kept = Against;

    fn keep(reader: &mut Reader<'_, '_, '_>, _: &'static str) -> Option<Against> {
        let plane: Option<ByName<WrittenPlane>> = reader.written("plane")?;
        let with: Option<ByName<WrittenEllipsoid>> = reader.written("with")?;
        match (plane, with) {
            (Some(plane), None) => {
                let place = reader.at.key("plane");
                surface::plane(reader.resolver, &plane, place).map(Against::Plane)
            }
            (None, Some(with)) => {
                let place = reader.at.key("with");
                let of_first = Degree::keep(reader, "degree")?;
                let of_second =
                    surface::degree(reader.resolver, with.degree.as_ref(), place.key("degree"));
                for (degree, place) in [(of_first, reader.at.key("ellipsoid")), (of_second, place)]
                {
                    if degree > 2 {
                        reader.resolver.problems.add(place.key("degree").problem(
                            "ellipsoids of higher degree meet planes only",
                            "leave `degree` out, or write `plane` instead of `with`",
                        ));
                    }
                }
                surface::ellipsoid(reader.resolver, &with, place).map(Against::Ellipsoid)
            }
            // reported by `check_surfaces`
            _ => None,
        }
    }

    fn add_fields<'a>(kept: &'a mut Against, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        match kept {
            Against::Plane(Plane {
                at,
                normal,
                tangent,
                extent,
            }) => {
                attachment(at, "plane.at", to);
                finite(normal, "plane.normal", to);
                // 0 where nothing depends on it
                if !tangent.iter().all(Number::is_zero) {
                    finite(tangent, "plane.along", to);
                }
                let ends = Term::new("edge", "plane.extent", Rule::NotNegative);
                to.push(Field::Term(ends.needs("nothing presses"), extent));
            }
            Against::Ellipsoid(second) => {
                Ellipsoid::add_fields(second, &names.of("with", "", ""), to);
            }
        }
    }

    fn add_bodies<'a>(kept: &'a mut Against, bodies: &mut Vec<&'a mut Body>) {
        bodies.push(&mut kept.place_mut().on);
    }

    fn flatten(kept: &mut Against) {
        match kept {
            Against::Plane(plane) => {
                plane.at.at[1] = Number::ZERO;
                if let Some(extent) = &mut plane.extent {
                    // of the two half-lengths, keeps the one that is seen in the plane
                    let away = plane.tangent[1].constant().is_some_and(|y| y.abs() > 0.5);
                    extent.half_lengths.remove(usize::from(!away));
                }
                plane.normal[1] = Number::ZERO;
                plane.tangent = [Number::ZERO; 3];
            }
            Against::Ellipsoid(second) => Ellipsoid::flatten(second),
        }
    }

    fn mirror(expander: &Expander<'_>, record: &mut Node, _: &str) {
        for key in ["plane", "with"] {
            record.change(key, |surface| expander.mirrored_by_name(surface));
        }
    }
}

/// Reports a contact with no surface or with two.
pub(super) fn check_surfaces(name: &str, reader: &Reader<'_, '_, '_>) {
    let problem = match (reader.has("plane"), reader.has("with")) {
        (true, true) => reader.at.key("with").key_problem(
            "the contact is with a plane and with an ellipsoid",
            "write two contacts, one with `plane` and one with `with`",
        ),
        (false, false) => reader.at.key("contact").problem(
            format!("the ellipsoid of contact {} meets nothing", quoted(name)),
            "add `plane: …`, or `with: …` for another ellipsoid",
        ),
        _ => return,
    };
    reader.resolver.problems.add(problem);
}

/// Reports a contact of two surfaces on the same body.
pub(super) fn check_bodies(reader: &Reader<'_, '_, '_>, name: &str, contact: &Contact) {
    if contact.ellipsoid.center.on != contact.against.place().on {
        return;
    }
    let (both, key) = match contact.against {
        Against::Plane(_) => ("the ellipsoid and the plane", "plane"),
        Against::Ellipsoid(_) => ("both ellipsoids", "with"),
    };
    reader
        .resolver
        .problems
        .add(reader.at.key(key).key("on").problem(
            format!("{both} of contact {} are on the same body", quoted(name)),
            "put them on two bodies; `frame` is the absolute frame",
        ));
}

/// Sets the width of a fading edge, if the user gives none, to the penetration that is to be expected, but to no
/// less than [`EDGE_WIDTH`] and no more than the half-lengths. This penetration is the last point of the elastic curve,
/// or the smallest semi-axis of the ellipsoid if that is less. The push of the edge, E S'/width with S' ≤ 3/2, is then
/// at most 3/4 of the force f of the surface up to this penetration δ, if the curve of f does not bend down: its energy
/// E is at most f δ/2.
pub(super) fn fade_over_depth(reader: &Reader<'_, '_, '_>, contact: &mut Contact) {
    let plane = reader.at.node.get("plane");
    let edge = plane.and_then(|plane| plane.get("edge"));
    let given = edge.is_some_and(|edge| edge.get("width").is_some());
    let Some((half_lengths, width)) = contact.against.fading_edge().filter(|_| !given) else {
        return;
    };
    // without an elastic force no energy is stored, and the edge does not push
    let Some(elastic) = &contact.elastic else {
        return;
    };
    let [x, y, z] = contact.ellipsoid.semi_axes.clone();
    let mut depth = Number::smaller(x, z);
    if !reader.resolver.planar {
        depth = Number::smaller(depth, y);
    }
    if let Some((curve, _)) = reader.resolver.curve_of(elastic)
        && let (false, Some([last, _])) = (curve.is_proportional(), curve.points.last())
    {
        let last = Number::product(elastic.stretch.clone(), (*last).into());
        depth = Number::smaller(depth, last);
    }
    let negative = |number| Number::negative(number);
    let least = Number::smaller(negative(depth), negative(EDGE_WIDTH.into()));
    let halves = half_lengths.iter().cloned();
    *width = halves.fold(negative(least), Number::smaller);
}

/// Reports a fading edge where the force has no energy as a function of the penetration, or its point of application
/// leaps.
pub(super) fn check_fading_edge(reader: &Reader<'_, '_, '_>, contact: &Contact) {
    let plane = contact.against.plane();
    let extent = plane.and_then(|plane| plane.extent.as_ref());
    let fades = extent.is_some_and(|extent| matches!(extent.rule, EdgeRule::Fade(_)));
    let place = reader.at.key("plane").key("extent");
    let law = contact.hysteresis.as_ref();
    if fades && law.is_some_and(|law| law.unloading.is_some()) {
        reader.resolver.problems.add(place.key_problem(
            "an edge that fades must know the energy that unloading gives back, which of a curve `unloading` it does not",
            "write `edge: { rule: cut }`, or `unloading_slope` alone",
        ));
    }
    if fades && contact.degree > 2 {
        reader.resolver.problems.add(place.key_problem(
            "the deepest point of an ellipsoid of higher degree leaps from corner to corner, and an edge cannot fade under it",
            "write `edge: { rule: cut }`, or leave `degree` out",
        ));
    }
}
