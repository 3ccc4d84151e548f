//! `--set name=value`: parameters of a model by name, with units.

use super::Error;
use super::model_argument::nearest;
use crate::quantity;
use bryant_generator::model::Model;

/// Parameters by name, in SI units.
pub fn parse_parameters(words: &[String], model: &Model) -> Result<Vec<(String, f64)>, Error> {
    words.iter().map(|word| parameter(word, model)).collect()
}

/// The values of all parameters of a model (SI), in its order: those set, and the defaults of the others.
pub fn values_of(model: &Model, set: &[(String, f64)]) -> Vec<f64> {
    let value = |name: &str| {
        set.iter()
            .rev()
            .find(|(n, _)| n == name)
            .map(|(_, value)| *value)
    };
    model
        .parameters
        .iter()
        .map(|p| value(&p.name).unwrap_or(p.default))
        .collect()
}

/// `name=value` as a parameter of the model, in SI units.
fn parameter(word: &str, model: &Model) -> Result<(String, f64), Error> {
    let Some((name, value)) = word.split_once('=') else {
        return Err(Error::Input(format!(
            "--set {word}: a name and a value are needed\n  help: write --set NAME=VALUE"
        )));
    };
    let (name, value) = (name.trim(), value.trim());
    let names: Vec<&str> = model.parameters.iter().map(|p| p.name.as_str()).collect();
    let Some(parameter) = model.parameters.iter().find(|p| p.name == name) else {
        let help = match (nearest(name, &names), names.is_empty()) {
            (Some(near), _) => format!("did you mean \"{near}\"?"),
            (None, true) => format!(
                "\"{}\" has no parameters; all its numbers are constants",
                model.name
            ),
            (None, false) => format!("there is {}", names.join(", ")),
        };
        return Err(Error::Input(format!(
            "there is no parameter \"{name}\"\n  help: {help}"
        )));
    };
    match quantity::quantity(value, &parameter.unit) {
        Ok(value) => Ok((name.to_owned(), value)),
        Err(error) => Err(Error::Input(format!("--set {name}: {error}"))),
    }
}
