//! Joints with coordinates of their own, compared with results from elsewhere: the published motion of a stiff
//! mechanism, the same mechanism in absolute coordinates, one body in place of welded ones, and closed forms.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::{Dynamics, Formula, Integrator, Settings, Tolerances, simulate};
use std::collections::BTreeMap;
use std::ops::ControlFlow;

fn engine_of(text: &str) -> Engine {
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = bryant_generator::read_str("scene.yaml", text, &none)
        .unwrap_or_else(|problems| panic!("{problems}\n{text}"));
    Engine::new(Config::new().lists(&model)).expect("no functions")
}

/// The outputs at the start, by name.
fn at_start(text: &str) -> BTreeMap<String, f64> {
    let engine = engine_of(text);
    let machine = engine.over::<f64>();
    let mut y = vec![0.0; machine.info().state_length()];
    machine.initial_state(&mut y);
    let mut values = vec![0.0; machine.info().outputs.len()];
    machine.outputs(0.0, &y, &mut values);
    let names = machine.info().outputs.iter().map(|o| o.name.to_string());
    names.zip(values).collect()
}

#[track_caller]
fn same(found: f64, expected: f64, scale: f64) {
    let difference = (found - expected).abs();
    assert!(
        difference <= 1e-12 * scale,
        "{found} for {expected}: {difference:e}"
    );
}

/// A flyball governor: a shaft on a hinge, a slider on it, and two rods on hinges, each tied to the slider by a stiff
/// spring and damper. Rods and shaft are 0.01 m square with 3000 kg/m³, the masses at the tips are points, the slider
/// is a cube.
fn governor() -> String {
    let (rod, tip) = (0.3, 5.0);
    let mass = rod + tip;
    let cg = (rod * 0.5 + tip) / mass;
    let along = rod * 2.0 * 0.01f64.powi(2) / 12.0;
    let across = rod * (1.0 + 0.01f64.powi(2)) / 12.0
        + rod * (0.5 - cg) * (0.5 - cg)
        + tip * (1.0 - cg) * (1.0 - cg);
    let shaft = rod * (1.0 + 0.01f64.powi(2)) / 12.0;
    format!(
        "
model: governor
dimension: 3
systems:
  - name: governor
    reference: fixed
    elements:
      - {{ name: shaft, joint: {{ hinge: z }}, mass: {rod}, cg: [0, 0, 0.5], inertia: [{shaft}, {shaft}, {along}] }}
      - {{ name: slider, on: shaft, at: [0, 0, 0], joint: {{ slider: z }}, mass: 3, cg: [0, 0, 0], inertia: [0.005, 0.005, 0.005] }}
      - {{ name: right, on: shaft, at: [0.05, 0, 1], joint: {{ hinge: y }}, mass: {mass}, cg: [{cg}, 0, 0], inertia: [{along}, {across}, {across}] }}
      - {{ name: left, on: shaft, at: [-0.05, 0, 1], joint: {{ hinge: [0, -2, 0] }}, mass: {mass}, cg: [-{cg}, 0, 0], inertia: [{along}, {across}, {across}] }}
    start:
      joints: {{ right: 30 deg, left: 30 deg, slider: 0.5 }}
      joint_rates: {{ shaft: {rate} }}
forces:
  - {{ field: gravity, acceleration: [0, 0, -9.81] }}
  - {{ spring: right, from: {{ on: governor/slider, at: [0.05, 0, 0] }}, to: {{ on: governor/right, at: [0.5, 0, 0] }}, stiffness: 8e5, length: 0.5, damping: 4e4 }}
  - {{ spring: left, from: {{ on: governor/slider, at: [-0.05, 0, 0] }}, to: {{ on: governor/left, at: [-0.5, 0, 0] }}, stiffness: 8e5, length: 0.5, damping: 4e4 }}
outputs:
  - {{ name: slider, of: joint governor/slider, what: position }}
  - {{ name: rod, of: joint governor/right, what: angle }}
  - {{ name: shaft, of: joint governor/shaft, what: rate }}
run: {{ duration: 10 s, every: 0.5 s }}
",
        rate = 2.0 * std::f64::consts::PI * 0.16,
    )
}

#[test]
fn the_flyball_governor_moves_as_published() {
    let engine = engine_of(&governor());
    let machine = engine.over::<f64>();
    let settings = Settings {
        method: Integrator::adaptive(Formula::Dop853, Tolerances::of(1e-9)),
        ..Settings::of(machine.info())
    };
    let mut state = vec![0.0; machine.info().state_length()];
    machine.initial_state(&mut state);
    let mut rows = Vec::new();
    let report = simulate::run(&machine, &state, &settings, None, &mut |sample| {
        rows.push((sample.t, sample.outputs.to_vec()));
        ControlFlow::Continue(())
    });
    report.unwrap_or_else(|failure| panic!("{failure}"));
    // slider height [m], rod angle [rad], shaft speed [rad/s], with the published digits
    let published = [
        (
            0.5,
            [(0.01735175, 1e-8), (1.38403518, 1e-8), (15.0048, 1e-4)],
        ),
        (
            10.0,
            [(0.24916533, 1e-8), (0.8492687, 1e-7), (1.6696602, 1e-7)],
        ),
    ];
    for (time, expected) in published {
        let row = rows
            .iter()
            .find(|(t, _)| (t - time).abs() < 1e-9)
            .expect("a row");
        for (found, (value, digit)) in row.1.iter().zip(expected) {
            // the last digit is rounded, and the motion amplifies rounding differences between the two programs
            assert!(
                (found - value).abs() <= 2.0 * digit,
                "{found} for {value} at {time} s"
            );
        }
    }
}

/// A planar chain of three elements with all laws of a joint, on hinges in absolute or in relative coordinates.
fn chain(relative: bool, state: [f64; 6]) -> String {
    let [a, b, c, u, v, w] = state;
    let (joint, start) = match relative {
        false => (
            "",
            format!(
                "angles: {{ a: {a}, b: {}, c: {} }}, rates: {{ a: {u}, b: {}, c: {} }}",
                a + b,
                a + b + c,
                u + v,
                u + v + w
            ),
        ),
        true => (
            ", joint: { hinge: y }",
            format!(
                "joints: {{ a: {a}, b: {b}, c: {c} }}, joint_rates: {{ a: {u}, b: {v}, c: {w} }}"
            ),
        ),
    };
    format!(
        "
model: chain
dimension: 2
curves: {{ bent: {{ points: [[-1, -30], [0, 5], [0.5, 10]], extrapolate: linear }} }}
systems:
  - name: s
    reference: {{ acceleration: [3, -1] }}
    elements:
      - {{ name: a{joint}, mass: 2, cg: [0.1, 0.2], inertia: 0.05 }}
      - {{ name: b, on: a, at: [0.1, 0.5]{joint}, mass: 1.5, cg: [-0.1, 0.2], inertia: 0.03 }}
      - {{ name: c, on: b, at: [0, 0.4]{joint}, mass: 0.5, cg: [0.02, 0.15], inertia: 0.004 }}
    start: {{ {start} }}
forces:
  - {{ field: gravity, acceleration: [0, -9.81] }}
  - {{ joint: s/a, elastic: bent, neutral: 0.2, damping: 0.3 }}
  - {{ joint: s/b, stiffness: 20, friction: 2, stop: {{ from: -0.1, to: 0.3, stiffness: 100, damping: 2 }} }}
  - {{ joint: s/c, damping: 0.05, friction: 0.3, stop: {{ to: 0.1, stiffness: 30 }} }}
  - {{ spring: tie, from: {{ on: s/c, at: [0, 0.3] }}, to: {{ on: frame, at: [0.5, 1] }}, stiffness: 70, length: 0.2, damping: 3 }}
outputs:
  - {{ name: tip, of: s/c, what: acceleration, at: [0.1, 0.3], component: [x, z] }}
  - {{ name: turn, of: s/c, what: angular_acceleration }}
  - {{ name: force, of: joint s/b, what: force, component: [x, z] }}
  - {{ name: moment a, of: joint s/a, what: moment }}
  - {{ name: moment b, of: joint s/b, what: moment }}
  - {{ name: moment c, of: joint s/c, what: moment }}
  - {{ name: torque, of: joint s/b, what: torque }}
  - {{ name: energy, of: s, what: kinetic_energy }}
  - {{ name: momentum, of: s, what: angular_momentum }}
run: {{ duration: 1 s, every: 0.1 s }}
"
    )
}

#[test]
fn relative_coordinates_say_the_same_as_absolute_ones() {
    let states = [
        [0.3, 0.2, -0.4, 1.0, -2.0, 0.5],
        [-1.2, 0.7, 0.6, -3.0, 0.04, 2.0],
        [2.5, -1.6, -0.3, 0.0, 4.0, -5.0],
    ];
    for state in states {
        let [absolute, relative] = [false, true].map(|relative| at_start(&chain(relative, state)));
        assert_eq!(absolute.len(), relative.len());
        for (name, value) in &absolute {
            same(relative[name], *value, 1e3);
        }
    }
}

/// Two bodies, the second welded to the first, or both as one body: masses at (0.1, 0, 0) and (0.3, 0, 0.2) of the
/// frame; only the first has moments of inertia of its own. A hinge carries the pair, and the pair carries a ball.
fn pair(welded: bool) -> String {
    let bodies = match welded {
        true => "
      - { name: one, joint: { hinge: [1, 2, 2] }, mass: 2, cg: [0.1, 0, 0], inertia: [0.2, 0.3, 0.25] }
      - { name: two, on: one, at: [0.3, 0, 0.2], joint: weld, mass: 1, cg: [0, 0, 0], inertia: [0, 0, 0] }
      - { name: ball, on: two, at: [0, 0.1, 0.3], mass: 0.5, cg: [0.1, 0, -0.2], inertia: [0.02, 0.02, 0.01] }"
            .to_owned(),
        false => {
            // about the common centre of gravity c = (2 (0.1, 0, 0) + (0.3, 0, 0.2))/3: r = ±, reduced mass 2/3,
            // distance (0.2, 0, 0.2)
            let (xx, xz): (f64, f64) = (2.0 / 3.0 * 0.04, -2.0 / 3.0 * 0.04);
            let (a, b, c): (f64, f64, f64) = (0.2 + xx, 0.3 + 2.0 * xx, 0.25 + xx);
            // principal axes: a turn about y of [[a, xz], [xz, c]]
            let angle = 0.5 * (2.0 * xz).atan2(a - c);
            let (mean, half) = ((a + c) / 2.0, ((a - c) / 2.0).hypot(xz));
            format!(
                "
      - {{ name: one, joint: {{ hinge: [1, 2, 2] }}, mass: 3, cg: [{}, 0, {}], inertia: [{}, {b}, {}], axes: [0, {}, 0] }}
      - {{ name: ball, on: one, at: [0.3, 0.1, 0.5], mass: 0.5, cg: [0.1, 0, -0.2], inertia: [0.02, 0.02, 0.01] }}",
                0.5 / 3.0,
                0.2 / 3.0,
                mean + half,
                mean - half,
                -angle
            )
        }
    };
    format!(
        "
model: pair
dimension: 3
systems:
  - name: s
    reference: fixed
    elements:{bodies}
    start: {{ joints: {{ one: 0.4 }}, joint_rates: {{ one: 3 }}, angles: {{ ball: [0.2, 0.3, -0.4] }}, rates: {{ ball: [1, 2, -3] }} }}
forces:
  - {{ field: gravity, acceleration: [1, 2, -9.81] }}
outputs:
  - {{ name: swing, of: joint s/one, what: acceleration }}
  - {{ name: ball, of: s/ball, what: acceleration, at: [0.1, 0.2, 0.3], component: [x, y, z] }}
  - {{ name: force, of: joint s/one, what: force, component: [x, y, z] }}
  - {{ name: moment, of: joint s/one, what: moment, component: [x, y, z] }}
  - {{ name: momentum, of: s, what: angular_momentum, component: [x, y, z] }}
  - {{ name: energy, of: s, what: kinetic_energy }}
run: {{ duration: 1 s, every: 0.1 s }}
"
    )
}

#[test]
fn welded_bodies_are_one() {
    let [two, one] = [true, false].map(|welded| at_start(&pair(welded)));
    for (name, value) in &one {
        same(two[name], *value, 1e2);
    }
}

#[test]
fn a_joint_holds_what_it_does_not_let_go() {
    // An arm about z with the mass m at (r, 0, h) turns at Ω: a = −Ω² r along x. Its joint carries the force m (a − g)
    // and the moment of that force.
    let values = at_start(
        "
model: turntable
dimension: 3
systems:
  - name: s
    reference: fixed
    elements: [{ name: arm, joint: { hinge: z }, mass: 2, cg: [0.5, 0, 0.3], inertia: [0.1, 0.1, 0.1] }]
    start: { joint_rates: { arm: 4 } }
forces: [{ field: gravity, acceleration: [0, 0, -10] }]
outputs:
  - { name: force, of: joint s/arm, what: force, component: [x, y, z] }
  - { name: moment, of: joint s/arm, what: moment, component: [x, y, z] }
  - { name: on frame, of: joint s/arm, what: moment, on: frame, component: y }
run: { duration: 1 s, every: 0.1 s }
",
    );
    let force = [-2.0 * 16.0 * 0.5, 0.0, 20.0];
    let moment = [0.0, 0.3 * force[0] - 0.5 * force[2], 0.0];
    for (axis, (force, moment)) in ["x", "y", "z"].iter().zip(force.into_iter().zip(moment)) {
        same(values[&format!("force {axis}")], force, 20.0);
        same(values[&format!("moment {axis}")], moment, 20.0);
    }
    same(values["on frame"], -moment[1], 20.0);
}

#[test]
fn a_screw_and_a_slider_follow_their_closed_forms() {
    // A nut of mass m and moment J about the screw, of advance h, falls by q̈ = −m g h/(J + m h²); a slider on a slope
    // under its own spring and damper.
    let values = at_start(
        "
model: screw
dimension: 3
systems:
  - name: nut
    reference: fixed
    elements: [{ name: body, joint: { screw: z, pitch: 0.6283185307179586 }, mass: 2, cg: [0, 0, 0.1], inertia: [0.1, 0.1, 0.03] }]
  - name: sled
    reference: { on: car, at: [1, 0, 0] }
    elements: [{ name: body, joint: { slider: [1, 0, -1], zero: 0.1 }, mass: 3, cg: [0.2, 0.1, 0], inertia: [0.1, 0.1, 0.1] }]
    start: { joints: { body: 0.2 }, joint_rates: { body: 0.5 } }
vehicles: [{ name: car, angles: [0, 0, 90 deg], acceleration: [0, 2, 0], start: { velocity: [0, 3, 0] } }]
forces:
  - { field: gravity, acceleration: [0, 0, -10] }
  - { joint: sled/body, stiffness: 60 N/m, neutral: 0.05, damping: 4 N*s/m }
outputs:
  - { name: nut, of: joint nut/body, what: acceleration }
  - { name: sled, of: joint sled/body, what: acceleration }
  - { name: effort, of: joint sled/body, what: effort }
  - { name: at, of: sled/body, what: position, at: [0, 0, 0], component: [x, y, z] }
  - { name: speed, of: sled/body, what: velocity, at: [0, 0, 0], component: [x, y, z] }
run: { duration: 1 s, every: 0.1 s }
",
    );
    let h = 0.1;
    same(values["nut"], -2.0 * 10.0 * h / (0.03 + 2.0 * h * h), 40.0);
    let effort = -60.0 * (0.2 - 0.05) - 4.0 * 0.5;
    same(values["effort"], effort, 10.0);
    // the car is turned by 90° about z: the slide is along (0, 1, −1)/√2
    let along = 0.5f64.sqrt();
    let driven = 10.0 * along - 2.0 * along;
    same(values["sled"], effort / 3.0 + driven, 10.0);
    for (axis, at, speed) in [
        ("x", 0.0, 0.0),
        ("y", 1.0 + 0.3 * along, 3.0 + 0.5 * along),
        ("z", -0.3 * along, -0.5 * along),
    ] {
        same(values[&format!("at {axis}")], at, 1.0);
        same(values[&format!("speed {axis}")], speed, 10.0);
    }
}
