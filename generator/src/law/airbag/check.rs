//! What an airbag is made of: the ellipsoids that it meets on other bodies, and what flows in and out.

use super::keys::Vent;
pub use super::keys::{Airbag, Ambient, Filled, Gas, Inflow};
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::declared::{Condition, Kind, Names, Reader};
use crate::model::part::{Field, Term};
use crate::model::resolve::Resolver;
use crate::model::rule::Rule;
use crate::model::{Curve, Dimension, Ellipsoid, Extrapolate, Number, ScaledCurve};

/// Part of the volume of the full bag that gas takes up at the start, unless the bag starts full.
pub const FOLDED: f64 = 1e-3;

impl Airbag {
    /// The ellipsoid of the bag, and those that it meets.
    pub fn ellipsoids(&self) -> impl Iterator<Item = &Ellipsoid> {
        std::iter::once(&self.ellipsoid).chain(&self.against)
    }

    /// Like [`ellipsoids`](Self::ellipsoids), mutable.
    pub fn ellipsoids_mut(&mut self) -> impl Iterator<Item = &mut Ellipsoid> {
        std::iter::once(&mut self.ellipsoid).chain(&mut self.against)
    }
}

/// Reports a bag in the plane, one that nothing fills or that meets nothing, and ellipsoids of a degree other than 2.
pub(super) fn check_keys(name: &str, reader: &Reader<'_, '_, '_>) {
    let (at, problems) = (reader.at, &reader.resolver.problems);
    let name = quoted(name);
    if reader.resolver.dimension() == Dimension::Plane {
        problems.add(at.key("airbag").problem(
            "in the plane a bag has no volume",
            "write the scene in space: `dimension: 3`",
        ));
    }
    if !reader.has("inflow") && !reader.has("start") {
        problems.add(at.key("airbag").problem(
            format!("nothing fills airbag {name}"),
            "add `inflow: { fire: …, flow: …, temperature: … }`, or `start: { pressure: …, temperature: … }` for a bag that is full",
        ));
    }
    let list = at.key("against");
    let others = list.node.items();
    if others.is_empty() {
        problems.add(list.problem(
            format!("airbag {name} meets nothing"),
            "name ellipsoids of other bodies: `against: [head, torso]`",
        ));
    }
    let others = (0..others.len()).map(|index| list.item(index));
    for place in std::iter::once(at.key("ellipsoid")).chain(others) {
        if place.node.get("degree").is_some() {
            problems.add(place.key("degree").key_problem(
                "a bag and what it meets are of degree 2",
                "leave `degree` out",
            ));
        }
    }
}

/// Reports a bag that meets its own body.
pub(super) fn check_bodies(airbag: &Airbag, name: &str, reader: &Reader<'_, '_, '_>) {
    for (index, other) in airbag.against.iter().enumerate() {
        if airbag.ellipsoid.center.on == other.center.on {
            let place = reader.at.key("against").item(index).key("on");
            reader.resolver.problems.add(place.problem(
                format!(
                    "airbag {} and what it meets are on the same body",
                    quoted(name)
                ),
                "a bag pushes other bodies than that which it is fixed to",
            ));
        }
    }
}

/// A mass flow that is negative nowhere.
pub struct NeverNegative;

impl Condition<ScaledCurve> for NeverNegative {
    fn check(kept: &ScaledCurve, resolver: &Resolver<'_>, at: At<'_>) {
        let negative = |(curve, _): (&Curve, _)| {
            let last = curve.points.len() - 1;
            let falls = curve.extrapolate == Extrapolate::Linear && curve.tangent(last) < 0.0;
            falls || curve.points.iter().any(|point| point[1] < 0.0)
        };
        if resolver.curve_of(kept).is_some_and(negative) {
            resolver.problems.add(at.problem(
                "gas flows in, and the curve is negative somewhere",
                "let no ordinate be negative, and let no line that goes on beyond the last point fall; what flows out does so through `vent`",
            ));
        }
    }
}

/// Area of the jet that flows out: the area of the hole times its discharge coefficient \[m²\].
pub struct Jet;

impl Kind for Jet {
    type Written = Option<Vent>;
    type Kept = Option<Number>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Option<Number>> {
        let written: Option<Vent> = reader.written(key)?;
        let Some(Vent { area, coefficient }) = written else {
            return Some(None);
        };
        let (at, resolver) = (reader.at.key(key), &reader.resolver);
        let area = resolver.coefficient(Some(&area), at.key("area"));
        let part = coefficient.map(|c| resolver.number(&c, at.key("coefficient")));
        Some(area.map(|area| match part {
            Some(part) => Number::product(area, part),
            None => area,
        }))
    }

    fn add_fields<'a>(kept: &'a mut Self::Kept, names: &Names<'_>, to: &mut Vec<Field<'a>>) {
        let term = Term::new(names.name, "vent.area", Rule::NotNegative).needs(names.needs);
        to.push(Field::Term(term, kept));
    }
}
