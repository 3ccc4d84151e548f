//! Curves: units applied, abscissae proven to increase, uses counted.

use super::name::Style;
use super::quantity::{Expected, Measure, describe};
use super::{AXES, Resolver};
use crate::description::curve::{
    Curve as Written, Extrapolate as WrittenExtrapolate, Function, ScaledCurve as WrittenScaled,
};
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::description::unit::{Dimension, unit};
use crate::diagnostic::{quoted, suggestion};
use crate::model::{
    Curve, Extrapolate, FieldComponent, ForceKind, Hysteresis, Model, Number, Reference,
    ScaledCurve,
};

/// A curve and the measures of its abscissa and ordinate.
#[derive(Clone, Debug)]
pub struct Measured {
    pub curve: Curve,
    pub measures: [Measure; 2],
}

impl Resolver<'_> {
    /// Enters a curve that has a name. One that is wrong is entered too, so that its uses are not reported as well.
    pub fn named_curve(&mut self, name: &str, written: &Written, at: At<'_>) {
        let key = at.key(name);
        let place = key.on_key();
        let unique = self.check_unique(
            name,
            "curves",
            self.curve_names.iter().map(String::as_str),
            place,
        );
        if self.parameters.iter().any(|p| p.name == name) {
            self.problems.add(key.key_problem(
                format!("{} is a curve and a parameter", quoted(name)),
                "give one of them another name",
            ));
        }
        if !unique || !self.check_name(name, "a curve", Style::Either, place) {
            return;
        }
        let measured = self.curve(name.to_owned(), written, key);
        self.curve_names.push(name.to_owned());
        self.curves.push(measured);
    }

    /// The curve as written, with what is wrong reported; `None` where too little is left of it.
    fn curve(&self, name: String, written: &Written, at: At<'_>) -> Option<Measured> {
        let before = self.problems.count();
        let mut measures = [Measure::Bare; 2];
        let mut factors = [1.0; 2];
        if let Some(units) = &written.unit {
            let place = at.key("unit");
            if units.len() != 2 {
                self.problems.add(place.problem(
                    format!("a curve has two units, but this list has {}", units.len()),
                    "write the unit of the abscissa and that of the ordinate: `[ms, m/s^2]`; `1` for a pure number",
                ));
                return None;
            }
            for (index, unit) in units.iter().enumerate() {
                let (factor, measure) = self.curve_number(unit, place.item(index))?;
                factors[index] = factor;
                measures[index] = measure;
            }
        }
        let place = at.key("points");
        let mut points = Vec::with_capacity(written.points.len());
        for (index, point) in written.points.iter().enumerate() {
            let here = place.item(index);
            let [x, y] = point.as_slice() else {
                self.problems.add(here.problem(
                    format!("a point has two numbers, but this list has {}", point.len()),
                    "write `[abscissa, ordinate]`",
                ));
                return None;
            };
            let mut entry = [0.0; 2];
            for (axis, quantity) in [x, y].into_iter().enumerate() {
                let (value, measure) = self.curve_number(quantity, here.item(axis))?;
                entry[axis] = match measure {
                    Measure::Bare | Measure::Unknown => value * factors[axis],
                    Measure::Known(dimension) => {
                        match measures[axis] {
                            Measure::Known(other) if other != dimension => {
                                self.problems.add(here.item(axis).problem(
                                    format!(
                                        "this is {}, the curve's other numbers are {}",
                                        describe(dimension),
                                        describe(other)
                                    ),
                                    "give all abscissae in one kind of unit, and all ordinates",
                                ));
                                return None;
                            }
                            _ => measures[axis] = measure,
                        }
                        value
                    }
                };
            }
            points.push(entry);
        }
        self.check_points(&points, written, place);
        let extrapolate = match written.extrapolate {
            Some(WrittenExtrapolate::Linear) => Extrapolate::Linear,
            Some(WrittenExtrapolate::Error) => Extrapolate::Error,
            Some(WrittenExtrapolate::Hold) | None => Extrapolate::Hold,
        };
        (self.problems.count() == before).then_some(Measured {
            curve: Curve {
                name,
                points,
                extrapolate,
            },
            measures,
        })
    }

    fn check_points(&self, points: &[[f64; 2]], written: &Written, at: At<'_>) {
        if points.len() < 2 {
            self.problems.add(at.problem(
                format!(
                    "a curve has at least two points, but this has {}",
                    points.len()
                ),
                "a constant is a curve through two points of the same ordinate",
            ));
        }
        for (index, pair) in points.windows(2).enumerate() {
            let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
            let here = at.item(index + 1);
            if x1 <= x0 {
                let shown = |index: usize| match written.points[index].first() {
                    Some(Quantity::Number(x)) => x.to_string(),
                    Some(Quantity::Text(text)) => text.clone(),
                    _ => String::new(),
                };
                self.problems.add(here.problem(
                    format!(
                        "the curve runs backwards: the abscissa {} follows {}",
                        shown(index + 1),
                        shown(index)
                    ),
                    "abscissae increase from point to point; a jump is written as a steep segment",
                ));
                return;
            }
            if !((y1 - y0) / (x1 - x0)).is_finite() {
                self.problems.add(here.problem(
                    "the segment that ends here is infinitely steep",
                    "move its two points apart",
                ));
                return;
            }
        }
    }

    /// A constant of a curve.
    fn curve_number(&self, quantity: &Quantity, at: At<'_>) -> Option<(f64, Measure)> {
        let (number, measure) = self.measured(quantity, at)?;
        match number.constant() {
            Some(value) => Some((value, measure)),
            None => {
                self.problems.add(at.problem(
                    "the points of a curve are numbers, but this depends on a parameter",
                    "scale the whole curve where it is used: `{ curve: name, times: parameter }`",
                ));
                None
            }
        }
    }

    /// The curve that a key asks for, as a function \[`x`\] → \[`y`\]; `None` where it is zero everywhere, or wrong.
    pub fn function(
        &mut self,
        function: &Function,
        at: At<'_>,
        owner: &str,
        x: Expected,
        y: Expected,
    ) -> Option<ScaledCurve> {
        match function {
            Function::Inline(written) => {
                let measured = self.curve(owner.to_owned(), written, at);
                self.curves.push(measured);
                let index = self.curves.len() - 1;
                self.scaled(index, None, at, x, y)
            }
            Function::Scaled(WrittenScaled { curve, times }) => {
                let index = self.find_curve(curve, at.key("curve"))?;
                self.scaled(
                    index,
                    times.as_ref().map(|t| (t, at.key("times"))),
                    at.key("curve"),
                    x,
                    y,
                )
            }
            Function::Quantity(Quantity::Text(name)) if is_word(name.trim()) => {
                let index = self.find_curve(name, at)?;
                self.scaled(index, None, at, x, y)
            }
            Function::Quantity(_) => {
                self.problems.add(at.problem(
                    "here stands a number, but a curve is needed",
                    "write the name of a curve, or a line through zero: `{ points: [[-1, -40], [1, 40]], extrapolate: linear }`",
                ));
                None
            }
        }
    }

    /// A vector whose components are constants or curves of time: \[x, z\] in the plane, \[x, y, z\] in space.
    ///
    /// A curve written in place is named after `owner` and its axis.
    pub fn components(
        &mut self,
        written: &[Function],
        at: At<'_>,
        owner: &str,
        y: Expected,
    ) -> [FieldComponent; 3] {
        let mut components = [0; 3].map(|_| FieldComponent::Constant(Number::ZERO));
        if self.has_length(written.len(), at) {
            for (index, component) in written.iter().enumerate() {
                let axis = self.axis(index);
                let owner = format!("{owner} {}", AXES[axis]);
                components[axis] = self.component(component, at.item(index), &owner, y);
            }
        }
        components
    }

    /// A constant or a curve of time.
    pub fn component(
        &mut self,
        function: &Function,
        at: At<'_>,
        owner: &str,
        y: Expected,
    ) -> FieldComponent {
        let zero = FieldComponent::Constant(Number::ZERO);
        if let Function::Quantity(quantity) = function {
            let curve = match quantity {
                Quantity::Text(text) => self.curve_names.iter().any(|n| n == text.trim()),
                _ => false,
            };
            if !curve {
                // a single word may be meant as a curve
                if let Quantity::Text(text) = quantity
                    && is_word(text)
                    && !text.split('-').all(|word| self.is_value(word))
                {
                    let names = self
                        .curve_names
                        .iter()
                        .chain(self.parameters.iter().map(|p| &p.name));
                    self.problems.add(at.problem(
                        format!("{} is neither a curve nor a parameter", quoted(text)),
                        suggestion(
                            text,
                            names.map(String::as_str),
                            "declare it under `curves` or `parameters`",
                        ),
                    ));
                    return zero;
                }
                return FieldComponent::Constant(self.number(quantity, at, y));
            }
        }
        match self.function(function, at, owner, super::quantity::TIME, y) {
            Some(curve) => FieldComponent::Curve(curve),
            None => zero,
        }
    }

    /// A curve that is `value` at all abscissae.
    pub fn constant_curve(&mut self, name: String, value: Number) -> ScaledCurve {
        self.curves.push(Some(Measured {
            curve: Curve {
                name,
                points: vec![[0.0, 1.0], [1.0, 1.0]],
                extrapolate: Extrapolate::Hold,
            },
            measures: [Measure::Bare; 2],
        }));
        ScaledCurve {
            curve: self.curves.len() - 1,
            times: value,
        }
    }

    /// Whether a word stands for a number in an expression.
    fn is_value(&self, word: &str) -> bool {
        self.parameters.iter().any(|p| p.name == word)
            || self.failed_parameters.iter().any(|p| p == word)
            || unit(word).is_some()
            || word == "pi"
    }

    fn find_curve(&self, name: &str, at: At<'_>) -> Option<usize> {
        let name = name.trim();
        let found = self.curve_names.iter().position(|n| n == name);
        if found.is_none() {
            self.problems.add(at.problem(
                format!("there is no curve {}", quoted(name)),
                suggestion(
                    name,
                    self.curve_names.iter().map(String::as_str),
                    "declare it under `curves`, or write it here: `{ points: [[0, 0], [1, 10]] }`",
                ),
            ));
        }
        found
    }

    fn scaled(
        &mut self,
        index: usize,
        times: Option<(&Quantity, At<'_>)>,
        at: At<'_>,
        x: Expected,
        y: Expected,
    ) -> Option<ScaledCurve> {
        let (times, of_times) = match times {
            Some((quantity, at)) => self.measured(quantity, at)?,
            None => (Number::Constant(1.0), Measure::Bare),
        };
        let Measured { curve, measures } = self.curves[index].as_ref()?;
        let ordinate = match (measures[1], of_times) {
            (Measure::Known(a), Measure::Known(b)) => Measure::Known(a * b),
            (Measure::Known(a), Measure::Bare) => Measure::Known(a),
            // bare ordinates are pure where the factor has a dimension, and SI where it has none
            (Measure::Bare, Measure::Known(b)) if b != Dimension::ONE => Measure::Known(b),
            _ => Measure::Unknown,
        };
        for (what, measure, expected) in [("abscissa", measures[0], x), ("ordinate", ordinate, y)] {
            if let Measure::Known(dimension) = measure
                && dimension != expected.dimension
            {
                self.problems.add(at.problem(
                    format!(
                        "the {what} of this curve is {}, but {} is needed",
                        describe(dimension),
                        expected.name
                    ),
                    format!(
                        "here a curve is {} ({}) against {} ({})",
                        y.name,
                        expected_unit(y),
                        x.name,
                        expected_unit(x)
                    ),
                ));
                return None;
            }
        }
        let zero = times.is_zero()
            || curve.points.iter().all(|p| p[1] == 0.0) && curve.extrapolate != Extrapolate::Error;
        (!zero).then_some(ScaledCurve {
            curve: index,
            times,
        })
    }

    /// What `curve` yields at the abscissa `x` and the default parameters.
    pub fn curve_of(&self, curve: &ScaledCurve) -> Option<(&Curve, f64)> {
        let measured = self.curves.get(curve.curve)?.as_ref()?;
        Some((&measured.curve, curve.times.value(&self.defaults)))
    }
}

fn expected_unit(expected: Expected) -> String {
    match expected.dimension.to_string() {
        unit if unit.is_empty() => "no unit".to_owned(),
        unit => unit,
    }
}

/// A word without operators, such as a name.
fn is_word(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_')
}

/// Drops the curves that nothing uses; those left keep their order.
pub fn keep_used(model: &mut Model) {
    let mut used = vec![false; model.curves.len()];
    for_each_use(model, &mut |curve| used[curve.curve] = true);
    let mut kept = 0;
    let new: Vec<usize> = used
        .iter()
        .map(|&used| {
            kept += usize::from(used);
            kept.saturating_sub(1)
        })
        .collect();
    for_each_use(model, &mut |curve| curve.curve = new[curve.curve]);
    let mut flags = used.into_iter();
    model.curves.retain(|_| flags.next() == Some(true));
}

fn for_each_use(model: &mut Model, visit: &mut dyn FnMut(&mut ScaledCurve)) {
    for system in &mut model.systems {
        if let Reference::Prescribed(acceleration) = &mut system.reference {
            acceleration.iter_mut().flatten().for_each(&mut *visit);
        }
    }
    for force in &mut model.forces {
        match &mut force.kind {
            ForceKind::Joint { about, bending, .. } => {
                let bending = bending.iter_mut();
                about
                    .iter_mut()
                    .chain(bending.flat_map(|b| [&mut b.flexion, &mut b.torsion]))
                    .filter_map(|t| t.elastic.as_mut())
                    .for_each(&mut *visit);
            }
            ForceKind::Field { acceleration, .. } => visit_components(acceleration, visit),
            ForceKind::Load(load) => {
                visit_components(&mut load.force, visit);
                visit_components(&mut load.moment, visit);
            }
            ForceKind::Contact(contact) => {
                contact.elastic.iter_mut().for_each(&mut *visit);
                visit_unloading(&mut contact.hysteresis, visit);
            }
            ForceKind::Belt(belt) => {
                visit(&mut belt.force);
                visit_unloading(&mut belt.hysteresis, visit);
                belt.pretensioner
                    .iter_mut()
                    .for_each(|p| visit(&mut p.retract));
            }
        }
    }
}

fn visit_unloading(law: &mut Option<Hysteresis>, visit: &mut dyn FnMut(&mut ScaledCurve)) {
    law.iter_mut()
        .filter_map(|law| law.unloading.as_mut())
        .for_each(visit);
}

fn visit_components(components: &mut [FieldComponent], visit: &mut dyn FnMut(&mut ScaledCurve)) {
    for component in components {
        if let FieldComponent::Curve(curve) = component {
            visit(curve);
        }
    }
}
