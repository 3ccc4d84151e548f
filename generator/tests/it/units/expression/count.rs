use bryant_generator::expression::count::{Count, Table};
use bryant_generator::expression::{Function, Graph, Node, Symbol};

#[test]
fn shared_nodes_count_once() {
    let graph = Graph::new();
    let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let product = x * y;
    let count = Count::of(&graph, &[(product + x).id(), (product - y).id()]);
    let expected = Count {
        add: 1,
        sub: 1,
        mul: 1,
        neg: 1, // y is older than the product: the difference is −(y − x y)
        ..Count::default()
    };
    assert_eq!(count, expected);
    assert_eq!(count.total(), 3);
}

#[test]
fn a_fused_operation_counts_two() {
    let graph = Graph::new();
    let x = graph.symbol(Symbol::Time).id();
    let fused = graph.intern(Node::MulAdd(x, x, x));
    assert_eq!(Count::of(&graph, &[fused.id()]).total(), 2);
}

#[test]
fn one_line_names_what_there_is() {
    let graph = Graph::new();
    let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let call = graph.call(Function::Curve(3), &[x * y + x]);
    let value = call * x.sin() * y.cos().sqrt() - x;
    assert_eq!(
        Count::of(&graph, &[value.id(), (-x).id()]).to_string(),
        "6 operations (1 add, 1 sub, 3 mul, 1 sqrt), 2 signs, 1 sin, 1 cos, 1 call (1 curve)"
    );
    assert_eq!(Count::default().to_string(), "0 operations");
}

#[test]
fn the_table_adds_up() {
    let graph = Graph::new();
    let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
    graph.section("element head");
    let a = x * y;
    graph.section("belt");
    let b = a + x;
    graph.section("unused");
    let _ = a * b;
    graph.section("element head");
    let c = b.sin() * a;
    let table = Table::of(&graph, &[c.id()]);
    assert_eq!(
        table.to_string(),
        "section       total  add  mul  sin\n\
             element head      2    0    2    1\n\
             belt              1    1    0    0\n\
             total             3    1    2    1"
    );
    assert_eq!(table.total, Count::of(&graph, &[c.id()]));
}
