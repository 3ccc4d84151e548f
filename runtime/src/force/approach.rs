//! How deep two ellipsoids overlap, and along which direction.
//!
//! In the unit direction n, from the first to the second, they overlap by
//!
//! φ(n) = h₁(n) + h₂(n) − n·d,   h_i = √(nᵀ Q_i n),
//!
//! with d from centre to centre and Q = R diag(a²) Rᵀ. The penetration is the smallest φ: where it is negative, the distance
//! of the two. φ is made smallest from the line of centres, downhill: with u_i = Q_i n/h_i the gap r = u₁ + u₂ − d between the
//! deepest points is φ n there, whence Newton's steps in the tangent plane of n,
//!
//! (K₁ + K₂ − φ + σ) s = −r,   K_i = (Q_i − u_i u_iᵀ)/h_i,
//!
//! σ making the matrix positive, and larger where a step went uphill (Levenberg). It is not positive of itself only where the
//! overlap is deeper than the radii of curvature; the smallest φ next to the line of centres is then found still.

use crate::{Mask, Real, Task};

/// Steps at most; two ellipsoids of any likely shape take four to eight.
const STEPS: u32 = 60;
/// A step shorter than this squared \[rad²\] leaves an error of the order of 10⁻¹⁶, and so does the derivative after one more.
/// Newton's steps square an error: for a scalar of more digits than a double one after that does for the rest of them.
const SHORT: f64 = 1e-16;
/// Longest step \[rad\].
const LONGEST: f64 = 0.5;

/// A symmetric matrix by xx, yy, zz, yz, xz, xy.
#[derive(Clone, Copy)]
struct Quadric<T>([T; 6]);

/// The search for the smallest φ, as a function of its own even where registers are wide: it is too long to be part of others.
struct Search<T> {
    both: [Quadric<T>; 2],
    between: [T; 3],
}

/// φ and what it comes from in one direction.
#[derive(Clone, Copy)]
struct Overlap<T> {
    /// φ
    depth: T,
    /// h₁, h₂
    reach: [T; 2],
    /// u₁, u₂
    furthest: [[T; 3]; 2],
}

/// \[n_x, n_y, n_z, φ\] of two ellipsoids by the matrices Q₁ and Q₂ \[m²\], each as xx, yy, zz, yz, xz, xy, and the vector d from
/// the first centre to the second \[m\].
#[expect(
    clippy::too_many_arguments,
    reason = "generated code calls functions of scalars"
)]
#[inline]
pub fn approach<T: Real>(
    xx1: T,
    yy1: T,
    zz1: T,
    yz1: T,
    xz1: T,
    xy1: T,
    xx2: T,
    yy2: T,
    zz2: T,
    yz2: T,
    xz2: T,
    xy2: T,
    dx: T,
    dy: T,
    dz: T,
) -> [T; 4] {
    T::enable(Search {
        both: [
            Quadric([xx1, yy1, zz1, yz1, xz1, xy1]),
            Quadric([xx2, yy2, zz2, yz2, xz2, xy2]),
        ],
        between: [dx, dy, dz],
    })
}

impl<T: Real> Task for Search<T> {
    type Output = [T; 4];

    #[inline(always)]
    fn run(self) -> [T; 4] {
        let Search { both, between } = self;
        let c = T::from_f64;
        let (zero, one) = (c(0.0), c(1.0));
        let squared = dot(between, between);
        let size = both[0].trace().sqrt() + both[1].trace().sqrt();
        let noise = c(1e-15) * (size + squared.max(c(1e-60)).sqrt());
        let small = c(1e-9) * size;

        // centres that coincide have no line
        let distance = squared.max(c(1e-60)).sqrt();
        let line = divided(between, distance);
        let mut n = pick(distance.lt(small), [one, zero, zero], line);
        let mut now = overlap(&both, between, n);
        let mut damping = zero;
        // known at compile time
        let fine = one.lt(one + c(1e-20)).all();
        let enough = c(if fine { 2.5 } else { 1.5 });
        // a lane that has come to its end goes no further, whatever the others do
        let mut ended = one.lt(zero);
        let mut short_steps = zero;
        for _ in 0..STEPS {
            let (axes, step, stiff) = newton(&both, between, n, &now, damping, small);
            let length = dot2(step, step);
            let limit = c(LONGEST) / length.max(c(LONGEST * LONGEST)).sqrt();
            let aside = sum(scaled(step[0], axes[0]), scaled(step[1], axes[1]));
            let moved = sum(n, scaled(limit, aside));
            let moved = scaled(one / dot(moved, moved).sqrt(), moved);
            let then = overlap(&both, between, moved);
            // uphill, by more than rounding makes of it
            let uphill = (now.depth + noise).lt(then.depth);
            let new_damping = T::select(
                uphill,
                (c(8.0) * damping).max(c(0.1) * stiff),
                // soon none, so that the last steps are Newton's
                (c(0.1) * damping - c(1e-3) * stiff).max(zero),
            );
            damping = T::select(ended, damping, new_damping);
            let stays = uphill.or(ended);
            n = pick(stays, n, moved);
            now = Overlap {
                depth: T::select(stays, now.depth, then.depth),
                reach: [
                    T::select(stays, now.reach[0], then.reach[0]),
                    T::select(stays, now.reach[1], then.reach[1]),
                ],
                furthest: [
                    pick(stays, now.furthest[0], then.furthest[0]),
                    pick(stays, now.furthest[1], then.furthest[1]),
                ],
            };
            let short = length.lt(c(SHORT));
            short_steps = T::select(short, short_steps + one, zero);
            ended = ended.or(enough.lt(short_steps));
            if ended.all() {
                break;
            }
        }
        [n[0], n[1], n[2], now.depth]
    }
}

/// Two tangents, Newton's step along them, and how stiff φ is.
#[inline(always)]
fn newton<T: Real>(
    both: &[Quadric<T>; 2],
    between: [T; 3],
    n: [T; 3],
    now: &Overlap<T>,
    damping: T,
    small: T,
) -> ([[T; 3]; 2], [T; 2], T) {
    let c = T::from_f64;
    let axes = tangents(n);
    let gap = sum(
        sum(now.furthest[0], now.furthest[1]),
        scaled(-c(1.0), between),
    );
    let aa = curved(both, now, axes[0], axes[0]) - now.depth;
    let bb = curved(both, now, axes[1], axes[1]) - now.depth;
    let ab = curved(both, now, axes[0], axes[1]);
    // the smaller eigenvalue made positive
    let (mean, half) = (c(0.5) * (aa + bb), c(0.5) * (aa - bb));
    let spread = (half * half + ab * ab + small * small).sqrt();
    let shift = damping + (small - (mean - spread)).max(c(0.0));
    let (aa, bb) = (aa + shift, bb + shift);
    let determinant = aa * bb - ab * ab;
    let (ga, gb) = (dot(axes[0], gap), dot(axes[1], gap));
    let step = [
        (ab * gb - bb * ga) / determinant,
        (ab * ga - aa * gb) / determinant,
    ];
    (axes, step, mean.abs() + spread)
}

/// aᵀ (K₁ + K₂) b
#[inline(always)]
fn curved<T: Real>(both: &[Quadric<T>; 2], now: &Overlap<T>, a: [T; 3], b: [T; 3]) -> T {
    let [u, w] = now.furthest;
    let first = (dot(a, both[0].times(b)) - dot(u, a) * dot(u, b)) / now.reach[0];
    let second = (dot(a, both[1].times(b)) - dot(w, a) * dot(w, b)) / now.reach[1];
    first + second
}

#[inline(always)]
fn overlap<T: Real>(both: &[Quadric<T>; 2], between: [T; 3], n: [T; 3]) -> Overlap<T> {
    let stretched = [both[0].times(n), both[1].times(n)];
    let reach = [dot(n, stretched[0]).sqrt(), dot(n, stretched[1]).sqrt()];
    let furthest = [
        divided(stretched[0], reach[0]),
        divided(stretched[1], reach[1]),
    ];
    Overlap {
        depth: reach[0] + reach[1] - dot(n, between),
        reach,
        furthest,
    }
}

/// Two unit vectors at right angles to a unit vector and to each other (Duff et al. 2017), without a branch.
#[inline(always)]
fn tangents<T: Real>([x, y, z]: [T; 3]) -> [[T; 3]; 2] {
    let one = T::from_f64(1.0);
    let sign = T::select(z.lt(T::from_f64(0.0)), -one, one);
    let a = -(one / (sign + z));
    let b = x * y * a;
    [
        [one + sign * x * x * a, sign * b, -(sign * x)],
        [b, sign + y * y * a, -y],
    ]
}

impl<T: Real> Quadric<T> {
    #[inline(always)]
    fn trace(&self) -> T {
        self.0[0] + self.0[1] + self.0[2]
    }

    #[inline(always)]
    fn times(&self, [x, y, z]: [T; 3]) -> [T; 3] {
        let [xx, yy, zz, yz, xz, xy] = self.0;
        [
            xx * x + xy * y + xz * z,
            xy * x + yy * y + yz * z,
            xz * x + yz * y + zz * z,
        ]
    }
}

// No closures, which nobody can ask to be inlined: each operation would be a call where registers are wide.

#[inline(always)]
fn scaled<T: Real>(by: T, [x, y, z]: [T; 3]) -> [T; 3] {
    [by * x, by * y, by * z]
}

#[inline(always)]
fn divided<T: Real>([x, y, z]: [T; 3], by: T) -> [T; 3] {
    [x / by, y / by, z / by]
}

#[inline(always)]
fn sum<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn pick<T: Real>(mask: T::Mask, a: [T; 3], b: [T; 3]) -> [T; 3] {
    [
        T::select(mask, a[0], b[0]),
        T::select(mask, a[1], b[1]),
        T::select(mask, a[2], b[2]),
    ]
}

#[inline(always)]
fn dot<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn dot2<T: Real>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests {
    use super::{approach, dot};
    use crate::test_scalars::Pair;
    use crate::{DoubleDouble, Dual, Real};

    type Vector = [f64; 3];

    /// Q of semi-axes turned about z, then x.
    fn quadric(semi: Vector, about_z: f64, about_x: f64) -> [f64; 6] {
        let ((s, c), (t, d)) = (about_z.sin_cos(), about_x.sin_cos());
        let r = [[c, -s, 0.0], [d * s, d * c, -t], [t * s, t * c, d]];
        let entry = |i: usize, j: usize| -> f64 {
            (0..3).map(|k| r[i][k] * r[j][k] * semi[k] * semi[k]).sum()
        };
        [
            entry(0, 0),
            entry(1, 1),
            entry(2, 2),
            entry(1, 2),
            entry(0, 2),
            entry(0, 1),
        ]
    }

    fn call<T: Real>(a: [T; 6], b: [T; 6], d: [T; 3]) -> [T; 4] {
        approach(
            a[0], a[1], a[2], a[3], a[4], a[5], b[0], b[1], b[2], b[3], b[4], b[5], d[0], d[1],
            d[2],
        )
    }

    fn depth(a: [f64; 6], b: [f64; 6], d: Vector, n: Vector) -> f64 {
        let reach = |q: [f64; 6]| {
            let [x, y, z] = n;
            let squares = q[0] * x * x + q[1] * y * y + q[2] * z * z;
            (squares + 2.0 * (q[3] * y * z + q[4] * x * z + q[5] * x * y)).sqrt()
        };
        reach(a) + reach(b) - dot(n, d)
    }

    fn pairs() -> Vec<([f64; 6], [f64; 6], Vector)> {
        let shapes = [
            [0.1, 0.2, 0.3],
            [0.3, 0.29, 0.05],
            [0.2, 0.2, 0.2],
            [1.0, 0.1, 0.1],
        ];
        let mut pairs = Vec::new();
        for (i, first) in shapes.into_iter().enumerate() {
            for (j, second) in shapes.into_iter().enumerate() {
                for k in 0..12 {
                    let at = |shift: f64| f64::from(k) * (1.0 + shift) + shift;
                    let a = quadric(first, at(0.3), at(0.7));
                    let b = quadric(second, at(0.1) + i as f64, at(0.9) + j as f64);
                    let line = [at(0.2).sin(), at(0.4).cos(), at(0.6).sin()];
                    let line = line.map(|x| x / dot(line, line).sqrt());
                    // apart, touching slightly, and a good deal
                    let sum = depth(a, b, [0.0; 3], line);
                    for share in [1.3, 0.97, 0.9] {
                        pairs.push((a, b, line.map(|x| share * sum * x)));
                    }
                }
            }
        }
        pairs
    }

    #[test]
    fn no_direction_overlaps_less() {
        for (a, b, d) in pairs() {
            let [x, y, z, ours] = call(a, b, d);
            let n = [x, y, z];
            assert!((dot(n, n) - 1.0).abs() <= 8.0 * f64::EPSILON);
            let size = depth(a, b, [0.0; 3], n) + dot(d, d).sqrt();
            let rounding = 16.0 * f64::EPSILON * size;
            assert!((ours - depth(a, b, d, n)).abs() <= rounding);
            // on a grid of the whole sphere, then downhill from the least of it
            let mut least = (f64::INFINITY, [0.0; 3]);
            const GRID: usize = 60;
            for i in 0..=GRID {
                let polar = core::f64::consts::PI * i as f64 / GRID as f64;
                for j in 0..2 * GRID {
                    let azimuth = core::f64::consts::PI * j as f64 / GRID as f64;
                    let n = [
                        polar.sin() * azimuth.cos(),
                        polar.sin() * azimuth.sin(),
                        polar.cos(),
                    ];
                    let found = depth(a, b, d, n);
                    if found < least.0 {
                        least = (found, n);
                    }
                }
            }
            let mut reach = 0.1;
            while reach > 1e-9 {
                let mut better = false;
                for i in 0..3 {
                    for sign in [-1.0, 1.0] {
                        let mut n = least.1;
                        n[i] += sign * reach;
                        let n = n.map(|x| x / dot(n, n).sqrt());
                        let found = depth(a, b, d, n);
                        if found < least.0 {
                            least = (found, n);
                            better = true;
                        }
                    }
                }
                if !better {
                    reach *= 0.5;
                }
            }
            assert!(
                ours <= least.0 + rounding,
                "{ours} instead of {}, {d:?}",
                least.0
            );
        }
    }

    #[test]
    fn exchanged_bodies_meet_alike() {
        for (a, b, d) in pairs() {
            let [x, y, z, ours] = call(a, b, d);
            let [u, v, w, other] = call(b, a, d.map(|x| -x));
            assert!((ours - other).abs() <= 1e-14);
            for (a, b) in [(x, u), (y, v), (z, w)] {
                // the direction is as exact as the root of the depth's rounding allows, if not better
                assert!((a + b).abs() <= 1e-7, "{a} {b}");
            }
        }
    }

    #[test]
    fn spheres_meet_on_their_line() {
        let (a, b) = (quadric([0.3; 3], 0.1, 0.2), quadric([0.2; 3], 0.5, 0.1));
        for d in [[0.3, -0.2, 0.25], [0.0, 0.0, -0.4], [1.0, 2.0, 3.0]] {
            let length = dot(d, d).sqrt();
            let [x, y, z, ours] = call(a, b, d);
            assert!((ours - (0.5 - length)).abs() <= 8.0 * f64::EPSILON * length);
            for (n, d) in [x, y, z].into_iter().zip(d) {
                assert!((n - d / length).abs() <= 8.0 * f64::EPSILON);
            }
        }
    }

    #[test]
    fn in_the_plane_nothing_leaves_it() {
        // cylinders that are long enough across
        let (a, b) = (
            [0.04, 0.3, 0.01, 0.0, 0.01, 0.0],
            [0.02, 0.3, 0.05, 0.0, -0.01, 0.0],
        );
        for angle in 0..20 {
            let (s, c) = (0.3 * f64::from(angle)).sin_cos();
            let d = [0.33 * c, 0.0, 0.33 * s];
            let [x, y, z, ours] = call(a, b, d);
            assert_eq!(y, 0.0);
            let along = |turn: f64| {
                let (s, c) = turn.sin_cos();
                depth(a, b, d, [x * c - z * s, 0.0, z * c + x * s])
            };
            assert!((-8..=8).all(|k| along(0.01 * f64::from(k)) >= ours - 1e-15));
        }
    }

    #[test]
    fn lanes_and_derivatives_pass() {
        let (a, b, d) = pairs()[7];
        let (e, f, g) = pairs()[200];
        let pack = |p: [f64; 6], q: [f64; 6]| -> [Pair; 6] {
            core::array::from_fn(|i| Pair([p[i], q[i]]))
        };
        let both = call(
            pack(a, e),
            pack(b, f),
            core::array::from_fn(|i| Pair([d[i], g[i]])),
        );
        for (lane, alone) in [call(a, b, d), call(e, f, g)].into_iter().enumerate() {
            for (both, alone) in both.iter().zip(alone) {
                assert_eq!(both.0[lane], alone);
            }
        }
        // ∂φ/∂d = −n, as n is where φ is least
        let n = call(a, b, d);
        let still = |q: [f64; 6]| q.map(Dual::constant);
        for i in 0..3 {
            let mut moving = d.map(Dual::constant);
            moving[i].slope = 1.0;
            let ours = call(still(a), still(b), moving);
            assert!((ours[3].slope + n[i]).abs() <= 1e-12);
            // and the direction turns as differences say
            let shifted = |h: f64| {
                let mut d = d;
                d[i] += h;
                call(a, b, d)
            };
            let (more, less) = (shifted(1e-5), shifted(-1e-5));
            for k in 0..3 {
                let slope = (more[k] - less[k]) / 2e-5;
                assert!((ours[k].slope - slope).abs() <= 1e-6 * (1.0 + slope.abs()));
            }
        }
    }

    /// The gap of the deepest points is φ n: the condition for the least φ, and its derivative by each component of d. `unit` bounds
    /// the relative error of an operation.
    fn the_least_is_met_to_all_digits<T: Real>(unit: f64) {
        let constant = |value: f64| Dual::constant(T::from_f64(value));
        for (a, b, d) in pairs() {
            for along in 0..3 {
                let (a, b) = (a.map(constant), b.map(constant));
                let mut d = d.map(constant);
                d[along].slope = T::from_f64(1.0);
                let [x, y, z, depth] = call(a, b, d);
                let n = [x, y, z];
                let now = super::overlap(&[super::Quadric(a), super::Quadric(b)], d, n);
                let turn = n.iter().map(|x| x.slope.to_f64().abs()).fold(0.0, f64::max);
                // n is in error by two roundings, and radii of curvature of 10 m each make of that 40 of the gap; some 16
                // roundings of lengths below 4 m come to that; derivatives move by what n moves
                let bound = (40.0 + 16.0 * 4.0) * unit;
                for i in 0..3 {
                    let gap = now.furthest[0][i] + now.furthest[1][i] - d[i];
                    let off = gap - depth * n[i];
                    let [value, slope] = [off.value, off.slope].map(|x| x.to_f64().abs());
                    assert!(value <= bound, "{value:e} > {bound:e}");
                    assert!(slope <= bound * (1.0 + turn), "{slope:e} > {bound:e}");
                }
                // ∂φ/∂d = −n
                let off = (depth.slope + n[along].value).to_f64().abs();
                assert!(off <= bound * (1.0 + turn), "{off:e} > {bound:e}");
            }
        }
    }

    #[test]
    fn direction_and_derivatives_have_all_digits_of_the_scalar() {
        let u = 0.5 * f64::EPSILON;
        the_least_is_met_to_all_digits::<f64>(u);
        // of a product
        the_least_is_met_to_all_digits::<DoubleDouble>(7.0 * u * u);
    }

    #[test]
    fn what_is_no_number_shows() {
        let a = quadric([0.3; 3], 0.1, 0.2);
        assert!(call(a, a, [f64::NAN, 0.1, 0.2])[3].is_nan());
    }

    #[test]
    fn a_common_centre_is_not_the_end() {
        let (a, b) = (
            quadric([0.3, 0.2, 0.1], 0.1, 0.2),
            quadric([0.2; 3], 0.5, 0.1),
        );
        let [x, y, z, ours] = call(a, b, [0.0; 3]);
        // the least there is: both reach least along the smallest axis
        assert!((dot([x, y, z], [x, y, z]) - 1.0).abs() < 1e-14 && ours.is_finite());
    }
}
