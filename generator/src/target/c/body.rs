//! Writes a list as the body of a C function: a statement for each operation, then a store for each result.

use super::support::Support;
use super::{indented, number};
use crate::expression::{ApproachCall, Function};
use crate::program::{Input, List, Operation, Value};
use std::fmt::Write as _;

/// The statements of a list, and which arguments of the C function they use.
pub(super) struct Body {
    pub text: String,
    /// True if the statements use `m`: parameters and values derived from them.
    pub uses_model: bool,
    /// True if the statements use `t`.
    pub uses_time: bool,
    /// True if the statements use `y`.
    pub uses_state: bool,
    /// True if the statements use `accelerations`.
    pub uses_accelerations: bool,
}

/// Writes a list as statements that store its results to `results[0]`, `results[1]` and so on. `m` is a pointer to the
/// model, `t` the time, `y` the state. Accelerations are in `accelerations`, event functions in `event_functions`.
pub(super) fn body(list: &List, curve: &dyn Fn(u32) -> String, support: &mut Support) -> Body {
    let first = list.constants.len() + list.inputs.len();
    let mut writer = Writer {
        list,
        curve,
        support,
        names: Vec::with_capacity(list.values()),
        used: used(list),
        text: String::new(),
    };
    writer
        .names
        .extend(list.constants.iter().map(|c| number(*c)));
    writer.names.extend(list.inputs.iter().map(|i| input(*i)));
    for operation in &list.operations {
        let name = writer.names.len() - first + 1;
        writer.operation(*operation, name);
    }
    let mut text = std::mem::take(&mut writer.text);
    for (k, result) in list.results.iter().enumerate() {
        let _ = writeln!(
            text,
            "    results[{k}] = {};",
            writer.names[result.0 as usize]
        );
    }
    let reads = |reads: fn(&Input) -> bool| {
        let inputs = list.inputs.iter().enumerate();
        let mut read = inputs.filter(|(k, _)| writer.used[list.constants.len() + k]);
        read.any(|(_, input)| reads(input))
    };
    Body {
        uses_model: reads(|i| matches!(i, Input::Parameter(_) | Input::Derived(_))),
        uses_time: reads(|i| matches!(i, Input::Time)),
        uses_state: reads(|i| matches!(i, Input::State(_))),
        uses_accelerations: reads(|i| matches!(i, Input::Acceleration(_))),
        text,
    }
}

/// For each value of a list, true if a result depends on it.
fn used(list: &List) -> Vec<bool> {
    let mut used = vec![false; list.values()];
    for result in &list.results {
        used[result.0 as usize] = true;
    }
    let mut end = used.len();
    for operation in list.operations.iter().rev() {
        let begin = end - operation.defines();
        if used[begin..end].contains(&true) {
            for operand in list.operands(*operation) {
                used[operand.0 as usize] = true;
            }
        }
        end = begin;
    }
    used
}

fn input(input: Input) -> String {
    match input {
        Input::Time => "t".to_owned(),
        Input::State(i) => format!("y[{i}]"),
        Input::Acceleration(i) => format!("accelerations[{i}]"),
        Input::EventFunction(i) => format!("event_functions[{i}]"),
        Input::Parameter(i) => format!("m->parameters[{i}]"),
        Input::Derived(i) => format!("m->derived[{i}]"),
    }
}

struct Writer<'a> {
    list: &'a List,
    /// Returns the name of a curve, given its index.
    curve: &'a dyn Fn(u32) -> String,
    support: &'a mut Support,
    /// For each value, the C expression that stands for it.
    names: Vec<String>,
    used: Vec<bool>,
    text: String,
}

impl Writer<'_> {
    fn of(&self, value: Value) -> &str {
        &self.names[value.0 as usize]
    }

    /// Writes an operation, unless no result depends on it. `name` is the number in the name of its variable.
    fn operation(&mut self, operation: Operation, name: usize) {
        let begin = self.names.len();
        let defines = operation.defines();
        let is_used = |k: usize| self.used[begin + k];
        if !(0..defines).any(is_used) {
            let nobody = std::iter::repeat_n(String::new(), defines);
            return self.names.extend(nobody);
        }
        if let Operation::SinCos(a) = operation {
            self.support.want("sin_cos");
            let (sine, cosine) = (format!("s{name}"), format!("c{name}"));
            let _ = writeln!(self.text, "    double {sine}, {cosine};");
            let angle = self.of(a).to_owned();
            let _ = writeln!(
                self.text,
                "    bryant_sin_cos({angle}, &{sine}, &{cosine});"
            );
            return self.names.extend([sine, cosine]);
        }
        if let Operation::Call { function, first } = operation {
            if function.part().is_some() {
                return self.several(function, first, name);
            }
            let text = self.call(function, first);
            self.define(&format!("v{name}"), &text);
        } else {
            let text = self.algebra(operation);
            self.define(&format!("v{name}"), &text);
        }
        self.names.push(format!("v{name}"));
    }

    fn define(&mut self, name: &str, text: &str) {
        let _ = writeln!(self.text, "    const double {name} = {text};");
    }

    fn algebra(&mut self, operation: Operation) -> String {
        match operation {
            Operation::MulAdd(..) => self.support.want("multiply_add"),
            Operation::Atan2(..) => self.support.want("angle"),
            Operation::Max(..) => self.support.want("maximum"),
            Operation::Min(..) => self.support.want("minimum"),
            _ => {}
        }
        let of = |value| self.of(value);
        match operation {
            Operation::Neg(a) => format!("-{}", of(a)),
            Operation::Add(a, b) => format!("{} + {}", of(a), of(b)),
            Operation::Sub(a, b) => format!("{} - {}", of(a), of(b)),
            Operation::Mul(a, b) => format!("{} * {}", of(a), of(b)),
            Operation::Div(a, b) => format!("{} / {}", of(a), of(b)),
            Operation::MulAdd(a, b, c) => {
                format!("MULTIPLY_ADD({}, {}, {})", of(a), of(b), of(c))
            }
            Operation::Sqrt(a) => format!("sqrt({})", of(a)),
            Operation::Atan2(a, b) => format!("bryant_angle({}, {})", of(a), of(b)),
            Operation::Max(a, b) => format!("bryant_maximum({}, {})", of(a), of(b)),
            Operation::Min(a, b) => format!("bryant_minimum({}, {})", of(a), of(b)),
            Operation::SinCos(_) | Operation::Call { .. } => {
                unreachable!("these are written by themselves")
            }
        }
    }

    /// The arguments of a call, separated by commas.
    fn arguments(&self, function: Function, first: u32) -> String {
        let first = first as usize;
        let values = &self.list.arguments[first..first + function.arity()];
        let values: Vec<&str> = values.iter().map(|value| self.of(*value)).collect();
        values.join(", ")
    }

    /// The expression that calls a function with one result.
    fn call(&mut self, function: Function, first: u32) -> String {
        let (part, curve) = match function {
            Function::Curve(curve) => ("curve_value", Some(curve)),
            Function::CurveSlope(curve) => ("curve_slope", Some(curve)),
            Function::CurveSecondDerivative(curve) => ("curve_second_derivative", Some(curve)),
            Function::CurveInverse(curve) => ("curve_inverse", Some(curve)),
            Function::CurveIntegral(curve) => ("curve_integral", Some(curve)),
            Function::CurveDoubleIntegral(curve) => ("curve_double_integral", Some(curve)),
            Function::CurveBreakpoints(curve) => ("curve_breakpoint_indicator", Some(curve)),
            Function::CurveStop(curve) => ("curve_stop", Some(curve)),
            Function::Choose => ("choose", None),
            Function::Power => ("power", None),
            Function::Support(_) | Function::Approach(_) | Function::User(_) => {
                unreachable!("these have several results")
            }
        };
        self.support.want(part);
        let arguments = self.arguments(function, first);
        match curve {
            Some(index) => format!("bryant_{part}(&{}, {arguments})", (self.curve)(index)),
            None => format!("bryant_{part}({arguments})"),
        }
    }

    /// Writes a call of a function with several results, which go to an array.
    fn several(&mut self, function: Function, first: u32, name: usize) {
        let (part, early) = match function {
            Function::Support(_) => ("support", None),
            Function::Approach(ApproachCall { planar, early, .. }) => match planar {
                true => ("approach_plane", Some(early)),
                false => ("approach_space", Some(early)),
            },
            _ => unreachable!(
                "the caller refuses functions of the user's, and others have one result"
            ),
        };
        self.support.want(part);
        let results = function.part().map_or(1, |(_, parts)| parts);
        let (given, arguments) = (function.arity(), self.arguments(function, first));
        let early = early.map_or(String::new(), |early| format!("{}, ", u8::from(early)));
        let line = format!("const double a{name}[{given}] = {{{arguments}}};");
        self.text.push_str(&indented(&line));
        let _ = writeln!(self.text, "    double r{name}[{results}];");
        let _ = writeln!(self.text, "    bryant_{part}(a{name}, {early}r{name});");
        let parts = (0..results).map(|k| format!("r{name}[{k}]"));
        self.names.extend(parts);
    }
}
