//! Expressions as plain text: `a = t1 + 2*q3`. The text can be pasted into any algebra program.

use super::Names;
use super::listing::{Binding, Line, Notation, Operand, listing};
use crate::expression::graph::Graph;
use crate::expression::node::NodeId;

/// The roots as equations `name = value`, after definitions of the values that they share: one line each, with the
/// sections as headings.
pub fn text(graph: &Graph, roots: &[(String, NodeId)], names: &Names<'_>) -> String {
    let mut text = String::new();
    for line in listing(graph, roots, names, &Text) {
        let gap = if text.is_empty() { "" } else { "\n" };
        text += &match line {
            Line::Section(name) if name.is_empty() => gap.to_string(),
            Line::Section(name) => format!("{gap}# {name}\n"),
            Line::Results => gap.to_string(),
            Line::Equation { name, value } => format!("{name} = {value}\n"),
        };
    }
    text
}

struct Text;

impl Notation for Text {
    fn number(&self, value: f64) -> String {
        // Debug gives the shortest text that reads back as the same number, with exponents.
        let text = format!("{value:?}");
        text.strip_suffix(".0").unwrap_or(&text).to_string()
    }

    fn input(&self, name: String) -> String {
        name
    }

    fn defined(&self, name: &str) -> String {
        name.to_string()
    }

    fn parenthesised(&self, inner: &str) -> String {
        format!("({inner})")
    }

    fn times(&self) -> &'static str {
        "*"
    }

    fn quotient(&self, above: Operand, below: Operand) -> String {
        let above = match above.form {
            Binding::Sum => self.parenthesised(&above.text),
            _ => above.text,
        };
        let below = match below.form {
            Binding::Atom => below.text,
            _ => self.parenthesised(&below.text),
        };
        format!("{above}/{below}")
    }

    fn sqrt(&self, inner: &str) -> String {
        format!("sqrt({inner})")
    }

    fn standard(&self, name: &'static str, arguments: &[String]) -> String {
        self.call(name, arguments)
    }

    fn call(&self, name: &str, arguments: &[String]) -> String {
        format!("{name}({})", arguments.join(", "))
    }
}
