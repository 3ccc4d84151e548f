//! The approach of two ellipsoids in space.
//!
//! Let u_i = Q_i n/h_i be the points of the bodies that are furthest along n, and r = u₁ + u₂ − d the gap between them.
//! Where φ is smallest, r = φ n. Newton's step s in the tangent plane of a unit vector n, with P = 1 − n nᵀ, is
//!
//! M s = −P r,   M = K₁ + K₂ − φ P,   K_i = (Q_i − u_i u_iᵀ)/h_i = ∂²h_i/∂n²
//!
//! M n = 0, so the inverse of M in the tangent plane is (tr(M) P − M)/m, where m is the sum of the principal minors of
//! M, the product of its two other eigenvalues (Cayley and Hamilton). The step uses M + σ P in place of M. σ makes it
//! positive definite, and is larger after a step that went uphill (Levenberg). M itself is not positive only where the
//! overlap is deeper than the radii of curvature. The search still finds the smallest φ next to the start there.

use super::{Ending, LONGEST, STEPS, at_end, unless_far};
use crate::real::by_index;
use crate::{Mask, Real, Task};

/// \[n_x, n_y, n_z, φ, p_x, p_y, p_z\] of two ellipsoids.
///
/// Q₁ and Q₂ are matrices \[m²\], each given as xx, yy, zz, yz, xz, xy. d is the vector from the first centre to the
/// second \[m\]. p is the vector from the first centre to the middle between the two points that are furthest along n
/// \[m\].
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
) -> [T; 7] {
    let both = [
        Quadric([xx1, yy1, zz1, yz1, xz1, xy1]),
        Quadric([xx2, yy2, zz2, yz2, xz2, xy2]),
    ];
    T::dispatch_apart(Search {
        both,
        between: [dx, dy, dz],
        early: None,
    })
}

/// [`approach`] for two ellipsoids that touch. If they do not touch, n is the normal of a plane between them, and −φ,
/// which is then positive, is at most their distance.
#[expect(
    clippy::too_many_arguments,
    reason = "generated code calls functions of scalars"
)]
#[inline(always)]
pub fn touch<T: Real>(
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
) -> [T; 7] {
    let both = [
        Quadric([xx1, yy1, zz1, yz1, xz1, xy1]),
        Quadric([xx2, yy2, zz2, yz2, xz2, xy2]),
    ];
    let between = [dx, dy, dz];
    let squared = dot(between, between);
    let reach = both[0].product(between).sqrt() + both[1].product(between).sqrt();
    let depth = reach - squared;
    let far = depth.lt(T::from_f64(0.0));
    let scale = T::from_f64(1.0) / squared.sqrt();
    let [x, y, z] = scaled(scale, between);
    let [px, py, pz] = scaled(T::from_f64(0.5), between);
    let apart = [x, y, z, scale * depth, px, py, pz];
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

/// A symmetric matrix, as xx, yy, zz, yz, xz, xy.
#[derive(Clone, Copy)]
pub(super) struct Quadric<T>(pub(super) [T; 6]);

/// The search for the smallest φ. It is compiled as a function of its own because it is too long to be inlined.
pub(super) struct Search<T: Real> {
    pub(super) both: [Quadric<T>; 2],
    pub(super) between: [T; 3],
    /// `Some`: a negative φ is enough, and the lanes of the mask need no result.
    pub(super) early: Option<T::Mask>,
}

/// Everything known in one direction n of any length.
#[derive(Clone, Copy)]
pub(super) struct Overlap<T> {
    /// n
    direction: [T; 3],
    /// 1/|n|
    scale: T,
    /// φ/|n|
    pub(super) depth: T,
    /// 1/h₁, 1/h₂
    bend: [T; 2],
    /// u₁, u₂
    pub(super) furthest: [[T; 3]; 2],
}

/// A step in the tangent plane.
struct Step<T> {
    along: [T; 3],
    /// Its squared length \[rad²\].
    squared: T,
    /// tr(K₁ + K₂), approximately
    stiff: T,
}

impl<T: Real> Task for Search<T> {
    type Output = [T; 7];

    #[inline(always)]
    fn run(self) -> [T; 7] {
        // a branch on a constant, decided at compile time
        match T::SLOPES {
            true => self.with_slopes(),
            false => self.found().0,
        }
    }
}

impl<T: Real> Search<T> {
    /// The result of a search on values alone, with the derivatives that one more Newton step gives it. To first order,
    /// the step's result does not depend on where the step starts, so derivatives of the direction found are not
    /// needed.
    #[inline(always)]
    fn with_slopes(self) -> [T; 7] {
        let Search {
            both,
            between,
            early,
        } = self;
        let [dx, dy, dz] = between;
        let found = T::Value::dispatch_apart(Search {
            both: [both[0].value(), both[1].value()],
            between: [dx.value(), dy.value(), dz.value()],
            early,
        });
        let [x, y, z, depth, px, py, pz] = found;
        let n = [T::of_value(x), T::of_value(y), T::of_value(z)];
        let size = both[0].trace().sqrt() + both[1].trace().sqrt();
        let small = T::from_f64(Ending::of::<T>(2).small) * size;
        let zero = T::from_f64(0.0);
        let now = overlap(&both, between, n);
        let step = newton(&both, between, &now, zero, small);
        let mut then = overlap(&both, between, sum(n, step.along));
        if early.is_some() {
            then = now.unless(T::of_value(depth).lt(zero), then);
        }
        let [nx, ny, nz, deep, qx, qy, qz] = then.result();
        [
            T::of_value(x).moving_as(nx),
            T::of_value(y).moving_as(ny),
            T::of_value(z).moving_as(nz),
            T::of_value(depth).moving_as(deep),
            T::of_value(px).moving_as(qx),
            T::of_value(py).moving_as(qy),
            T::of_value(pz).moving_as(qz),
        ]
    }

    /// The result on values alone, and the number of steps.
    #[inline(always)]
    pub(super) fn found(self) -> ([T; 7], u32) {
        let Search {
            both,
            between,
            early,
        } = self;
        let c = T::from_f64;
        let zero = c(0.0);
        let ending = Ending::of::<T>(2);
        let size = both[0].trace().sqrt() + both[1].trace().sqrt();
        let small = c(ending.small) * size;
        let squared = dot(between, between).max(c(1e-36));
        let distance = squared.sqrt();
        let noise = c(ending.noise) * (size + distance);

        let line = scaled(c(1.0) / distance, between);
        let line = pick(distance.lt(small), [c(1.0), zero, zero], line);
        let mut now = overlap(&both, between, start(&both, line));
        let mut damping = zero;
        let mut short_steps = zero;
        let mut ended = match early {
            Some(far) => far.or(now.depth.lt(zero)),
            None => zero.lt(zero),
        };
        let mut steps = 0;
        while steps < STEPS && !ended.all() {
            let step = newton(&both, between, &now, damping, small);
            let then = overlap(&both, between, moved(&now, &step));
            // whether φ increases by more than rounding
            let uphill = (now.depth + noise).lt(then.depth);
            let new_damping = T::select(
                uphill,
                (c(8.0) * damping).max(c(0.1) * step.stiff),
                // damping soon becomes 0, so the last steps are pure Newton steps
                (c(0.1) * damping - c(1e-3) * step.stiff).max(zero),
            );
            damping = T::select(ended, damping, new_damping);
            now = now.unless(uphill.or(ended), then);
            ended = ended.or(at_end(ending, step.squared, &mut short_steps));
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
fn start<T: Real>(both: &[Quadric<T>; 2], line: [T; 3]) -> [T; 3] {
    let one = T::from_f64(1.0);
    let bend = [
        one / both[0].product(line).sqrt(),
        one / both[1].product(line).sqrt(),
    ];
    let [xx, yy, zz, yz, xz, xy] = by_index(T::from_f64(0.0), |k| {
        bend[0] * both[0].0[k] + bend[1] * both[1].0[k]
    });
    let adjugate = Quadric([
        yy * zz - yz * yz,
        xx * zz - xz * xz,
        xx * yy - xy * xy,
        xz * xy - xx * yz,
        xy * yz - yy * xz,
        yz * xz - zz * xy,
    ]);
    let normal = adjugate.times(line);
    scaled(one / dot(normal, normal).sqrt(), normal)
}

#[inline(always)]
pub(super) fn overlap<T: Real>(both: &[Quadric<T>; 2], between: [T; 3], n: [T; 3]) -> Overlap<T> {
    let one = T::from_f64(1.0);
    let stretched = [both[0].times(n), both[1].times(n)];
    let squares = [dot(n, stretched[0]), dot(n, stretched[1])];
    let reach = [squares[0].sqrt(), squares[1].sqrt()];
    // 1/h, computed without waiting for h
    let bend = [reach[0] * (one / squares[0]), reach[1] * (one / squares[1])];
    let scale = one / dot(n, n).sqrt();
    Overlap {
        direction: n,
        scale,
        depth: (reach[0] + reach[1] - dot(n, between)) * scale,
        bend,
        furthest: [scaled(bend[0], stretched[0]), scaled(bend[1], stretched[1])],
    }
}

/// Newton's step.
#[inline(always)]
fn newton<T: Real>(
    both: &[Quadric<T>; 2],
    between: [T; 3],
    now: &Overlap<T>,
    damping: T,
    small: T,
) -> Step<T> {
    let c = T::from_f64;
    let (n, [u, w]) = (now.direction, now.furthest);
    let inverse = now.scale * now.scale;
    let level = now.depth * now.scale;
    let gap = [
        u[0] + w[0] - between[0],
        u[1] + w[1] - between[1],
        u[2] + w[2] - between[2],
    ];
    // P r
    let along = dot(n, gap) * inverse;
    let slope = sum(gap, scaled(-along, n));
    let stiffness = stiffness(both, now, level);
    let trace = stiffness.trace();
    let product = stiffness.minors();
    // the smaller eigenvalue is above product/trace where both are positive
    let firm = (small * trace).lt(product).and(c(0.0).lt(trace));
    let mut shift = damping;
    if !firm.all() {
        let half = c(0.5) * trace;
        let spread = (half * half - product).max(c(0.0)).sqrt();
        let missing = (small - (half - spread)).max(c(0.0));
        shift = damping + T::select(firm, c(0.0), missing);
    }
    let determinant = shift.mul_add(trace + shift, product);
    let turned = sum(stiffness.times(slope), scaled(-(trace + shift), slope));
    let step = scaled(c(1.0) / determinant, turned);
    Step {
        along: step,
        squared: dot(step, step) * inverse,
        stiff: trace.abs() + level.abs() + level.abs(),
    }
}

/// The matrix M, for n of any length.
#[inline(always)]
fn stiffness<T: Real>(both: &[Quadric<T>; 2], now: &Overlap<T>, level: T) -> Quadric<T> {
    let (n, [u, w]) = (now.direction, now.furthest);
    let (bent_u, bent_w) = (scaled(-now.bend[0], u), scaled(-now.bend[1], w));
    let lift = scaled(level * now.scale * now.scale, n);
    let (first, second) = (both[0].0, both[1].0);
    let mut m = first;
    for k in 0..6 {
        let (i, j) = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)][k];
        let shapes = now.bend[0].mul_add(first[k], now.bend[1] * second[k]);
        let shapes = bent_u[i].mul_add(u[j], bent_w[i].mul_add(w[j], shapes));
        m[k] = lift[i].mul_add(n[j], shapes);
    }
    Quadric([m[0] - level, m[1] - level, m[2] - level, m[3], m[4], m[5]])
}

/// The direction after the step, which is limited to the longest one.
#[inline(always)]
fn moved<T: Real>(now: &Overlap<T>, step: &Step<T>) -> [T; 3] {
    let longest = T::from_f64(LONGEST);
    let mut along = step.along;
    // steps that are short enough stay unchanged
    if !step.squared.lt(longest * longest).all() {
        let limit = longest / step.squared.max(longest * longest).sqrt();
        along = scaled(limit, along);
    }
    sum(now.direction, along)
}

impl<T: Real> Overlap<T> {
    /// `self` where the mask is true, `other` elsewhere.
    #[inline(always)]
    fn unless(self, mask: T::Mask, other: Self) -> Self {
        Overlap {
            direction: pick(mask, self.direction, other.direction),
            scale: T::select(mask, self.scale, other.scale),
            depth: T::select(mask, self.depth, other.depth),
            bend: [
                T::select(mask, self.bend[0], other.bend[0]),
                T::select(mask, self.bend[1], other.bend[1]),
            ],
            furthest: [
                pick(mask, self.furthest[0], other.furthest[0]),
                pick(mask, self.furthest[1], other.furthest[1]),
            ],
        }
    }

    #[inline(always)]
    fn result(&self) -> [T; 7] {
        let [x, y, z] = scaled(self.scale, self.direction);
        let half = T::from_f64(-0.5) * self.depth;
        let [px, py, pz] = sum(self.furthest[0], scaled(half, [x, y, z]));
        [x, y, z, self.depth, px, py, pz]
    }
}

impl<T: Real> Quadric<T> {
    #[inline(always)]
    fn value(&self) -> Quadric<T::Value> {
        let [xx, yy, zz, yz, xz, xy] = self.0;
        Quadric([
            xx.value(),
            yy.value(),
            zz.value(),
            yz.value(),
            xz.value(),
            xy.value(),
        ])
    }

    #[inline(always)]
    fn trace(&self) -> T {
        self.0[0] + self.0[1] + self.0[2]
    }

    /// The sum of the principal minors.
    #[inline(always)]
    fn minors(&self) -> T {
        let [xx, yy, zz, yz, xz, xy] = self.0;
        (xx * yy - xy * xy) + (xx * zz - xz * xz) + (yy * zz - yz * yz)
    }

    #[inline(always)]
    pub(super) fn times(&self, [x, y, z]: [T; 3]) -> [T; 3] {
        let [xx, yy, zz, yz, xz, xy] = self.0;
        [
            xx.mul_add(x, xy.mul_add(y, xz * z)),
            xy.mul_add(x, yy.mul_add(y, yz * z)),
            xz.mul_add(x, yz.mul_add(y, zz * z)),
        ]
    }

    /// nᵀ Q n
    #[inline(always)]
    fn product(&self, n: [T; 3]) -> T {
        dot(n, self.times(n))
    }
}

// No closures: the compiler cannot be told to inline them, and each operation on wide registers would become a call.

#[inline(always)]
fn scaled<T: Real>(by: T, [x, y, z]: [T; 3]) -> [T; 3] {
    [by * x, by * y, by * z]
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
pub(super) fn dot<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}
