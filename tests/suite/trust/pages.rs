//! Each law as its page in `docs/forces` states it, in plain vector algebra, compared with the equations at random
//! states.
//!
//! A body of mass m whose centre of gravity is its joint and whose moments of inertia are all J fulfils F = m a and M =
//! J ω̇: its accelerations show the force and moment on it.

mod statements;

use super::read;
use bryant::evaluation::{State, at, functions};
use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::Equations;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::model::Model;
use bryant_hard::random::Random;

type Vector = [f64; 3];
type Matrix = [Vector; 3];

const MASS: f64 = 2.0;
const INERTIA: f64 = 0.5;
const STATES: usize = 200;

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn plus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + b[i])
}

fn minus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] - b[i])
}

fn times(factor: f64, a: Vector) -> Vector {
    a.map(|x| factor * x)
}

fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

fn unit(a: Vector) -> Vector {
    times(1.0 / norm(a), a)
}

fn apply(m: &Matrix, v: Vector) -> Vector {
    m.map(|row| dot(row, v))
}

fn column(m: &Matrix, i: usize) -> Vector {
    m.map(|row| row[i])
}

fn sat(x: f64) -> f64 {
    x.clamp(-1.0, 1.0)
}

/// A value of a piecewise linear curve, extended along its last pieces.
fn curve(points: &[[f64; 2]], x: f64) -> f64 {
    let mut k = 0;
    while k + 2 < points.len() && x > points[k + 1][0] {
        k += 1;
    }
    let [[x0, y0], [x1, y1]] = [points[k], points[k + 1]];
    y0 + (x - x0) * (y1 - y0) / (x1 - x0)
}

/// The position and the motion of the body.
struct Moving {
    position: Vector,
    rotation: Matrix,
    quaternion: [f64; 4],
    velocity: Vector,
    omega: Vector,
}

impl Moving {
    fn random(random: &mut Random, near: Vector, spread: f64) -> Moving {
        let mut vector =
            |size: f64| -> Vector { std::array::from_fn(|_| random.uniform(-size, size)) };
        let (offset, velocity, omega) = (vector(spread), vector(2.0), vector(3.0));
        let q: [f64; 4] = std::array::from_fn(|_| random.uniform(-1.0, 1.0));
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        let [w, x, y, z] = q.map(|x| x / length);
        Moving {
            position: plus(near, offset),
            rotation: [
                [
                    1.0 - 2.0 * (y * y + z * z),
                    2.0 * (x * y - w * z),
                    2.0 * (x * z + w * y),
                ],
                [
                    2.0 * (x * y + w * z),
                    1.0 - 2.0 * (x * x + z * z),
                    2.0 * (y * z - w * x),
                ],
                [
                    2.0 * (x * z - w * y),
                    2.0 * (y * z + w * x),
                    1.0 - 2.0 * (x * x + y * y),
                ],
            ],
            quaternion: [w, x, y, z],
            velocity,
            omega,
        }
    }

    fn point(&self, local: Vector) -> Vector {
        plus(self.position, apply(&self.rotation, local))
    }

    fn velocity_at(&self, point: Vector) -> Vector {
        plus(
            self.velocity,
            cross(self.omega, minus(point, self.position)),
        )
    }
}

/// A force and a moment about the centre of gravity.
#[derive(Clone, Copy, Debug, Default)]
struct Wrench {
    force: Vector,
    moment: Vector,
}

impl Wrench {
    fn at(body: &Moving, point: Vector, force: Vector) -> Wrench {
        Wrench {
            force,
            moment: cross(minus(point, body.position), force),
        }
    }

    fn and(self, other: Wrench) -> Wrench {
        Wrench {
            force: plus(self.force, other.force),
            moment: plus(self.moment, other.moment),
        }
    }
}

/// A model with one free body and one force.
struct FreeBody {
    model: Model,
    equations: Equations,
    engine: Engine,
}

impl FreeBody {
    fn new(force: &str, rest: &str) -> FreeBody {
        let text = format!(
            "model: page\ndimension: 3\nsystems:\n  - name: one\n    elements: [{{ name: body, mass: {MASS}, cg: [0, 0, 0], inertia: [{INERTIA}, {INERTIA}, {INERTIA}] }}]\nforces:\n  - {{ {force} }}\n{rest}"
        );
        let model = read(&text).unwrap_or_else(|problems| panic!("{problems:#?}\n{text}"));
        let options = Options {
            matrices: true,
            route: None,
        };
        let equations = derive_with(&model, options);
        FreeBody {
            engine: Engine::new(Config::new().lists(&model)).unwrap(),
            model,
            equations,
        }
    }

    /// A state of the body and of laws; memory by a part of its name, 0 by default.
    fn state(&self, body: &Moving, t: f64, z: &[f64], memory: &[(&str, f64)]) -> State {
        let remembered = |name: &str| {
            let found = memory.iter().find(|(part, _)| name.contains(part));
            found.map_or(0.0, |(_, value)| *value)
        };
        let names = self.equations.memory.iter().map(|state| &state.name);
        State {
            t,
            q: [&body.position[..], &body.quaternion].concat(),
            v: [body.velocity, body.omega].concat(),
            z: z.to_vec(),
            m: names.map(|name| remembered(name)).collect(),
            a: Vec::new(),
        }
    }

    /// The rates of the states of laws.
    fn rates(&self, body: &Moving, t: f64, z: &[f64], memory: &[(&str, f64)]) -> Vec<f64> {
        let state = self.state(body, t, z, memory);
        let inputs = Inputs {
            time: state.t,
            coordinates: &state.q,
            velocities: &state.v,
            parameters: &[],
            auxiliaries: &state.z,
            memory: &state.m,
            accelerations: &[],
        };
        let roots = self.equations.auxiliaries.iter().map(|state| state.next);
        let roots: Vec<_> = roots.collect();
        evaluate(
            &self.equations.graph,
            &roots,
            &inputs,
            &functions(&self.model),
        )
    }

    /// The wrench on the body.
    fn acts(&self, body: &Moving, t: f64, z: &[f64], memory: &[(&str, f64)]) -> Wrench {
        let state = self.state(body, t, z, memory);
        let found = at(&self.engine, &[], &state).unwrap_or_else(|e| panic!("{e}"));
        let [force, moment] = [0, 3].map(|i| std::array::from_fn(|k| found.acceleration[i + k]));
        Wrench {
            force: times(MASS, force),
            moment: times(INERTIA, moment),
        }
    }
}

/// Checks for equality up to some hundred roundings of forces of this size.
#[track_caller]
fn same(what: &str, ours: Wrench, page: Wrench, size: f64) {
    let bound = 1e3 * f64::EPSILON * size.max(1.0);
    let off = norm(minus(ours.force, page.force)).max(norm(minus(ours.moment, page.moment)));
    assert!(
        off <= bound,
        "{what}: {ours:?} instead of {page:?}, off by {off:e}, allowed {bound:e}"
    );
}

/// f, θ₀, d, M, v, and the stop (from, to, k, d, a) of the joints here.
const ELASTIC: [[f64; 2]; 3] = [[-1.0, -3.0], [0.0, 0.0], [1.0, 2.0]];
const LAW: &str = "elastic: { points: [[-1, -3], [0, 0], [1, 2]], extrapolate: linear }, neutral: 0.2, damping: 0.3, friction: 0.7, friction_speed: 0.5, stop: { from: -0.4, to: 0.6, stiffness: 11, damping: 0.9, damping_angle: 0.1 }, lock: { by: now, stiffness: 5, damping: 0.6 }";
const NOW: &str = "switches: [{ switch: now, when: { time: 0 } }]\n";

/// The torque of a stop at a depth δ: k δ + d min(δ/a, 1) δ', never negative.
fn stop(depth: f64, rate: f64) -> f64 {
    match depth > 0.0 {
        true => (11.0 * depth + 0.9 * (depth / 0.1).min(1.0) * rate).max(0.0),
        false => 0.0,
    }
}

/// Q = −f(θ − θ₀) − d θ' − M sat(θ'/v) − stop − lock
fn torque(angle: f64, rate: f64, locked: f64) -> f64 {
    let stop = stop(angle - 0.6, rate) - stop(-0.4 - angle, -rate);
    let lock = 5.0 * (angle - locked) + 0.6 * rate;
    -curve(&ELASTIC, angle - 0.2) - 0.3 * rate - 0.7 * sat(rate / 0.5) - stop - lock
}

#[test]
fn joints_about_bryant_angles() {
    let mut random = Random::new(1);
    for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let scene = FreeBody::new(
            &format!("joint: one/body, about: {{ {axis}: {{ {LAW} }} }}"),
            NOW,
        );
        for _ in 0..STATES {
            let body = Moving::random(&mut random, [0.0; 3], 1.0);
            let a = &body.rotation;
            let (e1, e3) = ([1.0, 0.0, 0.0], column(a, 2));
            let s = dot(e1, e3);
            let c2 = 1.0 - s * s;
            // A = Rx Ry Rz
            let angles = [
                (-a[1][2]).atan2(a[2][2]),
                s.asin(),
                (-a[0][1]).atan2(a[0][0]),
            ];
            let directions = [
                times(1.0 / c2, minus(e1, times(s, e3))),
                times(1.0 / c2.sqrt(), cross(e3, e1)),
                times(1.0 / c2, minus(e3, times(s, e1))),
            ];
            let n = directions[i];
            let torque = torque(angles[i], dot(n, body.omega), 0.1);
            let page = Wrench {
                force: [0.0; 3],
                moment: times(torque, n),
            };
            let ours = scene.acts(&body, 1.0, &[], &[("locked", 0.1)]);
            same(axis, ours, page, 30.0 * norm(page.moment) / c2);
        }
    }
}

/// x > 0: clamp(s (x − p), u(x), f(x)), x < 0: clamp(s (x − p), f(x), u(x)), of f = ELASTIC, s = 20.
fn unloaded(x: f64, p: f64, u: f64) -> f64 {
    let f = curve(&ELASTIC, x);
    (20.0 * (x - p)).clamp(u.min(f), u.max(f))
}

/// k (c − θ) + d (c' − θ') within ± the limit, at t = 1 of a line from 0.1 to 0.5 in 2 s
fn driven(angle: f64, rate: f64) -> f64 {
    (6.0 * (0.3 - angle) + 0.4 * (0.2 - rate)).clamp(-1.5, 1.5)
}

#[test]
fn joints_with_memory_motors_and_drives() {
    const ELASTIC_LAW: &str = "elastic: { points: [[-1, -3], [0, 0], [1, 2]], extrapolate: linear }, neutral: 0.2, unloading_slope: 20";
    const UNLOADING: [[f64; 2]; 3] = [[-1.0, -1.0], [0.0, 0.0], [1.0, 1.5]];
    const DRIVES: &str = "friction: 0.7, friction_speed: 0.5, friction_displacement: 0.05, motor: { points: [[0, 1], [2, 5]] }, drive: { to: { points: [[0, 0.1], [2, 0.5]] }, stiffness: 6, damping: 0.4, limit: 1.5 }";
    let foam = format!(
        "{ELASTIC_LAW}, unloading: {{ points: [[-1, -1], [0, 0], [1, 1.5]], extrapolate: linear }}, {DRIVES}"
    );
    let dented = format!("{ELASTIC_LAW}, {DRIVES}");
    let mut random = Random::new(9);
    let (mut between, mut stuck, mut limited) = (0, 0, 0);
    for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let [foam, dented] = [&foam, &dented].map(|law| {
            FreeBody::new(
                &format!("joint: one/body, about: {{ {axis}: {{ {law} }} }}"),
                "",
            )
        });
        for _ in 0..STATES {
            let body = Moving::random(&mut random, [0.0; 3], 1.0);
            let a = &body.rotation;
            let (e1, e3) = ([1.0, 0.0, 0.0], column(a, 2));
            let s = dot(e1, e3);
            let c2 = 1.0 - s * s;
            let (angle, n) = match i {
                0 => (
                    (-a[1][2]).atan2(a[2][2]),
                    times(1.0 / c2, minus(e1, times(s, e3))),
                ),
                1 => (s.asin(), times(1.0 / c2.sqrt(), cross(e3, e1))),
                _ => (
                    (-a[0][1]).atan2(a[0][0]),
                    times(1.0 / c2, minus(e3, times(s, e1))),
                ),
            };
            let (rate, x) = (dot(n, body.omega), angle - 0.2);
            let z = random.uniform(-0.06, 0.06);
            let share = z / 0.05 + rate / 0.5;
            // chosen such that the line is often between the curves
            let (f, u) = (curve(&ELASTIC, x), curve(&UNLOADING, x));
            let near = |u: f64, w: f64| x - (u + w * (f - u)) / 20.0;
            let p = [
                near(u, random.uniform(-1.0, 2.0)),
                near(0.0, random.uniform(-1.0, 2.0)).max(0.0),
                near(0.0, random.uniform(-1.0, 2.0)).min(0.0),
            ];
            let others = -0.7 * sat(share) + 3.0 + driven(angle, rate);
            stuck += usize::from(share.abs() < 1.0);
            limited += usize::from(driven(angle, rate).abs() == 1.5);
            for (what, scene, elastic) in [
                ("foam", &foam, unloaded(x, p[0], u)),
                (
                    "dented",
                    &dented,
                    unloaded(x, if x > 0.0 { p[1] } else { p[2] }, 0.0),
                ),
            ] {
                between += usize::from(elastic != 0.0 && elastic != u && elastic != f);
                let page = Wrench {
                    force: [0.0; 3],
                    moment: times(others - elastic, n),
                };
                let memory = [("foot", p[0]), ("set above", p[1]), ("set below", p[2])];
                let ours = scene.acts(&body, 1.0, &[z], &memory);
                same(what, ours, page, 100.0 * (norm(page.moment) + norm(n)) / c2);
            }
        }
    }
    assert!(
        between > 50 && stuck > 20 && limited > 50,
        "{between} {stuck} {limited}"
    );
}

#[test]
fn flexion_and_torsion() {
    let law = LAW
        .replace("neutral: 0.2, ", "")
        .replace("from: -0.4, ", "");
    let law = law.split(", lock").next().expect("a law");
    let mut random = Random::new(2);
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let flexion = FreeBody::new(
            &format!("joint: one/body, axis: {name}, flexion: {{ {law} }}"),
            "",
        );
        let torsion = FreeBody::new(
            &format!("joint: one/body, axis: {name}, torsion: {{ {LAW} }}"),
            NOW,
        );
        for _ in 0..STATES {
            let body = Moving::random(&mut random, [0.0; 3], 1.0);
            let mut e_p = [0.0; 3];
            e_p[axis] = 1.0;
            let e_c = column(&body.rotation, axis);
            let across = cross(e_p, e_c);
            let (sine, cosine) = (norm(across), dot(e_p, e_c));
            let (beta, n) = (sine.atan2(cosine), unit(across));
            let rate = dot(n, body.omega);
            // the rate of the long axis
            let w = cross(e_c, cross(body.omega, e_c));
            let along = -curve(&ELASTIC, beta) - stop(beta - 0.6, rate);
            let against = 0.3 + 0.7 / norm(w).max(0.5);
            let page = Wrench {
                force: [0.0; 3],
                moment: minus(times(along, n), times(against, w)),
            };
            let ours = flexion.acts(&body, 1.0, &[], &[]);
            same("flexion", ours, page, 30.0 * norm(page.moment) / sine);

            // the rotation that is left after the bending is undone: the shortest rotation from e_p to e_c, backwards
            let back = |v: Vector| {
                let turned = minus(v, cross(n, times(sine, v)));
                plus(turned, times(1.0 - cosine, cross(n, cross(n, v))))
            };
            let side = (axis + 1) % 3;
            let twisted = back(column(&body.rotation, side));
            let mut e_side = [0.0; 3];
            e_side[side] = 1.0;
            let twist = dot(e_p, cross(e_side, twisted)).atan2(dot(e_side, twisted));
            let t = times(1.0 / (1.0 + cosine), plus(e_p, e_c));
            let torque = torque(twist, dot(t, body.omega), 0.1);
            let page = Wrench {
                force: [0.0; 3],
                moment: times(torque, t),
            };
            let ours = torsion.acts(&body, 1.0, &[], &[("locked", 0.1)]);
            let size = 30.0 * norm(page.moment) / (1.0 + cosine);
            same("torsion", ours, page, size / sine);
        }
    }
}

#[test]
fn flexion_does_not_brake_the_spin_of_a_bent_arm() {
    let scene = FreeBody::new(
        "joint: one/body, flexion: { damping: 0.5, friction: 1 }",
        "",
    );
    let (half, spin) = (std::f64::consts::FRAC_PI_6, 2.0);
    let rotation = [
        [(2.0 * half).cos(), 0.0, (2.0 * half).sin()],
        [0.0, 1.0, 0.0],
        [-(2.0 * half).sin(), 0.0, (2.0 * half).cos()],
    ];
    let body = Moving {
        position: [0.0; 3],
        rotation,
        quaternion: [half.cos(), 0.0, half.sin(), 0.0],
        velocity: [0.0; 3],
        omega: times(spin, column(&rotation, 2)),
    };
    let found = scene.acts(&body, 0.0, &[], &[]);
    same("spin", found, Wrench::default(), 1.0);
}

const PRESSED: [[f64; 2]; 3] = [[0.0, 0.0], [0.02, 300.0], [0.1, 800.0]];
const AXES: Vector = [0.12, 0.09, 0.15];
const NORMAL: Vector = [0.2, -0.3, 1.0];
const ALONG: Vector = [1.0, 0.4, -0.1];

/// N = max(0, F(δ) + d min(δ/δ_d, 1) δ') where δ > 0
fn pressure(elastic: f64, depth: f64, rate: f64) -> f64 {
    match depth > 0.0 {
        true => (elastic + 40.0 * (depth / 0.01).min(1.0) * rate).max(0.0),
        false => 0.0,
    }
}

/// Penetration, its rate, the deepest point, its sliding velocity, and the normal, for an ellipsoid at `centre` over
/// the plane through 0.
fn touch(body: &Moving, centre: Vector, axes: Vector) -> (f64, f64, Vector, Vector, Vector) {
    let n = unit(NORMAL);
    let in_axes: Vector = std::array::from_fn(|i| dot(column(&body.rotation, i), n));
    let h = (0..3)
        .map(|i| (axes[i] * in_axes[i]).powi(2))
        .sum::<f64>()
        .sqrt();
    let deepest: Vector = std::array::from_fn(|i| axes[i] * axes[i] * in_axes[i] / h);
    let point = minus(centre, apply(&body.rotation, deepest));
    let v = body.velocity_at(point);
    let slip = minus(v, times(dot(v, n), n));
    (h - dot(n, centre), -dot(v, n), point, slip, n)
}

#[test]
fn contacts_with_a_plane() {
    let geometry = "ellipsoid: { on: one/body, center: [0.03, 0.01, -0.02], semi_axes: [0.12, 0.09, 0.15] }, plane: { on: frame, at: [0, 0, 0], normal: [0.2, -0.3, 1], along: [1, 0.4, -0.1] }";
    let law = "elastic: { points: [[0, 0], [0.02, 300], [0.1, 800]], extrapolate: linear }, damping: 40, damping_depth: 0.01, friction: 0.4, friction_speed: 0.3";
    let foam =
        "unloading: { points: [[0, 0], [0.1, 100]], extrapolate: linear }, unloading_slope: 30000";
    let slides = FreeBody::new(&format!("contact: c, {geometry}, {law}"), "");
    let holds = FreeBody::new(
        &format!("contact: c, {geometry}, {law}, friction_displacement: 0.002"),
        "",
    );
    let unloads = FreeBody::new(&format!("contact: c, {geometry}, {law}, {foam}"), "");
    let mut random = Random::new(3);
    let (mut touched, mut slid) = (0, 0);
    for _ in 0..STATES {
        let body = Moving::random(&mut random, [0.0; 3], 0.15);
        let centre = body.point([0.03, 0.01, -0.02]);
        let (depth, rate, point, slip, n) = touch(&body, centre, AXES);
        let elastic = curve(&PRESSED, depth);
        let force = pressure(elastic, depth, rate);
        touched += usize::from(force > 0.0);
        slid += usize::from(norm(slip) > 0.3);
        let friction = |pressure: f64| times(-0.4 * pressure / norm(slip).max(0.3), slip);
        let total = |pressure: f64| plus(times(pressure, n), friction(pressure));
        let page = Wrench::at(&body, point, total(force));
        same(
            "slides",
            slides.acts(&body, 0.0, &[], &[]),
            page,
            100.0 * force,
        );

        // F = −μN s/max(1, |s|), s = z/z_b + z'/v_s, z along the plane
        let t1 = unit(minus(ALONG, times(dot(ALONG, n), n)));
        let tangents = [t1, cross(n, t1)];
        let z = [random.uniform(-2e-3, 2e-3), random.uniform(-2e-3, 2e-3)];
        let s = [0, 1].map(|i| z[i] / 2e-3 + dot(slip, tangents[i]) / 0.3);
        let long = s[0].hypot(s[1]).max(1.0);
        let drag = plus(
            times(s[0] / long, tangents[0]),
            times(s[1] / long, tangents[1]),
        );
        let page = Wrench::at(
            &body,
            point,
            minus(times(force, n), times(0.4 * force, drag)),
        );
        same(
            "holds",
            holds.acts(&body, 0.0, &z, &[]),
            page,
            100.0 * force,
        );

        // F = clamp(s (δ − p), u(δ), f(δ))
        let p = random.uniform(-0.01, 0.05);
        let unloading = 1000.0 * depth;
        let clamped = (30_000.0 * (depth - p)).max(unloading).min(elastic);
        let force = pressure(clamped, depth, rate);
        let page = Wrench::at(&body, point, total(force));
        let ours = unloads.acts(&body, 0.0, &[], &[("foot", p)]);
        same(
            "unloads",
            ours,
            page,
            100.0 * force + 30_000.0 * depth.abs(),
        );
    }
    assert!(touched > STATES / 4 && slid > STATES / 4);
}

#[test]
fn planes_that_end() {
    let of = |edge: &str| {
        FreeBody::new(
            &format!(
                "contact: c, ellipsoid: {{ on: one/body, center: [0, 0, 0], semi_axes: [0.1, 0.1, 0.1] }}, plane: {{ on: frame, at: [0, 0, 0], normal: [0.2, -0.3, 1], along: [1, 0.4, -0.1], extent: [0.3, 0.2], edge: {edge} }}, elastic: {{ points: [[0, 0], [0.1, 800]], extrapolate: linear }}"
            ),
            "",
        )
    };
    let (cut, fade) = (of("{ rule: cut }"), of("{ rule: fade, width: 0.15 }"));
    let mut random = Random::new(4);
    let (mut inside, mut faded) = (0, 0);
    for _ in 0..STATES {
        let body = Moving::random(&mut random, [0.0; 3], 0.3);
        let (depth, _, point, _, n) = touch(&body, body.position, [0.1; 3]);
        let force = 8000.0 * depth.max(0.0);
        let t1 = unit(minus(ALONG, times(dot(ALONG, n), n)));
        let tangents = [t1, cross(n, t1)];
        let place = tangents.map(|t| dot(t, point));
        let left = [0.3 - place[0].abs(), 0.2 - place[1].abs()];
        let there = left.iter().all(|x| *x > 0.0);
        inside += usize::from(there && force > 0.0);
        let page = Wrench::at(&body, point, times(if there { force } else { 0.0 }, n));
        same("cut", cut.acts(&body, 0.0, &[], &[]), page, 100.0 * force);

        // w = Π S((e_i − |ξ_i|)/width), S(x) = x² (3 − 2x), and −∇w ∫f
        let shares = left.map(|x| (x / 0.15).clamp(0.0, 1.0));
        let smooth = shares.map(|x| x * x * (3.0 - 2.0 * x));
        let stored = 0.5 * 8000.0 * depth.max(0.0).powi(2);
        let mut push = times(smooth[0] * smooth[1] * force, n);
        for i in 0..2 {
            let steep = 6.0 * shares[i] * (1.0 - shares[i]) / 0.15;
            let slope = -place[i].signum() * steep * smooth[1 - i];
            push = minus(push, times(stored * slope, tangents[i]));
        }
        faded += usize::from(shares.iter().any(|x| *x > 0.0 && *x < 1.0) && force > 0.0);
        // for a sphere the whole force goes through the centre
        let page = Wrench {
            force: push,
            moment: [0.0; 3],
        };
        same(
            "fade",
            fade.acts(&body, 0.0, &[], &[]),
            page,
            1e3 * (force + stored),
        );
    }
    assert!(inside > 10 && faded > 10, "{inside} {faded}");
}

#[test]
fn contacts_of_two_balls() {
    let scene = FreeBody::new(
        "contact: c, ellipsoid: { on: one/body, center: [0.03, 0, 0], semi_axes: [0.2, 0.2, 0.2] }, with: { on: frame, center: [0.1, 0, 0], semi_axes: [0.3, 0.3, 0.3] }, elastic: { points: [[0, 0], [0.02, 300], [0.1, 800]], extrapolate: linear }, damping: 40, damping_depth: 0.01, friction: 0.4, friction_speed: 0.3",
        "",
    );
    let mut random = Random::new(5);
    let mut touched = 0;
    for _ in 0..STATES {
        let body = Moving::random(&mut random, [0.1, 0.0, 0.0], 0.4);
        let centre = body.point([0.03, 0.0, 0.0]);
        let apart = minus(centre, [0.1, 0.0, 0.0]);
        let (n, depth) = (unit(apart), 0.5 - norm(apart));
        // beyond the radii there is no contact any more
        if depth > 0.3 {
            continue;
        }
        // the point of attack: in the middle of the overlap
        let point = minus(centre, times(0.2 - 0.5 * depth, n));
        let v = body.velocity_at(point);
        let slip = minus(v, times(dot(v, n), n));
        let force = pressure(curve(&PRESSED, depth), depth, -dot(v, n));
        touched += usize::from(force > 0.0);
        let friction = times(-0.4 * force / norm(slip).max(0.3), slip);
        let page = Wrench::at(&body, point, plus(times(force, n), friction));
        same("balls", scene.acts(&body, 0.0, &[], &[]), page, 1e4 * force);
    }
    assert!(touched > 20);
}

const WEBBING: [[f64; 2]; 3] = [[0.0, 0.0], [0.1, 500.0], [1.0, 2000.0]];

#[test]
fn belts() {
    let ends = "from: { on: one/body, at: [0.1, -0.05, 0.02] }, to: { on: frame, at: [1, 0, 0] }, force: { points: [[0, 0], [0.1, 500], [1, 2000]], extrapolate: linear }";
    let plain = FreeBody::new(
        &format!("belt: b, {ends}, length: 0.8, damping: 60, damping_stretch: 0.05"),
        "",
    );
    let slack = FreeBody::new(&format!("belt: b, {ends}, slack: 0.03"), "");
    let limited = FreeBody::new(
        &format!("belt: b, {ends}, length: 0.8, limiter: {{ force: 700 }}"),
        "",
    );
    let reel = FreeBody::new(
        &format!("belt: b, {ends}, retractor: {{ lock: never, spool: 20 }}"),
        "switches: [{ switch: never, when: { time: 9 } }]\n",
    );
    let fired = FreeBody::new(
        &format!(
            "belt: b, {ends}, length: 0.8, pretensioner: {{ fire: now, retract: {{ points: [[0, 0], [1, 0.1]] }} }}"
        ),
        NOW,
    );
    let foam = FreeBody::new(
        &format!(
            "belt: b, {ends}, length: 0.8, unloading: {{ points: [[0, 0], [1, 400]], extrapolate: linear }}, unloading_slope: 20000"
        ),
        "",
    );
    let mut random = Random::new(6);
    let mut taut = 0;
    for _ in 0..STATES {
        let body = Moving::random(&mut random, [0.0; 3], 0.5);
        let from = body.point([0.1, -0.05, 0.02]);
        let span = minus([1.0, 0.0, 0.0], from);
        let (length, along) = (norm(span), unit(span));
        let rate = -dot(along, body.velocity_at(from));
        let pull = |tension: f64| Wrench::at(&body, from, times(tension, along));
        let check = |what: &str, scene: &FreeBody, tension: f64, memory: &[(&str, f64)]| {
            let ours = scene.acts(&body, 0.4, &[], memory);
            same(what, ours, pull(tension), 100.0 * (tension + 2e4 * length));
        };
        let tension = |l0: f64, force: &dyn Fn(f64) -> f64| {
            let strain = length / l0 - 1.0;
            if strain > 0.0 {
                force(strain).max(0.0)
            } else {
                0.0
            }
        };
        let elastic = |strain: f64| curve(&WEBBING, strain);
        taut += usize::from(length > 0.8);
        // T = max(0, F(ε) + d min(s/s_d, 1) s')
        let s = length - 0.8;
        let damped = |strain: f64| elastic(strain) + 60.0 * (s / 0.05).min(1.0) * rate;
        check("damped", &plain, tension(0.8, &damped), &[]);
        // at the start the body is at 0, not rotated
        let start = norm(minus([1.0, 0.0, 0.0], [0.1, -0.05, 0.02]));
        check("slack", &slack, tension(start + 0.03, &elastic), &[]);
        check("limited", &limited, tension(0.8, &elastic).min(700.0), &[]);
        check("reel", &reel, 20.0, &[("never", 1e30)]);
        check("fired", &fired, tension(0.8 - 0.1 * 0.4, &elastic), &[]);
        let p = random.uniform(-0.01, 0.3);
        let clamped = |strain: f64| {
            (20_000.0 * (strain - p))
                .max(400.0 * strain)
                .min(elastic(strain))
        };
        check("foam", &foam, tension(0.8, &clamped), &[("foot", p)]);
    }
    assert!(taut > STATES / 4);
}

/// A belt from the frame over a ring on the body to another point of the frame: c s' = max(T₊ − R T₋, 0) − max(T₋ − R
/// T₊, 0), R = e^(μ θ), and s is subtracted from L₀ of the segment before.
#[test]
fn rings() {
    let scene = FreeBody::new(
        "belt: b, from: { on: frame, at: [-1, 0, 0.3] }, through: [{ ring: r, on: one/body, at: [0.1, -0.05, 0.02], friction: 0.3 }], to: { on: frame, at: [1, 0.2, 0] }, force: { points: [[0, 0], [0.1, 500], [1, 2000]], extrapolate: linear }, length: 1.7, damping: 60",
        "",
    );
    // at the start the body is at 0, not rotated, and both segments have the same strain
    let (ring, from, to) = ([0.1, -0.05, 0.02], [-1.0, 0.0, 0.3], [1.0, 0.2, 0.0]);
    let starts = [norm(minus(ring, from)), norm(minus(to, ring))];
    let lengths = starts.map(|length| 1.7 * length / (starts[0] + starts[1]));
    let mut random = Random::new(11);
    let (mut slipped, mut stuck) = (0, 0);
    for _ in 0..STATES {
        let body = Moving::random(&mut random, [0.0; 3], 0.5);
        let slip = random.uniform(-0.15, 0.15);
        let point = body.point(ring);
        let spans = [minus(from, point), minus(to, point)];
        let untensioned = [lengths[0] - slip, lengths[1] + slip];
        let [before, behind] = [0, 1].map(|k| {
            let (length, along) = (norm(spans[k]), unit(spans[k]));
            (
                length / untensioned[k] - 1.0,
                -dot(along, body.velocity_at(point)),
                along,
            )
        });
        let elastic = |strain: f64| {
            if strain > 0.0 {
                curve(&WEBBING, strain)
            } else {
                0.0
            }
        };
        let [first, second] = [elastic(before.0), elastic(behind.0)];
        // the angle between the directions of the webbing
        let cosine = dot(times(-1.0, before.2), behind.2);
        let ratio = (0.3 * cosine.clamp(-1.0, 1.0).acos()).exp();
        let expected =
            ((second - ratio * first).max(0.0) - (first - ratio * second).max(0.0)) / 50.0;
        let found = scene.rates(&body, 0.4, &[slip], &[])[0];
        let size = (first + second + 2e3) / 50.0;
        assert!(
            (found - expected).abs() < 1e5 * f64::EPSILON * size,
            "{found} instead of {expected}"
        );
        slipped += usize::from(expected != 0.0);
        stuck += usize::from(expected == 0.0 && first > 0.0);
        if expected == 0.0 {
            assert_eq!(found, 0.0);
        }
        // d acts on L₀ ε' with the L₀ of the whole belt, and grows with the stretch up to 1 mm; the rate of strain
        // includes those of the length and of L₀
        let tension = |(strain, rate, _): (f64, f64, Vector), own: f64, feeds: f64| {
            if strain <= 0.0 {
                return 0.0;
            }
            let of_strain = (rate - feeds * (1.0 + strain)) / own;
            let fades = (1e3 * strain * own).min(1.0);
            (elastic(strain) + 60.0 * 1.7 * of_strain * fades).max(0.0)
        };
        let pulls = [
            (tension(before, untensioned[0], -expected), before.2),
            (tension(behind, untensioned[1], expected), behind.2),
        ];
        let page = pulls.map(|(tension, along)| Wrench::at(&body, point, times(tension, along)));
        let size = 1e4 * (first + second + 2e3);
        same(
            "ring",
            scene.acts(&body, 0.4, &[slip], &[]),
            page[0].and(page[1]),
            size,
        );
    }
    assert!(slipped > STATES / 8 && stuck > 5, "{slipped} {stuck}");
}

/// A spherical airbag against a sphere: ΔV and A are those of the lens of both, computed here by spherical caps.
#[test]
fn airbags() {
    let (radius, other, surrounding) = (0.3, 0.2, 101_325.0);
    let scene = FreeBody::new(
        "airbag: b, ellipsoid: { on: frame, center: [0.1, 0, 0], semi_axes: [0.3, 0.3, 0.3] }, against: [{ on: one/body, center: [0.03, 0, 0], semi_axes: [0.2, 0.2, 0.2] }], vent: { area: 0.002, coefficient: 0.6 }, start: { pressure: 150000, temperature: 350 }",
        "",
    );
    let (constant, gamma) = (287.0, 1.4);
    let whole = 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
    let mut random = Random::new(12);
    let (mut full, mut choked, mut slack) = (0, 0, 0);
    for _ in 0..STATES {
        let body = Moving::random(&mut random, [0.1, 0.0, 0.0], 0.4);
        let centre = body.point([0.03, 0.0, 0.0]);
        let apart = minus(centre, [0.1, 0.0, 0.0]);
        let (n, distance) = (unit(apart), norm(apart));
        // up to the equator of the smaller sphere
        let equator = (radius * radius - other * other).sqrt();
        if distance < equator {
            continue;
        }
        let depth = radius + other - distance;
        let (area, taken) = match depth > 0.0 {
            true => {
                let plane =
                    (distance * distance + radius * radius - other * other) / (2.0 * distance);
                let cap = |r: f64, h: f64| std::f64::consts::PI * h * h * (3.0 * r - h) / 3.0;
                let caps = cap(radius, radius - plane) + cap(other, other - (distance - plane));
                (
                    std::f64::consts::PI * (radius * radius - plane * plane),
                    caps,
                )
            }
            false => (0.0, 0.0),
        };
        let volume = whole - taken;
        let mass = random.uniform(0.05, 0.4);
        let energy = random.uniform(0.7, 3.0) * surrounding * volume / (gamma - 1.0);
        let pressure = ((gamma - 1.0) * energy / volume).max(surrounding);
        let temperature = (gamma - 1.0) * energy / (mass * constant);
        let r = (surrounding / pressure).max((2.0 / (gamma + 1.0)).powf(gamma / (gamma - 1.0)));
        let square =
            2.0 * gamma / (gamma - 1.0) * (r.powf(2.0 / gamma) - r.powf((gamma + 1.0) / gamma));
        let psi = if square < 1e-4 {
            square / 1e-2
        } else {
            square.sqrt()
        };
        let out = 0.6 * 0.002 * pressure / (constant * temperature).sqrt() * psi;
        let enthalpy = -gamma / (gamma - 1.0) * constant * out * temperature;
        let is_full = (gamma - 1.0) * energy > surrounding * volume;
        // the point of attack: half way between the deepest points
        let point = minus(centre, times(other - 0.5 * depth, n));
        let shrinks = if depth > 0.0 {
            -area * dot(body.velocity_at(point), n)
        } else {
            0.0
        };
        let rate = match is_full {
            true => enthalpy + pressure * shrinks,
            false => enthalpy / gamma,
        };
        let found = scene.rates(&body, 0.0, &[mass, energy], &[]);
        // powers of numbers near 1, and their differences
        let near = |ours: f64, page: f64, size: f64| (ours - page).abs() < 1e-9 * size;
        assert!(
            near(found[0], -out, out.max(1e-3)),
            "{found:?} instead of {}",
            -out
        );
        assert!(
            near(
                found[1],
                rate,
                enthalpy.abs() + pressure * area * 10.0 + 1.0
            ),
            "{found:?} instead of {rate}"
        );
        let force = (pressure - surrounding) * area;
        let page = Wrench::at(&body, point, times(force, n));
        same(
            "bag",
            scene.acts(&body, 0.0, &[mass, energy], &[]),
            page,
            1e5 * (force + surrounding * area),
        );
        full += usize::from(is_full && depth > 0.0);
        choked += usize::from(r * pressure > surrounding * 1.000_001);
        slack += usize::from(!is_full);
    }
    assert!(
        full > 10 && choked > 10 && slack > 10,
        "{full} {choked} {slack}"
    );
}

#[test]
fn springs() {
    let ends = "from: { on: one/body, at: [0.1, -0.05, 0.02] }, to: { on: frame, at: [1, 0, 0] }";
    let line = FreeBody::new(
        &format!("spring: s, {ends}, stiffness: 700, length: 0.8, damping: 60"),
        "",
    );
    let curved = FreeBody::new(
        &format!(
            "spring: s, {ends}, elastic: {{ points: [[-1, -900], [0, 0], [0.1, 500], [1, 2000]], extrapolate: linear }}"
        ),
        "",
    );
    const POINTS: [[f64; 2]; 4] = [[-1.0, -900.0], [0.0, 0.0], [0.1, 500.0], [1.0, 2000.0]];
    let mut random = Random::new(8);
    let mut pushes = 0;
    for _ in 0..STATES {
        let body = Moving::random(&mut random, [0.0; 3], 0.5);
        let from = body.point([0.1, -0.05, 0.02]);
        let span = minus([1.0, 0.0, 0.0], from);
        let (length, along) = (norm(span), unit(span));
        let rate = -dot(along, body.velocity_at(from));
        // at the start the body is at 0, not rotated
        let start = norm(minus([1.0, 0.0, 0.0], [0.1, -0.05, 0.02]));
        for (what, scene, force) in [
            ("line", &line, 700.0 * (length - 0.8) + 60.0 * rate),
            ("curved", &curved, curve(&POINTS, length - start)),
        ] {
            let page = Wrench::at(&body, from, times(force, along));
            same(
                what,
                scene.acts(&body, 0.4, &[], &[]),
                page,
                100.0 * (force.abs() + 2e3),
            );
            pushes += usize::from(force < 0.0);
        }
    }
    assert!(pushes > STATES / 4);
}

/// Rx(a) Ry(b) Rz(c)
fn turned([a, b, c]: Vector) -> Matrix {
    let (x, y, z) = (a.sin_cos(), b.sin_cos(), c.sin_cos());
    [
        [y.1 * z.1, -y.1 * z.0, y.0],
        [
            x.1 * z.0 + x.0 * y.0 * z.1,
            x.1 * z.1 - x.0 * y.0 * z.0,
            -x.0 * y.1,
        ],
        [
            x.0 * z.0 - x.1 * y.0 * z.1,
            x.0 * z.1 + x.1 * y.0 * z.0,
            x.1 * y.1,
        ],
    ]
}

/// a b
fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let columns: [Vector; 3] = std::array::from_fn(|j| apply(a, column(b, j)));
    std::array::from_fn(|i| columns.map(|column| column[i]))
}

#[test]
fn bushings() {
    const LAWS: &str = "along: { x: { elastic: { points: [[-1, -900], [0, 0], [0.1, 500], [1, 2000]], extrapolate: linear }, damping: 30 }, y: { stiffness: 700 }, z: { stiffness: 200, damping: 60 } }, about: { x: { stiffness: 3, damping: 0.4 }, y: { elastic: { points: [[-1, -3], [0, 0], [1, 2]], extrapolate: linear } }, z: { stiffness: 5, damping: 0.7 } }";
    const POINTS: [[f64; 2]; 4] = [[-1.0, -900.0], [0.0, 0.0], [0.1, 500.0], [1.0, 2000.0]];
    let own = "{ on: one/body, at: [0.1, -0.05, 0.02], axes: [0.3, -0.2, 0.5] }";
    let other = "{ on: frame, at: [0.2, 0.1, -0.1], axes: [-0.4, 0.1, 0.2] }";
    let first = FreeBody::new(&format!("bushing: b, from: {own}, to: {other}, {LAWS}"), "");
    let second = FreeBody::new(&format!("bushing: b, from: {other}, to: {own}, {LAWS}"), "");
    let mut random = Random::new(11);
    for _ in 0..STATES {
        let body = Moving::random(&mut random, [0.0; 3], 0.5);
        let mine = (
            product(&body.rotation, &turned([0.3, -0.2, 0.5])),
            body.point([0.1, -0.05, 0.02]),
        );
        let fixed = (turned([-0.4, 0.1, 0.2]), [0.2, 0.1, -0.1]);
        for (what, scene, is_first) in [("first", &first, true), ("second", &second, false)] {
            let ((a1, p1), (a2, p2)) = if is_first {
                (mine, fixed)
            } else {
                (fixed, mine)
            };
            // of the second body less the first, at p₂
            let sign = if is_first { -1.0 } else { 1.0 };
            let (velocity, omega) = (times(sign, body.velocity_at(p2)), times(sign, body.omega));
            let in_first = |v: Vector| [0, 1, 2].map(|i| dot(column(&a1, i), v));
            let (d, rate) = (in_first(minus(p2, p1)), in_first(velocity));
            let resists = [
                curve(&POINTS, d[0]) + 30.0 * rate[0],
                700.0 * d[1],
                200.0 * d[2] + 60.0 * rate[2],
            ];
            let force = apply(&a1, resists);

            let (x, z) = (column(&a1, 0), column(&a2, 2));
            let s = dot(x, z);
            let c2 = 1.0 - s * s;
            let entry = |i: usize, j: usize| dot(column(&a1, i), column(&a2, j));
            // A₁ᵀ A₂ = Rx Ry Rz
            let angles = [
                (-entry(1, 2)).atan2(entry(2, 2)),
                s.asin(),
                (-entry(0, 1)).atan2(entry(0, 0)),
            ];
            let n = [
                times(1.0 / c2, minus(x, times(s, z))),
                times(1.0 / c2.sqrt(), cross(z, x)),
                times(1.0 / c2, minus(z, times(s, x))),
            ];
            let turning = n.map(|n| dot(n, omega));
            let torques = [
                3.0 * angles[0] + 0.4 * turning[0],
                curve(&ELASTIC, angles[1]),
                5.0 * angles[2] + 0.7 * turning[2],
            ];
            let moment = (0..3).fold([0.0; 3], |sum, i| plus(sum, times(torques[i], n[i])));
            // on the first body; on the second the opposite
            let on_first = Wrench::at(&body, p2, force).and(Wrench {
                force: [0.0; 3],
                moment,
            });
            let page = Wrench {
                force: times(-sign, on_first.force),
                moment: times(-sign, on_first.moment),
            };
            let size = norm(page.force) + 4e3 + 30.0 * norm(moment) / (c2 * c2);
            same(what, scene.acts(&body, 0.4, &[], &[]), page, size);
        }
    }
}

#[test]
fn fields_and_loads() {
    let field = FreeBody::new(
        "field: f, acceleration: [1.5, { points: [[0, 0], [1, 4]] }, -9.81]",
        "",
    );
    let load = FreeBody::new(
        "load: l, on: one/body, at: [0.1, 0.2, -0.3], force: [3, { points: [[0, 0], [1, 4]] }, -5], moment: [0.5, -0.4, 0.3]",
        "",
    );
    let mut random = Random::new(7);
    for _ in 0..STATES {
        let body = Moving::random(&mut random, [0.0; 3], 1.0);
        let t = random.uniform(0.0, 1.0);
        let page = Wrench {
            force: times(MASS, [1.5, 4.0 * t, -9.81]),
            moment: [0.0; 3],
        };
        same("field", field.acts(&body, t, &[], &[]), page, 100.0);
        let moment = Wrench {
            force: [0.0; 3],
            moment: [0.5, -0.4, 0.3],
        };
        let point = body.point([0.1, 0.2, -0.3]);
        let page = Wrench::at(&body, point, [3.0, 4.0 * t, -5.0]).and(moment);
        same("load", load.acts(&body, t, &[], &[]), page, 100.0);
    }
}
