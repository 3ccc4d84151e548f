//! Prescribed translations of reference joints and vehicles, by displacement, velocity or acceleration.
//!
//! The start must not contradict a curve: a displacement is measured from the start position, and its slope at the
//! start is the start velocity; a velocity curve begins with the start velocity.

use super::Resolver;
use crate::description::place::At;
use crate::description::system::Prescribed;
use crate::diagnostic::quoted;
use crate::model::{FieldComponent, Given, Interpolate, Number, ScaledCurve, Translation};

/// Largest relative difference of two values of the same velocity: numbers are written with a few digits.
const SAME: f64 = 1e-9;

/// The translation that is written at `at`. `velocity` is the start velocity, which is written at `start`, if at all;
/// the part of it that curves determine is removed.
pub(super) fn translation(
    resolver: &mut Resolver<'_>,
    written: &Prescribed,
    at: At<'_>,
    velocity: &mut [Number; 3],
    start: Option<At<'_>>,
) -> Translation {
    let still = Translation {
        given: Given::Acceleration,
        curves: [None, None, None],
        stops: None,
    };
    if written.acceleration.is_none() && written.stops.is_some() {
        resolver.problems.add(at.key("stops").key_problem(
            "`stops` is said of an acceleration, but none is given here",
            match written.count() {
                0 => "give the `acceleration` that brakes it, or remove `stops`",
                _ => {
                    "remove `stops`; a curve that ends at rest stays there with `extrapolate: hold`"
                }
            },
        ));
    }
    let stops = at.key("stops");
    let (key, given) = match written {
        Prescribed {
            displacement: Some(_),
            ..
        } => ("displacement", Given::Displacement),
        Prescribed {
            velocity: Some(_), ..
        } => ("velocity", Given::Velocity),
        Prescribed {
            acceleration: Some(_),
            ..
        } => ("acceleration", Given::Acceleration),
        _ => return still,
    };
    let at = at.key(key);
    if written.count() > 1 {
        resolver.problems.add(at.key_problem(
            "a motion is given once: by its displacement, its velocity or its acceleration",
            "keep one of the three keys; the other quantities follow from it",
        ));
        return still;
    }
    let before = resolver.problems.count();
    let components = match written {
        Prescribed {
            displacement: Some(list),
            ..
        } => resolver.components(list, at),
        Prescribed {
            velocity: Some(list),
            ..
        } => resolver.components(list, at),
        Prescribed {
            acceleration: Some(list),
            ..
        } => resolver.components(list, at),
        _ => return still,
    };
    if resolver.problems.count() > before {
        return still;
    }
    let mut curves = [None, None, None];
    for (axis, component) in components.into_iter().enumerate() {
        let index = if resolver.planar { axis / 2 } else { axis };
        let here = at.item(index);
        let begins = match given {
            Given::Displacement => begin_displaced(resolver, &component, here),
            Given::Velocity => value_at_start(resolver, &component),
            Given::Acceleration => None,
        };
        if let (Some(begins), Some(start)) = (begins, start) {
            check_start(resolver, begins, &velocity[axis], key, start.item(index));
        }
        curves[axis] = along_axis(resolver, component, given, here, &mut velocity[axis]);
    }
    let accelerated = given == Given::Acceleration && curves.iter().any(Option::is_some);
    let stops =
        (written.stops == Some(true) && accelerated).then(|| resolver.part_that_is_over(stops));
    Translation {
        given,
        curves,
        stops,
    }
}

/// The curve of the motion along an axis, if there is one. The part of `velocity` that the curve determines is removed.
fn along_axis(
    resolver: &mut Resolver<'_>,
    component: FieldComponent,
    given: Given,
    at: At<'_>,
    velocity: &mut Number,
) -> Option<ScaledCurve> {
    match (component, given) {
        (FieldComponent::Curve(curve), _) => {
            if given != Given::Acceleration {
                *velocity = Number::ZERO;
            }
            Some(curve)
        }
        (FieldComponent::Constant(speed), Given::Velocity) => {
            *velocity = speed;
            None
        }
        (FieldComponent::Constant(number), Given::Acceleration) if !number.is_zero() => {
            Some(resolver.constant_curve(at, number))
        }
        (FieldComponent::Constant(_), _) => None,
    }
}

/// The start velocity that follows from a displacement; `None` if the curve is no displacement.
fn begin_displaced(resolver: &Resolver<'_>, component: &FieldComponent, at: At<'_>) -> Option<f64> {
    let curve = match component {
        FieldComponent::Curve(curve) => curve,
        FieldComponent::Constant(number) => {
            if !number.is_zero() {
                resolver.problems.add(at.problem(
                    "a displacement is measured from the start, but this one is not 0 there",
                    "put what is constant into the start position",
                ));
            }
            return Some(0.0);
        }
    };
    if !is_smooth(
        resolver,
        curve,
        "a displacement",
        ", or give the velocity instead",
        at,
    ) {
        return None;
    }
    let (points, times) = resolver.curve_of(curve)?;
    let size = points.points.iter().fold(0.0f64, |m, p| m.max(p[1].abs()));
    let first = points.value(0.0);
    if first.is_nan() {
        resolver.problems.add(at.problem(
            "the displacement has no value at t = 0, where a run starts",
            "let the curve begin at 0, or extrapolate it otherwise",
        ));
        return None;
    }
    if first.abs() > SAME * size {
        resolver.problems.add(at.problem(
            format!(
                "a displacement is measured from the start, but this one is {} m there",
                times * first
            ),
            "let the curve be 0 at t = 0, and put what is constant into the start position",
        ));
        return None;
    }
    let stretch = curve.stretch.value(&resolver.defaults);
    Some(times / stretch * points.slope(0.0))
}

/// True if a curve has a slope everywhere; otherwise reports it, with an alternative.
pub(super) fn is_smooth(
    resolver: &Resolver<'_>,
    curve: &ScaledCurve,
    what: &str,
    instead: &str,
    at: At<'_>,
) -> bool {
    let Some((points, _)) = resolver.curve_of(curve) else {
        return false;
    };
    let smooth = points.interpolate == Interpolate::Cubic;
    if !smooth {
        resolver.problems.add(at.problem(
            format!(
                "the curve {} runs straight from point to point: as {what} its rate would jump there, and its acceleration be infinite",
                quoted(&points.name)
            ),
            format!("write `interpolate: cubic` in the curve{instead}"),
        ));
    }
    smooth
}

/// The value of a component at t = 0; `None` if the curve has no value there.
fn value_at_start(resolver: &Resolver<'_>, component: &FieldComponent) -> Option<f64> {
    match component {
        FieldComponent::Constant(number) => Some(number.value(&resolver.defaults)),
        FieldComponent::Curve(curve) => {
            let (points, times) = resolver.curve_of(curve)?;
            Some(times * points.value(0.0))
        }
    }
}

/// Reports a start velocity that differs from the one with which the prescribed motion begins.
fn check_start(resolver: &Resolver<'_>, begins: f64, velocity: &Number, key: &str, at: At<'_>) {
    let value = velocity.value(&resolver.defaults);
    let largest = begins.abs().max(value.abs());
    // false for NaN: a curve without a value at the start is no contradiction
    if (value - begins).abs() > SAME * largest {
        resolver.problems.add(at.problem(
            format!(
                "the motion starts with {value} m/s here, but with {begins} m/s by its {key}{}",
                resolver.by_default(velocity)
            ),
            format!("remove the velocity from the start; the {key} says it"),
        ));
    }
}
