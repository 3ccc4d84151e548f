//! Steps of one length by the method of Adams and Bashforth of order 6. It uses the derivatives of the last six steps:
//! one evaluation a step.
//!
//! y⁺ = y + h Σ bⱼ fⱼ, f₀ = f(y), fⱼ = f of j steps before, b = (4277, −7923, 9982, −7298, 2877, −475) / 1440
//! \[Bashforth and Adams 1883\]
//!
//! This is the integral, over the step ahead, of the polynomial through six derivatives. It is exact where y is a
//! polynomial of degree six; otherwise the error is 19087/60480 h⁷ y⁽⁷⁾. The first five steps use Dormand & Prince's
//! method of order 8. In addition a step rounds an entry by ½ ε|y| to first order in h, and rounding errors of the
//! derivatives count Σ|bⱼ| = 23 times.

use super::{Rate, march_dop853};
use crate::real::by_index;
use crate::{Change, Model, Real, Task, Vector};

/// Number of derivatives in a step.
const ORDER: usize = 6;
/// The weights of the derivatives, the latest first, times [`OVER`].
const WEIGHTS: [f64; ORDER] = [4277.0, -7923.0, 9982.0, -7298.0, 2877.0, -475.0];
const OVER: f64 = 1440.0;

/// Takes steps as [`march()`](super::march()) does, by the method of Adams and Bashforth of order 6. Each step takes
/// one evaluation; the first five steps, which are of order 8, take 13 each.
///
/// This method is for smooth motions without stiff forces, in many steps that have to be short. Where steps may be
/// long, [`march_dop853`] takes fewer evaluations in all.
///
/// Stability: a motion that decays faster than 2/(h Σ|bⱼ|) = 0.0877/h grows instead (2.78/h by `march`). So does an
/// oscillation faster than 0.114/h (2.8/h), because another root of the recurrence leaves the unit circle. Slower
/// undamped oscillations grow by 0.8 (ωh)⁸ in a step. A kink costs the method its order for six steps.
///
/// ```
/// # use bryant_runtime::{Real, Model, integrate::march_adams};
/// fn a_tenth_of_a_second<M: Model<f64>>(model: &M) -> M::State {
///     let mut y = model.initial_state();
///     march_adams(model, 0.0, 1e-4, 1000, &mut y);
///     y
/// }
/// ```
///
/// # Panics
/// With a model that has discrete states: switches, permanent sets, the charts of Bryant angles. Derivatives from
/// before a change of them belong to another motion.
#[inline(always)]
pub fn march_adams<T: Real, M: Model<T>>(model: &M, t: T, h: T, steps: u32, y: &mut M::State) -> T {
    assert!(
        M::INFO.memory.is_empty(),
        "march_adams is for models without memory, and {} has some: take march_dop853",
        M::INFO.name
    );
    T::dispatch(MarchAdams {
        model,
        t,
        h,
        steps,
        y,
    })
}

struct MarchAdams<'a, T, M, S> {
    model: &'a M,
    t: T,
    h: T,
    steps: u32,
    y: &'a mut S,
}

impl<T: Real, M: Model<T>> Task for MarchAdams<'_, T, M, M::State> {
    type Output = T;
    #[inline(always)]
    fn run(self) -> T {
        let MarchAdams {
            model,
            t: start,
            h,
            steps,
            y,
        } = self;
        let number = T::from_f64;
        // divided here, to the precision of any scalar
        let weights = WEIGHTS.map(|weight| h * number(weight) / number(OVER));
        // the derivative of step i stands at i mod 6
        let mut rates = [*y; ORDER];
        for step in 0..steps {
            let t = number(f64::from(step)) * h + start;
            let latest = step as usize % ORDER;
            T::dispatch_apart(Rate {
                model,
                t,
                y,
                rate: &mut rates[latest],
            });
            if (step as usize) < ORDER - 1 {
                march_dop853(model, t, h, 1, y);
            } else {
                let rates = by_index(&rates[0], |j| &rates[(latest + ORDER - j) % ORDER]);
                model.normalize_changed(y, &Sum { weights, rates });
            }
        }
        number(f64::from(steps)) * h + start
    }
}

/// y + h Σ bⱼ fⱼ
struct Sum<'a, T, S> {
    /// h bⱼ
    weights: [T; ORDER],
    /// fⱼ
    rates: [&'a S; ORDER],
}

impl<T: Real, S: Vector<T>> Change<T> for Sum<'_, T, S> {
    #[inline(always)]
    fn of(&self, i: usize, y: T) -> T {
        let mut sum = T::from_f64(0.0);
        for j in (0..ORDER).rev() {
            sum = self.weights[j].mul_add(self.rates[j][i], sum);
        }
        y + sum
    }
}

#[cfg(test)]
mod tests {
    use super::{ORDER, OVER, WEIGHTS};

    /// Σ bⱼ (−j)ᵐ = ∫₀¹ tᵐ dt for all degrees m up to five, in whole numbers. For degree six it is off by 19087/60480 ·
    /// 6!.
    #[test]
    fn the_weights_integrate_polynomials() {
        for degree in 0..=6_u32 {
            let terms = WEIGHTS.iter().zip(0_i64..);
            let sum: i64 = terms.map(|(b, j)| *b as i64 * (-j).pow(degree)).sum();
            let (exact, over) = (OVER as i64, i64::from(degree) + 1);
            match degree {
                6 => assert_eq!((exact - sum * over) * 60480, 19087 * 720 * over * exact),
                _ => assert_eq!(sum * over, exact, "{degree}"),
            }
        }
    }

    /// How far the numerical solution of y' = z y departs from the circle or the decay of the exact solution, after so
    /// many steps of length 1.
    fn growth([re, im]: [f64; 2], steps: u32) -> f64 {
        let times = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
        let exact = |j: f64| {
            let (size, (sine, cosine)) = ((re * j).exp(), (im * j).sin_cos());
            [size * cosine, size * sine]
        };
        let mut y: [[f64; 2]; ORDER] = core::array::from_fn(|j| exact(-(j as f64)));
        for _ in 0..steps {
            let terms = WEIGHTS.iter().zip(&y);
            let sum = terms.fold([0.0; 2], |[a, b], (w, [c, d])| {
                [a + w / OVER * c, b + w / OVER * d]
            });
            let [a, b] = times([re, im], sum);
            let next = [y[0][0] + a, y[0][1] + b];
            y.copy_within(0..ORDER - 1, 1);
            y[0] = next;
        }
        y[0][0].hypot(y[0][1])
    }

    #[test]
    fn decays_and_swings_are_kept_up_to_the_limits_that_are_said() {
        // beyond a limit, rounding excites another root, which grows by 0.1 % a step or more: by at least e^50 in 50
        // 000 steps
        let limit = OVER * 2.0 / WEIGHTS.iter().map(|w| w.abs()).sum::<f64>();
        assert!((limit - 0.0877).abs() < 5e-5, "{limit}");
        assert!(growth([-0.99 * limit, 0.0], 50_000) < 1e-9);
        for beyond in [[-1.01 * limit, 0.0], [0.0, 0.116]] {
            let grown = growth(beyond, 50_000);
            assert!(grown.is_nan() || grown > 1e9, "{beyond:?}: {grown:e}");
        }
        for swing in [0.114, 0.1, 0.05] {
            let steps = 50_000;
            let grown = growth([0.0, swing], steps).ln() / f64::from(steps);
            // the next term is of (ωh)¹⁰: about ten times (ωh)² of this one; then the root of the sum of a rounding in
            // each step
            let told = 0.8 * swing.powi(8);
            let bound = 10.0 * swing * swing * told + f64::EPSILON;
            assert!((grown - told).abs() < bound, "{swing}: {grown:e} {told:e}");
        }
    }
}
