use bryant_generator::expression::liveness::Live;
use bryant_generator::expression::passes::{join, rebuild};
use bryant_generator::expression::{Function, Graph, Node, Symbol};

#[test]
fn only_live_nodes_go_along() {
    let graph = Graph::new();
    let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let _dead = (x / y).sqrt();
    let call = graph.call(Function::Power, &[x, x + y]);
    let value = (x - y).cos().atan2(call.max(x));
    let copy = rebuild(&graph, &[value.id(), x.id()]);
    assert_eq!(
        copy.graph.len(),
        Live::new(&graph, &[value.id()]).nodes().len()
    );
    // A second rebuild changes nothing.
    let again = rebuild(&copy.graph, &copy.roots);
    assert_eq!(*again.graph.nodes(), *copy.graph.nodes());
    assert_eq!(again.roots, copy.roots);
}

#[test]
fn joined_graphs_have_in_common_what_they_can() {
    let [a, b] = [(); 2].map(|()| Graph::new());
    let make = |graph: &Graph, section: &str| {
        let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
        graph.section("element torso");
        let common = x * y;
        graph.section(section);
        [(common + x).id(), (common.sqrt()).id()]
    };
    let (of_a, of_b) = (make(&a, "element head"), make(&b, "element arm"));
    let both = join(&[(&a, &of_a[..1]), (&b, &of_b[..])]);
    // two inputs, the product, the sum, and the root that only the second graph has
    assert_eq!(both.graph.len(), 5);
    assert_eq!(both.roots[0], both.roots[1]);
    let section = |root: usize| both.graph.section_of(both.roots[root]);
    assert_eq!(both.graph.sections()[section(1)], "element head");
    assert_eq!(both.graph.sections()[section(2)], "element arm");
}

#[test]
fn sections_and_names_are_kept() {
    let graph = Graph::new();
    let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
    graph.section("element torso");
    let _dead = x / y;
    graph.section("element head");
    let a = x * y;
    graph.name(a, "a");
    graph.section("element torso");
    let b = a + x;
    let copy = rebuild(&graph, &[b.id()]);
    assert_eq!(*copy.graph.sections(), *graph.sections());
    let Node::Add(_, new_a) = copy.graph.node(copy.roots[0]) else {
        panic!("the sum is still a sum");
    };
    assert_eq!(copy.graph.name_of(new_a).as_deref(), Some("a"));
    for (new, old) in [(new_a, a), (copy.roots[0], b)] {
        assert_eq!(copy.graph.section_of(new), graph.section_of(old.id()));
    }
}
