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
//! All numbers are in SI units and have all digits of a double; their names are those of [`Info`]. `laws` has the
//! continuous states of force laws, `memory` their discrete states; a group that the model does not have may be left
//! out. A state may also start another, similar model: entries are found by their names.

use crate::orientation;
use crate::simulation::Recording;
use bryant_generator::description::load::read_file;
use bryant_runtime::Info;
use bryant_runtime::program::Start;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::{BTreeMap, BTreeSet};
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

/// A state of a model at a time \[s\], as the text of a file.
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

/// A state that was read, with remarks.
#[derive(Debug)]
pub struct Read {
    /// The state, with its time.
    pub start: Start,
    /// Sentences about differences between the file and the model.
    pub notes: Vec<String>,
}

/// Reads a state of a model, or of a similar model. Some entries may be missing in the file or in the model: those of a
/// system that only one of the two has, and states and memory of laws. Entries that the file lacks are taken from
/// `own`, the start of the model; entries that the model lacks are ignored; notes name both. Orientations are converted
/// between quaternions and Bryant angles if necessary. `end` is the time at which the run ends \[s\].
///
/// # Errors
/// The file cannot be read or is not a state, its time is negative or not before the end of the run, file and model
/// have no system in common, or only some of the entries of a system are in one of them. The message has the file, the
/// names and a remedy.
pub fn read(path: &Path, info: &Info, own: &[f64], end: f64) -> Result<Read, String> {
    let shown = path.display();
    let (text, file) = file(path)?;
    if !(0.0..end).contains(&file.time) {
        let place = text.lines().position(|line| line.contains("\"time\""));
        let line = place.map_or(String::new(), |line| format!(":{}", line + 1));
        return Err(format!(
            "{shown}{line}: the time of the state is {} s, but a run that begins there must begin at 0 s or later, and before its end at {end} s\n  \
             help: write the time that the state belongs to (0 of a state of rest), or give a later --duration",
            file.time
        ));
    }
    taken_over(file, info, own)
        .map(|(start, notes)| Read {
            start,
            notes: notes
                .into_iter()
                .map(|note| format!("{shown}: {note}"))
                .collect(),
        })
        .map_err(|error| format!("{shown}: {error}"))
}

/// The time of the state in a file \[s\].
///
/// # Errors
/// The file cannot be read, or it is no state.
pub fn time(path: &Path) -> Result<f64, String> {
    file(path).map(|(_, file)| file.time)
}

/// The text of a file, and the state in it.
fn file(path: &Path) -> Result<(String, File), String> {
    let shown = path.display();
    let text =
        read_file(path).map_err(|error| format!("cannot read the state {shown}: {error}"))?;
    let file = serde_json::from_str(&text).map_err(|error| {
        format!(
            "{shown}: this is no state: {error}\n  help: --final-state of `bryant run` writes one"
        )
    })?;
    Ok((text, file))
}

/// The name of the system of a coordinate or a velocity.
fn system_of(name: &str) -> Option<&str> {
    name.find(['/', '.']).map(|end| &name[..end])
}

fn taken_over(file: File, info: &Info, own: &[f64]) -> Result<(Start, Vec<String>), String> {
    let mut groups = [
        file.coordinates.0,
        file.velocities.0,
        file.laws.0,
        file.memory.0,
    ];
    let own_names = [
        info.coordinates,
        info.velocities,
        info.auxiliaries,
        info.memory,
    ];
    convert(&mut groups, own_names);
    let systems = |names: &mut dyn Iterator<Item = &str>| -> BTreeSet<String> {
        names.filter_map(system_of).map(str::to_owned).collect()
    };
    let given = systems(
        &mut groups[..2]
            .iter()
            .flat_map(|group| group.keys().map(String::as_str)),
    );
    let known = systems(
        &mut own_names[..2]
            .iter()
            .flat_map(|names| names.iter().copied()),
    );
    let strange = known.is_disjoint(&given) && !known.is_empty();
    let belongs =
        |name: &str, to: &BTreeSet<String>| system_of(name).is_none_or(|s| to.contains(s));

    let mut state = own.to_vec();
    let (mut missing, mut unknown) = (Vec::new(), Vec::new());
    let (mut begin, mut left) = (Vec::new(), Vec::new());
    let mut index = 0;
    for (place, (names, values)) in own_names.iter().zip(&mut groups).enumerate() {
        let of_bodies = place < 2;
        for name in *names {
            match values.remove(*name) {
                Some(value) => state[index] = value,
                None if of_bodies && (strange || belongs(name, &given)) => missing.push(*name),
                None => begin.push((*name).to_owned()),
            }
            index += 1;
        }
        let group = ["coordinates", "velocities", "laws", "memory"][place];
        for name in std::mem::take(values).into_keys() {
            match of_bodies && belongs(&name, &known) {
                true => unknown.push(format!("{name} ({group})")),
                false => left.push(name),
            }
        }
    }
    let entries =
        |count: usize| format!("{count} {}", if count == 1 { "entry" } else { "entries" });
    let wrong = match (missing.is_empty(), unknown.is_empty()) {
        (true, true) => {
            let name = info.name;
            let mut notes = Vec::new();
            if !begin.is_empty() {
                notes.push(format!(
                    "the state lacks {}, of what only {name} has; these begin as at its start: {}",
                    entries(begin.len()),
                    few(&begin)
                ));
            }
            if !left.is_empty() {
                notes.push(format!(
                    "the state has {} of what {name} does not have, and which are left out: {}",
                    entries(left.len()),
                    few(&left)
                ));
            }
            let t = file.time;
            return Ok((Start { t, state }, notes));
        }
        (false, _) => format!("it lacks {} ({})", few(&missing), entries(missing.len())),
        (true, false) => format!(
            "{} has no {} ({})",
            info.name,
            few(&unknown),
            entries(unknown.len())
        ),
    };
    Err(format!(
        "this is not a state of {}: {wrong}\n  \
         help: a state has every coordinate and velocity of a system, by name; start from one of a model with the same elements and joints",
        info.name
    ))
}

/// Converts quaternions and angular velocities to Bryant angles and their rates, or vice versa, if the model has the
/// other kind.
fn convert(groups: &mut [BTreeMap<String, f64>; 4], own_names: [&[&str]; 4]) {
    for name in own_names[0] {
        let (Some(of), to_angles) = (match name.strip_suffix(".phi1") {
            Some(element) => (Some(element), true),
            None => (name.strip_suffix(".qw"), false),
        }) else {
            continue;
        };
        let names =
            |letter: &str, parts: [&str; 3]| parts.map(|part| format!("{of}.{letter}{part}"));
        let axes = ["x", "y", "z"];
        let numbers = ["1", "2", "3"];
        let [q, w] = [names("q", axes), names("w", axes)];
        let [phi, rates] = [names("phi", numbers), names("dphi", numbers)];
        let (real, chart) = (format!("{of}.qw"), format!("{of}: chart"));
        let [coordinates, velocities, _, memory] = groups;
        let three = |group: &BTreeMap<String, f64>, names: &[String; 3]| -> Option<[f64; 3]> {
            let values = names.each_ref().map(|name| group.get(name).copied());
            Some([values[0]?, values[1]?, values[2]?])
        };
        let replace = |group: &mut BTreeMap<String, f64>,
                       old: &[String; 3],
                       new: [String; 3],
                       values: [f64; 3]| {
            old.iter().for_each(|name| {
                group.remove(name);
            });
            group.extend(new.into_iter().zip(values));
        };
        if to_angles {
            let (Some(scalar), Some([x, y, z]), Some(omega)) = (
                coordinates.get(&real).copied(),
                three(coordinates, &q),
                three(velocities, &w),
            ) else {
                continue;
            };
            let (angles, of_angles, of_chart) = orientation::in_chart([scalar, x, y, z], omega);
            coordinates.remove(&real);
            replace(coordinates, &q, phi, angles);
            replace(velocities, &w, rates, of_angles);
            memory.insert(chart, of_chart);
        } else {
            let (Some(angles), Some(of_angles)) =
                (three(coordinates, &phi), three(velocities, &rates))
            else {
                continue;
            };
            let chart = memory.remove(&chart).unwrap_or(0.0);
            let ([scalar, x, y, z], omega) = orientation::without_chart(angles, of_angles, chart);
            coordinates.insert(real, scalar);
            replace(coordinates, &phi, q, [x, y, z]);
            replace(velocities, &rates, w, omega);
        }
    }
}

/// The first five of the names.
fn few<T: AsRef<str>>(names: &[T]) -> String {
    let mut text: Vec<&str> = names.iter().take(5).map(AsRef::as_ref).collect();
    if names.len() > 5 {
        text.push("…");
    }
    text.join(", ")
}
