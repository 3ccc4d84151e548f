//! The terms of a user force: its function.

use super::check::{Port, User, UserFreedom, UserFunction, UserLine, UserParameter, UserState};
use crate::model::law::Terms;
use crate::model::part::{Field, Fresh, Part, Term, attachment};
use crate::model::rule::{Key, Rule, Ruled};
use crate::model::{Body, Dimension, Number, ScaledCurve};

impl Terms for User {
    fn add_fields<'a>(&'a mut self, _: Dimension, fields: &mut Vec<Field<'a>>) {
        let User {
            function,
            dimension: _,
            scale: _,
            points,
            bodies,
            lines,
            joints,
            freedoms,
            states,
        } = self;
        for Port { name, value } in points {
            attachment(value, &format!("points.{name}.at"), fields);
        }
        for Port { name, value } in lines {
            let UserLine { from, to } = value;
            attachment(from, &format!("lines.{name}.from.at"), fields);
            attachment(to, &format!("lines.{name}.to.at"), fields);
        }
        let elements = bodies.iter().chain(joints.iter());
        fields.extend(elements.map(|port| Field::Body(Body::Element(port.value))));
        for Port { name: _, value } in freedoms {
            let UserFreedom {
                element,
                freedom: _,
                turns: _,
            } = value;
            fields.push(Field::Body(Body::Element(*element)));
        }
        for Port { name, value } in states {
            let UserState {
                initial,
                unit: _,
                rate_unit: _,
            } = value;
            let key = format!("states.{name}.initial");
            fields.push(Field::Number(key, Rule::Finite, initial));
        }
        let calls = Term::new("function", "function", Rule::Finite);
        fields.push(Field::Term(calls, function));
    }

    fn settle_terms(&mut self) {
        for port in &mut self.function.parameters {
            if !port.value.value.is_in() {
                port.value.value.leave_out();
            }
        }
        for port in &mut self.function.curves {
            if !port.value.is_in() {
                port.value.leave_out();
            }
        }
    }

    fn bodies_mut(&mut self) -> Vec<&mut Body> {
        let points = self.points.iter_mut().map(|point| &mut point.value.on);
        let lines = self.lines.iter_mut();
        let ends = lines.flat_map(|line| [&mut line.value.from.on, &mut line.value.to.on]);
        points.chain(ends).collect()
    }

    /// The function keeps its vectors in space.
    fn flatten(&mut self) -> bool {
        for point in &mut self.points {
            point.value.at[1] = Number::ZERO;
        }
        for line in &mut self.lines {
            line.value.from.at[1] = Number::ZERO;
            line.value.to.at[1] = Number::ZERO;
        }
        true
    }
}

/// The function of a user force with its arguments that do not depend on the motion, as a part that may be left out.
impl Part for UserFunction {
    fn is_in(&self) -> bool {
        !self.name.is_empty()
    }
    fn leave_out(&mut self) {
        *self = UserFunction {
            name: String::new(),
            source: None,
            parameters: Vec::new(),
            curves: Vec::new(),
        };
    }
    fn put_in(&mut self, _: &mut Fresh<'_>) {}
    fn zero(&self) -> &'static str {
        "there is no function"
    }
    fn numbers(&mut self) -> Vec<Ruled<'_>> {
        let UserFunction {
            name: _,
            source: _,
            parameters,
            curves,
        } = self;
        let mut numbers = Vec::new();
        for Port { name, value } in parameters {
            let UserParameter { value, unit: _ } = value;
            numbers.extend(beside("parameters", name, value.numbers()));
        }
        for Port { name, value } in curves {
            numbers.extend(beside("curves", name, value.numbers()));
        }
        numbers
    }
    fn curves(&mut self) -> Vec<&mut ScaledCurve> {
        let parameters = self.parameters.iter_mut();
        let mut curves: Vec<&mut ScaledCurve> = parameters
            .flat_map(|port| port.value.value.curves())
            .collect();
        curves.extend(self.curves.iter_mut().flat_map(|port| port.value.curves()));
        curves
    }
}

/// The numbers of a port of a user force, with their places in the YAML.
fn beside<'a>(
    list: &'a str,
    name: &'a str,
    numbers: Vec<Ruled<'a>>,
) -> impl Iterator<Item = Ruled<'a>> {
    numbers.into_iter().map(move |number| Ruled {
        key: Key::Beside(number.key.path(&format!("{list}.{name}"))),
        ..number
    })
}
