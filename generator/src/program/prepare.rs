//! The passes over the methods of a model: known values are replaced by inputs, common factors are taken out,
//! operations are fused.
//!
//! The passes take most of the time of generation, and methods are independent of each other, so they are processed in
//! parallel on all processors. The output does not depend on the number of processors.
//!
//! Methods share the arguments of expensive calls, i.e. the searches between two ellipsoids: each method computes these
//! arguments as `accelerations` does. So all methods search with the same bits, and a list that joins several methods
//! searches once. Arguments of cheaper calls are left to each method: sharing them, too, would cost event functions and
//! kinks of the scenes in benches/scenes 4 to 18 % more operations.

use super::hoist;
use crate::equations::Equations;
use crate::expression::count::Count;
use crate::expression::liveness::Live;
use crate::expression::passes::{Rewritten, factor, fuse, needed, replace, restore};
use crate::expression::{Function, Graph, Node, NodeId, Symbol};
use crate::method::Start;
use crate::method::inputs::{Input, Inputs};
use crate::method::table::Specification;
use rustc_hash::FxHashMap;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of operations that a method must save to receive the accelerations instead of computing them itself.
const REPEATED_OPERATIONS: usize = 50;

/// A method after the factoring pass, in one or two forms.
pub(crate) struct Factored {
    /// The form that computes the accelerations itself.
    alone: Rewritten,
    /// The form that starts from accelerations, if the method allows it.
    short: Option<Rewritten>,
}

impl Factored {
    /// The cheaper form; true if that starts from accelerations.
    pub(crate) fn chosen(&self, inputs: &Inputs) -> (&Rewritten, bool) {
        match &self.short {
            Some(short) if starts_from_accelerations(&self.alone, short, inputs) => (short, true),
            _ => (&self.alone, false),
        }
    }
}

fn starts_from_accelerations(alone: &Rewritten, short: &Rewritten, inputs: &Inputs) -> bool {
    let total = |r: &Rewritten| Count::of(&r.graph, &r.roots).total();
    uses_accelerations(&short.graph, inputs) && total(alone) > total(short) + REPEATED_OPERATIONS
}

/// The inputs that replace known values: by node the input, and true if the value is minus the input.
type Known = FxHashMap<NodeId, (Symbol, bool)>;

/// The values that depend on parameters alone, as inputs stored in the mechanism.
fn known(derived: &[NodeId], inputs: &Inputs) -> Known {
    let fields = derived.iter().enumerate();
    fields
        .map(|(i, &id)| (id, (inputs.symbol(Input::Derived(i)), false)))
        .collect()
}

/// The same, with the values from which a method starts.
fn with_start(known: &Known, start: Start, equations: &Equations, inputs: &Inputs) -> Known {
    let mut known = known.clone();
    let graph = &equations.graph;
    match start {
        Start::State => {}
        Start::EventFunctions => {
            for (i, event_function) in equations.event_functions.iter().enumerate() {
                let symbol = inputs.symbol(Input::EventFunction(i));
                know(&mut known, graph, event_function.value, symbol);
            }
        }
        Start::Accelerations => {
            for (i, &id) in equations.accelerations.iter().enumerate() {
                let symbol = inputs.symbol(Input::Acceleration(i));
                know(&mut known, graph, id, symbol);
            }
        }
    }
    known
}

/// The arguments of the [expensive](is_expensive) calls that accelerations need.
struct Arguments {
    /// Index of `accelerations` among the methods. `None` if it is not wanted; then no arguments are shared.
    by: Option<usize>,
    /// The arguments, as nodes of the equations. Inputs, constants and values of parameters alone are left out: every
    /// method has the same.
    nodes: Vec<NodeId>,
}

impl Arguments {
    fn of(graph: &Graph, methods: &[Specification], known: &Known) -> Self {
        let by = methods.iter().position(|of| of.name == ACCELERATIONS);
        let roots = by.map_or(&[][..], |by| &methods[by].roots);
        let needed = needed(graph, roots, known);
        let mut is_argument = vec![false; graph.len()];
        // lists of arguments come before their calls and after their members
        for &id in needed.iter().rev() {
            let node = graph.node(id);
            let is_list = is_argument[id.0 as usize] && matches!(node, Node::Arguments(_));
            if is_list || is_expensive(&node) && !known.contains_key(&id) {
                for operand in node.operands() {
                    is_argument[operand.0 as usize] = true;
                }
            }
        }
        let is_work = |id: NodeId| {
            let node = graph.node(id);
            !node.is_leaf() && !matches!(node, Node::Arguments(_)) && !known.contains_key(&id)
        };
        let is_shared = |id: &NodeId| is_argument[id.0 as usize] && is_work(*id);
        Arguments {
            by,
            nodes: needed.into_iter().filter(is_shared).collect(),
        }
    }

    /// The input that replaces an argument until the methods are finished: an entry of m that no model has.
    fn stand_in(index: usize) -> Symbol {
        Symbol::Memory(u32::MAX - index as u32)
    }

    fn stand_ins(&self) -> impl Iterator<Item = (NodeId, Symbol)> {
        let nodes = self.nodes.iter().enumerate();
        nodes.map(|(index, &node)| (node, Self::stand_in(index)))
    }

    /// The roots of a method for the passes: for `accelerations`, also the shared arguments.
    fn roots(&self, method: usize, methods: &[Specification]) -> Vec<NodeId> {
        let mut roots = methods[method].roots.clone();
        if self.by == Some(method) {
            roots.extend(&self.nodes);
        }
        roots
    }
}

/// True if a call takes so long that sharing it is worth more than a few operations that a method could save in its
/// arguments.
fn is_expensive(node: &Node) -> bool {
    matches!(
        node,
        Node::Call(Function::Approach(_) | Function::Support(_), _)
    )
}

/// The method that determines how the shared arguments are computed.
const ACCELERATIONS: &str = "accelerations";

/// The methods after the factoring pass. `derived` are the known values.
pub(crate) fn factored(
    equations: &Equations,
    methods: &[Specification],
    derived: &[NodeId],
    inputs: &Inputs,
) -> Vec<Factored> {
    let all: Vec<usize> = (0..methods.len()).collect();
    let arguments = Arguments::of(&equations.graph, methods, &known(derived, inputs));
    factored_of(&all, equations, methods, &arguments, derived, inputs)
}

/// The same for the `wanted` methods only.
fn factored_of(
    wanted: &[usize],
    equations: &Equations,
    methods: &[Specification],
    arguments: &Arguments,
    derived: &[NodeId],
    inputs: &Inputs,
) -> Vec<Factored> {
    let known = known(derived, inputs);
    // a task for each form of each method
    let mut tasks: Vec<(Vec<NodeId>, Known)> = Vec::new();
    for &index in wanted {
        let method = &methods[index];
        let mut known = known.clone();
        if arguments.by != Some(index) {
            known.extend(arguments.stand_ins().map(|(node, by)| (node, (by, false))));
        }
        let plain = match method.start {
            Start::EventFunctions => with_start(&known, Start::EventFunctions, equations, inputs),
            _ => known.clone(),
        };
        let roots = arguments.roots(index, methods);
        if method.start == Start::Accelerations {
            let known = with_start(&known, Start::Accelerations, equations, inputs);
            tasks.push((roots.clone(), plain));
            tasks.push((roots, known));
        } else {
            tasks.push((roots, plain));
        }
    }
    let work = |graph: &Graph, (roots, known): &(Vec<NodeId>, Known)| {
        let Rewritten { graph, roots } = replace(graph, roots, known);
        factor(&graph, &roots)
    };
    let mut done = on_all_processors(&equations.graph, &tasks, &work).into_iter();
    let forms = wanted.iter().filter_map(|&index| {
        Some(Factored {
            alone: done.next()?,
            short: match methods[index].start {
                Start::Accelerations => done.next(),
                _ => None,
            },
        })
    });
    forms.collect()
}

/// The methods after all passes, each with true if it starts from accelerations. The first `before` of the `derived`
/// values were known when the methods were factored; a method that needs one of the others is factored again.
pub(crate) fn finished(
    equations: &Equations,
    methods: &[Specification],
    mut factored_before: Vec<Factored>,
    derived: &[NodeId],
    before: usize,
    inputs: &Inputs,
) -> Vec<(Rewritten, bool)> {
    let graph = &equations.graph;
    let arguments = Arguments::of(graph, methods, &known(&derived[..before], inputs));
    let needs_more = |method: &Specification| {
        if before == derived.len() {
            return false;
        }
        let live = Live::new(graph, &method.roots);
        derived[before..].iter().any(|&value| live.contains(value))
    };
    let again: Vec<usize> = (0..methods.len())
        .filter(|&index| needs_more(&methods[index]))
        .collect();
    let factored = factored_of(&again, equations, methods, &arguments, derived, inputs);
    for (index, factored) in again.into_iter().zip(factored) {
        factored_before[index] = factored;
    }
    let finish = |factored: Rewritten| {
        let Rewritten { graph, roots } = hoist::hoisted(graph, factored, derived, inputs);
        fuse(&graph, &roots)
    };
    let finish = |Factored { alone, short }: Factored| (finish(alone), short.map(finish));
    let mut finished: Vec<(Rewritten, Option<Rewritten>)> =
        factored_before.into_iter().map(finish).collect();
    let by = arguments.by.filter(|_| !arguments.nodes.is_empty());
    let values = by.map(|by| {
        let (Rewritten { graph, roots }, _) = &mut finished[by];
        let values = roots.split_off(methods[by].roots.len());
        let stand_ins = arguments.stand_ins().map(|(_, stand_in)| stand_in);
        (graph.clone(), stand_ins.zip(values).collect())
    });
    let complete = |method: Rewritten| match &values {
        Some((graph, values)) => restore(method, graph, values),
        None => method,
    };
    let chosen = finished.into_iter().map(|(alone, short)| {
        let alone = complete(alone);
        match short.map(complete) {
            Some(short) if starts_from_accelerations(&alone, &short, inputs) => (short, true),
            _ => (alone, false),
        }
    });
    chosen.collect()
}

/// The results of `work` for each task, in the order of the tasks. Each thread has a copy of the graph.
fn on_all_processors<T: Sync, R: Send>(
    graph: &Graph,
    tasks: &[T],
    work: &(impl Fn(&Graph, &T) -> R + Sync),
) -> Vec<R> {
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    if workers == 1 || tasks.len() < 2 || graph.len() < WORTH_A_THREAD {
        return tasks.iter().map(|task| work(graph, task)).collect();
    }
    let next = AtomicUsize::new(0);
    let mut results: Vec<Option<R>> = tasks.iter().map(|_| None).collect();
    std::thread::scope(|scope| {
        let workers = (0..workers.min(tasks.len())).map(|_| {
            let (graph, next) = (graph.clone(), &next);
            scope.spawn(move || {
                let mut done = Vec::new();
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(task) = tasks.get(index) else {
                        return done;
                    };
                    done.push((index, work(&graph, task)));
                }
            })
        });
        for worker in workers.collect::<Vec<_>>() {
            let done = match worker.join() {
                Ok(done) => done,
                Err(panic) => std::panic::resume_unwind(panic),
            };
            for (index, result) in done {
                results[index] = Some(result);
            }
        }
    });
    results.into_iter().flatten().collect()
}

/// Smallest graph for which threads are started; a smaller one is done before a thread starts \[nodes\].
const WORTH_A_THREAD: usize = 500;

/// Replaces a value by a symbol from now on, unless the value is a leaf.
fn know(known: &mut FxHashMap<NodeId, (Symbol, bool)>, graph: &Graph, id: NodeId, symbol: Symbol) {
    // A user of −x may be using its operand x.
    let (id, negative) = match graph.node(id) {
        Node::Neg(x) => (x, true),
        _ => (id, false),
    };
    if !graph.node(id).is_leaf() {
        known.entry(id).or_insert((symbol, negative));
    }
}

fn uses_accelerations(graph: &Graph, inputs: &Inputs) -> bool {
    graph.nodes().iter().any(|node| match node {
        Node::Symbol(symbol) => matches!(inputs.input(*symbol), Input::Acceleration(_)),
        _ => false,
    })
}
