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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::{Function, Symbol};

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
}
