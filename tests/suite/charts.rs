//! Bryant angles through their singularity: a change of chart affects only the coordinates.

use bryant_generator::dynamics::derive;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::model::{Coordinates, Dimension, ElementId, Reference};
use bryant_generator::motion::chart::LIMIT;
use bryant_generator::motion::layout::Layout;
use bryant_runtime::model::over;
use bryant_runtime::simulate::{self, Integrator, Settings};
use bryant_runtime::{
    Differentiable, Formula, Model, ParameterSet, Real, Report, Sample, Tolerances, Vector,
};
use bryant_tests::models::{free_tree_bryant, poles, poles_bryant};
use bryant_tests::trees::{Random, Shape, choices, random_charts, random_state, random_tree};
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::ops::ControlFlow;

/// Samples of a run: outputs, and the charts if there are any.
struct Run {
    outputs: Vec<Vec<f64>>,
    charts: Vec<Vec<f64>>,
    report: Report,
}

impl Run {
    /// Number of changes of charts between successive samples.
    fn changes(&self) -> usize {
        let pairs = self.charts.windows(2);
        let changed =
            |pair: &[Vec<f64>]| pair[0].iter().zip(&pair[1]).filter(|(a, b)| a != b).count();
        pairs.map(changed).sum()
    }
}

fn run<M: Model<f64>>(method: Integrator, duration: f64, disturbance: f64) -> Run {
    let model = M::new(<M::Parameters as ParameterSet<f64>>::defaults());
    run_of::<f64, M>(&model, method, duration, disturbance)
}

fn run_of<T: Real, M: Model<T>>(
    model: &M,
    method: Integrator,
    duration: f64,
    disturbance: f64,
) -> Run {
    let mut start = model.initial_state();
    let moving = M::INFO.coordinates.len() + M::INFO.velocities.len();
    for i in 0..moving {
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        start[i] += T::from_f64(sign * disturbance);
    }
    model.normalize(&mut start);
    let settings = Settings {
        duration,
        method,
        ..Settings::of(M::INFO)
    };
    let (mut outputs, mut charts) = (Vec::new(), Vec::new());
    let first = M::State::LEN - M::INFO.memory.len();
    let numbers = |values: &[T]| values.iter().map(|x| x.to_f64()).collect();
    let sink = &mut |sample: Sample<'_, T>| {
        outputs.push(numbers(sample.outputs));
        charts.push(numbers(&sample.state[first..]));
        ControlFlow::Continue(())
    };
    let model = Differentiable(model);
    let report = simulate::run(&model, start.as_ref(), &settings, None, sink)
        .unwrap_or_else(|failure| panic!("{failure}"));
    Run {
        outputs,
        charts,
        report,
    }
}

/// The largest difference of two runs up to each sample.
fn differences(a: &Run, b: &Run) -> Vec<f64> {
    let mut largest = 0.0f64;
    let pairs = a.outputs.iter().zip(&b.outputs);
    pairs
        .map(|(a, b)| {
            let pairs = a.iter().zip(b);
            largest = pairs.fold(largest, |m, (a, b)| m.max((a - b).abs()));
            largest
        })
        .collect()
}

fn adaptive(formula: Formula, tolerance: f64) -> Integrator {
    Integrator::adaptive(formula, Tolerances::uniform(tolerance))
}

/// The error theory of `motion`: each of n steps errs by the tolerance τ times the size y of the state times the growth
/// G of errors, which is measured by a run from a disturbed state. The states stay below 10 (metres, radians and their
/// rates).
#[test]
fn bodies_driven_through_the_pole_move_as_in_quaternions() {
    const TOLERANCE: f64 = 1e-14;
    const DISTURBANCE: f64 = 1e-7;
    const SIZE: f64 = 10.0;
    let method = adaptive(Formula::Dop853, TOLERANCE);
    let quaternion = run::<poles::Mechanism<f64>>(method, 2.0, 0.0);
    let disturbed = run::<poles::Mechanism<f64>>(method, 2.0, DISTURBANCE);
    let bryant = run::<poles_bryant::Mechanism<f64>>(method, 2.0, 0.0);
    // the wheel alone passes the pole every quarter of a turn: 18 rad are 11 passes
    assert!(bryant.changes() > 11, "{} changes", bryant.changes());
    let growth = differences(&quaternion, &disturbed);
    let found = differences(&quaternion, &bryant);
    assert_eq!(found.len(), 41);
    let steps = (quaternion.report.steps + bryant.report.steps) as f64;
    for (found, growth) in found.iter().zip(growth) {
        let bound = steps * TOLERANCE * SIZE * (growth / DISTURBANCE).max(1.0);
        assert!(*found <= bound && *found <= 1e-10, "{found:e} > {bound:e}");
    }
}

/// Every integration method, with fixed steps or not, passes through the pole with an error below the theoretical
/// bound.
#[test]
fn every_method_goes_through_the_pole() {
    const SIZE: f64 = 10.0;
    const DISTURBANCE: f64 = 1e-7;
    let exact = adaptive(Formula::Dop853, 1e-13);
    let quaternion = run::<poles::Mechanism<f64>>(exact, 1.0, 0.0);
    let disturbed = run::<poles::Mechanism<f64>>(exact, 1.0, DISTURBANCE);
    let growth = differences(&quaternion, &disturbed);
    for formula in Formula::ALL.into_iter().filter(|f| f.estimates_error()) {
        let tolerance = 1e-7;
        let bryant = run::<poles_bryant::Mechanism<f64>>(adaptive(formula, tolerance), 1.0, 0.0);
        assert!(
            bryant.changes() > 5,
            "{formula}: {} changes",
            bryant.changes()
        );
        let steps = bryant.report.steps as f64;
        for (found, growth) in differences(&quaternion, &bryant).iter().zip(&growth) {
            let bound = steps * tolerance * SIZE * (growth / DISTURBANCE).max(1.0);
            assert!(*found <= bound, "{formula}: {found:e} > {bound:e}");
        }
    }
    // fixed steps keep their order: with half the step, the error is 2^p times smaller; a factor of two is allowed for
    // terms of higher order
    for formula in [Formula::SemiImplicitEuler, Formula::Heun, Formula::Rk4] {
        let error = |steps: f64| {
            let method = Integrator::fixed(formula, 1.0 / steps);
            let bryant = run::<poles_bryant::Mechanism<f64>>(method, 1.0, 0.0);
            assert!(
                bryant.changes() > 5,
                "{formula}: {} changes",
                bryant.changes()
            );
            *differences(&quaternion, &bryant).last().expect("samples")
        };
        let (coarse, fine) = (error(1000.0), error(2000.0));
        let factor = 2f64.powi(formula.order() as i32);
        assert!(
            fine > 1e-11,
            "{formula}: an error of {fine:e} is no longer that of the method"
        );
        assert!(
            fine <= 2.0 * coarse / factor,
            "{formula}: {coarse:e} and then {fine:e}"
        );
    }
}

/// Single precision rounds each of n steps in a few operations: n · 8 ε · size · growth.
#[test]
fn single_precision_goes_through_the_pole() {
    const SIZE: f64 = 10.0;
    const DISTURBANCE: f64 = 1e-7;
    const STEPS: f64 = 500.0;
    let method = Integrator::fixed(Formula::Rk4, 1.0 / STEPS);
    let quaternion = run::<poles::Mechanism<f64>>(method, 1.0, 0.0);
    let disturbed = run::<poles::Mechanism<f64>>(method, 1.0, DISTURBANCE);
    let model = poles_bryant::Mechanism::<f64>::new(ParameterSet::defaults());
    let single = over::<f64, f32, _>(&model, |x| x as f32);
    let single = run_of::<f32, _>(&single, method, 1.0, 0.0);
    assert!(single.changes() > 5, "{} changes", single.changes());
    let growth = differences(&quaternion, &disturbed);
    for (found, growth) in differences(&quaternion, &single).iter().zip(growth) {
        let rounding = STEPS * 8.0 * f64::from(f32::EPSILON) * SIZE;
        let bound = rounding * (growth / DISTURBANCE).max(1.0);
        assert!(*found <= bound, "{found:e} > {bound:e}");
    }
}

/// Two trees tumble freely through many changes of charts: the errors of the steps add up, times the derivative of the
/// conserved quantity with respect to the state, as in `motion`.
#[test]
fn a_tumbling_tree_conserves_energy_and_momentum_over_charts() {
    const TOLERANCE: f64 = 1e-12;
    let method = adaptive(Formula::Dop853, TOLERANCE);
    let run = run::<free_tree_bryant::Mechanism<f64>>(method, 20.0, 0.0);
    assert!(run.changes() > 50, "{} changes", run.changes());
    // the star drifts 22 m away, which is the lever arm of the angular momentum
    let bound = run.report.steps as f64 * TOLERANCE * 22.0 * 6.5 * 3.0 * 5.0;
    assert!(bound < 1e-4, "{bound:e} is no bound");
    for row in &run.outputs {
        for (now, before) in row.iter().zip(&run.outputs[0]) {
            assert!(
                (now - before).abs() <= bound,
                "{now} instead of {before}, allowed {bound:e}"
            );
        }
    }
}

/// A = Rx Ry Rz, in the second chart followed by Ry(−90°).
fn rotation(angles: &[f64], chart: f64) -> Matrix3<f64> {
    let turn = |axis: Vector3<f64>, angle: f64| {
        *Rotation3::from_axis_angle(&nalgebra::Unit::new_unchecked(axis), angle).matrix()
    };
    turn(Vector3::x(), angles[0])
        * turn(Vector3::y(), angles[1])
        * turn(Vector3::z(), angles[2])
        * turn(Vector3::y(), -chart * std::f64::consts::FRAC_PI_2)
}

/// ω = e_x φ̇₁ + Rx e_y φ̇₂ + Rx Ry e_z φ̇₃
fn omega(angles: &[f64], rates: &[f64]) -> Vector3<f64> {
    let first = Rotation3::from_axis_angle(&Vector3::x_axis(), angles[0]);
    let second = first * Rotation3::from_axis_angle(&Vector3::y_axis(), angles[1]);
    Vector3::x() * rates[0] + first * Vector3::y() * rates[1] + second * Vector3::z() * rates[2]
}

/// A change of chart keeps A and ω within a few roundings, divided by the cosine of the new second angle, which is at
/// least 0.6; entries that do not change keep every bit.
#[test]
fn a_change_of_chart_is_none_of_the_body() {
    let mut random = Random::new(11);
    let (space, shape) = (Dimension::Space, Shape::Random);
    let bryant = Coordinates::Bryant;
    let model = random_tree(&mut random, space, bryant, Reference::Free, shape, 5);
    let (equations, layout) = (derive(&model), Layout::of(&model));
    let memory: Vec<_> = equations.memory.iter().map(|state| state.next).collect();
    let roots = [
        &equations.renewed_coordinates[..],
        &equations.renewed_velocities,
        &memory,
    ]
    .concat();
    let (mut changed, mut kept) = (0, 0);
    for k in 0..400 {
        let (mut q, v) = random_state(&mut random, &model);
        let m = random_charts(&mut random, &model);
        let elements: Vec<_> = (0..5)
            .map(|element| layout.element_coordinates(ElementId { system: 0, element }))
            .collect();
        if k % 4 == 0 {
            // exactly at the pole, and beyond it
            for range in &elements {
                let pole = if random.uniform(-1.0, 1.0) > 0.0 {
                    0.5
                } else {
                    -0.5
                };
                q[range.start + 1] = pole * std::f64::consts::PI;
            }
        } else if k % 4 == 1 {
            for range in &elements {
                q[range.start + 1] = random.uniform(-7.0, 7.0);
            }
        }
        let inputs = Inputs {
            time: 0.0,
            coordinates: &q,
            velocities: &v,
            parameters: &[],
            auxiliaries: &[],
            memory: &m,
            accelerations: &[],
        };
        let renewed = evaluate(&equations.graph, &roots, &inputs, &choices);
        let (q2, rest) = renewed.split_at(q.len());
        let (v2, m2) = rest.split_at(v.len());
        assert_eq!(
            (&q[..3], &v[..3]),
            (&q2[..3], &v2[..3]),
            "the reference joint"
        );
        for (element, range) in elements.into_iter().enumerate() {
            let (old, new) = (&q[range.clone()], &q2[range.clone()]);
            let (old_rates, new_rates) = (&v[range.clone()], &v2[range]);
            let (chart, other) = (m[element], m2[element]);
            let near = old[1].sin().abs() > LIMIT;
            assert_eq!(chart != other, near, "{old:?}");
            if !near {
                assert_eq!((old, old_rates), (new, new_rates));
                kept += 1;
                continue;
            }
            changed += 1;
            assert!(new[1].sin().abs() <= (1.0 - LIMIT * LIMIT).sqrt() + 1e-15);
            let rounding = 64.0 * f64::EPSILON / 0.6;
            let off = (rotation(old, chart) - rotation(new, other)).amax();
            assert!(off <= rounding, "A is off by {off:e}");
            let fast = old_rates.iter().map(|rate| rate.abs()).sum::<f64>();
            let off = (omega(old, old_rates) - omega(new, new_rates)).amax();
            assert!(off <= rounding * fast, "ω is off by {off:e}");
        }
    }
    assert!(
        changed > 400 && kept > 400,
        "{changed} changed, {kept} kept"
    );
}
