//! The conclusion of a study: the Pareto front, and a sentence about the cost of an accuracy.

use super::front::{self, Cost, Digits};
use super::point::{Point, Status};
use super::setting::{Pace, Scheme, time, two_digits};
use super::study::Study;

/// The conclusion of a study about one kind of error.
#[derive(Clone, Debug, PartialEq)]
pub struct Conclusion {
    /// Indices of the points on the front, in the order of decreasing error.
    pub front: Vec<usize>,
    /// The cheapest point whose error is at most [`Conclusion::wanted`]; all finer points of its series confirm this.
    pub cheapest: Option<usize>,
    /// The error that the sentence is about.
    pub wanted: f64,
    /// The cost of each further digit along the front.
    pub digits: Option<Digits>,
}

impl Conclusion {
    /// The conclusion of a study; `wanted` is the error that the sentence names.
    pub fn of(study: &Study, wanted: f64) -> Conclusion {
        let costs: Vec<Cost> = study.points.iter().map(|p| cost(study, p)).collect();
        let front = front::pareto(&costs);
        // errors below that of the reference are not known
        let known = |&&i: &&usize| !at_most(study, &study.points[i]);
        let fitted: Vec<Cost> = front.iter().filter(known).map(|&i| costs[i]).collect();
        Conclusion {
            cheapest: front::cheapest(&confirmed(study, &costs, wanted), wanted),
            digits: front::digits(&fitted),
            front,
            wanted,
        }
    }

    /// The sentence: "for 1 % in peak belt force the cheapest is tsit5 at tolerance 3e-4, at 0.21 ms per run; each
    /// further digit costs a factor 1.6"
    pub fn sentence(&self, study: &Study) -> String {
        let name = study.of.name(&study.reference.readings);
        let wanted = percent(self.wanted);
        let rests = rests_on(study);
        let Some(index) = self.cheapest else {
            return format!("no setting reaches {wanted} in {name}; {rests}");
        };
        let point = &study.points[index];
        let median = point.done().map_or(f64::NAN, |done| done.timing.median);
        let mut sentence = format!(
            "for {wanted} in {name} the cheapest is {}, at {} per run",
            point.setting.name(),
            time(two_digits(median))
        );
        if let Some(digits) = &self.digits {
            sentence += &format!(
                "; each further digit costs a factor {:.2} (from {:.0e} to {:.0e})",
                digits.factor, digits.from, digits.to
            );
        }
        format!("{sentence}; {rests}")
    }
}

/// The number of settings on which the conclusion rests, and the numbers of those that failed or were skipped, in
/// words.
fn rests_on(study: &Study) -> String {
    let (mut done, mut failed, mut skipped) = (0, 0, 0);
    for point in &study.points {
        *match point.status {
            Status::Done(_) => &mut done,
            Status::Failed(_) => &mut failed,
            Status::Skipped(_) => &mut skipped,
        } += 1;
    }
    let mut text = format!("this rests on {done} of {} settings", study.points.len());
    if failed > 0 {
        text += &format!(", {failed} failed");
    }
    if skipped > 0 {
        let why = match study.interrupted {
            true => "interrupted",
            false => "--budget",
        };
        let most = most_skipped(study).join(", ");
        text += &format!(", {skipped} were not reached or stopped ({why}), most of {most}");
    }
    text
}

/// The schemes of a study, in their usual order.
pub fn schemes(study: &Study) -> Vec<Scheme> {
    let there = |scheme: &Scheme| study.points.iter().any(|p| p.setting.scheme() == *scheme);
    Scheme::all().into_iter().filter(there).collect()
}

/// The methods with the largest shares of skipped settings, at most three: "rodas5 (31 of 33)".
fn most_skipped(study: &Study) -> Vec<String> {
    let counts = schemes(study).into_iter().map(|scheme| {
        let all = study.points.iter().filter(|p| p.setting.scheme() == scheme);
        let skipped = |p: &&Point| matches!(p.status, Status::Skipped(_));
        (
            scheme.name(),
            all.clone().filter(skipped).count(),
            all.count(),
        )
    });
    let mut counts: Vec<_> = counts.filter(|(_, skipped, _)| *skipped > 0).collect();
    counts.sort_by(|a, b| (b.1 * a.2).cmp(&(a.1 * b.2)));
    let named = counts.iter().take(3);
    named
        .map(|(formula, skipped, all)| format!("{formula} ({skipped} of {all})"))
        .collect()
}

/// Series whose steps are limited by stability instead of accuracy: the name of each, its typical step \[s\], and the
/// rate of the fastest motion of the scene \[1/s\], which is the stability limit of the method divided by this step.
pub fn bounded_by_stability(study: &Study) -> Vec<(String, f64, f64)> {
    let mut found = Vec::new();
    let series = study
        .points
        .chunk_by(|a, b| a.setting.same_series(&b.setting));
    for series in series.filter(|s| matches!(s[0].setting.pace, Pace::Tolerance(_))) {
        let Some(limit) = series[0].setting.formula.stability_limit() else {
            continue;
        };
        let done: Vec<(&Point, u64)> = series
            .iter()
            .filter_map(|point| Some((point, point.done()?.report.steps)))
            .collect();
        let bounded = done.windows(2).rev().find(|pair| {
            let finer = pair[0].0.setting.pace.value() / pair[1].0.setting.pace.value();
            let order = f64::from(pair[0].0.setting.formula.order());
            let expected = libm::pow(finer, 1.0 / order);
            let grown = pair[1].1 as f64 / pair[0].1 as f64;
            // the number of steps grows much less than the accuracy would require
            pair[0].1 > MANY_STEPS && grown < 1.0 + 0.25 * (expected - 1.0)
        });
        if let Some(pair) = bounded {
            let step = study.duration / pair[0].1 as f64;
            found.push((pair[1].0.setting.name(), step, limit / step));
        }
    }
    found
}

/// Least number of steps for a judgement about stability.
const MANY_STEPS: u64 = 200;

/// The cost of a point without a result.
const NONE: Cost = Cost {
    error: f64::INFINITY,
    time: f64::INFINITY,
};

/// Error and time of a point; infinite without a result, and with an error of 100 % or more.
pub fn cost(study: &Study, point: &Point) -> Cost {
    let Some(done) = point.done() else {
        return NONE;
    };
    let error = done.error(study.of, &study.reference.own).error;
    match error < 1.0 {
        true => Cost {
            error,
            time: done.timing.median,
        },
        false => NONE,
    }
}

/// The costs of points whose error is at most `wanted`, and not by luck. A point does not count if a finer point of its
/// series has a larger error, because a user who does not know the solution could not tell. A finer run that failed
/// does not matter: it reports this itself.
fn confirmed(study: &Study, costs: &[Cost], wanted: f64) -> Vec<Cost> {
    let points = &study.points;
    let refuted = |i: usize| {
        let finer = points[i..].iter().zip(&costs[i..]);
        finer
            .take_while(|(point, _)| point.setting.same_series(&points[i].setting))
            .any(|(point, cost)| point.done().is_some() && cost.error > wanted)
    };
    let all = (0..points.len()).map(|i| if refuted(i) { NONE } else { costs[i] });
    all.collect()
}

fn at_most(study: &Study, point: &Point) -> bool {
    let own = &study.reference.own;
    point
        .done()
        .is_some_and(|done| done.error(study.of, own).at_most)
}

/// An error in words: "1 %", "0.01 %", "1e-6"
pub fn percent(error: f64) -> String {
    match error {
        error if error >= 1e-4 => format!("{} %", two_digits(100.0 * error)),
        error => format!("{:e}", two_digits(error)),
    }
}
