//! What several cases measure alike.

use crate::bench::{Run, Trouble};

/// The largest value, at least 0; NaN if one is.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |m: f64, x: f64| if x <= m { m } else { x };
    values.into_iter().fold(0.0, larger)
}

/// Steps, rejected ones too.
///
/// # Errors
/// The run failed.
pub fn steps(run: &Run) -> Result<f64, Trouble> {
    let report = run.report()?;
    Ok((report.steps + report.rejected) as f64)
}
