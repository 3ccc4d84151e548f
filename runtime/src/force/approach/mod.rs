//! The depth by which two ellipsoids overlap, and the direction of the overlap.
//!
//! In the unit direction n, from the first ellipsoid to the second, they overlap by
//!
//! φ(n) = h₁(n) + h₂(n) − n·d,   h_i = √(nᵀ Q_i n),
//!
//! where d is the vector from centre to centre and Q = R diag(a²) Rᵀ. h is the support function of an ellipsoid, and
//! h₁ + h₂ that of the Minkowski sum of the first and the mirrored second. The penetration is the smallest φ; where it
//! is negative, its magnitude is the distance of the two. The search goes downhill to this n ([`space`], [`plane`]).
//! The length of n does not matter: φ is homogeneous of degree 1.
//!
//! **Far.** Each n with φ(n) < 0 is the normal of a plane between the two bodies (separating axis theorem), and −φ(n)
//! is at most their distance. `touch` ends at the first such n that it meets. It tries the line of centres first, which
//! takes three roots and no iteration. `approach` always goes on to the smallest φ. A force is 0 in both cases, so it
//! calls `touch`; a distance, or a function whose change of sign matters, calls `approach`.
//!
//! **Start.** For any ratio p the ellipsoid of the matrix (1 + 1/p) Q₁ + (1 + p) Q₂ encloses the Minkowski sum. With p
//! = h₁(m)/h₂(m) it touches the sum in the direction m (Kurzhanski and Vályi 1997, *Ellipsoidal calculus*, 2.2). Let m
//! be the line of centres. The search starts with the normal of this ellipsoid at the point where m leaves it: n ∝
//! (Q₁/h₁ + Q₂/h₂)⁻¹ d. For bodies of the same shape that touch, this is the solution.
//!
//! **Steps.** Measured for random shapes with semi-axes up to 1 : 6 and centres at 0.6 to 1.2 times the distance at
//! which they touch: `approach` takes 4.3 steps in space (at most 9) and 2.9 in the plane (at most 10). Up to 1 : 20 it
//! takes 4.9 (17) and 3.2 (12). `touch` takes none at 1.02 times that distance or more, except for one pair in 30 of
//! the longest shapes (`few_steps_are_needed` in the tests).
//!
//! A lane that has finished does not change any more, so no lane depends on the others.

pub mod plane;
pub mod space;
#[cfg(test)]
mod tests;

use crate::{Mask, Real, Task};

/// Largest number of steps.
const STEPS: u32 = 60;
/// Longest step \[rad\].
const LONGEST: f64 = 0.5;

/// The rule that ends a search.
#[derive(Clone, Copy)]
struct Ending {
    /// The square of a step length \[rad²\]. After a shorter step the error is of the order of rounding.
    short: f64,
    /// The number of short steps that end the search, less a half. Each step raises the error to a power, so a second
    /// one is enough for a scalar with more digits than a double.
    enough: f64,
    /// The part of the size by which rounding alone may increase φ.
    noise: f64,
    /// The part of the size below which a length counts as too small: centres that are closer have no line of centres,
    /// and radii of curvature are at least this long where they divide.
    small: f64,
}

impl Ending {
    /// The rule for a scalar, and for an iteration that raises the error to the power `order`, 2 or 3. The compiler
    /// evaluates this function.
    #[inline(always)]
    fn of<T: Real>(order: u32) -> Self {
        let one = T::from_f64(1.0);
        let more = |by: f64| one.lt(one + T::from_f64(by)).all();
        // at the tip of a body of 1 : 20 the squared error is multiplied by 20², the third power by 20⁴
        let (double, single) = match order {
            2 => (1e-9, 1e-4),
            _ => (1e-7, 1e-3),
        };
        if !more(1e-12) {
            Ending {
                short: single * single,
                enough: 0.5,
                noise: 1e-6,
                small: 1e-5,
            }
        } else {
            Ending {
                short: double * double,
                enough: if more(1e-20) { 1.5 } else { 0.5 },
                noise: 1e-15,
                small: 1e-9,
            }
        }
    }
}

/// Returns `apart` in the lanes that are far, and the result of the search in the others. If all lanes are far, there
/// is no search.
#[inline(always)]
fn unless_far<T: Real, const N: usize>(
    far: T::Mask,
    apart: [T; N],
    search: impl Task<Output = [T; N]>,
) -> [T; N] {
    if far.all() {
        return apart;
    }
    let mut found = T::dispatch_apart(search);
    for (found, apart) in found.iter_mut().zip(apart) {
        *found = T::select(far, apart, *found);
    }
    found
}

/// Counts short steps and returns the lanes that have enough of them. A NaN counts as a short step.
#[inline(always)]
fn at_end<T: Real>(ending: Ending, squared: T, short_steps: &mut T) -> T::Mask {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let long = T::from_f64(ending.short).lt(squared);
    *short_steps = T::select(long, zero, *short_steps + one);
    T::from_f64(ending.enough).lt(*short_steps)
}
