//! Airbags: an ellipsoid in space, the ellipsoids that it meets on other bodies, and its gas.

use super::keys::{Air, Airbag as Written, Inflow as WrittenInflow, Vent};
use crate::description::place::At;
use crate::diagnostic::quoted;
use crate::model::resolve::Resolver;
use crate::model::resolve::surface::ellipsoid;
use crate::model::{Curve, Dimension, Ellipsoid, Extrapolate, Number, ScaledCurve};
use serde::Serialize;

/// Air: its gas constant \[J/(kg K)\] and ratio of specific heats.
const OF_AIR: [f64; 2] = [287.0, 1.4];

/// Pressure of the standard atmosphere \[Pa\], and 20 °C as a temperature \[K\].
const AROUND: [f64; 2] = [101_325.0, 293.15];

/// Part of the volume of the full bag that gas takes up at the start, unless the bag starts full.
pub const FOLDED: f64 = 1e-3;

/// A bag of gas at one pressure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Airbag {
    /// The shape of the full bag.
    pub bag: Ellipsoid,
    /// The ellipsoids that the bag meets, on other bodies.
    pub against: Vec<Ellipsoid>,
    /// Gas that flows in.
    pub inflow: Option<Inflow>,
    /// Area of the jet that flows out: the area of the hole times its discharge coefficient \[m²\].
    pub vent: Option<Number>,
    /// Gas constant \[J/(kg K)\].
    pub constant: Number,
    /// Ratio of specific heats, more than 1.
    pub gamma: Number,
    /// Absolute pressure around the bag \[Pa\].
    pub ambient_pressure: Number,
    /// Temperature of the little gas that is in the bag before the inflow begins \[K\].
    pub ambient_temperature: Number,
    /// The gas of a bag that is full at the start; `None` for a folded bag.
    pub start: Option<Filled>,
}

/// A source of gas.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Inflow {
    /// The switch that starts the inflow: index into [`Model::switches`](crate::model::Model::switches).
    pub fire: usize,
    /// Mass flow against the time since the switch \[s\] → \[kg/s\].
    pub flow: ScaledCurve,
    /// Temperature of the gas \[K\].
    pub temperature: Number,
}

/// The gas of a full bag.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Filled {
    /// Absolute pressure \[Pa\].
    pub pressure: Number,
    /// Temperature \[K\].
    pub temperature: Number,
}

impl Airbag {
    /// The ellipsoid of the bag, and those that it meets.
    pub fn ellipsoids(&self) -> impl Iterator<Item = &Ellipsoid> {
        std::iter::once(&self.bag).chain(&self.against)
    }

    /// Like [`ellipsoids`](Self::ellipsoids), mutable.
    pub fn ellipsoids_mut(&mut self) -> impl Iterator<Item = &mut Ellipsoid> {
        std::iter::once(&mut self.bag).chain(&mut self.against)
    }
}

/// The checked form of an airbag.
pub(crate) fn airbag(resolver: &mut Resolver<'_>, written: &Written, at: At<'_>) -> Option<Airbag> {
    let name = quoted(&written.airbag);
    if resolver.dimension() == Dimension::Plane {
        resolver.problems.add(at.key("airbag").problem(
            "in the plane a bag has no volume",
            "write the scene in space: `dimension: 3`",
        ));
        return None;
    }
    let (bag, against) = ellipsoids(resolver, written, at);
    check_degrees(resolver, written, at);
    if written.inflow.is_none() && written.start.is_none() {
        resolver.problems.add(at.key("airbag").problem(
            format!("nothing fills airbag {name}"),
            "add `inflow: { fire: …, flow: …, temperature: … }`, or `start: { pressure: …, temperature: … }` for a bag that is full",
        ));
    }
    let inflow = written.inflow.as_ref();
    let inflow =
        inflow.and_then(|written_inflow| inflow_of(resolver, written_inflow, at.key("inflow")));
    // a flow that is 0 everywhere is none, and a folded bag without one does nothing
    if inflow.is_none() && written.start.is_none() {
        return None;
    }
    let vent = written.vent.as_ref();
    let vent = vent.and_then(|written| jet(resolver, written, at.key("vent")));
    let gas = written.gas.as_ref();
    let or = |number: Option<Number>, default: f64| number.unwrap_or(default.into());
    let constant = gas.and_then(|gas| gas.constant.as_ref());
    let constant = constant.map(|r| resolver.number(r, at.key("gas").key("constant")));
    let gamma = gas.and_then(|gas| gas.gamma.as_ref());
    let gamma = gamma.map(|g| resolver.number(g, at.key("gas").key("gamma")));
    let [pressure, temperature] = air(resolver, written.ambient.as_ref(), at.key("ambient"));
    let start = match &written.start {
        Some(start) => Some(filled(resolver, start, at.key("start"))?),
        None => None,
    };
    Some(Airbag {
        bag: bag?,
        against: against?,
        inflow,
        vent,
        constant: or(constant, OF_AIR[0]),
        gamma: or(gamma, OF_AIR[1]),
        ambient_pressure: or(pressure, AROUND[0]),
        ambient_temperature: or(temperature, AROUND[1]),
        start,
    })
}

/// The bag, and the ellipsoids that it meets; `None` for either if it is wrong.
fn ellipsoids(
    resolver: &Resolver<'_>,
    written: &Written,
    at: At<'_>,
) -> (Option<Ellipsoid>, Option<Vec<Ellipsoid>>) {
    let name = quoted(&written.airbag);
    let bag = ellipsoid(resolver, &written.ellipsoid, at.key("ellipsoid"));
    let list = at.key("against");
    if written.against.is_empty() {
        resolver.problems.add(list.problem(
            format!("airbag {name} meets nothing"),
            "name ellipsoids of other bodies: `against: [head, torso]`",
        ));
    }
    let mut against = Vec::new();
    for (index, other) in written.against.iter().enumerate() {
        let place = list.item(index);
        let other = ellipsoid(resolver, other, place);
        if let (Some(bag), Some(other)) = (&bag, &other)
            && bag.center.on == other.center.on
        {
            resolver.problems.add(place.key("on").problem(
                format!("airbag {name} and what it meets are on the same body"),
                "a bag pushes other bodies than that which it is fixed to",
            ));
        }
        against.push(other);
    }
    (bag, against.into_iter().collect())
}

/// Reports ellipsoids of a degree other than 2.
fn check_degrees(resolver: &Resolver<'_>, written: &Written, at: At<'_>) {
    let list = at.key("against");
    let round = std::iter::once((&written.ellipsoid, at.key("ellipsoid")));
    let others = written.against.iter().enumerate();
    for (ellipsoid, place) in round.chain(others.map(|(k, e)| (e, list.item(k)))) {
        if ellipsoid.degree.is_some() {
            resolver.problems.add(place.key("degree").key_problem(
                "a bag and what it meets are of degree 2",
                "leave `degree` out",
            ));
        }
    }
}

/// The area of the jet that flows out; `None` if it is 0.
fn jet(resolver: &Resolver<'_>, written: &Vent, at: At<'_>) -> Option<Number> {
    let area = resolver.coefficient(Some(&written.area), at.key("area"))?;
    let part = written
        .coefficient
        .as_ref()
        .map(|c| resolver.number(c, at.key("coefficient")));
    Some(match part {
        Some(part) => Number::product(area, part),
        None => area,
    })
}

/// The source of the gas; `None` where nothing flows.
fn inflow_of(resolver: &mut Resolver<'_>, written: &WrittenInflow, at: At<'_>) -> Option<Inflow> {
    let fire = resolver.switch_id(&written.fire, at.key("fire"));
    let place = at.key("flow");
    let flow = resolver.function(&written.flow, place);
    let temperature = resolver.number(&written.temperature, at.key("temperature"));
    let flow = flow?;
    let negative = |(curve, _): (&Curve, _)| {
        let last = curve.points.len() - 1;
        let falls = curve.extrapolate == Extrapolate::Linear && curve.tangent(last) < 0.0;
        falls || curve.points.iter().any(|point| point[1] < 0.0)
    };
    if resolver.curve_of(&flow).is_some_and(negative) {
        resolver.problems.add(place.problem(
            "gas flows in, and the curve is negative somewhere",
            "let no ordinate be negative, and let no line that goes on beyond the last point fall; what flows out does so through `vent`",
        ));
    }
    Some(Inflow {
        fire: fire?,
        flow,
        temperature,
    })
}

/// Pressure and temperature as written.
fn air(resolver: &Resolver<'_>, written: Option<&Air>, at: At<'_>) -> [Option<Number>; 2] {
    let pressure = written.and_then(|air| air.pressure.as_ref());
    let temperature = written.and_then(|air| air.temperature.as_ref());
    [
        pressure.map(|p| resolver.number(p, at.key("pressure"))),
        temperature.map(|t| resolver.number(t, at.key("temperature"))),
    ]
}

/// The gas of a bag that is full at the start.
fn filled(resolver: &Resolver<'_>, written: &Air, at: At<'_>) -> Option<Filled> {
    let [pressure, temperature] = air(resolver, Some(written), at);
    if pressure.is_none() || temperature.is_none() {
        resolver.problems.add(at.problem(
            "the gas of a full bag has a pressure and a temperature",
            "write `start: { pressure: 1.2 bar, temperature: 300 K }`, absolute both",
        ));
    }
    Some(Filled {
        pressure: pressure?,
        temperature: temperature?,
    })
}
