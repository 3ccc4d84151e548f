//! Which methods a module has, and what each of them starts from.

use super::prepare::{Factored, Given, Method, factored, finished};
use super::{Options, breakpoints, hoist};
use crate::equations::{Equations, LawState, Named, Route};
use crate::expression::live::{Dependence, Live};
use crate::expression::passes::{Rewritten, fuse, join};
use crate::expression::{Graph, Node, NodeId};
use crate::method::inputs::{Argument, Inputs};
use crate::model::Model;
use crate::names::{Names, snake};
use crate::target::rust::method::Request;
use crate::target::rust::results::{Each, Results};

/// v̇
pub(crate) const ACCELERATIONS: &str = "accelerations";
/// q̇ and v̇ at once.
pub(crate) const MOTION: &str = "motion";
/// The method that puts them into a sink.
pub(crate) const EACH_MOTION: &str = "each_motion";

const STATE: &[Argument] = &[Argument::Coordinates, Argument::Velocities];

/// Arguments, and m where orientation depends on it.
fn charted(equations: &Equations, arguments: &[Argument]) -> Vec<Argument> {
    let charts = (equations.charts > 0).then_some(Argument::Memory);
    arguments.iter().copied().chain(charts).collect()
}

/// These arguments, after t where results depend on it: S and r_s do where a root with a joint of its own is on a vehicle that turns.
fn timed(equations: &Equations, roots: &[NodeId], arguments: Vec<Argument>) -> Vec<Argument> {
    let live = Live::new(&equations.graph, roots);
    let depends = |id: &NodeId| Dependence::TIME.within(live.dependence(*id));
    let time = roots.iter().any(depends).then_some(Argument::Time);
    time.into_iter().chain(arguments).collect()
}

/// t, q, v, and z and m where the model has such.
fn time_and_state(equations: &Equations) -> Vec<Argument> {
    let mut arguments = vec![Argument::Time, Argument::Coordinates, Argument::Velocities];
    if !equations.auxiliaries.is_empty() {
        arguments.push(Argument::Auxiliaries);
    }
    if !equations.memory.is_empty() {
        arguments.push(Argument::Memory);
    }
    arguments
}

fn values(named: &[Named]) -> Vec<NodeId> {
    named.iter().map(|named| named.value).collect()
}

/// The gaps of all onsets, then their speeds.
fn onsets(equations: &Equations) -> Vec<NodeId> {
    let gaps = equations.onsets.iter().map(|onset| onset.gap);
    let speeds = equations.onsets.iter().map(|onset| onset.speed);
    gaps.chain(speeds).collect()
}

fn names(named: &[Named], prefix: &str) -> Vec<String> {
    named
        .iter()
        .map(|named| format!("{prefix}{}", snake(&named.name)))
        .collect()
}

/// The arguments of the curves of the state.
fn arguments(equations: &Equations) -> Vec<NodeId> {
    equations
        .curves
        .iter()
        .map(|curve| curve.argument)
        .collect()
}

/// The values that depend on parameters alone and are needed by others, fields of the mechanism; and the methods as the passes made them while
/// these values were looked for.
pub(crate) struct Derived {
    /// The values, by nodes of the equations; named in [`Inputs`].
    pub values: Vec<NodeId>,
    factored: Vec<Factored>,
    /// How many of the values were known to the factored methods.
    known: usize,
}

/// Finds the values that depend on parameters alone, and names them in `inputs`. `only` are the methods that are wanted; all where there is
/// nothing said.
pub(crate) fn derived(
    model: &Model,
    equations: &Equations,
    options: &Options,
    only: Option<&[&str]>,
    inputs: &mut Inputs,
) -> Derived {
    let graph = &equations.graph;
    let changing = match only {
        None => all_changing(equations, options),
        Some(_) => {
            let methods = methods(model, equations, options, inputs, only);
            let given = methods.iter().filter(|method| !method.arguments.is_empty());
            given.flat_map(|method| &method.roots).copied().collect()
        }
    };
    let mut values = Live::new(graph, &changing).hoistable(graph);
    keep(graph, &values, inputs);
    let methods = methods(model, equations, options, inputs, only);
    let factored = factored(equations, &methods, &values, inputs);
    let known = values.len();
    // What the passes make of parameters alone is known only when they are done.
    if !values.is_empty() || !inputs.parameters.is_empty() {
        let mut more = Vec::new();
        for (method, factored) in methods.iter().zip(&factored) {
            if method.arguments.is_empty() {
                continue;
            }
            let (chosen, _) = factored.chosen(inputs);
            let found = hoist::found(graph, &chosen.graph, &chosen.roots, &values, inputs);
            for (_, value) in found {
                if !values.contains(&value) && !more.contains(&value) {
                    more.push(value);
                }
            }
        }
        drop(methods);
        keep(graph, &more, inputs);
        values.extend(more);
    }
    Derived {
        values,
        factored,
        known,
    }
}

/// The results of all methods that are called with a state.
fn all_changing(equations: &Equations, options: &Options) -> Vec<NodeId> {
    let mut changing = [
        &equations.accelerations[..],
        &equations.coordinate_rates,
        &equations.outputs,
        &[equations.kinetic_energy],
        &values(&equations.powers),
        &values(&equations.guards),
        &values(&equations.kinks),
        &onsets(equations),
        &arguments(equations),
        &values(&equations.pivots),
        &equations.momentum,
        &equations.external_wrench,
    ]
    .concat();
    let laws = equations.auxiliaries.iter().chain(&equations.memory);
    changing.extend(laws.map(|state| state.next));
    if equations.charts > 0 {
        changing.extend(&equations.renewed_coordinates);
        changing.extend(&equations.renewed_velocities);
    }
    if options.matrices {
        changing.extend(upper_triangle(&equations.mass_matrix));
        changing.extend(
            equations
                .velocity_forces
                .iter()
                .chain(&equations.applied_forces),
        );
    }
    changing
}

/// Makes values fields of the mechanism.
fn keep(graph: &Graph, values: &[NodeId], inputs: &mut Inputs) {
    let mut names = Names::with(&["parameters"]);
    for name in &inputs.derived {
        names.take(name);
    }
    let nameless = |name: &&String| {
        let digits = name.strip_prefix('k');
        digits.is_some_and(|d| !d.is_empty() && d.bytes().all(|b| b.is_ascii_digit()))
    };
    let mut nameless = inputs.derived.iter().filter(nameless).count();
    for &id in values {
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
}

/// The methods of a model, as they are to be emitted.
pub(crate) fn requests<'a>(
    model: &Model,
    equations: &Equations,
    options: &Options,
    derived: Derived,
    inputs: &'a Inputs,
    only: Option<&[&str]>,
) -> Vec<Request<'a>> {
    let methods = methods(model, equations, options, inputs, only);
    let Derived {
        values,
        factored,
        known,
    } = derived;
    let finished = finished(equations, &methods, factored, &values, known, inputs);
    let Rewritten {
        graph: constants,
        roots,
    } = fuse(&equations.graph, &values);
    let new = Request {
        name: "new",
        documentation: vec!["The mechanism with these parameters; what depends on them alone is computed here, once.".into()],
        arguments: Vec::new(),
        from_accelerations: false,
        graph: constants,
        roots,
        labels: inputs.derived.clone(),
        results: Results::Mechanism(&inputs.derived),
    };
    let others = methods.into_iter().zip(finished);
    let others = others.map(|(method, (finished, from_accelerations))| {
        let Method {
            name,
            documentation,
            mut arguments,
            labels,
            results,
            ..
        } = method;
        if from_accelerations {
            arguments.push(Argument::Accelerations);
        }
        Request {
            name,
            documentation,
            arguments,
            from_accelerations,
            graph: finished.graph,
            roots: finished.roots,
            labels,
            results,
        }
    });
    std::iter::once(new).chain(others).collect()
}

/// The methods of a model but the one that makes the mechanism, before any pass.
fn methods<'a>(
    model: &Model,
    equations: &Equations,
    options: &Options,
    inputs: &'a Inputs,
    only: Option<&[&str]>,
) -> Vec<Method<'a>> {
    let request = |name,
                   documentation: &[&str],
                   arguments: &[Argument],
                   roots: &[NodeId],
                   labels: Vec<String>,
                   results| Method {
        name,
        documentation: documentation.iter().map(|line| line.to_string()).collect(),
        arguments: arguments.to_vec(),
        roots: roots.to_vec(),
        labels,
        results,
        given: Given::Derived,
    };
    let from_accelerations = |method: Method<'a>| Method {
        given: Given::Accelerations,
        ..method
    };
    let labels = |prefix: &str, words: &[String], suffix: &str| -> Vec<String> {
        words
            .iter()
            .map(|word| format!("{prefix}{word}{suffix}"))
            .collect()
    };
    let (q, v) = (&inputs.coordinates, &inputs.velocities);
    let time_and_state = &time_and_state(equations)[..];

    let mut requests = Vec::new();
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
    for (name, documentation, states, words, length) in [
        (
            "initial_auxiliaries",
            "z, the states of force laws, where a run starts.",
            &equations.auxiliaries,
            &inputs.auxiliaries,
            "AUXILIARIES",
        ),
        (
            "initial_memory",
            match equations.charts {
                0 => "m, what force laws remember, where a run starts.",
                _ => "m, the charts of elements and what force laws remember, where a run starts.",
            },
            &equations.memory,
            &inputs.memory,
            "MEMORY",
        ),
    ] {
        if !states.is_empty() {
            let initial: Vec<NodeId> = states.iter().map(|state| state.initial).collect();
            let labels = words.clone();
            let results = Results::Array(length);
            requests.push(request(
                name,
                &[documentation],
                &[],
                &initial,
                labels,
                results,
            ));
        }
    }
    if options.matrices {
        let matrix = upper_triangle(&equations.mass_matrix);
        let pairs = (0..v.len()).flat_map(|row| (row..v.len()).map(move |column| (row, column)));
        let of = timed(
            equations,
            &matrix,
            charted(equations, &[Argument::Coordinates]),
        );
        let documentation = match of.contains(&Argument::Time) {
            true => {
                "S(t, q), symmetric: S v̇ = r_s + r_k \\[MADYMO 1980, eq. 2\\]. Rows and columns in the order of v."
            }
            false => {
                "S(q), symmetric: S v̇ = r_s + r_k \\[MADYMO 1980, eq. 2\\]. Rows and columns in the order of v."
            }
        };
        requests.push(request(
            "mass_matrix",
            &[documentation],
            &of,
            &matrix,
            pairs
                .map(|(row, column)| format!("s_{}_{}", v[row], v[column]))
                .collect(),
            Results::Matrix(v.len()),
        ));
        let of = timed(
            equations,
            &equations.velocity_forces,
            charted(equations, STATE),
        );
        let documentation = match of.contains(&Argument::Time) {
            true => {
                "r_s(t, q, v), the forces of inertia when v̇ = 0, but for those of given accelerations."
            }
            false => "r_s(q, v), the forces of inertia that are quadratic in the velocities.",
        };
        requests.push(request(
            "velocity_forces",
            &[documentation],
            &of,
            &equations.velocity_forces,
            labels("r_s_", v, ""),
            Results::Vector,
        ));
        requests.push(request(
            "applied_forces",
            &["r_k(t, q, v), the generalised forces of everything that acts on the elements."],
            time_and_state,
            &equations.applied_forces,
            labels("r_k_", v, ""),
            Results::Vector,
        ));
    }
    let route = match equations.route {
        Route::Elimination => {
            "v̇(t, q, v) by elimination from the leaves to the root; S is never assembled."
        }
        Route::MassMatrix => "v̇(t, q, v) from S v̇ = r_s + r_k by S = LᵀDL in its fixed pattern.",
    };
    requests.push(request(
        ACCELERATIONS,
        &[route],
        time_and_state,
        &equations.accelerations,
        labels("", v, "_dot"),
        each("each_acceleration", "VELOCITIES"),
    ));
    requests.push(request(
        "coordinate_rates",
        &["q̇(q, v)."],
        STATE,
        &equations.coordinate_rates,
        labels("", q, "_dot"),
        each("each_coordinate_rate", "COORDINATES"),
    ));
    let rates = breakpoints::rates(equations);
    if !rates.is_empty() {
        requests.push(request(
            "kink_rates",
            &["By what time is multiplied in the curves of time that parameters stretch."],
            &[],
            &rates,
            (0..rates.len()).map(|i| format!("rate_{i}")).collect(),
            Results::List(rates.len()),
        ));
    }
    let next = |states: &[LawState]| -> Vec<NodeId> { states.iter().map(|s| s.next).collect() };
    if !equations.auxiliaries.is_empty() {
        requests.push(request(
            "auxiliary_rates",
            &["ż(t, q, v, z)."],
            time_and_state,
            &next(&equations.auxiliaries),
            labels("", &inputs.auxiliaries, "_dot"),
            each("each_auxiliary_rate", "AUXILIARIES"),
        ));
    }
    if !equations.memory.is_empty() {
        let mut arguments = time_and_state.to_vec();
        let mut given = Given::Derived;
        if renews_by_guards(equations) {
            arguments.push(Argument::Guards);
            given = Given::Guards;
        }
        let memory = next(&equations.memory);
        let (name, documentation, roots, words, results) = match equations.charts {
            0 => (
                "renewed_memory",
                "m after a step that was accepted with this state.",
                memory,
                inputs.memory.clone(),
                Results::Array("MEMORY"),
            ),
            _ => (
                "renewed",
                "q, v and m after a step that was accepted with this state: angles near ±90 deg in the other chart.",
                [
                    &equations.renewed_coordinates[..],
                    &equations.renewed_velocities,
                    &memory,
                ]
                .concat(),
                [&q[..], v, &inputs.memory].concat(),
                Results::Renewed(q.len(), v.len()),
            ),
        };
        requests.push(Method {
            name,
            documentation: vec![documentation.into()],
            arguments,
            roots,
            labels: labels("", &words, "_renewed"),
            results,
            given,
        });
    }
    if !equations.guards.is_empty() {
        requests.push(from_accelerations(request(
            "guards",
            &["Functions whose change of sign ends a step, in the order of `INFO.guards`."],
            time_and_state,
            &values(&equations.guards),
            names(&equations.guards, "guard_"),
            Results::Array("GUARDS"),
        )));
    }
    if !equations.kinks.is_empty() {
        requests.push(request(
            "kinks",
            &["Functions whose change of sign is where a force law is not smooth, in the order of `INFO.kinks`."],
            time_and_state,
            &values(&equations.kinks),
            names(&equations.kinks, "kink_"),
            Results::Array("KINKS"),
        ));
    }
    if !equations.onsets.is_empty() {
        let labels = ["gap_", "speed_"].map(|prefix| {
            let names = equations.onsets.iter();
            names
                .map(|onset| format!("{prefix}{}", snake(&onset.name)))
                .collect::<Vec<_>>()
        });
        requests.push(request(
            "onsets",
            &["When laws that do not act begin to, and how far the corners of curves are: the gap of each, then the speed of each, in the order of `INFO.onsets`."],
            time_and_state,
            &onsets(equations),
            labels.concat(),
            Results::List(2 * equations.onsets.len()),
        ));
    }
    if !equations.curves.is_empty() {
        let names = equations.curves.iter();
        requests.push(request(
            "curves",
            &["What the curves of the state are evaluated at, the bearings of bent joints and the directions of contacts, in the order of `INFO.curves`."],
            time_and_state,
            &arguments(equations),
            names
                .map(|curve| format!("argument_{}", snake(&curve.name)))
                .collect(),
            Results::Array("CURVES"),
        ));
    }
    if !equations.pivots.is_empty() {
        requests.push(request(
            "pivots",
            &["Pivots of the elimination that may vanish, as shares of what stands in their place before."],
            time_and_state,
            &values(&equations.pivots),
            names(&equations.pivots, "pivot_"),
            Results::List(equations.pivots.len()),
        ));
    }
    if !equations.conditions.is_empty() {
        let conditions = equations.conditions.iter();
        let values: Vec<NodeId> = conditions.map(|condition| condition.value).collect();
        let numbers = 1..=values.len();
        requests.push(request(
            "conditions",
            &["What parameters must keep, in the order of `INFO.conditions`."],
            &[],
            &values,
            numbers
                .map(|number| format!("condition_{number}"))
                .collect(),
            Results::List(values.len()),
        ));
    }
    requests.push(request(
        "kinetic_energy",
        &["T of all elements \\[J\\]."],
        time_and_state,
        &[equations.kinetic_energy],
        vec!["kinetic_energy".to_string()],
        Results::Scalar,
    ));
    if !equations.powers.is_empty() {
        requests.push(from_accelerations(request(
            "powers",
            &["Power of each effect \\[W\\], in the order of `INFO.powers`: together the rate of the kinetic energy."],
            time_and_state,
            &values(&equations.powers),
            names(&equations.powers, "power_"),
            Results::Array("POWERS"),
)));
    }
    if !equations.momentum.is_empty() {
        let axes = ["x", "y", "z", "about_x", "about_y", "about_z"].map(String::from);
        requests.push(request(
            "momentum",
            &["Linear \\[N s\\] and angular momentum about the origin \\[N m s\\] of what is free, absolute axes."],
            time_and_state,
            &equations.momentum,
            labels("momentum_", &axes, ""),
            Results::List(6),
        ));
        requests.push(request(
            "external_wrench",
            &["Force \\[N\\] and moment about the origin \\[N m\\] on what is free: the rate of its momentum."],
            time_and_state,
            &equations.external_wrench,
            labels("external_wrench_", &axes, ""),
            Results::List(6),
        ));
    }
    requests.push(from_accelerations(request(
        "outputs",
        &["What the scene asks to see, in the order and units of `INFO.outputs`."],
        time_and_state,
        &equations.outputs,
        model.outputs.iter().map(|o| o.name.clone()).collect(),
        Results::Array("OUTPUTS"),
    )));
    if let Some(only) = only {
        requests.retain(|method| only.contains(&method.name));
    }
    requests
}

/// A method that puts results into a sink, beside one that puts them into an array of a length.
fn each(method: &'static str, length: &'static str) -> Results<'static> {
    Results::Each(Each {
        method,
        length: Some(length),
    })
}

/// q̇ and v̇ by one method, made of those for each: the coordinates and velocities of an element are then read once for both.
pub(crate) fn motion<'a>(requests: &[Request<'a>]) -> Option<Request<'a>> {
    let named = |name: &str| requests.iter().find(|request| request.name == name);
    let (rates, accelerations) = (named("coordinate_rates")?, named(ACCELERATIONS)?);
    let Rewritten { graph, roots } = join(&[
        (&rates.graph, &rates.roots),
        (&accelerations.graph, &accelerations.roots),
    ]);
    Some(Request {
        name: MOTION,
        documentation: vec![
            "q̇ and, in places behind it, v̇, one by one, each as soon as it is found.".into(),
        ],
        arguments: accelerations.arguments.clone(),
        from_accelerations: false,
        graph,
        roots,
        labels: [&rates.labels[..], &accelerations.labels].concat(),
        results: Results::Each(Each {
            method: EACH_MOTION,
            length: None,
        }),
    })
}

/// Whether memory is renewed by the sign of a guard. It is then given the guards, to see the very values that ended the
/// step: computed a second time, a value close to 0 may have the other sign.
pub(crate) fn renews_by_guards(equations: &Equations) -> bool {
    let next: Vec<NodeId> = equations.memory.iter().map(|state| state.next).collect();
    let live = Live::new(&equations.graph, &next);
    let guards = equations.guards.iter().map(|guard| guard.value);
    let computed = |id: &NodeId| !matches!(equations.graph.node(*id), Node::Symbol(_));
    guards
        .filter(computed)
        .any(|guard| live.nodes().contains(&guard))
}

fn upper_triangle(matrix: &[Vec<NodeId>]) -> Vec<NodeId> {
    matrix
        .iter()
        .enumerate()
        .flat_map(|(row, entries)| entries.iter().skip(row).copied())
        .collect()
}
