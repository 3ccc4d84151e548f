//! Resolves the description: every name becomes an index, every number is in SI, every property of [`Model`] is
//! checked.
//!
//! ```text
//! parameters → curves → vehicles → systems (elements, reference, start) → forces → switches → outputs → run
//! ```
//!
//! Each step uses only results of the steps before it, and continues after a problem, so that all problems are
//! reported.

pub(crate) mod applied;
pub(crate) mod channel;
pub(crate) mod coordinate;
mod coupling;
mod criteria;
pub(crate) mod curve;
mod element;
mod formula;
pub(crate) mod hysteresis;
pub(crate) mod joint;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod kinematics;
pub(crate) mod law;
mod mesh;
mod mobility;
pub(crate) mod name;
pub(crate) mod output;
mod parameter;
pub(crate) mod quantity;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod regularity;
pub(crate) mod run;
pub(crate) mod rust;
pub(crate) mod surface;
mod switch;
mod system;
mod translation;
mod units;
mod vehicle;

use self::law::{Outputs, Registered};
use self::surface::surface;
use super::{
    Attachment, Body, Coordinates, Criteria, Dimension, ElementId, Force, Model, Number, Output,
    Parameter, Shown, Switch, System, Vehicle,
};
use crate::description::force::Attachment as WrittenEnd;
use crate::description::language::Language;
use crate::description::load::{Header, Loaded, load, shown};
use crate::description::mend::item_mentions;
use crate::description::output::Column;
use crate::description::place::At;
use crate::description::point::Point;
use crate::description::shape::Problems;
use crate::description::table::Table;
use crate::description::tree::MAX_ELEMENTS;
use crate::description::{
    load::Coordinates as WrittenCoordinates, load::Dimension as WrittenDimension,
    load::Units as WrittenUnits,
};
use crate::diagnostic::{Diagnostics, quoted, suggestion};
use crate::model::units::{Unit, UnitSystem, Units};
use joint::{Spelling, Word};
use name::Style;
use regularity::check_regularity;
use std::cell::Cell;
use std::collections::{BTreeMap, HashMap};
use std::io;
use std::path::{Path, PathBuf};

/// The kinds of joints and the force laws that the language knows, and how each is read. Whoever reads a model hands
/// them in.
pub struct Kinds {
    /// The kinds as written.
    pub language: &'static Language,
    /// The keys of a joint that stand for freedoms.
    pub(crate) spellings: &'static [Spelling],
    /// The words for joints that need no keys.
    pub(crate) words: &'static [Word],
    /// The force laws.
    pub(crate) laws: &'static [Registered],
    /// The outputs of the law of a force.
    pub(crate) outputs: fn(&Force) -> &dyn Outputs,
}

/// A model before and after normalisation.
pub struct Resolved {
    /// The model in its normal form.
    pub model: Model,
    /// The model with everything that the text mentions and that could be resolved. Forces that are switched off come
    /// after the others.
    pub written: Model,
    /// Number of forces that are switched off.
    pub off: usize,
    /// The criteria by which a run is judged, if the text has any.
    pub criteria: Option<Criteria>,
    /// The key of the law and the name of each force, in the order of the texts.
    pub(crate) owners: Vec<String>,
}

/// Loads and resolves a model, with or without the Rust files of user forces. Returns the model and the loaded texts.
pub(crate) fn resolve(
    kinds: &'static Kinds,
    name: &str,
    text: &str,
    loader: &dyn Fn(&Path) -> io::Result<String>,
    with_sources: bool,
) -> Result<(Resolved, Loaded), Diagnostics> {
    let mut loaded = load(kinds.language, name, text, loader, with_sources)?;
    let problems = Problems::new(kinds.language);
    let model = Resolver::new(kinds, &problems, &loaded).model(&loaded);
    let (mut found, _) = problems.into_parts();
    found.retain(|problem| !loaded.lost.explains(problem));
    let mut all = std::mem::take(&mut loaded.problems);
    all.append(&mut found);
    if let Some(model) = model.filter(|_| all.is_empty()) {
        return Ok((model, loaded));
    }
    let order: HashMap<String, usize> = loaded
        .paths
        .iter()
        .enumerate()
        .map(|(i, p)| (shown(p), i))
        .collect();
    all.sort_by_key(|p| (order.get(&p.file).copied().unwrap_or(0), p.line, p.column));
    Err(Diagnostics { problems: all })
}

/// The parts of a model that are resolved so far, and the problems.
///
/// A function that checks a part of a description looks up here the names that the part mentions, adds problems to
/// `problems`, and returns the checked form. Only the steps of `Resolver::model` enter checked forms here, with one
/// exception: curves that are written in place are entered when they are checked.
pub struct Resolver<'a> {
    pub(crate) kinds: &'static Kinds,
    pub(crate) problems: &'a Problems,
    pub(crate) planar: bool,
    /// Tables of points of curves, by file.
    pub(crate) tables: &'a BTreeMap<PathBuf, Table>,
    pub(crate) parameters: Vec<Parameter>,
    /// Default values of the parameters (SI), in the same order.
    pub(crate) defaults: Vec<f64>,
    /// Dimensions of the parameters, in the same order.
    pub(crate) measures: Vec<quantity::Measure>,
    /// Parameters whose declaration is wrong.
    pub(crate) failed_parameters: Vec<String>,
    /// Named curves, then those written in place; `None` for a wrong curve.
    pub(crate) curves: Vec<Option<curve::Measured>>,
    /// Names of the named curves, in the same order.
    pub(crate) curve_names: Vec<String>,
    pub(crate) vehicles: Vec<Vehicle>,
    pub(crate) systems: Vec<System>,
    /// All elements, by their paths.
    pub(crate) elements: HashMap<String, ElementId>,
    /// The paths of the elements, in order.
    pub(crate) paths: Vec<String>,
    /// The part of a human body that an element represents, if the text says so.
    pub(crate) parts: HashMap<ElementId, channel::BodyPart>,
    pub(crate) forces: Vec<Force>,
    /// The places of these forces.
    pub(crate) force_places: Vec<At<'a>>,
    /// The key of the law and the name of each force, in the order of the texts.
    pub(crate) owners: Vec<String>,
    /// Forces that are switched off or wrong: law and name.
    pub(crate) disabled: Vec<(&'static str, String)>,
    /// Those disabled forces that could be resolved.
    pub(crate) off: Vec<Force>,
    pub(crate) outputs: Vec<Output>,
    /// Shapes that are only drawn.
    pub(crate) shown: Vec<Shown>,
    /// Names of outputs with a unit of their own, and the units.
    units: Vec<(String, Unit)>,
    pub(crate) switch_names: Vec<String>,
    /// The switches, in the order of `switch_names`; `None` for a wrong switch.
    pub(crate) switches: Vec<Option<Switch>>,
    pub(crate) loaded: &'a Loaded,
    /// The part of the description that is being resolved; names of its curves are made from this: "belt lap".
    pub(crate) owner: String,
    /// True while a force is read.
    pub(crate) of_force: bool,
    /// True while a number is read that may depend on inputs: forces, thresholds and formulas follow them at once, but
    /// nothing else may change during a run.
    pub(crate) inputs_may_stand: Cell<bool>,
}

impl<'a> Resolver<'a> {
    pub(crate) fn new(kinds: &'static Kinds, problems: &'a Problems, loaded: &'a Loaded) -> Self {
        Resolver {
            kinds,
            problems,
            planar: loaded.header.dimension == WrittenDimension::Plane,
            tables: &loaded.tables,
            parameters: Vec::new(),
            defaults: Vec::new(),
            measures: Vec::new(),
            failed_parameters: Vec::new(),
            owner: String::new(),
            of_force: false,
            inputs_may_stand: Cell::new(false),
            curves: Vec::new(),
            curve_names: Vec::new(),
            vehicles: Vec::new(),
            systems: Vec::new(),
            elements: HashMap::new(),
            paths: Vec::new(),
            parts: HashMap::new(),
            forces: Vec::new(),
            force_places: Vec::new(),
            owners: Vec::new(),
            disabled: Vec::new(),
            off: Vec::new(),
            outputs: Vec::new(),
            shown: Vec::new(),
            units: Vec::new(),
            switch_names: Vec::new(),
            switches: Vec::new(),
            loaded,
        }
    }

    pub(crate) fn dimension(&self) -> Dimension {
        match self.planar {
            true => Dimension::Plane,
            false => Dimension::Space,
        }
    }

    /// The whole model; `None` if problems leave no useful model.
    pub(crate) fn model(mut self, loaded: &'a Loaded) -> Option<Resolved> {
        let top = loaded.files.last()?.source.at();
        let header = &loaded.header;
        self.check_header(header, top);
        self.enter_numbers(loaded);
        self.enter_vehicles(loaded);
        system::systems(&mut self, loaded);
        self.switch_names = switch::switch_names(&self, loaded);
        self.enter_forces(loaded);
        self.switches = switch::switches(&self, loaded);
        let sound = self.problems.count() == 0 && loaded.problems.is_empty();
        let mut headings = Vec::new();
        self.enter_outputs(loaded, &mut headings);
        let criteria = criteria::criteria(
            &mut self,
            header.criteria.as_ref(),
            top.key("criteria"),
            &mut headings,
        );
        let run = run::run(&self, header.run.as_ref(), top.key("run"));
        self.forget_consequences(loaded);
        if sound {
            check_regularity(&self, loaded);
            for (force, at) in self.forces.iter().zip(&self.force_places) {
                (self.kinds.outputs)(force).check_start(&self, &force.name, *at);
            }
        }
        let mut model = Model {
            name: header.model.clone(),
            title: header.title.clone().unwrap_or_default(),
            dimension: self.dimension(),
            coordinates: match header.coordinates {
                Some(WrittenCoordinates::Bryant) => Coordinates::Bryant,
                _ => Coordinates::Quaternion,
            },
            parameters: self.parameters,
            curves: self
                .curves
                .into_iter()
                .map(|c| Some(c?.curve))
                .collect::<Option<_>>()?,
            vehicles: self.vehicles,
            systems: self.systems,
            forces: self.forces,
            switches: self.switches.into_iter().collect::<Option<_>>()?,
            outputs: self.outputs,
            run,
            shown: self.shown,
            units: Units {
                system: match header.units {
                    Some(WrittenUnits::Engineering) => UnitSystem::Engineering,
                    _ => UnitSystem::Si,
                },
                own: self.units,
            },
            digest: String::new(),
        };
        let mut written = model.clone();
        let off = self.off.len();
        written.forces.append(&mut self.off);
        model.normalize();
        Some(Resolved {
            model,
            written,
            off,
            criteria,
            owners: self.owners,
        })
    }

    fn check_header(&self, header: &Header, top: At<'_>) {
        self.check_name(&header.model, "a model", Style::Kebab, top.key("model"));
        if self.planar && header.coordinates.is_some() {
            self.problems.add(top.key("coordinates").key_problem(
                "in the plane there is one angle per element and no choice of coordinates",
                "remove the key `coordinates`",
            ));
        }
        let title = header.title.as_deref().unwrap_or_default();
        if title.chars().any(char::is_control) || title.chars().count() > 200 {
            self.problems.add(top.key("title").problem(
                "the title is not one line of at most 200 characters",
                "shorten it; comments (`# …`) hold what is longer",
            ));
        }
    }

    /// Drops problems that may exist only because a parameter with a wrong declaration counts as 0.
    fn forget_consequences(&self, loaded: &Loaded) {
        if self.failed_parameters.is_empty() {
            return;
        }
        self.problems.retain(|problem| {
            let of = loaded.files.iter().map(|file| &file.source);
            let mut of = of.filter(|source| source.name == problem.file);
            !of.any(|source| item_mentions(source, problem, &self.failed_parameters))
        });
    }

    /// Enters parameters and named curves.
    fn enter_numbers(&mut self, loaded: &Loaded) {
        for file in &loaded.files {
            let contents = &file.contents;
            for (key, of) in [
                ("parameters", &contents.parameters),
                ("inputs", &contents.inputs),
            ] {
                let at = file.source.at().key(key);
                for (name, written) in of.iter().flat_map(|p| &p.0) {
                    let is_input = key == "inputs";
                    match parameter::parameter(self, name, &written.0, at.key(name), is_input) {
                        Some((parameter, measure)) => {
                            self.defaults.push(parameter.default);
                            self.parameters.push(parameter);
                            self.measures.push(measure);
                        }
                        None => self.failed_parameters.push(name.to_owned()),
                    }
                }
            }
        }
        for file in &loaded.files {
            let at = file.source.at().key("curves");
            for (name, written) in file.contents.curves.iter().flat_map(|c| &c.0) {
                self.named_curve(name, written, at);
            }
        }
    }

    fn enter_vehicles(&mut self, loaded: &Loaded) {
        for file in &loaded.files {
            let at = file.source.at().key("vehicles");
            for (index, written) in file.contents.vehicles.iter().flatten().enumerate() {
                let vehicle = vehicle::vehicle(self, written, at.item(index));
                self.vehicles.extend(vehicle);
            }
        }
    }

    /// Enters a system, and the paths of its elements.
    fn enter_system(&mut self, system: System) {
        for (element, e) in system.elements.iter().enumerate() {
            let path = format!("{}/{}", system.name, e.name);
            let id = ElementId {
                system: self.systems.len(),
                element,
            };
            self.elements.insert(path.clone(), id);
            self.paths.push(path);
        }
        self.systems.push(system);
    }

    /// Enters the forces, after a check of all surfaces, including those that no contact names.
    fn enter_forces(&mut self, loaded: &'a Loaded) {
        let mut shown = Vec::new();
        for file in &loaded.files {
            let at = file.source.at().key("surfaces");
            for (name, written) in file.contents.surfaces.iter().flat_map(|s| &s.0) {
                shown.extend(surface(self, name, written, at.key(name)));
            }
        }
        for file in &loaded.files {
            let at = file.source.at().key("forces");
            for (index, written) in file.contents.forces.iter().flatten().enumerate() {
                let at = at.item(index);
                let mut laws = self.kinds.laws.iter();
                let law = laws.find(|law| written.0.get(law.keys.key).is_some());
                let misfit = match law {
                    Some(law) => (law.enter)(self, &written.0, at).err(),
                    None => Some("the force has no kind".to_owned()),
                };
                self.force_places.resize(self.forces.len(), at);
                if let Some(misfit) = misfit {
                    // the shape was found to be right
                    self.problems
                        .add(at.problem(misfit, "see the reference of the language"));
                }
            }
        }
        shown.retain(|shown| {
            let mut looks = self.forces.iter().flat_map(|force| force.law.looks());
            !looks.any(|look| shown.is_in(&look))
        });
        let fixed = shown.into_iter().map(|shown| shown.fixed(&self.defaults));
        self.shown = fixed.collect();
        self.shown.extend(self.meshes(loaded));
    }

    /// Enters the outputs. Adds their headings to `headings`, including those of outputs that are switched off.
    fn enter_outputs(&mut self, loaded: &Loaded, headings: &mut Vec<String>) {
        for file in &loaded.files {
            let at = file.source.at().key("outputs");
            for (index, written) in file.contents.outputs.iter().flatten().enumerate() {
                let at = at.item(index);
                let output = match written {
                    Column::Output(written) => output::output(self, written, at, headings),
                    Column::Formula(written) => formula::formula(self, written, at, headings),
                };
                self.outputs.extend(output);
            }
        }
    }

    /// Index of the switch with this name; reports if there is none.
    pub(crate) fn switch_id(&self, name: &str, at: At<'_>) -> Option<usize> {
        let found = self.switch_names.iter().position(|n| n == name);
        if found.is_none() {
            let names = self.switch_names.iter().map(String::as_str);
            self.problems.add(at.problem(
                format!("there is no switch {}", quoted(name)),
                suggestion(
                    name,
                    names,
                    "declare it: `switches: [{ switch: crash, when: { time: 10 ms } }]`",
                ),
            ));
        }
        found
    }

    /// The element with the path `system/element`; reports if there is none.
    pub(crate) fn element_id(&self, path: &str, at: At<'_>) -> Option<ElementId> {
        if let Some(&id) = self.elements.get(path) {
            return Some(id);
        }
        let candidates = || self.paths.iter().map(String::as_str);
        let help = match path.split_once('/') {
            None if self.systems.iter().any(|s| s.name == path) => {
                format!(
                    "{} is a system; name one of its elements, as `{path}/element`",
                    quoted(path)
                )
            }
            None if self.vehicles.iter().any(|v| v.name == path) => format!(
                "{} is a vehicle, whose motion is given; name an element, as `system/element`",
                quoted(path)
            ),
            None => match candidates().find(|c| c.rsplit('/').next() == Some(path)) {
                Some(whole) => format!(
                    "elements are named with their system; did you mean {}?",
                    quoted(whole)
                ),
                None => suggestion(path, candidates(), "the model has no elements"),
            },
            Some(_) => suggestion(path, candidates(), "the model has no elements"),
        };
        self.problems
            .add(at.problem(format!("there is no element {}", quoted(path)), help));
        None
    }

    /// True if a system that was read before has an element of this name.
    pub fn has_element_elsewhere(&self, name: &str) -> bool {
        let mut elements = self.systems.iter().flat_map(|system| &system.elements);
        elements.any(|element| element.name == name)
    }

    /// The body with this path: `frame`, a vehicle or an element; reports if there is none.
    pub(crate) fn body(&self, path: &str, at: At<'_>) -> Option<Body> {
        if path == "frame" {
            return Some(Body::Frame);
        }
        if let Some(vehicle) = self.vehicles.iter().position(|v| v.name == path) {
            return Some(Body::Vehicle(vehicle));
        }
        let vehicles = self.vehicles.iter().map(|v| v.name.as_str());
        if !path.contains('/')
            && let Some(near) = crate::diagnostic::nearest(path, vehicles.chain(["frame"]))
        {
            self.problems.add(at.problem(
                format!("there is no body {}", quoted(path)),
                format!("did you mean {}?", quoted(near)),
            ));
            return None;
        }
        self.element_id(path, at).map(Body::Element)
    }

    /// A point on a body.
    pub(crate) fn end(&self, written: &WrittenEnd, at: At<'_>) -> Option<Attachment> {
        let position = self.vector(&written.at, at.key("at"));
        self.body(&written.on, at.key("on"))
            .map(|on| Attachment { on, at: position })
    }

    /// A point of an element in its local frame.
    pub(crate) fn point(&self, written: &Point, id: ElementId, at: At<'_>) -> [Number; 3] {
        match written {
            Point::Cg => self.systems[id.system].elements[id.element].cg.clone(),
            Point::At(point) => self.vector(point, at),
        }
    }

    /// The part of a human body that an element represents.
    pub(crate) fn part(&self, id: ElementId) -> channel::BodyPart {
        self.parts.get(&id).copied().unwrap_or_default()
    }

    pub(crate) fn path(&self, id: ElementId) -> String {
        let system = &self.systems[id.system];
        format!("{}/{}", system.name, system.elements[id.element].name)
    }

    /// True if the whole model has more elements than are allowed; reports this.
    pub(crate) fn too_many_elements(&self, at: At<'_>) -> bool {
        let count: usize = self.systems.iter().map(|s| s.elements.len()).sum();
        if count > MAX_ELEMENTS {
            self.problems.add(at.problem(
                format!("the model has {count} elements"),
                format!("at most {MAX_ELEMENTS} elements make a model"),
            ));
        }
        count > MAX_ELEMENTS
    }
}

/// Zero in all components.
pub(crate) const NOWHERE: [Number; 3] = [Number::ZERO; 3];

/// The absolute axes by name.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// A vector, scaled to length 1. Its components must be neither so large nor so small that their squares overflow or
/// lose digits.
pub(crate) fn unit(resolver: &Resolver<'_>, vector: [Number; 3]) -> [Number; 3] {
    let length = if vector.iter().all(|n| n.constant().is_some()) {
        let squares = vector.iter().map(|n| {
            let n = n.value(&resolver.defaults);
            n * n
        });
        Number::Constant(squares.sum::<f64>().sqrt())
    } else {
        let squares = vector.iter().map(|n| Number::product(n.clone(), n.clone()));
        Number::square_root(squares.fold(Number::ZERO, Number::sum))
    };
    vector.map(|n| Number::quotient(n, length.clone()))
}
