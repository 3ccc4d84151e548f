//! Outputs: their quantities, and the units of their columns.

use super::channel::{self, Wanted};
use super::joint::freedom_named;
use super::units::unit_shown;
use super::vehicle::vehicle_named;
use super::{NOWHERE, Resolver};
use crate::description::force::LawKeys;
use crate::description::output::{Axis, Component as WrittenComponent, Output as Written};
use crate::description::place::At;
use crate::description::point::Point;
use crate::diagnostic::{nearest, quoted, suggestion};
use crate::model::law::OfLaw;
use crate::model::{
    Body, Component, ElementId, FreedomQuantity, JointLoadQuantity, Number, Output, PointQuantity,
    Projection, Quantity, Reference, RotationQuantity, SwitchQuantity, SystemQuantity,
};

/// Longest heading \[characters\].
const MAX_HEADING: usize = 80;

/// A quantity of an element or a vehicle.
#[derive(Clone, Copy)]
enum OfBody {
    Point(PointQuantity),
    Rotation(RotationQuantity),
}

use OfBody::{Point as P, Rotation as R};

/// Name, unit and quantity for outputs of a body. The last one exists for elements only.
const OF_BODY: [(&str, &str, OfBody); 8] = [
    ("position", "m", P(PointQuantity::Position)),
    ("displacement", "m", P(PointQuantity::Displacement)),
    ("velocity", "m/s", P(PointQuantity::Velocity)),
    ("acceleration", "m/s^2", P(PointQuantity::Acceleration)),
    ("angle", "rad", R(RotationQuantity::Angle)),
    (
        "angular_velocity",
        "rad/s",
        R(RotationQuantity::AngularVelocity),
    ),
    (
        "angular_acceleration",
        "rad/s^2",
        R(RotationQuantity::AngularAcceleration),
    ),
    ("accelerometer", "m/s^2", P(PointQuantity::Accelerometer)),
];

/// Name, unit and quantity for outputs of a freedom: one that turns, and one that slides.
const OF_FREEDOM: [[(&str, &str, FreedomQuantity); 3]; 2] = [
    [
        ("angle", "rad", FreedomQuantity::Position),
        ("rate", "rad/s", FreedomQuantity::Rate),
        ("acceleration", "rad/s^2", FreedomQuantity::Acceleration),
    ],
    [
        ("position", "m", FreedomQuantity::Position),
        ("rate", "m/s", FreedomQuantity::Rate),
        ("acceleration", "m/s^2", FreedomQuantity::Acceleration),
    ],
];

/// Loads in every joint, whether a law acts in it or not.
const OF_ANY_JOINT: [(&str, &str, JointLoadQuantity); 2] = [
    ("force", "N", JointLoadQuantity::Force),
    ("moment", "N*m", JointLoadQuantity::Moment),
];

const OF_SYSTEM: [(&str, &str, SystemQuantity); 4] = [
    ("kinetic_energy", "J", SystemQuantity::KineticEnergy),
    ("momentum", "kg*m/s", SystemQuantity::Momentum),
    (
        "angular_momentum",
        "kg*m^2/s",
        SystemQuantity::AngularMomentum,
    ),
    ("position", "m", SystemQuantity::Position),
];

const OF_SWITCH: [(&str, &str, SwitchQuantity); 2] = [
    ("acts", "", SwitchQuantity::Acts),
    ("time", "s", SwitchQuantity::Time),
];

/// The object that the key `of` names.
enum Subject {
    Element(ElementId),
    System(usize),
    Vehicle(usize),
    Force(usize),
    Joint(ElementId),
    Freedom(ElementId),
    Switch(usize),
}

/// The checked form of an output; `None` if it is wrong or switched off. `headings` are the headings so far, including
/// those of outputs that are switched off.
pub(super) fn output(
    resolver: &mut Resolver<'_>,
    written: &Written,
    at: At<'_>,
    headings: &mut Vec<String>,
) -> Option<Output> {
    heading(resolver, &written.name, at.key("name"), headings);
    let off = written.enabled == Some(false);
    let code = written.code.clone();
    if let Some(code) = &code {
        let filter = written.filter.map(|class| class.said().1);
        check_code(resolver, code, filter, at.key("code"));
    }
    let quantity = match &code {
        Some(_) => resolver.quantity(&channel::with_axes(resolver, written), at, off),
        None => resolver.quantity(written, at, off),
    };
    let (quantity, unit) = quantity.filter(|_| !off)?;
    let (quantity, channel) = match code
        .as_deref()
        .zip(code.as_deref().and_then(channel::direction))
    {
        Some((code, direction)) => {
            let wanted = Wanted {
                direction,
                upper_neck: channel::is_upper_neck(code),
                says_axes: written.axes.is_some(),
                by: &format!("the channel code {code}"),
                at: at.key("code"),
            };
            // after a problem with the channel, the rest is checked all the same
            match channel::channel(resolver, quantity.clone(), wanted) {
                Some((quantity, channel)) => (quantity, Some(channel)),
                None => (quantity, None),
            }
        }
        None => (quantity, None),
    };
    if written.filter.is_some() && quantity.is_resultant() {
        resolver.problems.add(at.key("filter").problem(
            "a resultant is not filtered: sensors measure components, and their filtered values make the resultant",
            "give `component: [x, y, z]`, or leave the filter to `criteria`, which filter components first",
        ));
    }
    if let Some(shown) = &written.unit {
        unit_shown(resolver, shown, unit, &written.name, at.key("unit"));
    }
    Some(Output {
        name: written.name.clone(),
        quantity,
        unit: unit.to_owned(),
        code,
        filter: written.filter.map(|class| class.said().0),
        channel,
    })
}

/// Reports a channel code that is invalid, that another output has, or that contradicts the filter of the output.
fn check_code(resolver: &Resolver<'_>, code: &str, filter: Option<u16>, at: At<'_>) {
    let is_code = code.len() == 16
        && code
            .bytes()
            .all(|byte| byte.is_ascii_uppercase() || byte.is_ascii_digit());
    if !is_code {
        resolver.problems.add(at.problem(
            format!("{} is no channel code", quoted(code)),
            "a channel code of ISO-MME has 16 capital letters and digits, such as 11HEADCG00H3ACXA; of several components it has ? as its 15th character",
        ));
    }
    let said = match code.chars().last() {
        Some('A') => Some(1000),
        Some('B') => Some(600),
        Some('C') => Some(180),
        Some('D') => Some(60),
        _ => None,
    };
    if let Some(filter) = filter.filter(|filter| is_code && said != Some(*filter)) {
        resolver.problems.add(at.problem(
            format!("the last character of the channel code {code} does not say the filter of the output, CFC{filter}"),
            "end the code with A for CFC1000, B for CFC600, C for CFC180, D for CFC60",
        ));
    }
    let other = resolver
        .outputs
        .iter()
        .find(|other| other.code.as_deref() == Some(code));
    if let Some(other) = other {
        resolver.problems.add(at.problem(
            format!("the output {} has the channel code {code}, too", quoted(&other.name)),
            "give each output a code of its own; of two sides one has LE and the other RI as its seventh and eighth characters",
        ));
    }
}

/// Reports a heading that is invalid or too similar to another; adds it to `headings`.
pub(super) fn heading(resolver: &Resolver<'_>, name: &str, at: At<'_>, headings: &mut Vec<String>) {
    let plain = |name: &str| {
        name.to_lowercase()
            .replace(|c: char| !c.is_alphanumeric(), "_")
    };
    if name.trim().is_empty()
        || name.chars().count() > MAX_HEADING
        || name.chars().any(char::is_control)
    {
        resolver.problems.add(at.problem(
            format!(
                "the heading {} is empty, too long or not one line",
                quoted(name)
            ),
            format!("a heading has 1 to {MAX_HEADING} characters"),
        ));
    }
    if name.trim() == "time" {
        resolver.problems.add(at.problem(
            "an output cannot be called \"time\": that is the first column of the table",
            "give it another name",
        ));
    }
    if let Some(other) = headings.iter().find(|h| plain(h) == plain(name)) {
        resolver.problems.add(at.problem(
            if other == name {
                format!("there are two outputs called {}", quoted(name))
            } else {
                format!(
                    "the outputs {} and {} differ in capitals and signs only",
                    quoted(other),
                    quoted(name)
                )
            },
            "give one of them another name: headings of the table, files of plots and words on the command line tell names by their \
             letters and digits",
        ));
    }
    headings.push(name.to_owned());
}

impl Resolver<'_> {
    /// The quantity that an output asks for, and its unit. If `off` is true, the output is switched off, and its force
    /// may be switched off too.
    pub fn quantity(
        &self,
        written: &Written,
        at: At<'_>,
        off: bool,
    ) -> Option<(Quantity, &'static str)> {
        let subject = self.subject(written, at, off)?;
        if let Subject::Force(force) = subject {
            let outputs = (self.kinds.outputs)(&self.forces[force]);
            return outputs.output(self, written, force, at);
        }
        self.without(at, &["segment", "ring"], "anything but a belt");
        match subject {
            Subject::Element(_) | Subject::Vehicle(_) | Subject::System(_) => {
                self.without(at, &["about"], "anything but a joint");
                self.without(
                    at,
                    &["on"],
                    "anything but the force of a joint, a contact, a belt or a spring",
                );
            }
            Subject::Freedom(_) => self.without(
                at,
                &["at", "about", "component", "axes", "relative_to", "on"],
                "a freedom of a joint",
            ),
            Subject::Joint(_) => self.without(
                at,
                &["at", "about", "relative_to"],
                "what a joint transmits",
            ),
            Subject::Force(_) => {}
            Subject::Switch(_) => self.without(
                at,
                &["at", "component", "about", "axes", "relative_to", "on"],
                "a switch",
            ),
        }
        match subject {
            Subject::Element(element) => self.of_body(written, Body::Element(element), at),
            Subject::Vehicle(vehicle) => self.of_body(written, Body::Vehicle(vehicle), at),
            Subject::System(system) => self.of_system(written, system, at),
            Subject::Freedom(element) => self.of_freedom(written, element, at),
            Subject::Joint(element) => self.of_any_joint(written, element, at),
            Subject::Force(_) => None,
            Subject::Switch(switch) => self
                .look_up(written, &OF_SWITCH, "a switch", at)
                .map(|(what, unit)| (Quantity::Switch { switch, what }, unit)),
        }
    }

    /// The object that `of` names; reports if there is none. If `off` is true, a force that is switched off counts,
    /// too.
    fn subject(&self, written: &Written, at: At<'_>, off: bool) -> Option<Subject> {
        let (of, at) = (written.of.as_str(), at.key("of"));
        let words: Vec<&str> = of.split_whitespace().collect();
        match words[..] {
            ["system", name] => self.system_named(name, at).map(Subject::System),
            ["vehicle", name] => vehicle_named(self, name, at).map(Subject::Vehicle),
            ["switch", name] => self.switch_id(name, at).map(Subject::Switch),
            [name] if self.vehicles.iter().any(|v| v.name == name) => {
                vehicle_named(self, name, at).map(Subject::Vehicle)
            }
            [path] if path.contains('/') => self.element_id(path, at).map(Subject::Element),
            [name] => match self.systems.iter().position(|s| s.name == name) {
                Some(system) => Some(Subject::System(system)),
                None => {
                    self.nothing_called(name, at);
                    None
                }
            },
            ["joint", name] if self.has_freedoms(name, &written.what) => {
                self.element_id(name, at).map(Subject::Freedom)
            }
            ["joint", name] if OF_ANY_JOINT.iter().any(|(what, ..)| *what == written.what) => {
                self.element_id(name, at).map(Subject::Joint)
            }
            [kind, name] => self
                .force_named([kind, name], of, at, off)
                .map(Subject::Force),
            _ => {
                self.problems
                    .add(at.problem(format!("{} names nothing", quoted(of)), OF_HELP));
                None
            }
        }
    }

    /// Reports a single word that names no system, vehicle or element.
    fn nothing_called(&self, name: &str, at: At<'_>) {
        let mut forces = self.forces.iter().filter(|f| f.name == name);
        let force = forces.find(|f| self.observable().any(|law| law.key == f.law.key()));
        let element = self
            .paths
            .iter()
            .find(|p| p.rsplit('/').next() == Some(name));
        let help = match (force, element) {
            (Some(force), _) => format!(
                "did you mean {}?",
                quoted(&format!("{} {name}", force.law.key()))
            ),
            (_, Some(path)) => format!(
                "elements are named with their system; did you mean {}?",
                quoted(path)
            ),
            _ => OF_HELP.to_owned(),
        };
        self.problems
            .add(at.problem(format!("there is nothing called {}", quoted(name)), help));
    }

    /// The laws that have outputs.
    fn observable(&self) -> impl Iterator<Item = &'static LawKeys> + use<> {
        let laws = self.kinds.language.laws.iter();
        laws.filter(|law| law.is_observable)
    }

    /// The force that `of` names, by its law and name.
    fn force_named(
        &self,
        [kind, name]: [&str; 2],
        of: &str,
        at: At<'_>,
        off: bool,
    ) -> Option<usize> {
        let Some(law) = self.observable().find(|law| law.key == kind) else {
            let message = match self.kinds.language.laws.iter().find(|law| law.key == kind) {
                Some(law) => format!("{} is given and has no outputs", law.title),
                None => format!("there is no output of {}", quoted(of)),
            };
            let laws = self.observable().map(|law| law.key);
            let near = nearest(kind, laws.chain(["system", "switch", "vehicle"]));
            let help = match near {
                Some(near) => format!("did you mean \"{near} {name}\"?"),
                None => OF_HELP.to_owned(),
            };
            self.problems.add(at.problem(message, help));
            return None;
        };
        let called = law.called();
        let name = match name.split_once('/') {
            Some((name, _)) if law.has_ports => name,
            _ => name,
        };
        let found = self
            .forces
            .iter()
            .position(|f| f.law.key() == kind && f.name == name);
        if found.is_none() {
            if self
                .disabled
                .iter()
                .any(|(k, n)| *k == law.key && n == name)
            {
                // a force may also be missing because it is wrong, which has been reported
                if !off && self.problems.count() == 0 {
                    self.problems.add(at.problem(
                        format!("the {called} {} is switched off", quoted(name)),
                        "give the output `enabled: false` too, or switch the force on",
                    ));
                }
            } else {
                let names = self.forces.iter().filter(|f| f.law.key() == kind);
                let names: Vec<&str> = names.map(|f| f.name.as_str()).collect();
                self.problems.add(at.problem(
                    format!("there is no {called} {} among the forces", quoted(name)),
                    suggestion(name, names, &format!("add a force `{kind}: {name}`")),
                ));
            }
        }
        found
    }

    fn system_named(&self, name: &str, at: At<'_>) -> Option<usize> {
        let found = self.systems.iter().position(|s| s.name == name);
        if found.is_none() {
            self.problems.add(at.problem(
                format!("there is no system {}", quoted(name)),
                suggestion(
                    name,
                    self.systems.iter().map(|s| s.name.as_str()),
                    "the model has no systems",
                ),
            ));
        }
        found
    }

    pub fn look_up<T: Copy>(
        &self,
        written: &Written,
        table: &[(&'static str, &'static str, T)],
        of: &str,
        at: At<'_>,
    ) -> Option<(T, &'static str)> {
        let found = table.iter().find(|(name, ..)| *name == written.what);
        if found.is_none() {
            let all = table.iter().map(|(name, ..)| *name).collect::<Vec<_>>();
            let list = all
                .iter()
                .map(|n| format!("`{n}`"))
                .collect::<Vec<_>>()
                .join(", ");
            self.problems.add(at.key("what").problem(
                format!("{of} has no quantity {}", quoted(&written.what)),
                match nearest(&written.what, all) {
                    Some(near) => format!("did you mean `{near}`? There are {list}"),
                    None => format!("there are {list}"),
                },
            ));
        }
        found.map(|&(_, unit, what)| (what, unit))
    }

    fn of_body(
        &self,
        written: &Written,
        body: Body,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        let (table, of) = match body {
            Body::Element(_) => (&OF_BODY[..], "an element"),
            _ => (&OF_BODY[..OF_BODY.len() - 1], "a vehicle"),
        };
        let (what, unit) = self.look_up(written, table, of, at)?;
        let relative_to = match &written.relative_to {
            None => Body::Frame,
            Some(path) => self.body(path, at.key("relative_to"))?,
        };
        if relative_to == body {
            self.problems.add(at.key("relative_to").problem(
                format!("{} does not move relative to itself", quoted(&written.of)),
                "name another body",
            ));
            return None;
        }
        let quantity = match what {
            P(what) => {
                if what == PointQuantity::Accelerometer {
                    self.without(at, &["relative_to"], "what an accelerometer reads");
                }
                Quantity::Point {
                    body,
                    at: self.point_of_body(written, body, at)?,
                    what,
                    relative_to,
                    projection: Projection {
                        component: self.component_of_vector(written, at)?,
                        axes: self.axes(written, Some(body), relative_to, at)?,
                    },
                }
            }
            R(what) => {
                self.without(at, &["at"], "rotations, which all points of a body share");
                let axes = match what {
                    RotationQuantity::Angle => {
                        self.without(at, &["axes"], "an angle");
                        Body::Frame
                    }
                    _ => self.axes(written, Some(body), relative_to, at)?,
                };
                Quantity::Rotation {
                    body,
                    what,
                    relative_to,
                    projection: Projection {
                        component: self.component_of_rotation(
                            written,
                            what == RotationQuantity::Angle,
                            at,
                        )?,
                        axes,
                    },
                }
            }
        };
        Some((quantity, unit))
    }

    /// The point of a body that an output observes.
    fn point_of_body(&self, written: &Written, body: Body, at: At<'_>) -> Option<[Number; 3]> {
        let place = at.key("at");
        match (body, &written.at) {
            (Body::Element(id), point) => {
                Some(self.point(point.as_ref().unwrap_or(&Point::Cg), id, place))
            }
            (_, None) => Some(NOWHERE),
            (_, Some(Point::At(point))) => Some(self.vector(point, place)),
            (_, Some(Point::Cg)) => {
                self.problems.add(place.problem(
                    "a vehicle has no mass, and so no centre of gravity",
                    "give the coordinates of the point, or leave `at` out for the origin of the vehicle",
                ));
                None
            }
        }
    }

    /// The body whose axes define the components of a vector: the one that is written, otherwise the observer's.
    /// `local` is the body itself.
    pub fn axes(
        &self,
        written: &Written,
        local: Option<Body>,
        observer: Body,
        at: At<'_>,
    ) -> Option<Body> {
        let place = at.key("axes");
        match (written.axes.as_deref(), local) {
            (None, _) => Some(observer),
            (Some("local"), Some(body)) => Some(body),
            (Some("local"), None) => {
                self.problems.add(place.problem(
                    "a whole system has no axes of its own",
                    "name a body, such as `axes: man/torso`",
                ));
                None
            }
            (Some(path), _) => self.body(path, place),
        }
    }

    /// True if the path is an element whose joint has coordinates of its own, and `what` is a quantity of these.
    fn has_freedoms(&self, path: &str, what: &str) -> bool {
        let element = self.elements.get(path);
        let element = element.map(|id| &self.systems[id.system].elements[id.element]);
        let asked = OF_FREEDOM.iter().flatten().any(|(name, ..)| *name == what);
        asked && element.is_some_and(|e| e.joint.turns_with_carrier())
    }

    /// An output of the coordinate of a freedom of a joint.
    fn of_freedom(
        &self,
        written: &Written,
        element: ElementId,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        let joint = &self.systems[element.system].elements[element.element].joint;
        let freedoms = joint.freedoms();
        let name = written.freedom.as_deref();
        let freedom = freedom_named(self, name, &self.path(element), freedoms, at)?;
        let table = &OF_FREEDOM[usize::from(!freedoms[freedom].kind.turns())];
        let (what, unit) = self.look_up(written, table, "this freedom", at)?;
        let quantity = Quantity::Freedom {
            element,
            freedom,
            what,
        };
        Some((quantity, unit))
    }

    /// An output of the load in a joint.
    fn of_any_joint(
        &self,
        written: &Written,
        element: ElementId,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        let (what, unit) = self.look_up(written, &OF_ANY_JOINT, "a joint", at)?;
        let system = &self.systems[element.system];
        let carrier = match (system.elements[element.element].parent, &system.reference) {
            (Some(parent), _) => Body::Element(ElementId {
                system: element.system,
                element: parent,
            }),
            (None, Reference::Riding { vehicle, .. }) => Body::Vehicle(*vehicle),
            (None, Reference::Fixed | Reference::Prescribed(_)) => Body::Frame,
            (None, Reference::Free) => {
                self.problems.add(at.key("of").problem(
                    format!(
                        "nothing carries {}: the reference joint of a free system transmits nothing",
                        quoted(&self.path(element))
                    ),
                    "name an element that another one carries; the torque of a law in this joint is `what: torque`",
                ));
                return None;
            }
        };
        let on_carrier = self.on_second(written, [Body::Element(element), carrier], at)?;
        let on = if on_carrier {
            carrier
        } else {
            Body::Element(element)
        };
        let component = match what {
            JointLoadQuantity::Force => self.component_of_vector(written, at)?,
            JointLoadQuantity::Moment => self.component_of_rotation(written, false, at)?,
        };
        let axes = self.axes(written, Some(on), Body::Frame, at)?;
        let quantity = Quantity::JointLoad {
            element,
            what,
            on_carrier,
            projection: Projection { component, axes },
        };
        Some((quantity, unit))
    }

    /// The force of a belt that runs through rings, or of an airbag, on one of the bodies of its points; on the first
    /// body if there is no `on`.
    pub(crate) fn on_points(
        &self,
        written: &Written,
        force: usize,
        bodies: &[Body],
        at: At<'_>,
    ) -> Option<Quantity> {
        let on = match &written.on {
            Some(path) => self.body(path, at.key("on"))?,
            None => *bodies.first()?,
        };
        let points = bodies.iter().enumerate().filter(|(_, body)| **body == on);
        let points: Vec<usize> = points.map(|(index, _)| index).collect();
        if points.is_empty() {
            let mut names: Vec<String> = Vec::new();
            for body in bodies {
                let name = quoted(&self.body_name(*body));
                if !names.contains(&name) {
                    names.push(name);
                }
            }
            self.problems.add(at.key("on").problem(
                "no such force acts on that body",
                format!("it acts on {}", names.join(", ")),
            ));
            return None;
        }
        let component = self.component_of_vector(written, at)?;
        let axes = self.axes(written, Some(on), Body::Frame, at)?;
        Some(Quantity::ForceOnPoints {
            force,
            points,
            projection: Projection { component, axes },
        })
    }

    /// The force between two bodies, on one of them.
    pub(crate) fn force_on(
        &self,
        written: &Written,
        force: usize,
        bodies: [Body; 2],
        at: At<'_>,
    ) -> Option<Quantity> {
        let on_second = self.on_second(written, bodies, at)?;
        let projection = Projection {
            component: self.component_of_vector(written, at)?,
            axes: self.axes(
                written,
                Some(bodies[usize::from(on_second)]),
                Body::Frame,
                at,
            )?,
        };
        Some(Quantity::ForceOn {
            force,
            on_second,
            projection,
        })
    }

    /// True if `on` names the second of two bodies; false for the first, or if there is no `on`.
    pub(crate) fn on_second(
        &self,
        written: &Written,
        bodies: [Body; 2],
        at: At<'_>,
    ) -> Option<bool> {
        let Some(path) = &written.on else {
            return Some(false);
        };
        let on = self.body(path, at.key("on"))?;
        let found = bodies.iter().position(|body| *body == on);
        if found.is_none() {
            let [first, second] = bodies.map(|body| quoted(&self.body_name(body)));
            self.problems.add(at.key("on").problem(
                format!("no such force acts on {}", quoted(path)),
                format!("it acts on {first} and, opposite, on {second}"),
            ));
        }
        found.map(|index| index == 1)
    }

    /// The name of a body, as `on` has it.
    fn body_name(&self, body: Body) -> String {
        match body {
            Body::Frame => "frame".to_owned(),
            Body::Vehicle(index) => self.vehicles[index].name.clone(),
            Body::Element(id) => self.path(id),
        }
    }

    /// A scalar quantity of a force; reports keys that ask for a direction.
    pub(crate) fn scalar(&self, force: usize, what: impl OfLaw, at: At<'_>) -> Quantity {
        self.without(at, &["component", "axes", "on"], "a scalar");
        Quantity::of_force(force, what)
    }

    /// Reports keys that have no meaning for a law between bodies, which messages call `law`.
    pub(crate) fn of_law(&self, at: At<'_>, law: &str) {
        self.without(at, &["segment", "ring"], "anything but a belt");
        self.without(at, &["at", "about", "relative_to"], law);
    }

    /// Index of the relative rotation of a joint that `about` names.
    pub fn about(&self, written: &Written, at: At<'_>) -> Option<usize> {
        match (written.about, self.planar) {
            (None | Some(Axis::Y), true) => Some(1),
            (Some(Axis::X), false) => Some(0),
            (Some(Axis::Y), false) => Some(1),
            (Some(Axis::Z), false) => Some(2),
            (Some(Axis::Flexion), false) => Some(3),
            (Some(Axis::Torsion), false) => Some(4),
            (Some(_), true) => {
                self.problems.add(at.key("about").problem(
                    "in the plane a joint turns about y only",
                    "remove the key `about`",
                ));
                None
            }
            (None, false) => {
                self.problems.add(at.problem(
                    "in space a joint has three rotations, and the output does not say which",
                    "add `about: x`, `y` or `z`; or `flexion` or `torsion`",
                ));
                None
            }
        }
    }

    fn of_system(
        &self,
        written: &Written,
        system: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        let (what, unit) = self.look_up(written, &OF_SYSTEM, "a system", at)?;
        self.without(at, &["at", "relative_to"], "a whole system");
        let component = match what {
            SystemQuantity::KineticEnergy => {
                self.without(at, &["component", "axes"], "an energy");
                Component::Resultant
            }
            SystemQuantity::AngularMomentum => self.component_of_rotation(written, false, at)?,
            _ => self.component_of_vector(written, at)?,
        };
        let axes = self.axes(written, None, Body::Frame, at)?;
        Some((
            Quantity::System {
                system,
                what,
                projection: Projection { component, axes },
            },
            unit,
        ))
    }

    pub fn component_of_vector(&self, written: &Written, at: At<'_>) -> Option<Component> {
        match written.component.map(|c| c.0) {
            Some(WrittenComponent::Y) if self.planar => {
                self.problems.add(at.key("component").problem(
                    "in the plane nothing moves along y",
                    "write `x`, `z` or `resultant`",
                ));
                None
            }
            Some(WrittenComponent::X) => Some(Component::X),
            Some(WrittenComponent::Y) => Some(Component::Y),
            Some(WrittenComponent::Z) => Some(Component::Z),
            Some(WrittenComponent::Resultant) | None => Some(Component::Resultant),
        }
    }

    pub fn component_of_rotation(
        &self,
        written: &Written,
        angle: bool,
        at: At<'_>,
    ) -> Option<Component> {
        let place = at.key("component");
        match (written.component.map(|c| c.0), self.planar) {
            (None | Some(WrittenComponent::Y), true) => Some(Component::Y),
            (Some(_), true) => {
                self.problems.add(place.problem(
                    "in the plane everything turns about y",
                    "remove the key `component`",
                ));
                None
            }
            (None, false) if angle => {
                self.problems.add(at.problem(
                    "in space there are three Bryant angles, and the output does not say which",
                    "add `component: x`, `y` or `z` for the first, second or third; or `resultant` for the angle of the one turn \
                     that leads to the same orientation",
                ));
                None
            }
            (Some(WrittenComponent::X), false) => Some(Component::X),
            (Some(WrittenComponent::Y), false) => Some(Component::Y),
            (Some(WrittenComponent::Z), false) => Some(Component::Z),
            (Some(WrittenComponent::Resultant) | None, false) => Some(Component::Resultant),
        }
    }

    /// Reports keys that have no meaning here.
    pub fn without(&self, at: At<'_>, keys: &[&str], of: &str) {
        for key in keys {
            if at.node.get(key).is_some() {
                self.problems.add(at.key(key).key_problem(
                    format!("the key \"{key}\" means nothing for {of}"),
                    format!("remove `{key}`"),
                ));
            }
        }
    }
}

/// True if an output asks for a component of a force, or names axes.
pub(crate) fn has_direction(written: &Written) -> bool {
    written
        .component
        .is_some_and(|c| c.0 != WrittenComponent::Resultant)
        || written.axes.is_some()
        || written.on.is_some()
}

const OF_HELP: &str = "name an element (`man/head`), a force (`joint man/head`, `contact seat`, `belt chest`, `user drag`) or a system (`man`)";
