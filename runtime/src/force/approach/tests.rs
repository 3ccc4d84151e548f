//! Both searches, compared with dense searches, with more digits, across lanes and by their derivatives.

use super::space::{Quadric, approach, dot, overlap, touch};
use super::{plane, space};
use crate::real::lanes::{OfAnyWidth, with_width};
use crate::real::{Array2, by_index};
use crate::{DoubleDouble, Dual, Real, Several, Task, Width};

type Vector = [f64; 3];

/// Q of an ellipsoid with these semi-axes, turned about z, then about x.
fn quadric(semi: Vector, about_z: f64, about_x: f64) -> [f64; 6] {
    let ((s, c), (t, d)) = (about_z.sin_cos(), about_x.sin_cos());
    let r = [[c, -s, 0.0], [d * s, d * c, -t], [t * s, t * c, d]];
    let entry =
        |i: usize, j: usize| -> f64 { (0..3).map(|k| r[i][k] * r[j][k] * semi[k] * semi[k]).sum() };
    [
        entry(0, 0),
        entry(1, 1),
        entry(2, 2),
        entry(1, 2),
        entry(0, 2),
        entry(0, 1),
    ]
}

fn call<T: Real>(a: [T; 6], b: [T; 6], d: [T; 3]) -> [T; 7] {
    approach(
        a[0], a[1], a[2], a[3], a[4], a[5], b[0], b[1], b[2], b[3], b[4], b[5], d[0], d[1], d[2],
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
        let [x, y, z, ours, ..] = call(a, b, d);
        let n = [x, y, z];
        assert!((dot(n, n) - 1.0).abs() <= 8.0 * f64::EPSILON);
        let size = depth(a, b, [0.0; 3], n) + dot(d, d).sqrt();
        let rounding = 16.0 * f64::EPSILON * size;
        assert!((ours - depth(a, b, d, n)).abs() <= rounding);
        // on a grid of the whole sphere, then downhill from its smallest φ
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
        let [x, y, z, ours, ..] = call(a, b, d);
        let [u, v, w, other, ..] = call(b, a, d.map(|x| -x));
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
        let [x, y, z, ours, ..] = call(a, b, d);
        assert!((ours - (0.5 - length)).abs() <= 8.0 * f64::EPSILON * length);
        for (n, d) in [x, y, z].into_iter().zip(d) {
            assert!((n - d / length).abs() <= 8.0 * f64::EPSILON);
        }
    }
}

#[test]
fn lanes_and_derivatives_pass() {
    let (a, b, d) = pairs()[7];
    let (e, f, g) = pairs()[200];
    let pack = |p: [f64; 6], q: [f64; 6]| -> [Array2; 6] {
        core::array::from_fn(|i| Array2([p[i], q[i]]))
    };
    let both = call(
        pack(a, e),
        pack(b, f),
        core::array::from_fn(|i| Array2([d[i], g[i]])),
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
        // and the direction turns as finite differences say
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

/// The gap of the deepest points is φ n. This is the condition for the smallest φ; its derivative by each component of
/// d holds, too. `unit` bounds the relative error of an operation.
fn the_least_is_met_to_all_digits<T: Real>(unit: f64) {
    let constant = |value: f64| Dual::constant(T::from_f64(value));
    for (a, b, d) in pairs() {
        for along in 0..3 {
            let (a, b) = (a.map(constant), b.map(constant));
            let mut d = d.map(constant);
            d[along].slope = T::from_f64(1.0);
            let [x, y, z, depth, ..] = call(a, b, d);
            let n = [x, y, z];
            let now = overlap(&[Quadric(a), Quadric(b)], d, n);
            let turn = n.iter().map(|x| x.slope.to_f64().abs()).fold(0.0, f64::max);
            // n has an error of two roundings, and radii of curvature of 10 m each turn that into 40 of the gap. Some
            // 16 roundings of lengths below 4 m give the rest. The derivatives change by as much as n
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
    let [x, y, z, ours, ..] = call(a, b, [0.0; 3]);
    // the smallest φ: both bodies are shortest along the smallest axis
    assert!((dot([x, y, z], [x, y, z]) - 1.0).abs() < 1e-14 && ours.is_finite());
}

/// Numbers that look random, the same in each run.
struct Random(u64);

impl Random {
    /// In \[0, 1).
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn direction(&mut self) -> Vector {
        loop {
            let v: Vector = std::array::from_fn(|_| 2.0 * self.next() - 1.0);
            let squared = dot(v, v);
            if squared < 1.0 && squared > 0.01 {
                return v.map(|x| x / squared.sqrt());
            }
        }
    }

    /// Q of an ellipsoid with semi-axes between 0.3 m · ratio and 0.3 m, turned at random, in space or in the plane.
    fn shape(&mut self, ratio: f64, planar: bool) -> [f64; 6] {
        let semi: Vector = std::array::from_fn(|_| 0.3 * ratio.powf(-self.next()));
        if planar {
            let [xx, zz, xz] = self.ellipse(ratio);
            return [xx, 2.0 * (xx + zz), zz, 0.0, xz, 0.0];
        }
        let turn = [self.direction(), self.direction()];
        let first = turn[0];
        let along = dot(turn[1], first);
        let second: Vector = std::array::from_fn(|i| turn[1][i] - along * first[i]);
        let length = dot(second, second).sqrt();
        let second = second.map(|x| x / length);
        let third = [
            first[1] * second[2] - first[2] * second[1],
            first[2] * second[0] - first[0] * second[2],
            first[0] * second[1] - first[1] * second[0],
        ];
        let axes = [first, second, third];
        let entry = |i: usize, j: usize| -> f64 {
            (0..3)
                .map(|k| axes[k][i] * axes[k][j] * semi[k] * semi[k])
                .sum()
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

    fn ellipse(&mut self, ratio: f64) -> [f64; 3] {
        let [a, b] = std::array::from_fn(|_| (0.3 * ratio.powf(-self.next())).powi(2));
        let (s, c) = (std::f64::consts::TAU * self.next()).sin_cos();
        [
            a * c * c + b * s * s,
            a * s * s + b * c * c,
            (a - b) * c * s,
        ]
    }
}

/// A pair of bodies whose centres are `share` times as far apart as when they touch. If asked for, the plane y = 0 is a
/// plane of symmetry.
#[derive(Clone, Copy)]
struct Case {
    first: [f64; 6],
    second: [f64; 6],
    between: Vector,
    share: f64,
}

impl Case {
    fn space<T: Real>(&self) -> [T; 15] {
        let all = [&self.first[..], &self.second, &self.between].concat();
        std::array::from_fn(|i| T::from_f64(all[i]))
    }

    fn plane<T: Real>(&self) -> [T; 8] {
        let (a, b) = (self.first, self.second);
        let [x, _, z] = self.between;
        [a[0], a[2], a[4], b[0], b[2], b[4], x, z].map(T::from_f64)
    }

    fn least_on_a_grid(&self, planar: bool) -> (f64, Vector) {
        let mut least = (f64::INFINITY, [0.0; 3]);
        let look = |n: Vector, least: &mut (f64, Vector)| {
            let found = depth(self.first, self.second, self.between, n);
            let better = found < least.0;
            if better {
                *least = (found, n);
            }
            better
        };
        const GRID: usize = 2000;
        for i in 0..GRID {
            let part = (i as f64 + 0.5) / GRID as f64;
            let (s, c) = match planar {
                true => (std::f64::consts::TAU * part).sin_cos(),
                // a spiral
                false => (2.399_963_229_728_653 * i as f64).sin_cos(),
            };
            let z = 1.0 - 2.0 * part;
            let radius = (1.0 - z * z).sqrt();
            let n = match planar {
                true => [c, 0.0, s],
                false => [radius * c, radius * s, z],
            };
            look(n, &mut least);
        }
        let mut reach = 0.1;
        while reach > 1e-9 {
            let mut better = false;
            for i in 0..3 {
                for sign in [-1.0, 1.0] {
                    let mut n = least.1;
                    n[i] += sign * reach;
                    if planar {
                        n[1] = 0.0;
                    }
                    let n = n.map(|x| x / dot(n, n).sqrt());
                    better |= look(n, &mut least);
                }
            }
            if !better {
                reach *= 0.5;
            }
        }
        least
    }

    fn size(&self) -> f64 {
        depth(self.first, self.second, [0.0; 3], [1.0, 0.0, 0.0])
            + depth(self.first, self.second, [0.0; 3], [0.0, 0.0, 1.0])
            + dot(self.between, self.between).sqrt()
    }
}

fn cases(ratio: f64, planar: bool, shares: [f64; 2], count: usize) -> Vec<Case> {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let make = |_| {
        let (first, second) = (random.shape(ratio, planar), random.shape(ratio, planar));
        let mut line = random.direction();
        if planar {
            line[1] = 0.0;
            line = line.map(|x| x / dot(line, line).sqrt());
        }
        let at = |way: f64| line.map(|x| way * x);
        let (mut inside, mut outside) = (0.0, 2.0);
        for _ in 0..50 {
            let middle = 0.5 * (inside + outside);
            match call(first, second, at(middle))[3] > 0.0 {
                true => inside = middle,
                false => outside = middle,
            }
        }
        let share = shares[0] + (shares[1] - shares[0]) * random.next();
        Case {
            first,
            second,
            between: at(share * inside),
            share,
        }
    };
    (0..count).map(make).collect()
}

fn in_space<T: Real>(a: [T; 15], early: bool) -> [T; 7] {
    let [b, c, d, e, f, g, h, i, j, k, l, m, x, y, z] = a;
    match early {
        true => touch(b, c, d, e, f, g, h, i, j, k, l, m, x, y, z),
        false => approach(b, c, d, e, f, g, h, i, j, k, l, m, x, y, z),
    }
}

fn in_plane<T: Real>([a, b, c, d, e, f, x, z]: [T; 8], early: bool) -> [T; 5] {
    match early {
        true => plane::touch(a, b, c, d, e, f, x, z),
        false => plane::approach(a, b, c, d, e, f, x, z),
    }
}

#[test]
fn no_direction_of_a_dense_search_overlaps_less() {
    for planar in [false, true] {
        for (ratio, shares) in [
            (6.0, [1.0, 3.0]),
            (20.0, [1.0, 1.2]),
            (6.0, [0.9, 1.0]),
            (20.0, [0.95, 1.0]),
        ] {
            for case in cases(ratio, planar, shares, 60) {
                let least = case.least_on_a_grid(planar);
                let rounding = 16.0 * f64::EPSILON * case.size();
                let [.., ours, _, _, _] = in_space(case.space::<f64>(), false);
                let found = match planar {
                    true => in_plane(case.plane::<f64>(), false)[2],
                    false => ours,
                };
                assert!(
                    found <= least.0 + rounding,
                    "{found} instead of {}",
                    least.0
                );
                assert!((found - ours).abs() <= rounding);
                assert_eq!(found < 0.0, case.share > 1.0);
            }
        }
    }
}

#[test]
fn deep_in_each_other_no_direction_beside_overlaps_less() {
    for planar in [false, true] {
        for case in cases(20.0, planar, [0.0, 0.9], 300) {
            let n = match planar {
                true => {
                    let [x, z, ..] = in_plane(case.plane::<f64>(), false);
                    [x, 0.0, z]
                }
                false => {
                    let [x, y, z, ..] = in_space(case.space::<f64>(), false);
                    [x, y, z]
                }
            };
            let found = depth(case.first, case.second, case.between, n);
            let mut random = Random(7);
            for _ in 0..50 {
                let mut beside = random.direction();
                if planar {
                    beside[1] = 0.0;
                }
                let m: Vector = std::array::from_fn(|i| n[i] + 1e-3 * beside[i]);
                let m = m.map(|x| x / dot(m, m).sqrt());
                let there = depth(case.first, case.second, case.between, m);
                assert!(found <= there + 16.0 * f64::EPSILON * case.size());
            }
        }
    }
}

/// With twice the digits, the gap of the furthest points is φ n. The remaining component across n is the error of n
/// times a radius of curvature.
#[test]
fn the_direction_is_exact_for_long_shapes_too() {
    let c = DoubleDouble::from_f64;
    for planar in [false, true] {
        for shares in [[0.9, 1.0], [1.0, 1.1], [1.1, 3.0]] {
            for case in cases(20.0, planar, shares, 300) {
                let [x, y, z] = match planar {
                    true => {
                        let [x, z, ..] = in_plane(case.plane::<f64>(), false);
                        [x, 0.0, z]
                    }
                    false => {
                        let [x, y, z, ..] = in_space(case.space::<f64>(), false);
                        [x, y, z]
                    }
                };
                let both = [Quadric(case.first.map(c)), Quadric(case.second.map(c))];
                let d = case.between.map(c);
                let now = overlap(&both, d, [x, y, z].map(c));
                // the radii of curvature are at most a²/b, 6 m; n and the numbers that it is computed from are rounded
                // at 10⁻¹⁶
                let bound = 6.0 * 8.0 * f64::EPSILON + 16.0 * f64::EPSILON * case.size();
                for (i, n) in [x, y, z].into_iter().enumerate() {
                    let gap = now.furthest[0][i] + now.furthest[1][i] - d[i];
                    let off = (gap - now.depth * c(n)).to_f64().abs();
                    assert!(off <= bound, "{off:e} > {bound:e}");
                }
            }
        }
    }
}

#[test]
fn bodies_with_a_common_point_are_never_far() {
    let mut random = Random(11);
    for planar in [false, true] {
        for _ in 0..20_000 {
            let (a, b) = (random.shape(20.0, planar), random.shape(20.0, planar));
            // a point inside each body: from its centre a part of the way to the point that is furthest in some
            // direction
            let mut inside = |q: [f64; 6]| {
                let mut n = random.direction();
                if planar {
                    n[1] = 0.0;
                }
                let stretched = Quadric(q).times(n);
                let way = (1.0 - 1e-9 * random.next()) / dot(n, stretched).sqrt();
                stretched.map(|x| way * x)
            };
            let (p, q) = (inside(a), inside(b));
            let case = Case {
                first: a,
                second: b,
                between: std::array::from_fn(|i| p[i] - q[i]),
                share: 1.0,
            };
            let rounding = 8.0 * f64::EPSILON * case.size();
            let found = in_space(case.space::<f64>(), true)[3];
            assert!(found >= -rounding, "{found:e}");
            if planar {
                let found = in_plane(case.plane::<f64>(), true)[2];
                assert!(found >= -rounding, "{found:e}");
            }
        }
    }
}

#[test]
fn touching_bodies_agree_and_a_plane_separates_others() {
    for planar in [false, true] {
        for case in cases(20.0, planar, [0.7, 1.6], 2000) {
            let (all, early): (Vec<f64>, Vec<f64>) = match planar {
                true => (
                    in_plane(case.plane(), false).to_vec(),
                    in_plane(case.plane(), true).to_vec(),
                ),
                false => (
                    in_space(case.space(), false).to_vec(),
                    in_space(case.space(), true).to_vec(),
                ),
            };
            let at = if planar { 2 } else { 3 };
            if all[at] > 0.0 {
                assert_eq!(all, early);
            } else {
                let n = match planar {
                    true => [early[0], 0.0, early[1]],
                    false => [early[0], early[1], early[2]],
                };
                let there = depth(case.first, case.second, case.between, n);
                let rounding = 16.0 * f64::EPSILON * case.size();
                assert!((early[at] - there).abs() <= rounding);
                assert!(early[at] < 0.0 && all[at] <= early[at] + rounding);
                assert!((dot(n, n) - 1.0).abs() <= 8.0 * f64::EPSILON);
            }
        }
    }
}

/// Runs both searches in lanes, one case in each.
struct Beside<'a>(&'a [Case]);

/// One call.
struct Call<T: Real> {
    space: [T; 15],
    plane: [T; 8],
    early: bool,
}

impl<T: Real> Task for Call<T> {
    type Output = ([T; 7], [T; 5]);

    #[inline(always)]
    fn run(self) -> Self::Output {
        (
            in_space(self.space, self.early),
            in_plane(self.plane, self.early),
        )
    }
}

impl OfAnyWidth for Beside<'_> {
    type Output = Vec<[u64; 24]>;

    fn run<T: Several<One = f64>>(self) -> Vec<[u64; 24]> {
        let mut found = Vec::new();
        for cases in self.0.chunks(T::LANES) {
            let put = |of: &dyn Fn(&Case) -> f64| {
                let mut all = T::from_f64(0.0);
                for lane in 0..T::LANES {
                    // lanes without a case hold NaN
                    let value = cases.get(lane).map_or(f64::NAN, of);
                    all = all.with_lane(lane, value);
                }
                all
            };
            let nought = T::from_f64(0.0);
            let space = by_index(nought, |i| put(&|case| case.space::<f64>()[i]));
            let plane = by_index(nought, |i| put(&|case| case.plane::<f64>()[i]));
            let mut results = [nought; 24];
            for (early, results) in [false, true].into_iter().zip(results.chunks_mut(12)) {
                let (space, plane) = T::dispatch(Call {
                    space,
                    plane,
                    early,
                });
                results[..7].copy_from_slice(&space);
                results[7..].copy_from_slice(&plane);
            }
            for lane in 0..cases.len() {
                found.push(by_index(0, |i: usize| results[i].lane(lane).to_bits()));
            }
        }
        found
    }
}

#[test]
fn neighbours_change_no_bit() {
    for planar in [false, true] {
        // far, near and deep ones side by side
        let mut mixed = Vec::new();
        for shares in [[1.0, 1.05], [1.5, 3.0], [0.1, 0.9], [0.97, 1.03]] {
            mixed.push(cases(20.0, planar, shares, 200));
        }
        let mixed: Vec<Case> = (0..800).map(|i| mixed[i % 4][i / 4]).collect();
        let run = |cases: &[Case], width| with_width(width, Beside(cases));
        let Some(alone) = run(&mixed, Width::One) else {
            return;
        };
        for width in [Width::Two, Width::Four, Width::Eight] {
            let Some(beside) = run(&mixed, width) else {
                continue;
            };
            assert_eq!(alone, beside, "{}", width.name());
            // with other neighbours
            let shifted = run(&mixed[3..], width).expect("the width is there");
            assert_eq!(alone[3..], shifted, "{}", width.name());
        }
    }
}

#[test]
fn derivatives_are_those_of_differences_and_change_no_value() {
    for planar in [false, true] {
        for shares in [[0.85, 1.0], [1.0, 1.3]] {
            for case in cases(4.0, planar, shares, 40) {
                derivatives_are_those_of_differences(case.space(), &|a| in_space(a, false), &|a| {
                    in_space(a, false)
                });
                if planar {
                    derivatives_are_those_of_differences(
                        case.plane(),
                        &|a| in_plane(a, false),
                        &|a| in_plane(a, false),
                    );
                }
            }
        }
    }
}

fn derivatives_are_those_of_differences<const N: usize, const M: usize>(
    at: [f64; N],
    values: &dyn Fn([f64; N]) -> [f64; M],
    duals: &dyn Fn([Dual<f64>; N]) -> [Dual<f64>; M],
) {
    for along in 0..N {
        let moved = |by: f64| {
            let mut all = at;
            all[along] += by;
            values(all)
        };
        let mut moving = at.map(Dual::constant);
        moving[along].slope = 1.0;
        let ours = duals(moving);
        let (more, less, still) = (moved(1e-5), moved(-1e-5), moved(0.0));
        for k in 0..M {
            assert_eq!(ours[k].value, still[k]);
            let slope = (more[k] - less[k]) / 2e-5;
            let bound = 1e-4 * (1.0 + slope.abs());
            assert!(
                (ours[k].slope - slope).abs() <= bound,
                "{k} {along} {slope}"
            );
        }
    }
}

/// ∂φ/∂d = −n, and the derivatives of both sides agree, too.
#[test]
fn second_derivatives_agree_with_those_of_the_direction() {
    for planar in [false, true] {
        for case in cases(6.0, planar, [0.9, 1.2], 60) {
            for (i, at) in [(0, 12), (2, 14)] {
                for also in [12, 14] {
                    let mut twice = case.space::<Dual<Dual<f64>>>();
                    twice[at].slope.value = 1.0;
                    twice[also].value.slope = 1.0;
                    let found = in_space(twice, false);
                    let [n, bend] = [found[i].value.slope, -found[3].slope.slope];
                    assert!((n - bend).abs() <= 1e-11 * (1.0 + n.abs()), "{n} {bend}");
                }
            }
        }
    }
}

/// Mean and largest number of steps.
fn steps(cases: &[Case], of: impl Fn(&Case) -> u32) -> (f64, u32) {
    let counts: Vec<u32> = cases.iter().map(of).collect();
    let sum: u32 = counts.iter().sum();
    (
        f64::from(sum) / counts.len() as f64,
        counts.into_iter().max().unwrap_or(0),
    )
}

fn steps_in_space<T: Real>(case: &Case, early: bool) -> u32 {
    let a = case.space::<T>();
    let nothing = T::from_f64(0.0);
    let search = space::Search {
        both: [
            Quadric(std::array::from_fn(|i| a[i])),
            Quadric(std::array::from_fn(|i| a[6 + i])),
        ],
        between: [a[12], a[13], a[14]],
        early: early.then(|| nothing.lt(nothing)),
    };
    search.found().1
}

fn steps_in_plane<T: Real>(case: &Case, early: bool) -> u32 {
    let [a, b, c, d, e, f, x, z] = case.plane::<T>();
    let nothing = T::from_f64(0.0);
    let search = plane::Search {
        both: [plane::Quadric([a, b, c]), plane::Quadric([d, e, f])],
        between: [x, z],
        early: early.then(|| nothing.lt(nothing)),
    };
    search.found().1
}

#[test]
fn few_steps_are_needed() {
    // by the ratio of semi-axes, centres at 0.6 to 1.2 times the distance of a touch: the mean and the most
    for (ratio, planar, mean, most) in [
        (6.0, false, 4.5, 12),
        (20.0, false, 5.5, 20),
        (6.0, true, 3.0, 12),
        (20.0, true, 4.0, 16),
    ] {
        let all = cases(ratio, planar, [0.6, 1.2], 2000);
        let doubles = steps(&all, |case| match planar {
            true => steps_in_plane::<f64>(case, false),
            false => steps_in_space::<f64>(case, false),
        });
        let singles = steps(&all, |case| match planar {
            true => steps_in_plane::<f32>(case, false),
            false => steps_in_space::<f32>(case, false),
        });
        println!("{ratio} {planar} {doubles:?} {singles:?}");
        for found in [doubles, singles] {
            assert!(found.0 <= mean && found.1 <= most, "{found:?}");
        }
        // for bodies that do not touch, a separating plane is found at once
        let apart = cases(ratio, planar, [1.02, 1.5], 2000);
        let early = steps(&apart, |case| match planar {
            true => steps_in_plane::<f64>(case, true),
            false => steps_in_space::<f64>(case, true),
        });
        println!("apart {early:?}");
        assert!(early.0 <= 0.1 && early.1 <= 6, "{early:?}");
    }
}

#[test]
fn singles_have_the_digits_of_singles() {
    for planar in [false, true] {
        for case in cases(20.0, planar, [0.8, 1.3], 500) {
            let [.., double, _, _, _] = in_space(case.space::<f64>(), false);
            let single = match planar {
                true => in_plane(case.plane::<f32>(), false)[2],
                false => in_space(case.space::<f32>(), false)[3],
            };
            // the shapes are rounded, too: an entry of Q is off by a part of the largest one, and h along a short axis
            // by 20 times that
            let bound = 32.0 * f64::from(f32::EPSILON) * case.size();
            assert!((f64::from(single) - double).abs() <= bound);
        }
    }
}

#[test]
fn what_is_no_number_ends_the_search() {
    let case = cases(6.0, true, [0.9, 1.0], 1)[0];
    for at in 0..8 {
        let mut arguments = case.plane::<f64>();
        arguments[at] = f64::NAN;
        for early in [false, true] {
            assert!(in_plane(arguments, early)[2].is_nan(), "{at}");
        }
    }
    for at in 0..15 {
        let mut arguments = case.space::<f64>();
        arguments[at] = f64::NAN;
        for early in [false, true] {
            assert!(in_space(arguments, early)[3].is_nan(), "{at}");
        }
    }
}

#[test]
fn circles_meet_on_their_line() {
    for d in [[0.3, 0.25], [0.0, -0.4], [1.0, 3.0], [0.2, 0.0]] {
        let length = f64::hypot(d[0], d[1]);
        for early in [false, true] {
            let [x, z, ours, px, pz] =
                in_plane([0.09, 0.09, 0.0, 0.04, 0.04, 0.0, d[0], d[1]], early);
            let bound = 8.0 * f64::EPSILON * length;
            assert!((ours - (0.5 - length)).abs() <= bound);
            assert!((x - d[0] / length).abs() <= bound && (z - d[1] / length).abs() <= bound);
            if ours > 0.0 {
                let way = 0.3 - 0.5 * ours;
                assert!((px - way * x).abs() <= bound && (pz - way * z).abs() <= bound);
            }
        }
    }
}
