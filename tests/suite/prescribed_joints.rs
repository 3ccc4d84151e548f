//! Prescribed reference joints and given loads.

use crate::motion::{close, run_with_bound};
use bryant_tests::models::{loads, prescribed};

/// Velocity and displacement at the end of a ramp of acceleration from a to b, of length h: exact, because the
/// acceleration is linear.
fn ramp([x, v]: [f64; 2], [a, b]: [f64; 2], h: f64) -> [f64; 2] {
    [
        x + v * h + (2.0 * a + b) * h * h / 6.0,
        v + (a + b) * h / 2.0,
    ]
}

/// Position and velocity at t from those at 0; the acceleration goes through points, and after the last point continues
/// with a slope. The first point is not after 0.
fn follow(start: [f64; 2], points: &[[f64; 2]], slope: f64, t: f64) -> [f64; 2] {
    let mut state = start;
    for pair in points.windows(2) {
        let [[t0, a0], [t1, a1]] = [pair[0], pair[1]];
        let (from, to) = (t0.max(0.0), t1.min(t));
        if from < to {
            let value = |t: f64| a0 + (a1 - a0) * (t - t0) / (t1 - t0);
            state = ramp(state, [value(from), value(to)], to - from);
        }
    }
    let [last, a] = points[points.len() - 1];
    if t > last {
        state = ramp(state, [a, a + slope * (t - last)], t - last);
    }
    state
}

#[test]
fn a_prescribed_joint_follows_its_integrated_acceleration() {
    let (motion, _) = run_with_bound::<prescribed::Mechanism<f64>>(0.05, 1.2);
    let push = [[0.0, 0.0], [0.2, 3.0], [0.5, -2.0], [0.9, 1.0]].map(|[t, a]| [t, 1.5 * a]);
    let lift = [[-1.0, 0.5], [0.3, 0.5], [0.6, -1.5], [0.7, 2.0]];
    let beyond = |t: f64, points: &[[f64; 2]], slope: f64| {
        let inside = points.windows(2).find(|p| p[0][0] <= t && t < p[1][0]);
        match inside {
            Some(p) => p[0][1] + (p[1][1] - p[0][1]) * (t - p[0][0]) / (p[1][0] - p[0][0]),
            None => points[points.len() - 1][1] + slope * (t - points[points.len() - 1][0]),
        }
    };
    for (t, outputs) in motion.times.iter().zip(&motion.outputs) {
        let [x, vx] = follow([0.3, 1.2], &push, 0.0, *t);
        let [z, vz] = follow([2.0, -0.4], &lift, 35.0, *t);
        let (ax, az) = (beyond(*t, &push, 0.0), beyond(*t, &lift, 35.0));
        // nothing is integrated numerically: a dozen roundings of numbers below 10
        for (ours, expected) in outputs.iter().zip([x, z, vx, vz, ax, az]) {
            let error = (ours - expected).abs();
            assert!(
                error <= 12.0 * 10.0 * f64::EPSILON,
                "at {t} s: {ours} instead of {expected}"
            );
        }
    }
}

#[test]
fn a_moving_joint_is_a_field_seen_from_it() {
    let (motion, bounds) = run_with_bound::<prescribed::Mechanism<f64>>(0.05, 1.2);
    for (k, t) in motion.times.iter().enumerate() {
        let (q, v) = motion.states[k].split_at(4);
        for (seen, values) in [("angle", q), ("rate", v)] {
            let (road, trolley) = values.split_at(2);
            for (road, trolley) in road.iter().zip(trolley) {
                // both are computed
                close(seen, *t, *road, *trolley, 2.0 * bounds[k]);
            }
        }
        // The place of observation does not affect an instrument; accelerations change with the state by ω² and g.
        let [road, trolley] = [motion.outputs[k][6], motion.outputs[k][7]];
        let size = motion.states[k].iter().fold(10.0f64, |m, x| m.max(x * x));
        close("accelerometer", *t, road, trolley, size * 2.0 * bounds[k]);
    }
    let moved = motion.states[motion.states.len() - 1][0] - motion.states[0][0];
    assert!(moved.abs() > 0.1, "nothing moved");
}

#[test]
fn a_load_at_the_centre_of_gravity_is_a_field() {
    let (motion, bounds) = run_with_bound::<loads::Mechanism<f64>>(0.1, 1.2);
    for (k, t) in motion.times.iter().enumerate() {
        // reference joint and two quaternions each, then those of the wheel; the same for velocities
        let (q, v) = motion.states[k].split_at(11 + 11 + 4);
        for (what, values, length) in [("coordinate", q, 11), ("velocity", v, 9)] {
            let (field, load) = (&values[..length], &values[length..2 * length]);
            for (field, load) in field.iter().zip(load) {
                close(what, *t, *load, *field, 2.0 * bounds[k]);
            }
        }
        // ω̇ = M/I, from 1 rad/s
        let omega = 1.0 + 0.75 / 0.5 * t;
        close("wheel", *t, motion.outputs[k][0], omega, bounds[k]);
    }
    let moved = motion.states[motion.states.len() - 1][0];
    assert!(moved.abs() > 0.1, "nothing moved");
}
