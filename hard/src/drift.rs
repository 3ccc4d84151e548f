//! The drift of energy in systems without losses, and how it decreases with the step.

use crate::balance::Tree;
use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::chain::{Link, afloat, general};
use crate::jobs::many;
use crate::random::Random;
use crate::scene;
use bryant_runtime::{DoubleDouble, Formula, Real};

/// The cases of this file.
pub const CASES: &[Case] = &[
    Case {
        group: Group::Length,
        name: "slope of the energy drift over a million steps",
        law: "On ẍ = −x a Runge–Kutta or Rosenbrock method of order p multiplies the energy by |R(ih)|² in each step, \
              R(z) = eᶻ (1 + C z^(p+1) + …), and so by 1 + O(h^(p+1)) where p is odd; where p is even the term of that power is \
              imaginary, and h^(p+2) remains. Half a step is a slope of the energy that is 2^p or 2^(p+1) times less (Hairer & \
              Wanner II, IV.2).",
        run: oscillator,
    },
    Case {
        group: Group::Length,
        name: "energy of a double pendulum",
        law: "Without losses the energy is constant, except for the error of the method. In a given time this error is O(h^p): with half \
              the step it is 2^p times smaller. The semi-implicit method is symplectic: its error oscillates and does not grow (Hairer, \
              Lubich & Wanner, IX.8).",
        run: double_pendulum,
    },
    Case {
        group: Group::Length,
        name: "momentum of free flight",
        law: "No force acts on a chain of ten general bodies that tumble about each other. So its linear momentum, and its angular \
              momentum about the origin, are constant. They are the components of S v along the rigid motions of the whole chain, with S \
              by d'Alembert's principle.",
        run: free_flight,
    },
];

/// A method, its order, and a step for ẍ = −x. The step is so small that the first term of the drift dominates, and so
/// large that after a million steps the drift is far above rounding.
const STEPS: [(Formula, i32, f64); 7] = [
    (Formula::Heun, 2, 0.02),
    (Formula::Rk4, 4, 0.1),
    (Formula::Merson, 4, 0.1),
    (Formula::Dopri5, 5, 0.1),
    (Formula::Tsit5, 5, 0.1),
    (Formula::Dop853, 8, 0.4),
    (Formula::Rodas5, 5, 0.1),
];

fn oscillator(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("oscillator");
    let energy = |state: &[f64]| 0.5 * (state[0] * state[0] + state[1] * state[1]);
    for (formula, order, h) in STEPS {
        // the drift of Heun's method is larger, so fewer steps suffice
        let steps = if formula == Formula::Heun { 1e5 } else { 1e6 };
        bench.variant(format!("{} at h = {h} and {}", formula.name(), h / 2.0));
        let mut slopes = [0.0; 2];
        for (slope, h) in slopes.iter_mut().zip([h, h / 2.0]) {
            let run = bench.succeed(&scene, &many(formula, h, steps, 10.0))?;
            *slope = (energy(run.last()?) / 0.5).ln() / (h * steps);
        }
        let power = if order % 2 == 0 { order + 1 } else { order };
        let seen = (slopes[0] / slopes[1]).log2();
        bench.at_least(
            format!("power of h that the slope, {:.1e}/s, falls with", slopes[0]),
            seen,
            f64::from(power) - 0.25,
            "",
            format!(
                "{power} by the order, more if further terms cancel; less a quarter, because the next term is smaller by h²"
            ),
        );
    }
    Ok(())
}

/// The energy of the scene at the state φ₁, φ₂, ω₁, ω₂; heights are relative to the pivot.
fn energy(state: &[f64]) -> f64 {
    let &[first, second, w1, w2] = state else {
        return f64::NAN;
    };
    let (mass, length, half, inertia, g) = (1.0, 1.0, 0.5, 0.08, 9.81);
    let own = inertia + mass * half * half;
    let kinetic = 0.5 * (own + mass * length * length) * w1 * w1
        + 0.5 * own * w2 * w2
        + mass * length * half * w1 * w2 * (first - second).cos();
    let depth = (half + length) * first.cos() + half * second.cos();
    kinetic - mass * g * depth
}

/// A method, its order, and a step for a double pendulum whose fastest swing takes about a second.
const SWINGS: [(Formula, i32, f64); 8] = [
    (Formula::SemiImplicitEuler, 1, 0.002),
    (Formula::Heun, 2, 0.002),
    (Formula::Rk4, 4, 0.01),
    (Formula::Merson, 4, 0.01),
    (Formula::Dopri5, 5, 0.02),
    (Formula::Tsit5, 5, 0.02),
    (Formula::Dop853, 8, 0.05),
    (Formula::Rodas5, 5, 0.01),
];

fn double_pendulum(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("double-pendulum");
    let seconds = if bench.full() { 1000.0 } else { 40.0 };
    for (formula, order, h) in SWINGS {
        bench.variant(format!("{} at h = {h} and {}", formula.name(), h / 2.0));
        // samples are a whole number of steps apart, and at the same times in both runs; other steps would be shortened
        let samples = (seconds / h / 10.0).round();
        let worst = |parts: f64| -> Result<f64, Trouble> {
            let job = many(formula, h / parts, 10.0 * samples * parts, samples);
            let run = bench.succeed(&scene, &job)?;
            let first = run.states.first().map_or(f64::NAN, |state| energy(state));
            let away = run.states.iter().map(|state| (energy(state) - first).abs());
            Ok(away.fold(0.0, |worst, e| if e <= worst { worst } else { e }))
        };
        let (whole, half) = (worst(1.0)?, worst(2.0)?);
        bench.at_least(
            format!("power of h that the largest change, {whole:.1e} J, falls with"),
            (whole / half).log2(),
            f64::from(order) - 0.5,
            "",
            format!("order {order}, less a half for the terms that are h times as large"),
        );
    }
    Ok(())
}

fn free_flight(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let mut random = Random::new(5);
    let links: Vec<Link> = (0..10)
        .map(|_| {
            let mass = random.uniform(0.5, 5.0);
            general(&mut random, mass)
        })
        .collect();
    let rates: Vec<[f64; 3]> = links.iter().map(|_| random.vector(2.0)).collect();
    let scene = afloat(&links, &rates);
    let model = scene
        .model()
        .map_err(|problems| Trouble::Refused(problems.to_string()))?;
    let tree = Tree::of(&model)?;
    let coordinates = 3 + 4 * links.len();
    let momentum = |state: &[f64]| {
        let numbers = |part: &[f64]| -> Vec<DoubleDouble> {
            part.iter().map(|&value| Real::from_f64(value)).collect()
        };
        let (q, v) = state.split_at(coordinates);
        let [momentum, size] = tree.posture(&numbers(q)).momentum(&numbers(v));
        let [mut momentum, mut size] = [momentum, size].map(|six| six.map(Real::to_f64));
        // angular momentum about the origin instead of the reference joint: L + x × P
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            momentum[3 + i] += q[j] * momentum[k] - q[k] * momentum[j];
            size[3 + i] += q[j].abs() * size[k] + q[k].abs() * size[j];
        }
        (momentum, size)
    };
    let steps = if bench.full() { 1e6 } else { 2e4 };
    let h = 0.001;
    bench.variant(format!("dop853, {steps:.0e} steps of {h} s"));
    let run = bench.succeed(&scene, &many(Formula::Dop853, h, steps, 20.0))?;
    let (first, _) = momentum(run.states.first().map_or(&[][..], Vec::as_slice));
    let mut worst = [0.0f64; 2];
    for state in &run.states {
        let (now, size) = momentum(state);
        for i in 0..6 {
            let away = (now[i] - first[i]).abs() / size[i];
            let worst = &mut worst[i / 3];
            *worst = if away <= *worst { *worst } else { away };
        }
    }
    for (name, worst) in ["linear", "angular"].into_iter().zip(worst) {
        bench.at_most(
            format!("change of the {name} momentum over the sum of its terms"),
            worst,
            8.0 * steps * f64::EPSILON,
            "",
            "8 ε for each step, in which v is rounded once, and so are the four numbers of a rotation; errors of the method, \
             (2 rad/s · h)⁹, are far below",
        );
    }
    Ok(())
}
