//! The size of the program: tokens of its sources by crate, which formatting, comments and names do not change, against
//! `tests/size.txt`.
//!
//! Product is what is compiled into the command or into a user's crate, with the C and the pages that it prints; tests
//! are counted apart, and may grow.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The crates, and what belongs to the command but to no library.
const CRATES: [&str; 11] = [
    "generator",
    "runtime",
    "engine",
    "fmu",
    "study",
    "signal",
    "picture",
    "table",
    "hard",
    "python",
    ".",
];
/// A crate may differ by so much from the table.
const ALLOWED: f64 = 0.01;
const WHAT_NOW: &str = "if that is meant, `.ci/size --write` writes the table anew: commit it together with the change, whose message says why it is needed";

/// Tokens of a crate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Size {
    product: usize,
    tests: usize,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// The sources of a crate: below `src`, `tests`, `benches` and `examples`, and the build script.
fn files(of: &Path) -> Vec<PathBuf> {
    let mut all = vec![of.join("build.rs")];
    let mut open: Vec<PathBuf> = ["src", "tests", "benches", "examples"]
        .map(|name| of.join(name))
        .into();
    while let Some(directory) = open.pop() {
        let Ok(entries) = fs::read_dir(directory) else {
            continue;
        };
        for entry in entries {
            let path = entry.unwrap().path();
            match path.is_dir() {
                // crates of their own have no place here
                true if path.join("Cargo.toml").exists() => {}
                true => open.push(path),
                false => all.push(path),
            }
        }
    }
    all.retain(|path| path.exists());
    all.sort();
    all
}

/// Rows of tables cannot be broken.
#[test]
fn no_comment_is_wider_than_120_columns() {
    let all = CRATES.iter().flat_map(|name| files(&root().join(name)));
    let rust = all.filter(|path| path.extension().is_some_and(|e| e == "rs"));
    let (mut seen, mut wide) = (0, Vec::new());
    for path in rust {
        for (index, line) in fs::read_to_string(&path).unwrap().lines().enumerate() {
            let Some(comment) = line.trim_start().strip_prefix("//") else {
                continue;
            };
            seen += 1;
            let row = comment.trim_start_matches(['/', '!', ' ']).starts_with('|');
            if line.chars().count() > 120 && !row {
                wide.push(format!("{}:{}", path.display(), index + 1));
            }
        }
    }
    assert!(seen > 10_000, "only {seen} lines of comments were found");
    assert!(wide.is_empty(), "{wide:#?}");
}

/// Whether a file is a test by its place or its name.
fn is_test(path: &Path, of: &Path) -> bool {
    let inside = path.strip_prefix(of).unwrap();
    let named = |part: &str| matches!(part, "tests" | "tests.rs" | "benches" | "examples");
    inside.iter().any(|part| named(part.to_str().unwrap()))
}

fn size(of: &Path) -> Size {
    let mut size = Size::default();
    let mut apart = BTreeSet::new();
    let files = files(of);
    for path in &files {
        let Ok(text) = fs::read_to_string(path) else {
            continue;
        };
        let here = match path.extension().and_then(|e| e.to_str()) {
            Some("rs") => {
                // some texts of tests are malformed on purpose
                let Ok(tokens) = text.parse() else {
                    assert!(is_test(path, of), "{} is no Rust", path.display());
                    continue;
                };
                let (counted, modules) = of_rust(tokens);
                // `#[cfg(test)] mod name;` in a/mod.rs or a.rs is a/name.rs or a/name/
                let folder = match path.file_stem().unwrap().to_str() {
                    Some("mod" | "lib" | "main") => path.parent().unwrap().to_path_buf(),
                    _ => path.with_extension(""),
                };
                apart.extend(modules.into_iter().map(|name| folder.join(name)));
                counted
            }
            Some("c" | "h" | "js" | "css" | "html") => Size {
                product: words(&text),
                tests: 0,
            },
            _ => continue,
        };
        // a module comes behind the one that declares it, or before: both are seen below
        let whole = here.product + here.tests;
        let test = is_test(path, of)
            || apart
                .iter()
                .any(|a| path.starts_with(a) || path == &a.with_extension("rs"));
        match test {
            true => size.tests += whole,
            false => {
                size.product += here.product;
                size.tests += here.tests;
            }
        }
    }
    size
}

/// Tokens of Rust, without documentation, and the names of modules that are tests in files of their own.
fn of_rust(tokens: TokenStream) -> (Size, Vec<String>) {
    let (mut size, mut modules) = (Size::default(), Vec::new());
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        if let TokenTree::Punct(punct) = &token
            && punct.as_char() == '#'
        {
            let inner = matches!(tokens.peek(), Some(TokenTree::Punct(p)) if p.as_char() == '!');
            if inner {
                tokens.next();
            }
            let Some(TokenTree::Group(group)) = tokens.next_if(
                |t| matches!(t, TokenTree::Group(g) if g.delimiter() == Delimiter::Bracket),
            ) else {
                size.product += 1 + usize::from(inner);
                continue;
            };
            let text = group.stream().to_string();
            if text.starts_with("doc =") {
                continue;
            }
            if text.starts_with("cfg (test)") || text == "cfg(test)" || text == "test" {
                let item: Vec<TokenTree> = item(&mut tokens);
                let names: Vec<String> = item.iter().map(ToString::to_string).collect();
                if let [.., what, name, end] = &names[..]
                    && what == "mod"
                    && end == ";"
                {
                    modules.push(name.clone());
                }
                size.tests += of_rust(item.into_iter().collect()).0.sum();
                continue;
            }
            size.product += 3 + usize::from(inner) + of_rust(group.stream()).0.sum();
            continue;
        }
        match token {
            TokenTree::Group(group) => {
                let (inside, more) = of_rust(group.stream());
                size.product +=
                    inside.product + 2 * usize::from(group.delimiter() != Delimiter::None);
                size.tests += inside.tests;
                modules.extend(more);
            }
            _ => size.product += 1,
        }
    }
    (size, modules)
}

/// The item that follows an attribute: until its block, or until `;`.
fn item(tokens: &mut impl Iterator<Item = TokenTree>) -> Vec<TokenTree> {
    let mut item = Vec::new();
    let mut imports = false;
    for token in tokens {
        imports |= item.len() < 3 && matches!(&token, TokenTree::Ident(name) if name == "use");
        let ends = match &token {
            TokenTree::Group(group) => group.delimiter() == Delimiter::Brace && !imports,
            TokenTree::Punct(punct) => punct.as_char() == ';',
            _ => false,
        };
        item.push(token);
        if ends {
            break;
        }
    }
    item
}

impl Size {
    fn sum(self) -> usize {
        self.product + self.tests
    }
}

/// Tokens of C, JavaScript, CSS and HTML: names, numbers and each sign between them, without comments. A string is as
/// many tokens as it has words.
fn words(text: &str) -> usize {
    let mut count = 0;
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let comment = [("/*", "*/"), ("//", "\n"), ("<!--", "-->")];
        if let Some((_, end)) = comment.iter().find(|(begin, _)| rest.starts_with(begin)) {
            rest = rest[1..]
                .find(end)
                .map_or("", |at| &rest[1 + at + end.len()..]);
        } else if c.is_alphanumeric() || c == '_' {
            count += 1;
            rest = rest.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_');
        } else {
            count += usize::from(!c.is_whitespace());
            rest = &rest[c.len_utf8()..];
        }
    }
    count
}

/// The table: a line for each crate.
fn table(sizes: &BTreeMap<&str, Size>) -> String {
    let mut text = String::from(
        "# Tokens without comments: what the program is made of, and its tests. `.ci/size --write` writes this file.\n",
    );
    let total = |of: fn(&Size) -> usize| sizes.values().map(of).sum::<usize>();
    let rows = sizes
        .iter()
        .map(|(name, size)| (if *name == "." { "command" } else { name }, *size));
    let sum = Size {
        product: total(|s| s.product),
        tests: total(|s| s.tests),
    };
    for (name, size) in rows.chain([("total", sum)]) {
        let _ = writeln!(text, "{name:<10} {:>8} {:>8}", size.product, size.tests);
    }
    text
}

#[test]
fn the_program_is_as_large_as_its_table_says() {
    let sizes: BTreeMap<&str, Size> = CRATES
        .iter()
        .map(|&name| (name, size(&root().join(name))))
        .collect();
    let path = root().join("tests/size.txt");
    if std::env::var_os("SIZE_WRITE").is_some() {
        fs::write(&path, table(&sizes)).unwrap();
    }
    let written = fs::read_to_string(&path).unwrap();
    let product = |table: &str| -> BTreeMap<String, f64> {
        let lines = table.lines().filter(|line| !line.starts_with('#'));
        let row = |line: &str| {
            let mut words = line.split_whitespace();
            Some((words.next()?.to_owned(), words.next()?.parse().ok()?))
        };
        lines.filter_map(row).collect()
    };
    let now = table(&sizes);
    let (was, is) = (product(&written), product(&now));
    assert!(
        was.keys().eq(is.keys()),
        "tests/size.txt has other crates: {WHAT_NOW}"
    );
    for (name, &is) in &is {
        let grown = is / was[name] - 1.0;
        assert!(
            grown.abs() <= ALLOWED,
            "{name} has {is} tokens, {:+.1} % beside tests/size.txt: {WHAT_NOW}\n{now}",
            100.0 * grown
        );
    }
}

#[test]
fn comments_and_layout_do_not_count() {
    let count = |text: &str| of_rust(text.parse().unwrap()).0;
    let plain = count("fn f(x: f64) -> f64 { x * 2.0 }");
    assert_eq!(
        plain,
        Size {
            product: 15,
            tests: 0
        }
    );
    assert_eq!(
        plain,
        count(
            "/// Twice.\nfn f(\n    x: f64,\n) -> f64 {\n    // twice\n    x * 2.0\n}"
                .replace(",\n)", ")")
                .as_str()
        )
    );
    let tested = count(
        "fn f() {} #[cfg(test)] mod tests { #[test] fn g() { f() } } #[cfg(test)] use a::{b, c};",
    );
    assert_eq!(tested.product, 6);
    assert_eq!(
        of_rust("#[cfg(test)] mod deep;".parse().unwrap()).1,
        ["deep"]
    );
    assert_eq!(words("/* x */ a_1 += f(2); // y\n"), 8);
}

/// Where a library is not compiled as a test, a test among its sources would never run.
#[test]
fn no_test_is_where_it_is_not_compiled() {
    let mut untested = 0;
    for name in CRATES {
        let of = root().join(name);
        let manifest = fs::read_to_string(of.join("Cargo.toml")).unwrap();
        let library = manifest.split("\n[").find(|part| part.starts_with("lib]"));
        if !library.is_some_and(|part| part.contains("\ntest = false")) {
            continue;
        }
        untested += 1;
        let sources = of.join("src");
        for path in files(&of).iter().filter(|path| path.starts_with(&sources)) {
            let text = fs::read_to_string(path).unwrap_or_default();
            let tested = ["#[test]", "cfg(test)"]
                .iter()
                .any(|mark| text.contains(mark));
            assert!(!tested, "{}: its tests are not compiled", path.display());
        }
    }
    assert!(untested > 1);
}
