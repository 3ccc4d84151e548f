//! Curves: applies units, checks that abscissae increase, and enters curves that are written in place.

use super::name::Style;
use super::quantity::{Measure, describe};
use super::{AXES, Resolver};
use crate::description::curve::{
    Curve as Written, Extrapolate as WrittenExtrapolate, Function, FunctionOf,
    Interpolate as WrittenInterpolate, NameOrCurve, NoConstant, OverTime,
    ScaledCurve as WrittenScaled,
};
use crate::description::load::{beside, channel_key};
use crate::description::measure::{Expected, Measured as InUnit, OfItsUse, TIME};
use crate::description::place::{At, Step};
use crate::description::quantity::{Number as WrittenNumber, Quantity};
use crate::description::slip;
use crate::description::table::{Column, Columns, Fault, Table};
use crate::description::tree::MAX_POINTS;
use crate::description::unit::{Dimension, product, unit};
use crate::diagnostic::{Diagnostic, quoted, suggestion};
use crate::model::{Curve, Extrapolate, FieldComponent, Interpolate, Number, ScaledCurve};

/// A curve, with the dimensions of its abscissa and ordinate.
#[derive(Clone, Debug)]
pub struct Measured {
    pub curve: Curve,
    pub measures: [Measure; 2],
}

impl Resolver<'_> {
    /// Enters a named curve. A wrong curve is entered too, so that its uses are not reported as well.
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

    /// The checked form of a curve. Problems are reported; `None` if they leave no useful curve.
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
        let points = match self.channel_of(written, at)? {
            Some(table) => self.points_of_table(written, table, at, (&mut measures, factors)),
            None => self.points(written, at, &mut measures, factors),
        }?;
        let extrapolate = match written.extrapolate {
            Some(WrittenExtrapolate::Linear) => Extrapolate::Linear,
            Some(WrittenExtrapolate::Error) => Extrapolate::Error,
            Some(WrittenExtrapolate::Hold) | None => Extrapolate::Hold,
        };
        let interpolate = match written.interpolate {
            Some(WrittenInterpolate::Cubic) => Interpolate::Cubic,
            Some(WrittenInterpolate::Linear) | None => Interpolate::Linear,
        };
        let states_extrapolation = written.extrapolate.is_some();
        let curve = Curve {
            name,
            points,
            interpolate,
            extrapolate,
            states_extrapolation,
            thinned: None,
        };
        if self.problems.count() == before && !curve.is_finite() {
            self.problems.add(at.problem(
                "two points of this curve are so close that a cubic between them has no finite coefficients",
                "move the points apart, or write `interpolate: linear`",
            ));
        }
        if self.problems.count() == before && !curve.is_joined() {
            self.problems.add(at.problem(
                "the numbers of this curve are so far apart or so small that a segment misses the point where it ends",
                "look for wrong exponents and units; the numbers of a curve, in SI, are nearer to 1",
            ));
        }
        (self.problems.count() == before).then(|| Measured {
            curve: curve.with_at_most(MAX_POINTS),
            measures,
        })
    }

    /// The channel of a test from which a curve has its points; `Some(None)` if it has none, `None` if the channel is
    /// wrong.
    fn channel_of(&self, written: &Written, at: At<'_>) -> Option<Option<&Table>> {
        let (mme, channel) = match (&written.mme, &written.channel) {
            (None, None) => return Some(None),
            (Some(mme), Some(channel)) => (mme, channel),
            (Some(_), None) => {
                self.problems.add(at.problem(
                    "it is not said which channel of the test has the points",
                    "add `channel: CODE` with one of the codes in TEST.chn",
                ));
                return None;
            }
            (None, Some(_)) => {
                self.problems.add(at.key("channel").key_problem(
                    "a channel means nothing without a test",
                    "add `mme: TEST.mme`, or remove `channel`",
                ));
                return None;
            }
        };
        let others = [
            ("points", written.points.is_some()),
            ("file", written.file.is_some()),
            ("columns", written.columns.is_some()),
            ("unit", written.unit.is_some()),
        ];
        if let Some((key, _)) = others.into_iter().find(|(_, said)| *said) {
            self.problems.add(at.key(key).key_problem(
                format!("the channel of a test has points and units, and `{key}` has no meaning beside it"),
                format!("remove `{key}`, or `mme` and `channel`"),
            ));
            return None;
        }
        // a channel that could not be read has been reported by the loader
        let path = beside(&at.source.name, mme);
        self.tables.get(&channel_key(&path, channel)).map(Some)
    }

    /// The points of a curve in SI, from a list or a file.
    fn points(
        &self,
        written: &Written,
        at: At<'_>,
        measures: &mut [Measure; 2],
        factors: [f64; 2],
    ) -> Option<Vec<[f64; 2]>> {
        let listed = match (&written.points, &written.file) {
            (Some(points), None) => points,
            (None, Some(file)) => {
                let table = self.tables.get(&beside(&at.source.name, file));
                // a file that could not be read has been reported by the loader
                return self.points_of_table(written, table?, at, (measures, factors));
            }
            (None, None) => {
                self.problems.add(at.problem(
                    "a curve lacks its points",
                    "add `points: [[0, 0], [1, 10]]`, or `file: …` with the name of a text file of two columns",
                ));
                return None;
            }
            (Some(_), Some(_)) => {
                self.problems.add(at.key("file").key_problem(
                    "a curve has its points here or in a file, not both",
                    "remove `points` or `file`",
                ));
                return None;
            }
        };
        if written.columns.is_some() {
            self.problems.add(at.key("columns").key_problem(
                "columns mean nothing without a file",
                "add `file: …`, or remove `columns`",
            ));
        }
        let place = at.key("points");
        let points = self.listed_points(listed, place, measures, factors)?;
        if points.len() < 2 {
            self.problems.add(place.problem(
                format!(
                    "a curve has at least two points, but this has {}",
                    points.len()
                ),
                "a constant is a curve through two points of the same ordinate",
            ));
        }
        let shown = |index: usize| match listed[index].first().map(|x| &**x) {
            Some(Quantity::Number(x)) => x.to_string(),
            Some(Quantity::Text(text)) => text.clone(),
            _ => String::new(),
        };
        self.check_points(&points, &shown, &|index, message, help| {
            place.item(index).problem(message, help)
        });
        Some(points)
    }

    /// The points of a list, in SI. Points with units determine `measures`; `factors` scale points without units.
    fn listed_points(
        &self,
        listed: &[Vec<WrittenNumber<OfItsUse>>],
        place: At<'_>,
        measures: &mut [Measure; 2],
        factors: [f64; 2],
    ) -> Option<Vec<[f64; 2]>> {
        let mut points = Vec::with_capacity(listed.len());
        for (index, point) in listed.iter().enumerate() {
            let here = place.item(index);
            let [x, y] = point.as_slice() else {
                self.problems.add(
                    here.problem(
                        format!("a point has two numbers, but this list has {}", point.len()),
                        slip::in_list(here)
                            .unwrap_or_else(|| "write `[abscissa, ordinate]`".to_owned()),
                    ),
                );
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
        Some(points)
    }

    /// The points of a file or a channel. Units in headings determine the factors and `measures`; units under `unit`
    /// must not contradict them.
    fn points_of_table(
        &self,
        written: &Written,
        table: &Table,
        at: At<'_>,
        (measures, mut factors): (&mut [Measure; 2], [f64; 2]),
    ) -> Option<Vec<[f64; 2]>> {
        let wanted = self.wanted_columns(written.columns.as_deref(), at.key("columns"))?;
        let columns = match table.columns(wanted.as_ref()) {
            Ok(columns) => columns,
            Err(Fault::InFile(problem)) => {
                self.problems.add(*problem);
                return None;
            }
            Err(Fault::Column(which, message, help)) => {
                let place = match written.columns {
                    Some(_) => at.key("columns").item(which),
                    None => at.key("file"),
                };
                self.problems.add(place.problem(message, help));
                return None;
            }
        };
        for axis in 0..2 {
            let said = written
                .unit
                .is_some()
                .then_some((factors[axis], measures[axis]));
            if let Some(found) = self.unit_of_heading(table, &columns, axis, said, at)? {
                (factors[axis], measures[axis]) = found;
            }
        }
        let rows = &columns.rows;
        let points: Vec<[f64; 2]> = rows
            .iter()
            .map(|row| [row.values[0] * factors[0], row.values[1] * factors[1]])
            .collect();
        let shown = |index: usize| rows[index].values[0].to_string();
        self.check_points(&points, &shown, &|index, message, help| {
            table.problem(&rows[index], 0, message, help)
        });
        Some(points)
    }

    /// The unit in the heading of a column; `Some(None)` if there is none. `said` is the unit given by `unit`.
    fn unit_of_heading(
        &self,
        table: &Table,
        columns: &Columns,
        axis: usize,
        said: Option<(f64, Measure)>,
        at: At<'_>,
    ) -> Option<Option<(f64, Measure)>> {
        let Some(text) = &columns.units[axis] else {
            return Some(None);
        };
        if product(text).is_none() {
            self.problems.add(table.heading_problem(
                columns,
                axis,
                format!("{} in this heading is no unit", quoted(text)),
                "write the unit between the brackets, such as `time [ms]`, or other brackets",
            ));
            return None;
        }
        let found = self.curve_number(&Quantity::Text(text.clone()), at.key("file"))?;
        let differs = |(factor, measure): (f64, Measure)| {
            let known = |measure| match measure {
                Measure::Known(dimension) => dimension,
                Measure::Bare | Measure::Unknown => Dimension::ONE,
            };
            factor != found.0 || known(measure) != known(found.1)
        };
        if said.is_some_and(differs) {
            self.problems.add(table.heading_problem(
                columns,
                axis,
                format!(
                    "the unit of this heading, {}, is not the one under `unit`",
                    quoted(text)
                ),
                "remove `unit`, or correct one of the two",
            ));
            return None;
        }
        Some(Some(found))
    }

    /// The columns that the user asks for; `Some(None)` if none are named.
    fn wanted_columns(
        &self,
        columns: Option<&[Quantity]>,
        at: At<'_>,
    ) -> Option<Option<[Column; 2]>> {
        let Some(columns) = columns else {
            return Some(None);
        };
        let [x, y] = columns else {
            self.problems.add(at.problem(
                format!(
                    "a curve has two columns, but this list has {}",
                    columns.len()
                ),
                "write the column of the abscissa and that of the ordinate: `[time, ax]` or `[1, 2]`",
            ));
            return None;
        };
        let column = |quantity: &Quantity, index: usize| match quantity {
            Quantity::Text(name) => Some(Column::Name(name.clone())),
            Quantity::Number(n) if *n >= 1.0 && n.fract() == 0.0 && *n <= 1e6 => {
                Some(Column::Number(*n as usize))
            }
            _ => {
                self.problems.add(at.item(index).problem(
                    "this is no column",
                    "write a heading of the file, or the number of a column, counted from 1",
                ));
                None
            }
        };
        let (x, y) = (column(x, 0), column(y, 1));
        Some(Some([x?, y?]))
    }

    /// Reports abscissae that do not increase, and pieces that are too steep. `shown` is the text of an abscissa;
    /// `problem` makes a report at a point.
    fn check_points(
        &self,
        points: &[[f64; 2]],
        shown: &dyn Fn(usize) -> String,
        problem: &dyn Fn(usize, String, String) -> Diagnostic,
    ) {
        for (index, pair) in points.windows(2).enumerate() {
            let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
            if x1 <= x0 {
                self.problems.add(problem(
                    index + 1,
                    format!(
                        "the curve runs backwards: the abscissa {} follows {}",
                        shown(index + 1),
                        shown(index)
                    ),
                    "abscissae increase from point to point; a jump is written as a steep segment"
                        .to_owned(),
                ));
                return;
            }
            if !((y1 - y0) / (x1 - x0)).is_finite() {
                self.problems.add(problem(
                    index + 1,
                    "the segment that ends here is infinitely steep".to_owned(),
                    "move its two points apart".to_owned(),
                ));
                return;
            }
        }
    }

    /// A number in a curve, which must not depend on parameters.
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

    /// What a curve written in place is called: after what it belongs to, and the keys that lead to it from there.
    fn name_at(&self, at: At<'_>) -> String {
        let mut trail = at.trail();
        if trail.last() == Some(&Step::Key("curve")) {
            trail.pop();
        }
        let mut name = self.owner.clone();
        for (i, step) in trail.iter().enumerate() {
            name.push(' ');
            match step {
                Step::Key(key) => name.push_str(&key.replace('_', " ")),
                // curves that stand in a list are components
                Step::Item(index) if i + 1 == trail.len() => name.push_str(AXES[self.axis(*index)]),
                Step::Item(index) => name.push_str(&(index + 1).to_string()),
            }
        }
        name
    }

    /// The curve that a key asks for; `None` where it is zero everywhere, or wrong.
    pub fn function<X: InUnit, Y: InUnit>(
        &mut self,
        function: &FunctionOf<X, Y>,
        at: At<'_>,
    ) -> Option<ScaledCurve> {
        self.function_in(function, at, X::EXPECTED, Y::EXPECTED)
    }

    /// The curve that a key asks for, as a function \[`x`\] → \[`y`\]; `None` where it is zero everywhere, or wrong.
    pub fn function_in(
        &mut self,
        function: &Function,
        at: At<'_>,
        x: Expected,
        y: Expected,
    ) -> Option<ScaledCurve> {
        match function {
            Function::Inline(written) => {
                let measured = self.curve(self.name_at(at), written, at);
                self.curves.push(measured);
                let index = self.curves.len() - 1;
                self.scaled(index, None, at, x, y)
            }
            Function::Scaled(WrittenScaled {
                curve,
                times,
                stretch,
            }) => {
                let index = match curve {
                    NameOrCurve::Name(name) => self.find_curve(name, at.key("curve"))?,
                    NameOrCurve::Inline(written) => {
                        let measured = self.curve(self.name_at(at), written, at.key("curve"));
                        self.curves.push(measured);
                        self.curves.len() - 1
                    }
                };
                let stretch = match stretch {
                    Some(stretch) => self.number(stretch, at.key("stretch")),
                    None => Number::Constant(1.0),
                };
                let times = times.as_deref().map(|t| (t, at.key("times")));
                let scaled = self.scaled(index, times, at.key("curve"), x, y)?;
                Some(ScaledCurve { stretch, ..scaled })
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
    pub fn components<Y: InUnit>(
        &mut self,
        written: &[OverTime<Y>],
        at: At<'_>,
    ) -> [FieldComponent; 3] {
        let mut components = [0; 3].map(|_| FieldComponent::Constant(Number::ZERO));
        if self.has_length(written.len(), at) {
            for (index, component) in written.iter().enumerate() {
                let axis = self.axis(index);
                components[axis] = self.component(component, at.item(index));
            }
        }
        components
    }

    /// A constant or a curve of time.
    pub fn component<Y: InUnit>(&mut self, written: &OverTime<Y>, at: At<'_>) -> FieldComponent {
        self.component_in(written, at, Y::EXPECTED)
    }

    /// A constant or a curve of time; of a force it may depend on inputs.
    pub fn component_in(&mut self, function: &Function, at: At<'_>, y: Expected) -> FieldComponent {
        self.inputs_may_stand.set(self.of_force);
        let component = self.constant_or_curve(function, at, y);
        self.inputs_may_stand.set(false);
        component
    }

    fn constant_or_curve(
        &mut self,
        function: &Function,
        at: At<'_>,
        y: Expected,
    ) -> FieldComponent {
        let zero = FieldComponent::Constant(Number::ZERO);
        if let Function::Quantity(quantity) = function {
            let curve = match quantity {
                Quantity::Text(text) => self.curve_names.iter().any(|n| n == text.trim()),
                _ => false,
            };
            if !curve {
                // a single word may be the name of a curve
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
                return FieldComponent::Constant(self.number_in(quantity, at, y));
            }
        }
        match self.function_in(function, at, TIME, y) {
            Some(curve) => FieldComponent::Curve(curve),
            None => zero,
        }
    }

    /// A curve with the same value at all abscissae.
    pub fn constant_curve(&mut self, at: At<'_>, value: Number) -> ScaledCurve {
        self.straight(at, [1.0, 1.0], Extrapolate::Hold, value)
    }

    /// The line from 0 to 1 over the abscissae 0 to 1, held on both sides.
    pub fn part_that_is_over(&mut self, at: At<'_>) -> ScaledCurve {
        self.straight(at, [0.0, 1.0], Extrapolate::Hold, Number::Constant(1.0))
    }

    /// The line through 0 with this slope; `None` if the slope is 0.
    pub fn line(&mut self, at: At<'_>, slope: Number) -> Option<ScaledCurve> {
        if slope.is_zero() {
            return None;
        }
        let line = self.straight(at, [0.0, 1.0], Extrapolate::Linear, slope);
        Some(ScaledCurve {
            stiffness: true,
            ..line
        })
    }

    /// `times` the straight line with these ordinates at 0 and 1. The line is entered as a curve.
    fn straight(
        &mut self,
        at: At<'_>,
        [from, to]: [f64; 2],
        extrapolate: Extrapolate,
        times: Number,
    ) -> ScaledCurve {
        let name = self.name_at(at);
        self.curves.push(Some(Measured {
            curve: Curve {
                name,
                points: vec![[0.0, from], [1.0, to]],
                interpolate: Interpolate::Linear,
                extrapolate,
                states_extrapolation: true,
                thinned: None,
            },
            measures: [Measure::Bare; 2],
        }));
        ScaledCurve {
            curve: self.curves.len() - 1,
            times,
            stretch: Number::Constant(1.0),
            stiffness: false,
        }
    }

    /// The elastic law of a coordinate: a curve at `key`, or the line of a `stiffness`; `None` if there is none. The
    /// quantities are abscissa, ordinate and slope.
    pub fn elastic_in(
        &mut self,
        (key, curve): (&str, Option<&NoConstant>),
        stiffness: Option<&Quantity>,
        at: At<'_>,
        [x, y, slope]: [Expected; 3],
    ) -> Option<ScaledCurve> {
        let place = at.key("stiffness");
        match (curve, stiffness) {
            (Some(_), Some(_)) => {
                self.problems.add(place.key_problem(
                    format!("there are a curve, `{key}`, and a stiffness"),
                    format!("`stiffness` is short for a straight curve; keep it or `{key}`"),
                ));
                None
            }
            (Some(curve), None) => self.function_in(curve, at.key(key), x, y),
            (None, Some(stiffness)) => {
                let slope = self.number_in(stiffness, place, slope);
                self.line(place, slope)
            }
            (None, None) => None,
        }
    }

    /// True if a word stands for a number in an expression.
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
            // ordinates without units are pure numbers if the factor has a dimension, otherwise they are in SI
            (Measure::Bare, Measure::Known(b)) if b != Dimension::ONE => Measure::Known(b),
            _ => Measure::Unknown,
        };
        for (what, measure, expected) in [("abscissa", measures[0], x), ("ordinate", ordinate, y)] {
            if let Measure::Known(dimension) = measure
                && !expected.accepts(dimension)
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
            stretch: Number::Constant(1.0),
            stiffness: false,
        })
    }

    /// The unscaled curve, and its factor `times` at the default parameters; `None` if the curve is wrong.
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

/// True for a word without operators, such as a name.
fn is_word(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_')
}
