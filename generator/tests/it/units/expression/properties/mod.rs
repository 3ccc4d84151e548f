//! Properties of the symbolic core on random expressions.
//!
//! Every value carries a bound of its own rounding error (running error analysis, [`Bounded`]). Two ways to compute the
//! same value may differ by twice the sum of their bounds: once for the roundings of each way, and once for numbers
//! that were folded beforehand, whose roundings only the bound of the other way contains.

mod parse;
mod program;
mod scalars;

use bryant_generator::expression::count::Count;
use bryant_generator::expression::differentiate::differentiate;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::expression::passes::factor::cost;
use bryant_generator::expression::passes::{Rewritten, factor, fuse, rebuild};
use bryant_generator::expression::print::{Names, symbol_name, text};
use bryant_generator::expression::{Expr, Graph, NodeId, Symbol};
use program::{Program, programs};
use proptest::prelude::*;
use scalars::{Bounded, Curves, Dual};

/// Values of the inputs of a program: t, q₁ … q₃, v₁, p₁.
type State = [f64; 6];

fn states() -> impl Strategy<Value = State> {
    prop::array::uniform6(-2.0..2.0f64)
}

const SYMBOLS: [Symbol; 6] = [
    Symbol::Time,
    Symbol::Coordinate(0),
    Symbol::Coordinate(1),
    Symbol::Coordinate(2),
    Symbol::Velocity(0),
    Symbol::Parameter(0),
];

fn build(graph: &Graph, program: &Program) -> Vec<NodeId> {
    let results = program.run(SYMBOLS.map(|s| graph.symbol(s)));
    results.iter().map(|r| r.id()).collect()
}

fn values(graph: &Graph, roots: &[NodeId], state: &State) -> Vec<Bounded> {
    let [t, q @ .., v, p] = state.map(Bounded::exact);
    let inputs = Inputs {
        time: t,
        coordinates: &q,
        velocities: &[v],
        parameters: &[p],
        auxiliaries: &[],
        memory: &[],
        accelerations: &[],
    };
    evaluate(graph, roots, &inputs, &Curves)
}

fn check_close(a: &[Bounded], b: &[Bounded]) -> Result<(), TestCaseError> {
    prop_assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        prop_assume!(a.is_trusted() && b.is_trusted());
        let allowed = 2.0 * (a.error + b.error);
        prop_assert!(
            (a.value - b.value).abs() <= allowed,
            "{} and {} differ by more than {allowed:e}",
            a.value,
            b.value
        );
    }
    Ok(())
}

fn counted(rewritten: &Rewritten) -> Count {
    Count::of(&rewritten.graph, &rewritten.roots)
}

proptest! {
    #[test]
    fn folding_changes_no_value(program in programs(), state in states()) {
        let graph = Graph::new();
        let roots = build(&graph, &program);
        let direct = program.run(state.map(Bounded::exact));
        check_close(&values(&graph, &roots, &state), &direct)?;
    }

    #[test]
    fn passes_change_no_value(program in programs(), state in states()) {
        let graph = Graph::new();
        let roots = build(&graph, &program);
        let before = values(&graph, &roots, &state);
        let factored = factor(&graph, &roots);
        for new in [
            rebuild(&graph, &roots),
            fuse(&graph, &roots),
            fuse(&factored.graph, &factored.roots),
            factored,
        ] {
            check_close(&values(&new.graph, &new.roots, &state), &before)?;
        }
    }

    #[test]
    fn passes_never_cost_operations(program in programs()) {
        let graph = Graph::new();
        let roots = build(&graph, &program);
        let before = Count::of(&graph, &roots);
        prop_assert!(counted(&rebuild(&graph, &roots)).total() <= before.total());
        // Fusing joins two operations, both of which are counted.
        prop_assert_eq!(counted(&fuse(&graph, &roots)).total(), before.total());
        let after = counted(&factor(&graph, &roots));
        prop_assert!(cost(&after) <= cost(&before));
        // Only a reciprocal may add an operation, and it replaces at least two quotients.
        let reciprocals = before.div.saturating_sub(after.div);
        prop_assert!(after.total() <= before.total() + reciprocals);
        prop_assert!(after.div <= before.div);
        prop_assert!(after.trigonometric() <= before.trigonometric());
    }

    #[test]
    fn symbolic_derivatives_equal_dual_numbers(program in programs(), state in states()) {
        let graph = Graph::new();
        let roots = build(&graph, &program);
        for (at, symbol) in SYMBOLS.into_iter().enumerate() {
            // A function that branches has no symbolic derivative.
            let Ok(derivatives) = differentiate(&graph, &roots, symbol) else {
                continue;
            };
            let symbolic = values(&graph, &derivatives, &state);
            let mut duals = state.map(Dual::constant);
            duals[at] = Dual::variable(state[at]);
            let [t, q @ .., v, p] = duals;
            let inputs = Inputs {
                time: t,
                coordinates: &q,
                velocities: &[v],
                parameters: &[p],
                auxiliaries: &[],
                memory: &[],
                accelerations: &[],
            };
            let dual = evaluate(&graph, &roots, &inputs, &Curves);
            let dual: Vec<Bounded> = dual.iter().map(|d| d.derivative).collect();
            check_close(&symbolic, &dual)?;
        }
    }

    #[test]
    fn text_reads_back_as_the_same_value(program in programs(), state in states()) {
        let graph = Graph::new();
        let roots = build(&graph, &program);
        let fused = fuse(&graph, &roots);
        for (graph, roots) in [(&graph, &roots), (&fused.graph, &fused.roots)] {
            let named: Vec<(String, NodeId)> = roots
                .iter()
                .enumerate()
                .map(|(i, &root)| (format!("result{i}"), root))
                .collect();
            let written = text(graph, &named, &Names::of_inputs(&symbol_name));
            let mut known: Vec<(String, Bounded)> = SYMBOLS
                .into_iter()
                .map(symbol_name)
                .zip(state.map(Bounded::exact))
                .collect();
            let read = parse::evaluate_listing(&written, &mut known);
            prop_assert!(read.is_ok(), "{read:?} in\n{written}");
            let results: Vec<Bounded> = named
                .iter()
                .filter_map(|(name, _)| parse::lookup(&known, name))
                .collect();
            check_close(&results, &values(graph, roots, &state))?;
        }
    }

    #[test]
    fn the_same_program_gives_the_same_graph_and_text(program in programs()) {
        let once = || {
            let graph = Graph::new();
            let roots = build(&graph, &program);
            let factored = factor(&graph, &roots);
            let fused = fuse(&factored.graph, &factored.roots);
            let named: Vec<_> = fused.roots.iter().map(|&r| (format!("x{}", r.0), r)).collect();
            let written = text(&fused.graph, &named, &Names::of_inputs(&symbol_name));
            let nodes = fused.graph.nodes().to_vec();
            (nodes, fused.roots.clone(), written)
        };
        prop_assert_eq!(once(), once());
    }
}

/// Checks that both make the same node.
fn same(
    left: impl for<'g> Fn(Expr<'g>, Expr<'g>, Expr<'g>) -> Expr<'g>,
    right: impl for<'g> Fn(Expr<'g>, Expr<'g>, Expr<'g>) -> Expr<'g>,
) {
    let graph = Graph::new();
    let [x, y, z] = [0, 1, 2].map(|i| graph.symbol(Symbol::Coordinate(i)));
    assert_eq!(left(x, y, z).id(), right(x, y, z).id());
    // The same in the other order of creation.
    let graph = Graph::new();
    let [z, y, x] = [2, 1, 0].map(|i| graph.symbol(Symbol::Coordinate(i)));
    assert_eq!(right(x, y, z).id(), left(x, y, z).id());
}

fn n<'g>(like: Expr<'g>, value: f64) -> Expr<'g> {
    like.graph().constant(value)
}

#[test]
fn identities_of_the_constructors() {
    same(|x, y, _| x + y, |x, y, _| y + x);
    same(|x, y, _| x * y, |x, y, _| y * x);
    same(|x, y, _| x - y, |x, y, _| -(y - x));
    same(|x, y, _| x - (-y), |x, y, _| x + y);
    same(|x, y, _| -x - y, |x, y, _| -(x + y));
    same(|x, y, _| -x + y, |x, y, _| y - x);
    same(|x, _, _| -(-x), |x, _, _| x);
    same(|x, _, _| x + n(x, 0.0), |x, _, _| x);
    same(|x, _, _| n(x, 0.0) - x, |x, _, _| -x);
    same(|x, _, _| x - x, |x, _, _| n(x, 0.0));
    same(|x, _, _| x + x, |x, _, _| 2.0 * x);
    same(|x, _, _| 3.0 * x - x, |x, _, _| 2.0 * x);
    same(|x, _, _| x * n(x, 1.0), |x, _, _| x);
    same(|x, _, _| x * n(x, -1.0), |x, _, _| -x);
    same(|x, _, _| x * n(x, 0.0), |x, _, _| n(x, 0.0));
    same(|x, y, _| -x * y, |x, y, _| -(x * y));
    same(|x, y, _| -x * -y, |x, y, _| x * y);
    same(|x, y, z| (x - y) * (y - z), |x, y, z| (y - x) * (z - y));
    same(|x, _, _| 2.0 * (3.0 * x), |x, _, _| 6.0 * x);
    same(|x, _, _| x / n(x, 4.0), |x, _, _| 0.25 * x);
    same(|x, y, _| -x / y, |x, y, _| -(x / y));
    same(|x, y, _| x / -y, |x, y, _| -(x / y));
    same(|x, _, _| n(x, -2.0) / x, |x, _, _| -(n(x, 2.0) / x));
    same(|x, _, _| (-x).sin(), |x, _, _| -x.sin());
    same(|x, y, _| (x - y).cos(), |x, y, _| (y - x).cos());
    same(|x, _, _| n(x, 9.0).sqrt(), |x, _, _| n(x, 3.0));
    same(|x, _, _| x.max(x), |x, _, _| x);
    same(|x, _, _| x.min(x), |x, _, _| x);
}
