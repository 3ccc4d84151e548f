//! User forces: what the function looks at and acts on, what it is given, and the function itself.

use crate::description::curve::{Function, ScaledCurve as WrittenScaled};
use crate::description::load::{beside, shown};
use crate::description::place::At;
use crate::description::point::Point;
use crate::description::quantity::Quantity;
use crate::description::shape::Named;
use crate::description::unit::Dimension as UnitDimension;
use crate::diagnostic::{Diagnostic, quoted};
use crate::law::user::keys::{
    User as Written, UserFreedom as WrittenFreedom, UserPoint, UserState as WrittenState,
};
use crate::model::resolve::Resolver;
use crate::model::resolve::name::{Style, identifier};
use crate::model::resolve::quantity::{ANY, LENGTH, Measure, TIME};
use crate::model::resolve::rust::{self, Fault, Place, Wanted};
use crate::model::{
    Attachment, Body, Dimension, ElementId, FieldComponent, ForceKind, Joint, Number, ScaledCurve,
};
use std::path::{Component, Path, PathBuf};

/// Most entries of one kind.
const MAX_PORTS: usize = 100;

/// A force computed by a Rust function of the user's.
#[derive(Clone, Debug, PartialEq)]
pub struct User {
    /// What is called.
    pub function: UserFunction,
    /// Whether its vectors are those of the plane or of space, whatever the motion is.
    pub dimension: Dimension,
    /// The longest step \[s\], positive; `None` is the time between samples.
    pub scale: Option<f64>,
    /// Points: position and velocity in, force out.
    pub points: Vec<Port<Attachment>>,
    /// Elements: orientation and angular velocity in, moment out.
    pub bodies: Vec<Port<ElementId>>,
    /// Lines: length and its rate in, tension out.
    pub lines: Vec<Port<UserLine>>,
    /// Joints, by the element that they carry: relative angles and rates in, torques out.
    pub joints: Vec<Port<ElementId>>,
    /// Freedoms of joints: coordinate and rate in, torque or force along it out.
    pub freedoms: Vec<Port<UserFreedom>>,
    /// State variables: value in, rate out.
    pub states: Vec<Port<UserState>>,
}

/// A function, and what it is given whatever the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct UserFunction {
    /// Its name in its source; its path (`crate::aero::drag`) where there is none; empty where it is left out.
    pub name: String,
    /// The text with the function; `None` where the crate that includes the module has it.
    pub source: Option<UserSource>,
    /// Numbers and curves of time.
    pub parameters: Vec<Port<UserParameter>>,
    /// Curves to look up; `None` where the curve is zero everywhere.
    pub curves: Vec<Port<Option<ScaledCurve>>>,
}

/// Rust text of the user's.
#[derive(Clone, Debug, PartialEq)]
pub struct UserSource {
    /// Path of the file, relative to that of the model.
    pub name: String,
    /// Its text, lines ended by `\n`.
    pub text: String,
}

/// Something under a name that the user gave it; the name, dashes as underscores, is an identifier.
#[derive(Clone, Debug, PartialEq)]
pub struct Port<T> {
    /// As in the YAML.
    pub name: String,
    /// What it is.
    pub value: T,
}

/// A straight line between two points.
#[derive(Clone, Debug, PartialEq)]
pub struct UserLine {
    /// One end.
    pub from: Attachment,
    /// The other end.
    pub to: Attachment,
}

/// A freedom of a joint with coordinates of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct UserFreedom {
    /// The element that the joint carries.
    pub element: ElementId,
    /// Index into its freedoms.
    pub freedom: usize,
    /// Whether it turns; else it slides.
    pub turns: bool,
}

/// A number or a curve of time, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct UserParameter {
    /// The value.
    pub value: FieldComponent,
    /// SI unit, "" where the number has none or it is unknown.
    pub unit: String,
}

/// A state variable.
#[derive(Clone, Debug, PartialEq)]
pub struct UserState {
    /// Value at the start of a run.
    pub initial: Number,
    /// SI unit, "" where the number has none.
    pub unit: &'static str,
    /// SI unit of its rate.
    pub rate_unit: &'static str,
}

impl User {
    /// Names of what the function returns, in its order: per point a force, per body a moment, per line a tension, per
    /// joint torques, per freedom an effort, per state a rate; vectors by component, of which those that the plane has not are left out.
    pub fn results(&self) -> Vec<String> {
        let vector: &[&str] = match self.dimension {
            Dimension::Plane => &["_x", "_z"],
            Dimension::Space => &["_x", "_y", "_z"],
        };
        let rotation: &[&str] = match self.dimension {
            Dimension::Plane => &[""],
            Dimension::Space => &["_x", "_y", "_z"],
        };
        let mut results = Vec::new();
        let mut add = |name: &str, what: &str, components: &[&str]| {
            let name = name.replace('-', "_");
            results.extend(components.iter().map(|c| format!("{name}_{what}{c}")));
        };
        for point in &self.points {
            add(&point.name, "force", vector);
        }
        for body in &self.bodies {
            add(&body.name, "moment", rotation);
        }
        for line in &self.lines {
            add(&line.name, "tension", &[""]);
        }
        for joint in &self.joints {
            add(&joint.name, "torque", rotation);
        }
        for freedom in &self.freedoms {
            add(&freedom.name, "effort", &[""]);
        }
        for state in &self.states {
            add(&state.name, "rate", &[""]);
        }
        results
    }

    /// Number of things that it acts on.
    pub fn ports(&self) -> usize {
        self.points.len()
            + self.bodies.len()
            + self.lines.len()
            + self.joints.len()
            + self.freedoms.len()
    }
}

impl Resolver<'_> {
    /// The longest step of a user force \[s\].
    fn scale(&self, written: &Quantity, at: At<'_>) -> f64 {
        self.time(Some(written), at, f64::INFINITY)
    }

    /// Resolves a user force.
    pub fn user(&mut self, written: &Written, at: At<'_>) -> Option<ForceKind> {
        let before = self.problems.count();
        let name = &written.user;
        let mut taken = Vec::new();
        let points = self.ports(&written.points, at.key("points"), "a point", &mut taken);
        let bodies = self.ports(&written.bodies, at.key("bodies"), "a body", &mut taken);
        let lines = self.ports(&written.lines, at.key("lines"), "a line", &mut taken);
        let joints = self.ports(&written.joints, at.key("joints"), "a joint", &mut taken);
        let at_freedoms = at.key("freedoms");
        let freedoms = self.ports(&written.freedoms, at_freedoms, "a freedom", &mut taken);
        let states = self.ports(&written.states, at.key("states"), "a state", &mut taken);
        let at_parameters = at.key("parameters");
        let parameters = self.ports(
            &written.parameters,
            at_parameters,
            "a parameter",
            &mut vec![],
        );
        let curves = self.ports(&written.curves, at.key("curves"), "a curve", &mut vec![]);
        let jointless = joints.is_empty() && freedoms.is_empty();
        if points.is_empty() && bodies.is_empty() && lines.is_empty() && jointless {
            self.problems.add(at.key("user").key_problem(
                format!("the user force {} acts on nothing", quoted(name)),
                "give it `points`, `bodies`, `lines`, `joints` or `freedoms`",
            ));
        }

        let points = self.each(points, |this, point, at| this.user_point(point, at));
        let bodies = self.each(bodies, |this, path, at| this.acted_on(path, at));
        let joints = self.each(joints, |this, path, at| this.acted_on(path, at));
        let freedoms = self.each(freedoms, |this, freedom, at| this.user_freedom(freedom, at));
        let lines = self.each(lines, |this, line, at| {
            let from = this.end(&line.from, at.key("from"));
            let to = this.end(&line.to, at.key("to"));
            let (from, to) = (from?, to?);
            if from.on == to.on {
                this.problems.add(at.key("to").problem(
                    "both ends of this line are on the same body",
                    "a line runs between two bodies; `frame` is the absolute frame",
                ));
            }
            Some(UserLine { from, to })
        });
        let states = self.each(states, |this, state, at| this.user_state(state, at));
        let parameters = self.each_named(parameters, |this, key, function, at| {
            this.user_parameter(function, at, &format!("user {name} {key}"))
        });
        let curves = self.each_named(curves, |this, key, function, at| {
            let owner = format!("user {name} {key}");
            Some(this.function(function, at, &owner, ANY, ANY))
        });
        let (name, source) = self.user_function(written, at)?;
        let scale = (written.scale.as_ref()).map(|scale| self.scale(scale, at.key("scale")));
        if self.problems.count() > before {
            return None;
        }
        let user = User {
            function: UserFunction {
                name,
                source,
                parameters,
                curves,
            },
            dimension: if self.planar {
                Dimension::Plane
            } else {
                Dimension::Space
            },
            scale,
            points,
            bodies,
            lines,
            joints,
            freedoms,
            states,
        };
        self.check_user_source(written, &user, at);
        if self.problems.count() > before {
            return None;
        }
        let others = self.forces.iter().filter_map(|force| match &force.kind {
            ForceKind::User(other) => Some(other),
            _ => None,
        });
        if let Some(source) = &user.function.source
            && let Some(other) = others
                .filter(|other| other.function.source.as_ref() == Some(source))
                .find(|other| other.function.name != user.function.name)
        {
            self.problems.add(at.key("source").problem(
                format!(
                    "{} has the function {} of another user force",
                    quoted(&source.name),
                    quoted(&other.function.name)
                ),
                "give each function a file of its own; it may hold other functions that help it",
            ));
        }
        Some(ForceKind::User(Box::new(user)))
    }

    /// The entries of one kind whose names can be used, with their places.
    fn ports<'w, T>(
        &self,
        written: &'w Option<Named<T>>,
        at: At<'w>,
        what: &str,
        taken: &mut Vec<&'w str>,
    ) -> Vec<(&'w str, &'w T, At<'w>)> {
        let entries: &[(String, T)] = written.as_ref().map_or(&[], |named| &named.0);
        if entries.len() > MAX_PORTS {
            self.problems.add(at.key_problem(
                format!("a user force has at most {MAX_PORTS} entries of one kind"),
                "divide it into several forces",
            ));
            return Vec::new();
        }
        let mut ports = Vec::new();
        for (name, value) in entries {
            let here = at.key(name);
            let place = here.on_key();
            let what = format!("{what} of a user force");
            let unique = || self.check_unique(name, "entries", taken.iter().copied(), place);
            if self.check_name(name, &what, Style::Either, place) && unique() {
                ports.push((name.as_str(), value, here));
            }
            taken.push(name);
        }
        ports
    }

    fn each<T, U>(
        &mut self,
        ports: Vec<(&str, &T, At<'_>)>,
        mut resolve: impl FnMut(&mut Self, &T, At<'_>) -> Option<U>,
    ) -> Vec<Port<U>> {
        self.each_named(ports, |this, _, value, at| resolve(this, value, at))
    }

    fn each_named<T, U>(
        &mut self,
        ports: Vec<(&str, &T, At<'_>)>,
        mut resolve: impl FnMut(&mut Self, &str, &T, At<'_>) -> Option<U>,
    ) -> Vec<Port<U>> {
        let mut resolved = Vec::with_capacity(ports.len());
        for (name, value, at) in ports {
            if let Some(value) = resolve(self, name, value, at) {
                resolved.push(Port {
                    name: name.to_owned(),
                    value,
                });
            }
        }
        resolved
    }

    fn user_point(&self, written: &UserPoint, at: At<'_>) -> Option<Attachment> {
        let on = self.body(&written.on, at.key("on"))?;
        let position = match (&written.at, on) {
            (point, Body::Element(id)) => self.point(point, id, at.key("at")),
            (Point::At(point), _) => self.vector(point, at.key("at"), LENGTH),
            (Point::Cg, _) => {
                self.problems.add(at.key("at").problem(
                    format!("{} has no centre of gravity", quoted(&written.on)),
                    "give coordinates",
                ));
                return None;
            }
        };
        Some(Attachment { on, at: position })
    }

    /// An element: the absolute frame neither turns nor has a joint.
    fn acted_on(&self, path: &str, at: At<'_>) -> Option<ElementId> {
        if path == "frame" {
            self.problems.add(at.problem(
                "a moment on the absolute frame moves nothing",
                "name an element, as `system/element`",
            ));
            return None;
        }
        self.element_id(path, at)
    }

    /// A freedom of a joint with coordinates of its own.
    fn user_freedom(&self, written: &WrittenFreedom, at: At<'_>) -> Option<UserFreedom> {
        let element = self.element_id(&written.joint, at.key("joint"))?;
        let joint = &self.systems[element.system].elements[element.element].joint;
        let Joint::Freedoms(freedoms) = joint else {
            self.problems.add(at.key("joint").problem(
                format!(
                    "{} is on a joint without coordinates of its own",
                    quoted(&written.joint)
                ),
                "name it under `joints`, or give the element a `joint:`",
            ));
            return None;
        };
        let name = written.freedom.as_deref();
        let freedom = self.freedom_named(name, &written.joint, freedoms, at)?;
        Some(UserFreedom {
            element,
            freedom,
            turns: freedoms[freedom].kind.turns(),
        })
    }

    fn user_state(&self, written: &WrittenState, at: At<'_>) -> Option<UserState> {
        let place = at.key("initial");
        let (initial, measure) = self.measured(&written.initial, place)?;
        let dimension = match measure {
            Measure::Known(dimension) => dimension,
            _ => UnitDimension::ONE,
        };
        Some(UserState {
            initial,
            unit: dimension.name(),
            rate_unit: (dimension / TIME.dimension).name(),
        })
    }

    fn user_parameter(
        &mut self,
        written: &Function,
        at: At<'_>,
        owner: &str,
    ) -> Option<UserParameter> {
        let before = self.problems.count();
        let value = self.component(written, at, owner, ANY);
        if self.problems.count() > before {
            return None;
        }
        let measure = match (&value, written) {
            (FieldComponent::Constant(_), Function::Quantity(quantity)) => {
                self.measured(quantity, at)?.1
            }
            (FieldComponent::Constant(_), _) => Measure::Unknown,
            (FieldComponent::Curve(curve), written) => {
                let times = match written {
                    Function::Scaled(WrittenScaled {
                        times: Some(times), ..
                    }) => self.measured(times, at.key("times"))?.1,
                    _ => Measure::Bare,
                };
                let ordinate = self.curves.get(curve.curve)?.as_ref()?.measures[1];
                match (ordinate, times) {
                    (Measure::Known(a), Measure::Known(b)) => Measure::Known(a * b),
                    (known, Measure::Bare) => known,
                    (Measure::Bare, known) => known,
                    _ => Measure::Unknown,
                }
            }
        };
        let unit = match measure {
            Measure::Known(dimension) => dimension.to_string(),
            _ => String::new(),
        };
        Some(UserParameter { value, unit })
    }

    /// The function's name and its source, or its path.
    fn user_function(&self, written: &Written, at: At<'_>) -> Option<(String, Option<UserSource>)> {
        let default = identifier(&written.user);
        let function = written.function.as_deref().unwrap_or(&default).trim();
        let place = at.key("function");
        let Some(file) = &written.source else {
            return self
                .user_path(function, written, at)
                .map(|path| (path, None));
        };
        if function.contains("::") {
            self.problems.add(place.problem(
                format!(
                    "{} is a path, but the function stands in {}",
                    quoted(function),
                    quoted(file)
                ),
                "give the name of the function alone, or remove `source`",
            ));
            return None;
        }
        if syn::parse_str::<syn::Ident>(function).is_err() || function == "gen" {
            self.problems.add(place.problem(
                format!("{} cannot be the name of a function", quoted(function)),
                "write it as in the Rust file, such as `air_drag`",
            ));
            return None;
        }
        let path = beside(&at.source.name, file);
        let model = self.loaded.paths.first()?;
        let directory = model.parent().unwrap_or(Path::new(""));
        // the same from wherever the model is read
        let source = UserSource {
            name: shown(&relative(&path, directory)),
            // a text that could not be read is reported where it was; one that is to be written is not missed
            text: self.loaded.sources.get(&path).cloned().unwrap_or_default(),
        };
        Some((function.to_owned(), Some(source)))
    }

    /// A path that can be called from wherever the module is.
    fn user_path(&self, function: &str, written: &Written, at: At<'_>) -> Option<String> {
        let place = match written.function {
            Some(_) => at.key("function"),
            None => at.key("user"),
        };
        if !function.contains("::") {
            self.problems.add(place.problem(
                format!("the user force {} has no source", quoted(&written.user)),
                "add `source: FILE.rs`; a function of your crate is named by its path, such as `function: crate::aero::drag`",
            ));
            return None;
        }
        let words: Vec<&str> = function.split("::").collect();
        let first = words.first().copied().unwrap_or_default();
        let sound = words.iter().enumerate().all(|(index, word)| {
            syn::parse_str::<syn::Ident>(word).is_ok() || index == 0 && *word == "crate"
        });
        if !sound || ["self", "super", "Self"].contains(&first) {
            self.problems.add(place.problem(
                format!("{} is not the path of a function", quoted(function)),
                "begin with `crate::` or the name of a crate, such as `crate::aero::drag`",
            ));
            return None;
        }
        Some(function.to_owned())
    }

    /// Reports what is wrong with the file of a function.
    fn check_user_source(&self, written: &Written, user: &User, at: At<'_>) {
        let Some(file) = &written.source else { return };
        let path = beside(&at.source.name, file);
        let Some(text) = self.loaded.sources.get(&path) else {
            return;
        };
        fn names<T>(ports: &[Port<T>]) -> Vec<&str> {
            ports.iter().map(|port| port.name.as_str()).collect()
        }
        let entries = [
            ("points", names(&user.points)),
            ("bodies", names(&user.bodies)),
            ("lines", names(&user.lines)),
            ("joints", names(&user.joints)),
            ("freedoms", names(&user.freedoms)),
            ("parameters", names(&user.function.parameters)),
            ("curves", names(&user.function.curves)),
            ("states", names(&user.states)),
        ];
        let identifiers = |names: &Vec<&str>| names.iter().map(|name| identifier(name)).collect();
        let file = shown(&path);
        let wanted = Wanted {
            file: &file,
            force: &written.user,
            function: &user.function.name,
            names: &entries
                .each_ref()
                .map(|(kind, names)| (*kind, identifiers(names))),
        };
        for fault in rust::faults(text, &wanted) {
            let Fault {
                place,
                message,
                help,
            } = fault;
            let entry = |kind, index: usize| {
                let (_, names) = entries.iter().find(|(known, _)| *known == kind)?;
                Some(at.key(kind).key(names.get(index)?))
            };
            self.problems.add(match place {
                Place::File(line, column, length) => {
                    Diagnostic::at(&file, text, (line, column, length), message, help)
                }
                Place::Function if written.function.is_some() => {
                    at.key("function").problem(message, help)
                }
                Place::Function => at.key("source").problem(message, help),
                Place::Name(kind, index) => {
                    let at = entry(kind, index).unwrap_or(at);
                    at.key_problem(message, help)
                }
            });
        }
    }
}

/// A path as seen from a directory; both are relative to the same place.
fn relative(path: &Path, directory: &Path) -> PathBuf {
    if path.is_absolute() != directory.is_absolute() {
        return path.to_owned();
    }
    let (mut path, mut directory) = (
        path.components().peekable(),
        directory.components().peekable(),
    );
    while path.peek().is_some() && path.peek() == directory.peek() {
        path.next();
        directory.next();
    }
    let up = directory.map(|_| Component::ParentDir);
    up.chain(path).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_the_same_name_from_everywhere() {
        for (path, directory, name) in [
            ("models/drag.rs", "models", "drag.rs"),
            ("drag.rs", "", "drag.rs"),
            ("/a/models/parts/drag.rs", "/a/models", "parts/drag.rs"),
            ("../models/drag.rs", "models", "../../models/drag.rs"),
            (
                "/a/models/drag.rs",
                "/a/tests/models",
                "../../models/drag.rs",
            ),
            ("/a/drag.rs", "models", "/a/drag.rs"),
        ] {
            let found = relative(Path::new(path), Path::new(directory));
            assert_eq!(found, Path::new(name), "{path} from {directory}");
        }
    }
}
