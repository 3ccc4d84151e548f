//! Finds the fastest motion of a scene, and the force that causes it. This motion limits the steps of explicit methods,
//! however small the requested accuracy is.
//!
//! ẏ = f(t, y) is linearised at some states of a run. A vector is repeatedly multiplied by ∂f/∂y: the geometric mean of
//! its growth is the largest |λ|, also for an oscillation, and the vector tends to the motion x of this eigenvalue.
//! Along x the power of each effect (force times velocity) is curved: P(y + εx) − 2 P(y) + P(y − εx) is 2 ε² times the
//! change of the force with the velocity. The effect with the largest such curvature causes the motion.

use super::setting::{Pace, Setting, time, two_digits};
use crate::equations::Engine;
use bryant_runtime::program::{Job, Scalar};
use bryant_runtime::{Adjustable, Formula};
use std::ops::ControlFlow;
use std::time::Duration;

/// The fastest motion that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Fastest {
    /// |λ| \[1/s\].
    pub rate: f64,
    /// The time at which it occurs \[s\].
    pub t: f64,
    /// The velocity that changes most in this motion.
    pub velocity: String,
    /// The effect that causes it; `None` if the power of no effect is curved.
    pub effect: Option<String>,
}

/// About the number of states of a run that are kept; every `EACH`-th and the last `LAST` of them are examined.
const STATES: f64 = 240.0;
const EACH: usize = 10;
const LAST: usize = 3;
/// Number of products with the linearisation, and number of the first ones that are ignored.
const PRODUCTS: usize = 300;
const FORGOTTEN: usize = 100;
/// The change of the largest velocity by which the curvature of powers is measured \[m/s, rad/s\].
const MOVED: f64 = 1e-3;

/// The fastest motion of a run of a job, with these values of all parameters. Only the part of the run that is computed
/// within `patience` \[s\] is examined. `None` if nothing moves.
pub fn fastest(engine: &Engine, job: &Job, parameters: &[f64], patience: f64) -> Option<Fastest> {
    let info = engine.info();
    let duration = job.duration.unwrap_or(info.duration);
    let setting = Setting {
        formula: Formula::Dopri5,
        switches: false,
        pace: Pace::Tolerance(1e-5),
        scalar: Scalar::F64,
        locate: false,
    };
    let job = Job {
        every: Some(duration / STATES),
        time_limit: Some(Duration::from_secs_f64(patience)),
        ..setting.job(job)
    };
    let mut states = Vec::new();
    // if the run fails or its time is over, the states so far are examined
    let mut keep = |t: f64, y: &[f64], _: &[f64]| {
        states.push((t, y.to_vec()));
        ControlFlow::Continue(())
    };
    let _ = engine.run(&job, &mut keep, &mut |_| ControlFlow::Continue(()));
    let late = states.len().saturating_sub(LAST);
    let states = states.iter().enumerate();
    let states = states.filter(|(index, _)| index.is_multiple_of(EACH) || *index >= late);
    let mut model = engine.in_double();
    model.set_parameters(parameters);
    let motions = states.filter_map(|(_, (t, y))| {
        let (rate, x) = motion(&*model, *t, y)?;
        Some((rate, *t, y, x))
    });
    let (rate, t, y, x) = motions.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let first = info.coordinates.len();
    let velocities = first..first + info.velocities.len();
    let most = velocities.max_by(|&a, &b| x[a].abs().total_cmp(&x[b].abs()))?;
    Some(Fastest {
        rate,
        t,
        velocity: info.state_name(most)?.to_owned(),
        effect: effect(&*model, t, y, &x, MOVED / x[most].abs()),
    })
}

/// The largest |λ| at a state, and its motion; `None` if nothing changes, or there is no Jacobian.
fn motion(model: &dyn Adjustable<f64>, t: f64, y: &[f64]) -> Option<(f64, Vec<f64>)> {
    let n = y.len();
    let (mut matrix, mut by_time) = (vec![0.0; n * n], vec![0.0; n]);
    if !model.jacobian(t, y, &mut matrix, &mut by_time) {
        return None;
    }
    // all entries differ from 0, and from their neighbours
    let mut x: Vec<f64> = (0..n).map(|i| 1.0 + 0.1 * (i % 7) as f64).collect();
    let mut growth = 0.0;
    for k in 0..PRODUCTS {
        let rows = matrix.chunks_exact(n);
        let product: Vec<f64> = rows
            .map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum())
            .collect();
        let size = product.iter().map(|x| x * x).sum::<f64>().sqrt();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        // the growth of the first vectors is ignored, because they have not converged
        if k >= FORGOTTEN {
            growth += libm::log(size);
        }
        x = product.iter().map(|x| x / size).collect();
    }
    Some((libm::exp(growth / (PRODUCTS - FORGOTTEN) as f64), x))
}

/// The effect whose power has the largest curvature along a motion.
fn effect(model: &dyn Adjustable<f64>, t: f64, y: &[f64], x: &[f64], moved: f64) -> Option<String> {
    let names = model.info().powers;
    let powers = |by: f64| {
        let y: Vec<f64> = y.iter().zip(x).map(|(y, x)| y + by * x).collect();
        let mut powers = vec![0.0; names.len()];
        model.powers(t, &y, &mut powers);
        powers
    };
    let [before, here, after] = [-moved, 0.0, moved].map(powers);
    let bent = |i: usize| (before[i] - 2.0 * here[i] + after[i]).abs();
    let most = (0..names.len()).max_by(|&a, &b| bent(a).total_cmp(&bent(b)))?;
    (bent(most) > 0.0).then(|| names[most].to_string())
}

impl Fastest {
    /// A sentence: "the fastest motion reaches about 15000 1/s, at t = 45 ms, most in "man/neck.omega", by "joint
    /// man/neck: friction""
    pub fn text(&self) -> String {
        let by = match &self.effect {
            Some(effect) => format!(", by \"{effect}\""),
            None => String::new(),
        };
        format!(
            "the fastest motion reaches about {:.0} 1/s, at t = {}, most in \"{}\"{by}",
            two_digits(self.rate),
            time(two_digits(self.t)),
            self.velocity
        )
    }
}
