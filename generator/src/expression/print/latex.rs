//! Expressions as LaTeX: an `aligned` environment, to be put into `\[ … \]` or `equation`.

use super::Names;
use super::listing::{Line, Notation, Operand, listing};
use crate::expression::graph::Graph;
use crate::expression::node::NodeId;

/// The roots as equations, after definitions of the values that they share; sections are lines of text. The names of
/// roots and inputs must be LaTeX; those of nodes and functions are identifiers.
pub fn latex(graph: &Graph, roots: &[(String, NodeId)], names: &Names<'_>) -> String {
    let mut lines = Vec::new();
    for line in listing(graph, roots, names, &Latex) {
        match line {
            Line::Section(name) if name.is_empty() => {}
            Line::Section(name) => lines.push(format!("&\\text{{{}}}", escaped(&name))),
            Line::Results => {}
            Line::Equation { name, value } => lines.push(format!("{name} &= {value}")),
        }
    }
    format!(
        "\\begin{{aligned}}\n{}\n\\end{{aligned}}\n",
        lines.join(" \\\\\n")
    )
}

/// An identifier with its parts as subscripts: `w_head_x` is `w_{\mathrm{head},x}`, `t12` is `t_{12}`.
pub fn identifier(name: &str) -> String {
    let mut parts = name.split('_').filter(|part| !part.is_empty());
    let first = parts.next().unwrap_or(name);
    let letters = first.trim_end_matches(|c: char| c.is_ascii_digit());
    let (base, digits) = first.split_at(if letters.is_empty() {
        first.len()
    } else {
        letters.len()
    });
    let subscripts: Vec<String> = Some(digits)
        .filter(|digits| !digits.is_empty())
        .into_iter()
        .chain(parts)
        .map(upright)
        .collect();
    match subscripts.is_empty() {
        true => upright(base),
        false => format!("{}_{{{}}}", upright(base), subscripts.join(",")),
    }
}

/// Sets words upright; letters and numbers stay as they are.
fn upright(part: &str) -> String {
    let number = part.chars().all(|c| c.is_ascii_digit());
    match number || part.chars().count() == 1 {
        true => escaped(part),
        false => format!("\\mathrm{{{}}}", escaped(part)),
    }
}

/// Escapes characters that have a meaning in TeX.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\\' => safe.push_str("\\textbackslash{}"),
            '^' => safe.push_str("\\textasciicircum{}"),
            '~' => safe.push_str("\\textasciitilde{}"),
            '{' | '}' | '_' | '&' | '%' | '#' | '$' => safe.extend(['\\', c]),
            _ => safe.push(c),
        }
    }
    safe
}

struct Latex;

impl Notation for Latex {
    fn number(&self, value: f64) -> String {
        let text = format!("{value:?}");
        match text.split_once('e') {
            Some((mantissa, exponent)) => {
                let power = format!("10^{{{exponent}}}");
                match mantissa {
                    "1" => power,
                    _ => format!("{mantissa}\\cdot {power}"),
                }
            }
            None if value.is_infinite() => "\\infty".to_string(),
            None if value.is_nan() => "\\mathrm{NaN}".to_string(),
            None => text.strip_suffix(".0").unwrap_or(&text).to_string(),
        }
    }

    fn input(&self, name: String) -> String {
        name
    }

    fn defined(&self, name: &str) -> String {
        identifier(name)
    }

    fn parenthesised(&self, inner: &str) -> String {
        format!("\\left({inner}\\right)")
    }

    fn times(&self) -> &'static str {
        "\\,"
    }

    fn quotient(&self, above: Operand, below: Operand) -> String {
        format!("\\frac{{{}}}{{{}}}", above.text, below.text)
    }

    fn sqrt(&self, inner: &str) -> String {
        format!("\\sqrt{{{inner}}}")
    }

    fn standard(&self, name: &'static str, arguments: &[String]) -> String {
        let operator = match name {
            "atan2" => "\\operatorname{atan2}".to_string(),
            _ => format!("\\{name}"),
        };
        format!("{operator}{}", self.parenthesised(&arguments.join(", ")))
    }

    fn call(&self, name: &str, arguments: &[String]) -> String {
        format!(
            "{}{}",
            identifier(name),
            self.parenthesised(&arguments.join(", "))
        )
    }
}
