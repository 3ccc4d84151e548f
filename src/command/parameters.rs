//! `--set name=value`: parameters of a model by name, with units.

use super::Error;
use super::model_argument::nearest;
use crate::quantity;
use bryant_generator::model::annotated_model::AnnotatedModel;
use bryant_generator::model::{Model, Parameter};

/// Reads parameters: their names and values in SI units; each at most once, and within its bounds.
pub fn parse_parameters(
    words: &[String],
    scene: &AnnotatedModel,
) -> Result<Vec<(String, f64)>, Error> {
    let mut set: Vec<(String, f64)> = Vec::new();
    for word in words {
        let (name, value) = parameter(word, scene)?;
        if set.iter().any(|(before, _)| *before == name) {
            return Err(Error::Input(format!(
                "the parameter \"{name}\" is given twice"
            )));
        }
        set.push((name, value));
    }
    Ok(set)
}

/// The values of all parameters of a model (SI), in its order: those in `set`, else the defaults.
pub fn values_of(model: &Model, set: &[(String, f64)]) -> Vec<f64> {
    let value = |name: &str| set.iter().find(|(n, _)| n == name).map(|(_, value)| *value);
    model
        .parameters
        .iter()
        .map(|p| value(&p.name).unwrap_or(p.default))
        .collect()
}

/// Reads `name=value` as a parameter of the model, in SI units.
fn parameter(word: &str, scene: &AnnotatedModel) -> Result<(String, f64), Error> {
    let model = &scene.model;
    let Some((name, value)) = word.split_once('=') else {
        return Err(Error::Input(format!(
            "--set {word}: a name and a value are needed\n  help: write --set NAME=VALUE"
        )));
    };
    let (name, value) = (name.trim(), value.trim());
    let names: Vec<&str> = model.parameters.iter().map(|p| p.name.as_str()).collect();
    let Some(parameter) = model.parameters.iter().find(|p| p.name == name) else {
        let unused = scene.unused_parameters();
        if let Some((name, why)) = unused.into_iter().find(|(unused, _)| unused == name) {
            let place = scene.places.get(&format!("parameter {name}"), "");
            let place = place.map_or_else(String::new, |place| format!(" ({place})"));
            return Err(Error::Input(format!(
                "the parameter \"{name}\"{place} changes nothing: {why}\n  help: `bryant effects` lists what is out, and why"
            )));
        }
        let help = match (nearest(name, &names), names.is_empty()) {
            (Some(near), _) => format!("did you mean \"{near}\"?"),
            (None, true) => format!(
                "\"{}\" has no parameters; all its numbers are constants",
                model.name
            ),
            (None, false) => format!("there are: {}", names.join(", ")),
        };
        return Err(Error::Input(format!(
            "there is no parameter \"{name}\"\n  help: {help}"
        )));
    };
    let value = quantity::quantity(value, &parameter.unit)
        .map_err(|error| Error::Input(format!("--set {name}: {error}")))?;
    match out_of_bounds(parameter, value) {
        Some(bounds) => Err(Error::Input(format!(
            "the parameter \"{name}\" is {}, but must be {bounds}",
            with_unit(value, &parameter.unit)
        ))),
        None => Ok((name.to_owned(), value)),
    }
}

/// The bounds that a value of a parameter violates, as text; `None` if it violates none.
fn out_of_bounds(parameter: &Parameter, value: f64) -> Option<String> {
    let (min, max) = (parameter.min, parameter.max);
    if min.is_none_or(|min| value >= min) && max.is_none_or(|max| value <= max) {
        return None;
    }
    let unit = |bound| with_unit(bound, &parameter.unit);
    Some(match (min, max) {
        (Some(min), Some(max)) => format!("between {min} and {}", unit(max)),
        (Some(min), None) => format!("at least {}", unit(min)),
        (None, max) => format!("at most {}", unit(max.unwrap_or(f64::INFINITY))),
    })
}

fn with_unit(value: f64, unit: &str) -> String {
    format!("{value} {unit}").trim_end().to_owned()
}
