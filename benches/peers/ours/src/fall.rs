//! The whole fall from one state, and the formulas of its steps.

use crate::{Result, time};
use bryant_runtime::integrate::{march, march_adams, march_dop853};
use bryant_runtime::simulate::simulate_from;
use bryant_runtime::{Formula, Integrator, Model, Real, Settings};
use std::ops::ControlFlow;

/// The formula of a step.
#[derive(Clone, Copy)]
pub enum StepFormula {
    /// Runge–Kutta 4.
    Rk4,
    /// Dormand–Prince 8(5,3).
    Dop853,
    /// Adams–Bashforth 6.
    Adams,
}

impl StepFormula {
    pub fn named(name: &str) -> Result<StepFormula> {
        match name {
            "rk4" => Ok(StepFormula::Rk4),
            "dop853" => Ok(StepFormula::Dop853),
            "adams" => Ok(StepFormula::Adams),
            _ => Err(format!("a fall is by rk4, dop853 or adams, not by {name:?}").into()),
        }
    }

    /// Steps of one length from time 0, without any checks.
    #[inline(always)]
    pub fn march<T: Real, M: Model<T>>(self, model: &M, h: T, steps: u32, y: &mut M::State) {
        let t = T::from_f64(0.0);
        match self {
            StepFormula::Rk4 => march(model, t, h, steps, y),
            StepFormula::Dop853 => march_dop853(model, t, h, steps, y),
            StepFormula::Adams => march_adams(model, t, h, steps, y),
        };
    }
}

/// Times of runs from one state \[ns\], and their end; if the time loop has the formula, the run uses it with its
/// checks.
pub fn fall<M: Model<f64>>(
    mechanism: &M,
    start: M::State,
    duration: f64,
    step: f64,
    rule: StepFormula,
) -> Result<(Vec<f64>, Vec<f64>)> {
    let mut end = start;
    let formula = match rule {
        StepFormula::Rk4 => Formula::Rk4,
        StepFormula::Dop853 => Formula::Dop853,
        StepFormula::Adams => {
            let steps = (duration / step).round() as u32;
            let times = time::runs(|| {
                end = start;
                rule.march(mechanism, step, steps, &mut end);
            });
            return Ok((times, end.as_ref().to_vec()));
        }
    };
    let settings = Settings {
        start: 0.0,
        duration,
        every: duration,
        parts: 0,
        method: Integrator::fixed(formula, step),
        locate: false,
        max_steps: u64::MAX,
    };
    let mut failure = None;
    let times = time::runs(|| {
        let run = simulate_from(mechanism, start, &settings, &mut |sample| {
            end.as_mut().copy_from_slice(sample.state);
            ControlFlow::Continue(())
        });
        failure = run.err();
    });
    match failure {
        Some(failure) => Err(failure.into()),
        None => Ok((times, end.as_ref().to_vec())),
    }
}
