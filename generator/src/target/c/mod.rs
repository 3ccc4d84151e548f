//! Writes C99: a header and a source with the methods of a model. They need nothing but `math.h`.
//!
//! | file | what |
//! |---|---|
//! | `header` | the header: sizes, names, declarations |
//! | `methods` | the functions of a model |
//! | `body` | a list as the statements of a function |
//! | `curve` | curves as constant arrays |
//! | `support` | laws and curves as static functions, whose text is in the folder `support` |
//! | `names` | identifiers |
//!
//! Results have the same bits as those of the Rust text over `f64` if the compiler obeys IEEE 754 (no `-ffast-math`).
//! The text contains its own elementary functions; of the platform's library it needs only exact functions. With
//! `BRYANT_FUSED`, results have the same bits as those of lanes, with one exception: if GCC optimises and fuses, it
//! turns −(a·b + c) into −a·b − c, and if that is 0, its sign differs.

mod body;
mod curve;
mod header;
mod methods;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod names;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod support;

use crate::expression::Function;
use crate::program::{Curve, List, Lists, Operation};
use methods::Methods;
use std::fmt::Write as _;
use support::Support;

/// A model as C99.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// The prefix of all C names, and the name of the files without `.h` and `.c`.
    pub name: String,
    /// The text of the header.
    pub header: String,
    /// The text of the source, which includes the header by `#include "NAME.h"`.
    pub source: String,
}

/// The reason why a model cannot be written in C: its forces call functions of the user, which are Rust.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoC {
    /// The names of the functions.
    pub functions: Vec<String>,
}

impl std::fmt::Display for NoC {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let functions = self.functions.join(", ");
        write!(
            f,
            "there is no C of this model: {functions} is Rust, as the description of the force says\n  \
             help: leave the force out, or describe it by curves"
        )
    }
}

impl std::error::Error for NoC {}

/// Writes a model as C99. `about` has lines that describe the model.
///
/// # Errors
/// If the model calls functions of the user, which are Rust.
pub fn source(lists: &Lists, about: &[String]) -> Result<Source, NoC> {
    let functions = functions_of_users(lists);
    if !functions.is_empty() {
        return Err(NoC { functions });
    }
    let name = names::model(&lists.facts.name);
    let mut support = Support::default();
    let functions = Methods {
        lists,
        name: &name,
        support: &mut support,
    }
    .all();
    let said = about.iter().rposition(|line| !line.is_empty());
    let about = &about[..said.map_or(0, |last| last + 1)];
    let lines = about.iter().map(|line| format!(" * {}", comment(line)));
    let lines = lines.map(|line| format!("{}\n", line.trim_end()));
    let about = format!("/*\n{} */\n", lines.collect::<String>());
    let header = header::header(lists, &name, &about, &functions);
    let mut text = format!(
        "/* Functions of {name}.h, where it says what they do. Compile with optimisation (-O2). Where BRYANT_FUSED is\n   \
         defined, products and sums are rounded at once (-O2 -mfma -DBRYANT_FUSED); results then differ by rounding. */\n\
         #include \"{name}.h\"\n\n#include <math.h>\n#include <stddef.h>\n#include <string.h>\n\n\
         /* no product and sum are fused unasked */\n#ifdef __clang__\n#pragma STDC FP_CONTRACT OFF\n\
         #elif defined __GNUC__\n#pragma GCC optimize (\"fp-contract=off\")\n#endif\n\n{}",
        support.text()
    );
    if support.has("curve") {
        for (index, curve) in lists.curves.iter().enumerate() {
            let name = format!("{name}_curve_{index}");
            if functions.iter().any(|f| f.mentions(&name)) {
                text.push_str(&curve::define(curve, &name));
            }
        }
    }
    for function in &functions {
        let _ = writeln!(
            text,
            "{}{}\n{}",
            function.before, function.head, function.body
        );
    }
    text.push_str(&tables(lists, &name));
    Ok(Source {
        name,
        header,
        source: text,
    })
}

/// Writes a list as a function of its own, with everything that it calls:
/// `void NAME(double t, const double y[], double results[])`. The list must depend on time and state alone. `curves`
/// are the curves of the model.
///
/// # Errors
/// If the list calls functions of the user, which are Rust.
pub fn function(list: &List, curves: &[Curve], name: &str) -> Result<String, NoC> {
    let of_user = list.operations.iter().any(|operation| {
        matches!(
            operation,
            Operation::Call {
                function: Function::User(_),
                ..
            }
        )
    });
    if of_user {
        let functions = vec!["a function of the user's".to_owned()];
        return Err(NoC { functions });
    }
    let mut support = Support::default();
    let curve = |index: u32| format!("{name}_curve_{index}");
    let statements = body::body(list, &curve, &mut support).text;
    let mut text = format!(
        "#include <math.h>\n#include <stddef.h>\n#include <string.h>\n\n{}",
        support.text()
    );
    if support.has("curve") {
        for (index, of) in curves.iter().enumerate() {
            let name = curve(index as u32);
            if statements.contains(&format!("&{name},")) {
                text.push_str(&curve::define(of, &name));
            }
        }
    }
    let _ = write!(
        text,
        "void {name}(double t, const double y[], double results[])\n{{\n    (void)t;\n    (void)y;\n{statements}}}\n"
    );
    Ok(text)
}

/// Names and units as C arrays.
fn tables(lists: &Lists, name: &str) -> String {
    let upper = name.to_ascii_uppercase();
    let mut text = String::new();
    for (table, size, members) in header::tables(&lists.facts) {
        let members: Vec<String> = members.into_iter().map(quoted).collect();
        let members = members.join(", ");
        let line = format!("const char *const {name}_{table}[{upper}_{size}] = {{{members}}};");
        text.push_str(&line);
        text.push('\n');
    }
    text
}

/// The names of the functions of the user that a model calls.
fn functions_of_users(lists: &Lists) -> Vec<String> {
    let mut found = Vec::new();
    for routine in &lists.routines {
        for operation in &routine.list.operations {
            if let Operation::Call {
                function: Function::User(call),
                ..
            } = operation
                && let Some(Some(name)) = lists.users.get(usize::from(call.force))
                && !found.contains(name)
            {
                found.push(name.clone());
            }
        }
    }
    found
}

/// A number in C: the shortest text that reads back as the same double.
fn number(value: f64) -> String {
    match value {
        f64::INFINITY => "INFINITY".to_owned(),
        f64::NEG_INFINITY => "(-INFINITY)".to_owned(),
        value if value.is_nan() => "NAN".to_owned(),
        value if value.is_sign_negative() => format!("({value:?})"),
        value => format!("{value:?}"),
    }
}

/// Replaces characters that would end a comment or continue a line.
fn comment(words: &str) -> String {
    let printable = |c: char| match c {
        '\\' => '/',
        c if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}') => ' ',
        c => c,
    };
    let words: String = words.chars().map(printable).collect();
    let words = words.replace("*/", "* /").replace("/*", "/ *");
    words.replace("??", "? ?")
}

/// A string literal.
fn quoted(words: &str) -> String {
    let mut text = String::from("\"");
    for c in words.chars() {
        match c {
            '"' | '\\' | '?' => text.extend(['\\', c]),
            c if c.is_control() => text.push(' '),
            c => text.push(c),
        }
    }
    text.push('"');
    text
}

/// A statement with indentation, broken at spaces into lines of at most 120 columns.
fn indented(statement: &str) -> String {
    const WIDTH: usize = 120;
    let mut text = String::from("   ");
    let mut column = text.len();
    for word in statement.split(' ') {
        if column + 1 + word.len() > WIDTH {
            text.push_str("\n       ");
            column = 7;
        }
        text.push(' ');
        text.push_str(word);
        column += 1 + word.len();
    }
    text.push('\n');
    text
}
