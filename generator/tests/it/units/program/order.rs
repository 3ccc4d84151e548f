use bryant_generator::expression::{Graph, NodeId, Symbol};
use bryant_generator::program::order::by_need;
use bryant_generator::program::schedule::uses;

/// Sections in the order in which [`by_need`] comes to them.
fn sections(graph: &Graph, roots: &[NodeId]) -> Vec<String> {
    let mut sections: Vec<usize> = by_need(graph, &uses(graph, roots))
        .into_iter()
        .map(|id| graph.section_of(id))
        .collect();
    sections.dedup();
    let names = sections.into_iter();
    names.map(|at| graph.sections()[at].clone()).collect()
}

#[test]
fn a_section_stands_right_before_the_first_that_needs_it() {
    let graph = Graph::new();
    let input = |i: u32| graph.symbol(Symbol::Coordinate(i));
    graph.section("element a: rate");
    let rate_of_a = 0.5 * input(0);
    graph.section("element b: rate");
    let rate_of_b = 0.5 * input(1);
    graph.section("element a: axes");
    let axes_of_a = input(0) * input(0);
    graph.section("element b: axes");
    let axes_of_b = input(1) * input(1);
    graph.section("element b: moments");
    let moment_of_b = (axes_of_b + input(1)).sqrt();
    graph.section("element a: moments");
    let moment_of_a = axes_of_a * input(2) + moment_of_b;
    graph.section("element b: acceleration");
    let acceleration_of_b = moment_of_a * axes_of_b;
    let roots = [rate_of_a, rate_of_b, moment_of_a, acceleration_of_b];
    let order = [
        "element b: rate",
        "element b: axes",
        "element b: moments",
        "element a: rate",
        "element a: axes",
        "element a: moments",
        "element b: acceleration",
    ];
    assert_eq!(sections(&graph, &roots.map(|root| root.id())), order);
}

#[test]
fn what_stands_beside_waits_for_what_it_needs() {
    let graph = Graph::new();
    let input = |i: u32| graph.symbol(Symbol::Coordinate(i));
    graph.section("element a: axes");
    let axes = input(0).sin();
    graph.section("element a: rate");
    let rate = axes * input(1);
    graph.section("element b: acceleration");
    let acceleration = axes * input(2);
    let order = [
        "element a: axes",
        "element a: rate",
        "element b: acceleration",
    ];
    let roots = [acceleration.id(), rate.id()];
    assert_eq!(sections(&graph, &roots), order);
    // An owner of which nothing else is needed comes last.
    graph.section("element c: rate");
    let alone = 2.0 * input(3);
    let last = sections(&graph, &[alone.id(), roots[0], roots[1]]);
    assert_eq!(last[..3], order);
    assert_eq!(last[3..], ["element c: rate"]);
}
