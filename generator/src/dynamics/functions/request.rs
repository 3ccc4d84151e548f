//! What is asked for: the name of a function, with its argument: `jacobian(arm/hand)`.

use super::{FUNCTIONS, Function};
use crate::diagnostic::{Diagnostic, Diagnostics, quoted, suggestion};
use crate::model::{Body, ElementId, Model, Number};

/// A frame fixed in a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The body.
    pub body: Body,
    /// Its origin, in the frame of the body \[m\].
    pub at: [Number; 3],
    /// Its Bryant angles against the frame of the body \[rad\].
    pub angles: [Number; 3],
}

/// A function that is asked for, of a model that has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    name: String,
    /// Index in [`FUNCTIONS`].
    function: usize,
    frame: Option<Frame>,
}

impl Request {
    /// The name as it is shown: `jacobian(arm/hand)`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The function.
    pub fn function(&self) -> &'static Function {
        &FUNCTIONS[self.function]
    }

    /// The frame that the function is of, if it is of one.
    pub fn frame(&self) -> Option<&Frame> {
        self.frame.as_ref()
    }
}

/// Requests of a model, each once, in their order. `file` stands for the model in messages.
///
/// # Errors
/// All functions and frames that do not exist.
pub fn requests<'a>(
    model: &Model,
    file: &str,
    asked: impl IntoIterator<Item = &'a str>,
) -> Result<Vec<Request>, Diagnostics> {
    let (mut found, mut problems) = (Vec::<Request>::new(), Vec::new());
    for asked in asked {
        match request(model, asked) {
            Ok(request) if found.iter().any(|other| other.name == request.name) => {}
            Ok(request) => found.push(request),
            Err([message, help]) => problems.push(Diagnostic::of_file(file, message, help)),
        }
    }
    match problems.is_empty() {
        true => Ok(found),
        false => Err(Diagnostics { problems }),
    }
}

/// A request of a model.
///
/// # Errors
/// What is wrong, and what helps.
pub fn request(model: &Model, asked: &str) -> Result<Request, [String; 2]> {
    let asked = asked.trim();
    let (name, argument) = match asked.split_once('(') {
        None => (asked, None),
        Some((name, rest)) => match rest.trim_end().strip_suffix(')') {
            Some(argument) => (name.trim_end(), Some(argument.trim())),
            None => {
                let message = format!("{} has no closing parenthesis", quoted(asked));
                return Err([message, "write `jacobian(arm/hand)`".to_owned()]);
            }
        },
    };
    let names = FUNCTIONS.iter().map(|function| function.name);
    let Some(function) = names.clone().position(|other| other == name) else {
        let message = format!("there is no function {}", quoted(name));
        return Err([message, suggestion(name, names, "there is none")]);
    };
    let of_frame = FUNCTIONS[function].is_of_frame();
    let frame = match (of_frame, argument) {
        (false, None) => None,
        (true, Some(argument)) => Some((argument, frame(model, argument)?)),
        (false, Some(_)) => {
            let message = format!("the function {} has no argument", quoted(name));
            return Err([message, format!("write `{name}`")]);
        }
        (true, None) => {
            let message = format!("the function {} is of a frame", quoted(name));
            let example = frames(model).into_iter().next();
            let example = example.map_or(String::new(), |(path, _)| path);
            return Err([message, format!("write `{name}({example})`")]);
        }
    };
    Ok(Request {
        name: match &frame {
            Some((argument, _)) => format!("{name}({argument})"),
            None => name.to_owned(),
        },
        function,
        frame: frame.map(|(_, frame)| frame),
    })
}

/// The frame of a name.
fn frame(model: &Model, name: &str) -> Result<Frame, [String; 2]> {
    let all = frames(model);
    let mut found = all.iter().filter(|(path, _)| {
        let own = path.rsplit('/').next();
        path == name || own == Some(name)
    });
    match (found.next(), found.next()) {
        (Some((_, frame)), None) => Ok(frame.clone()),
        (Some((first, _)), Some(_)) => {
            let message = format!("several systems have a frame {}", quoted(name));
            Err([message, format!("write {}", quoted(first))])
        }
        (None, _) => {
            let own = all.iter().filter_map(|(path, _)| path.rsplit('/').next());
            let paths = all.iter().map(|(path, _)| path.as_str());
            let help = match name.contains('/') {
                true => suggestion(name, paths, "the model has none"),
                false => suggestion(name, own, "the model has none"),
            };
            Err([format!("there is no frame {}", quoted(name)), help])
        }
    }
}

/// All frames: those of the elements, their points, and the vehicles.
fn frames(model: &Model) -> Vec<(String, Frame)> {
    let none = [0.0; 3].map(Number::Constant);
    let of_body = |body| Frame {
        body,
        at: none.clone(),
        angles: none.clone(),
    };
    let mut frames = Vec::new();
    for (s, system) in model.systems.iter().enumerate() {
        for (k, element) in system.elements.iter().enumerate() {
            let body = Body::Element(ElementId {
                system: s,
                element: k,
            });
            let path = |name: &str| format!("{}/{name}", system.name);
            frames.push((path(&element.name), of_body(body)));
            frames.extend(element.points.iter().map(|point| {
                let frame = Frame {
                    body,
                    at: point.at.clone(),
                    angles: point.angles.clone(),
                };
                (path(&point.name), frame)
            }));
        }
    }
    let vehicles = model.vehicles.iter().enumerate();
    let vehicles = vehicles.map(|(k, of)| (of.name.clone(), of_body(Body::Vehicle(k))));
    frames.extend(vehicles);
    frames
}
