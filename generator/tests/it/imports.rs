//! The files of the generator import each other in one direction: a circle of files stays small, and within one room.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::ToTokens;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The largest number of files in a circle.
const LARGEST: usize = 11;

/// A module: the names from the root of the crate to it.
type Module = Vec<String>;

/// The modules of the crate, each with its file.
fn modules(folder: &Path, module: &Module, all: &mut BTreeMap<Module, String>) {
    for entry in fs::read_dir(folder).expect("the sources can be read") {
        let path = entry.expect("an entry").path();
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let own = || [&module[..], std::slice::from_ref(&name)].concat();
        if path.is_dir() {
            modules(&path, &own(), all);
        } else if path.extension().is_some_and(|e| e == "rs") && name != "tests" {
            let module = if ["mod", "lib"].contains(&name.as_str()) {
                module.clone()
            } else {
                own()
            };
            all.insert(module, fs::read_to_string(&path).expect("a source"));
        }
    }
}

/// True for what is compiled for tests alone.
fn is_test(item: &syn::Item) -> bool {
    let attributes = match item {
        syn::Item::Mod(item) => &item.attrs,
        syn::Item::Use(item) => &item.attrs,
        syn::Item::Fn(item) => &item.attrs,
        _ => return false,
    };
    attributes
        .iter()
        .any(|a| a.to_token_stream().to_string().contains("cfg (test)"))
}

/// All paths below `prefix` that these tokens begin with: `a::b`, `{a, b::c}`. Returns the number of tokens read.
fn paths(tokens: &[TokenTree], prefix: &Module, found: &mut Vec<Module>) -> usize {
    match tokens.first() {
        Some(TokenTree::Ident(name)) => {
            let path = [&prefix[..], &[name.to_string()]].concat();
            let colons = tokens[1..].iter().take(2);
            let goes_on = colons.filter(|t| t.to_string() == ":").count() == 2;
            match goes_on {
                true => 3 + paths(&tokens[3..], &path, found),
                false => {
                    found.push(path);
                    1
                }
            }
        }
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
            let inner: Vec<TokenTree> = group.stream().into_iter().collect();
            for part in inner.split(|t| t.to_string() == ",") {
                paths(part, prefix, found);
            }
            1
        }
        _ => {
            found.push(prefix.clone());
            0
        }
    }
}

/// The paths in tokens that begin at the root of the crate or at a module nearby. The second result is true if a macro
/// makes paths from names it is given.
fn all_paths(tokens: TokenStream, found: &mut Vec<Module>) -> bool {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let (mut i, mut makes_paths) = (0, false);
    while i < tokens.len() {
        let word = tokens[i].to_string();
        match &tokens[i] {
            TokenTree::Ident(_) if ["crate", "super", "self"].contains(&word.as_str()) => {
                i += paths(&tokens[i..], &Vec::new(), found).max(1);
                continue;
            }
            TokenTree::Group(group) => makes_paths |= all_paths(group.stream(), found),
            _ => {}
        }
        let after: String = tokens[i..]
            .iter()
            .take(4)
            .map(ToString::to_string)
            .collect();
        makes_paths |= after.starts_with('$') && after.ends_with("::");
        i += 1;
    }
    makes_paths
}

/// The module that a path leads to, if it is one of the crate's.
fn target(from: &Module, path: &Module, all: &BTreeMap<Module, String>) -> Option<Module> {
    let mut base = from.clone();
    let mut rest = &path[..];
    match rest.first()?.as_str() {
        "crate" => {
            base.clear();
            rest = &rest[1..];
        }
        "self" => rest = &rest[1..],
        "super" => {
            while rest.first().is_some_and(|word| word == "super") {
                base.pop()?;
                rest = &rest[1..];
            }
        }
        _ => {}
    }
    // `pub(crate)` names no file
    rest.first()?;
    let mut to = [&base[..], rest].concat();
    while !all.contains_key(&to) {
        to.pop()?;
    }
    (to != *from).then_some(to)
}

/// By module: the modules that it imports.
fn imports(all: &BTreeMap<Module, String>) -> BTreeMap<Module, BTreeSet<Module>> {
    let mut imports = BTreeMap::new();
    for (module, text) in all {
        let file = syn::parse_file(text).expect("the sources are Rust");
        let mut found = Vec::new();
        let mut makes_paths = false;
        for item in file.items.iter().filter(|item| !is_test(item)) {
            makes_paths |= all_paths(item.to_token_stream(), &mut found);
            if let syn::Item::Use(item) = item {
                let tokens: Vec<TokenTree> = item.tree.to_token_stream().into_iter().collect();
                let mut named = Vec::new();
                paths(&tokens, &Vec::new(), &mut named);
                let child = |path: &Module| all.contains_key(&[&module[..], &path[..1]].concat());
                found.extend(
                    named
                        .into_iter()
                        .filter(|path| !path.is_empty() && child(path)),
                );
            }
        }
        let mut to: BTreeSet<Module> = found
            .iter()
            .filter_map(|path| target(module, path, all))
            .collect();
        if makes_paths {
            let children = all
                .keys()
                .filter(|m| m.len() > module.len() && m.starts_with(module));
            to.extend(children.cloned());
        }
        imports.insert(module.clone(), to);
    }
    imports
}

/// The modules that can be reached from one.
fn reached(from: &Module, imports: &BTreeMap<Module, BTreeSet<Module>>) -> BTreeSet<Module> {
    let (mut reached, mut open) = (BTreeSet::new(), vec![from.clone()]);
    while let Some(module) = open.pop() {
        for next in &imports[&module] {
            if reached.insert(next.clone()) {
                open.push(next.clone());
            }
        }
    }
    reached
}

/// The circles, the modules of each in order.
fn circles(imports: &BTreeMap<Module, BTreeSet<Module>>) -> BTreeSet<Vec<Module>> {
    let reached: BTreeMap<&Module, BTreeSet<Module>> =
        imports.keys().map(|m| (m, reached(m, imports))).collect();
    let circle = |m: &&Module| -> Vec<Module> {
        let others = reached[*m].iter();
        others
            .filter(|other| reached[other].contains(*m))
            .cloned()
            .collect()
    };
    let circles = reached.keys().map(circle);
    circles.filter(|circle| circle.len() > 1).collect()
}

#[test]
fn circles_of_files_are_small_and_in_one_room() {
    let mut all = BTreeMap::new();
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    modules(&sources, &Vec::new(), &mut all);
    assert!(all.len() > 200, "the sources of the generator");
    let circles = circles(&imports(&all));
    assert!(
        !circles.is_empty(),
        "rooms whose files share a type have circles"
    );
    for circle in circles {
        let names: Vec<String> = circle.iter().map(|module| module.join("/")).collect();
        assert!(
            circle.len() <= LARGEST,
            "a circle of {}: {names:?}",
            circle.len()
        );
        let rooms: BTreeSet<Option<&String>> = circle.iter().map(|m| m.first()).collect();
        assert!(rooms.len() == 1, "a circle across rooms: {names:?}");
    }
}

/// What the test above sees: each way in which a file can name another.
#[test]
fn each_way_to_name_a_module_is_an_import() {
    let texts = [
        ("a", "use crate::b::{self, c::D}; mod tests { }"),
        ("b", "pub use c::D; fn f() { super::e::g(); }"),
        ("b/c", "pub struct D(crate::e::G);"),
        (
            "e",
            "macro_rules! all { ($($x:ident)*) => { $(pub use self::$x::Y;)* } }",
        ),
        ("e/h", "#[cfg(test)] mod t { use crate::a; } pub struct Y;"),
    ];
    let module = |path: &str| path.split('/').map(str::to_owned).collect::<Module>();
    let all = texts.map(|(path, text)| (module(path), text.to_owned()));
    let found = imports(&all.into_iter().collect());
    let of =
        |path: &str| -> Vec<String> { found[&module(path)].iter().map(|m| m.join("/")).collect() };
    assert_eq!(of("a"), ["b", "b/c"]);
    assert_eq!(of("b"), ["b/c", "e"]);
    assert_eq!(of("b/c"), ["e"]);
    assert_eq!(of("e"), ["e/h"]);
    assert!(of("e/h").is_empty());
}
