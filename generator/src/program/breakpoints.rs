//! The times at which curves of time have kinks, as far as these do not depend on parameters.
//!
//! A curve of rate · t passes its point x_k at the smallest time for which the computed product satisfies rate · t ≥
//! x_k. So a step that ends at this time has its last stage on the left of the point, and the next step has its first
//! stage on the right.

use crate::equations::Equations;
use crate::model::Model;

/// The kink times that do not depend on parameters, increasing.
pub(crate) fn constant(model: &Model, equations: &Equations) -> Vec<f64> {
    let mut times = Vec::new();
    for &(curve, rate) in &equations.curves_of_time {
        if let Some(rate) = equations.graph.expr(rate).as_constant() {
            let points = model.curves[curve].points.iter();
            times.extend(points.map(|point| passed(point[0], rate)));
        }
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// The smallest time t with rate · t ≥ x.
pub fn passed(x: f64, rate: f64) -> f64 {
    let mut t = x / rate;
    // a division and a multiplication may differ by one or two roundings
    for _ in 0..4 {
        if t * rate < x {
            t = t.next_up();
        } else if t.next_down() * rate >= x {
            t = t.next_down();
        }
    }
    t
}
