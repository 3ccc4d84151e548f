//! The state of a run as a file: written at the end of one run, read at the start of another.
//!
//! ```json
//! {
//!   "model": "sled-pendulum",
//!   "time": 0.05,
//!   "coordinates": { "arm.phi": 0.1, … },
//!   "velocities": { "arm.omega": 2.0, … },
//!   "laws": { … },
//!   "memory": { … }
//! }
//! ```
//!
//! All numbers are in SI units and have all digits of a double; their names are those of [`Info`]. `laws` has the continuous states of
//! force laws, `memory` their discrete states; a group that the model does not have may be left out.

use crate::simulation::Recording;
use bryant_generator::description::load::read_file;
use bryant_runtime::Info;
use bryant_runtime::program::Start;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::fmt::{self, Write};
use std::path::Path;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(rename = "model")]
    _model: Option<String>,
    time: f64,
    coordinates: Group,
    velocities: Group,
    #[serde(default)]
    laws: Group,
    #[serde(default)]
    memory: Group,
}

/// Numbers by name, each name once.
#[derive(Default)]
struct Group(BTreeMap<String, f64>);

impl<'de> Deserialize<'de> for Group {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Once;
        impl<'de> Visitor<'de> for Once {
            type Value = Group;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("numbers by name")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Group, A::Error> {
                let mut group = BTreeMap::new();
                while let Some(name) = entries.next_key::<String>()? {
                    // checked before the value is read, so that the error shows the place of the name
                    if group.contains_key(&name) {
                        return Err(A::Error::custom(format_args!("\"{name}\" is given twice")));
                    }
                    group.insert(name, entries.next_value()?);
                }
                Ok(Group(group))
            }
        }
        deserializer.deserialize_map(Once)
    }
}

/// The last state of a run, which must have one, as the text of a file.
pub fn text(recording: &Recording) -> String {
    let header = &recording.header;
    let names = [
        &header.coordinates,
        &header.velocities,
        &header.auxiliaries,
        &header.memory,
    ]
    .map(|names| names.iter().map(String::as_str).collect());
    of_groups(
        &header.name,
        names,
        recording.last_time(),
        &recording.last_state,
    )
}

/// A state of a model, with its time \[s\], as the text of a file.
pub fn of_state(model: &str, info: &Info, time: f64, state: &[f64]) -> String {
    let names = [
        info.coordinates,
        info.velocities,
        info.auxiliaries,
        info.memory,
    ]
    .map(<[_]>::to_vec);
    of_groups(model, names, time, state)
}

fn of_groups(model: &str, names: [Vec<&str>; 4], time: f64, state: &[f64]) -> String {
    let mut text = String::from("{\n");
    let name = |name: &str| serde_json::Value::from(name).to_string();
    let _ = writeln!(text, "  \"model\": {},", name(model));
    let _ = write!(text, "  \"time\": {:?}", time);
    let mut rest = state;
    let groups = ["coordinates", "velocities", "laws", "memory"];
    for (group, names) in groups.into_iter().zip(names) {
        let (values, others) = rest.split_at(names.len());
        rest = others;
        let entries = names.iter().zip(values);
        let entries = entries.map(|(entry, value)| format!("    {}: {value:?}", name(entry)));
        let entries: Vec<String> = entries.collect();
        let _ = match entries.is_empty() {
            true => write!(text, ",\n  \"{group}\": {{}}"),
            false => write!(text, ",\n  \"{group}\": {{\n{}\n  }}", entries.join(",\n")),
        };
    }
    text.push_str("\n}\n");
    text
}

/// Reads a state of a model.
///
/// # Errors
/// The file cannot be read or is not a state, or names are missing in the model or in the file; the message has the file, the names and a
/// remedy.
pub fn read(path: &Path, info: &Info) -> Result<Start, String> {
    let shown = path.display();
    let text =
        read_file(path).map_err(|error| format!("cannot read the state {shown}: {error}"))?;
    of_text(&text, info).map_err(|error| format!("{shown}: {error}"))
}

fn of_text(text: &str, info: &Info) -> Result<Start, String> {
    let file: File = serde_json::from_str(text).map_err(|error| {
        format!("this is no state: {error}\n  help: --final-state of `bryant run` writes one")
    })?;
    let groups = [
        ("coordinates", info.coordinates, file.coordinates.0),
        ("velocities", info.velocities, file.velocities.0),
        ("laws", info.auxiliaries, file.laws.0),
        ("memory", info.memory, file.memory.0),
    ];
    let mut state = Vec::with_capacity(info.state_length());
    let (mut missing, mut unknown) = (Vec::new(), Vec::new());
    for (group, names, mut values) in groups {
        for name in names {
            match values.remove(*name) {
                Some(value) => state.push(value),
                None => missing.push(*name),
            }
        }
        unknown.extend(values.into_keys().map(|name| format!("{name} ({group})")));
    }
    let (count, wrong) = match (missing.is_empty(), unknown.is_empty()) {
        (true, true) => {
            return Ok(Start {
                t: file.time,
                state,
            });
        }
        (false, _) => (missing.len(), format!("it lacks {}", few(&missing))),
        (true, false) => (
            unknown.len(),
            format!("{} has no {}", info.name, few(&unknown)),
        ),
    };
    let entries = if count == 1 { "entry" } else { "entries" };
    Err(format!(
        "this is not a state of {}: {wrong} ({count} {entries})\n  \
         help: a state has every coordinate, velocity, state and memory of a law, by name; start from one of a model with the same \
         elements, joints and laws",
        info.name
    ))
}

/// Some of many names.
fn few<T: AsRef<str>>(names: &[T]) -> String {
    let mut text: Vec<&str> = names.iter().take(5).map(AsRef::as_ref).collect();
    if names.len() > 5 {
        text.push("…");
    }
    text.join(", ")
}
