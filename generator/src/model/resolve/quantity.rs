//! Converts written quantities to numbers in SI, and checks their dimensions.
//!
//! A number without unit is in SI and may be used everywhere. So may a parameter without unit, but a product with it
//! has no known dimension. Everything else has the dimension of its units.

use super::Resolver;
use crate::description::expression::{self, Expression, Function, Kind, Operator};
use crate::description::place::At;
use crate::description::quantity::{OneOrThree, Quantity};
use crate::description::slip;
use crate::description::unit::Dimension;
use crate::diagnostic::{quoted, suggestion};
use crate::model::{Number, Requirement};

/// What is known about the dimension of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    /// A number without unit: in SI by itself, a pure number in a product.
    Bare,
    /// A parameter without unit.
    Unknown,
    /// A dimension given by units.
    Known(Dimension),
}

/// Returns the meaning of a name in an expression, given the name, the position of its first character and its length;
/// `None` if the name is wrong, which is reported.
pub type Names<'a> = &'a dyn Fn(&str, usize, usize) -> Option<(Number, Measure)>;

/// The physical quantity that a key expects.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    /// Name with its article ("a mass").
    pub name: &'static str,
    /// Its dimension.
    pub dimension: Dimension,
}

macro_rules! expected {
    ($($constant:ident = $name:literal [$m:literal $kg:literal $s:literal $rad:literal];)*) => {
        $(pub const $constant: Expected = Expected { name: $name, dimension: Dimension::new($m, $kg, $s, $rad) };)*
    };
}

expected! {
    LENGTH = "a length" [1 0 0 0];
    TIME = "a time" [0 0 1 0];
    MASS = "a mass" [0 1 0 0];
    INERTIA = "a moment of inertia" [2 1 0 0];
    ANGLE = "an angle" [0 0 0 1];
    SPEED = "a speed" [1 0 -1 0];
    RATE = "an angular velocity" [0 0 -1 1];
    ACCELERATION = "an acceleration" [1 0 -2 0];
    FORCE = "a force" [1 1 -2 0];
    TORQUE = "a torque" [2 1 -2 0];
    MOMENT = "a moment" [2 1 -2 0];
    STIFFNESS = "a stiffness" [0 1 -2 0];
    LINEAR_DAMPING = "a damping coefficient" [0 1 -1 0];
    ANGULAR_STIFFNESS = "a stiffness" [2 1 -2 -1];
    ANGULAR_DAMPING = "a damping coefficient" [2 1 -1 -1];
    PURE = "a pure number" [0 0 0 0];
    LENGTH_PER_ANGLE = "a length per angle" [1 0 0 -1];
    ANGLE_PER_LENGTH = "an angle per length" [-1 0 0 1];
    FRICTION = "a coefficient of friction" [0 0 0 0];
    AREA = "an area" [2 0 0 0];
    PRESSURE = "a pressure" [-1 1 -2 0];
    MASS_FLOW = "a mass per time" [0 1 -1 0];
}

/// An absolute temperature.
pub const TEMPERATURE: Expected = Expected {
    name: "a temperature",
    dimension: Dimension::ONE.kelvin(1),
};

/// The specific gas constant R.
pub const GAS_CONSTANT: Expected = Expected {
    name: "a gas constant",
    dimension: Dimension::new(2, 0, -2, 0).kelvin(-1),
};

/// Accepts any dimension; its own powers belong to no unit.
pub const ANY: Expected = Expected {
    name: "anything",
    dimension: Dimension::new(i32::MAX, i32::MAX, i32::MAX, 0),
};

impl Expected {
    /// True if a quantity of this dimension is accepted.
    pub fn accepts(&self, dimension: Dimension) -> bool {
        self.dimension == ANY.dimension || self.dimension == dimension
    }

    /// The SI unit, in words.
    fn unit(&self) -> String {
        match self.dimension.to_string() {
            unit if unit.is_empty() => "no unit".to_owned(),
            unit => unit,
        }
    }
}

impl Resolver<'_> {
    /// The number and what is known about its dimension; `None` after a reported problem.
    pub fn measured(&self, quantity: &Quantity, at: At<'_>) -> Option<(Number, Measure)> {
        let (number, measure) = match quantity {
            Quantity::Number(value) => (Number::Constant(*value), Measure::Bare),
            Quantity::Param(name) => {
                self.parameter(name, at.key("param"), 0, name.chars().count())?
            }
            Quantity::Text(text) => {
                let bad = text.trim();
                if bad.eq_ignore_ascii_case("nan") || bad.eq_ignore_ascii_case("inf") {
                    self.not_finite(at);
                    return None;
                }
                match expression::parse(text) {
                    Ok(expression) => {
                        self.expression(&expression, at, &|name, offset, length| {
                            self.parameter(name, at, offset, length)
                        })?
                    }
                    Err(m) => {
                        self.problems
                            .add(at.text_problem(m.offset, m.length, m.message, m.help));
                        return None;
                    }
                }
            }
        };
        if !number.value(&self.defaults).is_finite() {
            self.not_finite(at);
            return None;
        }
        Some((number, measure))
    }

    /// The number, which must have the expected dimension; 0 after a reported problem.
    pub fn number(&self, quantity: &Quantity, at: At<'_>, expected: Expected) -> Number {
        let Some((number, measure)) = self.measured(quantity, at) else {
            return Number::ZERO;
        };
        if let Measure::Known(dimension) = measure
            && !expected.accepts(dimension)
        {
            let found = dimension.to_string();
            let found = match found.as_str() {
                "" => "a pure number".to_owned(),
                "rad" => "an angle".to_owned(),
                unit => format!("in {unit}"),
            };
            let gravity = match quantity {
                Quantity::Text(text)
                    if expected.name == ACCELERATION.name
                        && found == "in kg"
                        && text.contains('g') =>
                {
                    "`g` is the gram; standard gravity is `gn`; "
                }
                _ => "",
            };
            self.problems.add(at.problem(
                format!("{} is needed here, but this is {found}", expected.name),
                match expected.unit().as_str() {
                    "no unit" => format!("{gravity}write {} without a unit", expected.name),
                    unit => format!(
                        "{gravity}give {} in {unit} or a multiple of it",
                        expected.name
                    ),
                },
            ));
            return Number::ZERO;
        }
        number
    }

    /// The number as by [`number`](Self::number), with its value at the default parameters; no value after a reported
    /// problem.
    pub fn valued(
        &self,
        quantity: &Quantity,
        at: At<'_>,
        expected: Expected,
    ) -> (Number, Option<f64>) {
        let before = self.problems.count();
        let number = self.number(quantity, at, expected);
        let value = number.value(&self.defaults);
        (number, (self.problems.count() == before).then_some(value))
    }

    /// A coefficient; `None` if it is 0 or missing.
    pub fn coefficient(
        &self,
        quantity: Option<&Quantity>,
        at: At<'_>,
        expected: Expected,
    ) -> Option<Number> {
        let number = self.number(quantity?, at, expected);
        (!number.is_zero()).then_some(number)
    }

    /// Reports requirements that are broken at the default parameters. `at` is the place of their owner. Each place is
    /// reported only once, and not if it has another problem already.
    pub fn judge(&self, requirements: Vec<Requirement>, at: At<'_>) {
        let mut reported: Vec<String> = Vec::new();
        for requirement in requirements {
            let Requirement {
                sentence,
                path,
                value,
                rule,
                help,
                written,
            } = requirement;
            let found = value.value(&self.defaults);
            if rule.keeps(found) || reported.contains(&path) {
                continue;
            }
            let place = at.path(&path);
            let but = match written {
                true => format!(", but is {found}"),
                false => String::new(),
            };
            let problem =
                place.problem(format!("{sentence}{but}{}", self.by_default(&value)), help);
            if !self.problems.has_at(&problem) {
                self.problems.add(problem);
            }
            reported.push(path);
        }
    }

    /// Words to add to a message if a value depends on parameters.
    pub fn by_default(&self, number: &Number) -> &'static str {
        match number.constant() {
            Some(_) => "",
            None => " at the default parameters",
        }
    }

    /// A vector: \[x, z\] in the plane, \[x, y, z\] in space.
    pub fn vector(&self, entries: &[Quantity], at: At<'_>, expected: Expected) -> [Number; 3] {
        if !self.has_length(entries.len(), at) {
            return [Number::ZERO; 3];
        }
        let mut vector = [Number::ZERO; 3];
        for (index, entry) in entries.iter().enumerate() {
            vector[self.axis(index)] = self.number(entry, at.item(index), expected);
        }
        vector
    }

    /// Index of the absolute axis that belongs to an entry of a written vector.
    pub fn axis(&self, index: usize) -> usize {
        if self.planar { 2 * index } else { index }
    }

    /// True if a list has one entry for each dimension; otherwise reports it.
    pub fn has_length(&self, length: usize, at: At<'_>) -> bool {
        let (right, help) = if self.planar {
            (2, "in the plane a vector is written `[x, z]`")
        } else {
            (3, "in space a vector is written `[x, y, z]`")
        };
        if length != right {
            self.problems.add(at.problem(
                format!("a vector has {right} components, but this list has {length}"),
                slip::in_list(at).unwrap_or_else(|| help.to_owned()),
            ));
        }
        length == right
    }

    /// Moments, angles or rates about axes: one about y in the plane, three in space.
    pub fn rotation(&self, value: &OneOrThree, at: At<'_>, expected: Expected) -> [Number; 3] {
        let mut rotation = [Number::ZERO; 3];
        for (axis, component, at) in self.about_axes(value, at, expected) {
            rotation[axis] = self.number(component, at, expected);
        }
        rotation
    }

    /// The entry for each axis, with its place. Reports a wrong number of entries, and then returns none.
    pub fn about_axes<'w, T>(
        &self,
        value: &'w OneOrThree<T>,
        at: At<'w>,
        expected: Expected,
    ) -> Vec<(usize, &'w T, At<'w>)> {
        match (value, self.planar) {
            (OneOrThree::One(one), true) => vec![(1, one, at)],
            (OneOrThree::List(list), false) if self.has_length(list.len(), at) => list
                .iter()
                .enumerate()
                .map(|(axis, component)| (axis, component, at.item(axis)))
                .collect(),
            (OneOrThree::List(_), false) => Vec::new(),
            (OneOrThree::List(_), true) => {
                self.problems.add(at.problem(
                    format!(
                        "here stands a list, but in the plane {} is one value",
                        expected.name
                    ),
                    "give the one about the y axis, without brackets",
                ));
                Vec::new()
            }
            (OneOrThree::One(_), false) => {
                self.problems.add(at.problem(
                    format!(
                        "here stands one value, but in space {} is given per axis",
                        expected.name
                    ),
                    "write `[x, y, z]`",
                ));
                Vec::new()
            }
        }
    }

    fn not_finite(&self, at: At<'_>) {
        self.problems.add(at.problem(
            "this is not a finite number",
            "give a number that is neither NaN nor infinite; look for a division by zero or the root of a negative number",
        ));
    }

    /// The parameter with this name, within a text at `offset`; reports if there is none.
    pub(super) fn parameter(
        &self,
        name: &str,
        at: At<'_>,
        offset: usize,
        length: usize,
    ) -> Option<(Number, Measure)> {
        match self.parameters.iter().position(|p| p.name == name) {
            Some(index) => Some((Number::Parameter(index), self.measures[index])),
            // the problem in the declaration of the parameter has been reported
            None if self.failed_parameters.iter().any(|p| p == name) => None,
            None => {
                let names = self.parameters.iter().map(|p| p.name.as_str());
                let help = if self.curve_names.iter().any(|c| c == name) {
                    "it is a curve; a curve is scaled by `{ curve: name, times: factor }`"
                        .to_owned()
                } else {
                    match expression::spelling(name) {
                        Some(right) => format!("as a unit: {right}"),
                        None => suggestion(name, names, "declare it under `parameters`"),
                    }
                };
                self.problems.add(at.text_problem(
                    offset,
                    length,
                    format!("{} is neither a number nor a parameter", quoted(name)),
                    help,
                ));
                None
            }
        }
    }

    /// A number that must not depend on parameters.
    pub(crate) fn constant(
        &self,
        quantity: &Quantity,
        at: At<'_>,
        what: &str,
    ) -> Option<(f64, Measure)> {
        let (number, measure) = self.measured(quantity, at)?;
        if number.constant().is_none() {
            self.problems.add(at.problem(
                format!("{what} depends on a parameter"),
                "give a number; expressions of parameters may stand where the parameter is used",
            ));
        }
        Some((number.constant()?, measure))
    }

    /// Simplifies an expression and finds its dimension. `names` returns the meaning of its names, and reports unknown
    /// ones.
    pub(super) fn expression(
        &self,
        e: &Expression,
        at: At<'_>,
        names: Names<'_>,
    ) -> Option<(Number, Measure)> {
        use Measure::{Bare, Known};
        Some(match &e.kind {
            Kind::Number(value) => (Number::Constant(*value), Bare),
            Kind::Quantity(value, unit) => {
                (Number::Constant(value * unit.factor), Known(unit.dimension))
            }
            Kind::Parameter(name) => names(name, e.offset, e.length)?,
            Kind::Negative(a) => {
                let (a, measure) = self.expression(a, at, names)?;
                (Number::negative(a), measure)
            }
            Kind::Binary(operator, left, right) => {
                let (a, b) = (
                    self.expression(left, at, names),
                    self.expression(right, at, names),
                );
                let ((a, of_a), (b, of_b)) = (a?, b?);
                let measure = self.measure_of(*operator, of_a, of_b, e, at)?;
                let number = match operator {
                    Operator::Add => Number::sum(a, b),
                    Operator::Subtract => Number::difference(a, b),
                    Operator::Multiply => Number::product(a, b),
                    Operator::Divide => Number::quotient(a, b),
                };
                (number, measure)
            }
            Kind::Call(Function::SquareRoot, a) => {
                let (number, measure) = self.expression(a, at, names)?;
                let measure = match measure {
                    Known(dimension) => match dimension.root() {
                        Some(root) => Known(root),
                        None => {
                            self.problems.add(at.text_problem(
                                e.offset,
                                e.length,
                                format!("the square root of {}", describe(dimension)),
                                "what stands under the root is a square",
                            ));
                            return None;
                        }
                    },
                    other => other,
                };
                (Number::square_root(number), measure)
            }
            Kind::Call(function, a) => {
                let (number, measure) = self.expression(a, at, names)?;
                if let Known(dimension) = measure
                    && dimension != Dimension::ONE
                {
                    self.problems.add(at.text_problem(
                        a.offset,
                        a.length,
                        format!("the sine or cosine of {}", describe(dimension)),
                        "give an angle, in rad or deg",
                    ));
                    return None;
                }
                let number = match function {
                    Function::Cosine => Number::cosine(number),
                    _ => Number::sine(number),
                };
                (number, Bare)
            }
        })
    }

    /// The dimension of a sum, a product or a quotient. `e` is the whole expression.
    fn measure_of(
        &self,
        operator: Operator,
        of_a: Measure,
        of_b: Measure,
        e: &Expression,
        at: At<'_>,
    ) -> Option<Measure> {
        use Measure::{Bare, Known, Unknown};
        Some(match (operator, of_a, of_b) {
            (Operator::Add | Operator::Subtract, Known(x), Known(y)) if x != y => {
                self.problems.add(at.text_problem(
                    e.offset,
                    e.length,
                    format!("a sum of {} and {}", describe(x), describe(y)),
                    "both sides of + and - have the same dimension",
                ));
                return None;
            }
            (Operator::Add | Operator::Subtract, Known(x), _) => Known(x),
            (Operator::Add | Operator::Subtract, _, Known(y)) => Known(y),
            (Operator::Multiply, Known(x), Known(y)) => Known(x * y),
            (Operator::Multiply, Known(x), Bare) | (Operator::Multiply, Bare, Known(x)) => Known(x),
            (Operator::Divide, Known(x), Known(y)) => Known(x / y),
            (Operator::Divide, Known(x), Bare) => Known(x),
            (Operator::Divide, Bare, Known(y)) => Known(Dimension::ONE / y),
            (_, Bare, Bare) => Bare,
            _ => Unknown,
        })
    }
}

/// A dimension in words.
pub fn describe(dimension: Dimension) -> String {
    match dimension.to_string() {
        unit if unit.is_empty() => "a pure number".to_owned(),
        unit if unit == "rad" => "an angle".to_owned(),
        unit => format!("a quantity in {unit}"),
    }
}
