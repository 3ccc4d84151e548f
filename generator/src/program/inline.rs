//! Decides which values are bound to a name and which are written where they are used.
//!
//! A value is written in place if it is used once, in its own section, and has no name, and as long as the expression
//! fits on a line and is not nested too deep.

use super::schedule::index;
use crate::expression::{Graph, Node, NodeId};
use crate::method::inputs::{Input, Inputs};
use rustc_hash::FxHashMap;

/// Largest width of an expression in characters: the rest of a line beside the name of its value.
const LINE: usize = 68;
/// Characters that surround a number to convert it to the scalar type.
const AROUND_NUMBER: usize = 5;
/// Characters before the name of a value that depends on parameters alone.
const BEFORE_DERIVED: usize = 5;
/// Characters before the name of a parameter.
const BEFORE_PARAMETER: usize = 16;
/// Assumed width of a name that is assigned later, after the order is fixed.
const NAMELESS: usize = 4;
/// Deepest nesting of an expression.
const DEPTH: usize = 4;

/// The size of an expression on the page.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Look {
    /// Width in characters, roughly, because temporaries have no names yet.
    width: usize,
    depth: usize,
}

/// By node: true if the value is written where it is used. `labels` are the names of results.
pub(crate) fn inline(
    graph: &Graph,
    labels: &FxHashMap<NodeId, String>,
    uses: &[u32],
    inputs: &Inputs,
) -> Vec<bool> {
    let word = |id: NodeId| word(graph, id, labels);
    let nodes = graph.nodes();
    let user_sections = user_sections(graph, uses);
    let mut inline = vec![false; nodes.len()];
    // By value, its size as its users see it: that of its name, or that of its formula.
    let mut looks = vec![Look::default(); nodes.len()];
    for (position, &node) in nodes
        .iter()
        .enumerate()
        .filter(|(position, _)| uses[*position] > 0)
    {
        let id = NodeId(position as u32);
        if let Some(width) = leaf(node, inputs) {
            looks[position] = Look { width, depth: 0 };
            continue;
        }
        let list = |id: NodeId| matches!(nodes[index(id)], Node::Arguments(_));
        if list(id) && uses[position] > 1 {
            // an argument list that several calls use is computed once, so its members are bound
            for operand in node.operands().filter(|&operand| !list(operand)) {
                if inline[index(operand)] && !matches!(nodes[index(operand)], Node::Neg(_)) {
                    inline[index(operand)] = false;
                    looks[index(operand)] = word(operand);
                }
            }
        }
        let mut largest_first: Vec<NodeId> = node
            .operands()
            .filter(|&id| inline[index(id)] && !list(id))
            .collect();
        largest_first.sort_by_key(|&id| std::cmp::Reverse(looks[index(id)]));
        let mut formula = look(node, &looks);
        for operand in largest_first {
            if formula.width <= LINE && formula.depth <= DEPTH {
                break;
            }
            inline[index(operand)] = false;
            looks[index(operand)] = word(operand);
            formula = look(node, &looks);
        }
        inline[position] = match node {
            // A list is not a value, so it is never bound.
            Node::Arguments(_) => true,
            // A sign is easier to read than a name, and costs nothing.
            Node::Neg(a) if !inline[index(a)] => true,
            _ if labels.contains_key(&id) => false,
            Node::Sin(_) | Node::Cos(_) | Node::Call(..) => false,
            _ => {
                let section = Some(graph.section_of(id));
                let here = user_sections[position].is_none_or(|user| Some(user) == section);
                uses[position] == 1 && here && graph.name_of(id).is_none()
            }
        };
        looks[position] = if inline[position] { formula } else { word(id) };
    }
    inline
}

/// By value, the section of its user; meaningful only if it has a single user.
fn user_sections(graph: &Graph, uses: &[u32]) -> Vec<Option<usize>> {
    let mut sections = vec![None; graph.len()];
    for (position, node) in graph.nodes().iter().enumerate() {
        if uses[position] > 0 {
            for operand in node.operands() {
                sections[index(operand)] = Some(graph.section_of(NodeId(position as u32)));
            }
        }
    }
    sections
}

/// Width of a number or of an input; `None` for an operation.
fn leaf(node: Node, inputs: &Inputs) -> Option<usize> {
    match node {
        Node::Constant(bits) => Some(AROUND_NUMBER + format!("{:?}", f64::from_bits(bits)).len()),
        Node::Symbol(symbol) => Some(match inputs.input(symbol) {
            Input::Time => 1,
            Input::Coordinate(i) => inputs.coordinates[i].len(),
            Input::Velocity(i) => inputs.velocities[i].len(),
            Input::Auxiliary(i) => inputs.auxiliaries[i].len(),
            Input::Memory(i) => inputs.memory[i].len(),
            Input::Acceleration(i) => inputs.accelerations[i].len(),
            Input::EventFunction(i) => inputs.event_functions[i].len(),
            Input::Parameter(i) => BEFORE_PARAMETER + inputs.parameters[i].len(),
            Input::Derived(i) => BEFORE_DERIVED + inputs.derived[i].len(),
        }),
        _ => None,
    }
}

/// The size of a bound value: that of its name.
fn word(graph: &Graph, id: NodeId, labels: &FxHashMap<NodeId, String>) -> Look {
    let name = graph.name_of(id);
    let name = name.as_ref().or_else(|| labels.get(&id));
    Look {
        width: name.map_or(NAMELESS, String::len),
        depth: 0,
    }
}

/// The size of an operation's formula.
fn look(node: Node, looks: &[Look]) -> Look {
    let (mut width, mut depth) = (0, 0);
    for operand in node.operands() {
        let look = looks[index(operand)];
        width += look.width;
        depth = depth.max(look.depth);
    }
    // the rough width of the text around the operands
    let around = match node {
        Node::Constant(_) | Node::Symbol(_) => 0,
        Node::Neg(_) => 1,
        Node::Add(..) | Node::Sub(..) | Node::Mul(..) | Node::Div(..) => 3,
        Node::MulAdd(..) => 12,
        Node::Sqrt(_) => 7,
        Node::Sin(_) | Node::Cos(_) => 10,
        Node::Atan2(..) => 8,
        Node::Max(..) | Node::Min(..) => 6,
        Node::Call(..) => 36,
        Node::Arguments(_) => 4,
    };
    Look {
        width: width + around,
        depth: depth + 1,
    }
}
