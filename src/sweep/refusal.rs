//! The reasons why a row of parameters is refused, or why its run cannot be trusted.

use crate::equations::Engine;
use bryant_runtime::CurveKind;
use bryant_runtime::batch::Doubt;
use bryant_runtime::batch::rows::Job;

/// The values of all parameters in a row, in the order of the model.
pub fn parameters(engine: &Engine, job: &Job, row: &[f64]) -> Vec<f64> {
    let defaults = engine.info().parameters.iter();
    let mut values: Vec<f64> = defaults.map(|parameter| parameter.default).collect();
    let varied = job.varied.iter().copied().zip(row.iter().copied());
    for (index, value) in job.fixed.iter().copied().chain(varied) {
        if let Some(place) = values.get_mut(index) {
            *place = value;
        }
    }
    values
}

/// The reason why the model refuses the parameters of a row; `None` if it accepts them.
pub fn refusal(engine: &Engine, job: &Job, row: &[f64]) -> Option<String> {
    let info = engine.info();
    let values = parameters(engine, job, row);
    let mut infinite = info.parameters.iter().zip(&values);
    if let Some((parameter, value)) = infinite.find(|(_, value)| !value.is_finite()) {
        let name = parameter.name;
        return Some(format!(
            "the parameter \"{name}\" is {value}, but must be finite"
        ));
    }
    let mut model = engine.in_double();
    model.set_parameters(&values);
    let condition = info.conditions.get(model.violated()?)?;
    Some((*condition).to_owned())
}

/// The reason why a run that reached its end cannot be trusted; `None` without a doubt.
pub fn doubt(engine: &Engine, doubt: Option<Doubt>) -> Option<String> {
    let info = engine.info();
    Some(match doubt? {
        Doubt::Bent(bearing) => {
            let curve = info.curves.get(bearing)?;
            format!("\"{}\" {}", curve.name, curve.singular())
        }
        Doubt::Sunk(contact) => format!(
            "the bodies of \"{}\" have sunk into each other so far that the direction of the force is not determined",
            info.curves.get(contact)?.name
        ),
        Doubt::Missed(onset) => format!(
            "a step passed over an event that begins and ends within the step: \"{}\"",
            info.onsets.get(onset)?
        ),
        Doubt::Unstable(index) => format!(
            "the fixed steps are above the stability limit; the unstable motion is largest in \"{}\"",
            info.state_name(index)?
        ),
        Doubt::Energy(effect) => match effect.and_then(|effect| info.powers.get(effect)) {
            Some(effect) => format!(
                "the balance of energy has a gap: the fixed steps are too long; when the gap began, the largest power was that of \"{effect}\""
            ),
            None => "the balance of energy has a gap: the fixed steps are too long".to_owned(),
        },
        Doubt::Momentum => {
            "the balance of momentum of freely moving bodies has a gap: the fixed steps are too long".to_owned()
        }
        Doubt::Error(index) => format!(
            "\"{}\" errs by too much, as a comparison with steps half as long shows: the fixed steps are too long",
            info.state_name(index)?
        ),
        Doubt::Tied => "several events happen at the same time, and depend on parameters otherwise".to_owned(),
        Doubt::Left(curve) if info.curves.get(curve)?.kind == CurveKind::Volume => format!(
            "the {} is compressed so far that its law is no longer valid",
            info.curves.get(curve)?.name
        ),
        Doubt::Left(curve) if info.curves.get(curve)?.kind == CurveKind::Edge => format!(
            "the edge of \"{}\" pushes harder than the surface: it fades over less than the depth of the body",
            info.curves.get(curve)?.name
        ),
        Doubt::Left(curve) => format!(
            "the argument of the curve \"{}\" is so far outside of its points that the value of the curve is arbitrary",
            info.curves.get(curve)?.name
        ),
    })
}
