//! Random chains of sliders whose time scales differ by up to a factor of 10⁹, compared with an implicit method that is
//! written here for this purpose.
//!
//! Masses m_i move on a line. Joint i connects mass i to mass i − 1, or to the frame for i = 0, with the force
//!
//! f_i = P_i − k_i q_i − c_i q'_i − F_i clamp(q'_i/v_i, −1, 1),   m_i x''_i = f_i − f_{i+1},   x_i = q_0 + … + q_i
//!
//! The reference is the Radau IIA method of order 5 (Hairer & Wanner, *Solving ODEs II*, IV.8). Newton's iteration
//! solves all stages at once, and steps are chosen by comparison with two steps of half the length. It shares no code
//! with the program.

use crate::bench::{Bench, Run, Trouble};
use crate::case::{Case, Group};
use crate::case_model::CaseModel;
use crate::random::Random;
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Integrator, Tolerances};
use std::fmt::Write;

/// The case of this file.
pub const CASES: &[Case] = &[Case {
    group: Group::Stiffness,
    name: "random chains with time scales from 1 s to 1 ns",
    law: "Springs, dampers and friction on masses from 1 mg to 1 t: the motion is that of a Radau IIA method of order 5, computed apart.",
    run: chains,
}];

/// Number of scenes.
const SCENES: u64 = 300;
/// Length of each run and time between samples \[s\].
const DURATION: f64 = 1.0;
const EVERY: f64 = 0.01;
/// Relative error that is allowed in a step of the reference.
const SHARP: f64 = 1e-8;

/// The error that a run promises for its outputs, as a share of their largest value.
const PROMISED: f64 = 1e-3;

/// Least speed of full friction \[m/s\]: ten times the error of a speed that the tolerances allow. Below it, an allowed
/// error could make a creeping body slide, and an explicit method would pass this kink again and again.
const CREEP: f64 = 1e-6;

/// A joint of a chain, and the mass that it carries \[SI\].
#[derive(Clone, Copy, Debug)]
struct Joint {
    mass: f64,
    stiffness: f64,
    damping: f64,
    friction: f64,
    friction_speed: f64,
    load: f64,
}

/// The coordinates of all joints, then their speeds.
type State = Vec<f64>;

fn joints(random: &mut Random) -> Vec<Joint> {
    let count = 2 + random.below(2);
    let mut before = f64::INFINITY;
    (0..count)
        .map(|i| {
            let mass = 10f64.powf(random.uniform(-6.0, 3.0));
            // the lighter of the two masses at this joint sets its fastest rate
            let lighter = mass.min(before);
            before = mass;
            let slow = random.uniform(0.5, 5.0);
            let rate = match i {
                0 => slow,
                _ => 10f64.powf(random.uniform(0.0, 9.0)),
            };
            let load = lighter.min(mass) * random.uniform(-10.0, 10.0);
            let least = if rate > 1e3 { 0.3 } else { 0.0 };
            let ratio = random.uniform(least, 1.5);
            let soft = Joint {
                mass,
                stiffness: lighter * slow * slow,
                damping: 0.0,
                friction: 0.0,
                friction_speed: 1.0,
                load,
            };
            match random.below(3) {
                _ if i == 0 => Joint {
                    damping: 2.0 * ratio * lighter * slow,
                    ..soft
                },
                0 => Joint {
                    stiffness: lighter * rate * rate,
                    damping: 2.0 * ratio * lighter * rate,
                    ..soft
                },
                1 => Joint {
                    damping: lighter * rate,
                    ..soft
                },
                _ => {
                    let friction = lighter * random.uniform(0.1, 10.0);
                    Joint {
                        friction,
                        friction_speed: (friction / (lighter * rate)).max(CREEP),
                        ..soft
                    }
                }
            }
        })
        .collect()
}

/// The text of a chain. Stiffnesses are numbers instead of curves: a curve through points at ±1 m rounds its argument
/// to 10⁻¹⁶ m, so a spring of 10¹⁷ N/m would jump by 10 N, more than the load.
fn scene(name: &str, joints: &[Joint]) -> CaseModel {
    let mut elements = String::new();
    let mut forces = String::new();
    let mut outputs = String::new();
    for (i, joint) in joints.iter().enumerate() {
        let on = if i == 0 {
            String::new()
        } else {
            format!("on: e{}, at: [0, 0], ", i - 1)
        };
        let Joint {
            mass,
            stiffness,
            damping,
            friction,
            friction_speed,
            load,
        } = *joint;
        let _ = writeln!(
            elements,
            "      - {{ name: e{i}, {on}joint: {{ slider: x }}, mass: {mass:e}, cg: [0, 0], inertia: {mass:e} }}"
        );
        let _ = write!(
            forces,
            "  - {{ joint: c/e{i}, motor: {load:e}, stiffness: {stiffness:e}"
        );
        if damping > 0.0 {
            let _ = write!(forces, ", damping: {damping:e}");
        }
        if friction > 0.0 {
            let _ = write!(
                forces,
                ", friction: {friction:e}, friction_speed: {friction_speed:e}"
            );
        }
        forces.push_str(" }\n");
        let _ = writeln!(
            outputs,
            "  - {{ name: a{i}, of: c/e{i}, what: acceleration, component: x }}"
        );
    }
    CaseModel::new(
        name,
        format!(
            "model: chain\ndimension: 2\nsystems:\n  - name: c\n    reference: fixed\n    elements:\n{elements}forces:\n{forces}outputs:\n{outputs}\
             run: {{ duration: {DURATION} s, every: {EVERY} s }}\n"
        ),
    )
}

/// The derivative of a state with respect to time.
fn rate(joints: &[Joint], y: &[f64]) -> State {
    let n = joints.len();
    let forces: Vec<f64> = (0..n)
        .map(|i| {
            let joint = &joints[i];
            let (q, v) = (y[i], y[n + i]);
            let slip = (v / joint.friction_speed).clamp(-1.0, 1.0);
            joint.load - joint.stiffness * q - joint.damping * v - joint.friction * slip
        })
        .collect();
    let mut rate = y[n..].to_vec();
    rate.extend((0..n).map(|i| absolute(joints, &forces, i) - before(joints, &forces, i)));
    rate
}

/// The absolute acceleration of mass `i`.
fn absolute(joints: &[Joint], forces: &[f64], i: usize) -> f64 {
    (forces[i] - forces.get(i + 1).copied().unwrap_or(0.0)) / joints[i].mass
}

/// The absolute acceleration of the mass before mass `i`; 0 for the frame.
fn before(joints: &[Joint], forces: &[f64], i: usize) -> f64 {
    if i == 0 {
        0.0
    } else {
        absolute(joints, forces, i - 1)
    }
}

/// The derivative of [`rate`] with respect to the state, by columns: the rates of a unit change of each entry, because
/// [`rate`] is linear except for the clamp.
fn jacobian(joints: &[Joint], y: &[f64]) -> Vec<State> {
    let n = joints.len();
    (0..2 * n)
        .map(|column| {
            let mut forces = vec![0.0; n];
            let mut of = vec![0.0; 2 * n];
            if column < n {
                forces[column] = -joints[column].stiffness;
            } else {
                let i = column - n;
                of[i] = 1.0;
                let joint = &joints[i];
                let slips = y[column].abs() >= joint.friction_speed;
                let viscous = if slips {
                    0.0
                } else {
                    joint.friction / joint.friction_speed
                };
                forces[i] = -joint.damping - viscous;
            }
            for i in 0..n {
                of[n + i] = absolute(joints, &forces, i) - before(joints, &forces, i);
            }
            of
        })
        .collect()
}

/// The coefficients a_ij of the Radau IIA method with three stages.
fn radau() -> [[f64; 3]; 3] {
    let s = 6f64.sqrt();
    [
        [
            (88.0 - 7.0 * s) / 360.0,
            (296.0 - 169.0 * s) / 1800.0,
            (-2.0 + 3.0 * s) / 225.0,
        ],
        [
            (296.0 + 169.0 * s) / 1800.0,
            (88.0 + 7.0 * s) / 360.0,
            (-2.0 - 3.0 * s) / 225.0,
        ],
        [(16.0 - s) / 36.0, (16.0 + s) / 36.0, 1.0 / 9.0],
    ]
}

/// The states at all stages of a step of the reference; the last stage is the end of the step. `None` if Newton's
/// iteration does not converge.
fn step(joints: &[Joint], y: &[f64], h: f64) -> Option<[State; 3]> {
    let (a, n) = (radau(), y.len());
    let mut stages = vec![y.to_vec(); 3];
    for _ in 0..12 {
        let rates: Vec<State> = stages.iter().map(|stage| rate(joints, stage)).collect();
        let slopes: Vec<Vec<State>> = stages.iter().map(|stage| jacobian(joints, stage)).collect();
        let size = 3 * n;
        let mut matrix = vec![vec![0.0; size + 1]; size];
        for (i, row) in a.iter().enumerate() {
            for k in 0..n {
                let line = &mut matrix[i * n + k];
                let mut residual = stages[i][k] - y[k];
                for (j, weight) in row.iter().enumerate() {
                    residual -= h * weight * rates[j][k];
                    for (l, column) in slopes[j].iter().enumerate() {
                        line[j * n + l] -= h * weight * column[k];
                    }
                }
                line[i * n + k] += 1.0;
                line[size] = -residual;
            }
        }
        let change = solve(matrix)?;
        let mut moved = 0.0f64;
        for (k, change) in change.iter().enumerate() {
            stages[k / n][k % n] += change;
            let scale = y[k % n].abs() + stages[k / n][k % n].abs();
            moved = moved.max(change.abs() / (1e-13 * scale + 1e-18));
        }
        if moved <= 1.0 {
            return stages.try_into().ok();
        }
    }
    None
}

/// Time of the first stage as a share of the step, (4 − √6)/10.
const FIRST: f64 = 0.155_051_025_721_682_2;

/// Bound of the error of the rates between the begin of a step and its first stage, whose state is `first`. If friction
/// changes between sliding and sticking in this interval, no stage sees the force at the begin. As this holds for the
/// whole step and for its halves, their comparison does not show the error.
fn unseen(joints: &[Joint], y: &[f64], first: &[f64]) -> State {
    let n = joints.len();
    let forces: Vec<f64> = (0..n)
        .map(|i| {
            let Joint {
                friction,
                friction_speed,
                ..
            } = joints[i];
            let [one, other] = [y, first].map(|y| y[n + i] / friction_speed);
            let side = |slip: f64| i32::from(slip > 1.0) - i32::from(slip < -1.0);
            match side(one) == side(other) {
                true => 0.0,
                false => friction * (one.clamp(-1.0, 1.0) - other.clamp(-1.0, 1.0)),
            }
        })
        .collect();
    let mut unseen = vec![0.0; 2 * n];
    for i in 0..n {
        unseen[n + i] = (absolute(joints, &forces, i) - before(joints, &forces, i)).abs();
    }
    unseen
}

/// Solves a linear system by elimination with pivoting; each row ends with its right-hand side, and is scaled by its
/// largest coefficient.
fn solve(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = rows.len();
    for row in &mut rows {
        let largest = row[..n].iter().fold(0.0f64, |m, x| m.max(x.abs()));
        row.iter_mut().for_each(|x| *x /= largest);
    }
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        rows.swap(k, pivot);
        let (above, below) = rows.split_at_mut(k + 1);
        for row in below {
            let factor = row[k] / above[k][k];
            if factor != 0.0 {
                for (x, p) in row[k..].iter_mut().zip(&above[k][k..]) {
                    *x -= factor * p;
                }
            }
        }
    }
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|j| rows[k][j] * rows[j][n]).sum();
        rows[k][n] = (rows[k][n] - sum) / rows[k][k];
    }
    let x: Vec<f64> = rows.iter().map(|row| row[n]).collect();
    x.iter().all(|x| x.is_finite()).then_some(x)
}

/// The states of the reference at the samples, and the largest acceleration of any joint at the end of any step. `None`
/// if steps become too short.
fn reference(joints: &[Joint]) -> Option<(Vec<State>, f64)> {
    let n = joints.len();
    let mut y = vec![0.0; 2 * n];
    let mut largest_of = vec![0.0f64; 2 * n];
    let accelerations = |y: &[f64]| {
        rate(joints, y)[n..]
            .iter()
            .fold(0.0f64, |m, a| m.max(a.abs()))
    };
    let mut largest = accelerations(&y);
    let (mut all, mut t, mut h) = (vec![y.clone()], 0.0, 1e-12);
    for sample in 1..=(DURATION / EVERY).round() as usize {
        let end = sample as f64 * EVERY;
        while t < end {
            let last = t + 1.01 * h >= end;
            let length = if last { end - t } else { h };
            let whole = step(joints, &y, length);
            let half = step(joints, &y, 0.5 * length);
            let halves = half
                .as_ref()
                .and_then(|[.., half]| step(joints, half, 0.5 * length));
            let error = match (&whole, &half, &halves) {
                (Some([.., whole]), Some([first, ..]), Some([.., halves])) => {
                    let scale = |k: usize| SHARP * largest_of[k].max(halves[k].abs()) + 1e-24;
                    let unseen = unseen(joints, &y, first);
                    (0..2 * n).fold(0.0f64, |m, k| {
                        let apart = (whole[k] - halves[k]).abs();
                        m.max(apart.max(0.5 * length * FIRST * unseen[k]) / scale(k))
                    })
                }
                _ => f64::INFINITY,
            };
            let factor = (0.8 * error.max(1e-9).powf(-0.2)).clamp(0.2, 5.0);
            if error <= 1.0 {
                [.., y] = halves?;
                t = if last { end } else { t + length };
                for (largest, entry) in largest_of.iter_mut().zip(&y) {
                    *largest = largest.max(entry.abs());
                }
                largest = largest.max(accelerations(&y));
                h = if last {
                    h.max(length * factor)
                } else {
                    length * factor
                };
            } else {
                h = length * factor;
                if h < 1e-20 {
                    return None;
                }
            }
        }
        all.push(y.clone());
    }
    Some((all, largest))
}

/// The largest errors of a run: coordinates \[m\]; speeds \[m/s\]; accelerations as a share of the largest
/// acceleration.
fn errors(
    run: &Run,
    joints: &[Joint],
    (states, largest): &(Vec<State>, f64),
) -> Result<[f64; 3], Trouble> {
    let n = joints.len();
    let mut worst = [0.0f64; 3];
    if run.states.len() != states.len() {
        return Err(Trouble::Case("samples are missing".into()));
    }
    for (found, exact) in run.states.iter().zip(states) {
        for k in 0..2 * n {
            let of = &mut worst[k / n];
            *of = of.max((found[k] - exact[k]).abs());
        }
        // accelerations are computed by the force laws of this file, from the state of the run
        let [found, exact] = [found, exact].map(|y| rate(joints, y));
        for k in n..2 * n {
            worst[2] = worst[2].max((found[k] - exact[k]).abs() / largest);
        }
    }
    Ok(worst)
}

/// Repeats a run as the command does to keep its promise for outputs: the tolerance is divided by ten until two
/// successive runs agree within `PROMISED`. Returns whether more than the first comparison was needed, and the run that
/// is delivered.
///
/// At the default tolerances a step has an error of 10⁻⁷ m/s in a speed, so the acceleration of an oscillation of
/// frequency ω has an error of ω 10⁻⁷ m/s. In a chain with small loads this exceeds the promise.
fn promised(
    bench: &Bench<'_>,
    scene: &CaseModel,
    joints: &[Joint],
    first: &Run,
) -> Result<(bool, Run), Trouble> {
    let n = joints.len();
    let accelerations = |run: &Run| -> Vec<State> {
        let of = |y: &State| rate(joints, y)[n..].to_vec();
        run.states.iter().map(of).collect()
    };
    let mut sharp = first.clone();
    for times in 1..=6 {
        let tolerances = Tolerances::of(Tolerances::default().relative / 10f64.powi(times));
        let job = Job {
            method: Some(Integrator::switching(Formula::Tsit5, tolerances)),
            ..Job::default()
        };
        let next = bench.succeed(scene, &job)?;
        let [one, other] = [&sharp, &next].map(accelerations);
        let (one, other) = (one.iter().flatten(), other.iter().flatten());
        let largest = other.clone().fold(0.0f64, |m, a| m.max(a.abs()));
        let apart = one
            .zip(other)
            .fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        if apart <= PROMISED * largest {
            return Ok((times > 1, sharp));
        }
        sharp = next;
    }
    Err(Trouble::Case("no two runs agree".into()))
}

fn chains(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let (mut worst, mut which, mut most) = ([0.0f64; 3], [0; 3], 0.0f64);
    let (mut switched, mut often) = (0, 0);
    let scenes = if bench.full() { SCENES } else { SCENES / 5 };
    for seed in 0..scenes {
        let joints = joints(&mut Random::new(seed));
        let scene = scene(&format!("chain-{seed}"), &joints);
        let run = bench.succeed(&scene, &Job::default())?;
        let report = run.report()?;
        switched += u64::from(report.stiff > 0);
        let (sharpened, delivered) = promised(bench, &scene, &joints, &run)?;
        often += u64::from(sharpened);
        let steps = (report.steps + report.rejected) as f64;
        most = most.max(steps);
        let speed = run
            .states
            .iter()
            .flat_map(|y| &y[joints.len()..2 * joints.len()]);
        let speed = speed.fold(0.0f64, |m, v| m.max(v.abs()));
        // a step has errors of 1e-8 m and 1e-7 (1 + v); motions are damped or oscillate, so that errors are not
        // amplified within the second
        let allowed = steps * (1e-8 + 1e-7 * (1.0 + speed));
        let exact = reference(&joints)
            .ok_or_else(|| Trouble::Case("the reference does not come to its end".into()))?;
        let found = errors(&run, &joints, &exact)?;
        let promised = errors(&delivered, &joints, &exact)?[2];
        let found = [found[0] / allowed, found[1] / (5.0 * allowed), promised];
        for k in 0..3 {
            if found[k] > worst[k] || found[k].is_nan() {
                (worst[k], which[k]) = (found[k], seed);
            }
        }
    }
    bench.variant(format!(
        "{scenes} chains ({switched} change the method, {often} are sharpened)"
    ));
    let because = "steps × (a_x + (r v + a_v) × 1 s), for a motion that does not amplify errors";
    bench.at_most(
        format!(
            "error of coordinates over what is allowed, in chain {}",
            which[0]
        ),
        worst[0],
        1.0,
        "",
        because,
    );
    bench.at_most(
        format!(
            "error of speeds over what is allowed, in chain {}",
            which[1]
        ),
        worst[1],
        1.0,
        "",
        "the same times 5 1/s, the fastest of the slow motions",
    );
    bench.at_most(
        format!(
            "error of accelerations over the largest, in chain {}",
            which[2]
        ),
        worst[2],
        PROMISED,
        "",
        "what a run promises of its outputs",
    );
    bench.at_most(
        "steps of a chain",
        most,
        2e5,
        "",
        "a thousand oscillations of 1e3 1/s, and what each layer takes",
    );
    Ok(())
}
