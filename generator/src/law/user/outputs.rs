//! Outputs of a user force: a quantity of one of its ports.

use super::check::{Port, User};
use crate::description::output::Output as Written;
use crate::description::place::At;
use crate::diagnostic::{quoted, suggestion};
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::force::{Measures, Value};
use crate::law::joint::JointMeasures;
use crate::model::law::{OfLaw, Visible};
use crate::model::resolve::Resolver;
use crate::model::resolve::law::Outputs;
use crate::model::{Body, Component, Projection, Quantity};
use serde::Serialize;

/// A quantity of a user force. Indices are those of the force's points, bodies, lines, joints, freedoms, states.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum UserQuantity {
    /// Force on a point \[N\].
    Force(usize, Projection),
    /// Moment on a body \[N m\]; in the plane the component is [`Component::Y`].
    Moment(usize, Projection),
    /// Tension in a line \[N\].
    Tension(usize),
    /// Length of a line \[m\].
    Length(usize),
    /// Rate of the length of a line \[m/s\].
    LengthRate(usize),
    /// Torque in a joint about one relative rotation (0 to 2; 1 in the plane) \[N m\].
    Torque(usize, usize),
    /// Relative angle in a joint \[rad\].
    Angle(usize, usize),
    /// Rate of a relative angle in a joint \[rad/s\].
    AngleRate(usize, usize),
    /// Torque or force along a freedom of a joint \[N m\] or \[N\].
    Effort(usize),
    /// Value of a state.
    State(usize),
    /// Rate of a state.
    StateRate(usize),
}

impl OfLaw for UserQuantity {
    fn boxed(&self) -> Box<dyn OfLaw> {
        Box::new(*self)
    }

    fn projection_mut(&mut self) -> Option<&mut Projection> {
        match self {
            UserQuantity::Force(_, projection) | UserQuantity::Moment(_, projection) => {
                Some(projection)
            }
            _ => None,
        }
    }

    fn component(&self) -> Option<Component> {
        match self {
            UserQuantity::Force(_, projection) | UserQuantity::Moment(_, projection) => {
                Some(projection.component)
            }
            _ => None,
        }
    }

    fn exists_in_plane(&self) -> bool {
        match self {
            UserQuantity::Force(_, projection) => projection.lies_in_plane(),
            UserQuantity::Moment(_, projection) => projection.is_about_y(),
            UserQuantity::Torque(_, about)
            | UserQuantity::Angle(_, about)
            | UserQuantity::AngleRate(_, about) => *about == 1,
            _ => true,
        }
    }
}

/// The quantities of a kind of port: name, unit, quantity.
type Table = [(&'static str, &'static str, Asked)];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Asked {
    Force,
    Moment,
    Tension,
    Length,
    LengthRate,
    Torque,
    Angle,
    AngleRate,
    Effort,
    State,
    StateRate,
}

const OF_POINT: [(&str, &str, Asked); 1] = [("force", "N", Asked::Force)];
const OF_BODY: [(&str, &str, Asked); 1] = [("moment", "N*m", Asked::Moment)];
const OF_JOINT: [(&str, &str, Asked); 3] = [
    ("torque", "N*m", Asked::Torque),
    ("angle", "rad", Asked::Angle),
    ("rate", "rad/s", Asked::AngleRate),
];
const OF_LINE: [(&str, &str, Asked); 3] = [
    ("tension", "N", Asked::Tension),
    ("length", "m", Asked::Length),
    ("rate", "m/s", Asked::LengthRate),
];
const OF_FREEDOM: [(&str, &str, Asked); 1] = [("effort", "", Asked::Effort)];
const OF_STATE: [(&str, &str, Asked); 2] = [
    ("state", "", Asked::State),
    ("rate", "1/s", Asked::StateRate),
];

impl Outputs for User {
    fn output(
        &self,
        resolver: &Resolver<'_>,
        written: &Written,
        force: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        of_user(resolver, self, written, force, at)
    }
}

impl Visible for User {}

/// The quantity that an output asks of a user force, and its unit.
fn of_user(
    resolver: &Resolver<'_>,
    user: &User,
    written: &Written,
    force: usize,
    at: At<'_>,
) -> Option<(Quantity, &'static str)> {
    resolver.without(at, &["segment", "ring"], "anything but a belt");
    resolver.without(at, &["on", "relative_to"], "a user force");
    fn names<T>(ports: &[Port<T>]) -> Vec<&str> {
        ports.iter().map(|port| port.name.as_str()).collect()
    }
    let kinds: [(&str, Vec<&str>, &Table); 6] = [
        ("a point", names(&user.points), &OF_POINT),
        ("a body", names(&user.bodies), &OF_BODY),
        ("a line", names(&user.lines), &OF_LINE),
        ("a joint", names(&user.joints), &OF_JOINT),
        ("a freedom", names(&user.freedoms), &OF_FREEDOM),
        ("a state", names(&user.states), &OF_STATE),
    ];
    let all = || kinds.iter().flat_map(|(_, names, _)| names).copied();

    let words = written.of.split_whitespace().last().unwrap_or_default();
    let (what, index) = match words.split_once('/') {
        Some((_, port)) => {
            let found = kinds.iter().find_map(|(kind, names, table)| {
                let index = names.iter().position(|name| *name == port)?;
                Some((kind, index, table))
            });
            let Some((kind, index, table)) = found else {
                resolver.problems.add(at.key("of").problem(
                    format!("the user force has no {}", quoted(port)),
                    suggestion(port, all().collect::<Vec<_>>(), "it has no ports"),
                ));
                return None;
            };
            let (what, _) = resolver.look_up(written, table, kind, at)?;
            (what, index)
        }
        None => only_port(resolver, written, &kinds, at)?,
    };
    resolver.without(at, &["at"], "a user force");
    let (what, unit) = user_quantity(resolver, written, user, what, index, at)?;
    Some((Quantity::of_force(force, what), unit))
}

/// The only port that has the quantity asked for; reports if there are several, or none.
fn only_port(
    resolver: &Resolver<'_>,
    written: &Written,
    kinds: &[(&str, Vec<&str>, &Table)],
    at: At<'_>,
) -> Option<(Asked, usize)> {
    let mut found = Vec::new();
    let mut possible: Vec<&str> = Vec::new();
    for (_, names, table) in kinds.iter().filter(|(_, names, _)| !names.is_empty()) {
        possible.extend(table.iter().map(|(what, ..)| *what));
        if let Some((_, _, what)) = table.iter().find(|(what, ..)| *what == written.what) {
            let ports = names.iter().enumerate();
            found.extend(ports.map(|(index, name)| (*what, index, *name)));
        }
    }
    possible.sort_unstable();
    possible.dedup();
    match found[..] {
        [(what, index, _)] => Some((what, index)),
        [] => {
            resolver.problems.add(at.key("what").problem(
                format!("this user force has no {}", quoted(&written.what)),
                suggestion(&written.what, possible, "it has nothing to show"),
            ));
            None
        }
        [(_, _, first), ..] => {
            let names: Vec<String> = found.iter().map(|(.., name)| quoted(name)).collect();
            resolver.problems.add(at.key("of").problem(
                format!(
                    "{} may be that of {}",
                    quoted(&written.what),
                    names.join(", ")
                ),
                format!("say which: `of: {}/{first}`", written.of.trim()),
            ));
            None
        }
    }
}

/// The quantity of the port with this index, and its unit.
fn user_quantity(
    resolver: &Resolver<'_>,
    written: &Written,
    user: &User,
    asked: Asked,
    index: usize,
    at: At<'_>,
) -> Option<(UserQuantity, &'static str)> {
    if !matches!(asked, Asked::Force | Asked::Moment) {
        resolver.without(at, &["component", "axes"], "a scalar");
    }
    if !matches!(asked, Asked::Torque | Asked::Angle | Asked::AngleRate) {
        resolver.without(at, &["about"], "anything but a joint");
    }
    Some(match asked {
        Asked::Force => {
            let component = resolver.component_of_vector(written, at)?;
            let on = user.points.get(index)?.value.on;
            let axes = resolver.axes(written, Some(on), Body::Frame, at)?;
            (
                UserQuantity::Force(index, Projection { component, axes }),
                "N",
            )
        }
        Asked::Moment => {
            let component = resolver.component_of_rotation(written, false, at)?;
            let on = Body::Element(user.bodies.get(index)?.value);
            let axes = resolver.axes(written, Some(on), Body::Frame, at)?;
            (
                UserQuantity::Moment(index, Projection { component, axes }),
                "N*m",
            )
        }
        Asked::Tension => (UserQuantity::Tension(index), "N"),
        Asked::Length => (UserQuantity::Length(index), "m"),
        Asked::LengthRate => (UserQuantity::LengthRate(index), "m/s"),
        Asked::Torque | Asked::Angle | Asked::AngleRate => {
            let about = resolver.about(written, at)?;
            if about > 2 {
                resolver.problems.add(at.key("about").problem(
                    "a user force acts about the three relative rotations",
                    "write `x`, `y` or `z`",
                ));
                return None;
            }
            match asked {
                Asked::Torque => (UserQuantity::Torque(index, about), "N*m"),
                Asked::Angle => (UserQuantity::Angle(index, about), "rad"),
                _ => (UserQuantity::AngleRate(index, about), "rad/s"),
            }
        }
        Asked::Effort => {
            let unit = match user.freedoms.get(index)?.value.turns {
                true => "N*m",
                false => "N",
            };
            (UserQuantity::Effort(index), unit)
        }
        Asked::State => (
            UserQuantity::State(index),
            user.states.get(index)?.value.unit,
        ),
        Asked::StateRate => {
            let unit = user.states.get(index)?.value.rate_unit;
            (UserQuantity::StateRate(index), unit)
        }
    })
}

/// Expressions of the quantities of a user force, by port.
pub struct UserMeasures<'g> {
    /// Force on each point \[N\].
    pub forces: Vec<Vec3<'g>>,
    /// Moment on each body \[N m\].
    pub moments: Vec<Vec3<'g>>,
    /// The measures of each line.
    pub lines: Vec<LineMeasures<'g>>,
    /// The measures of each joint, about each relative rotation; in the plane only the second is there.
    pub joints: Vec<[Option<JointMeasures<'g>>; 3]>,
    /// Torque or force along each freedom \[N m\] or \[N\].
    pub efforts: Vec<Expr<'g>>,
    /// Value and rate of each state.
    pub states: Vec<(Expr<'g>, Expr<'g>)>,
}

/// Expressions of the quantities of a line.
#[derive(Clone, Copy)]
pub struct LineMeasures<'g> {
    /// Tension \[N\].
    pub tension: Expr<'g>,
    /// Length \[m\].
    pub length: Expr<'g>,
    /// Rate of the length \[m/s\].
    pub rate: Expr<'g>,
}

impl<'g> Measures<'g> for UserMeasures<'g> {
    fn value(&self, asked: &dyn OfLaw) -> Option<Value<'g>> {
        let what = asked.get::<UserQuantity>()?;
        let joint = |joint: usize, about: usize| self.joints.get(joint)?.get(about).copied()?;
        let scalar = match *what {
            UserQuantity::Force(i, projection) => {
                return Some(Value::Along(projection, *self.forces.get(i)?));
            }
            UserQuantity::Moment(i, projection) => {
                return Some(Value::Along(projection, *self.moments.get(i)?));
            }
            UserQuantity::Tension(i) => self.lines.get(i)?.tension,
            UserQuantity::Length(i) => self.lines.get(i)?.length,
            UserQuantity::LengthRate(i) => self.lines.get(i)?.rate,
            UserQuantity::Torque(i, about) => joint(i, about)?.torque,
            UserQuantity::Angle(i, about) => joint(i, about)?.angle,
            UserQuantity::AngleRate(i, about) => joint(i, about)?.rate,
            UserQuantity::Effort(i) => *self.efforts.get(i)?,
            UserQuantity::State(i) => self.states.get(i)?.0,
            UserQuantity::StateRate(i) => self.states.get(i)?.1,
        };
        Some(Value::Scalar(scalar))
    }
}
