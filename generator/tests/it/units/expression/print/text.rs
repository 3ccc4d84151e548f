use bryant_generator::expression::print::{Names, symbol_name, text};
use bryant_generator::expression::{Expr, Function, Graph, Node, Symbol};

fn inputs(graph: &Graph) -> [Expr<'_>; 4] {
    [0, 1, 2, 3].map(|i| graph.symbol(Symbol::Coordinate(i)))
}

fn letters(symbol: Symbol) -> String {
    match symbol {
        Symbol::Coordinate(i) => "abcd"[i as usize..][..1].to_string(),
        other => symbol_name(other),
    }
}

fn written(graph: &Graph, root: Expr<'_>) -> String {
    let roots = [("x".to_string(), root.id())];
    text(graph, &roots, &Names::of_inputs(&letters))
}

#[test]
fn signs_fold_and_parentheses_are_few() {
    let graph = Graph::new();
    let [a, b, c, d] = inputs(&graph);
    for (root, expected) in [
        (a + b + c + d, "a + b + c + d"),
        (a - b, "a - b"),
        (b - a, "b - a"),
        (a - (b - c), "a - b + c"),
        (-(a + b), "-a - b"),
        (-(a - b) * c, "c*(b - a)"),
        (a * b + c * d, "a*b + c*d"),
        ((a + b) * (c - d), "(a + b)*(c - d)"),
        (-(a + b) * c, "-c*(a + b)"),
        (-2.0 * a, "-2*a"),
        (0.1 * a + graph.constant(1e-7), "0.1*a + 1e-7"),
        (a - graph.constant(3.0), "a - 3"),
        (a / b * c, "c*a/b"),
        (a / (b * c), "a/(b*c)"),
        ((a + b) / (c + d), "(a + b)/(c + d)"),
        (a / b / c, "a/b/c"),
        (a / (b / c), "a/(b/c)"),
        (-(a * b) - c, "-c - a*b"),
        ((a - b).sin() * (-a).cos(), "sin(a - b)*cos(a)"),
        ((a * a + b).sqrt(), "sqrt(b + a*a)"),
        (b.atan2(-a), "atan2(b, -a)"),
        (a.max(b).min(c), "min(max(a, b), c)"),
        (graph.call(Function::Curve(1), &[a + b]), "curve2(a + b)"),
    ] {
        assert_eq!(written(&graph, root), format!("x = {expected}\n"));
    }
    let minus = graph.intern(Node::Neg(a.id()));
    let fused = graph.intern(Node::MulAdd(minus.id(), b.id(), c.id()));
    assert_eq!(written(&graph, fused), "x = c - a*b\n");
}

#[test]
fn shared_values_are_defined_before_the_results() {
    let graph = Graph::new();
    let [a, b, c, _] = inputs(&graph);
    graph.section("element head");
    let sum = a + b;
    let named = sum.sin() * c;
    graph.name(named, "w");
    graph.section("belt");
    let length = (sum * sum + c).sqrt();
    let roots = [
        ("x".to_string(), (length + named).id()),
        ("y".to_string(), (length - a.sin() * a.sin()).id()),
    ];
    assert_eq!(
        text(&graph, &roots, &Names::of_inputs(&letters)),
        "# element head\n\
             t1 = a + b\n\
             w = c*sin(t1)\n\
             \n\
             # belt\n\
             t2 = sqrt(c + t1*t1)\n\
             \n\
             x = w + t2\n\
             y = t2 - sin(a)*sin(a)\n"
    );
}

#[test]
fn names_never_collide() {
    let graph = Graph::new();
    let [a, b, c, d] = inputs(&graph);
    graph.name(a + b, "c");
    graph.name(c * d, "t1");
    graph.name(c + d, "t1");
    let shared = a * b;
    let total = (a + b) * (c * d) * (c + d) + shared / (shared + d);
    assert_eq!(
        written(&graph, total),
        "c_2 = a + b\n\
             t1 = c*d\n\
             t1_2 = c + d\n\
             t2 = a*b\n\
             \n\
             x = c_2*t1*t1_2 + t2/(d + t2)\n"
    );
}

#[test]
fn long_lines_are_cut_and_deep_expressions_are_no_burden() {
    let graph = Graph::new();
    let [a, b, c, d] = inputs(&graph);
    let nested = (0..50_000).fold(a, |sum, _| (sum + b) * c - d);
    let long = written(&graph, nested);
    let longest = long.lines().map(str::len).max();
    assert!(longest < Some(200), "{longest:?}");
    // No operation is lost: two signs between terms and one between factors at each level.
    let signs = |sign: &str| long.matches(sign).count();
    assert_eq!([signs(" + ") + signs(" - "), signs("*")], [100_000, 50_000]);
}
