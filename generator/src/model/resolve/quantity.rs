//! Converts written quantities to numbers in SI, and checks their dimensions.
//!
//! A number without unit is in SI and may be used everywhere. So may a parameter without unit, but a product with it
//! has no known dimension. Everything else has the dimension of its units.

use super::Resolver;
use crate::description::expression::{self, Expression, ExpressionKind, Function, Operator};
use crate::description::measure::{ACCELERATION, Expected, Measured};
use crate::description::place::{At, Step};
use crate::description::quantity::{Number as WrittenNumber, OneOrThree, Quantity};
use crate::description::slip;
use crate::description::unit::Dimension;
use crate::diagnostic::{Diagnostic, quoted, suggestion};
use crate::model::{Number, Requirement, Rule};

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

    /// The number, which must have the dimension of its unit; 0 after a reported problem.
    pub fn number<U: Measured>(&self, written: &WrittenNumber<U>, at: At<'_>) -> Number {
        self.number_in(written, at, U::EXPECTED)
    }

    /// The number, which must have the expected dimension; 0 after a reported problem.
    pub fn number_in(&self, quantity: &Quantity, at: At<'_>, expected: Expected) -> Number {
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
    pub fn valued<U: Measured>(
        &self,
        written: &WrittenNumber<U>,
        at: At<'_>,
    ) -> (Number, Option<f64>) {
        let before = self.problems.count();
        let number = self.number(written, at);
        let value = number.value(&self.defaults);
        (number, (self.problems.count() == before).then_some(value))
    }

    /// A coefficient; `None` if it is 0 or missing.
    pub fn coefficient<U: Measured>(
        &self,
        written: Option<&WrittenNumber<U>>,
        at: At<'_>,
    ) -> Option<Number> {
        self.coefficient_in(written.map(|w| &**w), at, U::EXPECTED)
    }

    /// A coefficient of the expected dimension; `None` if it is 0 or missing.
    pub fn coefficient_in(
        &self,
        quantity: Option<&Quantity>,
        at: At<'_>,
        expected: Expected,
    ) -> Option<Number> {
        let number = self.number_in(quantity?, at, expected);
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

    /// The problem that a number of a force breaks its rule, in the words of [`judge`](Self::judge). It is reported
    /// also of a number that has no effect.
    pub fn breaks(&self, rule: Rule, value: f64, at: At<'_>) -> Diagnostic {
        let mut path = String::new();
        for step in at.trail() {
            match step {
                Step::Key(key) if path.is_empty() => path.push_str(key),
                Step::Key(key) => path = format!("{path}.{key}"),
                Step::Item(index) => path = format!("{path}[{index}]"),
            }
        }
        let (law, name) = self.owner.split_once(' ').unwrap_or((&self.owner, ""));
        let sentence = format!(
            "`{path}` of {law} {} {}, but is {value}",
            quoted(name),
            rule.words()
        );
        at.problem(sentence, rule.help())
    }

    /// Words to add to a message if a value depends on parameters.
    pub fn by_default(&self, number: &Number) -> &'static str {
        match number.constant() {
            Some(_) => "",
            None => " at the default parameters",
        }
    }

    /// A vector: \[x, z\] in the plane, \[x, y, z\] in space.
    pub fn vector<U: Measured>(&self, entries: &[WrittenNumber<U>], at: At<'_>) -> [Number; 3] {
        if !self.has_length(entries.len(), at) {
            return [Number::ZERO; 3];
        }
        let mut vector = [Number::ZERO; 3];
        for (index, entry) in entries.iter().enumerate() {
            vector[self.axis(index)] = self.number(entry, at.item(index));
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
    pub fn rotation<U: Measured>(
        &self,
        value: &OneOrThree<WrittenNumber<U>>,
        at: At<'_>,
    ) -> [Number; 3] {
        let mut rotation = [Number::ZERO; 3];
        for (axis, component, at) in self.about_axes(value, at, U::EXPECTED) {
            rotation[axis] = self.number(component, at);
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
            Some(index) if self.parameters[index].input && !self.inputs_may_stand.get() => {
                self.problems.add(at.text_problem(
                    offset,
                    length,
                    format!("{} is an input, which changes during a run", quoted(name)),
                    "inputs stand in motors, targets of drives, loads, accelerations of fields, parameters of user forces, thresholds of switches and formulas; make it a parameter to use it here",
                ));
                None
            }
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
            ExpressionKind::Number(value) => (Number::Constant(*value), Bare),
            ExpressionKind::Quantity(value, unit) => {
                (Number::Constant(value * unit.factor), Known(unit.dimension))
            }
            ExpressionKind::Parameter(name) => names(name, e.offset, e.length)?,
            ExpressionKind::Negative(a) => {
                let (a, measure) = self.expression(a, at, names)?;
                (Number::negative(a), measure)
            }
            ExpressionKind::Binary(operator, left, right) => {
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
            ExpressionKind::Call(Function::SquareRoot, a) => {
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
            ExpressionKind::Call(function, a) => {
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
