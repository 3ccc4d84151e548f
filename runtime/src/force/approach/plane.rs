//! The approach of two ellipses in the plane x–z.
//!
//! Let n have the angle α, t = dn/dα, and let primes be derivatives with respect to α:
//!
//! h h' = tᵀ Q n,   h'' = ρ − h,   ρ = det Q/h³,   ρ' = −3 ρ h'/h,   φ'' = ρ₁ + ρ₂ − φ
//!
//! ρ is the radius of curvature. Halley's iteration finds the root of φ' next to the start: Δα = −φ'φ''/(φ''² −
//! φ'φ'''/2), with Δα as the tangent of an angle. It raises errors to their third power. φ' changes its sign between
//! the last n where it was negative and the last where it was positive. If a step would leave this interval, or follows
//! one that did not halve φ', the next n is the middle of the interval.

use super::{Ending, LONGEST, STEPS, at_end, unless_far};
use crate::{Mask, Real, Task};

/// \[n_x, n_z, φ, p_x, p_z\] of two ellipses.
///
/// Q₁ and Q₂ are matrices \[m²\], each given as xx, zz, xz. d is the vector from the first centre to the second \[m\].
/// p is the vector from the first centre to the middle between the two points that are furthest along n \[m\].
#[expect(
    clippy::too_many_arguments,
    reason = "generated code calls functions of scalars"
)]
#[inline]
pub fn approach<T: Real>(xx1: T, zz1: T, xz1: T, xx2: T, zz2: T, xz2: T, dx: T, dz: T) -> [T; 5] {
    T::dispatch_apart(Search {
        both: [Quadric([xx1, zz1, xz1]), Quadric([xx2, zz2, xz2])],
        between: [dx, dz],
        early: None,
    })
}

/// [`approach`] for two ellipses that touch. If they do not touch, n is the normal of a line between them, and −φ,
/// which is then positive, is at most their distance.
#[expect(
    clippy::too_many_arguments,
    reason = "generated code calls functions of scalars"
)]
#[inline(always)]
pub fn touch<T: Real>(xx1: T, zz1: T, xz1: T, xx2: T, zz2: T, xz2: T, dx: T, dz: T) -> [T; 5] {
    let both = [Quadric([xx1, zz1, xz1]), Quadric([xx2, zz2, xz2])];
    let between = [dx, dz];
    let squared = dot(between, between);
    let reach = both[0].product(between).sqrt() + both[1].product(between).sqrt();
    let depth = reach - squared;
    let far = depth.lt(T::from_f64(0.0));
    let (one, half) = (T::from_f64(1.0), T::from_f64(0.5));
    let scale = one / squared.sqrt();
    let apart = [scale * dx, scale * dz, scale * depth, half * dx, half * dz];
    unless_far(
        far,
        apart,
        Search {
            both,
            between,
            early: Some(far),
        },
    )
}

/// A symmetric matrix, as xx, zz, xz.
#[derive(Clone, Copy)]
pub(super) struct Quadric<T>(pub(super) [T; 3]);

/// The search for the smallest φ. It is compiled as a function of its own because it is too long to be inlined.
pub(super) struct Search<T: Real> {
    pub(super) both: [Quadric<T>; 2],
    pub(super) between: [T; 2],
    /// `Some`: a negative φ is enough, and the lanes of the mask need no result.
    pub(super) early: Option<T::Mask>,
}

/// Everything known in one direction n of any length. φ and its derivatives are those of a unit vector times |n|.
#[derive(Clone, Copy)]
struct Overlap<T> {
    /// n
    direction: [T; 2],
    /// n²
    squared: T,
    /// φ
    depth: T,
    /// φ'
    slope: T,
    /// φ''
    curvature: T,
    /// φ'''
    third: T,
    /// u₁ = Q₁ n/h₁
    furthest: [T; 2],
}

/// The interval in which φ' changes its sign: the last n where φ' was negative, and the last where it was positive;
/// zero until there is one.
#[derive(Clone, Copy)]
struct Bracket<T>([[T; 2]; 2]);

impl<T: Real> Task for Search<T> {
    type Output = [T; 5];

    #[inline(always)]
    fn run(self) -> [T; 5] {
        // a branch on a constant, decided at compile time
        match T::SLOPES {
            true => self.with_slopes(),
            false => self.found().0,
        }
    }
}

impl<T: Real> Search<T> {
    /// The result of a search on values alone, with the derivatives that one more step gives it. To first order, the
    /// step's result does not depend on where the step starts, so derivatives of the direction found are not needed.
    #[inline(always)]
    fn with_slopes(self) -> [T; 5] {
        let Search {
            both,
            between,
            early,
        } = self;
        let found = T::Value::dispatch_apart(Search {
            both: [both[0].value(), both[1].value()],
            between: [between[0].value(), between[1].value()],
            early,
        });
        let [x, z, depth, px, pz] = found;
        let n = [T::of_value(x), T::of_value(z)];
        let flat = [both[0].determinant(), both[1].determinant()];
        let size = both[0].trace().sqrt() + both[1].trace().sqrt();
        let small = T::from_f64(Ending::of::<T>(3).small) * size;
        let now = overlap(&both, between, flat, n);
        let mut then = overlap(&both, between, flat, turned(n, halley(&now, small)));
        if early.is_some() {
            then = now.unless(T::of_value(depth).lt(T::from_f64(0.0)), then);
        }
        let [nx, nz, deep, qx, qz] = then.result();
        [
            T::of_value(x).moving_as(nx),
            T::of_value(z).moving_as(nz),
            T::of_value(depth).moving_as(deep),
            T::of_value(px).moving_as(qx),
            T::of_value(pz).moving_as(qz),
        ]
    }

    /// The result on values alone, and the number of steps.
    #[inline(always)]
    pub(super) fn found(self) -> ([T; 5], u32) {
        let Search {
            both,
            between,
            early,
        } = self;
        let c = T::from_f64;
        let zero = c(0.0);
        let ending = Ending::of::<T>(3);
        let flat = [both[0].determinant(), both[1].determinant()];
        let size = both[0].trace().sqrt() + both[1].trace().sqrt();
        let small = c(ending.small) * size;
        let distance = dot(between, between).max(c(1e-36)).sqrt();
        let line = scaled(c(1.0) / distance, between);
        let line = pick(distance.lt(small), [c(1.0), zero], line);

        let mut now = overlap(&both, between, flat, start(&both, line));
        let mut bracket = Bracket([[zero; 2]; 2]);
        let mut before = c(f64::INFINITY);
        let mut short_steps = zero;
        let mut ended = match early {
            Some(far) => far.or(now.depth.lt(zero)),
            None => zero.lt(zero),
        };
        let mut steps = 0;
        while steps < STEPS && !ended.all() {
            bracket.narrow(&now);
            let angle = halley(&now, small);
            let at_end = at_end(ending, angle * angle, &mut short_steps);
            let steep = now.slope.abs();
            let slow = (c(0.5) * before).lt(steep).and(at_end.not());
            before = steep;
            let moved = bracket.inside(&now, angle, slow);
            let then = overlap(&both, between, flat, moved);
            now = now.unless(ended, then);
            ended = ended.or(at_end);
            if early.is_some() {
                ended = ended.or(now.depth.lt(zero));
            }
            steps += 1;
        }
        (now.result(), steps)
    }
}

/// The start of the search: (Q₁/h₁ + Q₂/h₂)⁻¹ times the unit vector of the line of centres, scaled to a unit vector.
#[inline(always)]
fn start<T: Real>(both: &[Quadric<T>; 2], line: [T; 2]) -> [T; 2] {
    let one = T::from_f64(1.0);
    let bend = [
        one / both[0].product(line).sqrt(),
        one / both[1].product(line).sqrt(),
    ];
    let [first, second] = [both[0].0, both[1].0];
    let xx = bend[0].mul_add(first[0], bend[1] * second[0]);
    let zz = bend[0].mul_add(first[1], bend[1] * second[1]);
    let xz = bend[0].mul_add(first[2], bend[1] * second[2]);
    let normal = Quadric([zz, xx, -xz]).times(line);
    scaled(one / dot(normal, normal).sqrt(), normal)
}

/// Evaluates φ and its derivatives in a direction; `flat` are det Q₁ and det Q₂.
#[inline(always)]
fn overlap<T: Real>(
    both: &[Quadric<T>; 2],
    between: [T; 2],
    flat: [T; 2],
    n: [T; 2],
) -> Overlap<T> {
    let one = T::from_f64(1.0);
    let across = [-n[1], n[0]];
    let stretched = [both[0].times(n), both[1].times(n)];
    let squares = [dot(n, stretched[0]), dot(n, stretched[1])];
    let turning = [dot(across, stretched[0]), dot(across, stretched[1])];
    let reach = [squares[0].sqrt(), squares[1].sqrt()];
    // 1/h², and 1/h computed without waiting for h
    let inverse = [one / squares[0], one / squares[1]];
    let bend = [reach[0] * inverse[0], reach[1] * inverse[1]];
    let squared = dot(n, n);
    let depth = reach[0] + reach[1] - dot(n, between);
    let slope = turning[0].mul_add(bend[0], turning[1] * bend[1]) - dot(across, between);
    let length = squared * squared;
    let radius = [
        flat[0] * bend[0] * inverse[0] * length,
        flat[1] * bend[1] * inverse[1] * length,
    ];
    let grows = [turning[0] * inverse[0], turning[1] * inverse[1]];
    let grows = radius[0].mul_add(grows[0], radius[1] * grows[1]);
    Overlap {
        direction: n,
        squared,
        depth,
        slope,
        curvature: radius[0] + radius[1] - depth,
        third: T::from_f64(-3.0).mul_add(grows, -slope),
        furthest: scaled(bend[0], stretched[0]),
    }
}

/// The tangent of the angle of Halley's step, limited to the longest step. Where φ'' is not positive the step goes
/// downhill.
#[inline(always)]
fn halley<T: Real>(now: &Overlap<T>, small: T) -> T {
    let c = T::from_f64;
    let zero = c(0.0);
    let (slope, curvature) = (now.slope, now.curvature);
    let below = curvature.mul_add(curvature, c(-0.5) * slope * now.third);
    let firm = zero.lt(curvature).and(zero.lt(below));
    let above = T::select(firm, slope * curvature, c(LONGEST) * slope);
    let below = T::select(firm, below, slope.abs().max(small));
    (-(above / below)).max(c(-LONGEST)).min(c(LONGEST))
}

/// n turned by the angle whose tangent is given.
#[inline(always)]
fn turned<T: Real>([x, z]: [T; 2], tangent: T) -> [T; 2] {
    [(-tangent).mul_add(z, x), tangent.mul_add(x, z)]
}

impl<T: Real> Bracket<T> {
    /// Narrows the interval by the current n.
    #[inline(always)]
    fn narrow(&mut self, now: &Overlap<T>) {
        let falls = now.slope.lt(T::from_f64(0.0));
        self.0 = [
            pick(falls, now.direction, self.0[0]),
            pick(falls, self.0[1], now.direction),
        ];
    }

    /// n turned by the angle whose tangent is given, or the middle of the interval.
    #[inline(always)]
    fn inside(&self, now: &Overlap<T>, tangent: T, slow: T::Mask) -> [T; 2] {
        let zero = T::from_f64(0.0);
        let falls = now.slope.lt(zero);
        let other = pick(falls, self.0[1], self.0[0]);
        let known = zero.lt(dot(other, other));
        let moved = turned(now.direction, tangent);
        // true if the new n is beyond the other end, which lies in the direction of the step
        let turn = moved[0] * other[1] - moved[1] * other[0];
        let beyond = T::select(falls, turn, -turn).lt(zero);
        let halved = known.and(slow.or(beyond));
        let half = [now.direction[0] + other[0], now.direction[1] + other[1]];
        pick(halved, half, moved)
    }
}

impl<T: Real> Overlap<T> {
    /// `self` where the mask is true, `other` elsewhere.
    #[inline(always)]
    fn unless(self, mask: T::Mask, other: Self) -> Self {
        Overlap {
            direction: pick(mask, self.direction, other.direction),
            squared: T::select(mask, self.squared, other.squared),
            depth: T::select(mask, self.depth, other.depth),
            slope: T::select(mask, self.slope, other.slope),
            curvature: T::select(mask, self.curvature, other.curvature),
            third: T::select(mask, self.third, other.third),
            furthest: pick(mask, self.furthest, other.furthest),
        }
    }

    #[inline(always)]
    fn result(&self) -> [T; 5] {
        let scale = T::from_f64(1.0) / self.squared.sqrt();
        let [x, z] = scaled(scale, self.direction);
        let depth = scale * self.depth;
        let half = T::from_f64(-0.5) * depth;
        let [px, pz] = [
            half.mul_add(x, self.furthest[0]),
            half.mul_add(z, self.furthest[1]),
        ];
        [x, z, depth, px, pz]
    }
}

impl<T: Real> Quadric<T> {
    #[inline(always)]
    fn value(&self) -> Quadric<T::Value> {
        let [xx, zz, xz] = self.0;
        Quadric([xx.value(), zz.value(), xz.value()])
    }

    #[inline(always)]
    fn trace(&self) -> T {
        self.0[0] + self.0[1]
    }

    #[inline(always)]
    fn determinant(&self) -> T {
        let [xx, zz, xz] = self.0;
        xx * zz - xz * xz
    }

    #[inline(always)]
    fn times(&self, [x, z]: [T; 2]) -> [T; 2] {
        let [xx, zz, xz] = self.0;
        [xx.mul_add(x, xz * z), xz.mul_add(x, zz * z)]
    }

    /// nᵀ Q n
    #[inline(always)]
    fn product(&self, n: [T; 2]) -> T {
        dot(n, self.times(n))
    }
}

#[inline(always)]
fn scaled<T: Real>(by: T, [x, z]: [T; 2]) -> [T; 2] {
    [by * x, by * z]
}

#[inline(always)]
fn pick<T: Real>(mask: T::Mask, a: [T; 2], b: [T; 2]) -> [T; 2] {
    [T::select(mask, a[0], b[0]), T::select(mask, a[1], b[1])]
}

#[inline(always)]
fn dot<T: Real>(a: [T; 2], b: [T; 2]) -> T {
    a[0].mul_add(b[0], a[1] * b[1])
}
