//! Every reason for which a run is doubted or ends early: a scene that has it, and a similar scene that has not.
//!
//! | reason | test |
//! |---|---|
//! | a curve is exceeded | `a_curve_counts_while_its_force_acts`, `a_line_through_nothing_goes_on_for_ever` |
//! | an edge that pushes harder than its plane | `an_edge_that_fades_over_less_than_the_depth_says_so` |
//! | a bag compressed so far that its law is no longer valid | `a_bag_that_is_pressed_flat_says_so` |
//! | flexion through 180° | `a_flexion_through_half_a_turn_says_so`; in lanes `tests/suite/sweep/reasons.rs` |
//! | laws about x, y, z through ±90° about y | `a_joint_through_its_singular_angle_says_so` |
//! | a doubt that no accuracy removes ends all further runs | `what_no_accuracy_removes_ends_at_once` |
//! | two ellipsoids that sink through each other | `ellipsoids_that_sink_through_each_other_say_so`; in lanes `tests/suite/sweep/reasons.rs` |
//! | a step above the limit of stability; the balance of energy | `steps_that_are_too_long_are_told` |
//! | a step over an event that begins and ends within it; the balance of momentum | `what_steps_pass_over_is_told`,
//! `momentum_that_is_lost_is_told` |
//! | too many steps; too long a time | `too_many_steps_and_none_too_many`, `a_time_limit_ends_what_would_not_end` |
//! | numbers that are not finite; steps below the smallest; an inertia that vanishes | `what_grows_without_end_ends`, `an_inertia_that_vanishes_ends_the_run` |
//! | fixed steps that err by too much | `what_a_stage_alone_meets_is_told`, `steps_that_err_are_told` |
//! | a balance, a limit of stability, in lanes | `lanes_of_fixed_steps_are_watched_as_single_runs_are` |
//! | events of the same time, whose times depend on parameters otherwise | `events_that_cannot_be_told_apart_say_so` |
//! | a check that fails | `src/command/error_report.rs` |
//! | outputs that differ from a check by more than promised or requested | `outputs_are_as_accurate_as_promised_or_said_not_to_be` |
//! | a user function that ends the program, panics or does not return | `tests/suite/loaded_library.rs` |

use super::sound;
use crate::command_call::call;
use bryant::simulation::{Recording, run};
use bryant_runtime::batch::rows::{Asked, Job as RowsJob};
use bryant_runtime::batch::{self, Doubt, Fixed, Pace, Status};
use bryant_runtime::program::{ErrorKind, Job};
use bryant_runtime::simulate::ENERGY_LIMIT;
use bryant_runtime::{Formula, Integrator, Response, Tolerances, Width};
use std::time::Duration;

/// A ball over a plate with an end, or a spring; the tests exchange parts of it.
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

/// A ball that lies deep in foam and glides over its edge.
const FOAM: &str = "model: foam
dimension: 2
systems:
  - name: ball
    elements: [{ name: ball, mass: 20, cg: [0, 0], inertia: 0.1 }]
    start: { position: [0.1, 0.04], velocity: [2, 0] }
forces:
  - { load: weight, on: ball/ball, at: cg, force: [0, -4 kN] }
  - contact: foam
    ellipsoid: { on: ball/ball, center: [0, 0], semi_axes: [0.1, 0.1] }
    plane: { on: frame, at: [0, 0], normal: [0, 1], extent: 0.25 }
    elastic: { unit: [mm, N], points: [[0, 0], [30, 700], [60, 4200], [90, 12000]], extrapolate: linear }
outputs: [{ name: x, of: ball/ball, what: position, component: x }]
run: { duration: 0.1 s, every: 1 ms }
";

/// The push of an edge is 3/2 E/width at most, of 4.2 kN at a depth of 60 mm where E = 84 J: more than these below 30
/// mm. A width of one's own may be as narrow as that; the default is the depth of the curve.
#[test]
fn an_edge_that_fades_over_less_than_the_depth_says_so() {
    assert_eq!(kinds(FOAM, &job()), [""; 0]);
    let found = in_lanes(FOAM, batch::LaneFormula::Dopri5, 1e-4, ENERGY_LIMIT);
    assert_eq!(found, (Status::Done, None));
    let wide = FOAM.replace("extent: 0.25", "extent: 0.25, edge: { width: 60 mm }");
    assert_eq!(kinds(&wide, &job()), [""; 0]);
    let narrow = FOAM.replace("extent: 0.25", "extent: 0.25, edge: { width: 10 mm }");
    let doubts = go(&narrow, &job()).doubts;
    assert!(doubts.len() == 1 && doubts[0].kind == "edge", "{doubts:?}");
    assert!(
        doubts[0]
            .message
            .contains("the edge of \"contact foam\" pushes harder than the surface")
            && doubts[0].amount > 2.0,
        "{doubts:?}"
    );
    let (status, doubt) = in_lanes(&narrow, batch::LaneFormula::Dopri5, 1e-4, ENERGY_LIMIT);
    assert!(
        matches!((status, doubt), (Status::Doubtful, Some(Doubt::Left(_)))),
        "{doubt:?}"
    );
    // an edge that cuts does not push
    let cut = FOAM.replace("extent: 0.25", "extent: 0.25, edge: { rule: cut }");
    assert!(!kinds(&cut, &job()).contains(&"edge".to_owned()));
}

fn go(text: &str, job: &Job) -> Recording {
    let (_, engine) = sound(text);
    run(&engine, job, &mut |_| ())
}

/// The kinds of doubts about a run, which must reach its end.
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
    // on an endless plate it sinks in by more than twice the curve
    let endless = SHELF
        .replace(", extent: 0.2", "")
        .replace("mass: 5 kg", "mass: 500 kg");
    assert_eq!(kinds(&endless, &job()), ["curve"]);
    // a curve that ends does not disturb a ball that falls past the plate
    let ended = SHELF.replace("extrapolate: linear", "extrapolate: error");
    assert_eq!(kinds(&ended, &job()), [""; 0]);
    let error = go(
        &endless.replace("extrapolate: linear", "extrapolate: error"),
        &job(),
    )
    .result;
    let error = error.expect_err("it leaves the curve").message;
    assert!(
        error.contains("the argument of the curve \"contact shelf: curve\" exceeds the last point"),
        "{error}"
    );
    // a switch has ended the force
    let ended = "until: off, elastic: { points: [[0, 0], [0.02, 100], [0.05, 5000]] }\nswitches: [{ switch: off, when: { time: 0 } }]";
    let off = endless.replace(
        "elastic: { points: [[0, 0], [0.02, 1000], [0.05, 5000]], extrapolate: linear }",
        &ended.replace(", elastic", "\n    elastic"),
    );
    assert_eq!(kinds(&off, &job()), [""; 0]);
}

/// A curve that is left says by how much, in the unit of its abscissa: each law that has a curve of the motion.
#[test]
fn a_curve_that_is_left_says_its_unit() {
    let curve = "{ points: [[-0.01, -1], [0, 0], [0.01, 1.5]], extrapolate: linear }";
    let hysteresis = format!(
        "{curve}, unloading: {{ points: [[-0.01, -0.5], [0, 0], [0.01, 0.5]], extrapolate: linear }}"
    );
    let belt = "{ points: [[0, 0], [0.01, 1], [0.02, 3]], extrapolate: linear }";
    let ball = "elements: [{ name: b, mass: 1, cg: [0, 0], inertia: 1 }]\n    start: { position: [0, 1], velocity: [1, 0] }";
    let wheel = "reference: fixed\n    elements: [{ name: b, mass: 1, cg: [0, 0], inertia: 1 }]\n    start: { rates: { b: 1 } }";
    let slider = "reference: fixed\n    elements: [{ name: b, joint: { slider: x }, mass: 1, cg: [0, 0], inertia: 1 }]\n    start: { joint_rates: { b: 1 } }";
    let turning =
        "elements: [{ name: b, mass: 1, cg: [0, 0], inertia: 1 }]\n    start: { rates: { b: 1 } }";
    let ends = "from: { on: one/b, at: [0, 0] }, to: { on: frame, at: [0, 0] }";
    let far = "from: { on: one/b, at: [0, 0] }, to: { on: frame, at: [-1, 1] }";
    let pressed = "ellipsoid: { on: one/b, center: [0, 0], semi_axes: [0.1, 0.1] }, plane: { on: frame, at: [0.15, 0], normal: [-1, 0] }";
    let of_plane = "{ points: [[0, 0], [0.005, 1], [0.01, 4]], extrapolate: linear }";
    for (system, force, unit) in [
        (wheel, format!("joint: one/b, elastic: {curve}"), " rad"),
        (
            wheel,
            format!("joint: one/b, elastic: {hysteresis}"),
            " rad",
        ),
        (slider, format!("joint: one/b, elastic: {curve}"), " m"),
        (
            ball,
            format!("spring: s, {far}, length: 1, elastic: {curve}"),
            " m",
        ),
        (
            ball,
            format!("bushing: s, {ends}, along: {{ x: {{ elastic: {curve} }} }}"),
            " m",
        ),
        (
            turning,
            format!("bushing: s, {ends}, about: {{ y: {{ elastic: {curve} }} }}"),
            " rad",
        ),
        (
            ball,
            format!("contact: s, {pressed}, elastic: {of_plane}"),
            " m",
        ),
        (ball, format!("belt: s, {far}, force: {belt}"), ""),
    ] {
        let text = format!(
            "model: left\ndimension: 2\nsystems:\n  - name: one\n    {system}\nforces:\n  - {{ {force} }}\noutputs: [{{ name: x, of: one/b, what: position, component: x }}]\n\
             run: {{ duration: 0.2 s, every: 0.1 s }}\n"
        );
        let doubts = go(&text, &job()).doubts;
        let left = doubts.iter().find(|doubt| doubt.kind == "curve");
        let said = &left.unwrap_or_else(|| panic!("{doubts:?}\n{text}")).message;
        // (0.0100 m) by 0.123 m, and
        let (_, rest) = said.split_once(" point (").expect(said);
        let (point, rest) = rest.split_once(") by ").expect(said);
        let (beyond, _) = rest.split_once(", and").expect(said);
        for number in [point, beyond] {
            let number = number.strip_suffix(unit).expect(said);
            assert!(number.parse::<f64>().is_ok(), "{number}: {said}");
        }
    }
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
    // ½ J ω² < ½ k π²: it turns back before 180°; or it passes beside; or nothing has a direction there
    let turns = with("0, 3.1, 0", elastic);
    let beside = with("0, 3.2, 0.6", "flexion: { elastic: half }");
    let damped = with("0, 3.2, 0", "flexion: { damping: 0.01 }");
    for text in [turns, beside, damped] {
        assert_eq!(kinds(&text, &job()), [""; 0], "{text}");
    }
}

/// A run that goes through a singular angle, or beyond the points of a curve, does so at every accuracy: it is neither
/// checked nor repeated, also with `--accuracy`. A run whose steps are too long is checked.
#[test]
fn what_no_accuracy_removes_ends_at_once() {
    let directory = crate::directory();
    let path = directory.path();
    let runs = |text: &str, options: &[&str]| {
        std::fs::write(path.join("scene.yaml"), text).unwrap();
        let all = ["run", "scene.yaml", "--no-files", "--json"];
        let (printed, error) = call(path, &[&all[..], options].concat(), 3);
        let printed: serde_json::Value = serde_json::from_str(&printed).unwrap();
        (printed["accuracy"]["runs"].as_u64().unwrap(), error)
    };
    let angle = BENT
        .replace("axis: z, LAW", "about: { x: { damping: 1e-3 } }")
        .replace("RATES", "0, 3, 0")
        .replace("about: flexion", "about: y");
    let curve = SHELF
        .replace(", extent: 0.2", "")
        .replace("mass: 5 kg", "mass: 500 kg");
    for (text, said) in [(&angle, "±90° about y"), (&curve, "contact shelf")] {
        // at the default tolerance 1e-7 and a tenth of it; from the tolerance 1e-4 down to 1e-7
        for (options, enough) in [(&[][..], 2), (&["--accuracy", "1e-4"], 4)] {
            let (runs, error) = runs(text, options);
            assert!(runs <= enough, "{options:?}: {error}");
            assert!(error.contains(said), "{error}");
        }
    }
    let line = "{ points: [[-1, -10000], [1, 10000]], extrapolate: linear }";
    let stiff = SPRING.replace("CURVE", line);
    let (runs, error) = runs(
        &stiff,
        &["--method", "rk4", "--step", "27.5 ms", "--every", "6 s"],
    );
    assert!(runs > 1, "{error}");
}

/// A coarse run may leave a curve that the motion does not leave: x = 0.1 sin 10 t on a spring known up to 0.1002.
#[test]
fn a_doubt_of_a_coarse_run_alone_does_not_last() {
    let directory = crate::directory();
    let path = directory.path();
    let text = "model: swing
dimension: 2
systems:
  - name: a
    reference: fixed
    elements: [{ name: b, mass: 1 kg, cg: [0, 0], inertia: 1, joint: [{ slider: x }] }]
    start: { joint_rates: { b: 1 } }
forces: [{ joint: a/b, elastic: { points: [[-0.1002, -10.02], [0.1002, 10.02]] } }]
outputs: [{ name: x, of: a/b, what: position, component: x }]
run: { duration: 20 s, every: 0.1 s }
";
    std::fs::write(path.join("scene.yaml"), text).unwrap();
    for accuracy in ["0.1", "1e-3"] {
        let options = [
            "run",
            "scene.yaml",
            "--no-files",
            "--json",
            "--accuracy",
            accuracy,
        ];
        let (printed, _) = call(path, &options, 0);
        let printed: serde_json::Value = serde_json::from_str(&printed).unwrap();
        assert!(printed["accuracy"]["runs"].as_u64().unwrap() > 1);
    }
}

#[test]
fn a_joint_through_its_singular_angle_says_so() {
    let with = |rates: &str, law: &str| {
        let law = format!("about: {{ {law} }}");
        let text = BENT.replace("axis: z, LAW", &law).replace("RATES", rates);
        text.replace("about: flexion", "about: y")
            .replace("duration: 5 s", "duration: 1 s")
    };
    // 3 rad/s for 1 s about y, with next to no law
    for law in [
        "x: { damping: 1e-3 }",
        "z: { stiffness: 1e-3 }",
        "y: { stiffness: 1e-3 }",
        "x: { damping: 1e-3 }, y: { damping: 1e-3 }, z: { damping: 1e-3 }",
    ] {
        for rates in ["0, 3, 0", "0, -3, 0"] {
            let text = with(rates, law);
            let doubts = go(&text, &job()).doubts;
            let said = doubts.iter().find(|doubt| doubt.kind == "angles");
            let said = &said.unwrap_or_else(|| panic!("{law} {rates}")).message;
            assert!(
                said.contains("\"joint top/body about x, y and z\" is turned through ±90° about y")
                    && said.contains("since t = "),
                "{said}"
            );
            let (status, doubt) = in_lanes(&text, batch::LaneFormula::Dopri5, 5e-3, ENERGY_LIMIT);
            assert!(
                matches!((status, doubt), (Status::Doubtful, Some(Doubt::Bent(0)))),
                "{law} {rates}: {doubt:?}"
            );
        }
    }
    // ½ J ω² < ½ k (π/2)²: it turns back before; or it turns about another axis, or passes beside
    for (rates, law) in [
        ("0, 3, 0", "x: { damping: 1e-3 }, y: { stiffness: 4 }"),
        ("3, 0, 0", "x: { damping: 1e-3 }, z: { damping: 1e-3 }"),
        ("0, 0, 3", "x: { damping: 1e-3 }, z: { damping: 1e-3 }"),
        ("0.6, 3, 0", "x: { damping: 1e-3 }"),
    ] {
        let text = with(rates, law);
        assert_eq!(kinds(&text, &job()), [""; 0], "{law} {rates}");
        let found = in_lanes(&text, batch::LaneFormula::Dopri5, 5e-3, ENERGY_LIMIT);
        assert_eq!(found, (Status::Done, None), "{law} {rates}");
    }
    // the same on both sides; fixed steps may come so near to the angle that rounding decides where the moment points
    // to
    let same = with("0, 3, 0", "y: { damping: 0.1, friction: 0.1 }");
    assert_eq!(kinds(&same, &job()), [""; 0]);
    // a law that does not act
    let off = with("0, 3, 0", "x: { damping: 1e-3 }")
        .replace("{ joint: top/body,", "{ joint: top/body, until: off,")
        + "switches: [{ switch: off, when: { time: 0.1 } }]\n";
    assert_eq!(kinds(&off, &job()), [""; 0]);
}

#[test]
fn steps_that_are_too_long_are_told() {
    let line = "{ points: [[-1, -10000], [1, 10000]], extrapolate: linear }";
    let stiff = SPRING.replace("CURVE", line);
    let with = |formula, step| Job {
        method: Some(Integrator::fixed(formula, step)),
        every: Some(6.0),
        ..job()
    };
    // ω = 100 1/s, and Runge and Kutta's method is stable up to ω h = 2.83; it loses energy
    let unstable = kinds(&stiff, &with(Formula::Rk4, 0.034));
    assert_eq!(
        unstable.first().map(String::as_str),
        Some("step"),
        "{unstable:?}"
    );
    let lossy = kinds(&stiff, &with(Formula::Rk4, 0.0275));
    assert_eq!(lossy, ["energy", "error"]);
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

/// A ball that touches a stiff plate for about 20 ms and leaves it: ω = √(k/m) = 141 1/s.
const BOUNCE: &str = "model: bounce
dimension: 2
systems:
  - name: man
    elements: [{ name: ball, mass: 5 kg, cg: [0, 0], inertia: 0.02 }]
    start: { position: [0, 0.11], velocity: [0, -3] }
forces:
  - contact: shelf
    ellipsoid: { on: man/ball, center: [0, 0], semi_axes: [0.1, 0.1] }
    plane: { on: frame, at: [0, 0], normal: [0, 1] }
    elastic: { points: [[0, 0], [1, 1e5]], extrapolate: linear }
outputs: [{ name: z, of: man/ball, what: position, component: z }]
run: { duration: 60 ms, every: 60 ms }
";

/// A ball on a belt that it stretches: ω = 10 1/s.
const PULL: &str = "model: pull
dimension: 2
systems:
  - name: man
    elements: [{ name: ball, mass: 5 kg, cg: [0, 0], inertia: 0.02 }]
    start: { velocity: [0, 1] }
forces:
  - belt: rope
    from: { on: man/ball, at: [0, 0] }
    to: { on: frame, at: [0, -1] }
    force: { points: [[0, 0], [1, 500]], extrapolate: linear }
    length: 1
outputs: [{ name: z, of: man/ball, what: position, component: z }]
run: { duration: 2 s, every: 2 s }
";

fn stepped(formula: Formula, step: f64) -> Job {
    Job {
        method: Some(Integrator::fixed(formula, step)),
        ..job()
    }
}

#[test]
fn what_steps_pass_over_is_told() {
    let missed = |step| {
        let kinds = kinds(BOUNCE, &stepped(Formula::Rk4, step));
        kinds.contains(&"missed".to_owned())
    };
    // a step as long as the run, and one of a fraction of the touch
    assert!(missed(60e-3));
    assert!(!missed(2e-3));
    assert_eq!(kinds(BOUNCE, &stepped(Formula::Rk4, 0.5e-3)), [""; 0]);
    assert_eq!(kinds(BOUNCE, &job()), [""; 0]);
}

#[test]
fn momentum_that_is_lost_is_told() {
    // ω h = 2 is close to the limit of stability, which the impulse of a step shows first; ω h = 0.5 loses almost
    // nothing
    let lost = kinds(PULL, &stepped(Formula::Rk4, 0.2));
    assert_eq!(
        lost.first().map(String::as_str),
        Some("momentum"),
        "{lost:?}"
    );
    assert_eq!(kinds(PULL, &stepped(Formula::Rk4, 0.05)), [""; 0]);
    assert_eq!(kinds(PULL, &job()), [""; 0]);
    let off = Job {
        energy_limit: Some(f64::INFINITY),
        ..stepped(Formula::Rk4, 0.2)
    };
    assert_eq!(kinds(PULL, &off), [""; 0]);
}

/// Two balls that touch for half a millisecond, while a step of 10 ms covers 0.4 m: one of Merson's stages is within
/// the touch, and throws the other ball away.
const MEET: &str = "model: meet
dimension: 3
systems:
  - name: ball
    elements: [{ name: body, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }]
    start: { position: [-8.864117, 7.521460, 5.172915], velocity: [28.803852, -23.673293, -16.380056] }
  - name: target
    elements: [{ name: body, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }]
forces:
  - contact: hit
    ellipsoid: { on: ball/body, center: [0, 0, 0], semi_axes: [0.157162, 0.137808, 0.058865] }
    with: { on: target/body, center: [0, 0, 0], semi_axes: [0.157162, 0.137808, 0.058865] }
    elastic: { points: [[0, 0], [1, 47859732]], extrapolate: linear }
outputs: [{ name: vx, of: ball/body, what: velocity, component: x }]
run: { duration: 0.5 s, every: 0.5 s }
";

#[test]
fn what_a_stage_alone_meets_is_told() {
    let found = kinds(MEET, &stepped(Formula::Merson, 0.01));
    assert!(found.contains(&"error".to_owned()), "{found:?}");
    assert_eq!(kinds(MEET, &stepped(Formula::Merson, 2e-5)), [""; 0]);
    assert_eq!(kinds(MEET, &job()), [""; 0]);
}

/// A mass on the corner of its spring, that is thrown at the hard side and comes back.
const THROWN: &str = "model: thrown
dimension: 2
systems:
  - name: cart
    reference: fixed
    elements: [{ name: body, joint: { slider: x }, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { joint_rates: { body: 1 } }
forces:
  - { joint: cart/body, elastic: { points: [[-1, -1], [0, 0], [1, 1e6]], extrapolate: linear } }
outputs: [{ name: v, of: joint cart/body, what: rate }]
run: { duration: 0.2 s, every: 0.2 s }
";

#[test]
fn a_corner_at_which_a_step_begins_is_passed_well_or_told() {
    // half a period of ω = 1000 1/s on the hard side, and the rest at ω = 1 1/s on the other
    let exact = -(0.2 - std::f64::consts::PI / 1000.0).cos();
    let mut wrong = 0;
    for formula in [
        Formula::Heun,
        Formula::Rk4,
        Formula::Merson,
        Formula::Dopri5,
    ] {
        for step in [
            2e-5, 1e-4, 5e-4, 1e-3, 2e-3, 3e-3, 5e-3, 0.01, 0.02, 0.05, 0.2,
        ] {
            let recording = go(THROWN, &stepped(formula, step));
            if recording.result.is_err() {
                continue;
            }
            let v = recording
                .table
                .columns
                .last()
                .and_then(|column| column.values.last());
            let off = (v.expect("a speed") - exact).abs();
            let told = !recording.doubts.is_empty();
            assert!(told || off < 0.1, "{formula} {step}: {off}");
            assert!(!told || off > 1e-3, "{formula} {step}: {off}");
            wrong += u32::from(off > 0.1);
        }
    }
    assert!(wrong >= 12, "{wrong}");
    assert_eq!(kinds(THROWN, &job()), [""; 0]);
}

/// An arm that is driven to and fro, and a body between belts.
const DRIVEN: &str = "model: driven
dimension: 2
curves: { nod: { points: [[0, 0], [0.5, 1], [1, -1], [1.5, 0.5], [2, 0]], interpolate: cubic } }
systems:
  - name: arm
    reference: fixed
    elements: [{ name: body, mass: 1, cg: [0.2, 0], inertia: 0.02 }]
forces:
  - { joint: arm/body, drive: { to: nod, stiffness: 12, damping: 0.1, limit: 4 } }
outputs: [{ name: angle, of: joint arm/body, what: angle }]
run: { duration: 3 s, every: 0.5 s }
";

const BETWEEN: &str = "model: between
dimension: 2
systems:
  - name: man
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 0.01 }]
    start: { velocity: [3, 0.5] }
forces:
  - { belt: left, from: { on: man/body, at: [0, 0.02] }, to: { on: frame, at: [-0.3, 0] }, stiffness: 40 kN, slack: 5 mm }
  - { belt: right, from: { on: man/body, at: [0, -0.02] }, to: { on: frame, at: [0.3, 0.05] }, stiffness: 40 kN, slack: 5 mm }
outputs: [{ name: x, of: man/body, what: position, component: x }]
run: { duration: 0.3 s, every: 50 ms }
";

#[test]
fn steps_that_err_are_told() {
    for (scene, formulas, steps) in [
        (
            DRIVEN,
            [Formula::Heun, Formula::Rk4],
            [0.125, 0.1, 0.0625, 0.05, 0.025, 0.0125, 5e-3, 1e-3],
        ),
        (
            BETWEEN,
            [Formula::Heun, Formula::Rk4],
            [5e-3, 2.5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 2e-5],
        ),
    ] {
        let last = |recording: &Recording| {
            let column = recording.table.columns.last().expect("an output");
            column.values.clone()
        };
        let sharp = last(&go(scene, &job()));
        let size = sharp.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let (mut told_of, mut silent) = (0, 0);
        for formula in formulas {
            for step in steps {
                let recording = go(scene, &stepped(formula, step));
                let told = recording.result.is_err() || !recording.doubts.is_empty();
                let found = last(&recording);
                let apart = found.iter().zip(&sharp).map(|(a, b)| (a - b).abs());
                let off = apart.fold(0.0, f64::max) / size;
                // 5 %, by an estimate within a factor of two
                assert!(told || off < 0.1, "{formula} {step}: {off}");
                assert!(!told || off > 5e-3, "{formula} {step}: {off}");
                told_of += u32::from(told);
                silent += u32::from(!told);
            }
        }
        assert!(told_of >= 3 && silent >= 3, "{told_of} {silent}");
    }
}

/// How the only row of a scene ends in lanes by fixed steps.
fn in_lanes(
    text: &str,
    method: batch::LaneFormula,
    step: f64,
    energy_limit: f64,
) -> (Status, Option<Doubt>) {
    let (model, engine) = sound(text);
    let job = RowsJob {
        settings: batch::Settings {
            duration: model.run.duration,
            samples: 2,
            pace: Pace::Fixed(Fixed { method, step }),
            locate: false,
            max_steps: 1_000_000,
            time_limit: None,
            energy_limit,
        },
        varied: Vec::new(),
        fixed: Vec::new(),
        responses: Vec::new(),
        estimate: false,
        wanted: f64::INFINITY,
        width: Width::widest(),
    };
    let row = engine.rows(&job, &[]).expect("there are registers").rows[0];
    (row.status, row.doubt)
}

#[test]
fn lanes_of_fixed_steps_are_watched_as_single_runs_are() {
    let line = "{ points: [[-1, -10000], [1, 10000]], extrapolate: linear }";
    let stiff = SPRING.replace("CURVE", line);
    let rk4 = |text, step| in_lanes(text, batch::LaneFormula::Rk4, step, ENERGY_LIMIT);
    let good = (Status::Done, None);
    // as `steps_that_are_too_long_are_told`
    let (status, doubt) = rk4(&stiff, 0.034);
    assert!(
        status != Status::Done && matches!(doubt, Some(Doubt::Unstable(_))),
        "{doubt:?}"
    );
    let (status, doubt) = rk4(&stiff, 0.0275);
    assert_eq!(
        (status, doubt),
        (Status::Doubtful, Some(Doubt::Energy(Some(0))))
    );
    assert_eq!(rk4(&stiff, 0.0005), good);
    // as `momentum_that_is_lost_is_told`
    assert_eq!(rk4(PULL, 0.2), (Status::Doubtful, Some(Doubt::Momentum)));
    assert_eq!(rk4(PULL, 0.05), good);
    let off = in_lanes(PULL, batch::LaneFormula::Rk4, 0.2, f64::INFINITY);
    assert_eq!(off, good);
    // as `what_a_stage_alone_meets_is_told`
    let (status, doubt) = in_lanes(MEET, batch::LaneFormula::Merson, 0.01, ENERGY_LIMIT);
    assert!(
        matches!((status, doubt), (Status::Doubtful, Some(Doubt::Error(_)))),
        "{doubt:?}"
    );
    assert_eq!(
        in_lanes(MEET, batch::LaneFormula::Merson, 2e-5, ENERGY_LIMIT),
        good
    );
}

#[test]
fn a_time_limit_ends_what_would_not_end() {
    let line = "{ points: [[-1, -1e8], [1, 1e8]], extrapolate: linear }";
    let stiff = SPRING.replace("CURVE", line);
    let within = |duration, limit| {
        let job = Job {
            duration: Some(duration),
            time_limit: Some(Duration::from_secs_f64(limit)),
            ..job()
        };
        go(&stiff, &job).result
    };
    // 10⁴ periods of 0.6 ms in a simulated second
    let error = within(1e4, 0.2).expect_err("it takes hours");
    assert_eq!((error.kind, error.exit_code()), (ErrorKind::Time, 3));
    assert!(within(0.2, 60.0).is_ok());
}

#[test]
fn what_grows_without_end_ends() {
    // φ̈ = ±10⁶ φ: e^(1000 t) exceeds all doubles at 0.71 s, and a cosine of ω = 1000 1/s exceeds nothing
    let with = |sign: &str| {
        let line = format!(
            "{{ points: [[-1, {sign}1e6], [1, {}1e6]], extrapolate: linear }}",
            if sign == "-" { "" } else { "-" }
        );
        SPRING
            .replace("CURVE", &line)
            .replace("duration: 6 s", "duration: 1 s")
    };
    let error = go(&with(""), &job()).result.expect_err("it grows");
    let t = error.t.expect("a time");
    assert!(
        (0.69..0.72).contains(&t) && error.exit_code() == 3,
        "{error:?}"
    );
    assert!(error.message.contains("is not finite"), "{error:?}");
    assert_eq!(kinds(&with("-"), &job()), [""; 0]);
    let short = Job {
        duration: Some(0.1),
        ..job()
    };
    assert!(go(&with(""), &short).result.is_ok(), "it is finite yet");
}

#[test]
fn an_inertia_that_vanishes_ends_the_run() {
    // two points on massless arms, which hold each other except where they are in line
    let text = "model: line
dimension: 2
systems:
  - name: two
    elements:
      - { name: ball, mass: 1, cg: [0.1, 0], inertia: 0 }
      - { name: rider, on: ball, at: [0.4, 0], mass: 1, cg: [0.3, 0], inertia: 0 }
    start: { angles: { rider: BEND }, rates: { rider: RATE } }
outputs: [{ name: angle, of: two/rider, what: angle }]
run: { duration: 0.1 s, every: 10 ms }
";
    let with = |bend: &str, rate: &str| {
        let text = text.replace("BEND", bend).replace("RATE", rate);
        go(&text, &job()).result
    };
    // in line from the start, or later, or never
    let error = with("0", "0").expect_err("nothing holds them");
    assert!(
        error.message.contains("is not finite") && error.t == Some(0.0),
        "{error:?}"
    );
    let error = with("-10 deg", "3").expect_err("they come in line");
    assert!(error.message.contains("asks for a step of"), "{error:?}");
    assert!(with("10 deg", "0").is_ok() && with("10 deg", "3").is_ok());
}

/// Two rods that fall from near the top: a chaotic motion.
const CHAOS: &str = "model: chaos
dimension: 2
systems:
  - name: arm
    reference: fixed
    elements:
      - { name: upper, mass: 1, cg: [0, -0.5], inertia: 0.08 }
      - { name: lower, on: upper, at: [0, -1], mass: 1, cg: [0, -0.5], inertia: 0.08 }
    start: { angles: { upper: 3, lower: 3 } }
forces: [{ field: gravity, acceleration: [0, -9.81] }]
outputs: [{ name: angle, of: arm/lower, what: angle }]
run: { duration: 60 s, every: 1 s }
";

#[test]
fn outputs_are_as_accurate_as_promised_or_said_not_to_be() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    std::fs::write(here.join("chaos.yaml"), CHAOS).unwrap();
    for (more, code, said) in [
        (&["--duration", "60 s"][..], 3, "not as accurate as 0.1 %"),
        (&["--duration", "2 s"], 0, "checked by"),
        (&["--duration", "60 s", "--no-verify"], 0, "evaluations"),
        (
            &["--duration", "60 s", "--tolerance", "1e-3"],
            3,
            "not as accurate as 10 %",
        ),
        (
            &["--duration", "2 s", "--tolerance", "1e-6"],
            0,
            "checked by",
        ),
        (
            &["--duration", "60 s", "--accuracy", "0.1%"],
            3,
            "is not reached",
        ),
        (
            &["--duration", "2 s", "--accuracy", "0.1%"],
            0,
            "estimated error at most",
        ),
        (&["--duration", "60 s", "--verify"], 3, "not as accurate as"),
        (&["--duration", "2 s", "--verify"], 0, "checked by"),
    ] {
        let arguments = [&["run", "chaos.yaml", "--no-files"][..], more].concat();
        let (_, stderr) = call(here, &arguments, code);
        assert!(stderr.contains(said), "{more:?}: {stderr}");
    }
}

/// Two balls of 10 mm that meet head on, or with a distance of `offset` between their paths.
const BALLS: &str = "model: balls
dimension: 2
parameters: { offset: 0 m, stiffness: 100 N/m }
curves: { line: { unit: [m, m], points: [[0, 0], [1, 1]], extrapolate: linear } }
systems:
  - name: ball
    elements: [{ name: body, mass: 10 g, cg: [0, 0], inertia: 1e-6 }]
    start: { position: [-1, offset], velocity: [200, 0] }
  - name: target
    elements: [{ name: body, mass: 10 g, cg: [0, 0], inertia: 1e-6 }]
forces:
  - contact: hit
    ellipsoid: { on: ball/body, center: [0, 0], semi_axes: [10 mm, 10 mm] }
    with: { on: target/body, center: [0, 0], semi_axes: [10 mm, 10 mm] }
    elastic: { curve: line, times: stiffness }
outputs: [{ name: speed, of: target/body, what: velocity, component: x }]
run: { duration: 20 ms, every: 1 ms }
";

#[test]
fn ellipsoids_that_sink_through_each_other_say_so() {
    let space = BALLS
        .replace("dimension: 2", "dimension: 3")
        .replace("[-1, offset]", "[-1, offset, 0]")
        .replace("[200, 0]", "[200, 0, 0]")
        .replace(
            "cg: [0, 0], inertia: 1e-6",
            "cg: [0, 0, 0], inertia: [1e-6, 1e-6, 1e-6]",
        )
        .replace("center: [0, 0]", "center: [0, 0, 0]")
        .replace("[10 mm, 10 mm]", "[10 mm, 10 mm, 10 mm]");
    // along their shortest axes, one of which would be a disc
    let flat = |text: &str| text.replacen("[10 mm, 10 mm", "[3 mm, 10 mm", 1);
    let with = |offset: f64, stiffness: f64, method: Option<Integrator>| Job {
        parameters: vec![("offset".into(), offset), ("stiffness".into(), stiffness)],
        method,
        ..job()
    };
    let fixed = |step| Some(Integrator::fixed(Formula::Rk4, step));
    for text in [BALLS.to_owned(), space.clone(), flat(BALLS), flat(&space)] {
        // 100 N/m stop nothing: one ball passes through the other, in steps of the default method and in short ones
        for method in [None, fixed(1e-5), fixed(1.3e-5)] {
            assert_eq!(
                kinds(&text, &with(0.0, 100.0, method)),
                ["sunk"],
                "{text} {method:?}"
            );
            // beside each other at any depth, if both are round; touching only
            let round = !text.contains("[3 mm");
            let beside = [5e-3, 1e-3, -1e-3].into_iter().filter(|_| round);
            for offset in beside.chain([19.9e-3]) {
                let mut found = kinds(&text, &with(offset, 100.0, method));
                // a touch of 20 µs is two fixed steps, which err by more than 5 % in the spin that it gives
                found.retain(|kind| method.is_none() || kind != "error");
                assert_eq!(found, [""; 0], "{offset} {method:?} {text}");
            }
        }
        // 100 MN/m stop them
        assert_eq!(kinds(&text, &with(0.0, 1e8, None)), [""; 0], "{text}");
    }
    // a step that ends where the centres coincide finds no force there
    for text in [BALLS, &space] {
        for step in [1e-3, 5e-4] {
            let found = kinds(text, &with(0.0, 1e8, fixed(step)));
            assert_eq!(
                found.first().map(String::as_str),
                Some("sunk"),
                "{step} {found:?}"
            );
        }
    }
    // along the z axis, where an angle about it would jump without a reason
    let upright = space
        .replace("[-1, offset, 0]", "[offset, 0, -1]")
        .replace("[200, 0, 0]", "[0, 0, 200]");
    assert_eq!(kinds(&upright, &with(1e-3, 100.0, None)), [""; 0]);
    assert_eq!(kinds(&upright, &with(0.0, 100.0, None)), ["sunk"]);
}

/// A heavy ball that falls on a bag, and on a floor below.
const BAG: &str = "\
model: bag
dimension: 3
parameters: { floor: { value: -0.2 m } }
systems:
  - name: ball
    reference: free
    elements: [{ name: lead, mass: 200 kg, cg: [0, 0, 0], inertia: [5, 5, 5] }]
    start: { position: [0, 0, 0.75], velocity: [0, 0, -10] }
surfaces:
  ball: { on: ball/lead, center: [0, 0, 0], semi_axes: [0.4, 0.4, 0.4] }
forces:
  - airbag: cushion
    ellipsoid: { on: frame, center: [0, 0, 0], semi_axes: [0.3, 0.3, 0.3] }
    against: [ball]
    vent: { area: 20000 mm^2 }
    start: { pressure: 110 kPa, temperature: 293.15 K }
  - { contact: floor, ellipsoid: ball, plane: { on: frame, at: [0, 0, floor], normal: [0, 0, 1] }, stiffness: 5e6, damping: 1e4 }
outputs: [{ name: volume, of: airbag cushion, what: volume }]
run: { duration: 0.1 s }
";

#[test]
fn a_bag_that_is_pressed_flat_says_so() {
    let at = |floor: f64| {
        let parameters = vec![("floor".into(), floor)];
        kinds(
            BAG,
            &Job {
                parameters,
                ..job()
            },
        )
    };
    // 0.113 m³, of which the ball leaves about 4 litres, or none
    assert_eq!(at(-0.2), [""; 0]);
    assert_eq!(at(-0.25), ["volume"]);
    let rk4 = |text: &str| in_lanes(text, batch::LaneFormula::Rk4, 1e-6, ENERGY_LIMIT).1;
    assert_eq!(rk4(BAG), None);
    let deep = BAG.replace("-0.2 m", "-0.25 m");
    let found = rk4(&deep);
    assert!(matches!(found, Some(Doubt::Left(_))), "{found:?}");
}

/// A cart of 2 kg that 3 N push from a time that is a parameter until 40 ms.
const PUSHED: &str = "\
model: pushed
dimension: 2
parameters: { when: 0.02 s }
systems:
  - name: a
    elements: [{ name: cart, mass: 2 kg, cg: [0, 0], inertia: 1 }]
switches:
  - { switch: on, when: { time: when } }
  - { switch: off, when: { time: 0.04 s } }
forces: [{ load: push, on: a/cart, at: [0, 0], force: [3, 0], since: on, until: off }]
outputs: [{ name: v, of: a/cart, what: velocity, component: x }]
run: { duration: 0.1 s, every: 10 ms }
";

/// Before 40 ms, dv/dT = −F/m; from there on nothing pushes, and T matters no more: at 40 ms there is no derivative.
#[test]
fn events_that_cannot_be_told_apart_say_so() {
    let (model, engine) = sound(PUSHED);
    let job = RowsJob {
        settings: batch::Settings {
            duration: model.run.duration,
            samples: 2,
            pace: Pace::Adaptive(Tolerances::of(1e-8)),
            locate: true,
            max_steps: 100_000,
            time_limit: None,
            energy_limit: ENERGY_LIMIT,
        },
        varied: vec![0],
        fixed: Vec::new(),
        responses: vec![Asked::of(0, Response::Final)],
        estimate: false,
        wanted: f64::INFINITY,
        width: Width::widest(),
    };
    let slope = |when: f64, by: f64| {
        let found = engine.gradients(&job, &[when], &[by]).expect("it runs");
        let row = found.rows[0];
        ((row.status, row.doubt), found.slopes[0])
    };
    // to the tolerance
    let (state, found) = slope(0.02, 1.0);
    assert_eq!(state, (Status::Done, None));
    assert!((found + 1.5).abs() < 1e-6, "{found}");
    let tied = (Status::Doubtful, Some(Doubt::Tied));
    assert_eq!(slope(0.04, 1.0).0, tied);
    // nothing is asked of it along no direction
    assert_eq!(slope(0.04, 0.0).0, (Status::Done, None));
}

/// The tests of each reason: its enumeration, its name, and the tests with and without it.
const PAIRS: &[(&str, &str, &[&str])] = &[
    ("Problem", "Step", &["steps_that_are_too_long_are_told"]),
    (
        "Problem",
        "Curve",
        &[
            "a_curve_counts_while_its_force_acts",
            "a_line_through_nothing_goes_on_for_ever",
        ],
    ),
    ("Problem", "Missed", &["what_steps_pass_over_is_told"]),
    (
        "Problem",
        "Flexion",
        &[
            "a_flexion_through_half_a_turn_says_so",
            "a_joint_through_its_singular_angle_says_so",
        ],
    ),
    (
        "Problem",
        "Sunk",
        &["ellipsoids_that_sink_through_each_other_say_so"],
    ),
    ("Problem", "Energy", &["steps_that_are_too_long_are_told"]),
    ("Problem", "Momentum", &["momentum_that_is_lost_is_told"]),
    ("Problem", "Error", &["what_a_stage_alone_meets_is_told"]),
    ("Reason", "NonFinite", &["what_grows_without_end_ends"]),
    (
        "Reason",
        "StepTooSmall",
        &["an_inertia_that_vanishes_ends_the_run"],
    ),
    (
        "Reason",
        "TooManySteps",
        &["too_many_steps_and_none_too_many"],
    ),
    (
        "Reason",
        "InvalidSettings",
        &["settings_without_sense_are_refused"],
    ),
    ("Reason", "Refused", &["infinite_parameters_are_refused"]),
    (
        "Reason",
        "NoJacobian",
        &["a_method_that_needs_a_jacobian_says_so_where_there_is_none"],
    ),
    ("ErrorKind", "Job", &["infinite_parameters_are_refused"]),
    ("ErrorKind", "Run", &["what_grows_without_end_ends"]),
    (
        "ErrorKind",
        "Time",
        &["a_time_limit_ends_what_would_not_end"],
    ),
    (
        "ErrorKind",
        "Stopped",
        &["an_observer_hears_between_samples_and_stops_a_run"],
    ),
    (
        "Doubt",
        "Bent",
        &[
            "every_row_without_a_result_says_why",
            "lanes_tell_what_single_runs_tell",
        ],
    ),
    (
        "Doubt",
        "Sunk",
        &["ellipsoids_that_sink_through_each_other_are_told_in_lanes"],
    ),
    (
        "Doubt",
        "Missed",
        &["fixed_steps_that_go_over_something_are_told"],
    ),
    (
        "Doubt",
        "Left",
        &["curves_that_are_left_too_far_are_told_in_lanes"],
    ),
    (
        "Doubt",
        "Unstable",
        &["lanes_of_fixed_steps_are_watched_as_single_runs_are"],
    ),
    (
        "Doubt",
        "Energy",
        &["lanes_of_fixed_steps_are_watched_as_single_runs_are"],
    ),
    (
        "Doubt",
        "Momentum",
        &["lanes_of_fixed_steps_are_watched_as_single_runs_are"],
    ),
    (
        "Doubt",
        "Error",
        &["lanes_of_fixed_steps_are_watched_as_single_runs_are"],
    ),
    (
        "Doubt",
        "Tied",
        &["events_that_cannot_be_told_apart_say_so"],
    ),
    (
        "ErrorReport",
        "not as accurate",
        &["outputs_are_as_accurate_as_promised_or_said_not_to_be"],
    ),
    (
        "ErrorReport",
        "not reached",
        &["outputs_are_as_accurate_as_promised_or_said_not_to_be"],
    ),
    (
        "ErrorReport",
        "could not be checked",
        &["a_check_that_fails_is_an_error_and_one_without_time_is_not"],
    ),
];

/// The names of the variants of an enumeration in a source file.
fn variants<'a>(source: &'a str, name: &str) -> Vec<&'a str> {
    let start = format!("pub enum {name} {{\n");
    let (_, body) = source.split_once(&start).expect("it is there");
    let (body, _) = body.split_once("\n}").expect("it ends");
    let lines = body.lines().filter_map(|line| line.strip_prefix("    "));
    let names = lines.filter(|line| line.starts_with(|c: char| c.is_ascii_uppercase()));
    let end = |c: char| !c.is_ascii_alphanumeric();
    names
        .map(|line| line.split(end).next().unwrap_or_default())
        .collect()
}

#[test]
fn every_reason_has_a_scene_that_trips_it_and_one_that_does_not() {
    macro_rules! source {
        ($path:literal) => {
            include_str!(concat!("../../../", $path))
        };
    }
    let enumerations = [
        ("Problem", source!("runtime/src/simulate/diagnostic.rs")),
        ("Reason", source!("runtime/src/failure.rs")),
        ("ErrorKind", source!("runtime/src/program/error.rs")),
        ("Doubt", source!("runtime/src/batch/scenario.rs")),
    ];
    let mut reasons: Vec<(&str, &str)> = Vec::new();
    for (name, source) in enumerations {
        reasons.extend(variants(source, name).into_iter().map(|v| (name, v)));
    }
    // the reasons of a run's check, by words of their messages
    let report = source!("src/command/error_report.rs");
    let said = report.matches("error(format!(").count();
    let words = ["not as accurate", "not reached", "could not be checked"];
    reasons.extend(words.map(|words| ("ErrorReport", words)));
    assert_eq!(said, 3, "a check ends for a reason that is not listed here");
    let listed: Vec<(&str, &str)> = PAIRS.iter().map(|(name, v, _)| (*name, *v)).collect();
    assert_eq!(reasons, listed);
    let tests = [
        include_str!("doubts.rs"),
        include_str!("refusals.rs"),
        source!("tests/suite/sweep/reasons.rs"),
        source!("runtime/tests/it/simulate.rs"),
        source!("runtime/tests/it/program.rs"),
        source!("tests/suite/units/command/error_report.rs"),
        source!("engine/tests/it/onset.rs"),
    ];
    for (name, reason, pair) in PAIRS {
        for test in *pair {
            let test = format!("fn {test}() {{");
            let there = tests.iter().any(|text| text.contains(&test));
            assert!(there, "{name}::{reason}: {test}");
        }
    }
}
