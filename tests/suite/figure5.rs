//! The first 30 ms of the child in its seat, as in figure 5 of the 1980 paper.
//!
//! Until a belt tightens or a contact touches, only the field of the sled acts, equally on all elements: the head moves like a point in
//! this field, by the double integral of the pulse (0 until 10 ms, 198 m/s² from 20 ms on).

use bryant::bundled::find;
use bryant::evaluation::functions;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::model::{
    Asked, BeltOutput, BeltQuantity, ContactQuantity, ForceKind, JointOutput, JointQuantity, Model,
    Output, Quantity,
};
use bryant_tests::runs::{Recording, run};

const TOLERANCE: f64 = 1e-10;

fn child_seat() -> Model {
    let bundled = find("child-seat").expect("a bundled model");
    bryant::bundled::model(bundled).expect("the model reads")
}

fn ride(parameters: &[(&str, f64)]) -> Recording {
    let bundled = bryant_generated::find("child-seat").expect("a bundled model");
    run(&bundled.entry, parameters, TOLERANCE)
}

/// The forces of all belts and contacts and the torques of all joints, by name, at every sample up to a time.
fn forces(recording: &Recording, until: f64) -> Vec<(f64, String, f64)> {
    let mut model = child_seat();
    model.outputs.clear();
    for (index, force) in model.forces.iter().enumerate() {
        let what = match force.kind {
            ForceKind::Belt(_) => Asked::Belt(BeltOutput {
                part: 0,
                what: BeltQuantity::Force,
            }),
            ForceKind::Contact(_) => Asked::Contact(ContactQuantity::Force),
            ForceKind::Joint(_) => Asked::Joint(JointOutput {
                about: 1,
                what: JointQuantity::Torque,
            }),
            _ => continue,
        };
        let quantity = Quantity::OfForce { force: index, what };
        model.outputs.push(Output {
            name: force.name.clone(),
            quantity,
            unit: String::new(),
            code: None,
            filter: None,
            channel: None,
        });
    }
    let equations = derive_with(
        &model,
        Options {
            matrices: false,
            route: None,
        },
    );
    let defaults: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    let mut found = Vec::new();
    for (t, state) in recording.times.iter().zip(&recording.states) {
        if *t > until + 1e-9 {
            break;
        }
        let (coordinates, velocities) = state.split_at(equations.coordinates.len());
        let inputs = Inputs {
            time: *t,
            coordinates,
            velocities,
            parameters: &defaults,
            auxiliaries: &[],
            memory: &[],
        };
        let values = evaluate(
            &equations.graph,
            &equations.outputs,
            &inputs,
            &functions(&model),
        );
        for (output, value) in model.outputs.iter().zip(values) {
            found.push((*t, output.name.clone(), value));
        }
    }
    found
}

#[test]
fn head_excursion_and_acceleration_are_those_of_the_figure() {
    let ride = ride(&[]);
    // in metres, to three digits
    let excursion = ride.column("head excursion");
    for (t, printed) in [
        (20, 0.003),
        (22, 0.006),
        (24, 0.009),
        (26, 0.013),
        (28, 0.018),
        (30, 0.023),
    ] {
        let ours = excursion[ride.at(f64::from(t) * 1e-3)];
        assert!(
            (ours - printed).abs() <= 0.001,
            "excursion at {t} ms: {ours} instead of {printed}"
        );
    }
    // in m/s², to an integer
    let acceleration = ride.column("res. head acceleration");
    for (t, printed) in [
        (12, 40.0),
        (14, 80.0),
        (16, 118.0),
        (18, 158.0),
        (20, 198.0),
    ] {
        let ours = acceleration[ride.at(f64::from(t) * 1e-3)];
        assert!(
            (ours - printed).abs() <= 1.0,
            "acceleration at {t} ms: {ours} instead of {printed}"
        );
    }
}

#[test]
fn nothing_holds_the_child_in_the_first_30_ms() {
    for (t, name, force) in forces(&ride(&[]), 0.03) {
        assert!(force.abs() < 1e-6, "{name} at {t} s: {force}");
    }
}

#[test]
fn the_child_floats_as_a_point_does() {
    let ride = ride(&[]);
    let [acceleration, excursion, accelerometer] = [
        "res. head acceleration",
        "head excursion",
        "head accelerometer",
    ]
    .map(|name| ride.column(name));
    for k in 0..=ride.at(0.03) {
        let t = ride.times[k];
        let ramp = (t - 0.01).clamp(0.0, 0.01);
        let flat = (t - 0.02).max(0.0);
        let a = 19_800.0 * ramp;
        let x = 19_800.0 / 6.0 * ramp.powi(3) + 0.99 * flat + 99.0 * flat * flat;
        // each step errs by the tolerance, or by less for a polynomial of degree 3: rounding remains
        let bound = ride.steps * TOLERANCE;
        assert!((excursion[k] - x).abs() <= bound, "excursion at {t} s");
        assert!(
            (acceleration[k] - a).abs() <= 1e-9 * 198.0,
            "acceleration at {t} s"
        );
        assert!(
            accelerometer[k].abs() <= 1e-9 * 198.0,
            "accelerometer at {t} s"
        );
        if t <= 0.01 {
            assert_eq!(ride.states[k], ride.states[0], "at rest at {t} s");
        }
    }
}

/// With gravity the child falls from the first instant: the head accelerates by 9.81 m/s² before the pulse, and by both fields during it.
/// An accelerometer in the head reads 0 as long as nothing holds the child, and more when the cushion catches it. The start of the child is
/// the same.
#[test]
fn gravity_acts_from_the_start_but_is_felt_on_the_cushion_only() {
    let (without, with) = (ride(&[]), ride(&[("gravity", 9.81)]));
    assert_eq!(with.states[0], without.states[0], "gravity moves no start");
    let [acceleration, excursion, accelerometer, cushion] = [
        "res. head acceleration",
        "head excursion",
        "head accelerometer",
        "cushion force",
    ]
    .map(|name| with.column(name));
    let caught = cushion.iter().position(|force| *force > 0.0);
    let caught = caught.expect("the cushion is under the child");
    assert!(
        with.times[caught] > 0.02,
        "it falls through the onset of the pulse"
    );
    let sideways = without.column("head excursion");
    for k in 0..caught {
        let t = with.times[k];
        let pulse = 19_800.0 * (t - 0.01).clamp(0.0, 0.01);
        let bound = 1e-9 * 198.0;
        assert!(
            (acceleration[k] - pulse.hypot(9.81)).abs() < bound,
            "acceleration at {t} s"
        );
        assert!(accelerometer[k] < bound, "accelerometer at {t} s");
        let bound = (with.steps + without.steps) * TOLERANCE;
        assert!(
            (excursion[k] - sideways[k]).abs() < bound,
            "excursion at {t} s"
        );
    }
    assert!(accelerometer[caught] > 1.0 && without.column("head accelerometer")[caught] < 1e-6);
}
