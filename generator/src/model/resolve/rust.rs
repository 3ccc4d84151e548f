//! Checks the Rust file of a user force: it is Rust, has the function, and uses the ports that the model gives it.
//!
//! The compiler checks types. The checks here need no compiler, and run before any code is generated: syntax,
//! signature, names that the model does not declare, and declared names that the file never uses.

use crate::diagnostic::{nearest, quoted, suggestion};
use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};
use quote::ToTokens;
use std::collections::HashSet;
use syn::{FnArg, GenericArgument, GenericParam, Item, ItemFn, Pat, PathArguments, Safety, Type};

/// Longest file \[bytes\].
const MAX_BYTES: usize = 256 << 10;
/// Deepest nesting of brackets.
const MAX_DEPTH: usize = 128;
/// Largest number of operator characters in a row.
const MAX_SIGNS: usize = 64;
/// Stack for the parser, which is recursive \[bytes\].
const STACK: usize = 512 << 20;

/// Names that the generated part of the module uses.
const TAKEN: [&str; 5] = ["Input", "Output", "input", "output", "scalars"];

/// The properties that a file must have.
pub struct Wanted<'a> {
    /// Name of the file in messages.
    pub file: &'a str,
    /// Name of the force.
    pub force: &'a str,
    /// Name of the function.
    pub function: &'a str,
    /// The declared names, as identifiers, by the field of `Input` that holds them ("points").
    pub names: &'a [(&'static str, Vec<String>)],
}

/// A problem in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The place of the problem.
    pub place: FaultPlace,
    /// The problem in words.
    pub message: String,
    /// A remedy.
    pub help: String,
}

/// The place of a problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FaultPlace {
    /// In the file: line and column, both from 1, and length in characters.
    File(usize, usize, usize),
    /// In the model: the key that names the function.
    Function,
    /// In the model: the entry of this kind, with this index.
    Name(&'static str, usize),
}

/// The problems of a file.
pub fn faults(text: &str, wanted: &Wanted<'_>) -> Vec<Fault> {
    // A thread of its own: it gets a large stack, as the parser is recursive, and its source positions are freed with
    // it.
    std::thread::scope(|scope| {
        std::thread::Builder::new()
            .stack_size(STACK)
            .spawn_scoped(scope, || checked(text, wanted))
            .ok()
            .and_then(|thread| thread.join().ok())
    })
    .unwrap_or_default()
}

/// The signature that a function must have.
pub fn signature(function: &str) -> String {
    format!("pub fn {function}<T: Real>(input: &Input<T>) -> Output<T>")
}

fn checked(text: &str, wanted: &Wanted<'_>) -> Vec<Fault> {
    match Source::parse(text, wanted) {
        Ok(source) => source.faults(wanted),
        Err(fault) => vec![*fault],
    }
}

struct Source {
    tokens: TokenStream,
    items: Vec<Item>,
}

impl Source {
    fn parse(text: &str, wanted: &Wanted<'_>) -> Result<Self, Box<Fault>> {
        let at = |place, message: String, help: &str| {
            Box::new(Fault {
                place,
                message,
                help: help.to_owned(),
            })
        };
        let file = quoted(wanted.file);
        if text.len() > MAX_BYTES {
            return Err(at(
                FaultPlace::File(1, 1, 1),
                format!("the file {file} is longer than {MAX_BYTES} bytes"),
                "a user force is one function with what it needs",
            ));
        }
        let not_rust = |error: String, span: Span| {
            let help = "look for a bracket or a semicolon that is missing here or above";
            at(place(span, 1), format!("this is not Rust: {error}"), help)
        };
        let tokens: TokenStream = text.parse().map_err(|e: proc_macro2::LexError| {
            let what = "a bracket, a quotation mark or a comment does not end, or begins nowhere";
            not_rust(what.to_owned(), e.span())
        })?;
        if let Some(span) = too_deep(&tokens) {
            return Err(at(
                place(span, 1),
                format!(
                    "brackets are nested more than {MAX_DEPTH} deep, or signs follow one another"
                ),
                "give parts of the formula names of their own",
            ));
        }
        let parsed = syn::parse_file(text).map_err(|e| not_rust(e.to_string(), e.span()))?;
        if parsed.shebang.is_some() {
            return Err(at(
                FaultPlace::File(1, 1, 2),
                "the file begins with `#!`, but it becomes a module".to_owned(),
                "remove the first line",
            ));
        }
        Ok(Source {
            tokens,
            items: parsed.items,
        })
    }

    fn faults(&self, wanted: &Wanted<'_>) -> Vec<Fault> {
        let mut faults = Vec::new();
        self.items(&mut faults);
        let function = self.function(wanted, &mut faults);
        if let Some(function) = function {
            let fits = fits(function);
            if !fits {
                let name = &function.sig.ident;
                faults.push(Fault {
                    place: place(name.span(), wanted.function.chars().count()),
                    message: format!(
                        "the function {} has another signature than a user force",
                        quoted(wanted.function)
                    ),
                    help: format!("write `{}`", signature(wanted.function)),
                });
            }
            faults.extend(undeclared(function, wanted));
            if fits && faults.is_empty() {
                faults.extend(self.unused(wanted));
            }
        }
        faults
    }

    /// Reports items that the module must not contain.
    fn items(&self, faults: &mut Vec<Fault>) {
        for item in &self.items {
            let ident = match item {
                Item::Struct(item) => &item.ident,
                Item::Enum(item) => &item.ident,
                Item::Union(item) => &item.ident,
                Item::Type(item) => &item.ident,
                Item::Trait(item) => &item.ident,
                Item::Mod(item) => &item.ident,
                // functions have a namespace apart from types
                Item::Fn(item) if item.sig.ident == "scalars" => &item.sig.ident,
                _ => continue,
            };
            let name = ident.to_string();
            let here = place(ident.span(), name.chars().count());
            if matches!(item, Item::Mod(item) if item.content.is_none()) {
                faults.push(Fault {
                    place: here,
                    message: format!("the module {} is in another file", quoted(&name)),
                    help: "a user force is one file: write the module here, in braces".to_owned(),
                });
            } else if TAKEN.contains(&name.as_str()) {
                faults.push(Fault {
                    place: here,
                    message: format!("{} is generated, and cannot be defined here", quoted(&name)),
                    help: "remove the definition, or give it another name".to_owned(),
                });
            }
        }
    }

    fn function(&self, wanted: &Wanted<'_>, faults: &mut Vec<Fault>) -> Option<&ItemFn> {
        let functions = || {
            self.items.iter().filter_map(|item| match item {
                Item::Fn(function) => Some(function),
                _ => None,
            })
        };
        let found = functions().find(|function| function.sig.ident == wanted.function);
        if found.is_none() {
            let names: Vec<String> = functions().map(|f| f.sig.ident.to_string()).collect();
            let near = nearest(wanted.function, names.iter().map(String::as_str));
            faults.push(Fault {
                place: FaultPlace::Function,
                message: format!(
                    "there is no function {} in {}",
                    quoted(wanted.function),
                    quoted(wanted.file)
                ),
                help: match near {
                    Some(near) => format!("did you mean {}?", quoted(near)),
                    None => format!(
                        "`bryant check MODEL --skeleton {}` prints one to begin with: `{} {{ … }}`",
                        wanted.force,
                        signature(wanted.function)
                    ),
                },
            });
        }
        found
    }

    /// Names in the model that the file never mentions.
    fn unused(&self, wanted: &Wanted<'_>) -> Vec<Fault> {
        let mut mentioned = HashSet::new();
        for_each_token(&self.tokens, &mut |token| {
            if let TokenTree::Ident(ident) = token {
                mentioned.insert(ident.to_string());
            }
        });
        let mut faults = Vec::new();
        for (kind, names) in wanted.names {
            for (index, name) in names.iter().enumerate() {
                if !mentioned.contains(name) {
                    faults.push(Fault {
                        place: FaultPlace::Name(kind, index),
                        message: format!("{} never mentions {}", quoted(wanted.file), quoted(name)),
                        help: match *kind {
                            "states" => format!(
                                "a state has a rate: `output.states.{name}.rate = …`; or remove it"
                            ),
                            kind => format!("it is there as `input.{kind}.{name}`; or remove it"),
                        },
                    });
                }
            }
        }
        faults
    }
}

/// True if a function has the signature `fn name<T: Real>(input: &Input<T>) -> Output<T>`.
fn fits(function: &ItemFn) -> bool {
    let signature = &function.sig;
    let plain = signature.asyncness.is_none()
        && !matches!(signature.safety, Safety::Unsafe(_))
        && signature.abi.is_none()
        && signature.variadic.is_none()
        && signature.generics.where_clause.is_none();
    let mut generics = signature.generics.params.iter();
    let (Some(GenericParam::Type(scalar)), None) = (generics.next(), generics.next()) else {
        return false;
    };
    let mut bounds = scalar.bounds.iter();
    let real = match (bounds.next(), bounds.next()) {
        (Some(syn::TypeParamBound::Trait(bound)), None) => {
            let last = bound.path.segments.last();
            last.is_some_and(|segment| segment.ident == "Real")
        }
        _ => false,
    };
    let mut inputs = signature.inputs.iter();
    let input = match (inputs.next(), inputs.next()) {
        (Some(FnArg::Typed(argument)), None) => match &*argument.ty {
            Type::Reference(reference) => {
                reference.mutability.is_none() && is_of(&reference.elem, "Input", &scalar.ident)
            }
            _ => false,
        },
        _ => false,
    };
    let output = match &signature.output {
        syn::ReturnType::Type(_, of) => is_of(of, "Output", &scalar.ident),
        syn::ReturnType::Default => false,
    };
    plain && real && input && output
}

/// True if a type is `name<scalar>`, with any path.
fn is_of(of: &Type, name: &str, scalar: &syn::Ident) -> bool {
    let Type::Path(path) = of else { return false };
    let Some(last) = path.path.segments.last() else {
        return false;
    };
    let PathArguments::AngleBracketed(arguments) = &last.arguments else {
        return false;
    };
    let mut arguments = arguments.args.iter();
    let (Some(GenericArgument::Type(Type::Path(argument))), None) =
        (arguments.next(), arguments.next())
    else {
        return false;
    };
    last.ident == name && argument.path.is_ident(scalar)
}

/// Names that the function reads from its input, or sets in its output, and that the model does not declare.
fn undeclared(function: &ItemFn, wanted: &Wanted<'_>) -> Vec<Fault> {
    let mut tokens = Vec::new();
    for_each_token(&function.to_token_stream(), &mut |token| {
        tokens.push(token.clone())
    });
    let word = |index: usize| match tokens.get(index) {
        Some(TokenTree::Ident(ident)) => Some(ident.to_string()),
        _ => None,
    };
    let sign = |index: usize, sign: char| matches!(tokens.get(index), Some(TokenTree::Punct(p)) if p.as_char() == sign);
    let mut roots = Vec::new();
    if let Some(FnArg::Typed(argument)) = function.sig.inputs.first()
        && let Pat::Ident(input) = &*argument.pat
    {
        roots.push(input.ident.to_string());
    }
    for index in 0..tokens.len() {
        let is = |offset: usize, text: &str| word(index + offset).as_deref() == Some(text);
        if is(0, "let") && is(1, "mut") && sign(index + 3, '=') && is(4, "Output") {
            roots.extend(word(index + 2));
        }
    }
    let mut faults = Vec::new();
    for index in 0..tokens.len() {
        let (Some(root), Some(kind), Some(name)) = (word(index), word(index + 2), word(index + 4))
        else {
            continue;
        };
        let path = sign(index + 1, '.') && sign(index + 3, '.');
        let field_of_field = index > 0 && sign(index - 1, '.');
        let known = wanted.names.iter().find(|(known, _)| *known == kind);
        if let (true, false, Some((kind, names))) = (path, field_of_field, known)
            && roots.contains(&root)
            && !names.contains(&name)
        {
            let names = names.iter().map(String::as_str);
            faults.push(Fault {
                place: place(tokens[index + 4].span(), name.chars().count()),
                message: format!(
                    "the user force {} has no {} among its {kind}",
                    quoted(wanted.force),
                    quoted(&name)
                ),
                help: suggestion(
                    &name,
                    names,
                    &format!("declare it in the model: `{kind}: {{ {name}: … }}`"),
                ),
            });
        }
    }
    faults
}

/// The place of a token.
fn place(span: Span, length: usize) -> FaultPlace {
    let start = span.start();
    FaultPlace::File(start.line.max(1), start.column + 1, length.max(1))
}

/// Visits all tokens in the order of the text, including those within groups. It is not recursive, so nesting may be
/// deep.
fn for_each_token(tokens: &TokenStream, visit: &mut dyn FnMut(&TokenTree)) {
    let mut open = vec![tokens.clone().into_iter()];
    while let Some(current) = open.last_mut() {
        match current.next() {
            Some(TokenTree::Group(group)) => open.push(group.stream().into_iter()),
            Some(token) => visit(&token),
            None => {
                open.pop();
            }
        }
    }
}

/// The place where brackets are nested too deep, or too many operator characters follow one another.
fn too_deep(tokens: &TokenStream) -> Option<Span> {
    let mut open = vec![tokens.clone().into_iter()];
    let mut signs = 0;
    while let Some(current) = open.last_mut() {
        match current.next() {
            Some(TokenTree::Group(group)) => {
                if open.len() > MAX_DEPTH && group.delimiter() != Delimiter::None {
                    return Some(group.span());
                }
                signs = 0;
                open.push(group.stream().into_iter());
            }
            Some(TokenTree::Punct(punct)) => {
                signs += 1;
                if signs > MAX_SIGNS {
                    return Some(punct.span());
                }
            }
            Some(_) => signs = 0,
            None => {
                open.pop();
            }
        }
    }
    None
}
