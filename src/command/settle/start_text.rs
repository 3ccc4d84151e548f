//! Writes a state of rest as `start:` of the systems of a model.

use crate::orientation::WithoutCharts;
use crate::pose::{Layout, Pose, Vec3};
use bryant_generator::model::{ElementId, Joint, Model, Reference};
use bryant_runtime::Info;
use bryant_runtime::program::Header;
use std::fmt::Write as _;

/// The systems with their starts, as a part of a model's file.
///
/// # Errors
/// The coordinates do not fit the model.
pub fn start(
    model: &Model,
    info: &Info<'_>,
    parameters: &[f64],
    state: &[f64],
) -> Result<String, String> {
    let without = WithoutCharts::of(&Header::of(info));
    let q = without.q(state);
    let layout = Layout::new(model, &without.coordinates).map_err(|error| error.to_string())?;
    let pose = Pose::new(model, &layout, parameters, 0.0, &q).ok_or("the state is too short")?;
    let of = |names: &[&str], name: &str| names.iter().position(|one| *one == name);
    let coordinate = |name: String| of(info.coordinates, &name).map(|index| state[index]);
    let velocity = |name: String| {
        of(info.velocities, &name).map(|index| state[info.coordinates.len() + index])
    };
    let vector = |letter: &str, system: &str, find: &dyn Fn(String) -> Option<f64>| {
        let axes = ["x", "y", "z"].map(|axis| find(format!("{system}.{letter}{axis}")));
        let all: Vec<f64> = axes.into_iter().flatten().collect();
        (!all.is_empty()).then(|| list(&all))
    };
    let mut text = String::from(
        "# A state of rest. Belts count their slack and pretension from this start, and memory of laws, such as friction that holds, begins anew.\nsystems:\n",
    );
    for (s, system) in model.systems.iter().enumerate() {
        let _ = writeln!(text, "  - name: {}\n    start:", system.name);
        if matches!(system.reference, Reference::Free) {
            if let Some(position) = vector("", &system.name, &coordinate) {
                let _ = writeln!(text, "      position: {position}");
            }
            if let Some(velocity) = vector("v", &system.name, &velocity) {
                let _ = writeln!(text, "      velocity: {velocity}");
            }
        }
        let (mut angles, mut joints) = (Vec::new(), Vec::new());
        for (e, element) in system.elements.iter().enumerate() {
            let id = ElementId {
                system: s,
                element: e,
            };
            let name = &element.name;
            let owner = format!("{}/{name}.", system.name);
            let own = info
                .coordinates
                .iter()
                .zip(state)
                .filter(|(one, _)| one.starts_with(&owner));
            let own: Vec<f64> = own.map(|(_, value)| *value).collect();
            match own[..] {
                [] => {}
                [one] if element.joint == Joint::Ball => {
                    angles.push(format!("{name}: {}", plain(one)))
                }
                _ if element.joint == Joint::Ball => {
                    let shown = bryant(pose.frame(id).rotation);
                    angles.push(format!("{name}: {}", list(&shown)));
                }
                [one] => joints.push(format!("{name}: {}", plain(one))),
                _ => joints.push(format!("{name}: {}", list(&own))),
            }
        }
        for (key, entries) in [("angles", angles), ("joints", joints)] {
            if !entries.is_empty() {
                let _ = writeln!(text, "      {key}: {{ {} }}", entries.join(", "));
            }
        }
    }
    Ok(text)
}

/// The Bryant angles of a rotation, which is given by rows \[rad\].
fn bryant([first, second, third]: [Vec3; 3]) -> Vec3 {
    [
        libm::atan2(-second[2], third[2]),
        libm::asin(first[2].clamp(-1.0, 1.0)),
        libm::atan2(-first[1], first[0]),
    ]
}

fn list(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| plain(*value)).collect();
    format!("[{}]", values.join(", "))
}

/// A number with all its digits, as a model may contain it.
fn plain(value: f64) -> String {
    format!("{:?}", value + 0.0)
}
