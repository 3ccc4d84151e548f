//! Which outputs share a plot: those of one quantity at one place, and those that are alone at their places with others
//! of their quantity.

use bryant_generator::model::{
    Body, ElementId, FreedomQuantity, JointLoadQuantity, Model, PointQuantity, Quantity,
    RotationQuantity, SystemQuantity,
};
use bryant_signal::unit;
use serde_json::{Value, json};

/// A plot has at most this many curves.
const MOST_CURVES: usize = 6;

/// An output on the page.
#[derive(Clone, Debug, PartialEq)]
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub struct Measurand {
    /// What it measures: "acceleration", "belt force".
    pub what: String,
    /// Where: "driver/head", "three-point"; empty if that has no name.
    pub place: String,
}

/// A plot: its title, the title of its axis of values, the unit of its curves, and their outputs.
#[derive(Clone, Debug, PartialEq)]
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub struct Plot {
    pub title: String,
    what: String,
    unit: String,
    pub curves: Vec<usize>,
}

/// The plots of a run whose outputs have these units and these largest magnitudes.
pub fn json(model: &Model, units: &[&str], sizes: &[f64]) -> Value {
    let places: Vec<Measurand> = model
        .outputs
        .iter()
        .zip(units)
        .map(|(output, unit)| place(model, &output.quantity, unit))
        .collect();
    let names: Vec<&str> = model.outputs.iter().map(|o| o.name.as_str()).collect();
    let plots = plots(&places, units, &names, sizes).into_iter();
    let plots = plots.map(|plot| {
        json!({ "title": plot.title, "what": plot.what, "unit": plot.unit, "curves": plot.curves })
    });
    plots.collect()
}

/// The bodies that an output belongs to.
pub fn bodies(model: &Model, quantity: &Quantity) -> Vec<Body> {
    let mut found = Vec::new();
    for leaf in quantity.leaves() {
        match leaf {
            Quantity::Point { body, .. } | Quantity::Rotation { body, .. } => found.push(*body),
            Quantity::JointLoad { element, .. } | Quantity::Freedom { element, .. } => {
                found.push(Body::Element(*element));
            }
            Quantity::ForceOn { force, .. }
            | Quantity::ForceOnPoints { force, .. }
            | Quantity::OfForce { force, .. } => found.extend(of_force(model, *force)),
            Quantity::Switch { .. } | Quantity::System { .. } | Quantity::Formula(_) => {}
        }
    }
    let mut seen = Vec::new();
    found.retain(|body| {
        !seen.contains(body) && {
            seen.push(*body);
            true
        }
    });
    found
}

/// The forces of the model that an output belongs to, by their indices.
pub fn laws(quantity: &Quantity) -> Vec<usize> {
    let of = |leaf: &Quantity| match leaf {
        Quantity::ForceOn { force, .. }
        | Quantity::ForceOnPoints { force, .. }
        | Quantity::OfForce { force, .. } => Some(*force),
        _ => None,
    };
    let mut found: Vec<usize> = quantity.leaves().into_iter().filter_map(of).collect();
    found.dedup();
    found
}

/// The bodies that a force acts on or is fixed to, but for the frame.
pub fn of_force(model: &Model, force: usize) -> Vec<Body> {
    let mut kind = model.forces[force].law.clone();
    let mut bodies: Vec<Body> = kind.bodies_mut().into_iter().map(|body| *body).collect();
    bodies.retain(|body| *body != Body::Frame);
    bodies.dedup();
    bodies
}

// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn plots(places: &[Measurand], units: &[&str], names: &[&str], sizes: &[f64]) -> Vec<Plot> {
    // each output joins the first group of its kind: together at a place, or alone
    let alone = |k: usize| {
        let same = (0..places.len()).filter(|j| places[*j] == places[k] && units[*j] == units[k]);
        same.count() == 1 || places[k].place.is_empty()
    };
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for k in 0..places.len() {
        let fits = |group: &&mut Vec<usize>| {
            let first = group[0];
            let kind = places[first].what == places[k].what && units[first] == units[k];
            kind && match alone(k) {
                true => alone(first),
                false => !alone(first) && places[first].place == places[k].place,
            }
        };
        match groups.iter_mut().find(fits) {
            Some(group) => group.push(k),
            None => groups.push(vec![k]),
        }
    }
    let mut plots = Vec::new();
    for mut group in groups {
        let Measurand { what, place } = &places[group[0]];
        let title = match group[..] {
            [only] => names[only].to_owned(),
            [first, ..] if alone(first) => what.clone(),
            _ => format!("{what}, {place}"),
        };
        let parts = group.len().div_ceil(MOST_CURVES);
        if parts > 1 {
            // small curves would lie on the axis beside large ones
            group.sort_by(|a, b| sizes[*b].total_cmp(&sizes[*a]));
        }
        let many = group.len().div_ceil(parts);
        for (part, curves) in group.chunks(many).enumerate() {
            let mut curves = curves.to_vec();
            curves.sort_unstable();
            plots.push(Plot {
                title: match parts {
                    1 => title.clone(),
                    _ => format!("{title}, {} of {parts}", part + 1),
                },
                what: what.clone(),
                unit: units[curves[0]].to_owned(),
                curves,
            });
        }
    }
    plots
}

fn place(model: &Model, quantity: &Quantity, unit: &str) -> Measurand {
    let of_element = |id: &ElementId| {
        let system = &model.systems[id.system];
        format!("{}/{}", system.name, system.elements[id.element].name)
    };
    let of_body = |body: &Body| match body {
        Body::Frame => String::new(),
        Body::Element(id) => of_element(id),
        Body::Vehicle(index) => model.vehicles[*index].name.clone(),
    };
    let (what, place) = match quantity {
        Quantity::Point { body, what, .. } => {
            let what = match what {
                PointQuantity::Position => "position",
                PointQuantity::Displacement => "displacement",
                PointQuantity::Velocity => "velocity",
                PointQuantity::Acceleration | PointQuantity::Accelerometer => "acceleration",
            };
            (what.to_owned(), of_body(body))
        }
        Quantity::Rotation { body, what, .. } => {
            let what = match what {
                RotationQuantity::Angle => "angle",
                RotationQuantity::AngularVelocity => "angular velocity",
                RotationQuantity::AngularAcceleration => "angular acceleration",
            };
            (what.to_owned(), of_body(body))
        }
        Quantity::JointLoad { element, what, .. } => {
            let what = match what {
                JointLoadQuantity::Force => "joint force",
                JointLoadQuantity::Moment => "joint moment",
            };
            (what.to_owned(), of_element(element))
        }
        Quantity::Freedom { element, what, .. } => {
            let what = match what {
                FreedomQuantity::Position => "joint position",
                FreedomQuantity::Rate => "joint rate",
                FreedomQuantity::Acceleration => "joint acceleration",
            };
            (what.to_owned(), of_element(element))
        }
        Quantity::ForceOn { force, .. }
        | Quantity::ForceOnPoints { force, .. }
        | Quantity::OfForce { force, .. } => {
            let force = &model.forces[*force];
            (
                format!("{} {}", force.law.key(), measure(unit)),
                force.name.clone(),
            )
        }
        Quantity::Switch { .. } => ("switch".to_owned(), String::new()),
        Quantity::System { system, what, .. } => {
            let what = match what {
                SystemQuantity::KineticEnergy => "kinetic energy",
                SystemQuantity::Momentum => "momentum",
                SystemQuantity::AngularMomentum => "angular momentum",
                SystemQuantity::Position => "centre of gravity",
            };
            (what.to_owned(), model.systems[*system].name.clone())
        }
        Quantity::Formula(_) => (measure(unit).to_owned(), String::new()),
    };
    Measurand {
        what: what.trim().to_owned(),
        place,
    }
}

/// The quantity that a unit measures, in words.
fn measure(unit: &str) -> &'static str {
    const WORDS: [(&str, &str); 11] = [
        ("N", "force"),
        ("N*m", "moment"),
        ("Pa", "pressure"),
        ("m", "length"),
        ("rad", "angle"),
        ("m/s", "velocity"),
        ("m/s^2", "acceleration"),
        ("rad/s", "angular velocity"),
        ("J", "energy"),
        ("W", "power"),
        ("kg", "mass"),
    ];
    let found = WORDS
        .iter()
        .find(|(si, _)| unit::factor(unit, si).is_some());
    found.map_or("value", |(_, word)| word)
}
