//! The occupant load criterion of the pulse of a vehicle. An occupant flies freely until the vehicle is 65 mm behind,
//! and is then stopped by a constant deceleration over another 235 mm. That deceleration is the criterion \[Euro NCAP
//! TB 021\].
//!
//! Let u be the change of velocity of the vehicle up to a time, and s its integral. The flight ends at t₁ with s(t₁) =
//! 0.065 m. A restraint with the deceleration a gives the occupant the speed of the vehicle at t₂, with u(t₂) = a (t₂ −
//! t₁). Until then the occupant has moved forward by s(t₂) − a (t₂ − t₁)²/2 = 0.3 m. So t₂ is the first zero of s − u
//! (t − t₁)/2 − 0.3 m. Velocity is linear between samples, so s is quadratic there, and the function whose zero is t₂
//! is linear.

use crate::{Mask, Real};

/// The distance of free flight \[m\].
const FLIGHT: f64 = 0.065;
/// The whole distance that the occupant moves forward \[m\].
const WHOLE: f64 = 0.065 + 0.235;

/// OLC \[m/s²\] of the acceleration of a vehicle along its path \[m/s²\]; NaN where the pulse ends before the occupant
/// is stopped. `None` with fewer than two samples.
#[inline(always)]
pub(super) fn olc<T: Real>(samples: &[T], every: f64) -> Option<T> {
    let of = T::from_f64;
    let (zero, half) = (of(0.0), of(0.5));
    let step = of(every);
    let (first, others) = samples.split_first().filter(|(_, rest)| !rest.is_empty())?;
    // the pulse acts in the direction of the change of velocity that it causes
    let whole = samples.iter().fold(zero, |sum, a| sum + *a);
    let sign = T::select(whole.lt(zero), of(-1.0), of(1.0));
    let (mut u, mut s, mut before) = (zero, zero, *first);
    let (mut flying, mut held) = (of(1.0), of(1.0));
    let mut flight = zero;
    let mut result = of(f64::NAN);
    for (i, a) in others.iter().enumerate() {
        let (u0, s0) = (u, s);
        let gain = (before + *a) * half * step * sign;
        u = u0 + gain;
        s = (u0 + u).mul_add(half * step, s0);
        before = *a;
        let begin = of(i as f64 * every);
        let k = gain / step;
        // the flight ends within this interval, where its length is s₀ + u₀ τ + k τ²/2
        let ends = zero.lt(flying).and(s.lt(of(FLIGHT)).not());
        let rest = of(FLIGHT) - s0;
        let square = (u0 * u0 + of(2.0) * k * rest).max(zero);
        let some = zero.lt(square);
        let root = T::select(some, T::select(some, square, of(1.0)).sqrt(), zero);
        let part = of(2.0) * rest / T::select(ends, u0 + root, of(1.0));
        flight = T::select(ends, begin + part, flight);
        flying = T::select(ends, zero, flying);
        // the restraint has stopped the occupant within this interval; the remaining function is linear in τ
        let since = begin - flight;
        let open = s0 - u0 * since * half - of(WHOLE);
        let slope = (u0 - k * since) * half;
        let stops = zero
            .lt(held)
            .and(zero.lt(flying).not())
            .and(slope.mul_add(step, open).lt(zero).not());
        let part = -open / T::select(stops, slope, of(1.0));
        let lasted = T::select(stops, since + part, of(1.0));
        result = T::select(stops, k.mul_add(part, u0) / lasted, result);
        held = T::select(stops, zero, held);
    }
    Some(result)
}

#[cfg(test)]
mod tests {
    use crate::{Dual, Response, reduce};

    const EVERY: f64 = 1e-4;

    fn olc(samples: &[f64]) -> f64 {
        reduce(Response::Olc, samples, EVERY, &mut [])
    }

    /// A constant deceleration c: s = c t²/2, so t₁² = 0.13/c, and c t²/2 − c t (t − t₁)/2 = c t t₁/2 = 0.3 at t₂ = 0.6/(c t₁). With
    /// t₂/t₁ = 0.6/0.13 the criterion is c t₂/(t₂ − t₁) = c · 0.6/0.47.
    #[test]
    fn a_constant_pulse_has_the_criterion_of_the_closed_form() {
        for pulse in [-200.0, 200.0, -80.0] {
            let samples = vec![pulse; 2001];
            let exact = f64::abs(pulse) * 0.6 / 0.47;
            let found = olc(&samples);
            // velocity is linear, so only sums of 2000 terms are rounded
            assert!((found / exact - 1.0).abs() < 1e-11, "{found} {exact}");
        }
    }

    #[test]
    fn a_pulse_that_ends_too_early_has_none() {
        assert!(olc(&vec![200.0; 100]).is_nan());
        assert!(olc(&vec![0.0; 1000]).is_nan());
        assert!(olc(&[1.0]).is_nan());
    }

    /// OLC is proportional to a constant pulse.
    #[test]
    fn it_has_the_derivative_of_the_closed_form() {
        let samples = vec![
            Dual {
                value: -200.0,
                slope: -1.0
            };
            2001
        ];
        let found = reduce(Response::Olc, &samples, EVERY, &mut []);
        let error: f64 = found.slope - 0.6 / 0.47;
        assert!(error.abs() < 1e-11, "{error}");
    }
}
