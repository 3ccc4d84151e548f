//! Measurements that several cases share.

use crate::bench::{Run, Trouble};
use bryant_runtime::Tolerances;

/// The largest value, at least 0; NaN if one value is NaN.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |m: f64, x: f64| if x <= m { m } else { x };
    values.into_iter().fold(0.0, larger)
}

/// Number of steps, including rejected ones.
///
/// # Errors
/// The run failed.
pub fn steps(run: &Run) -> Result<f64, Trouble> {
    let report = run.report()?;
    Ok((report.steps + report.rejected) as f64)
}

/// Bound of the change of a speed v \[m/s\] in a step with error control: r v + a_v + ω a_x. It includes errors of
/// position, which an oscillation of frequency ω \[1/s\] converts to errors of speed.
pub fn error_of_speed(of: &Tolerances, speed: f64, omega: f64) -> f64 {
    of.relative * speed + of.velocities + omega * of.positions
}

/// Bound of the change of a rate θ' \[rad/s\] in a step with error control: r θ' + a_ω + ω a_θ, as in
/// [`error_of_speed`].
pub fn error_of_rate(of: &Tolerances, rate: f64, omega: f64) -> f64 {
    of.relative * rate + of.angular_velocities + omega * of.angles
}
