//! The work–precision diagram of a study.

use crate::accuracy::conclusion::{Conclusion, cost, schemes};
use crate::accuracy::point::Point;
use crate::accuracy::setting::{Pace, Setting, time};
use crate::accuracy::study::Study;
use crate::picture::work_precision::{Diagram, Line};
use bryant_runtime::program::Scalar;

/// The diagram of a study.
pub fn diagram(study: &Study, conclusion: &Conclusion) -> Diagram {
    let schemes = schemes(study);
    let there =
        |variant: &&(Scalar, bool)| study.points.iter().any(|p| of(&p.setting) == **variant);
    let variants: Vec<(Scalar, bool)> = VARIANTS.iter().filter(there).copied().collect();
    let series = study
        .points
        .chunk_by(|a, b| a.setting.same_series(&b.setting));
    let line = |series: &[Point]| {
        let setting = &series[0].setting;
        let costs = series.iter().map(|point| cost(study, point));
        let costs = costs.filter(|cost| cost.error.is_finite());
        Some(Line {
            method: schemes.iter().position(|s| *s == setting.scheme())?,
            variant: variants.iter().position(|v| *v == of(setting))?,
            fixed: matches!(setting.pace, Pace::Step(_)),
            points: costs.map(|cost| [cost.error, cost.time]).collect(),
        })
    };
    let front = conclusion.front.iter().map(|&index| {
        let cost = cost(study, &study.points[index]);
        [cost.error, cost.time]
    });
    Diagram {
        title: format!(
            "{}: what accuracy costs in time, {} simulated",
            study.model,
            time(study.duration)
        ),
        error: study.of.name(&study.reference.readings),
        methods: schemes.iter().map(|s| s.name()).collect(),
        variants: variants.iter().map(|v| name(*v, &variants)).collect(),
        lines: series.filter_map(line).collect(),
        front: front.collect(),
        own: study.reference.own.of(study.of),
        sentence: conclusion.sentence(study),
    }
}

/// The variants in the order of drawing, the usual one first.
const VARIANTS: [(Scalar, bool); 5] = [
    (Scalar::F64, true),
    (Scalar::F64, false),
    (Scalar::F32, true),
    (Scalar::F32, false),
    (Scalar::Fast, true),
];

fn of(setting: &Setting) -> (Scalar, bool) {
    (setting.scalar, setting.locate)
}

/// The name of a variant: "f32, kinks passed"; kinks are named only if some of `all` are passed.
fn name((scalar, locate): (Scalar, bool), all: &[(Scalar, bool)]) -> String {
    let scalar = match scalar {
        Scalar::Fast => "f64, fast sines",
        other => other.name(),
    };
    match (locate, all.iter().any(|(_, locate)| !locate)) {
        (_, false) => scalar.to_owned(),
        (true, true) => format!("{scalar}, kinks located"),
        (false, true) => format!("{scalar}, kinks passed"),
    }
}
