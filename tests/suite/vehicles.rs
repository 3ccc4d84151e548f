//! Vehicles: bodies attached to them move relative to them as expected, wherever the vehicles are.

use crate::motion::{close, run_with_bound};
use crate::prescribed_motion::{compare_with_lagrange, scaled, wave};
use bryant::evaluation::functions;
use bryant::pose::{Layout, Numbers, Pose};
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::Route;
use bryant_generator::expression::NodeId;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::model::{
    Attachment, Body, Coordinates, Dimension, ElementId, FieldComponent, Given, Interpolate, Model,
    Number, Reference, Translation, Vehicle,
};
use bryant_generator::read_str;
use bryant_runtime::Model as _;
use bryant_tests::models::{MODELS, stops, vehicle, vehicle_turned};
use bryant_tests::trees::{Random, Shape, random_charts, random_state, random_tree};

#[test]
fn a_braking_sled_is_a_field_seen_from_it() {
    let (motion, bounds) = run_with_bound::<vehicle::Mechanism<f64>>(0.01, 0.25);
    // road: x, z, lower, upper; the seat in the same order; carried; pulled
    for (k, t) in motion.times.iter().enumerate() {
        let (q, v) = motion.states[k].split_at(10);
        let outputs = &motion.outputs[k];
        for i in 0..4 {
            let (mut place, mut speed) = (q[i], v[i]);
            if i < 2 {
                place -= outputs[i];
                speed -= outputs[2 + i];
            }
            // both are computed
            close("position", *t, place, q[4 + i], 2.0 * bounds[k]);
            close("velocity", *t, speed, v[4 + i], 2.0 * bounds[k]);
        }
    }
    let ways = motion.states.iter().map(|y| (y[4] - 0.1).abs());
    assert!(ways.fold(0.0, f64::max) > 0.05, "nothing moved");
    let tensions = motion.outputs.iter().map(|o| o[4]);
    assert!(tensions.fold(0.0, f64::max) > 200.0, "the belt was idle");
    let friction = motion.outputs.iter().map(|o| o[5].abs());
    assert!(friction.fold(0.0, f64::max) > 10.0, "nothing slid");
}

#[test]
fn a_turntable_is_a_centrifugal_field_seen_from_it() {
    // With the angle ψ to the arm, I ψ̈ = −m b (Ω² r) sin ψ − torque(ψ, ψ̇): a pendulum in a field of Ω² r.
    let (motion, bounds) = run_with_bound::<vehicle::Mechanism<f64>>(0.01, 0.25);
    for (k, t) in motion.times.iter().enumerate() {
        let (q, v) = motion.states[k].split_at(10);
        close("angle", *t, q[8] - 3.0 * t, q[9], 2.0 * bounds[k]);
        close("rate", *t, v[8] - 3.0, v[9], 2.0 * bounds[k]);
        let outputs = &motion.outputs[k];
        // the law of the joint is relative to the table; a few roundings of numbers below 3
        let (angle, rate) = (q[8] - 3.0 * t, v[8] - 3.0);
        let torque = -2.0 * angle - 0.05 * rate;
        assert!(
            (outputs[6] - torque).abs() <= 8.0 * 3.0 * f64::EPSILON,
            "at {t} s"
        );
        // the rim at 0.8 m along (cos 3t, −sin 3t) is pulled inwards; a dozen roundings of 7.2
        let (s, c) = (3.0 * t).sin_cos();
        for (ours, expected) in [(outputs[7], -7.2 * c), (outputs[8], 7.2 * s)] {
            assert!(
                (ours - expected).abs() <= 12.0 * 7.2 * f64::EPSILON,
                "at {t} s"
            );
        }
    }
}

#[test]
fn turning_and_moving_everything_leaves_the_motion() {
    let (motion, bounds) = run_with_bound::<vehicle_turned::Mechanism<f64>>(0.02, 0.8);
    for (k, t) in motion.times.iter().enumerate() {
        let outputs = &motion.outputs[k];
        for of in [0, 6] {
            let [x, y, z] = [outputs[of], outputs[of + 1], outputs[of + 2]];
            let turned = [2.0 + x, -1.0 - z, 4.0 + y];
            for (axis, expected) in turned.into_iter().enumerate() {
                close(
                    "position",
                    *t,
                    outputs[of + 3 + axis],
                    expected,
                    2.0 * bounds[k],
                );
            }
        }
    }
    let way = |of: usize| {
        let (first, last) = (
            &motion.outputs[0],
            &motion.outputs[motion.outputs.len() - 1],
        );
        (last[of] - first[of]).abs()
    };
    assert!(way(2) > 0.05 && way(6) > 0.02, "nothing moved");
}

fn outputs_at<M: bryant_runtime::Model<f64>>(model: &M, t: f64, state: &M::State) -> Vec<f64> {
    let mut outputs = vec![0.0; M::INFO.outputs.len()];
    model.outputs(t, state, &mut outputs);
    outputs
}

#[test]
fn the_motion_of_a_vehicle_is_the_rate_of_its_positions() {
    const H: f64 = 1e-4;
    let model = vehicle_turned::Mechanism::<f64>::new(Default::default());
    let state = model.initial_state();
    let at = |t: f64| outputs_at(&model, t, &state);
    // away from the points, where accelerations jump
    for t in [0.05, 0.15, 0.25, 0.35, 0.45, 0.55, 0.7] {
        let [before, now, after] = [at(t - H), at(t), at(t + H)];
        for axis in 12..15 {
            let (p, v, a) = (now[axis], now[axis + 3], now[axis + 6]);
            let rate = (after[axis] - before[axis]) / (2.0 * H);
            let bend = (after[axis] - 2.0 * p + before[axis]) / (H * H);
            // h²/6 of a third derivative below 1000, and rounding of a position below 3 over h; h²/12 of a fourth
            // derivative below 10⁴, and rounding over h²
            assert!(
                (v - rate).abs() <= H * H / 6.0 * 1e3 + 8.0 * f64::EPSILON / H,
                "v at {t}"
            );
            assert!(
                (a - bend).abs() <= H * H / 12.0 * 1e4 + 32.0 * f64::EPSILON / (H * H),
                "a at {t}"
            );
        }
    }
}

#[test]
fn joints_on_vehicles_obey_lagrange() {
    let mut random = Random::new(11);
    for dimension in [Dimension::Plane, Dimension::Space] {
        for given in [Given::Displacement, Given::Velocity, Given::Acceleration] {
            for count in [1, 3] {
                let fixed = Reference::Fixed;
                let (shape, angles) = (Shape::Random, Coordinates::Bryant);
                let mut model = random_tree(&mut random, dimension, angles, fixed, shape, count);
                model.forces.clear();
                let space = dimension == Dimension::Space;
                model.curves = vec![
                    wave(&mut random, "smooth", Interpolate::Cubic),
                    wave(&mut random, "turn", Interpolate::Cubic),
                    wave(&mut random, "tilt", Interpolate::Cubic),
                ];
                let constant = |x: f64| FieldComponent::Constant(Number::from(x));
                let curve = |curve, times| FieldComponent::Curve(scaled(curve, times, 1.2));
                model.vehicles = vec![Vehicle {
                    name: "car".into(),
                    position: [0.3, 0.0, 1.0].map(Number::from),
                    velocity: [0.0; 3].map(Number::from),
                    translation: Translation {
                        given,
                        curves: [
                            Some(scaled(0, 1.3, 1.1)),
                            space.then(|| scaled(2, 0.4, 1.0)),
                            Some(scaled(0, -0.7, 1.0)),
                        ],
                        stops: None,
                    },
                    angles: match space {
                        true => [curve(1, 0.8), curve(2, -0.6), curve(1, 1.1)],
                        false => [constant(0.0), curve(1, 0.8), constant(0.0)],
                    },
                    angles_at_start: [0.0; 3].map(Number::from),
                }];
                let y = if space { 0.2 } else { 0.0 };
                model.systems[0].reference = Reference::Riding {
                    vehicle: 0,
                    at: [0.5, y, -0.4].map(Number::from),
                };
                model.name = format!("{count} in {dimension:?} by {given:?}");
                compare_with_lagrange(&mut random, &model);
            }
        }
    }
}

/// Two elements, the first on a vehicle that moves and rotates by curves of time, each on a joint as written.
fn riding(dimension: u32, joints: [&str; 2]) -> Model {
    let vector = |x: f64, y: f64, z: f64| match dimension {
        2 => format!("[{x}, {z}]"),
        _ => format!("[{x}, {y}, {z}]"),
    };
    let (inertia, angles, displacement) = match dimension {
        2 => ("0.3", "turn", "[way, { curve: way, times: -0.4 }]"),
        _ => (
            "[0.3, 0.25, 0.2]",
            "[turn, { curve: way, times: -0.6 }, { curve: turn, times: 0.8 }]",
            "[way, { curve: turn, times: 0.5 }, { curve: way, times: -0.4 }]",
        ),
    };
    let [first, second] = joints;
    let text = format!(
        "model: riding\ndimension: {dimension}\n{}curves:\n  \
         turn: {{ points: [[-0.1, -0.3], [0, 0], [0.3, 0.8], [0.7, -0.2], [1.3, 1.1]], interpolate: cubic }}\n  \
         way: {{ points: [[-0.1, 0.2], [0, 0], [0.5, -0.7], [1.3, 0.9]], interpolate: cubic }}\n\
         vehicles: [{{ name: car, displacement: {displacement}, angles: {angles} }}]\n\
         systems:\n  - name: s\n    reference: {{ on: car, at: {} }}\n    elements:\n      \
         - {{ name: root, joint: {first}, mass: 2, cg: {}, inertia: {inertia} }}\n      \
         - {{ name: tip, on: root, at: {}, joint: {second}, mass: 0.7, cg: {}, inertia: {inertia} }}\n\
         run: {{ duration: 1 s, every: 0.1 s }}\n",
        if dimension == 3 {
            "coordinates: bryant\n"
        } else {
            ""
        },
        vector(0.5, 0.2, -0.4),
        vector(0.1, -0.05, 0.2),
        vector(0.2, 0.1, 0.4),
        vector(-0.1, 0.15, 0.3),
    );
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = read_str("riding.yaml", &text, &none)
        .unwrap_or_else(|problems| panic!("{problems}\n{text}"));
    Model {
        name: format!("{first}, {second}"),
        ..model
    }
}

const IN_SPACE: [&str; 10] = [
    "weld",
    "ball",
    "{ hinge: [1, -2, 0.5], zero: 30 deg }",
    "{ hinge: y, armature: 0.3 }",
    "{ slider: [0.3, 1, -1], zero: 0.2 }",
    "{ screw: y, pitch: 0.4 }",
    "{ cylinder: z }",
    "{ planar: y }",
    "free",
    "[{ slider: x, name: a }, { hinge: z, name: b }, { hinge: y, name: c }, { hinge: x, name: d }]",
];

const IN_PLANE: [&str; 6] = [
    "weld",
    "hinge",
    "{ hinge: -y, zero: 0.3 }",
    "{ slider: [1, 2], zero: -0.1 }",
    "{ planar: y }",
    "[{ hinge: y, name: a }, { slider: z, name: b }]",
];

#[test]
fn joints_of_every_kind_on_vehicles_that_turn_obey_lagrange() {
    let mut random = Random::new(13);
    for (dimension, joints) in [(3, &IN_SPACE[..]), (2, &IN_PLANE)] {
        for (i, first) in joints.iter().enumerate() {
            for step in [1, 3] {
                let second = joints[(i + step) % joints.len()];
                let model = riding(dimension, [first, second]);
                compare_with_lagrange(&mut random, &model);
                solve_their_equations(&mut random, &model);
            }
        }
    }
}

/// v̇ by both routes solves S v̇ = r_s + r_k: the residual is the rounding of S v̇ and of the forces.
fn solve_their_equations(random: &mut Random, model: &Model) {
    for route in [Route::Elimination, Route::MassMatrix] {
        let options = Options {
            matrices: true,
            route: Some(route),
        };
        let equations = derive_with(model, options);
        for _ in 0..5 {
            let (q, v) = random_state(random, model);
            let m = random_charts(random, model);
            let inputs = Inputs {
                time: random.uniform(0.0, 1.2),
                coordinates: &q,
                velocities: &v,
                parameters: &[],
                auxiliaries: &[],
                memory: &m,
                accelerations: &[],
            };
            let of =
                |roots: &[NodeId]| evaluate(&equations.graph, roots, &inputs, &functions(model));
            let (s, a) = (
                of(&equations.mass_matrix.concat()),
                of(&equations.accelerations),
            );
            let (r_s, r_k) = (
                of(&equations.velocity_forces),
                of(&equations.applied_forces),
            );
            let n = v.len();
            let sum = |f: &dyn Fn(usize) -> f64| (0..n).map(f).sum::<f64>();
            let terms =
                |i: usize| sum(&|j| (s[n * i + j] * a[j]).abs()) + r_s[i].abs() + r_k[i].abs();
            // forces of a system are of one size, so their rounding is, too, and there are some hundred operations
            let scale = (0..n).map(terms).fold(0.0, f64::max);
            for i in 0..n {
                let left = sum(&|j| s[n * i + j] * a[j]) - r_s[i] - r_k[i];
                assert!(
                    left.abs() <= 1e3 * f64::EPSILON * scale,
                    "{}, {route:?}: {left:e} of {scale:e}",
                    model.name
                );
            }
        }
    }
}

/// The car: 9 − 0.72 m/s at 48 ms, with a deceleration of 30 m/s², and 0 after 8.28/30 s more; along z 0.3 − 0.04 m/s
/// at 40 ms, and 0 after 0.26/2 s more. The pushed body: 0.5 m/s at 50 ms, 2.5 m/s at 150 and at 250 ms, and 0
/// after 2.5/20 s more.
#[test]
fn what_stops_stays_where_it_is() {
    let model = stops::Mechanism::<f64>::new(Default::default());
    let state = model.initial_state();
    let ends = [
        (0.324, 0, 2, 3.0 + 0.432 - 0.011_52 + 8.28 * 8.28 / 60.0),
        (
            0.17,
            1,
            3,
            0.5 - 0.012 + 50.0 * 0.04f64.powi(3) / 6.0 - 0.26 * 0.26 / 4.0,
        ),
        (0.375, 7, 8, 0.025 / 3.0 + 0.15 + 0.85 / 3.0 + 0.156_25),
    ];
    for i in 1..=100 {
        let t = 0.02 * f64::from(i);
        let outputs = outputs_at(&model, t, &state);
        assert!(outputs.iter().all(|output| output.is_finite()), "at {t} s");
        for (end, place, speed, expected) in ends {
            let moves = outputs[speed] != 0.0;
            assert_eq!(moves, t < end, "{place} at {t} s");
            let close = (outputs[place] - expected).abs() <= 1e-14 * 8.0;
            assert!(
                moves || close,
                "{} at {t} s, not {expected}",
                outputs[place]
            );
        }
        assert_eq!(outputs[4] != 0.0, t < 0.324);
        assert_eq!(outputs[6] != 0.0, t < 0.17, "the sled at {t} s");
    }
    let mut kinks = vec![model.kink_after(0.0)];
    while kinks[kinks.len() - 1] < 9.0 {
        kinks.push(model.kink_after(kinks[kinks.len() - 1]));
    }
    for (end, ..) in ends {
        let there = kinks.iter().any(|kink| (kink - end).abs() < 1e-14);
        assert!(there, "{end} among {kinks:?}");
    }
}

#[test]
fn pictures_show_where_vehicles_stopped() {
    let compiled = MODELS.iter().find(|m| m.entry.info.name == "stops");
    let model = compiled.expect("a test model").model();
    let info = <stops::Mechanism<f64> as bryant_runtime::Model<f64>>::INFO;
    let layout = Layout::new(&model, info.coordinates).expect("the names of its coordinates");
    let compiled = stops::Mechanism::<f64>::new(Default::default());
    let state = compiled.initial_state();
    let parameters: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    let numbers = Numbers {
        model: &model,
        parameters: &parameters,
    };
    for t in [0.0, 0.1, 0.15, 0.2, 0.3, 0.4, 0.9] {
        let outputs = outputs_at(&compiled, t, &state);
        let pose = Pose::new(&model, &layout, &parameters, t, &state).expect("all coordinates");
        for (vehicle, axis, output) in [(0, 0, 0), (0, 2, 1), (1, 0, 5)] {
            let origin = Attachment {
                on: Body::Vehicle(vehicle),
                at: [0.0; 3].map(Number::from),
            };
            let drawn = pose.point(&numbers, &origin)[axis];
            // a few dozen roundings of numbers below 5
            let close = (drawn - outputs[output]).abs() <= 64.0 * 5.0 * f64::EPSILON;
            assert!(close, "{vehicle} at {t} s: {drawn}, {}", outputs[output]);
        }
    }
}

#[test]
fn pictures_show_vehicles_where_outputs_say() {
    let compiled = MODELS
        .iter()
        .find(|m| m.entry.info.name == "vehicle-turned");
    let model = compiled.expect("a test model").model();
    let info = <vehicle_turned::Mechanism<f64> as bryant_runtime::Model<f64>>::INFO;
    let layout = Layout::new(&model, info.coordinates).expect("the names of its coordinates");
    let compiled = vehicle_turned::Mechanism::<f64>::new(Default::default());
    let state = compiled.initial_state();
    let numbers = Numbers {
        model: &model,
        parameters: &[],
    };
    for t in [0.0, 0.13, 0.37, 0.52, 0.79] {
        let outputs = outputs_at(&compiled, t, &state);
        let pose = Pose::new(&model, &layout, &[], t, &state).expect("all coordinates");
        let on_vehicle = Attachment {
            on: Body::Vehicle(0),
            at: [0.3, -0.2, 0.5].map(Number::from),
        };
        let rider = Attachment {
            on: Body::Element(ElementId {
                system: 2,
                element: 0,
            }),
            at: [0.0, 0.1, -0.2].map(Number::from),
        };
        for (attachment, from) in [(on_vehicle, 12), (rider, 6)] {
            let drawn = pose.point(&numbers, &attachment);
            for (drawn, output) in drawn.iter().zip(&outputs[from..from + 3]) {
                // a few dozen roundings of numbers below 2
                assert!(
                    (drawn - output).abs() <= 64.0 * 2.0 * f64::EPSILON,
                    "at {t} s"
                );
            }
        }
    }
}
