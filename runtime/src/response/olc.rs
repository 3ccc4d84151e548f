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
