//! Outputs with a direction, compared with balances that are independent of them: rates along the motion, momentum,
//! angular momentum.
//!
//! A rate along the motion is (g(t + h, y + h ẏ) − g(t − h, y − h ẏ)) / 2h. Its error is h² times the third derivative,
//! plus the rounding of g over h.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::Dynamics;

/// Step of differences \[s\].
const H: f64 = 1e-5;
/// Motions here have frequencies up to 20/s, so h² 20³ is 1e-6 of a quantity; rounding over h is 1e-11.
const TOLERANCE: f64 = 1e-5;
/// Times of the comparisons \[s\], with the same coordinates. None is at a point of a curve, where accelerations jump.
const TIMES: [f64; 3] = [0.007, 0.031, 0.077];

/// A dummy strapped to a car that turns about all axes; a flying ball strikes its head.
const SCENE: &str = "
model: rider
dimension: 3
curves:
  brake: { unit: [ms, m/s^2], points: [[0, 0], [100, -200]], extrapolate: linear }
  roll: { points: [[-1, -3], [0, 0.2], [0.1, 0.5], [1, 2]], interpolate: cubic }
vehicles:
  - { name: car, acceleration: [brake, 3, 1], angles: [roll, { curve: roll, times: 0.7 }, { curve: roll, times: -0.4 }],
      start: { position: [1, 2, 3], velocity: [12, 1, 0] } }
systems:
  - name: man
    reference: { on: car, at: [0.3, 0.1, 0.4] }
    elements:
      - { name: torso, mass: 30 kg, cg: [0.02, 0.01, 0.2], inertia: [1.1, 1.0, 0.4], axes: [0.1, 0.2, 0.3] }
      - { name: head, on: torso, at: [0.01, 0, 0.45], mass: 4.5 kg, cg: [0.02, 0, 0.1], inertia: [0.03, 0.03, 0.03] }
      - { name: arm, on: torso, at: [0, 0.2, 0.4], mass: 3 kg, cg: [0, 0.02, -0.2], inertia: [0.05, 0.05, 0.01] }
      - { name: hand, on: arm, at: [0, 0, -0.4], mass: 1 kg, cg: [0, 0, -0.1], inertia: [0.01, 0.01, 0.01] }
    start:
      angles: { torso: [0.2, -0.3, 0.4], head: [-0.3, 0.5, 0.1], arm: [0.7, 0.9, -0.2], hand: [0.1, 0.2, 0.9] }
      rates: { torso: [3, -2, 5], head: [-4, 6, 1], arm: [2, -9, 4], hand: [5, 5, -7] }
  - name: ball
    elements: [{ name: shell, mass: 2 kg, cg: [0, 0, 0], inertia: [0.01, 0.01, 0.01] }]
    start: { position: [1.5, 2, 4.2], velocity: [3, -1, -5], rates: { shell: [9, 8, -7] } }
forces:
  - { field: gravity, acceleration: [0, 0, -9.81] }
  - { field: wind, acceleration: [0, 4, 0], on: [man/arm] }
  - joint: man/torso
    about: { x: { damping: 3 }, y: { elastic: { points: [[-1, -900], [1, 900]], extrapolate: linear } } }
    flexion: { damping: 2 }
  - { joint: man/head, flexion: { elastic: { points: [[0, 0], [1, 40]], extrapolate: linear }, damping: 0.7 }, torsion: { damping: 0.5 } }
  - { joint: man/hand, about: { z: { elastic: { points: [[-1, -3], [1, 4]], extrapolate: linear } } } }
  - belt: chest
    from: { on: man/torso, at: [0.1, 0, 0.35] }
    to: { on: car, at: [-0.4, 0.2, 0.9] }
    force: { points: [[0, 0], [0.1, 600]], extrapolate: linear }
    length: 0.5 m
  - contact: struck
    ellipsoid: { on: ball/shell, center: [0, 0, 0], semi_axes: [0.2, 0.3, 0.4] }
    with: { on: man/head, center: [0, 0, 0.1], semi_axes: [0.5, 0.6, 0.7] }
    elastic: { points: [[0, 0], [1, 3 kN]], extrapolate: linear }
    friction: 0.4
    friction_speed: 1
";

/// A model with three components of each output, by name.
struct Seen {
    engine: Engine,
    names: Vec<String>,
}

impl Seen {
    /// Each of `outputs` is a name and all other keys of an output except `component`.
    fn of(outputs: &[(&str, &str)]) -> Seen {
        let mut text = format!("{SCENE}outputs:\n");
        let mut names = Vec::new();
        for (name, keys) in outputs {
            for component in ["x", "y", "z"] {
                text += &format!(
                    "  - {{ name: {name} {component}, {keys}, component: {component} }}\n"
                );
            }
            names.push((*name).to_owned());
        }
        let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
        let (model, _) = bryant_generator::read_str("rider.yaml", &text, &none)
            .unwrap_or_else(|e| panic!("{e}"));
        let engine = Engine::new(Config::new().lists(&model)).expect("an engine");
        Seen { engine, names }
    }

    fn at(&self, name: &str, t: f64, y: &[f64]) -> [f64; 3] {
        let first = 3 * self
            .names
            .iter()
            .position(|n| n == name)
            .expect("an output");
        let machine = self.engine.over::<f64>();
        let mut all = vec![0.0; machine.info().outputs.len()];
        machine.outputs(t, y, &mut all);
        std::array::from_fn(|i| all[first + i])
    }

    fn start(&self) -> Vec<f64> {
        let machine = self.engine.over::<f64>();
        let mut y = vec![0.0; machine.info().state_length()];
        machine.initial_state(&mut y);
        y
    }

    /// The rate of an output along the motion.
    fn rate(&self, name: &str, t: f64, y: &[f64]) -> [f64; 3] {
        let machine = self.engine.over::<f64>();
        let mut rate = vec![0.0; y.len()];
        machine.derivative(t, y, &mut rate);
        let moved = |h: f64| -> Vec<f64> { y.iter().zip(&rate).map(|(y, r)| y + h * r).collect() };
        let (after, before) = (
            self.at(name, t + H, &moved(H)),
            self.at(name, t - H, &moved(-H)),
        );
        std::array::from_fn(|i| (after[i] - before[i]) / (2.0 * H))
    }
}

fn sum(vectors: &[[f64; 3]]) -> [f64; 3] {
    vectors
        .iter()
        .fold([0.0; 3], |sum, v| std::array::from_fn(|i| sum[i] + v[i]))
}

fn times(factor: f64, v: [f64; 3]) -> [f64; 3] {
    v.map(|x| factor * x)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    sum(&[a, times(-1.0, b)])
}

fn size(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[track_caller]
fn equal(what: &str, found: [f64; 3], wanted: [f64; 3], scale: f64) {
    assert!(scale > 1e-3, "{what}: nothing to compare");
    let off = size(minus(found, wanted));
    assert!(
        off < TOLERANCE * scale,
        "{what}: {found:?} instead of {wanted:?}"
    );
}

#[test]
fn what_an_observer_sees_are_the_rates_of_what_he_sees() {
    for observer in ["car", "man/torso", "ball/shell", "frame"] {
        for (body, at) in [
            ("man/hand", ", at: [0.1, 0.2, 0.3]"),
            ("car", ", at: [1, 2, 3]"),
            ("man/arm", ""),
        ] {
            if body == observer {
                continue;
            }
            let keys =
                |what: &str| format!("of: {body}, what: {what}{at}, relative_to: {observer}");
            let of = |what: &str| format!("of: {body}, what: {what}, relative_to: {observer}");
            let seen = Seen::of(&[
                ("position", &keys("position")),
                ("displacement", &keys("displacement")),
                ("velocity", &keys("velocity")),
                ("acceleration", &keys("acceleration")),
                ("angular velocity", &of("angular_velocity")),
                ("angular acceleration", &of("angular_acceleration")),
                (
                    "in other axes",
                    &format!("{}, axes: man/head", keys("acceleration")),
                ),
            ]);
            let y = seen.start();
            for t in TIMES {
                let what = |what: &str| format!("{what} of {body} relative to {observer} at {t} s");
                let velocity = seen.at("velocity", t, &y);
                for from in ["position", "displacement"] {
                    equal(
                        &what(from),
                        seen.rate(from, t, &y),
                        velocity,
                        size(velocity).max(1.0),
                    );
                }
                let acceleration = seen.at("acceleration", t, &y);
                equal(
                    &what("velocity"),
                    seen.rate("velocity", t, &y),
                    acceleration,
                    size(acceleration),
                );
                let turning = seen.at("angular acceleration", t, &y);
                let found = seen.rate("angular velocity", t, &y);
                equal(&what("angular velocity"), found, turning, size(turning));
                // a vector has the same length in all axes
                let other = size(seen.at("in other axes", t, &y));
                assert!((other - size(acceleration)).abs() < 1e-12 * other);
            }
        }
    }
}

#[test]
fn axes_of_a_body_turn_with_it() {
    // d(Aᵀ v)/dt + ω_local × (Aᵀ v) = Aᵀ v̇
    let seen = Seen::of(&[
        ("velocity", "of: man/hand, what: velocity, axes: man/head"),
        (
            "acceleration",
            "of: man/hand, what: acceleration, axes: man/head",
        ),
        ("omega", "of: man/head, what: angular_velocity, axes: local"),
    ]);
    let y = seen.start();
    for t in TIMES {
        let (velocity, omega) = (seen.at("velocity", t, &y), seen.at("omega", t, &y));
        let found = sum(&[seen.rate("velocity", t, &y), cross(omega, velocity)]);
        let acceleration = seen.at("acceleration", t, &y);
        equal("acceleration", found, acceleration, size(acceleration));
    }
}

#[test]
fn joints_transmit_what_accelerates_all_that_they_carry() {
    let bodies = [("torso", 30.0), ("head", 4.5), ("arm", 3.0), ("hand", 1.0)];
    let mut outputs = vec![("momentum".to_owned(), "of: man, what: momentum".to_owned())];
    for (name, _) in bodies {
        outputs.push((
            format!("{name} velocity"),
            format!("of: man/{name}, what: velocity"),
        ));
        outputs.push((
            format!("{name} force"),
            format!("of: joint man/{name}, what: force"),
        ));
    }
    for (name, keys) in [
        ("belt", "of: belt chest, what: force, on: man/torso"),
        ("strike", "of: contact struck, what: force, on: man/head"),
        ("ball", "of: contact struck, what: force, axes: frame"),
        ("ball velocity", "of: ball/shell, what: velocity"),
        ("on arm", "of: joint man/hand, what: force, on: man/arm"),
        (
            "on car",
            "of: joint man/torso, what: force, on: car, axes: frame",
        ),
    ] {
        outputs.push((name.to_owned(), keys.to_owned()));
    }
    let outputs: Vec<(&str, &str)> = outputs.iter().map(|(a, b)| (&**a, &**b)).collect();
    let seen = Seen::of(&outputs);
    let y = seen.start();
    for t in TIMES {
        let at = |name: &str| seen.at(name, t, &y);
        // m (v̇ − g) of an element
        let free = |name: &str| {
            let mass = bodies.iter().find(|(n, _)| *n == name).unwrap().1;
            let wind = if name == "arm" { 4.0 } else { 0.0 };
            let rate = seen.rate(&format!("{name} velocity"), t, &y);
            times(mass, minus(rate, [0.0, wind, -9.81]))
        };
        let (belt, strike) = (at("belt"), at("strike"));
        assert!(
            size(belt) > 100.0 && size(strike) > 10.0,
            "{belt:?} {strike:?}"
        );
        let scale = size(free("torso")) + size(belt) + size(strike);
        equal("hand", at("hand force"), free("hand"), scale);
        equal(
            "arm",
            at("arm force"),
            sum(&[free("arm"), free("hand")]),
            scale,
        );
        equal("head", at("head force"), minus(free("head"), strike), scale);
        let all = bodies.map(|(name, _)| free(name));
        let root = minus(sum(&all), sum(&[belt, strike]));
        equal("torso", at("torso force"), root, scale);
        let lost = minus(seen.rate("momentum", t, &y), times(38.5, [0.0, 0.0, -9.81]));
        let root = minus(lost, sum(&[belt, strike, times(3.0, [0.0, 4.0, 0.0])]));
        equal("all", at("torso force"), root, scale);
        equal(
            "hand on arm",
            at("on arm"),
            times(-1.0, at("hand force")),
            scale,
        );
        equal(
            "torso on car",
            at("on car"),
            times(-1.0, at("torso force")),
            scale,
        );
        equal("ball", at("ball"), times(-1.0, strike), scale);
        let ball = times(
            2.0,
            minus(seen.rate("ball velocity", t, &y), [0.0, 0.0, -9.81]),
        );
        equal("ball by its motion", at("ball"), ball, scale);
    }
}

#[test]
fn joints_transmit_the_moment_that_turns_what_they_carry() {
    let seen = Seen::of(&[
        ("hand omega", "of: man/hand, what: angular_velocity"),
        ("hand joint", "of: man/hand, what: position, at: [0, 0, 0]"),
        ("hand cg", "of: man/hand, what: position"),
        ("hand force", "of: joint man/hand, what: force"),
        ("hand moment", "of: joint man/hand, what: moment"),
        ("arm moment", "of: joint man/arm, what: moment"),
        ("on arm", "of: joint man/hand, what: moment, on: man/arm"),
        ("momentum", "of: man, what: angular_momentum"),
        ("root", "of: man/torso, what: position, at: [0, 0, 0]"),
        ("cg", "of: man, what: position"),
        ("arm cg", "of: man/arm, what: position"),
        ("strap", "of: man/torso, what: position, at: [0.1, 0, 0.35]"),
        ("root force", "of: joint man/torso, what: force"),
        ("root moment", "of: joint man/torso, what: moment"),
        ("belt", "of: belt chest, what: force"),
        ("strike", "of: contact struck, what: force"),
        ("ball spin", "of: ball, what: angular_momentum"),
        ("ball place", "of: ball, what: position"),
    ]);
    let y = seen.start();
    for t in TIMES {
        let at = |name: &str| seen.at(name, t, &y);
        // about the centre of gravity of the hand, whose moments of inertia are equal
        let arm = minus(at("hand joint"), at("hand cg"));
        let turned = times(0.01, seen.rate("hand omega", t, &y));
        let moment = minus(turned, cross(arm, at("hand force")));
        equal("hand", at("hand moment"), moment, size(turned) + 0.1);
        equal(
            "arm on hand",
            at("on arm"),
            times(-1.0, moment),
            size(turned) + 0.1,
        );
        // no law acts in the joint of the arm
        assert_eq!(at("arm moment"), [0.0; 3]);
        // the whole dummy, about the origin; the moment of the strike follows from its effect on the ball
        let weight = [0.0, 0.0, -9.81];
        let ball = minus(
            seen.rate("ball spin", t, &y),
            cross(at("ball place"), times(2.0, weight)),
        );
        let others = sum(&[
            cross(at("root"), at("root force")),
            cross(at("cg"), times(38.5, weight)),
            cross(at("arm cg"), times(3.0, [0.0, 4.0, 0.0])),
            cross(at("strap"), at("belt")),
            times(-1.0, ball),
        ]);
        let rate = seen.rate("momentum", t, &y);
        equal(
            "dummy",
            at("root moment"),
            minus(rate, others),
            size(rate) + size(others),
        );
        assert!(
            size(at("root moment")) > 100.0 * TOLERANCE * (size(rate) + size(others)),
            "the moment does not show"
        );
    }
}

/// Outputs of a scene at its start, by name.
fn at_start(text: &str) -> Vec<(String, f64)> {
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) =
        bryant_generator::read_str("scene.yaml", text, &none).unwrap_or_else(|e| panic!("{e}"));
    let engine = Engine::new(Config::new().lists(&model)).expect("an engine");
    let machine = engine.over::<f64>();
    let mut y = vec![0.0; machine.info().state_length()];
    machine.initial_state(&mut y);
    let mut all = vec![0.0; machine.info().outputs.len()];
    machine.outputs(0.0, &y, &mut all);
    let names = model.outputs.iter().map(|output| output.name.clone());
    names.zip(all).collect()
}

#[test]
fn relative_angles_are_those_of_the_joint() {
    let found = at_start(&format!(
        "{SCENE}  - {{ joint: man/arm, about: {{ x: {{ damping: 1 }}, y: {{ damping: 1 }}, z: {{ damping: 1 }} }} }}
outputs:
  - {{ name: x, of: man/arm, what: angle, component: x, relative_to: man/torso }}
  - {{ name: joint x, of: joint man/arm, what: angle, about: x }}
  - {{ name: y, of: man/arm, what: angle, component: y, relative_to: man/torso }}
  - {{ name: joint y, of: joint man/arm, what: angle, about: y }}
  - {{ name: z, of: man/arm, what: angle, component: z, relative_to: man/torso }}
  - {{ name: joint z, of: joint man/arm, what: angle, about: z }}
"
    ));
    for pair in found.chunks(2) {
        let [(name, seen), (_, wanted)] = pair else {
            unreachable!()
        };
        assert!(
            seen.abs() > 0.05 && (seen - wanted).abs() < 1e-14,
            "{name}: {seen} {wanted}"
        );
    }
}

#[test]
fn the_one_turn_between_two_bodies_has_its_angle() {
    // two rotations about the same axis, (1, 2, 2)/3: by 0.4 and by 0.4 + angle
    for angle in [1e-7, 0.3, 1.5, 3.0, std::f64::consts::PI - 1e-7] {
        let bryant = |angle: f64| {
            // A = cos I + sin [n]× + (1 − cos) n nᵀ
            let (n, c, s) = ([1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0], angle.cos(), angle.sin());
            let a = |i: usize, j: usize| {
                let cross = match (3 + j - i) % 3 {
                    0 => c,
                    1 => -s * n[(i + 2) % 3],
                    _ => s * n[(i + 1) % 3],
                };
                cross + (1.0 - c) * n[i] * n[j]
            };
            [
                f64::atan2(-a(1, 2), a(2, 2)),
                a(0, 2).asin(),
                f64::atan2(-a(0, 1), a(0, 0)),
            ]
        };
        let found = at_start(&format!(
            "model: two\ndimension: 3\nsystems:
  - name: one
    elements: [{{ name: body, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }}]
    start: {{ angles: {{ body: {:?} }} }}
  - name: other
    elements: [{{ name: body, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }}]
    start: {{ angles: {{ body: {:?} }} }}
outputs:
  - {{ name: between, of: other/body, what: angle, component: resultant, relative_to: one/body }}
  - {{ name: back, of: one/body, what: angle, component: resultant, relative_to: other/body }}
  - {{ name: whole, of: other/body, what: angle, component: resultant }}
",
            bryant(0.4),
            bryant(0.4 + angle)
        ));
        // near 0 and π as exact as elsewhere: rounding of the matrices, a few ε
        assert!((found[0].1 - angle).abs() < 4e-15, "{angle}: {found:?}");
        assert!((found[1].1 - angle).abs() < 4e-15, "{angle}: {found:?}");
        let whole = if 0.4 + angle > std::f64::consts::PI {
            2.0 * std::f64::consts::PI - 0.4 - angle
        } else {
            0.4 + angle
        };
        assert!((found[2].1 - whole).abs() < 4e-15, "{angle}: {found:?}");
    }
}

#[test]
fn a_pendulum_pulls_at_its_hinge() {
    // m l θ'² + m g cos θ along the rod; across it, the part that the rod does not carry
    let (m, l, g, angle, rate) = (2.0, 0.7, 9.81, 0.6f64, 3.0);
    let found = at_start(&format!(
        "model: pendulum\ndimension: 2\nsystems:
  - name: rod
    reference: fixed
    elements: [{{ name: bob, mass: {m}, cg: [0, -{l}], inertia: 0 }}]
    start: {{ position: [1, 2], angles: {{ bob: {angle} }}, rates: {{ bob: {rate} }} }}
forces:
  - {{ field: gravity, acceleration: [0, -{g}] }}
  - {{ joint: rod/bob, elastic: {{ points: [[0, 0], [1, 5]], extrapolate: linear }} }}
outputs:
  - {{ name: along, of: joint rod/bob, what: force, component: z, axes: local }}
  - {{ name: across, of: joint rod/bob, what: force, component: x, axes: rod/bob }}
  - {{ name: size, of: joint rod/bob, what: force }}
  - {{ name: on ceiling, of: joint rod/bob, what: force, component: z, axes: rod/bob, on: frame }}
  - {{ name: moment, of: joint rod/bob, what: moment }}
  - {{ name: moment on ceiling, of: joint rod/bob, what: moment, on: frame }}
"
    ));
    let along = m * l * rate * rate + m * g * angle.cos();
    let torque = -5.0 * angle;
    // a rod without inertia about its end: torque + l F = 0
    let across = -torque / l;
    for (name, wanted) in [
        ("along", along),
        ("across", across),
        ("size", along.hypot(across)),
        ("on ceiling", -along),
        ("moment", torque),
        ("moment on ceiling", -torque),
    ] {
        let value = found.iter().find(|(n, _)| n == name).unwrap().1;
        assert!(
            (value - wanted).abs() < 1e-12 * along,
            "{name}: {value} instead of {wanted}"
        );
    }
}

#[test]
fn forces_have_the_signs_that_the_reference_states() {
    let found = at_start(
        "model: signs\ndimension: 2\nsystems:
  - name: puck
    elements: [{ name: disc, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { position: [0, 0.09], velocity: [2, 0] }
forces:
  - contact: floor
    ellipsoid: { on: puck/disc, center: [0, 0], semi_axes: [0.1, 0.1] }
    plane: { on: frame, at: [0, 0], normal: [0, 1] }
    elastic: { points: [[0, 0], [10 mm, 100]], extrapolate: linear }
    friction: 0.5
  - { belt: rope, from: { on: puck/disc, at: [0, 0] }, to: { on: frame, at: [-1, 0.09] }, length: 0.9, force: { points: [[0, 0], [1, 90]], extrapolate: linear } }
outputs:
  - { name: penetration, of: contact floor, what: penetration }
  - { name: normal, of: contact floor, what: normal }
  - { name: friction, of: contact floor, what: friction }
  - { name: x, of: contact floor, what: force, component: x }
  - { name: z, of: contact floor, what: force, component: z }
  - { name: on floor, of: contact floor, what: force, component: z, on: frame }
  - { name: size, of: contact floor, what: force }
  - { name: tension, of: belt rope, what: force }
  - { name: pull, of: belt rope, what: force, component: x }
  - { name: on wall, of: belt rope, what: force, component: x, on: frame }
",
    );
    for (name, wanted) in [
        ("penetration", 0.01),
        ("normal", 100.0),
        ("friction", -50.0),
        ("x", -50.0),
        ("z", 100.0),
        ("on floor", -100.0),
        ("size", 100f64.hypot(50.0)),
        ("tension", 10.0),
        ("pull", -10.0),
        ("on wall", 10.0),
    ] {
        let value = found.iter().find(|(n, _)| n == name).unwrap().1;
        assert!(
            (value - wanted).abs() < 1e-10,
            "{name}: {value} instead of {wanted}"
        );
    }
}

#[test]
fn a_stiffness_is_a_straight_curve() {
    let scene = |joint: &str, contact: &str, belts: [&str; 2]| {
        let [one, two] = belts;
        at_start(&format!(
            "model: short\ndimension: 2\nparameters: {{ k: 70 N*m }}\nsystems:
  - name: puck
    elements:
      - {{ name: disc, mass: 1, cg: [0, 0], inertia: 1 }}
      - {{ name: arm, on: disc, at: [0, 0], mass: 1, cg: [0, 0.1], inertia: 1 }}
    start: {{ position: [0, 0.09], angles: {{ arm: 20 deg }} }}
forces:
  - {{ joint: puck/arm, {joint}, neutral: 5 deg }}
  - contact: floor
    ellipsoid: {{ on: puck/disc, center: [0, 0], semi_axes: [0.1, 0.1] }}
    plane: {{ on: frame, at: [0, 0], normal: [0, 1] }}
    {contact}
  - {{ belt: rope, from: {{ on: puck/disc, at: [0, 0] }}, to: {{ on: frame, at: [-1, 0.09] }}, length: 0.9, {one} }}
  - {{ belt: cord, from: {{ on: puck/disc, at: [0, 0] }}, to: {{ on: frame, at: [1, 0.09] }}, pretension: 7, {two} }}
outputs:
  - {{ name: torque, of: joint puck/arm, what: torque }}
  - {{ name: normal, of: contact floor, what: normal }}
  - {{ name: rope, of: belt rope, what: force }}
  - {{ name: cord, of: belt cord, what: untensioned_length }}
"
        ))
    };
    let short = scene(
        "stiffness: k",
        "stiffness: 10 N/mm",
        ["stiffness: 0.5 N/mm", "stiffness: 90 N"],
    );
    let line = |slope: f64| format!("{{ points: [[0, 0], [1, {slope}]], extrapolate: linear }}");
    let long = scene(
        "elastic: { points: [[0, 0], [1, 70]], extrapolate: linear }",
        &format!("elastic: {}", line(1e4)),
        [
            &format!("force: {}", line(450.0)),
            &format!("force: {}", line(90.0)),
        ],
    );
    let fifteen = 15f64.to_radians();
    for ((one, other), wanted) in
        short
            .iter()
            .zip(&long)
            .zip([-70.0 * fifteen, 100.0, 50.0, 1.0 / (1.0 + 7.0 / 90.0)])
    {
        assert!(
            (one.1 - wanted).abs() < 1e-10,
            "{one:?} instead of {wanted}"
        );
        assert!(
            (one.1 - other.1).abs() < 1e-12 * wanted.abs(),
            "{one:?} {other:?}"
        );
    }
}

#[test]
fn several_forces_in_one_joint_add_up() {
    let found = at_start(
        "model: knee\ndimension: 2\nsystems:
  - name: leg
    reference: fixed
    elements: [{ name: shank, mass: 1, cg: [0, -0.2], inertia: 0.1 }]
    start: { angles: { shank: 0.5 }, rates: { shank: 2 } }
forces:
  - { joint: leg/shank, stiffness: 300, until: broken }
  - { joint: leg/shank, name: residual, stiffness: 20, damping: 3, since: broken }
  - { joint: leg/shank, name: skin, damping: 4 }
switches: [{ switch: broken, when: { of: joint leg/shank/residual, what: angle, above: 0.6 } }]
outputs:
  - { name: whole, of: joint leg/shank, what: torque }
  - { name: residual, of: joint leg/shank/residual, what: torque }
  - { name: skin, of: joint leg/shank/skin, what: torque }
  - { name: together, of: joint leg/shank, what: moment }
",
    );
    let values: Vec<f64> = found.iter().map(|(_, value)| *value).collect();
    assert_eq!(values, [-150.0, 0.0, -8.0, -158.0]);
}

#[test]
fn a_spring_pushes_and_pulls() {
    let at = |z: f64, rate: f64| {
        let found = at_start(&format!(
            "model: strut\ndimension: 2\nparameters: {{ k: 200 N/m }}\nsystems:
  - name: man
    elements: [{{ name: torso, mass: 1, cg: [0, 0], inertia: 1 }}]
    start: {{ position: [0, {z}], velocity: [0, {rate}] }}
forces:
  - {{ spring: strut, from: {{ on: man/torso, at: [0, 0] }}, to: {{ on: frame, at: [0, 0] }}, stiffness: k, length: 0.5, damping: 10 }}
  - {{ spring: relaxed, from: {{ on: man/torso, at: [0, 0] }}, to: {{ on: frame, at: [1, 0] }}, stiffness: k }}
outputs:
  - {{ name: force, of: spring strut, what: force }}
  - {{ name: length, of: spring strut, what: length }}
  - {{ name: elongation, of: spring strut, what: elongation }}
  - {{ name: rate, of: spring strut, what: rate }}
  - {{ name: vector, of: spring strut, what: force, component: z }}
  - {{ name: on frame, of: spring strut, what: force, component: z, on: frame }}
  - {{ name: relaxed, of: spring relaxed, what: force }}
  - {{ name: acceleration, of: man/torso, what: acceleration, component: z }}
"
        ));
        found
            .into_iter()
            .map(|(_, value)| value)
            .collect::<Vec<f64>>()
    };
    // in tension: the man is above, and the spring pulls him down
    let close = |found: Vec<f64>, wanted: [f64; 8]| {
        for (found, wanted) in found.iter().zip(wanted) {
            assert!(
                (found - wanted).abs() < 1e-12,
                "{found} instead of {wanted}"
            );
        }
    };
    close(at(0.7, 2.0), [60.0, 0.7, 0.2, 2.0, -60.0, 60.0, 0.0, -60.0]);
    close(
        at(0.3, 2.0),
        [-20.0, 0.3, -0.2, 2.0, 20.0, -20.0, 0.0, 20.0],
    );
}
