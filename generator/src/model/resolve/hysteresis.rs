//! Curves of unloading: what they and the steep line between must be for the loops to close.

use super::Resolver;
use super::quantity::Expected;
use crate::description::curve::Function;
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::model::{Curve, Extrapolate, Hysteresis, Interpolate, Number, ScaledCurve};

/// The slope of the line between loading and unloading, where none is given, in steepest slopes of loading.
const STEEPNESS: f64 = 10.0;

/// A force law with hysteresis as written.
pub struct Unloading<'w> {
    /// `unloading`
    pub curve: Option<&'w Function>,
    /// `unloading_slope`
    pub slope: Option<&'w Quantity>,
    /// The key of the curve of loading, and whether it was written.
    pub loading: (&'static str, bool),
    /// Where the force stands.
    pub at: At<'w>,
    /// What a curve written in place is called.
    pub owner: String,
    /// Abscissa, ordinate and slope.
    pub expected: [Expected; 3],
}

impl Resolver<'_> {
    /// The hysteresis of a force law; `None` where nothing is written of it, or there is no loading to unload from.
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
        let unloading = written
            .curve
            .and_then(|u| self.function(u, curve_at, &written.owner, x, y));
        let slope = written
            .slope
            .and_then(|s| self.coefficient(Some(s), slope_at, of_slope));
        let loading = loading?;
        if self.problems.count() > before
            || (written.curve.is_none() && slope.is_none())
            || unloading.as_ref().is_some_and(|u| self.are_one(u, loading))
        {
            return None;
        }

        let (f, times) = self.curve_of(loading)?;
        let f = &drawn(f, loading.stretch.value(&self.defaults));
        // by the curve as it is written: factors that are parameters stay such
        let unscaled = loading.stretch.value(&self.defaults) * steepest(f, 1.0);
        let foot = value(f, 0.0);
        let default = Number::quotient(
            Number::product(
                Number::Constant(STEEPNESS * unscaled),
                loading.times.clone(),
            ),
            loading.stretch.clone(),
        );
        let mut needed = steepest(f, times);
        if let Some(unloading) = &unloading {
            let (u, of_unloading) = self.curve_of(unloading)?;
            let u = &drawn(u, unloading.stretch.value(&self.defaults));
            needed = needed.max(steepest(u, of_unloading));
            if let Some(x) = above((u, of_unloading), (f, times)) {
                self.problems.add(curve_at.problem(
                    match x {
                        Some(x) => format!("at {x} the curve of unloading lies above that of loading"),
                        None => "beyond the last points the curve of unloading lies above that of loading".to_owned(),
                    },
                    "unloading gives back at most what loading took: let its curve lie at or below the other everywhere",
                ));
            }
        }
        let given = slope.is_some();
        let slope = slope.unwrap_or(default);
        let value = slope.value(&self.defaults);
        // a slope equal to the steepest, reckoned otherwise, may be less by rounding
        if value < needed * (1.0 - 1e-12) || value <= 0.0 {
            let place = if given { slope_at } else { curve_at };
            self.problems.add(place.problem(
                format!(
                    "the line between loading and unloading has the slope {value}, but the curves are as steep as {needed}{}",
                    self.by_default(&slope)
                ),
                "give an `unloading_slope` at least as steep as both curves, or leave it out for ten times that of loading",
            ));
        }
        Some(Hysteresis {
            foot: Number::negative(Number::quotient(
                Number::product(Number::Constant(foot), loading.times.clone()),
                slope.clone(),
            )),
            unloading,
            slope,
        })
    }
}

impl Resolver<'_> {
    /// Whether two curves are one, however they are written.
    fn are_one(&self, a: &ScaledCurve, b: &ScaledCurve) -> bool {
        let shape = |curve: &ScaledCurve| {
            let (curve, _) = self.curve_of(curve)?;
            Some((&curve.points, curve.interpolate, curve.extrapolate))
        };
        a.times == b.times && a.stretch == b.stretch && shape(a) == shape(b)
    }
}

/// Straight pieces by which a smooth piece of a curve is looked at.
const PIECES: u32 = 16;

/// A curve with its abscissae stretched, smooth pieces as straight ones.
fn drawn(curve: &Curve, stretch: f64) -> Curve {
    let mut drawn = Curve {
        interpolate: Interpolate::Linear,
        ..curve.clone()
    };
    if curve.interpolate == Interpolate::Cubic {
        drawn.points = vec![curve.points[0]];
        for pair in curve.points.windows(2) {
            for piece in 1..PIECES {
                let x =
                    pair[0][0] + (pair[1][0] - pair[0][0]) * f64::from(piece) / f64::from(PIECES);
                drawn.points.push([x, curve.value(x)]);
            }
            drawn.points.push(pair[1]);
        }
    }
    for point in &mut drawn.points {
        point[0] *= stretch;
    }
    drawn
}

/// The steepest slope of a curve scaled by a factor.
fn steepest(curve: &Curve, factor: f64) -> f64 {
    let slope = |pair: &[[f64; 2]]| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
    let slopes = curve.points.windows(2).map(slope);
    slopes.fold(0.0, |most: f64, slope| most.max(slope * factor))
}

/// The value of a curve; beyond its points the outermost where it must not be left.
fn value(curve: &Curve, x: f64) -> f64 {
    let points = &curve.points;
    let last = points.len() - 1;
    let right = points.partition_point(|p| p[0] <= x);
    if curve.extrapolate != Extrapolate::Linear && (right == 0 || right > last) {
        return points[right.saturating_sub(1).min(last)][1];
    }
    let k = right.clamp(1, last) - 1;
    let [[x0, y0], [x1, y1]] = [points[k], points[k + 1]];
    y0 + (x - x0) * (y1 - y0) / (x1 - x0)
}

/// An abscissa from 0 on at which the first of two scaled curves lies above the second, or `Some(None)` where it does so
/// far out only.
fn above(upper: (&Curve, f64), lower: (&Curve, f64)) -> Option<Option<f64>> {
    let difference = |x: f64| value(upper.0, x) * upper.1 - value(lower.0, x) * lower.1;
    let size = |(curve, factor): (&Curve, f64)| {
        let sizes = curve.points.iter().map(|p| (p[1] * factor).abs());
        sizes.fold(0.0, f64::max)
    };
    let rounding = 8.0 * f64::EPSILON * (size(upper) + size(lower));
    let abscissae = |curve: &Curve| -> Vec<f64> { curve.points.iter().map(|p| p[0]).collect() };
    let mut kinks = [vec![0.0], abscissae(upper.0), abscissae(lower.0)].concat();
    kinks.retain(|x| *x >= 0.0);
    kinks.sort_by(f64::total_cmp);
    if let Some(x) = kinks.iter().find(|x| difference(**x) > rounding) {
        return Some(Some(*x));
    }
    let end = kinks[kinks.len() - 1];
    let far = 1e3 * (end + 1.0);
    (difference(far) > rounding * (far / (end + 1.0))).then_some(None)
}

#[cfg(test)]
mod tests {
    use super::{above, steepest, value};
    use crate::model::{Curve, Extrapolate, Interpolate};

    fn curve(points: &[[f64; 2]], extrapolate: Extrapolate) -> Curve {
        let (name, points) = (String::new(), points.to_vec());
        Curve {
            name,
            points,
            interpolate: Interpolate::Linear,
            extrapolate,
            told: true,
        }
    }

    #[test]
    fn curves_are_compared_wherever_either_has_a_kink() {
        let f = curve(&[[0.0, 0.0], [2.0, 2.0]], Extrapolate::Linear);
        let u = curve(&[[0.0, 0.0], [1.0, 0.2], [1.5, 1.4]], Extrapolate::Hold);
        assert_eq!(above((&u, 1.0), (&f, 1.0)), None);
        // 1.2 · 1.4 = 1.68 at 1.5
        assert_eq!(above((&u, 1.2), (&f, 1.0)), Some(Some(1.5)));
        // held at 2 while the other goes on with 2.4 per unit
        let u = curve(&[[0.0, 0.0], [1.5, 1.4], [1.6, 1.6]], Extrapolate::Linear);
        assert_eq!(above((&u, 1.0), (&f, 1.0)), Some(Some(2.0)));
        let u = curve(&[[1.9, 0.0], [2.0, 0.2]], Extrapolate::Linear);
        assert_eq!(above((&u, 1.0), (&f, 1.0)), Some(None));
    }

    #[test]
    fn the_steepest_slope_is_of_the_scaled_curve() {
        let f = curve(&[[0.0, 0.0], [2.0, 2.0], [3.0, -1.0]], Extrapolate::Hold);
        assert_eq!(steepest(&f, 2.0), 2.0);
        assert_eq!(steepest(&f, -2.0), 6.0);
    }

    #[test]
    fn a_held_curve_keeps_its_outermost_value() {
        let f = curve(&[[1.0, 1.0], [2.0, 3.0]], Extrapolate::Hold);
        assert_eq!(
            [0.0, 1.5, 2.0, 9.0].map(|x| value(&f, x)),
            [1.0, 2.0, 3.0, 3.0]
        );
        let f = curve(&[[1.0, 1.0], [2.0, 3.0]], Extrapolate::Linear);
        assert_eq!([0.0, 3.0].map(|x| value(&f, x)), [-1.0, 5.0]);
    }
}
