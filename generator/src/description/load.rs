//! From a file and those it includes to descriptions with their places.

use super::criteria::Criteria;
use super::curve::{self, Curve};
use super::expand::instance::rename;
use super::expand::{Known, expand};
use super::file_content;
use super::force::Force;
use super::language::Language;
use super::mend::{Lost, mend, take_out};
use super::mesh::Meshes;
use super::output::Column;
use super::parameter::ParameterEntry;
use super::part;
use super::person;
use super::place::At;
use super::run::Run;
use super::schema::{Schema, numbers};
use super::shape::{Misfit, Named, Problems, Record, Shape, misfit, record, words};
use super::short_forms::{Include, Mirror};
use super::surface::Surface;
use super::switch::Switch;
use super::system::System;
use super::table::Table;
use super::tree::{MAX_BYTES, Node, NodeKind, Source};
use super::vehicle::Vehicle;
use crate::diagnostic::{Diagnostic, Diagnostics, quoted, suggestion};
use bryant_table::mme::{self, NoChannel, Test, Wrong};
use serde_yaml::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Component, Path, PathBuf};

/// Most files that one model is read from.
const MAX_FILES: usize = 64;

record! {
    /// A model.
    Model as "a model" {
        /// name of the model, words joined by dashes
        model: String,
        /// one sentence for listings
        title: Option<String> = "empty",
        /// `2`: motion in the x–z plane; `3`: in space
        dimension: Dimension,
        /// in space only. `quaternion`: four numbers and the angular velocity; `bryant`: the [angles of the
        /// formalism](#charts-of-bryant-angles) and their rates
        coordinates: Option<Coordinates> = "`quaternion`",
        /// `SI` or `engineering`: the [units](#units-of-outputs) in which outputs are shown
        units: Option<Units> = "`SI`",
        /// files to read first, with paths relative to this file, whose parts are joined by `/` or, as on Windows, by
        /// `\`, on every system; see [an included file](#an-included-file); or [instances](#an-instance) of them
        include: Option<Vec<Include>>,
        /// [parameters](#a-parameter) by name
        parameters: Option<Named<ParameterEntry>>,
        /// [inputs](#inputs) by name: numbers that change from outside during a run
        inputs: Option<Named<ParameterEntry>>,
        /// [curves](#a-curve) by name
        curves: Option<Named<Curve>>,
        /// how [two sides](#a-mirror) correspond
        mirror: Option<Mirror> = "left, right",
        /// [ellipsoids and planes](#named-surfaces) by name
        surfaces: Option<Named<Surface>>,
        /// lists of surfaces by name
        groups: Option<Named<Vec<String>>>,
        /// [meshes](#a-mesh) that stand in the absolute frame
        mesh: Option<Meshes>,
        /// list of [vehicles](#a-vehicle), bodies whose motion is given
        vehicles: Option<Vec<Vehicle>>,
        /// list of [systems](#a-system)
        systems: Option<Vec<System>> = "those included",
        /// list of forces: [joint](#a-joint-force), [field](#a-field), [contact](#a-contact), [belt](#a-belt),
        /// [spring](#a-spring), [bushing](#a-bushing), [airbag](#an-airbag), [load](#a-load), [user](#a-user-force)
        forces: Option<Vec<Force>>,
        /// list of [switches](#a-switch)
        switches: Option<Vec<Switch>>,
        /// list of [outputs](#an-output), the columns of the table
        outputs: Option<Vec<Column>>,
        /// [duration and sampling](#a-run)
        run: Option<Run> = "1 s, every 10 ms",
        /// the [injury criteria](#a-set-of-criteria) that judge a run
        criteria: Option<Criteria>,
    }
}

record! {
    /// A file that others include.
    Included as "an included file" {
        /// files to read first, relative to this one, or instances of them
        include: Option<Vec<Include>>,
        /// as in a model; all files share their names
        parameters: Option<Named<ParameterEntry>>,
        /// as in a model
        inputs: Option<Named<ParameterEntry>>,
        /// as in a model
        curves: Option<Named<Curve>>,
        /// for this file alone
        mirror: Option<Mirror> = "left, right",
        /// as in a model
        surfaces: Option<Named<Surface>>,
        /// as in a model
        groups: Option<Named<Vec<String>>>,
        /// as in a model
        mesh: Option<Meshes>,
        /// as in a model
        vehicles: Option<Vec<Vehicle>>,
        /// as in a model
        systems: Option<Vec<System>>,
        /// as in a model
        forces: Option<Vec<Force>>,
        /// as in a model
        switches: Option<Vec<Switch>>,
        /// as in a model
        outputs: Option<Vec<Column>>,
    }
}

words! {
    /// A system of units.
    Units {
        /// m, N, rad, s, …
        Si = "SI",
        /// mm, g, kN, °, kPa, ms.
        Engineering = "engineering",
    }
}

words! {
    /// Coordinates of orientation.
    Coordinates {
        /// Unit quaternions.
        Quaternion = "quaternion",
        /// Bryant angles.
        Bryant = "bryant",
    }
}

/// Number of space dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// The x–z plane.
    Plane,
    /// Space.
    Space,
}

impl Shape for Dimension {
    fn schema(_: &mut Schema) -> Value {
        numbers(&[2, 3])
    }

    fn check(at: At<'_>, problems: &Problems) {
        match &at.node.kind {
            NodeKind::Scalar { text, .. } if ["2", "3"].contains(&text.as_str()) => {}
            _ => problems.add(at.problem(
                "a model moves in the plane or in space",
                "write `2` for the x–z plane, or `3` for space",
            )),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        match value.as_u64() {
            Some(2) => Ok(Dimension::Plane),
            Some(3) => Ok(Dimension::Space),
            _ => Err(misfit(value, "the dimension, 2 or 3,")),
        }
    }
}

/// The kind of a file, and what else it may be.
trait Document: Record {
    /// What it is in place of this, if that is known, and what to do with it.
    fn instead(root: &Node, name: &str) -> Option<file_content::What>;
}

impl Document for Model {
    fn instead(root: &Node, name: &str) -> Option<file_content::What> {
        file_content::instead_of_model(root, name)
    }
}

impl Document for Included {
    fn instead(root: &Node, name: &str) -> Option<file_content::What> {
        file_content::instead_of_part(root, name)
    }
}

/// What a model file says beside its contents.
#[derive(Clone, Debug)]
pub struct Header {
    /// Name.
    pub model: String,
    /// Title.
    pub title: Option<String>,
    /// Plane or space.
    pub dimension: Dimension,
    /// Coordinates of orientation.
    pub coordinates: Option<Coordinates>,
    /// The system of units in which outputs are shown.
    pub units: Option<Units>,
    /// Duration and sampling.
    pub run: Option<Run>,
    /// By what a run is judged.
    pub criteria: Option<Criteria>,
}

/// A file and what it says.
#[derive(Debug)]
pub struct File {
    /// Text and places.
    pub source: Source,
    /// What it says; of the model file without its header.
    pub contents: Included,
}

/// A model and what it includes.
#[derive(Debug)]
pub struct Loaded {
    /// Of the model file.
    pub header: Header,
    /// Included files first, each before those that include it; the model file last.
    pub files: Vec<File>,
    /// Files with the points of curves, by their path as [`beside`] gives it.
    pub tables: BTreeMap<PathBuf, Table>,
    /// Rust files with the user's own forces, by their path as [`beside`] gives it.
    pub sources: BTreeMap<PathBuf, String>,
    /// Every file in the order read, the model file first.
    pub paths: Vec<PathBuf>,
    /// What is wrong; the rest was read without it, so that mistakes there are found, too.
    pub problems: Vec<Diagnostic>,
    /// What is missing for that reason.
    pub lost: Lost,
}

/// Opens a file to be read, behind links; what is no file, a folder, a device or a pipe, is refused: it may have no
/// end.
pub fn open_file(path: &Path) -> io::Result<std::fs::File> {
    let refused = || io::Error::other("it is not a file");
    // Asked before opening, which would wait for whoever writes to a pipe.
    if !std::fs::metadata(path)?.is_file() {
        return Err(refused());
    }
    let file = std::fs::File::open(path)?;
    // it may be another since
    match file.metadata()?.is_file() {
        true => Ok(file),
        false => Err(refused()),
    }
}

/// Where the table of a channel of a test is kept.
pub fn channel_key(mme: &Path, code: &str) -> PathBuf {
    mme.join(code)
}

/// Reads a file's text, at most [`MAX_BYTES`] and a little: UTF-8, or, of tests in ISO-MME, ISO 8859-1.
pub fn read_file(path: &Path) -> io::Result<String> {
    use io::Read;
    let mut bytes = Vec::new();
    let file = open_file(path)?;
    file.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    let is =
        |name: Option<&std::ffi::OsStr>, word| name.is_some_and(|n| n.eq_ignore_ascii_case(word));
    let of_test =
        is(path.extension(), "mme") || is(path.parent().and_then(Path::file_name), "channel");
    if of_test {
        return Ok(mme::decoded(bytes));
    }
    String::from_utf8(bytes).map_err(|error| match file_content::of_bytes(error.as_bytes()) {
        Some(what) => io::Error::new(io::ErrorKind::InvalidData, what),
        None => io::ErrorKind::InvalidData.into(),
    })
}

/// A fault of a test in ISO-MME: in its file, or, if that cannot be read, where the model names it.
fn in_test(at: At<'_>, wrong: Wrong) -> Diagnostic {
    match wrong {
        Wrong::Io { path, error } => {
            let (message, help) = unreadable(&shown(&path), &error);
            at.problem(message, help)
        }
        Wrong::Content { path, text, fault } => {
            let place = (fault.line, fault.column, fault.length);
            Diagnostic::at(&shown(&path), &text, place, fault.message, fault.help)
        }
    }
}

/// A channel of a test as a table, and the files that it is read from. `at` is the curve that names it.
fn channel_of(test: &Test, code: &str, at: At<'_>) -> Result<(Table, Vec<PathBuf>), Diagnostic> {
    let names = test.names();
    let index = mme::find(&names, code).map_err(|error| {
        let codes = names.iter().map(|(name, _)| *name);
        let (message, help) = match error {
            NoChannel::Unknown => (
                format!("the test has no channel {}", quoted(code)),
                suggestion(code, codes, "the names of its channels are their codes"),
            ),
            NoChannel::Several(count) => (
                format!("the test has {count} channels {}", quoted(code)),
                "give every channel a name of its own".to_owned(),
            ),
        };
        at.key("channel").problem(message, help)
    })?;
    let channel = test.channel(index);
    let channel = channel.map_err(|wrong| in_test(at.key("channel"), wrong))?;
    let (file, text) = test.file(index);
    let paths = test.paths(index).into_iter().map(Path::to_owned);
    let table = Table::of_channel(&shown(file), text, &channel)?;
    Ok((table, paths.collect()))
}

/// Reads a file of at most so many bytes; a longer one is an error.
pub fn read_bytes(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    use io::Read;
    let mut bytes = Vec::new();
    open_file(path)?.take(most + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > most {
        true => Err(io::Error::other(format!("it is longer than {most} bytes"))),
        false => Ok(bytes),
    }
}

/// A file that could not be read, as a message and its remedy.
pub fn unreadable(path: &str, error: &io::Error) -> (String, &'static str) {
    match error.kind() {
        io::ErrorKind::NotFound => (
            format!("there is no file {}", quoted(path)),
            "look at the path; paths of included files are relative to the file that includes them",
        ),
        io::ErrorKind::InvalidData => match error.get_ref() {
            Some(what) if what.to_string().starts_with("text in") => (
                format!("the file {} is {what}, not in UTF-8", quoted(path)),
                "save it as UTF-8",
            ),
            Some(what) => (
                format!("the file {} is {what}", quoted(path)),
                "name a file that is text",
            ),
            None => (
                format!("the file {} is not text in UTF-8", quoted(path)),
                "save it as UTF-8",
            ),
        },
        _ => (
            format!("the file {} cannot be read: {error}", quoted(path)),
            "look at its kind and its permissions",
        ),
    }
}

/// Parses a model and all that it includes; whether the Rust files of user forces are read is chosen.
///
/// # Errors
/// All problems, where so little is left without what is wrong that nothing can be said of it; other problems are part
/// of the result.
pub fn load(
    language: &'static Language,
    name: &str,
    text: &str,
    loader: &dyn Fn(&Path) -> io::Result<String>,
    with_sources: bool,
) -> Result<Loaded, Diagnostics> {
    let mut reader = Reader {
        loader,
        with_sources,
        problems: Problems::new(language),
        files: Vec::new(),
        tables: BTreeMap::new(),
        tests: BTreeMap::new(),
        sources: BTreeMap::new(),
        paths: Vec::new(),
        included: BTreeSet::new(),
        persons: BTreeSet::new(),
        open: Vec::new(),
        planar: false,
        known: Known::default(),
        lost: Lost::default(),
        unread: false,
    };
    let header = reader.model(name, text);
    let (problems, _) = reader.problems.into_parts();
    match header {
        Some(header) if problems.is_empty() || !reader.unread => Ok(Loaded {
            header,
            files: reader.files,
            tables: reader.tables,
            sources: reader.sources,
            paths: reader.paths,
            problems,
            lost: reader.lost,
        }),
        _ => Err(Diagnostics { problems }),
    }
}

struct Reader<'a> {
    loader: &'a dyn Fn(&Path) -> io::Result<String>,
    with_sources: bool,
    problems: Problems,
    files: Vec<File>,
    tables: BTreeMap<PathBuf, Table>,
    /// Tests in ISO-MME that curves name, by their path.
    tests: BTreeMap<PathBuf, Test>,
    sources: BTreeMap<PathBuf, String>,
    paths: Vec<PathBuf>,
    /// The files read already, with the name of their system where another was asked for.
    included: BTreeSet<(PathBuf, Option<String>)>,
    /// Names of the people that were made.
    persons: BTreeSet<String>,
    /// The files whose includes are being read.
    open: Vec<PathBuf>,
    planar: bool,
    /// What short forms refer to.
    known: Known,
    /// What is missing of what was read, because it is wrong.
    lost: Lost,
    /// Whether a whole file is missing.
    unread: bool,
}

impl Reader<'_> {
    fn model(&mut self, name: &str, text: &str) -> Option<Header> {
        let path = normal(Path::new(name));
        self.paths.push(path.clone());
        if let Some((what, help)) = file_content::of_text(text) {
            self.problems.add(Diagnostic::of_file(
                name,
                format!("this is {what}, no model"),
                help,
            ));
            return None;
        }
        let mut source = self.checked::<Model>(name, text)?;
        self.planar = source.root.get("dimension").and_then(Node::text) == Some("2");
        self.includes(path, &source);
        self.expand(&mut source);
        let model: Model = self.typed(&source)?;
        let contents = Included {
            include: model.include,
            parameters: model.parameters,
            inputs: model.inputs,
            curves: model.curves,
            mirror: model.mirror,
            surfaces: model.surfaces,
            groups: model.groups,
            mesh: model.mesh,
            vehicles: model.vehicles,
            systems: model.systems,
            forces: model.forces,
            switches: model.switches,
            outputs: model.outputs,
        };
        self.contents(source, contents);
        Some(Header {
            model: model.model,
            title: model.title,
            dimension: model.dimension,
            coordinates: model.coordinates,
            units: model.units,
            run: model.run,
            criteria: model.criteria,
        })
    }

    /// The text as a tree of the shape of `T`; misfits are reported all at once with their places, and taken out.
    fn checked<T: Shape + Document>(&mut self, name: &str, text: &str) -> Option<Source> {
        let mut source = match Source::parse(name, text) {
            Ok(source) => source,
            Err(problem) => {
                self.problems.add(*problem);
                self.unread = true;
                return None;
            }
        };
        if let Some((what, help)) = T::instead(&source.root, name) {
            let message = format!("this is {what}, not {}", T::TITLE);
            self.problems.add(source.at().problem(message, help));
            self.unread = true;
            return None;
        }
        let before = self.problems.count();
        T::check(source.at(), &self.problems);
        if self.problems.count() > before {
            match mend(&source, self.problems.language, T::check, &mut self.lost) {
                Some(rest) => source.root = rest,
                None => {
                    self.unread = true;
                    return None;
                }
            }
        }
        Some(source)
    }

    /// Writes out the short forms of a file; items for which this is not possible are reported and taken out.
    fn expand(&mut self, source: &mut Source) {
        let language = self.problems.language;
        let mut problems = Problems::new(language);
        let mut known = self.known.clone();
        let mut root = expand(source, self.planar, &mut known, &problems);
        let (mut found, _) = problems.into_parts();
        // what names something in a file that was not read is no mistake
        for problem in found.iter().filter(|_| !self.unread) {
            self.problems.add(problem.clone());
        }
        for _ in 0..MAX_FILES {
            if found.is_empty() {
                break;
            }
            for problem in &found {
                self.lost.add(source, problem);
            }
            take_out(&mut source.root, &found);
            problems = Problems::new(language);
            known = self.known.clone();
            root = expand(source, self.planar, &mut known, &problems);
            (found, _) = problems.into_parts();
        }
        self.known = known;
        source.root = root;
    }

    /// The tree as `T`, its short forms written out.
    fn typed<T: Shape>(&mut self, source: &Source) -> Option<T> {
        match T::read(&source.root.value()) {
            Ok(value) => Some(value),
            Err(error) => {
                self.unread = true;
                // what is not as it should be after short forms were written out is reported there
                if self.problems.count() == 0 {
                    self.problems.add(Diagnostic::of_file(
                        &source.name,
                        format!("this cannot be read: {error}"),
                        "see the reference of the language for what may stand here",
                    ));
                }
                None
            }
        }
    }

    /// Reads the files that a file includes.
    fn includes(&mut self, path: PathBuf, source: &Source) {
        self.open.push(path);
        let list = source.at().key("include");
        let count = match &list.node.kind {
            NodeKind::List(items) if source.root.get("include").is_some() => items.len(),
            _ => 0,
        };
        for index in 0..count {
            let at = list.item(index);
            if person::is_person(at) {
                self.person(at);
                continue;
            }
            if part::is_part(at) {
                self.part(at);
                continue;
            }
            let (file, system) = match at.node.get("file") {
                Some(_) => (at.key("file"), Some(at.key("system"))),
                None => (at, None),
            };
            self.include(file, system);
        }
        self.open.pop();
    }

    fn contents(&mut self, source: Source, contents: Included) {
        let before = self.problems.kept();
        self.tables(source.at());
        for (index, force) in contents.forces.iter().flatten().enumerate() {
            let text = |key: &str| force.0.get(key).and_then(Value::as_str);
            let mut laws = self.problems.language.laws.iter();
            let law = laws.find_map(|law| Some((law, text(law.key)?)));
            if let Some((law, name)) = law
                && let Some(key) = law.source
                && let Some(file) = text(key).filter(|_| self.with_sources)
            {
                let at = source.at().key("forces").item(index).key(key);
                self.user_source(at, file, name);
            }
        }
        for problem in self.problems.since(before) {
            self.lost.add(&source, &problem);
        }
        self.files.push(File { source, contents });
    }

    /// Reads a person who is made, as a file that the model includes.
    fn person(&mut self, at: At<'_>) {
        let system = at.key("system");
        let name = system.node.text().unwrap_or_default().to_owned();
        if !self.persons.insert(name.clone()) {
            self.problems.add(system.problem(
                format!("there are two systems called {}", quoted(&name)),
                "give each person a name of its own",
            ));
            self.unread = true;
            return;
        }
        match person::text(at, self.planar, &self.problems) {
            Some(text) => self.made(&format!("human {name}"), &text),
            None => self.unread = true,
        }
    }

    /// Reads a part of a car, as a file that the model includes.
    fn part(&mut self, at: At<'_>) {
        let name = at.key("name").node.text().unwrap_or_default().to_owned();
        match part::text(at, self.planar, &self.problems) {
            Some(text) => self.made(&format!("part {name}"), &text),
            None => self.unread = true,
        }
    }

    /// Reads a text that was made as if it were an included file.
    fn made(&mut self, name: &str, text: &str) {
        let Some(mut source) = self.checked::<Included>(name, text) else {
            return;
        };
        self.expand(&mut source);
        if let Some(contents) = self.typed::<Included>(&source) {
            self.contents(source, contents);
        }
    }

    /// Reads a file, whose path stands at `at`; where another name for its system stands somewhere, under that name.
    fn include(&mut self, at: At<'_>, system: Option<At<'_>>) {
        let from = self
            .open
            .last()
            .and_then(|p| p.parent())
            .unwrap_or(Path::new(""));
        let path = normal(&from.join(at.node.text().unwrap_or_default().replace('\\', "/")));
        if let Some(begin) = self.open.iter().position(|p| *p == path) {
            let cycle: Vec<String> = self.open[begin..]
                .iter()
                .chain([&path])
                .map(|p| shown(p))
                .collect();
            self.problems.add(at.problem(
                format!("the files include each other: {}", cycle.join(" → ")),
                "remove one of these includes; move what both need into a file of its own",
            ));
            self.unread = true;
            return;
        }
        let name = system.and_then(|at| at.node.text()).map(str::to_owned);
        let again = self.included.iter().any(|(known, _)| *known == path);
        if !self.included.insert((path.clone(), name.clone())) {
            return;
        }
        let text = match again {
            true => (self.loader)(&path).ok(),
            false => self.text(at, &path),
        };
        let Some(text) = text else {
            self.unread = true;
            return;
        };
        let Some(mut source) = self.checked::<Included>(&shown(&path), &text) else {
            return;
        };
        self.includes(path, &source);
        if again || name.is_some() {
            let mut known = self.known.without(&source.name);
            let mut root = expand(&source, self.planar, &mut known, &self.problems);
            let at = system.unwrap_or(at);
            let Some(renaming) = rename(&mut root, name.as_deref(), again, at, &self.problems)
            else {
                self.unread = true;
                return;
            };
            self.known
                .add_renamed(known, &root, &source.name, &renaming);
            source.root = root;
        } else {
            self.expand(&mut source);
        }
        if let Some(contents) = self.typed::<Included>(&source) {
            self.contents(source, contents);
        }
    }

    /// The text of one more file; reported at `at` where there is none.
    fn text(&mut self, at: At<'_>, path: &Path) -> Option<String> {
        self.text_or(at, path, None)
    }

    /// True if so many more files are more than a model may have; reports this.
    fn too_many_files(&self, at: At<'_>, more: usize) -> bool {
        let too_many = self.paths.len() + more > MAX_FILES;
        if too_many {
            self.problems.add(at.problem(
                format!("the model is made of more than {MAX_FILES} files"),
                "join files",
            ));
        }
        too_many
    }

    /// The same with a remedy for a file that does not exist.
    fn text_or(&mut self, at: At<'_>, path: &Path, missing: Option<&str>) -> Option<String> {
        if self.too_many_files(at, 1) {
            return None;
        }
        match (self.loader)(path) {
            Ok(text) => {
                self.paths.push(path.to_owned());
                Some(text)
            }
            Err(error) => {
                let (message, help) = unreadable(&shown(path), &error);
                let help = missing
                    .filter(|_| error.kind() == io::ErrorKind::NotFound)
                    .unwrap_or(help);
                self.problems.add(at.problem(message, help));
                None
            }
        }
    }

    /// Reads the files that the curves at this place and below name.
    fn tables(&mut self, at: At<'_>) {
        match &at.node.kind {
            NodeKind::Scalar { .. } => {}
            NodeKind::List(items) => (0..items.len()).for_each(|index| self.tables(at.item(index))),
            NodeKind::Map(_) if curve::has_file(at.node) => match at.node.get("mme") {
                Some(_) => self.channel(at),
                None => self.table(at.key("file")),
            },
            NodeKind::Map(entries) => {
                for entry in entries {
                    self.tables(at.key(&entry.key));
                }
            }
        }
    }

    /// Reads the channel of a test that a curve names.
    fn channel(&mut self, at: At<'_>) {
        let (Some(mme), Some(code)) = (at.node.get("mme"), at.node.get("channel")) else {
            return;
        };
        let (Some(mme), Some(code)) = (mme.text(), code.text()) else {
            return;
        };
        let path = beside(&at.source.name, mme);
        let key = channel_key(&path, code);
        if self.tables.contains_key(&key) {
            return;
        }
        if !self.tests.contains_key(&path) {
            let loader = |path: &Path| match (self.loader)(path) {
                Ok(text) if text.len() > MAX_BYTES => {
                    let message = format!("it is longer than {} MiB", MAX_BYTES >> 20);
                    Err(io::Error::other(message))
                }
                read => read,
            };
            match Test::read(&path, &loader).and_then(Test::whole) {
                Ok(test) => self.tests.insert(path.clone(), test),
                Err(wrong) => {
                    self.problems.add(in_test(at.key("mme"), wrong));
                    return;
                }
            };
        }
        match channel_of(&self.tests[&path], code, at) {
            Ok((table, mut paths)) => {
                paths.retain(|path| !self.paths.contains(path));
                if !self.too_many_files(at.key("mme"), paths.len()) {
                    self.paths.append(&mut paths);
                    self.tables.insert(key, table);
                }
            }
            Err(problem) => self.problems.add(problem),
        }
    }

    fn table(&mut self, at: At<'_>) {
        let NodeKind::Scalar { text: file, .. } = &at.node.kind else {
            return;
        };
        let path = beside(&at.source.name, file);
        if self.tables.contains_key(&path) {
            return;
        }
        let Some(text) = self.text(at, &path) else {
            return;
        };
        match Table::new(&shown(&path), &text) {
            Ok(table) => {
                self.tables.insert(path, table);
            }
            Err(problem) => self.problems.add(*problem),
        }
    }

    /// Reads the Rust file of a user force.
    fn user_source(&mut self, at: At<'_>, file: &str, force: &str) {
        let path = beside(&at.source.name, file);
        if self.sources.contains_key(&path) {
            return;
        }
        let missing = format!(
            "look at the path; it is relative to this file. `bryant check MODEL --skeleton {}` prints a file to begin with",
            quoted(force).trim_matches('"')
        );
        let Some(text) = self.text_or(at, &path, Some(&missing)) else {
            return;
        };
        let text = text.trim_start_matches('\u{feff}').replace("\r\n", "\n");
        if text.len() > MAX_BYTES {
            self.problems.add(at.problem(
                format!("the file {} is longer than {MAX_BYTES} bytes", quoted(file)),
                "a user force is one function with what it needs",
            ));
            return;
        }
        self.sources.insert(path, text);
    }
}

/// The path of a file named in another. Its parts are joined by `/` or by `\\`, on every system.
pub fn beside(source: &str, file: &str) -> PathBuf {
    let directory = Path::new(source).parent().unwrap_or(Path::new(""));
    normal(&directory.join(file.replace('\\', "/")))
}

/// The path without `.` and, as far as that is possible, `..`.
fn normal(path: &Path) -> PathBuf {
    let mut normal = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir
                if matches!(normal.components().next_back(), Some(Component::Normal(_))) =>
            {
                normal.pop();
            }
            part => normal.push(part),
        }
    }
    normal
}

/// A path as shown to the user, the same on every system.
pub fn shown(path: &Path) -> String {
    let path = path.display().to_string();
    // of a path as Windows gives it in full, what a user writes; with the other sign the beginning would have no
    // meaning
    let path = path.strip_prefix(r"\\?\").unwrap_or(&path);
    path.replace('\\', "/")
}
