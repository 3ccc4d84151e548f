//! Vehicles: bodies with prescribed motion, and the reference joints that ride on them.

use super::name::Style;
use super::translation::{is_smooth, translation};
use super::{NOWHERE, Resolver};
use crate::description::measure::ANGLE;
use crate::description::place::At;
use crate::description::vehicle::Vehicle as Written;
use crate::diagnostic::{quoted, suggestion};
use crate::model::{FieldComponent, Number, Vehicle};

/// The checked form of a vehicle; `None` if there is another of the same name. A wrong vehicle is returned too, so that
/// its uses are not reported as well.
pub(super) fn vehicle(
    resolver: &mut Resolver<'_>,
    written: &Written,
    at: At<'_>,
) -> Option<Vehicle> {
    let place = at.key("name");
    let earlier = resolver.vehicles.iter().map(|v| v.name.as_str());
    let unique = resolver.check_unique(&written.name, "vehicles", earlier, place);
    if written.name == "frame" {
        resolver.problems.add(place.problem(
            "\"frame\" is the absolute frame and cannot be the name of a vehicle",
            "use another name",
        ));
    }
    resolver.check_name(&written.name, "a vehicle", Style::Either, place);
    let (mut position, mut velocity, mut start) = (NOWHERE, NOWHERE, None);
    if let Some(given) = &written.start {
        let here = at.key("start");
        if let Some(written) = &given.position {
            position = resolver.vector(written, here.key("position"));
        }
        if let Some(written) = &given.velocity {
            velocity = resolver.vector(written, here.key("velocity"));
            start = Some(here.key("velocity"));
        }
    }
    resolver.owner = format!("vehicle {}", written.name);
    let at = at.base();
    let translation = translation(resolver, &written.translation, at, &mut velocity, start);
    let mut angles = [0; 3].map(|_| FieldComponent::Constant(Number::ZERO));
    let mut angles_at_start = NOWHERE;
    if let Some(written) = &written.angles {
        for (axis, function, here) in resolver.about_axes(written, at.key("angles"), ANGLE) {
            let angle = resolver.component(function, here);
            angles_at_start[axis] = angle_at_start(resolver, &angle, here);
            angles[axis] = angle;
        }
    }
    if !unique {
        return None;
    }
    let vehicle = Vehicle {
        name: written.name.clone(),
        position,
        velocity,
        translation,
        angles,
        angles_at_start,
    };
    resolver.judge(vehicle.requirements(), at);
    Some(vehicle)
}

/// An angle at t = 0. Its curve must have a slope everywhere. 0 after a reported problem.
fn angle_at_start(resolver: &Resolver<'_>, angle: &FieldComponent, at: At<'_>) -> Number {
    let curve = match angle {
        FieldComponent::Constant(number) => return number.clone(),
        FieldComponent::Curve(curve) => curve,
    };
    if !is_smooth(resolver, curve, "an angle", "", at) {
        return Number::ZERO;
    }
    let Some((points, _)) = resolver.curve_of(curve) else {
        return Number::ZERO;
    };
    let value = points.value(0.0);
    if value.is_nan() {
        resolver.problems.add(at.problem(
            "the angle has no value at t = 0, where a run starts",
            "let the curve begin at 0, or extrapolate it otherwise",
        ));
        return Number::ZERO;
    }
    Number::product(curve.times.clone(), value.into())
}

/// Index of the vehicle with this name; reports if there is none.
pub(super) fn vehicle_named(resolver: &Resolver<'_>, name: &str, at: At<'_>) -> Option<usize> {
    let found = resolver.vehicles.iter().position(|v| v.name == name);
    if found.is_none() {
        let names = resolver.vehicles.iter().map(|v| v.name.as_str());
        let help = suggestion(name, names, "declare it under `vehicles`");
        resolver
            .problems
            .add(at.problem(format!("there is no vehicle {}", quoted(name)), help));
    }
    found
}

/// The position of a point of a vehicle at t = 0, absolute frame.
pub(super) fn ridden_at_start(
    resolver: &Resolver<'_>,
    vehicle: usize,
    at: &[Number; 3],
) -> [Number; 3] {
    let vehicle = &resolver.vehicles[vehicle];
    let turned = turned(&vehicle.angles_at_start, at);
    std::array::from_fn(|i| Number::sum(vehicle.position[i].clone(), turned[i].clone()))
}

/// Rx(φ₁) Ry(φ₂) Rz(φ₃) v, computed from right to left.
fn turned(angles: &[Number; 3], v: &[Number; 3]) -> [Number; 3] {
    let mut v = v.clone();
    for axis in [2, 1, 0] {
        let (s, c) = (
            Number::sine(angles[axis].clone()),
            Number::cosine(angles[axis].clone()),
        );
        // (a, b) → (a c − b s, a s + b c), where a and b are the components along the two axes that follow `axis`
        let [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
        let part = |x: &Number, factor: &Number| Number::product(x.clone(), factor.clone());
        (v[a], v[b]) = (
            Number::difference(part(&v[a], &c), part(&v[b], &s)),
            Number::sum(part(&v[a], &s), part(&v[b], &c)),
        );
    }
    v
}
