//! A study as one page of HTML: distributions, sensitivities, points of runs that can be selected, and the runs as rows.

use super::filled;
use bryant_study::results::{Results, ResultsError};
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
    /// Limits of responses \[SI\], by their names.
    pub limits: Vec<(String, f64)>,
    /// The command line that makes this page.
    pub command: String,
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
    let d = study.varied.len();
    let stride = study.rows.div_ceil(MOST_RUNS).max(1);
    let limit = |name: &str| {
        let found = about.limits.iter().find(|(limited, _)| limited == name);
        found.map(|(_, limit)| *limit)
    };
    let mut rows: Vec<Value> = Vec::new();
    let mut within = vec![0u64; study.responses.len()];
    for batch in results.batches() {
        let batch = batch?;
        for (k, run) in batch.outcomes.runs.iter().enumerate() {
            let row = batch.first + k as u64;
            let responses = batch.outcomes.of(k);
            for (count, (response, value)) in
                within.iter_mut().zip(study.responses.iter().zip(responses))
            {
                *count += u64::from(limit(&response.name).is_some_and(|limit| *value <= limit));
            }
            if !row.is_multiple_of(stride) {
                continue;
            }
            let mut cells = vec![json!(row), json!(run.status.word()), json!(run.error)];
            // all digits, so that a row can be run again
            cells.extend(batch.values[k * d..][..d].iter().map(|x| json!(x)));
            cells.extend(responses.iter().map(|y| json!(y)));
            rows.push(cells.into());
        }
    }
    let parameters = study.varied.iter();
    let parameters = parameters.map(|p| json!({ "name": p.name, "unit": p.unit }));
    let responses = summary.responses.iter().zip(&within).map(|(one, within)| {
        json!({
            "name": one.name,
            "unit": one.unit,
            "mean": one.mean,
            "deviation": one.deviation,
            "minimum": one.minimum,
            "maximum": one.maximum,
            "quantiles": one.quantiles,
            "correlations": one.correlations,
            "shares": one.sensitivity.as_ref().map(|of| &of.parameters),
            "limit": limit(&one.name),
            "within": *within as f64 / one.count.max(1) as f64,
        })
    });
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
        "thinned": stride > 1,
        "ends": summary.ends,
        "reasons": summary.reasons,
        "errors": summary.errors.text().trim(),
        "parameters": parameters.collect::<Vec<_>>(),
        "responses": responses.collect::<Vec<_>>(),
        "rows": rows,
        "fixed": options,
        "command": format!("bryant run {} --responses {}", quoted(&about.model), quoted(&about.study)),
        "made": about.command,
    });
    let title = format!("{} runs of {}", study.rows, study.model);
    let scripts = [include_str!("common.js"), include_str!("study.js")];
    Ok(filled(include_str!("study.html"), &title, &data, &scripts))
}

/// A word quoted for a command line.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:%+@,".contains(c);
    match !word.is_empty() && word.chars().all(plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}
