//! The comment at the top of the generated text: a description of the model, and the cost of its methods.

use super::method::Function;
use super::operations;
use crate::equations::Equations;
use crate::model::Model;
use crate::target::summary;

/// The comment at the top of a module. It ends in a newline.
pub(crate) fn header(model: &Model, equations: &Equations, functions: &[Function]) -> String {
    let mut text = String::new();
    for said in summary::lines(model, equations) {
        line(&mut text, said);
    }
    operations::tables(&mut text, equations, functions);
    text
}

/// Adds a line of comment to a text.
pub(crate) fn line(text: &mut String, content: impl AsRef<str>) {
    text.push_str("//");
    let content = content.as_ref().trim_end();
    if !content.is_empty() {
        text.push(' ');
        text.push_str(content);
    }
    text.push('\n');
}
