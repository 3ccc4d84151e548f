use bryant_generator::expression::print::latex::identifier;
use bryant_generator::expression::print::{Names, latex};
use bryant_generator::expression::{Function, Graph, Symbol};

fn names(symbol: Symbol) -> String {
    match symbol {
        Symbol::Coordinate(i) => format!("q_{{{}}}", i + 1),
        _ => "t".to_string(),
    }
}

#[test]
fn results_stand_after_what_they_share() {
    let graph = Graph::new();
    let [a, b, c] = [0, 1, 2].map(|i| graph.symbol(Symbol::Coordinate(i)));
    graph.section("element head_1: 50 % of it");
    let w = (a + b) / c;
    graph.name(w, "w_head_x");
    let shared = (w * c).sqrt();
    let curve = graph.call(Function::CurveSlope(0), &[a]);
    let roots = [
        ("x".to_string(), (-shared - 2.0 * (a - b) * c.sin()).id()),
        ("y".to_string(), (3e-9 * (shared * b.atan2(a)) * curve).id()),
    ];
    assert_eq!(
        latex(&graph, &roots, &Names::of_inputs(&names)),
        r"\begin{aligned}
&\text{element head\_1: 50 \% of it} \\
w_{\mathrm{head},x} &= \frac{q_{1} + q_{2}}{q_{3}} \\
t_{1} &= \sqrt{q_{3}\,w_{\mathrm{head},x}} \\
x &= -t_{1} - 2\,\left(q_{1} - q_{2}\right)\,\sin\left(q_{3}\right) \\
y &= 3\cdot 10^{-9}\,t_{1}\,\mathrm{curve}_{1,\mathrm{slope}}\left(q_{1}\right)\,\operatorname{atan2}\left(q_{2}, q_{1}\right)
\end{aligned}
"
    );
}

#[test]
fn identifiers_become_subscripts() {
    for (name, expected) in [
        ("t12", "t_{12}"),
        ("x", "x"),
        ("torso", "\\mathrm{torso}"),
        ("S_head_2", "S_{\\mathrm{head},2}"),
        ("a_", "a"),
        ("_", "\\_"),
        ("42", "42"),
    ] {
        assert_eq!(identifier(name), expected);
    }
}
