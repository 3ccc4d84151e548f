//! Random scenes in which several laws that begin, end, remember and switch act together: the result of `bryant run`
//! agrees with a sharp run by another method to what is promised, or the run says that it does not.

use super::sound;
use bryant::accuracy::check::{self, Verdict};
use bryant::accuracy::comparison::PROMISED;
use bryant::simulation;
use bryant_hard::random::Random;
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Integrator, Tolerances};

/// Draws a scene.
type Shape = fn(&mut Random) -> String;

/// Scenes of each shape.
const SCENES: u64 = 12;

/// A number from `from` to `to`, every power of ten as often as any other.
fn of(random: &mut Random, from: f64, to: f64) -> f64 {
    from * (to / from).powf(random.uniform(0.0, 1.0))
}

/// A curve through 0 of three straight pieces on each side.
fn bent(random: &mut Random, length: f64, force: f64) -> String {
    let (x, y) = (random.uniform(0.2, 0.8), random.uniform(0.1, 0.9));
    let points = [[10.0, 14.0], [1.0, 1.0], [x, y]].map(|[x, y]| [x * length, y * force]);
    let below = points.map(|[x, y]| format!("[{:e}, {:e}]", -x, -y));
    let above = points.map(|[x, y]| format!("[{x:e}, {y:e}]"));
    let [c, b, a] = above;
    format!(
        "{{ points: [{}, [0, 0], {a}, {b}, {c}], extrapolate: linear }}",
        below.join(", ")
    )
}

/// A chain whose joints unload along other curves, meet stops, and are locked, loosened or joined by switches.
fn chain(r: &mut Random) -> String {
    let (mut elements, mut forces, mut outputs) = (String::new(), String::new(), String::new());
    for i in 0..2 {
        let mass = of(r, 0.3, 5.0);
        let on = if i == 0 {
            ""
        } else {
            "on: e0, at: [0, -0.35], "
        };
        elements += &format!(
            "      - {{ name: e{i}, {on}mass: {mass:e}, cg: [{:e}, -0.2], inertia: {:e} }}\n",
            r.uniform(-0.05, 0.05),
            0.02 * mass
        );
        let stiffness = of(r, 3.0, 100.0);
        let curve = bent(r, 1.0, stiffness);
        let when = [
            "since: a",
            "until: b",
            "lock: { by: b, stiffness: 50, damping: 0.5 }",
        ][r.below(3)];
        forces += &format!(
            "  - {{ joint: s/e{i}, elastic: {curve}, unloading_slope: {:e}, damping: {:e}, {when}, stop: {{ from: {:e}, to: {:e}, stiffness: {:e}, damping: 0.3 }} }}\n",
            stiffness * of(r, 10.0, 50.0),
            of(r, 0.02, 0.5),
            r.uniform(-1.0, -0.1),
            r.uniform(0.1, 1.0),
            of(r, 50.0, 1e4)
        );
        forces += &format!("  - {{ joint: s/e{i}, name: rest, stiffness: 5, damping: 0.05 }}\n");
        outputs += &format!("  - {{ name: a{i}, of: s/e{i}, what: angle }}\n");
    }
    format!(
        "dimension: 2\nsystems:\n  - name: s\n    reference: fixed\n    elements:\n{elements}    start: {{ angles: {{ e0: {:e}, e1: {:e} }}, rates: {{ e0: {:e}, e1: {:e} }} }}\n\
         forces:\n{forces}  - {{ field: g, acceleration: [0, -9.81] }}\n\
         switches:\n  - {{ switch: a, when: {{ time: {:e} }} }}\n  - {{ switch: b, when: {{ of: joint s/e1, what: angle, above: {:e} }}, after: 2 ms }}\n\
         outputs:\n{outputs}run: {{ duration: 0.4 s, every: 10 ms }}\n",
        r.uniform(-1.0, 1.0),
        r.uniform(-1.0, 1.0),
        r.uniform(-6.0, 6.0),
        r.uniform(-6.0, 6.0),
        r.uniform(0.01, 0.2),
        r.uniform(-0.3, 0.6)
    )
}

/// A slider that is driven between stops, and a hinge on it that rubs, holds and is turned by a motor.
fn driven(r: &mut Random) -> String {
    let stiffness = of(r, 300.0, 2e4);
    format!(
        "dimension: 2\nsystems:\n  - name: s\n    reference: fixed\n    elements:\n      - {{ name: c, joint: {{ slider: x }}, mass: {:e}, cg: [0, 0], inertia: 0.02 }}\n      \
         - {{ name: d, on: c, at: [0.3, 0], joint: {{ hinge: y }}, mass: 1, cg: [0.1, 0], inertia: 0.01 }}\n    start: {{ joint_rates: {{ c: {:e}, d: {:e} }} }}\n\
         forces:\n  - {{ joint: s/c, damping: 2, stop: {{ from: {:e}, to: {:e}, stiffness: {:e}, damping: 5 }}, drive: {{ to: {{ points: [[0, 0], [0.1, {:e}], [0.3, {:e}], [0.5, 0]], interpolate: cubic }}, stiffness: {stiffness:e}, damping: {:e}, limit: {:e} }} }}\n  \
         - {{ joint: s/d, stiffness: {:e}, unloading_slope: 2000, friction: {:e}, friction_displacement: {:e}, motor: {{ points: [[0, 0], [0.1, {:e}], [0.3, 0]] }}, until: off }}\n  \
         - {{ joint: s/d, name: rest, damping: 0.05, stop: {{ from: -0.6, to: {:e}, stiffness: 300 }} }}\n\
         switches: [{{ switch: off, when: {{ of: joint s/d, what: angle, above: {:e} }} }}]\n\
         outputs: [{{ name: c, of: joint s/c, what: position }}, {{ name: d, of: joint s/d, what: angle }}]\nrun: {{ duration: 0.6 s, every: 10 ms }}\n",
        of(r, 0.5, 5.0),
        r.uniform(-0.3, 0.3),
        r.uniform(-4.0, 4.0),
        r.uniform(-0.06, -0.01),
        r.uniform(0.01, 0.06),
        stiffness * of(r, 1.0, 30.0),
        r.uniform(-0.08, 0.08),
        r.uniform(-0.08, 0.08),
        of(r, 1.0, 30.0),
        of(r, 5.0, 60.0),
        of(r, 3.0, 50.0),
        of(r, 0.05, 2.0),
        of(r, 5e-4, 1e-2),
        r.uniform(-2.0, 2.0),
        r.uniform(0.2, 0.8),
        r.uniform(0.1, 0.5)
    )
}

/// A body on the floor of a car that brakes until it stands, which slides into the dash and is held by a belt that
/// yields.
fn stopping(r: &mut Random) -> String {
    let (mass, speed, time) = (of(r, 1.0, 80.0), of(r, 2.0, 20.0), r.uniform(0.05, 0.2));
    format!(
        "dimension: 2\nvehicles: [{{ name: car, acceleration: [{:e}, 0], stops: true, start: {{ velocity: [{speed:e}, 0] }} }}]\n\
         systems:\n  - name: s\n    elements:\n      - {{ name: b, mass: {mass:e}, cg: [0, 0], inertia: {:e} }}\n      - {{ name: h, on: b, at: [0, 0.2], mass: {:e}, cg: [0, 0.1], inertia: {:e} }}\n    start: {{ position: [0, 0.1], velocity: [{speed:e}, 0] }}\n\
         forces:\n  - {{ field: g, acceleration: [0, -9.81] }}\n  \
         - {{ contact: floor, ellipsoid: {{ on: s/b, center: [0, 0], semi_axes: [0.15, 0.1] }}, plane: {{ on: car, at: [0, 0], normal: [0, 1], extent: {:e} }}, stiffness: {:e}, damping: {:e}, friction: {:e}, friction_displacement: {:e} }}\n  \
         - {{ contact: dash, ellipsoid: {{ on: s/b, center: [0, 0], semi_axes: [0.15, 0.1] }}, plane: {{ on: car, at: [{:e}, 0], normal: [-1, 0] }}, stiffness: {:e}, unloading_slope: {:e} }}\n  \
         - {{ belt: x, from: {{ on: s/b, at: [0, 0.05] }}, to: {{ on: car, at: [-0.5, {:e}] }}, stiffness: {:e}, slack: {:e}, damping: {mass:e}, limiter: {{ force: {:e} }} }}\n  \
         - {{ joint: s/h, stiffness: {mass:e}, damping: {:e}, stop: {{ from: -0.6, to: 0.6, stiffness: {:e} }} }}\n\
         outputs: [{{ name: x, of: s/b, what: velocity, component: x }}, {{ name: head, of: s/h, what: angle }}]\nrun: {{ duration: {:e}, every: 5 ms }}\n",
        -speed / time,
        0.02 * mass,
        0.1 * mass,
        2e-3 * mass,
        r.uniform(0.3, 1.5),
        mass * of(r, 3e3, 3e4),
        mass * of(r, 3.0, 50.0),
        r.uniform(0.1, 0.8),
        of(r, 1e-4, 3e-3),
        r.uniform(0.2, 0.4),
        mass * 3e3,
        mass * 1e5,
        r.uniform(0.0, 0.4),
        mass * of(r, 3e3, 3e4),
        r.uniform(0.0, 0.05),
        mass * speed / time * of(r, 0.3, 3.0),
        0.03 * mass,
        30.0 * mass,
        1.5 * time
    )
}

/// A body that flies into a belt which runs through a ring, slack at first, on a reel that a switch locks.
fn ringed(r: &mut Random) -> String {
    let (mass, speed) = (of(r, 1.0, 60.0), of(r, 0.5, 15.0));
    let end = [
        "slack: 0.02",
        "slack: 0.0",
        "retractor: { lock: l, spool: 10 }",
    ][r.below(3)];
    format!(
        "dimension: 2\nsystems:\n  - name: s\n    elements: [{{ name: b, mass: {mass:e}, cg: [0, 0.1], inertia: {:e} }}]\n    start: {{ position: [0.2, 0], velocity: [{speed:e}, {:e}] }}\n\
         forces:\n  - belt: x\n    from: {{ on: frame, at: [-0.3, 0] }}\n    through: [{{ ring: one, on: frame, at: [{:e}, 0.3], friction: {:e}, resistance: {:e} }}]\n    \
         to: {{ on: s/b, at: [0.1, 0] }}\n    stiffness: {:e}\n    {end}\n    damping: {:e}\n    limiter: {{ force: {:e} }}\n\
         switches: [{{ switch: l, when: {{ of: s/b, what: displacement, component: x, above: 0.01 }} }}]\n\
         outputs: [{{ name: x, of: s/b, what: velocity, component: x }}, {{ name: slip, of: belt x, what: slip, ring: one }}]\nrun: {{ duration: {:e}, every: 2 ms }}\n",
        0.02 * mass,
        r.uniform(-2.0, 2.0),
        r.uniform(-0.1, 0.1),
        r.uniform(0.0, 0.4),
        of(r, 50.0, 500.0),
        of(r, 3e3, 5e4),
        of(r, 1.0, 200.0),
        of(r, 500.0, 5e3),
        (1.0 / speed).min(0.2)
    )
}

#[test]
fn laws_that_act_together_are_as_accurate_as_promised_or_said_not_to_be() {
    let shapes: [(&str, Shape); 4] = [
        ("chain", chain),
        ("driven", driven),
        ("stopping", stopping),
        ("ringed", ringed),
    ];
    let sharp = Job {
        method: Some(Integrator::adaptive(Formula::Dop853, Tolerances::of(1e-11))),
        locate: Some(true),
        ..Job::default()
    };
    let mut compared = 0;
    for (name, shape) in shapes {
        for seed in 0..SCENES {
            let text = format!("model: {name}\n{}", shape(&mut Random::new(seed)));
            let (_, engine) = sound(&text);
            let checked = check::run(&engine, &Job::default(), false, &mut |_, _| {});
            let run = &checked.recording;
            let close = matches!(&checked.certainty.check, Some((_, Verdict::Apart(d))) if d.worst <= checked.certainty.limit);
            if run.result.is_err() || !run.doubts.is_empty() || !close {
                continue;
            }
            let reference = simulation::run(&engine, &sharp, &mut |_| {});
            if reference.result.is_err() {
                continue;
            }
            compared += 1;
            for (ours, sharp) in run.table.columns.iter().zip(&reference.table.columns) {
                let size = sharp.values.iter().fold(1e-9, |m: f64, x| m.max(x.abs()));
                let apart = ours
                    .values
                    .iter()
                    .zip(&sharp.values)
                    .map(|(a, b)| (a - b).abs());
                let off = apart.fold(0.0, f64::max) / size;
                assert!(off <= PROMISED, "{} is {off:e} off\n{text}", ours.name);
            }
        }
    }
    // what the rest says is not compared
    assert!(compared >= 3 * SCENES, "{compared}");
}
