//! Why a row of parameters is refused, and why its run is not to be trusted.

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

/// What the parameters of a row do not keep, in the words of the model; `None` where they keep everything.
pub fn refusal(engine: &Engine, job: &Job, row: &[f64]) -> Option<String> {
    let info = engine.info();
    let values = parameters(engine, job, row);
    let mut infinite = info.parameters.iter().zip(&values);
    if let Some((parameter, value)) = infinite.find(|(_, value)| !value.is_finite()) {
        let name = parameter.name;
        return Some(format!(
            "the parameter \"{name}\" must be finite, but is {value}"
        ));
    }
    let mut model = engine.in_double();
    model.set_parameters(&values);
    let condition = info.conditions.get(model.violated()?)?;
    Some((*condition).to_owned())
}

/// Why a run that reached its end is not to be trusted, in words; `None` where it is.
pub fn doubt(engine: &Engine, doubt: Option<Doubt>) -> Option<String> {
    let info = engine.info();
    Some(match doubt? {
        Doubt::Bent(bearing) => format!(
            "\"{}\" is bent through 180°, where flexion has no direction and torsion no angle",
            info.curves.get(bearing)?.name
        ),
        Doubt::Sunk(contact) => format!(
            "the bodies of \"{}\" have sunk into each other so far that the direction of the force is not determined",
            info.curves.get(contact)?.name
        ),
        Doubt::Missed(onset) => format!(
            "a step went over what begins and ends within: \"{}\"",
            info.onsets.get(onset)?
        ),
        Doubt::Unstable(index) => format!(
            "the fixed steps are above the limit of stability, most in \"{}\"",
            info.state_name(index)?
        ),
        Doubt::Energy(effect) => match effect.and_then(|effect| info.powers.get(effect)) {
            Some(effect) => format!(
                "the balance of energy has a gap: the fixed steps are too long; the largest power when it began is of \"{effect}\""
            ),
            None => "the balance of energy has a gap: the fixed steps are too long".to_owned(),
        },
        Doubt::Momentum => {
            "the momentum of what moves freely has a gap: the fixed steps are too long".to_owned()
        }
        Doubt::Error(index) => format!(
            "\"{}\" errs by too much, as estimated from the rates within the fixed steps",
            info.state_name(index)?
        ),
        Doubt::Left(curve) if info.curves.get(curve)?.kind == CurveKind::Volume => format!(
            "the {} is pressed to less of its volume than its law knows",
            info.curves.get(curve)?.name
        ),
        Doubt::Left(curve) => format!(
            "the curve \"{}\" is left so far that what it gives is made up",
            info.curves.get(curve)?.name
        ),
    })
}
