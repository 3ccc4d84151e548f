//! Which methods a module has, and what each of them starts from.

use super::Options;
use super::function::Request;
use super::inputs::{Argument, Input, Inputs};
use super::names::{Names, snake};
use super::results::Results;
use crate::equations::{Equations, Route};
use crate::expression::count::Count;
use crate::expression::live::Live;
use crate::expression::passes::{Rewritten, factor, fuse, replace};
use crate::expression::{Graph, Node, NodeId, Symbol};
use crate::model::Model;
use rustc_hash::FxHashMap;

/// Operations above which `outputs` calls `accelerations` instead of computing them a second time in its own text.
const REPEATED_OPERATIONS: usize = 50;

const STATE: &[Argument] = &[Argument::Coordinates, Argument::Velocities];
const TIME_AND_STATE: &[Argument] = &[Argument::Time, Argument::Coordinates, Argument::Velocities];
const ALL: &[Argument] = &[
    Argument::Time,
    Argument::Coordinates,
    Argument::Velocities,
    Argument::Accelerations,
];

/// The values that depend on parameters alone and are needed by others: fields of the mechanism, named in `inputs`.
pub(super) fn derived(
    equations: &Equations,
    options: &Options,
    inputs: &mut Inputs,
) -> Vec<NodeId> {
    let graph = &equations.graph;
    let mut changing = [
        &equations.accelerations[..],
        &equations.coordinate_rates,
        &equations.outputs,
    ]
    .concat();
    if options.matrices {
        changing.extend(upper_triangle(&equations.system_matrix));
        changing.extend(
            equations
                .velocity_forces
                .iter()
                .chain(&equations.applied_forces),
        );
    }
    let derived = Live::new(graph, &changing).hoistable(graph);
    let mut names = Names::with(&["parameters"]);
    let mut nameless = 0;
    for &id in &derived {
        let name = graph
            .name_of(id)
            .map(|name| snake(&name))
            .unwrap_or_else(|| {
                nameless += 1;
                format!("k{nameless}")
            });
        inputs.derived.push(names.take(&name));
        inputs
            .derived_in
            .push(graph.sections()[graph.section_of(id)].clone());
    }
    derived
}

/// The methods of a model.
pub(super) fn requests<'a>(
    model: &Model,
    equations: &Equations,
    options: &Options,
    derived: &[NodeId],
    inputs: &'a Inputs,
) -> Vec<Request<'a>> {
    let graph = &equations.graph;
    let mut known: FxHashMap<NodeId, (Symbol, bool)> = FxHashMap::default();
    for (i, &id) in derived.iter().enumerate() {
        known.insert(id, (inputs.symbol(Input::Derived(i)), false));
    }
    let prepare = |roots: &[NodeId], known: &FxHashMap<NodeId, (Symbol, bool)>| {
        let Rewritten { graph, roots } = replace(graph, roots, known);
        let Rewritten { graph, roots } = factor(&graph, &roots);
        fuse(&graph, &roots)
    };
    let request = |name,
                   documentation: &[&str],
                   arguments,
                   roots: &[NodeId],
                   labels: Vec<String>,
                   results| {
        let Rewritten { graph, roots } = prepare(roots, &known);
        let documentation = documentation.iter().map(|line| line.to_string()).collect();
        Request {
            name,
            documentation,
            arguments,
            from_accelerations: false,
            graph,
            roots,
            labels,
            results,
        }
    };
    let labels = |prefix: &str, words: &[String], suffix: &str| -> Vec<String> {
        words
            .iter()
            .map(|word| format!("{prefix}{word}{suffix}"))
            .collect()
    };
    let (q, v) = (&inputs.coordinates, &inputs.velocities);

    let mut requests = Vec::new();
    let Rewritten {
        graph: constants,
        roots,
    } = fuse(graph, derived);
    requests.push(Request {
        name: "new",
        documentation: vec!["The mechanism with these parameters; what depends on them alone is computed here, once.".into()],
        arguments: &[],
        from_accelerations: false,
        graph: constants,
        roots,
        labels: inputs.derived.clone(),
        results: Results::Mechanism(&inputs.derived),
    });
    requests.push(request(
        "initial_conditions",
        &["q and v where a run starts."],
        &[],
        &[
            &equations.initial_coordinates[..],
            &equations.initial_velocities,
        ]
        .concat(),
        [&q[..], v].concat(),
        Results::Start(q.len()),
    ));
    if options.matrices {
        let matrix = upper_triangle(&equations.system_matrix);
        let pairs = (0..v.len()).flat_map(|row| (row..v.len()).map(move |column| (row, column)));
        requests.push(request(
            "system_matrix",
            &["S(q), symmetric: S v̇ = r_s + r_k \\[MADYMO 1980, eq. 2\\]. Rows and columns in the order of v."],
            &[Argument::Coordinates],
            &matrix,
            pairs.map(|(row, column)| format!("s_{}_{}", v[row], v[column])).collect(),
            Results::Matrix(v.len()),
        ));
        requests.push(request(
            "velocity_forces",
            &["r_s(q, v), the forces of inertia that are quadratic in the velocities."],
            STATE,
            &equations.velocity_forces,
            labels("r_s_", v, ""),
            Results::Vector,
        ));
        requests.push(request(
            "applied_forces",
            &["r_k(t, q, v), the generalised forces of everything that acts on the elements."],
            TIME_AND_STATE,
            &equations.applied_forces,
            labels("r_k_", v, ""),
            Results::Vector,
        ));
    }
    let route = match equations.route {
        Route::Elimination => {
            "v̇(t, q, v) by elimination from the leaves to the root; S is never assembled."
        }
        Route::SystemMatrix => "v̇(t, q, v) from S v̇ = r_s + r_k by S = LᵀDL in its fixed pattern.",
    };
    requests.push(request(
        "accelerations",
        &[route],
        TIME_AND_STATE,
        &equations.accelerations,
        labels("", v, "_dot"),
        Results::Array("VELOCITIES"),
    ));
    requests.push(request(
        "coordinate_rates",
        &["q̇(q, v)."],
        STATE,
        &equations.coordinate_rates,
        labels("", q, "_dot"),
        Results::Array("COORDINATES"),
    ));
    requests.push(outputs(model, equations, inputs, &known, prepare));
    requests
}

/// The method for what the scene asks to see. Where that would repeat most of `accelerations`, it calls them.
fn outputs<'a>(
    model: &Model,
    equations: &Equations,
    inputs: &Inputs,
    known: &FxHashMap<NodeId, (Symbol, bool)>,
    prepare: impl Fn(&[NodeId], &FxHashMap<NodeId, (Symbol, bool)>) -> Rewritten,
) -> Request<'a> {
    let mut with_accelerations = known.clone();
    for (i, &id) in equations.accelerations.iter().enumerate() {
        let symbol = inputs.symbol(Input::Acceleration(i));
        // Whoever needs −x may be using x, the operand.
        let (id, negative) = match equations.graph.node(id) {
            Node::Neg(x) => (x, true),
            _ => (id, false),
        };
        if !matches!(
            equations.graph.node(id),
            Node::Constant(_) | Node::Symbol(_)
        ) {
            with_accelerations.entry(id).or_insert((symbol, negative));
        }
    }
    let total = |r: &Rewritten| Count::of(&r.graph, &r.roots).total();
    let alone = prepare(&equations.outputs, known);
    let short = prepare(&equations.outputs, &with_accelerations);
    let from_accelerations = uses_accelerations(&short.graph, inputs)
        && total(&alone) > total(&short) + REPEATED_OPERATIONS;
    let Rewritten { graph, roots } = if from_accelerations { short } else { alone };
    Request {
        name: "outputs",
        documentation: vec![
            "What the scene asks to see, in the order and units of `INFO.outputs`.".to_string(),
        ],
        arguments: if from_accelerations {
            ALL
        } else {
            TIME_AND_STATE
        },
        from_accelerations,
        graph,
        roots,
        labels: model
            .outputs
            .iter()
            .map(|output| output.name.clone())
            .collect(),
        results: Results::Array("OUTPUTS"),
    }
}

fn uses_accelerations(graph: &Graph, inputs: &Inputs) -> bool {
    graph.nodes().iter().any(|node| match node {
        Node::Symbol(symbol) => matches!(inputs.input(*symbol), Input::Acceleration(_)),
        _ => false,
    })
}

fn upper_triangle(matrix: &[Vec<NodeId>]) -> Vec<NodeId> {
    matrix
        .iter()
        .enumerate()
        .flat_map(|(row, entries)| entries.iter().skip(row).copied())
        .collect()
}
