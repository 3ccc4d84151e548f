use bryant_generator::expression::count::Count;
use bryant_generator::expression::liveness::Live;
use bryant_generator::expression::passes::factor;
use bryant_generator::expression::passes::factor::cost;
use bryant_generator::expression::print::{Names, symbol_name, text};
use bryant_generator::expression::{Expr, Graph, NodeId, Symbol};

fn inputs(graph: &Graph) -> [Expr<'_>; 5] {
    [0, 1, 2, 3, 4].map(|i| graph.symbol(Symbol::Coordinate(i)))
}

fn letters(symbol: Symbol) -> String {
    match symbol {
        Symbol::Coordinate(i) => "abcde"[i as usize..][..1].to_string(),
        other => symbol_name(other),
    }
}

fn written(graph: &Graph, roots: &[Expr<'_>]) -> String {
    let ids: Vec<NodeId> = roots.iter().map(|r| r.id()).collect();
    let new = factor(graph, &ids);
    let before = cost(&Count::of(graph, &ids));
    assert!(cost(&Count::of(&new.graph, &new.roots)) <= before);
    let named = ["x", "y", "z"].iter().map(|n| n.to_string());
    let roots: Vec<_> = named.zip(new.roots).collect();
    text(&new.graph, &roots, &Names::of_inputs(&letters))
}

#[test]
fn common_factors_go_outside() {
    let graph = Graph::new();
    let [a, b, c, d, e] = inputs(&graph);
    assert_eq!(written(&graph, &[a * c + b * c]), "x = c*(a + b)\n");
    assert_eq!(written(&graph, &[a * c - b * c]), "x = c*(a - b)\n");
    assert_eq!(
        written(&graph, &[a * c + d * e + b * c]),
        "x = c*(a + b) + d*e\n"
    );
    assert_eq!(
        written(&graph, &[a * b * c + a * b * d + a * e]),
        "x = a*(e + b*(c + d))\n"
    );
    assert_eq!(written(&graph, &[2.0 * a + 2.0 * b]), "x = 2*(a + b)\n");
    assert_eq!(written(&graph, &[a * a - a * b + a]), "x = a*(a - b + 1)\n");
}

#[test]
fn a_product_that_is_needed_elsewhere_is_not_taken_apart() {
    let graph = Graph::new();
    let [a, b, c, ..] = inputs(&graph);
    assert_eq!(
        written(&graph, &[a * c + b * c, a * c]),
        "t1 = a*c\n\nx = t1 + b*c\ny = t1\n"
    );
}

#[test]
fn common_pairs_are_shared_up_to_sign() {
    let graph = Graph::new();
    let [a, b, c, d, e] = inputs(&graph);
    assert_eq!(
        written(&graph, &[a + c - b, b + d - a]),
        "t1 = a - b\n\nx = c + t1\ny = d - t1\n"
    );
    assert_eq!(
        written(&graph, &[(a * c) * e, (a * d) * e]),
        "t1 = a*e\n\nx = c*t1\ny = d*t1\n"
    );
}

#[test]
fn numbers_and_parameters_collect() {
    let graph = Graph::new();
    let [a, b, ..] = inputs(&graph);
    let [p, r] = [0, 1].map(|i| graph.symbol(Symbol::Parameter(i)));
    assert_eq!(
        written(&graph, &[2.0 * a * (graph.constant(3.0) * b)]),
        "x = 6*a*b\n"
    );
    let new = factor(&graph, &[(p * a * r).id()]);
    let live = Live::new(&new.graph, &new.roots);
    assert_eq!(live.hoistable(&new.graph).len(), 1);
}

#[test]
fn opposites_cancel() {
    let graph = Graph::new();
    let [a, b, c, ..] = inputs(&graph);
    assert_eq!(written(&graph, &[(a + b) - (c + b)]), "x = a - c\n");
    assert_eq!(written(&graph, &[(a + b) + (a - b)]), "x = 2*a\n");
}

#[test]
fn one_reciprocal_for_several_quotients() {
    let graph = Graph::new();
    let [a, b, c, d, e] = inputs(&graph);
    let below = c * d + e;
    assert_eq!(
        written(&graph, &[a / below, b / below]),
        "t1 = 1/(e + c*d)\n\nx = a*t1\ny = b*t1\n"
    );
    assert_eq!(written(&graph, &[a / c + b / c]), "x = (a + b)/c\n");
    assert_eq!(written(&graph, &[a / below]), "x = a/(e + c*d)\n");
}

#[test]
fn names_and_sections_stay_with_what_is_shared() {
    let graph = Graph::new();
    let [a, b, c, ..] = inputs(&graph);
    graph.section("element head");
    let w = a * c + b * c;
    graph.name(w, "w");
    assert_eq!(
        written(&graph, &[w.sin() * w]),
        "# element head\nw = c*(a + b)\n\nx = w*sin(w)\n"
    );
}

#[test]
fn deep_and_long_expressions_take_linear_time() {
    let graph = Graph::new();
    let [a, b, c, d, _] = inputs(&graph);
    let nested = (0..20_000).fold(a, |sum, _| (sum + b) * c - d);
    let long = (0..20_000).fold(a, |sum, i| {
        let factor = graph.constant(f64::from(i) + 0.5);
        sum + factor * (b + factor).sin() * c
    });
    let roots = [nested.id(), long.id()];
    let new = factor(&graph, &roots);
    let [before, after] = [Count::of(&graph, &roots), Count::of(&new.graph, &new.roots)];
    // c is taken out of the long sum.
    assert!(after.total() + 19_000 < before.total());
}
