//! Hysteresis: curves of unloading, and the steep line between loading and unloading.

use super::Resolver;
use crate::description::curve::NoConstant;
use crate::description::measure::Expected;
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::model::unloading;
use crate::model::{Hysteresis, Number, ScaledCurve};

/// Default slope of the line between loading and unloading, as a multiple of the steepest slope of loading.
const STEEPNESS: f64 = 10.0;

/// The keys of a force law with hysteresis, as written.
pub struct Unloading<'w> {
    /// The key `unloading`.
    pub curve: Option<&'w NoConstant>,
    /// The key `unloading_slope`.
    pub slope: Option<&'w Quantity>,
    /// The key of the loading curve, and true if it is written.
    pub loading: (&'static str, bool),
    /// Place of the force in the text.
    pub at: At<'w>,
    /// Abscissa, ordinate and slope.
    pub expected: [Expected; 3],
}

impl Resolver<'_> {
    /// The hysteresis of a force law; `None` if none is written, or there is no loading curve.
    pub fn hysteresis(
        &mut self,
        loading: Option<&ScaledCurve>,
        written: Unloading<'_>,
    ) -> Option<Hysteresis> {
        let Unloading { at, expected, .. } = written;
        let [x, y, of_slope] = expected;
        let curve_at = at.key("unloading");
        let slope_at = at.key("unloading_slope");
        if let (loading, false) = written.loading {
            for (key, place) in [("unloading", curve_at), ("unloading_slope", slope_at)] {
                if at.node.get(key).is_some() {
                    self.problems.add(place.key_problem(
                        format!("`{key}` means nothing without `{loading}`, the curve of loading"),
                        format!("add `{loading}: …`, or remove `{key}`"),
                    ));
                }
            }
        }
        let before = self.problems.count();
        let curve = written
            .curve
            .and_then(|u| self.function_in(u, curve_at, x, y));
        let slope = written
            .slope
            .and_then(|s| self.coefficient_in(Some(s), slope_at, of_slope));
        let loading = loading?;
        if self.problems.count() > before
            || (written.curve.is_none() && slope.is_none())
            || curve.as_ref().is_some_and(|u| are_one(self, u, loading))
        {
            return None;
        }

        let (f, _) = self.curve_of(loading)?;
        // computed from the curve as written: factors that are parameters remain parameters
        let steepest = unloading::steepest(f).into_iter().fold(0.0, f64::max);
        let default = Number::quotient(
            Number::product((STEEPNESS * steepest).into(), loading.times.clone()),
            loading.stretch.clone(),
        );
        let foot = unloading::value(f, 0.0);
        let slope = slope.unwrap_or(default);
        Some(Hysteresis {
            foot: Number::negative(Number::quotient(
                Number::product(Number::Constant(foot), loading.times.clone()),
                slope.clone(),
            )),
            unloading: curve,
            slope,
        })
    }
}

/// True if two curves are the same function, however they are written.
fn are_one(resolver: &Resolver<'_>, a: &ScaledCurve, b: &ScaledCurve) -> bool {
    let shape = |curve: &ScaledCurve| {
        let (curve, _) = resolver.curve_of(curve)?;
        Some((&curve.points, curve.interpolate, curve.extrapolate))
    };
    a.times == b.times && a.stretch == b.stretch && shape(a) == shape(b)
}
