use bryant_generator::expression::passes::Recall;
use bryant_generator::expression::{Function, Graph, Symbol};

#[test]
fn only_what_changes_is_made_anew() {
    let graph = Graph::new();
    let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let slope = |function: Function| match function {
        Function::Curve(i) => Function::CurveSlope(i),
        other => other,
    };
    let called = graph.call(Function::Curve(3), &[x + y]);
    let unchanged = (x * y).sqrt();
    let value = graph.call(Function::Power, &[called, unchanged]) - unchanged;
    let mut recall = Recall::new(&graph, slope);
    let new = recall.expression(value);
    let called = graph.call(Function::CurveSlope(3), &[x + y]);
    let expected = graph.call(Function::Power, &[called, unchanged]) - unchanged;
    assert_eq!(new.id(), expected.id());
    assert_eq!(recall.expression(unchanged).id(), unchanged.id());
    // what was made of a part before is found again, also under a new node
    let more = recall.expression(value * x - unchanged);
    assert_eq!(more.id(), (new * x - unchanged).id());
}
