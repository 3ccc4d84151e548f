//! A study as one page of HTML: distributions, sensitivities, points of runs that can be selected, and the runs as
//! rows.

use super::{filled, short};
use crate::process::quoted;
use bryant_signal::unit;
use bryant_study::criteria::Shown;
use bryant_study::distribution::Distribution;
use bryant_study::quantity::strict;
use bryant_study::results::{Results, ResultsError};
use bryant_study::study::{Levels, Plan, RandomDesign, Study};
use bryant_study::summary::Summary;
use serde_json::{Value, json};

/// A page shows at most this many runs; of more runs, every second one and so on is shown.
const MOST_RUNS: u64 = 5000;

/// The texts of a page that are not results.
pub struct About {
    /// The path of the study file, as it was given.
    pub study: String,
    /// The model as an argument of a command, relative to the study.
    pub model: String,
    /// Digest of the model.
    pub digest: String,
    /// Responses that are injury criteria.
    pub criteria: Vec<Judged>,
    /// The command line that makes this page.
    pub command: String,
}

/// A response that is an injury criterion.
pub struct Judged {
    /// Its name.
    pub name: String,
    /// How its number is shown beside its limit.
    pub shown: Shown,
}

/// The page of results.
///
/// # Errors
/// A block cannot be read.
pub fn page(
    results: &Results<'_>,
    summary: &Summary,
    about: &About,
) -> Result<String, ResultsError> {
    let study = results.study;
    let runs = Runs::of(results, about)?;
    let fixed = study.fixed.iter();
    let mut options: Vec<String> = fixed
        .map(|one| format!("--set {}={}", one.name, one.value))
        .collect();
    options.extend(study.run.duration.map(|t| format!("--duration {t}")));
    let data = json!({
        "title": format!("{} runs of {}", study.rows, study.model),
        "model": study.model,
        "version": env!("CARGO_PKG_VERSION"),
        "digest": about.digest,
        "identity": summary.identity,
        "runs": study.rows,
        "thinned": runs.stride > 1,
        "design": design(&study.plan),
        "kept": runs.kept,
        "ends": summary.ends,
        "reasons": summary.reasons,
        "errors": summary.errors.text().trim(),
        "parameters": parameters(study),
        "responses": responses(summary, about, &runs.within),
        "rows": runs.rows,
        "fixed": options,
        "command": format!("bryant run {} --responses {}", quoted(&about.model), quoted(&about.study)),
        "made": about.command,
    });
    let title = format!("{} runs of {}", study.rows, study.model);
    let scripts = [include_str!("common.js"), include_str!("study.js")];
    Ok(filled(include_str!("study.html"), &title, &data, &scripts))
}

/// The runs of a study.
struct Runs {
    /// Every so many are shown.
    stride: u64,
    /// Those, with all digits, so that one can be made again.
    rows: Vec<Value>,
    /// How many keep the limit of each response.
    within: Vec<u64>,
    /// How many keep all limits.
    kept: u64,
}

impl Runs {
    fn of(results: &Results<'_>, about: &About) -> Result<Self, ResultsError> {
        let study = results.study;
        let d = study.varied.len();
        let limits = study.responses.iter().map(|response| {
            let one = about.judged(&response.name)?;
            Some(one.shown.limit? * one.factor(&response.unit.name))
        });
        let limits: Vec<Option<f64>> = limits.collect();
        let mut runs = Runs {
            stride: study.rows.div_ceil(MOST_RUNS).max(1),
            rows: Vec::new(),
            within: vec![0; study.responses.len()],
            kept: 0,
        };
        for batch in results.batches() {
            let batch = batch?;
            for (k, run) in batch.outcomes.runs.iter().enumerate() {
                let row = batch.first + k as u64;
                let responses = batch.outcomes.of(k);
                let mut all = true;
                for (count, (limit, value)) in
                    runs.within.iter_mut().zip(limits.iter().zip(responses))
                {
                    if let Some(limit) = limit {
                        *count += u64::from(value <= limit);
                        // a value that is not known keeps no limit
                        all &= value <= limit;
                    }
                }
                runs.kept += u64::from(all);
                if !row.is_multiple_of(runs.stride) {
                    continue;
                }
                let mut cells = vec![json!(row), json!(run.status.word()), json!(run.error)];
                cells.extend(batch.values[k * d..][..d].iter().map(|x| json!(x)));
                cells.extend(responses.iter().map(|y| json!(y)));
                runs.rows.push(cells.into());
            }
        }
        Ok(runs)
    }
}

impl About {
    /// The criterion that a response is.
    fn judged(&self, response: &str) -> Option<&Judged> {
        self.criteria.iter().find(|one| one.name == response)
    }
}

impl Judged {
    /// Its unit in that of the results.
    fn factor(&self, unit: &str) -> f64 {
        unit::factor(self.shown.unit, unit).unwrap_or(self.shown.scale)
    }
}

/// What is varied, in the units of the study.
fn parameters(study: &Study) -> Vec<Value> {
    let each = study.varied.iter().enumerate().map(|(index, p)| {
        // the rows are in SI, as a command takes them
        let factor = strict(&format!("1 {}", p.shown), &p.unit).unwrap_or(1.0);
        json!({
            "name": p.name,
            "unit": p.shown,
            "factor": factor,
            "values": values(&study.plan, index, factor),
        })
    });
    each.collect()
}

/// The responses, criteria in their units. So many runs are `within` the limit of each.
fn responses(summary: &Summary, about: &About, within: &[u64]) -> Vec<Value> {
    let each = summary.responses.iter().zip(within).map(|(one, within)| {
        let judged = about.judged(&one.name);
        let factor = judged.map_or(1.0, |judged| judged.factor(&one.unit));
        let shown = |value: f64| value / factor;
        json!({
            "name": one.name,
            "unit": judged.map_or(one.unit.as_str(), |judged| judged.shown.unit),
            "factor": factor,
            "mean": shown(one.mean),
            "deviation": shown(one.deviation),
            "minimum": shown(one.minimum),
            "maximum": shown(one.maximum),
            "quantiles": one.quantiles.map(shown),
            "correlations": one.correlations,
            "shares": one.sensitivity.as_ref().map(|of| &of.parameters),
            "limit": judged.and_then(|judged| judged.shown.limit),
            "within": *within as f64 / one.count.max(1) as f64,
        })
    });
    each.collect()
}

/// The design in words.
fn design(plan: &Plan) -> &'static str {
    match plan {
        Plan::Grid(_) => "a grid",
        Plan::List(_) => "a list",
        Plan::Random { design, .. } => match design {
            RandomDesign::LatinHypercube => "a latin hypercube",
            RandomDesign::Sobol => "Sobol' points",
            RandomDesign::MonteCarlo => "random points",
            RandomDesign::Saltelli => "Saltelli's groups of points",
        },
    }
}

/// The values that a parameter takes, in words, in a unit of this size \[SI\].
fn values(plan: &Plan, index: usize, factor: f64) -> String {
    let number = |value: f64| short(value / factor).as_f64().unwrap_or(value).to_string();
    let list = |values: &[f64]| match values {
        few if few.len() <= 6 => {
            let few: Vec<String> = few.iter().map(|value| number(*value)).collect();
            few.join(", ")
        }
        many => format!("{} values", many.len()),
    };
    let ends = |[min, max]: [Option<f64>; 2]| match (min, max) {
        (None, None) => String::new(),
        (Some(min), None) => format!(", at least {}", number(min)),
        (None, Some(max)) => format!(", at most {}", number(max)),
        (Some(min), Some(max)) => format!(", {} to {}", number(min), number(max)),
    };
    match plan {
        Plan::List(_) => "as listed".to_owned(),
        Plan::Grid(all) => match &all[index] {
            Levels::Steps { from, to, count } => {
                format!("{} to {} in {count} values", number(*from), number(*to))
            }
            Levels::Values(values) => list(values),
        },
        Plan::Random { distributions, .. } => match &distributions[index] {
            Distribution::Uniform { from, to } => format!("{} to {}", number(*from), number(*to)),
            Distribution::Normal {
                mean,
                deviation,
                min,
                max,
            } => {
                let ends = ends([*min, *max]);
                format!("normal, {} ± {}{ends}", number(*mean), number(*deviation))
            }
            Distribution::Lognormal {
                median,
                deviation,
                min,
                max,
            } => {
                let ends = ends([*min, *max]);
                format!(
                    "lognormal, median {}, deviation {deviation} of the logarithm{ends}",
                    number(*median)
                )
            }
            Distribution::Triangular { from, mode, to } => format!(
                "{} to {}, most often {}",
                number(*from),
                number(*to),
                number(*mode)
            ),
            Distribution::Discrete { values, .. } => list(values),
        },
    }
}
