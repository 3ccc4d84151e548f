//! Finds the curves that are functions of time, curve(rate · t), and their rates.

use crate::expression::liveness::{Dependence, Live};
use crate::expression::{Function, Graph, Node, NodeId, Symbol};

/// The curves that the roots evaluate at multiples of time: for each the index of the curve and the node of the factor.
/// Each pair occurs once, in the order of the graph.
pub fn of(graph: &Graph, roots: &[NodeId]) -> Vec<(usize, NodeId)> {
    let live = Live::new(graph, roots);
    let mut found = Vec::new();
    for &id in live.nodes() {
        let node = graph.node(id);
        if let Node::Call(function, ..) = node
            && let Some(argument) = node.operands().next()
            && let Some(curve) = curve_of(function)
            && let Some(rate) = factor_of_time(graph, &live, argument)
            && !found.contains(&(curve, rate))
        {
            found.push((curve, rate));
        }
    }
    found
}

/// The factor c in c · t.
fn factor_of_time(graph: &Graph, live: &Live, argument: NodeId) -> Option<NodeId> {
    let is_time = |id: NodeId| graph.node(id) == Node::Symbol(Symbol::Time);
    match graph.node(argument) {
        Node::Symbol(Symbol::Time) => Some(graph.constant(1.0).id()),
        Node::Mul(a, b) if is_time(a) => Some(b),
        Node::Mul(a, b) if is_time(b) => Some(a),
        _ => None,
    }
    .filter(|&factor| is_time(argument) || live.dependence(factor).within(Dependence::PARAMETERS))
}

fn curve_of(function: Function) -> Option<usize> {
    match function {
        Function::Curve(i)
        | Function::CurveSlope(i)
        | Function::CurveSecondDerivative(i)
        | Function::CurveIntegral(i)
        | Function::CurveDoubleIntegral(i) => Some(i as usize),
        _ => None,
    }
}
