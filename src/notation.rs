//! Names for the inputs of a model in printed equations: `phi_head` in text, `\phi_{\mathrm{head}}` in LaTeX.
//!
//! A variable `man/head.phi` is named by its component and its element. The system is added only if the name of the
//! element is ambiguous. Curves and parameters keep their names.

use bryant_generator::equations::{Equations, Variable};
use bryant_generator::expression::print::{self, latex};
use bryant_generator::expression::{Function, Symbol};
use bryant_generator::law::ForceKind;
use bryant_generator::model::{Force, Model};

/// The names of the inputs and functions of a model.
#[derive(Clone, Debug)]
pub struct Notation {
    coordinates: Vec<Name>,
    velocities: Vec<Name>,
    parameters: Vec<String>,
    curves: Vec<String>,
    /// For each user force, the names of the results of its function.
    users: Vec<Vec<String>>,
}

/// The name of a variable: its component, and its element or system.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Name {
    component: String,
    owner: Vec<String>,
}

impl Notation {
    /// The notation of a model.
    pub fn new(model: &Model, equations: &Equations) -> Self {
        let names =
            |variables: &[Variable]| variables.iter().map(|v| Name::new(model, v)).collect();
        Self {
            coordinates: names(&equations.coordinates),
            velocities: names(&equations.velocities),
            parameters: model.parameters.iter().map(|p| p.name.clone()).collect(),
            curves: model.curves.iter().map(|c| identifier(&c.name)).collect(),
            users: model.forces.iter().map(results).collect(),
        }
    }

    /// The name of an input as an identifier.
    pub fn text(&self, symbol: Symbol) -> String {
        match self.name(symbol) {
            Ok(name) => name.text(),
            Err(text) => text,
        }
    }

    /// The name of an input as LaTeX.
    pub fn latex(&self, symbol: Symbol) -> String {
        match self.name(symbol) {
            Ok(name) => name.latex(),
            Err(text) => latex::identifier(&text),
        }
    }

    /// The name of a function as an identifier.
    pub fn function(&self, function: Function) -> String {
        let curve = |index: u32, suffix: &str| {
            let name = self.curves.get(index as usize);
            name.map(|name| format!("{name}{suffix}"))
        };
        let named = match function {
            Function::Curve(i) => curve(i, ""),
            Function::CurveSlope(i) => curve(i, "_slope"),
            Function::CurveSecondDerivative(i) => curve(i, "_second_derivative"),
            Function::CurveInverse(i) => curve(i, "_inverse"),
            Function::CurveIntegral(i) => curve(i, "_integral"),
            Function::CurveDoubleIntegral(i) => curve(i, "_double_integral"),
            Function::CurveBreakpoints(i) => curve(i, "_breakpoint_indicator"),
            Function::CurveStop(i) => curve(i, "_stop"),
            Function::User(call) => {
                let results = self.users.get(usize::from(call.force));
                results.and_then(|r| r.get(usize::from(call.part)).cloned())
            }
            _ => None,
        };
        named.unwrap_or_else(|| print::function_name(function))
    }

    fn name(&self, symbol: Symbol) -> Result<&Name, String> {
        let found = match symbol {
            Symbol::Coordinate(i) => self.coordinates.get(i as usize),
            Symbol::Velocity(i) => self.velocities.get(i as usize),
            Symbol::Parameter(i) => {
                let name = self.parameters.get(i as usize).cloned();
                return Err(name.unwrap_or_else(|| print::symbol_name(symbol)));
            }
            Symbol::Auxiliary(_) | Symbol::Memory(_) | Symbol::Acceleration(_) => None,
            Symbol::Time => None,
        };
        found.ok_or_else(|| print::symbol_name(symbol))
    }
}

/// Names of the results of a user force's function: `drag_returns_head_force_x`.
fn results(force: &Force) -> Vec<String> {
    match ForceKind::of(force) {
        ForceKind::User(user) => {
            let results = user.results();
            let function = identifier(user.function.name.rsplit("::").next().unwrap_or_default());
            let named = results.iter().map(|r| format!("{function}_returns_{r}"));
            named.collect()
        }
        _ => Vec::new(),
    }
}

impl Name {
    fn new(model: &Model, variable: &Variable) -> Self {
        let (_, component) = variable
            .name
            .rsplit_once('.')
            .unwrap_or(("", &variable.name));
        let system = &model.systems[variable.system];
        let owner = match variable.element.map(|index| &system.elements[index].name) {
            None => vec![identifier(&system.name)],
            Some(element) => {
                let elements = model.systems.iter().flat_map(|s| &s.elements);
                let unique = elements.filter(|e| e.name == *element).count() == 1;
                // an element with the name of a system would be ambiguous
                let alone = unique && model.systems.iter().all(|s| s.name != *element);
                let system = (!alone).then(|| identifier(&system.name));
                system.into_iter().chain([identifier(element)]).collect()
            }
        };
        Self {
            component: component.to_owned(),
            owner,
        }
    }

    fn text(&self) -> String {
        format!("{}_{}", self.component, self.owner.join("_"))
    }

    fn latex(&self) -> String {
        let (base, index) = match self.component.as_str() {
            "x" | "y" | "z" => (self.component.clone(), ""),
            "vx" => ("\\dot{x}".into(), ""),
            "vy" => ("\\dot{y}".into(), ""),
            "vz" => ("\\dot{z}".into(), ""),
            "phi" => ("\\varphi".into(), ""),
            "omega" => ("\\dot{\\varphi}".into(), ""),
            "phi1" => ("\\varphi".into(), "1"),
            "phi2" => ("\\varphi".into(), "2"),
            "phi3" => ("\\varphi".into(), "3"),
            "dphi1" => ("\\dot{\\varphi}".into(), "1"),
            "dphi2" => ("\\dot{\\varphi}".into(), "2"),
            "dphi3" => ("\\dot{\\varphi}".into(), "3"),
            "wx" => ("\\omega".into(), "x"),
            "wy" => ("\\omega".into(), "y"),
            "wz" => ("\\omega".into(), "z"),
            "qw" => ("q".into(), "w"),
            "qx" => ("q".into(), "x"),
            "qy" => ("q".into(), "y"),
            "qz" => ("q".into(), "z"),
            other => (latex::identifier(other), ""),
        };
        let owner = self.owner.iter().map(|part| {
            let part = part.replace('_', "\\_");
            format!("\\mathrm{{{part}}}")
        });
        let index = Some(index.to_owned()).filter(|i| !i.is_empty());
        let subscripts: Vec<String> = owner.chain(index).collect();
        format!("{base}_{{{}}}", subscripts.join(","))
    }
}

/// A name as an identifier: characters other than letters, digits and underscores become underscores.
fn identifier(name: &str) -> String {
    let replaced = name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
    let text: String = replaced.collect();
    match text.starts_with(|c: char| c.is_ascii_digit()) {
        true => format!("_{text}"),
        false => text,
    }
}
