//! The shapes of scenes in which a free motion meets something, or nothing, and the parameters of each scene.

use super::{Case, Met, direction, met, size, speed, stiffness};
use crate::random::Random;

const BALLS: &str = "
model: balls
dimension: 2
parameters: { x: -1 m, z: 0 m, u: 1 m/s, w: 0 m/s, r: 10 mm, other: 10 mm, k: 1 N/m }
curves: { line: { unit: [m, m], points: [[0, 0], [1, 1]], extrapolate: linear } }
systems:
  - name: ball
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { position: [x, z], velocity: [u, w] }
  - name: target
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1 }]
forces:
  - contact: hit
    ellipsoid: { on: ball/body, center: [0, 0], semi_axes: [r, r] }
    with: { on: target/body, center: [0, 0], semi_axes: [other, other] }
    elastic: { curve: line, times: k }
outputs:
  - { name: vx, of: ball/body, what: velocity, component: x }
  - { name: vz, of: ball/body, what: velocity, component: z }
run: { duration: 1 s, every: 0.1 s }
";

fn balls(random: &mut Random) -> Case {
    let (r, s, speed) = (size(random), size(random), speed(random));
    let (along, at) = (direction(random), random.uniform(0.1, 0.9));
    let aside = random.uniform(-1.3, 1.3) * (r + s);
    let before = speed * at;
    let place = [
        -before * along[0] - aside * along[1],
        -before * along[1] + aside * along[0],
    ];
    let velocity = along.map(|x| speed * x);
    // the force law must not act at either end of the run
    let clear = |t: f64| (speed * (t - at)).hypot(aside) > r + s;
    let [x, z] = place;
    let [u, w] = velocity;
    Case {
        parameters: vec![x, z, u, w, r, s, stiffness(speed, r.min(s))],
        free: velocity.to_vec(),
        scale: speed,
        met: match clear(0.0) && clear(1.0) {
            true => met(r + s - aside.abs(), r.min(s)),
            false => Met::Hardly,
        },
    }
}

const ELLIPSOIDS: &str = "
model: ellipsoids
dimension: 3
parameters: { x: -1 m, y: 0 m, z: 0 m, u: 1 m/s, v: 0 m/s, w: 0 m/s, a: 10 mm, b: 10 mm, c: 20 mm, k: 1 N/m }
curves: { line: { unit: [m, m], points: [[0, 0], [1, 1]], extrapolate: linear } }
systems:
  - name: ball
    elements: [{ name: body, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }]
    start: { position: [x, y, z], velocity: [u, v, w] }
  - name: target
    elements: [{ name: body, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }]
forces:
  - contact: hit
    ellipsoid: { on: ball/body, center: [0, 0, 0], semi_axes: [a, b, c] }
    with: { on: target/body, center: [0, 0, 0], semi_axes: [a, b, c] }
    elastic: { curve: line, times: k }
outputs:
  - { name: vx, of: ball/body, what: velocity, component: x }
  - { name: vy, of: ball/body, what: velocity, component: y }
  - { name: vz, of: ball/body, what: velocity, component: z }
run: { duration: 1 s, every: 0.1 s }
";

/// Two ellipsoids of the same axes that do not rotate touch when the centre of one is on an ellipsoid of twice the size
/// about the centre of the other.
fn ellipsoids(random: &mut Random) -> Case {
    let a = size(random);
    let axes = [
        a,
        a * random.uniform(0.3, 1.0),
        a * random.uniform(0.3, 1.0),
    ];
    let (speed, at) = (speed(random), random.uniform(0.1, 0.9));
    let mut along = [(); 3].map(|()| random.uniform(-1.0, 1.0));
    let norm = along.iter().map(|x| x * x).sum::<f64>().sqrt();
    along = along.map(|x| x / norm);
    let through = axes.map(|axis| 1.5 * axis * random.uniform(-1.0, 1.0));
    let start: Vec<f64> = (0..3).map(|i| through[i] - speed * at * along[i]).collect();
    // distance of the centres over its value at touch, in coordinates where this ellipsoid is a unit ball
    let (p, d): (Vec<f64>, Vec<f64>) = (0..3)
        .map(|i| (through[i] / (2.0 * axes[i]), along[i] / (2.0 * axes[i])))
        .unzip();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let distance = |far: f64| {
        let there: Vec<f64> = (0..3).map(|i| p[i] + far * d[i]).collect();
        dot(&there, &there).sqrt()
    };
    let ends = [0.0, 1.0].map(|t| speed * (t - at));
    let way = -dot(&p, &d) / dot(&d, &d);
    // the run may end before the closest approach, or begin after it
    let nearest = distance(way.clamp(ends[0], ends[1]));
    let least = axes[1].min(axes[2]);
    let velocity = along.map(|x| speed * x);
    let mut parameters = start;
    parameters.extend(velocity);
    parameters.extend(axes);
    parameters.push(stiffness(speed, least));
    Case {
        parameters,
        free: velocity.to_vec(),
        scale: speed,
        met: match ends.into_iter().all(|far| distance(far) > 1.0) {
            true => met(1.0 - nearest, 1.0),
            false => Met::Hardly,
        },
    }
}

const PLATES: &str = "
model: plates
dimension: 2
parameters: { x: -1 m, z: 0 m, u: 1 m/s, w: 0 m/s, r: 10 mm, e: 20 mm, k: 1 N/m }
curves: { line: { unit: [m, m], points: [[0, 0], [1, 1]], extrapolate: linear } }
systems:
  - name: ball
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { position: [x, z], velocity: [u, w] }
forces:
  - contact: shelf
    ellipsoid: { on: ball/body, center: [0, 0], semi_axes: [r, r] }
    plane: { on: frame, at: [0, 0], normal: [0, 1], extent: e }
    elastic: { curve: line, times: k }
outputs:
  - { name: vx, of: ball/body, what: velocity, component: x }
  - { name: vz, of: ball/body, what: velocity, component: z }
run: { duration: 1 s, every: 0.1 s }
";

/// A second plate, which forms a corner with the first.
const CORNERS: &str = "
  - contact: wall
    ellipsoid: { on: ball/body, center: [0, 0], semi_axes: [r, r] }
    plane: { on: frame, at: [e, 0], normal: [-1, 0], extent: e }
    elastic: { curve: line, times: k }
";

/// The times when a uniform motion enters and leaves the interval from `low` to `high`; `place` is its place at time 0.
fn while_between(place: f64, speed: f64, [low, high]: [f64; 2]) -> [f64; 2] {
    let times = [(low - place) / speed, (high - place) / speed];
    [times[0].min(times[1]), times[0].max(times[1])]
}

/// The largest depth of a ball in a plate along the `normal` of the plate, while the ball is between its edges.
/// Negative if the ball misses the plate. `None` if the plate acts at either end of the run, or if the contact is too
/// short or too weak to be clear.
fn depth(normal: [f64; 2], along: [f64; 2], r: f64, e: f64) -> Option<f64> {
    let [height, falls] = normal;
    let [from, to] = while_between(along[0], along[1], [-e, e]);
    let deep = |t: f64| r - (height + falls * t);
    let idle = |t: f64| t < from || to < t || deep(t) < 0.0;
    if !idle(0.0) || !idle(1.0) {
        return None;
    }
    let (from, to) = (from.max(0.0), to.min(1.0));
    if from >= to {
        return Some(f64::NEG_INFINITY);
    }
    let deepest = deep(from).max(deep(to));
    let long = (to - from) * along[1].abs().max(falls.abs()) > 0.02 * e.min(r);
    // near its edges the force of a plate fades; within half of that width it is less than half of the full force
    let inner = e - r.clamp(0.01, 1.0).min(e) / 2.0;
    let (from, to) = {
        let [from, to] = while_between(along[0], along[1], [-inner, inner]);
        (from.max(0.0), to.min(1.0))
    };
    let firm = from < to && deep(from).max(deep(to)) > deepest / 2.0;
    (deepest < 0.0 || long && firm).then_some(deepest)
}

fn plates(random: &mut Random, corner: bool) -> Case {
    let (r, e, speed) = (size(random), size(random), speed(random));
    let (along, at) = (direction(random), random.uniform(0.1, 0.9));
    let through = [
        random.uniform(-1.3, 1.3) * e,
        r + random.uniform(-0.8, 0.2) * r,
    ];
    let [u, w] = along.map(|x| speed * x);
    let [x, z] = [through[0] - u * at, through[1] - w * at];
    let depths = [
        depth([z, w], [x, u], r, e),
        depth([e - x, -u], [z, w], r, e),
    ];
    let depths = &depths[..if corner { 2 } else { 1 }];
    let deepest = depths
        .iter()
        .flatten()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    Case {
        parameters: vec![x, z, u, w, r, e, stiffness(speed, r.min(e))],
        free: vec![u, w],
        scale: speed,
        met: match depths.iter().any(Option::is_none) {
            true => Met::Hardly,
            false => met(deepest, r.min(e)),
        },
    }
}

const BELTS: &str = "
model: belts
dimension: 2
parameters: { z: 0 m, w: 1 m/s, gravity: 10 m/s^2, l: 1 m, f: 1 N }
curves: { line: { points: [[0, 0], [1, 1]], extrapolate: linear } }
systems:
  - name: ball
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { position: [0, z], velocity: [0, w] }
forces:
  - { field: gravity, acceleration: [0, -gravity] }
  - belt: leash
    from: { on: frame, at: [0, 0] }
    to: { on: ball/body, at: [0, 0] }
    length: l
    force: { curve: line, times: f }
outputs:
  - { name: z, of: ball/body, what: position, component: z }
run: { duration: 1 s, every: 0.1 s }
";

/// A mass on a belt is thrown up, and is back at the end of the run.
fn belts(random: &mut Random) -> Case {
    let w = speed(random);
    let (g, apex) = (2.0 * w, 0.25 * w);
    let l = apex / random.uniform(0.6, 1.5);
    let z = 0.1 * l;
    Case {
        parameters: vec![z, w, g, l, stiffness(w, l) * l],
        free: vec![z],
        scale: l,
        met: met(z + apex - l, l),
    }
}

const STOPS: &str = "
model: stops
dimension: 2
parameters: { rate: 1 rad/s, moment: -1 N*m, end: 1 rad, k: 1 N*m/rad }
systems:
  - name: wheel
    reference: fixed
    elements: [{ name: wheel, mass: 1 kg, cg: [0, 0], inertia: 1 kg*m^2 }]
    start: { rates: { wheel: rate } }
forces:
  - { joint: wheel/wheel, stop: { to: end, stiffness: k } }
  - { load: back, on: wheel/wheel, moment: moment }
outputs:
  - { name: angle, of: wheel/wheel, what: angle }
run: { duration: 1 s, every: 0.1 s }
";

fn stops(random: &mut Random) -> Case {
    let rate = speed(random);
    let apex = 0.25 * rate;
    let end = apex / random.uniform(0.6, 1.5);
    Case {
        parameters: vec![rate, -2.0 * rate, end, stiffness(rate, end)],
        free: vec![0.0],
        scale: end,
        met: met(apex - end, end),
    }
}

/// A function that makes a scene of a shape.
pub(super) type Make = fn(&mut Random) -> Case;

/// All shapes: name, model, and the function that makes a scene.
pub(super) fn all() -> Vec<(&'static str, String, Make)> {
    let corners = PLATES.replace("outputs:", &format!("{CORNERS}outputs:"));
    vec![
        ("balls", BALLS.to_owned(), balls),
        ("ellipsoids", ELLIPSOIDS.to_owned(), ellipsoids),
        ("plates", PLATES.to_owned(), |random| plates(random, false)),
        ("corners", corners, |random| plates(random, true)),
        ("belts", BELTS.to_owned(), belts),
        ("stops", STOPS.to_owned(), stops),
    ]
}
