//! A specification for each emitted method, in the order of the emitted text.
//!
//! A new method needs a function here and its line in `TABLE`, and a row in the table of [`Method`], unless it is a
//! part of another method. A new section needs neither of the two here: `dynamics/sections.rs` says what it computes.

use super::inputs::{Argument, Inputs};
use super::results::{Length, Results};
use super::{Method, Start};
use crate::equations::{Equations, Function, LawState, Named, Route, Section};
use crate::expression::liveness::{Dependence, Live};
use crate::expression::{Node, NodeId};
use crate::model::Model;
use crate::names::{Names, snake};
use std::borrow::Cow;
use std::collections::BTreeSet;

/// A method before any pass.
#[derive(Clone, Debug)]
pub struct Specification {
    pub name: Cow<'static, str>,
    /// The method of the lists that this method is or belongs to; the parts of a method follow one another in the order
    /// of the table. `None` if another method of the lists contains the same results.
    pub part_of: Option<Method>,
    /// What the method computes, in one sentence.
    pub documentation: &'static str,
    /// The arguments of the method.
    pub arguments: Vec<Argument>,
    /// The results, as nodes of the equations.
    pub roots: Vec<NodeId>,
    /// Names for roots that have none, one per root.
    pub labels: Vec<String>,
    /// How the roots are returned.
    pub results: Results,
    /// For a function that is asked for, its index in [`Equations::functions`].
    pub function: Option<usize>,
    /// Values that the method receives as arguments: the event functions, or the accelerations if computing them again
    /// would be most of the method's work.
    pub start: Start,
    /// True if the method is evaluated over lanes and writes to no output writer. It is then always inlined: wide
    /// registers are used only in functions compiled for them, which are in the runtime, so all methods that these call
    /// must become parts of them.
    pub in_lanes: bool,
    /// True if the runtime has a method of this name that takes the whole state instead of its parts. The generated
    /// method then gets a different name.
    pub of_parts: bool,
}

/// The sources from which specifications are made.
pub struct Source<'a> {
    pub model: &'a Model,
    pub equations: &'a Equations,
    pub inputs: &'a Inputs,
    /// True if S, r_s and r_k are wanted.
    pub matrices: bool,
}

/// All methods but [`new`], [`motion`], the sections and the outputs, which follow. An entry is `None` for a model that
/// has no such method.
const TABLE: [fn(&Source<'_>) -> Option<Specification>; 17] = [
    initial_conditions,
    initial_auxiliaries,
    initial_memory,
    mass_matrix,
    velocity_forces,
    applied_forces,
    accelerations,
    coordinate_rates,
    kink_rates,
    auxiliary_rates,
    renewed,
    event_functions,
    kinks,
    onsets,
    curves,
    pivots,
    conditions,
];

/// The methods that a model has. `only` are the names of the wanted methods; `None` means all.
pub fn methods(source: &Source<'_>, only: Option<&[&str]>) -> Vec<Specification> {
    let sections = source.equations.sections.iter();
    let found = TABLE.iter().filter_map(|entry| entry(source));
    found
        .chain(sections.map(|section| source.section(section)))
        .chain(outputs(source))
        .chain(functions(source))
        .filter(|method| only.is_none_or(|only| only.contains(&&*method.name)))
        .collect()
}

/// The method that computes the values that depend on parameters alone. Its roots are found by the passes; its labels
/// are the fields in which they are stored.
pub fn new(inputs: &Inputs) -> Specification {
    Specification {
        documentation: "The mechanism with these parameters; what depends on them alone is computed here, once.",
        labels: inputs.derived.clone(),
        ..of_parameters("new", Method::Derived, Results::Mechanism)
    }
}

/// q̇ and v̇ as one method, made of the methods for each, so that the coordinates and velocities of an element are read
/// once for both.
pub fn motion(rates: &Specification, accelerations: &Specification) -> Specification {
    Specification {
        name: "motion".into(),
        part_of: Some(Method::Derivative),
        documentation: "q̇ and, in places behind it, v̇, one by one, each as soon as it is found.",
        roots: [&rates.roots[..], &accelerations.roots].concat(),
        labels: [&rates.labels[..], &accelerations.labels].concat(),
        results: Results::Written {
            by: EACH_MOTION,
            length: None,
        },
        ..accelerations.clone()
    }
}

/// The method that writes q̇ and v̇.
pub const EACH_MOTION: &str = "each_motion";

/// True if the memory is renewed by the sign of an event function. The method then receives the event functions, so
/// that it has exactly the values that ended the step: a value close to 0 that is computed again may have the other
/// sign.
pub fn renews_by_event_functions(equations: &Equations) -> bool {
    let live = Live::new(&equations.graph, &next(&equations.memory));
    let event_functions = equations
        .event_functions
        .iter()
        .map(|event_function| event_function.value);
    let computed = |id: &NodeId| !matches!(equations.graph.node(*id), Node::Symbol(_));
    event_functions
        .filter(computed)
        .any(|event_function| live.nodes().contains(&event_function))
}

fn initial_conditions(from: &Source<'_>) -> Option<Specification> {
    let Source {
        equations, inputs, ..
    } = from;
    Some(Specification {
        documentation: "q and v where a run starts.",
        roots: [
            &equations.initial_coordinates[..],
            &equations.initial_velocities,
        ]
        .concat(),
        labels: [&inputs.coordinates[..], &inputs.velocities].concat(),
        in_lanes: true,
        ..of_parameters("initial_conditions", Method::InitialState, Results::Start)
    })
}

fn initial_auxiliaries(from: &Source<'_>) -> Option<Specification> {
    let states = some(&from.equations.auxiliaries)?;
    let results = Results::Array(Length::Auxiliaries);
    Some(Specification {
        documentation: "z, the states of force laws, where a run starts.",
        roots: states.iter().map(|state| state.initial).collect(),
        labels: from.inputs.auxiliaries.clone(),
        in_lanes: true,
        ..of_parameters("initial_auxiliaries", Method::InitialState, results)
    })
}

fn initial_memory(from: &Source<'_>) -> Option<Specification> {
    let states = some(&from.equations.memory)?;
    let results = Results::Array(Length::Memory);
    Some(Specification {
        documentation: match from.equations.charts {
            0 => "m, what force laws remember, where a run starts.",
            _ => "m, the charts of elements and what force laws remember, where a run starts.",
        },
        roots: states.iter().map(|state| state.initial).collect(),
        labels: from.inputs.memory.clone(),
        in_lanes: true,
        ..of_parameters("initial_memory", Method::InitialState, results)
    })
}

fn mass_matrix(from: &Source<'_>) -> Option<Specification> {
    from.matrices.then_some(())?;
    let v = &from.inputs.velocities;
    let rows = from.equations.mass_matrix.iter().enumerate();
    let roots: Vec<NodeId> = rows
        .flat_map(|(row, entries)| entries.iter().skip(row).copied())
        .collect();
    let pairs = (0..v.len()).flat_map(|row| (row..v.len()).map(move |column| (row, column)));
    let labels = pairs.map(|(row, column)| format!("s_{}_{}", v[row], v[column]));
    let arguments = from.timed(&roots, &[Argument::Coordinates]);
    Some(Specification {
        documentation: match arguments.contains(&Argument::Time) {
            true => {
                "S(t, q), symmetric: S v̇ = r_s + r_k \\[MADYMO 1980, eq. 2\\]. Rows and columns in the order of v."
            }
            false => {
                "S(q), symmetric: S v̇ = r_s + r_k \\[MADYMO 1980, eq. 2\\]. Rows and columns in the order of v."
            }
        },
        arguments,
        roots,
        labels: labels.collect(),
        ..of_parameters("mass_matrix", Method::MassMatrix, Results::Matrix)
    })
}

fn velocity_forces(from: &Source<'_>) -> Option<Specification> {
    from.matrices.then_some(())?;
    let roots = &from.equations.velocity_forces;
    let arguments = from.timed(roots, &[Argument::Coordinates, Argument::Velocities]);
    Some(Specification {
        documentation: match arguments.contains(&Argument::Time) {
            true => {
                "r_s(t, q, v), the forces of inertia when v̇ = 0, but for those of given accelerations."
            }
            false => "r_s(q, v), the forces of inertia that are quadratic in the velocities.",
        },
        arguments,
        roots: roots.clone(),
        labels: labels("r_s_", &from.inputs.velocities, ""),
        ..of_parameters("velocity_forces", Method::VelocityForces, Results::Vector)
    })
}

fn applied_forces(from: &Source<'_>) -> Option<Specification> {
    from.matrices.then(|| Specification {
        documentation: "r_k(t, q, v), the generalised forces of everything that acts on the elements.",
        roots: from.equations.applied_forces.clone(),
        labels: labels("r_k_", &from.inputs.velocities, ""),
        ..from.of_state("applied_forces", Method::AppliedForces, Results::Vector)
    })
}

/// Not a part of the lists: they contain v̇ in [`motion`].
fn accelerations(from: &Source<'_>) -> Option<Specification> {
    let results = Results::Written {
        by: "each_acceleration",
        length: Some(Length::Velocities),
    };
    Some(Specification {
        part_of: None,
        documentation: match from.equations.route {
            Route::Elimination => {
                "v̇(t, q, v) by elimination from the leaves to the root; S is never assembled."
            }
            Route::MassMatrix => {
                "v̇(t, q, v) from S v̇ = r_s + r_k by S = LᵀDL in its fixed pattern."
            }
        },
        roots: from.equations.accelerations.clone(),
        labels: labels("", &from.inputs.velocities, "_dot"),
        ..from.of_state("accelerations", Method::Derivative, results)
    })
}

fn coordinate_rates(from: &Source<'_>) -> Option<Specification> {
    let results = Results::Written {
        by: "each_coordinate_rate",
        length: Some(Length::Coordinates),
    };
    Some(Specification {
        arguments: vec![Argument::Coordinates, Argument::Velocities],
        roots: from.equations.coordinate_rates.clone(),
        labels: labels("", &from.inputs.coordinates, "_dot"),
        of_parts: true,
        ..of_parameters("coordinate_rates", Method::CoordinateRates, results)
    })
}

fn kink_rates(from: &Source<'_>) -> Option<Specification> {
    let stretched = from.equations.stretched_curves_of_time();
    let rates: Vec<NodeId> = stretched.map(|(_, rate)| rate).collect();
    let results = Results::Array(Length::Number(rates.len()));
    (!rates.is_empty()).then(|| Specification {
        labels: (0..rates.len()).map(|i| format!("rate_{i}")).collect(),
        roots: rates,
        ..of_parameters("kink_rates", Method::KinkRates, results)
    })
}

fn auxiliary_rates(from: &Source<'_>) -> Option<Specification> {
    let states = some(&from.equations.auxiliaries)?;
    let results = Results::Written {
        by: "each_auxiliary_rate",
        length: Some(Length::Auxiliaries),
    };
    Some(Specification {
        documentation: "ż(t, q, v, z).",
        roots: next(states),
        labels: labels("", &from.inputs.auxiliaries, "_dot"),
        ..from.of_state("auxiliary_rates", Method::Derivative, results)
    })
}

/// m and, if orientations have charts, q and v.
fn renewed(from: &Source<'_>) -> Option<Specification> {
    let Source {
        equations, inputs, ..
    } = from;
    let memory = next(some(&equations.memory)?);
    let charted = equations.charts > 0;
    let (name, results) = match charted {
        true => ("renewed", Results::Renewed),
        false => ("renewed_memory", Results::Array(Length::Memory)),
    };
    let mut method = from.of_state(name, Method::Renewed, results);
    method.in_lanes = true;
    if renews_by_event_functions(equations) {
        method.arguments.push(Argument::EventFunctions);
        method.start = Start::EventFunctions;
    }
    let words = match charted {
        true => {
            method.documentation = "q, v and m after a step that was accepted with this state: angles near ±90 deg in the other chart.";
            let (q, v) = (
                &equations.renewed_coordinates[..],
                &equations.renewed_velocities,
            );
            method.roots = [q, v, &memory].concat();
            [&inputs.coordinates[..], &inputs.velocities, &inputs.memory].concat()
        }
        false => {
            method.documentation = "m after a step that was accepted with this state.";
            method.roots = memory;
            inputs.memory.clone()
        }
    };
    method.labels = labels("", &words, "_renewed");
    Some(method)
}

fn event_functions(from: &Source<'_>) -> Option<Specification> {
    let event_functions = some(&from.equations.event_functions)?;
    let results = Results::Array(Length::EventFunctions);
    Some(Specification {
        roots: values(event_functions),
        labels: named("event_function_", event_functions),
        start: Start::Accelerations,
        in_lanes: true,
        of_parts: true,
        ..from.of_state("event_functions", Method::EventFunctions, results)
    })
}

fn kinks(from: &Source<'_>) -> Option<Specification> {
    let kinks = some(&from.equations.kinks)?;
    let results = Results::Array(Length::Number(kinks.len()));
    Some(Specification {
        roots: values(kinks),
        labels: named("kink_", kinks),
        in_lanes: true,
        of_parts: true,
        ..from.of_state("kinks", Method::Kinks, results)
    })
}

fn onsets(from: &Source<'_>) -> Option<Specification> {
    let onsets = some(&from.equations.onsets)?;
    let results = Results::Array(Length::Number(2 * onsets.len()));
    let gaps = onsets.iter().map(|onset| onset.gap);
    let speeds = onsets.iter().map(|onset| onset.speed);
    let names: Vec<String> = onsets.iter().map(|onset| snake(&onset.name)).collect();
    Some(Specification {
        roots: gaps.chain(speeds).collect(),
        labels: [labels("gap_", &names, ""), labels("speed_", &names, "")].concat(),
        in_lanes: true,
        of_parts: true,
        ..from.of_state("onsets", Method::Onsets, results)
    })
}

fn curves(from: &Source<'_>) -> Option<Specification> {
    let curves = some(&from.equations.curves)?;
    let names = curves.iter().map(|curve| snake(&curve.name));
    let results = Results::Array(Length::Number(curves.len()));
    Some(Specification {
        roots: curves.iter().map(|curve| curve.argument).collect(),
        labels: names.map(|name| format!("argument_{name}")).collect(),
        of_parts: true,
        ..from.of_state("curves", Method::Curves, results)
    })
}

fn pivots(from: &Source<'_>) -> Option<Specification> {
    let pivots = some(&from.equations.pivots)?;
    let results = Results::Array(Length::Number(pivots.len()));
    Some(Specification {
        roots: values(pivots),
        labels: named("pivot_", pivots),
        ..from.of_state("pivots", Method::Pivots, results)
    })
}

fn conditions(from: &Source<'_>) -> Option<Specification> {
    let conditions = some(&from.equations.conditions)?;
    let results = Results::Array(Length::Number(conditions.len()));
    let numbers = 1..=conditions.len();
    Some(Specification {
        roots: conditions.iter().map(|condition| condition.value).collect(),
        labels: numbers.map(|k| format!("condition_{k}")).collect(),
        ..of_parameters("conditions", Method::Conditions, results)
    })
}

fn outputs(from: &Source<'_>) -> Option<Specification> {
    let outputs = from.model.outputs.iter();
    let results = Results::Array(Length::Outputs);
    Some(Specification {
        roots: from.equations.outputs.clone(),
        labels: outputs.map(|output| output.name.clone()).collect(),
        start: Start::Accelerations,
        in_lanes: true,
        of_parts: true,
        ..from.of_state("outputs", Method::Outputs, results)
    })
}

/// The functions that are asked for.
fn functions(from: &Source<'_>) -> Vec<Specification> {
    let mut names = Names::with(&[]);
    let functions = from.equations.functions.iter().enumerate();
    let specification = |(index, function): (usize, &Function)| {
        let name = names.take(&snake(&function.name));
        let label = |row: &String, column: &String| snake(&format!("{name} {row} {column}"));
        let rows = function.rows.iter();
        let labels = rows.flat_map(|row| function.columns.iter().map(move |c| label(row, c)));
        let labels = labels.collect();
        Specification {
            labels,
            part_of: None,
            documentation: function.sentence,
            arguments: from.arguments(function),
            roots: function.values.clone(),
            function: Some(index),
            ..of_parameters(
                "",
                Method::Derived,
                Results::Table(function.rows.len(), function.columns.len()),
            )
        }
        .named(name)
    };
    functions.map(specification).collect()
}

impl Specification {
    fn named(self, name: String) -> Self {
        Specification {
            name: name.into(),
            ..self
        }
    }
}

/// A method of parameters alone, without results so far.
fn of_parameters(name: &'static str, part_of: Method, results: Results) -> Specification {
    Specification {
        name: name.into(),
        part_of: Some(part_of),
        documentation: part_of.sentence(),
        arguments: Vec::new(),
        roots: Vec::new(),
        labels: Vec::new(),
        results,
        function: None,
        start: Start::State,
        in_lanes: false,
        of_parts: false,
    }
}

impl Source<'_> {
    /// A method of t, q and v, and of z and m if the model has them, without results so far.
    fn of_state(&self, name: &'static str, part_of: Method, results: Results) -> Specification {
        let all = [
            Argument::Time,
            Argument::Coordinates,
            Argument::Velocities,
            Argument::Auxiliaries,
            Argument::Memory,
        ];
        let there = |argument: &Argument| match argument {
            Argument::Auxiliaries => !self.equations.auxiliaries.is_empty(),
            Argument::Memory => !self.equations.memory.is_empty(),
            _ => true,
        };
        Specification {
            arguments: all.into_iter().filter(there).collect(),
            ..of_parameters(name, part_of, results)
        }
    }

    /// The method of a section.
    fn section(&self, section: &Section) -> Specification {
        let name = section.method.name();
        let one = name.strip_suffix('s').unwrap_or(name);
        let label = |named: &Named| match named.name.as_str() {
            "" => name.to_owned(),
            of => format!("{one}_{}", snake(of)),
        };
        let results = match &section.values[..] {
            [alone] if alone.name.is_empty() => Results::Scalar,
            values => Results::Array(Length::Number(values.len())),
        };
        Specification {
            roots: values(&section.values),
            labels: section.values.iter().map(label).collect(),
            start: section.start,
            of_parts: true,
            ..self.of_state(name, section.method, results)
        }
    }

    /// The arguments that a function always has, and t, z and m if it depends on them.
    fn arguments(&self, function: &Function) -> Vec<Argument> {
        let graph = &self.equations.graph;
        let live = Live::new(graph, &function.values);
        let inputs = live.nodes().iter().filter_map(|&id| match graph.node(id) {
            Node::Symbol(symbol) => self.inputs.input(symbol).argument(),
            _ => None,
        });
        let all: BTreeSet<Argument> = inputs.chain(function.arguments.iter().copied()).collect();
        all.into_iter().collect()
    }

    /// The given arguments, preceded by t if the results depend on time (as S and r_s do if a turning vehicle carries a
    /// root whose joint is not a ball), and followed by m if orientations have charts.
    fn timed(&self, roots: &[NodeId], arguments: &[Argument]) -> Vec<Argument> {
        let live = Live::new(&self.equations.graph, roots);
        let depends = |id: &NodeId| Dependence::TIME.within(live.dependence(*id));
        let time = roots.iter().any(depends).then_some(Argument::Time);
        let charts = (self.equations.charts > 0).then_some(Argument::Memory);
        let arguments = arguments.iter().copied();
        time.into_iter().chain(arguments).chain(charts).collect()
    }
}

/// The list; `None` if it is empty.
fn some<T>(all: &[T]) -> Option<&[T]> {
    (!all.is_empty()).then_some(all)
}

fn next(states: &[LawState]) -> Vec<NodeId> {
    states.iter().map(|state| state.next).collect()
}

fn values(named: &[Named]) -> Vec<NodeId> {
    named.iter().map(|named| named.value).collect()
}

fn named(prefix: &str, named: &[Named]) -> Vec<String> {
    let names = named.iter().map(|named| snake(&named.name));
    names.map(|name| format!("{prefix}{name}")).collect()
}

fn labels(prefix: &str, words: &[String], suffix: &str) -> Vec<String> {
    let words = words.iter();
    words
        .map(|word| format!("{prefix}{word}{suffix}"))
        .collect()
}
