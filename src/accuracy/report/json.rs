//! A study as JSON.

use crate::accuracy::conclusion::{Conclusion, bounded_by_stability};
use crate::accuracy::point::{Point, Status};
use crate::accuracy::setting::Pace;
use crate::accuracy::study::Study;
use serde_json::{Map, Value, json};

/// The whole study; a number that is not finite is `null`.
pub fn json(study: &Study, conclusion: &Conclusion) -> Value {
    let environment = &study.environment;
    let parameters: Map<String, Value> = study
        .parameters
        .iter()
        .map(|(name, value, unit)| (name.clone(), json!({ "value": value, "unit": unit })))
        .collect();
    let points: Vec<Value> = study
        .points
        .iter()
        .enumerate()
        .map(|(index, p)| point(study, p, conclusion.front.contains(&index)))
        .collect();
    let readings: Vec<Value> = study
        .reference
        .readings
        .iter()
        .zip(&study.reference.own.readings)
        .map(|(reading, own)| {
            json!({
                "name": reading.name,
                "unit": reading.unit,
                "value": reading.value,
                "time_s": reading.time,
                "own_error": own,
            })
        })
        .collect();
    let bounded = bounded_by_stability(study).into_iter();
    let bounded = bounded.map(|(setting, step, rate)| {
        json!({ "setting": setting, "step_s": step, "limit_of_rate_per_s": rate })
    });
    let bounded: Vec<Value> = bounded.collect();
    json!({
        "model": study.model,
        "digest": study.digest,
        "bryant": environment.version,
        "commit": environment.commit,
        "engine": environment.engine,
        "target": environment.target,
        "cpu_features": environment.features,
        "parameters": parameters,
        "duration_s": study.duration,
        "every_s": study.every,
        "operations_per_evaluation": study.operations.evaluation,
        "reference": {
            "statement": study.reference.statement,
            "own_error_state": study.reference.own.state,
            "tolerances": study.reference.tolerances,
            "closed_form": study.reference.closed.map(|(name, difference)| {
                json!({ "name": name, "difference": difference })
            }),
            "readings": readings,
        },
        "curves_exchanged": study.exchanged.as_ref().map(|e| {
            let worst = e.readings.iter().copied().fold(0.0, f64::max);
            json!({ "state": e.state, "worst_reading": worst, "reference": e.reference.statement })
        }),
        "curves_not_exchanged": study.not_exchanged,
        "of": study.of.name(&study.reference.readings),
        "sentence": conclusion.sentence(study),
        "factor_per_digit": conclusion.digits.map(|d| d.factor),
        "points": points,
        "bounded_by_stability": bounded,
        "fastest_motion": study.fastest.as_ref().map(|fastest| json!({
            "rate_per_s": fastest.rate,
            "time_s": fastest.t,
            "velocity": fastest.velocity,
            "effect": fastest.effect,
        })),
        "complete": !study.interrupted,
        "took_s": study.took,
    })
}

fn point(study: &Study, point: &Point, front: bool) -> Value {
    let setting = &point.setting;
    let mut value = json!({
        "method": setting.scheme().name(),
        "scalar": setting.scalar.name(),
        "kinks": setting.kinks(),
        "curves": setting.curves.name(),
    });
    match setting.pace {
        Pace::Step(step) => value["step_s"] = json!(step),
        Pace::Tolerance(tolerance) => value["tolerance"] = json!(tolerance),
    }
    match &point.status {
        Status::Failed(reason) => {
            value["status"] = json!("failed");
            value["reason"] = json!(reason);
        }
        Status::Skipped(reason) => {
            value["status"] = json!("skipped");
            value["reason"] = json!(reason);
        }
        Status::Done(done) => {
            let of = done.error(study.of, study.own(setting.curves));
            let names = study.reference.readings.iter().map(|r| r.name.clone());
            let errors = done.readings.iter();
            let readings: Map<String, Value> = names
                .zip(errors.map(|e| json!({ "error": e.value, "time_error_s": e.time })))
                .collect();
            value["status"] = json!("done");
            value["front"] = json!(front);
            value["error"] = json!(of.error);
            value["below_reference"] = json!(of.at_most);
            value["error_state"] = json!(done.state.error);
            value["error_state_entry"] = json!(done.state.entry);
            value["readings"] = json!(readings);
            value["energy_gap"] = json!(done.energy);
            value["momentum_drift"] = json!(done.momentum);
            value["order"] = json!(done.order);
            value["steps"] = json!(done.report.steps);
            value["rejected"] = json!(done.report.rejected);
            value["events"] = json!(done.report.events);
            value["evaluations"] = json!(done.report.evaluations);
            value["jacobians"] = json!(done.report.jacobians);
            value["operations"] = json!(done.operations);
            value["largest_step_s"] = json!(done.report.largest_step);
            value["smallest_step_s"] = json!(done.report.smallest_step);
            value["wall_median_s"] = json!(done.timing.median);
            value["wall_95_s"] = json!(done.timing.late);
            value["repetitions"] = json!(done.timing.repetitions);
            value["simulated_per_wall"] = json!(done.report.t / done.timing.median);
        }
    }
    value
}
