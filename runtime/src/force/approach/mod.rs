//! How deep two ellipsoids overlap, and along which direction.
//!
//! In the unit direction n, from the first to the second, they overlap by
//!
//! φ(n) = h₁(n) + h₂(n) − n·d,   h_i = √(nᵀ Q_i n),
//!
//! with d from centre to centre and Q = R diag(a²) Rᵀ; h is the support function of an ellipsoid, and h₁ + h₂ that of the Minkowski
//! sum of the first and the mirrored second. The penetration is the smallest φ: where it is negative, the distance of the two. n is
//! found downhill ([`space`], [`plane`]), of a length that does not matter: φ is homogeneous of degree 1.
//!
//! **Far.** Each n with φ(n) < 0 is the normal of a plane between the two bodies (separating axis theorem), and −φ(n) is at most their
//! distance. `touch` ends at the first such n that it meets, before all others the line of centres, which takes three roots and no
//! iteration. `approach` goes on to the smallest φ in any case. A force is 0 in both cases; a distance or a function whose change of sign
//! is looked for is asked of `approach`.
//!
//! **Start.** For any ratio p the ellipsoid of the matrix (1 + 1/p) Q₁ + (1 + p) Q₂ encloses the Minkowski sum, and with p = h₁(m)/h₂(m)
//! it touches it in the direction m (Kurzhanski and Vályi 1997, *Ellipsoidal calculus*, 2.2). The search begins with its normal where
//! the line of centres leaves it, m being that line: n ∝ (Q₁/h₁ + Q₂/h₂)⁻¹ d. Of bodies of like shape that touch, this is the
//! solution.
//!
//! **Steps.** For random shapes with semi-axes up to 1 : 6, of centres at 0.6 to 1.2 times the distance of a touch, `approach` takes 4.3 in
//! space (at most 9) and 2.9 in the plane (at most 10); up to 1 : 20 it is 4.9 (17) and 3.2 (12). `touch` takes none where the distance is
//! 1.02 times that or more, but for one pair in 30 of the longest shapes (`few_steps_are_needed` in the tests).
//!
//! Lanes that have come to their end stay as they are: none sees what the others do.

pub mod plane;
pub mod space;
#[cfg(test)]
mod tests;

use crate::{Mask, Real, Task};

/// Steps at most.
const STEPS: u32 = 60;
/// Longest step \[rad\].
const LONGEST: f64 = 0.5;

/// When a search is at its end.
#[derive(Clone, Copy)]
struct Ending {
    /// A step shorter than this, squared \[rad²\], leaves an error of the order of rounding.
    short: f64,
    /// How many of these it takes, less a half. Each brings the error to a power of itself, so a second one serves a scalar of more
    /// digits than a double.
    enough: f64,
    /// By which part of the size rounding alone makes φ larger.
    noise: f64,
    /// The part of the size below which a length counts as this: centres that are closer have no line, and no radius of curvature that is
    /// divided by is smaller.
    small: f64,
}

impl Ending {
    /// For a scalar, of an iteration with errors of the next step like the power `order`, 2 or 3, of the last one. Known when this is
    /// compiled.
    #[inline(always)]
    fn of<T: Real>(order: u32) -> Self {
        let one = T::from_f64(1.0);
        let more = |by: f64| one.lt(one + T::from_f64(by)).all();
        // an error of the square is multiplied by 20² at the tip of a body of 1 : 20, one of the third power by 20⁴
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

/// `apart` in the lanes that are far, what a search finds in the others. There is no search where all lanes are far.
#[inline(always)]
fn unless_far<T: Real, const N: usize>(
    far: T::Mask,
    apart: [T; N],
    search: impl Task<Output = [T; N]>,
) -> [T; N] {
    if far.all() {
        return apart;
    }
    let mut found = T::enable_apart(search);
    for (found, apart) in found.iter_mut().zip(apart) {
        *found = T::select(far, apart, *found);
    }
    found
}

/// Counts short steps, and says where they are enough. What is no number is at its end, too.
#[inline(always)]
fn at_end<T: Real>(ending: Ending, squared: T, short_steps: &mut T) -> T::Mask {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let long = T::from_f64(ending.short).lt(squared);
    *short_steps = T::select(long, zero, *short_steps + one);
    T::from_f64(ending.enough).lt(*short_steps)
}
