//! Reference joints with prescribed motion: by displacement, velocity or acceleration, alone or with a vehicle.

use crate::motion::{close, run_with_bound};
use bryant::evaluation::functions;
use bryant_generator::dynamics::lagrange::lagrange;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::model::{
    Coordinates, Curve, Dimension, Extrapolate, Given, Interpolate, Model, Number, Reference,
    ScaledCurve, Translation,
};
use bryant_tests::models::motions;
use bryant_tests::trees::{Random, Shape, random_charts, random_state, random_tree};

#[test]
fn one_motion_given_in_two_ways_is_one_motion() {
    let (motion, bounds) = run_with_bound::<motions::Mechanism<f64>>(0.05, 1.2);
    for (k, t) in motion.times.iter().enumerate() {
        let of = |system: usize| &motion.outputs[k][6 * system..6 * system + 6];
        for (first, second) in [(0, 1), (2, 3)] {
            for (ours, other) in of(first).iter().zip(of(second)) {
                // nothing is integrated numerically: a few dozen roundings of numbers below 10
                let error = (ours - other).abs();
                assert!(
                    error <= 40.0 * 10.0 * f64::EPSILON,
                    "at {t} s: {ours}, {other}"
                );
            }
            let (q, v) = motion.states[k].split_at(5);
            for (what, values) in [("angle", q), ("rate", v)] {
                close(what, *t, values[first], values[second], 2.0 * bounds[k]);
            }
        }
        // x = x₀ + rise (3 s² − 2 s³), z = z₀ − 0.3 t
        let s = t / 1.25;
        let x = 0.3 + 0.6 * (3.0 - 2.0 * s) * s * s;
        assert!((of(0)[0] - x).abs() <= 40.0 * f64::EPSILON, "at {t} s");
        assert!(
            (of(0)[1] - (2.0 - 0.3 * t)).abs() <= 40.0 * f64::EPSILON,
            "at {t} s"
        );
    }
    // ∫ of the jolts: trapezia, and 0.3 from 0.9 s on
    let area = 0.2 * 2.5 / 2.0 + 0.3 * 1.0 / 2.0 - 0.4 * 0.7 / 2.0;
    let last = &motion.outputs[motion.outputs.len() - 1];
    assert!((last[24] - (area + 0.3 * 0.3)).abs() <= 40.0 * f64::EPSILON);
    // stretched to 1.125 s and doubled
    let stretched = 2.0 * (1.25 * area + 0.3 * 0.075);
    assert!((last[25] - stretched).abs() <= 40.0 * f64::EPSILON);
    let moved = motion.states[motion.states.len() - 1][0] - motion.states[0][0];
    assert!(moved.abs() > 0.1, "nothing moved");
}

/// A wavy curve of time about its mean.
pub(crate) fn wave(random: &mut Random, name: &str, interpolate: Interpolate) -> Curve {
    let mut points = vec![[-0.1, random.uniform(-1.0, 1.0)]];
    for k in 0..6 {
        let x = 0.2 * f64::from(k) + random.uniform(0.05, 0.15);
        points.push([x, random.uniform(-1.0, 1.0)]);
    }
    Curve {
        name: name.into(),
        points,
        interpolate,
        extrapolate: Extrapolate::Linear,
        states_extrapolation: true,
        thinned: None,
    }
}

/// A scaled curve of a model.
pub(crate) fn scaled(curve: usize, times: f64, stretch: f64) -> ScaledCurve {
    ScaledCurve {
        curve,
        times: times.into(),
        stretch: stretch.into(),
        stiffness: false,
    }
}

/// Checks that S and r_s + r_k of a model are those of Lagrange's equations, at random states and times between `from`
/// and 1.2 s.
pub(crate) fn compare_with_lagrange(random: &mut Random, model: &Model) {
    let options = Options {
        matrices: true,
        route: None,
    };
    let equations = derive_with(model, options);
    let oracle = lagrange(model).expect("algebra");
    let mut acts = false;
    for _ in 0..20 {
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
        let roots = [oracle.mass_matrix.concat(), oracle.velocity_forces.clone()];
        let expected = evaluate(&oracle.graph, &roots.concat(), &inputs, &functions(model));
        let (s, r) = expected.split_at(v.len() * v.len());
        let roots = [
            equations.mass_matrix.concat(),
            equations.velocity_forces.clone(),
            equations.applied_forces.clone(),
        ];
        let ours = evaluate(
            &equations.graph,
            &roots.concat(),
            &inputs,
            &functions(model),
        );
        let (our_s, rest) = ours.split_at(v.len() * v.len());
        let (r_s, r_k) = rest.split_at(v.len());
        let largest = |values: &[f64]| values.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        for (ours, expected) in our_s.iter().zip(s) {
            assert!(
                (ours - expected).abs() <= 1e-12 * largest(s),
                "S of {}",
                model.name
            );
        }
        // each term is an inertia times two rates, or times a prescribed acceleration of some hundred m/s²
        let scale = largest(s) * v.iter().fold(1e3f64, |m, x| m.max(x * x));
        for ((r_s, r_k), expected) in r_s.iter().zip(r_k).zip(r) {
            let error = (r_s + r_k - expected).abs();
            assert!(error <= 1e-12 * scale, "r of {}: {error:e}", model.name);
        }
        acts |= largest(r_k) > 0.0;
    }
    // beyond the last point of a curve of displacements nothing acts
    assert!(acts, "nothing acts");
}

/// A curve that decides which part of a motion has already stopped.
fn part_that_is_over() -> Curve {
    Curve {
        name: "stops".into(),
        points: vec![[0.0, 0.0], [1.0, 1.0]],
        interpolate: Interpolate::Linear,
        extrapolate: Extrapolate::Hold,
        states_extrapolation: true,
        thinned: None,
    }
}

#[test]
fn joints_moved_as_given_obey_lagrange() {
    let mut random = Random::new(9);
    for dimension in [Dimension::Plane, Dimension::Space] {
        for given in [Given::Displacement, Given::Velocity, Given::Acceleration] {
            for count in [1, 2, 4] {
                let fixed = Reference::Fixed;
                let (shape, angles) = (Shape::Random, Coordinates::Bryant);
                let mut model = random_tree(&mut random, dimension, angles, fixed, shape, count);
                model.forces.clear();
                model.curves = vec![
                    wave(&mut random, "smooth", Interpolate::Cubic),
                    match given {
                        Given::Displacement => wave(&mut random, "wave", Interpolate::Cubic),
                        _ => wave(&mut random, "line", Interpolate::Linear),
                    },
                ];
                model.curves.push(part_that_is_over());
                let along_y = dimension == Dimension::Space;
                let system = &mut model.systems[0];
                system.velocity = [0.3, 0.0, -0.2].map(Number::from);
                system.reference = Reference::Prescribed(Translation {
                    given,
                    curves: [
                        Some(scaled(0, 1.3, 1.1)),
                        along_y.then(|| scaled(1, -0.4, 0.8)),
                        Some(scaled(1, 0.7, 1.0)),
                    ],
                    stops: (given == Given::Acceleration && count == 2)
                        .then(|| scaled(2, 1.0, 1.0)),
                });
                model.name = format!("{count} in {dimension:?} by {given:?}");
                compare_with_lagrange(&mut random, &model);
            }
        }
    }
}
