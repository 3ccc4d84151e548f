//! User forces: the points, bodies and so on that the function reads and acts on, its other arguments, and the function
//! itself.

use crate::description::curve::{Function, FunctionOf, OverTime, ScaledCurve as WrittenScaled};
use crate::description::load::{beside, shown};
use crate::description::measure::{Any, TIME};
use crate::description::place::At;
use crate::description::point::Point;
use crate::description::shape::Named;
use crate::description::unit::Dimension as UnitDimension;
use crate::diagnostic::{Diagnostic, quoted};
use crate::law::user::keys::{
    User as Written, UserFreedom as WrittenFreedom, UserLine as WrittenLine, UserPoint,
    UserState as WrittenState,
};
use crate::model::Joint;
use crate::model::resolve::Resolver;
use crate::model::resolve::joint::freedom_named;
use crate::model::resolve::name::{Style, identifier};
use crate::model::resolve::quantity::Measure;
use crate::model::resolve::run::time;
use crate::model::resolve::rust::{self, Fault, FaultPlace, Wanted};
use crate::model::{Attachment, Body, Dimension, ElementId, FieldComponent, Number, ScaledCurve};
use serde::Serialize;
use std::path::{Component, Path, PathBuf};

/// Largest number of ports of one kind.
const MAX_PORTS: usize = 100;

/// A force computed by a Rust function of the user's.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct User {
    /// The function that is called.
    pub function: UserFunction,
    /// The dimension of the function's vectors, which may differ from that of the motion.
    pub dimension: Dimension,
    /// The longest step \[s\], positive; `None` for the time between samples.
    pub scale: Option<f64>,
    /// Points: the function gets position and velocity, and returns a force.
    pub points: Vec<Port<Attachment>>,
    /// Elements: the function gets orientation and angular velocity, and returns a moment.
    pub bodies: Vec<Port<ElementId>>,
    /// Lines: the function gets the length and its rate, and returns a tension.
    pub lines: Vec<Port<UserLine>>,
    /// Joints, each given by the element that it carries: the function gets relative angles and rates, and returns
    /// torques.
    pub joints: Vec<Port<ElementId>>,
    /// Freedoms of joints: the function gets coordinate and rate, and returns a torque or force along the coordinate.
    pub freedoms: Vec<Port<UserFreedom>>,
    /// State variables: the function gets the value, and returns its rate.
    pub states: Vec<Port<UserState>>,
}

/// A function, and those of its arguments that do not depend on the motion.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UserFunction {
    /// Name of the function in its source; its path (`crate::aero::drag`) if there is no source; empty if the function
    /// is left out.
    pub name: String,
    /// The text with the function; `None` if the crate that includes the generated module has the function.
    pub source: Option<UserSource>,
    /// Parameters: numbers and curves of time.
    pub parameters: Vec<Port<UserParameter>>,
    /// Curves that the function looks up; `None` for a curve that is zero everywhere.
    pub curves: Vec<Port<Option<ScaledCurve>>>,
}

/// Rust text of the user's.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UserSource {
    /// Path of the file, relative to the file of the model.
    pub name: String,
    /// The text, with lines that end in `\n`.
    pub text: String,
}

/// A value with a name that the user gave it. With underscores in place of dashes, the name is an identifier.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Port<T> {
    /// The name as in the YAML.
    pub name: String,
    /// The value.
    pub value: T,
}

/// A straight line between two points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UserLine {
    /// One end.
    pub from: Attachment,
    /// The other end.
    pub to: Attachment,
}

/// A freedom of a joint with coordinates of its own.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UserFreedom {
    /// The element that the joint carries.
    pub element: ElementId,
    /// Index of the freedom among those of the joint.
    pub freedom: usize,
    /// True if the freedom turns, false if it slides.
    pub turns: bool,
}

/// A number or a curve of time, in SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UserParameter {
    /// The value.
    pub value: FieldComponent,
    /// SI unit; "" if the number has none or it is unknown.
    pub unit: String,
}

/// A state variable.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UserState {
    /// Value at the start of a run.
    pub initial: Number,
    /// SI unit; "" if the number has none.
    pub unit: &'static str,
    /// SI unit of its rate.
    pub rate_unit: &'static str,
}

impl User {
    /// Names of the results of the function, in their order: a force for each point, a moment for each body, a tension
    /// for each line, torques for each joint, an effort for each freedom, a rate for each state. Vectors have a name
    /// for each component; components that do not exist in the plane are left out.
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

    /// Number of points, bodies, lines, joints and so on that the function acts on.
    pub fn ports(&self) -> usize {
        self.points.len()
            + self.bodies.len()
            + self.lines.len()
            + self.joints.len()
            + self.freedoms.len()
    }
}

/// The checked form of a user force.
pub(crate) fn user(resolver: &mut Resolver<'_>, written: &Written, at: At<'_>) -> Option<User> {
    let before = resolver.problems.count();
    let entries = Entries::of(resolver, written, at);
    if entries.act_on_nothing() {
        resolver.problems.add(at.key("user").key_problem(
            format!("the user force {} acts on nothing", quoted(&written.user)),
            "give it `points`, `bodies`, `lines`, `joints` or `freedoms`",
        ));
    }
    let user = entries.checked(resolver, written, at)?;
    if resolver.problems.count() > before {
        return None;
    }
    check_user_source(resolver, written, &user, at);
    if resolver.problems.count() > before {
        return None;
    }
    check_own_file(resolver, &user, at);
    Some(user)
}

/// Reports a source file that holds another user force's function, too.
fn check_own_file(resolver: &Resolver<'_>, user: &User, at: At<'_>) {
    let others = resolver.forces.iter();
    let others = others.filter_map(|force| force.law.get::<User>());
    if let Some(source) = &user.function.source
        && let Some(other) = others
            .filter(|other| other.function.source.as_ref() == Some(source))
            .find(|other| other.function.name != user.function.name)
    {
        resolver.problems.add(at.key("source").problem(
            format!(
                "{} has the function {} of another user force",
                quoted(&source.name),
                quoted(&other.function.name)
            ),
            "give each function a file of its own; it may hold other functions that help it",
        ));
    }
}

/// The entries of one kind: name, value as written, and place.
type Listed<'w, T> = Vec<(&'w str, &'w T, At<'w>)>;

/// The entries of a user force that have usable names.
struct Entries<'w> {
    points: Listed<'w, UserPoint>,
    bodies: Listed<'w, String>,
    lines: Listed<'w, WrittenLine>,
    joints: Listed<'w, String>,
    freedoms: Listed<'w, WrittenFreedom>,
    states: Listed<'w, WrittenState>,
    parameters: Listed<'w, OverTime<Any>>,
    curves: Listed<'w, FunctionOf<Any, Any>>,
}

impl<'w> Entries<'w> {
    /// The entries of a user force. Names of parameters need only differ from each other, and so do names of curves;
    /// all other names must differ.
    fn of(resolver: &Resolver<'_>, written: &'w Written, at: At<'w>) -> Self {
        let mut taken = Vec::new();
        let mut apart = [Vec::new(), Vec::new()];
        let place = |key| at.key(key);
        Entries {
            points: ports(
                resolver,
                &written.points,
                place("points"),
                "a point",
                &mut taken,
            ),
            bodies: ports(
                resolver,
                &written.bodies,
                place("bodies"),
                "a body",
                &mut taken,
            ),
            lines: ports(
                resolver,
                &written.lines,
                place("lines"),
                "a line",
                &mut taken,
            ),
            joints: ports(
                resolver,
                &written.joints,
                place("joints"),
                "a joint",
                &mut taken,
            ),
            freedoms: ports(
                resolver,
                &written.freedoms,
                place("freedoms"),
                "a freedom",
                &mut taken,
            ),
            states: ports(
                resolver,
                &written.states,
                place("states"),
                "a state",
                &mut taken,
            ),
            parameters: ports(
                resolver,
                &written.parameters,
                place("parameters"),
                "a parameter",
                &mut apart[0],
            ),
            curves: ports(
                resolver,
                &written.curves,
                place("curves"),
                "a curve",
                &mut apart[1],
            ),
        }
    }

    fn act_on_nothing(&self) -> bool {
        self.points.is_empty()
            && self.bodies.is_empty()
            && self.lines.is_empty()
            && self.joints.is_empty()
            && self.freedoms.is_empty()
    }

    /// The user force with its valid entries; `None` if its function is wrong.
    fn checked(self, resolver: &mut Resolver<'_>, written: &Written, at: At<'_>) -> Option<User> {
        let points = each(self.points, |_, point, at| user_point(resolver, point, at));
        let bodies = each(self.bodies, |_, path, at| acted_on(resolver, path, at));
        let joints = each(self.joints, |_, path, at| acted_on(resolver, path, at));
        let freedoms = each(self.freedoms, |_, freedom, at| {
            user_freedom(resolver, freedom, at)
        });
        let lines = each(self.lines, |_, line, at| user_line(resolver, line, at));
        let states = each(self.states, |_, state, at| user_state(resolver, state, at));
        let parameters = each(self.parameters, |_, function, at| {
            user_parameter(resolver, function, at)
        });
        let curves = each(self.curves, |_, function, at| {
            Some(resolver.function(function, at))
        });
        let (function, source) = user_function(resolver, written, at)?;
        let scale = written.scale.as_deref();
        let scale = scale.map(|_| time(resolver, scale, at.key("scale"), f64::INFINITY));
        Some(User {
            function: UserFunction {
                name: function,
                source,
                parameters,
                curves,
            },
            dimension: resolver.dimension(),
            scale,
            points,
            bodies,
            lines,
            joints,
            freedoms,
            states,
        })
    }
}

/// The entries of one kind that have usable names, with their places.
fn ports<'w, T>(
    resolver: &Resolver<'_>,
    written: &'w Option<Named<T>>,
    at: At<'w>,
    what: &str,
    taken: &mut Vec<&'w str>,
) -> Listed<'w, T> {
    let entries: &[(String, T)] = written.as_ref().map_or(&[], |named| &named.0);
    if entries.len() > MAX_PORTS {
        resolver.problems.add(at.key_problem(
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
        let unique = || resolver.check_unique(name, "entries", taken.iter().copied(), place);
        if resolver.check_name(name, &what, Style::Either, place) && unique() {
            ports.push((name.as_str(), value, here));
        }
        taken.push(name);
    }
    ports
}

/// The checked forms of the valid entries.
fn each<T, U>(
    listed: Listed<'_, T>,
    mut check: impl FnMut(&str, &T, At<'_>) -> Option<U>,
) -> Vec<Port<U>> {
    let mut checked = Vec::with_capacity(listed.len());
    for (name, value, at) in listed {
        if let Some(value) = check(name, value, at) {
            checked.push(Port {
                name: name.to_owned(),
                value,
            });
        }
    }
    checked
}

/// The checked form of a point at which the function acts.
fn user_point(resolver: &Resolver<'_>, written: &UserPoint, at: At<'_>) -> Option<Attachment> {
    let on = resolver.body(&written.on, at.key("on"))?;
    let position = match (&written.at, on) {
        (point, Body::Element(id)) => resolver.point(point, id, at.key("at")),
        (Point::At(point), _) => resolver.vector(point, at.key("at")),
        (Point::Cg, _) => {
            resolver.problems.add(at.key("at").problem(
                format!("{} has no centre of gravity", quoted(&written.on)),
                "give coordinates",
            ));
            return None;
        }
    };
    Some(Attachment { on, at: position })
}

/// The checked form of a line, which must run between two bodies.
fn user_line(resolver: &Resolver<'_>, written: &WrittenLine, at: At<'_>) -> Option<UserLine> {
    let from = resolver.end(&written.from, at.key("from"));
    let to = resolver.end(&written.to, at.key("to"));
    let (from, to) = (from?, to?);
    if from.on == to.on {
        resolver.problems.add(at.key("to").problem(
            "both ends of this line are on the same body",
            "a line runs between two bodies; `frame` is the absolute frame",
        ));
    }
    Some(UserLine { from, to })
}

/// The element that the function acts on. The absolute frame is refused, as it neither turns nor has a joint.
fn acted_on(resolver: &Resolver<'_>, path: &str, at: At<'_>) -> Option<ElementId> {
    if path == "frame" {
        resolver.problems.add(at.problem(
            "a moment on the absolute frame moves nothing",
            "name an element, as `system/element`",
        ));
        return None;
    }
    resolver.element_id(path, at)
}

/// The checked form of a freedom of a joint with coordinates of its own.
fn user_freedom(
    resolver: &Resolver<'_>,
    written: &WrittenFreedom,
    at: At<'_>,
) -> Option<UserFreedom> {
    let element = resolver.element_id(&written.joint, at.key("joint"))?;
    let joint = &resolver.systems[element.system].elements[element.element].joint;
    let Joint::Freedoms(freedoms) = joint else {
        resolver.problems.add(at.key("joint").problem(
            format!(
                "{} is on a joint without coordinates of its own",
                quoted(&written.joint)
            ),
            "name it under `joints`, or give the element a `joint:`",
        ));
        return None;
    };
    let name = written.freedom.as_deref();
    let freedom = freedom_named(resolver, name, &written.joint, freedoms, at)?;
    Some(UserFreedom {
        element,
        freedom,
        turns: freedoms[freedom].kind.turns(),
    })
}

/// The checked form of a state: its initial value, its unit, and that of its rate.
fn user_state(resolver: &Resolver<'_>, written: &WrittenState, at: At<'_>) -> Option<UserState> {
    let place = at.key("initial");
    let (initial, measure) = resolver.measured(&written.initial, place)?;
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

/// The checked form of a parameter, with its unit if that is known.
fn user_parameter(
    resolver: &mut Resolver<'_>,
    written: &OverTime<Any>,
    at: At<'_>,
) -> Option<UserParameter> {
    let before = resolver.problems.count();
    let value = resolver.component(written, at);
    if resolver.problems.count() > before {
        return None;
    }
    let measure = match (&value, &**written) {
        (FieldComponent::Constant(_), Function::Quantity(quantity)) => {
            resolver.measured(quantity, at)?.1
        }
        (FieldComponent::Constant(_), _) => Measure::Unknown,
        (FieldComponent::Curve(curve), written) => {
            let times = match written {
                Function::Scaled(WrittenScaled {
                    times: Some(times), ..
                }) => resolver.measured(times, at.key("times"))?.1,
                _ => Measure::Bare,
            };
            let ordinate = resolver.curves.get(curve.curve)?.as_ref()?.measures[1];
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

/// The name of the function and its source; or the path of the function, without a source.
fn user_function(
    resolver: &Resolver<'_>,
    written: &Written,
    at: At<'_>,
) -> Option<(String, Option<UserSource>)> {
    let default = identifier(&written.user);
    let function = written.function.as_deref().unwrap_or(&default).trim();
    let place = at.key("function");
    let Some(file) = &written.source else {
        return user_path(resolver, function, written, at).map(|path| (path, None));
    };
    if function.contains("::") {
        resolver.problems.add(place.problem(
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
        resolver.problems.add(place.problem(
            format!("{} cannot be the name of a function", quoted(function)),
            "write it as in the Rust file, such as `air_drag`",
        ));
        return None;
    }
    let path = beside(&at.source.name, file);
    let model = resolver.loaded.paths.first()?;
    let directory = model.parent().unwrap_or(Path::new(""));
    // a path that does not depend on where the model is read from
    let source = UserSource {
        name: shown(&relative(&path, directory)),
        // an unreadable text has been reported when it was read; a text that is still to be written may be missing
        text: resolver
            .loaded
            .sources
            .get(&path)
            .cloned()
            .unwrap_or_default(),
    };
    Some((function.to_owned(), Some(source)))
}

/// The path of the function, checked: it must be valid wherever the generated module is.
fn user_path(
    resolver: &Resolver<'_>,
    function: &str,
    written: &Written,
    at: At<'_>,
) -> Option<String> {
    let place = match written.function {
        Some(_) => at.key("function"),
        None => at.key("user"),
    };
    if !function.contains("::") {
        resolver.problems.add(place.problem(
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
    if !sound || ["resolver", "super", "Self"].contains(&first) {
        resolver.problems.add(place.problem(
            format!("{} is not the path of a function", quoted(function)),
            "begin with `crate::` or the name of a crate, such as `crate::aero::drag`",
        ));
        return None;
    }
    Some(function.to_owned())
}

/// Reports problems in the source file of a function.
fn check_user_source(resolver: &Resolver<'_>, written: &Written, user: &User, at: At<'_>) {
    let Some(file) = &written.source else { return };
    let path = beside(&at.source.name, file);
    let Some(text) = resolver.loaded.sources.get(&path) else {
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
        resolver.problems.add(match place {
            FaultPlace::File(line, column, length) => {
                Diagnostic::at(&file, text, (line, column, length), message, help)
            }
            FaultPlace::Function if written.function.is_some() => {
                at.key("function").problem(message, help)
            }
            FaultPlace::Function => at.key("source").problem(message, help),
            FaultPlace::Name(kind, index) => {
                let at = entry(kind, index).unwrap_or(at);
                at.key_problem(message, help)
            }
        });
    }
}

/// A path relative to a directory. Both must be absolute, or relative to the same directory.
pub fn relative(path: &Path, directory: &Path) -> PathBuf {
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
