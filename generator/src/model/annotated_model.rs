//! A model together with everything that its text mentions, and the places in the text: the basis for explaining the
//! model.

use super::criteria::Criteria;
use super::mechanism::Model;
use super::resolve::Resolved;
use super::surface::Shown;
use crate::description::load::Loaded;
use crate::description::long_form::long_form;
use crate::description::place::At;
use crate::description::tree::NodeKind;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A model and its text.
#[derive(Clone, Debug)]
pub struct AnnotatedModel {
    /// The model in its normal form, from which code is generated.
    pub model: Model,
    /// The model with everything that the text mentions, including zeros and unused parts. Forces that are switched off
    /// come after the others.
    pub written: Model,
    /// Number of forces that are switched off: the last of `written`.
    pub off: usize,
    /// The criteria by which a run is judged, if the text has any.
    pub criteria: Option<Criteria>,
    /// The places of all parts in the text.
    pub places: SourceLines,
    /// Every file that was read, the model's own file first.
    pub read: Vec<PathBuf>,
    /// The model in its long form, as one file: lists, mirror images, named surfaces and instances written out.
    pub long_form: String,
    /// For a URDF file: sentences on parts that were left out, and other remarks.
    pub notes: Vec<String>,
}

impl AnnotatedModel {
    /// The scene of a model that was read from these texts.
    pub(crate) fn of(resolved: Resolved, loaded: Loaded) -> Self {
        AnnotatedModel {
            model: resolved.model,
            written: resolved.written,
            off: resolved.off,
            criteria: resolved.criteria,
            places: SourceLines::of(&loaded, &resolved.owners),
            long_form: long_form(&loaded),
            read: loaded.paths,
            notes: Vec::new(),
        }
    }

    /// Turns lines of the text that was read into lines of the file from which the text was made. Places without a line
    /// there are left out.
    pub(crate) fn turn_lines(&mut self, line_there: impl Fn(usize) -> Option<usize>) {
        self.places.keep(&line_there);
        for shown in self.model.shown.iter_mut().chain(&mut self.written.shown) {
            if let Shown::Mesh(mesh) = shown {
                mesh.line = line_there(mesh.line).unwrap_or_default();
            }
        }
    }
}

/// A line of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceLine {
    /// Name of the file, as it was given.
    pub file: String,
    /// Number of the line, from 1.
    pub line: usize,
    /// The text at this place: `friction: 0`; only the key if its value is long.
    pub text: String,
}

/// Places, by owner ("contact seat-back", "parameter mu", "element man/head", "model") and by the key below the owner
/// ("about.x.friction", "acceleration\[0\]"; "" for the owner itself).
#[derive(Clone, Debug, Default)]
pub struct SourceLines {
    places: BTreeMap<String, BTreeMap<String, SourceLine>>,
}

/// Values longer than this are not shown \[characters\].
const LONGEST_TEXT: usize = 32;

impl SourceLines {
    /// Replaces each line number by that of another text, and drops places without a line in that text.
    fn keep(&mut self, line_there: impl Fn(usize) -> Option<usize>) {
        for keys in self.places.values_mut() {
            keys.retain(|_, place| {
                let line = line_there(place.line);
                place.line = line.unwrap_or(place.line);
                line.is_some()
            });
        }
    }

    /// The place of a key of an owner.
    pub fn get(&self, owner: &str, key: &str) -> Option<&SourceLine> {
        self.places.get(owner)?.get(key)
    }

    /// The names of the owners of a kind ("parameter"), in no meaningful order.
    pub fn of_kind<'a>(&'a self, kind: &'a str) -> impl Iterator<Item = &'a str> {
        let name = move |owner: &'a String| owner.strip_prefix(kind)?.strip_prefix(' ');
        self.places.keys().filter_map(name)
    }

    /// The places of all parts; `owners` has the law and the name of each force.
    fn of(loaded: &Loaded, owners: &[String]) -> Self {
        let mut owners = owners.iter();
        let mut places = SourceLines::default();
        for file in &loaded.files {
            let top = file.source.at();
            if let Some(last) = loaded.files.last()
                && std::ptr::eq(last, file)
            {
                for key in ["dimension", "coordinates", "run"] {
                    if top.node.get(key).is_some() {
                        places.enter("model", key, top.key(key));
                    }
                }
            }
            let contents = &file.contents;
            for (name, _) in contents.parameters.iter().flat_map(|p| &p.0) {
                places.enter(
                    &format!("parameter {name}"),
                    "",
                    top.key("parameters").key(name),
                );
            }
            for (name, _) in contents.curves.iter().flat_map(|c| &c.0) {
                places.enter(&format!("curve {name}"), "", top.key("curves").key(name));
            }
            for (index, system) in contents.systems.iter().flatten().enumerate() {
                let at = top.key("systems").item(index);
                let owner = format!("system {}", system.name);
                places.enter(&owner, "", at);
                places.below(&owner, "", at, &["elements"]);
                for (index, element) in system.elements.iter().flatten().enumerate() {
                    let at = at.key("elements").item(index);
                    let owner = format!("element {}/{}", system.name, element.name);
                    places.enter(&owner, "", at);
                    places.below(&owner, "", at, &[]);
                }
            }
            for index in 0..contents.forces.iter().flatten().count() {
                let at = top.key("forces").item(index);
                let Some(owner) = owners.next() else { break };
                places.enter(owner, "", at);
                places.below(owner, "", at, &[]);
            }
            for (index, output) in contents.outputs.iter().flatten().enumerate() {
                let at = top.key("outputs").item(index);
                let owner = format!("output {}", output.name());
                places.enter(&owner, "", at);
                places.below(&owner, "", at, &[]);
            }
        }
        places
    }

    /// Adds everything below a place. If several files have the same key, the last one counts.
    fn below(&mut self, owner: &str, prefix: &str, at: At<'_>, but: &[&str]) {
        match &at.node.kind {
            NodeKind::Scalar { .. } => {}
            NodeKind::List(items) => {
                for index in 0..items.len() {
                    let (key, item) = (format!("{prefix}[{index}]"), at.item(index));
                    self.enter(owner, &key, item);
                    self.below(owner, &key, item, but);
                }
            }
            NodeKind::Map(entries) => {
                for entry in entries {
                    // There are many points, and none of them is an effect.
                    if entry.key == "points" || but.contains(&entry.key.as_str()) {
                        continue;
                    }
                    let separator = if prefix.is_empty() { "" } else { "." };
                    let (key, value) = (
                        format!("{prefix}{separator}{}", entry.key),
                        at.key(&entry.key),
                    );
                    self.enter(owner, &key, value);
                    self.below(owner, &key, value, but);
                }
            }
        }
    }

    fn enter(&mut self, owner: &str, key: &str, at: At<'_>) {
        let name = key.rsplit('.').next().unwrap_or_default();
        let text = match &at.node.kind {
            NodeKind::Scalar { text, .. }
                if text.chars().count() <= LONGEST_TEXT && !name.is_empty() =>
            {
                format!("{name}: {}", text.escape_debug())
            }
            _ => name.to_owned(),
        };
        let place = SourceLine {
            file: at.source.name.clone(),
            line: at.of_key().line,
            text,
        };
        let keys = self.places.entry(owner.to_owned()).or_default();
        keys.insert(key.to_owned(), place);
    }
}

impl std::fmt::Display for SourceLine {
    /// Writes `models/sled.yaml:12`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}", self.file, self.line)
    }
}
