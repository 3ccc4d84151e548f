//! Every reason for which a run is doubted or ends early: a scene that has it, and one close by that has not.

use super::sound;
use bryant::simulation::{Recording, run};
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Method};

/// A ball over a plate that ends, or a spring: with parts of it exchanged.
const SHELF: &str = "model: shelf
dimension: 2
systems:
  - name: man
    elements: [{ name: ball, mass: 5 kg, cg: [0, 0], inertia: 0.02 }]
    start: { position: [0, 0.3], velocity: [1, 0] }
forces:
  - { field: g, acceleration: [0, -1 gn] }
  - contact: shelf
    ellipsoid: { on: man/ball, center: [0, 0], semi_axes: [0.1, 0.1] }
    plane: { on: frame, at: [0, 0], normal: [0, 1], extent: 0.2 }
    elastic: { points: [[0, 0], [0.02, 1000], [0.05, 5000]], extrapolate: linear }
outputs: [{ name: z, of: man/ball, what: position, component: z }]
run: { duration: 0.6 s, every: 0.1 s }
";

const SPRING: &str = "model: spring
dimension: 2
systems:
  - name: wheel
    reference: fixed
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { rates: { body: 1 } }
forces:
  - { joint: wheel/body, elastic: CURVE }
outputs: [{ name: angle, of: joint wheel/body, what: angle }]
run: { duration: 6 s, every: 0.1 s }
";

const BENT: &str = "model: flex
dimension: 3
curves: { half: { points: [[0, 0], [180 deg, 3.141592653589793]], extrapolate: linear } }
systems:
  - name: top
    reference: fixed
    elements: [{ name: body, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }]
    start: { rates: { body: [RATES] } }
forces:
  - { joint: top/body, axis: z, LAW }
outputs: [{ name: torque, of: joint top/body, what: torque, about: flexion }]
run: { duration: 5 s, every: 10 ms }
";

fn go(text: &str, job: &Job) -> Recording {
    let (_, engine) = sound(text);
    run(&engine, job, &mut |_| ())
}

/// The kinds of doubts of a run to its end.
#[track_caller]
fn kinds(text: &str, job: &Job) -> Vec<String> {
    let recording = go(text, job);
    if let Err(error) = &recording.result {
        panic!("{error:?}\n{text}");
    }
    let finite = recording.table.columns.iter().flat_map(|c| &c.values);
    assert!(finite.clone().all(|x| x.is_finite()), "{text}");
    recording
        .doubts
        .iter()
        .map(|doubt| doubt.kind.clone())
        .collect()
}

fn job() -> Job {
    Job::default()
}

#[test]
fn a_curve_counts_while_its_force_acts() {
    assert_eq!(kinds(SHELF, &job()), [""; 0]);
    // on a plate that does not end it sinks in by more than twice the curve
    let endless = SHELF
        .replace(", extent: 0.2", "")
        .replace("mass: 5 kg", "mass: 500 kg");
    assert_eq!(kinds(&endless, &job()), ["curve"]);
    // nor does a curve that ends hinder what falls past the plate
    let ended = SHELF.replace("extrapolate: linear", "extrapolate: error");
    assert_eq!(kinds(&ended, &job()), [""; 0]);
    let error = go(
        &endless.replace("extrapolate: linear", "extrapolate: error"),
        &job(),
    )
    .result;
    let error = error.expect_err("it leaves the curve").message;
    assert!(
        error.contains("\"contact shelf: curve\" is left by"),
        "{error}"
    );
    // a force that a switch has ended
    let ended = "until: off, elastic: { points: [[0, 0], [0.02, 100], [0.05, 5000]] }\nswitches: [{ switch: off, when: { time: 0 } }]";
    let off = endless.replace(
        "elastic: { points: [[0, 0], [0.02, 1000], [0.05, 5000]], extrapolate: linear }",
        &ended.replace(", elastic", "\n    elastic"),
    );
    assert_eq!(kinds(&off, &job()), [""; 0]);
}

#[test]
fn a_line_through_nothing_goes_on_for_ever() {
    for (curve, doubts) in [
        (
            "{ points: [[-0.1, -0.1], [0.1, 0.1]], extrapolate: linear }",
            &[][..],
        ),
        (
            "{ points: [[0.1, 0.1], [0.2, 0.2], [0.4, 0.4]], extrapolate: linear }",
            &[],
        ),
        (
            "{ points: [[-0.1, -0.1], [0.1, 0.11]], extrapolate: linear }",
            &["curve"],
        ),
        (
            "{ points: [[-0.1, -0.1], [0, 0], [0.1, 0.2]], extrapolate: linear }",
            &["curve"],
        ),
        (
            "{ points: [[-0.6, -0.6], [0, 0], [0.6, 1.2]], extrapolate: linear }",
            &[],
        ),
        ("{ points: [[-0.1, -0.1], [0.1, 0.1]] }", &["curve"]),
        (
            "{ points: [[-0.1, -0.1], [0.1, 0.1]], extrapolate: hold }",
            &[],
        ),
        ("{ points: [[-2, -2], [2, 2]] }", &[]),
    ] {
        assert_eq!(
            kinds(&SPRING.replace("CURVE", curve), &job()),
            doubts,
            "{curve}"
        );
    }
}

#[test]
fn a_flexion_through_half_a_turn_says_so() {
    let elastic = "flexion: { elastic: half }, torsion: { elastic: { points: [[-180 deg, -1], [180 deg, 1]] } }";
    let with = |rates: &str, law: &str| BENT.replace("RATES", rates).replace("LAW", law);
    for rates in ["0, 3.2, 0", "3.2, 0, 0", "2, 3, 0"] {
        let text = with(rates, elastic);
        assert!(
            kinds(&text, &job()).contains(&"flexion".to_owned()),
            "{rates}"
        );
        let doubts = go(&text, &job()).doubts;
        let said = &doubts
            .iter()
            .find(|d| d.kind == "flexion")
            .expect("it does")
            .message;
        assert!(
            said.contains("\"joint top/body\" is bent through 180°") && said.contains("since t = "),
            "{said}"
        );
    }
    // ½ J ω² < ½ k π²: it turns before; or it passes beside; or nothing has a direction there
    let turns = with("0, 3.1, 0", elastic);
    let beside = with("0, 3.2, 0.6", "flexion: { elastic: half }");
    let damped = with("0, 3.2, 0", "flexion: { damping: 0.01 }");
    for text in [turns, beside, damped] {
        assert_eq!(kinds(&text, &job()), [""; 0], "{text}");
    }
}

#[test]
fn steps_that_are_too_long_are_told() {
    let line = "{ points: [[-1, -10000], [1, 10000]], extrapolate: linear }";
    let stiff = SPRING.replace("CURVE", line);
    let with = |formula, step| Job {
        method: Some(Method::fixed(formula, step)),
        every: Some(6.0),
        ..job()
    };
    // ω = 100 1/s, and Runge and Kutta's method is stable to ω h = 2.83; what it loses is the energy's
    let unstable = kinds(&stiff, &with(Formula::Rk4, 0.034));
    assert_eq!(
        unstable.first().map(String::as_str),
        Some("step"),
        "{unstable:?}"
    );
    let lossy = kinds(&stiff, &with(Formula::Rk4, 0.0275));
    assert_eq!(lossy, ["energy"]);
    assert_eq!(kinds(&stiff, &with(Formula::Rk4, 0.0005)), [""; 0]);
}

#[test]
fn too_many_steps_and_none_too_many() {
    let text = SPRING.replace(
        "CURVE",
        "{ points: [[-1, -1], [1, 1]], extrapolate: linear }",
    );
    let limited = |max_steps| Job {
        max_steps: Some(max_steps),
        ..job()
    };
    let few = go(&text, &limited(3)).result.expect_err("3 steps are few");
    assert!(few.message.contains("limit of 3 steps"), "{few:?}");
    assert!(go(&text, &limited(100_000)).result.is_ok());
}
