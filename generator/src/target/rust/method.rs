//! Writes a method as Rust: as a whole or in pieces.

use super::expression::ident;
use super::function::{Writer, with_body};
use super::library::Library;
use super::naming::Naming;
use super::results;
use crate::expression::count::Table;
use crate::method::Start;
use crate::method::inputs::{Argument, Inputs};
use crate::method::results::Results;
use crate::method::table::Specification;
use crate::program::Options;
use crate::program::order::Order;
use crate::program::plan::Procedure;
use crate::program::schedule::Schedule;
use crate::program::split::pieces;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::borrow::Cow;
use std::collections::BTreeSet;
use syn::{Block, ImplItemFn, parse_quote};

/// The name of a method in the generated text. If the trait `Model` has a method of the same name that takes the whole
/// state, this method would hide it. Its name then ends in `_at`, as it is evaluated at the parts of a state:
/// `outputs_at(t, q, v)`.
pub(crate) fn method_name(method: &Specification) -> String {
    match method.of_parts {
        true => format!("{}_at", method.name),
        false => method.name.to_string(),
    }
}

/// True for the constructor, which has no receiver but makes a mechanism from parameters.
pub(crate) fn constructs(method: &Specification) -> bool {
    method.results == Results::Mechanism
}

/// A method as text.
pub(crate) struct Function {
    pub name: Cow<'static, str>,
    /// The pieces of the method, if it has any, and the method.
    pub methods: Vec<ImplItemFn>,
    /// The structs that the pieces return.
    pub structs: Vec<TokenStream>,
    /// The number of operations, by section.
    pub operations: Table,
}

/// Writes a method; a long method in pieces.
pub(crate) fn write(
    procedure: Procedure,
    inputs: &Inputs,
    library: &Library,
    options: &Options,
) -> Function {
    let Procedure {
        method,
        graph,
        roots,
    } = procedure;
    let (labels, results) = (&method.labels, method.results);
    let puts = results.one_by_one();
    let schedule = Schedule::new(graph, roots, labels, inputs, Order::of(results), puts);
    let long = schedule.lines.len() > options.merged && !constructs(&method);
    let pieces = pieces(&schedule, options.statements);
    let (name, operations) = (
        method.name.clone(),
        Table::of(&schedule.graph, &schedule.roots),
    );
    let writer = Writer {
        names: Naming::new(&schedule, labels, inputs, &method.arguments),
        apart: long && pieces.len() > 1,
        method,
        schedule,
        pieces,
        inputs,
        library,
    };
    let (structs, methods) = writer.in_pieces();
    Function {
        name,
        methods,
        structs,
        operations,
    }
}

/// The method `method`, whose results are those that the method `of` writes, from the index on that the constant `from`
/// holds.
pub(crate) fn part_of(method: &Specification, of: &str, from: &str) -> Vec<ImplItemFn> {
    let (of, from) = (ident(of), ident(from));
    let given = method.arguments.iter().map(|a| ident(a.name()));
    let body = parse_quote!({
        self.#of(#(#given,)* &mut bryant_runtime::TailView::<_, #from>(writer));
    });
    let reads = method.arguments.iter().copied().collect();
    public_method(method, &reads, true, body)
}

/// The public method with this body, which reads these arguments. If results go to an output writer, there is a second
/// method around it.
pub(crate) fn public_method(
    method: &Specification,
    reads: &BTreeSet<Argument>,
    puts_any: bool,
    body: Block,
) -> Vec<ImplItemFn> {
    let name = ident(&method_name(method));
    let documentation = format!(" {}", method.documentation);
    let returned = results::returned(method.results);
    if constructs(method) {
        return vec![with_body(
            body,
            parse_quote! {
                #[doc = #documentation]
                #[inline(always)]
                pub fn #name(parameters: Parameters<T>) -> #returned {}
            },
        )];
    }
    let asked = method.start == Start::Accelerations;
    // a method that starts from v̇ computes them, a function is given them
    let computed = |argument: &Argument| asked && *argument == Argument::Accelerations;
    let arguments = method.arguments.iter().filter(|of| !computed(of));
    let given: Vec<_> = arguments.clone().map(|a| ident(a.name())).collect();
    let every = arguments.clone().map(|argument| argument.declaration(true));
    let arguments =
        arguments.map(|argument| argument.declaration(asked || reads.contains(argument)));
    let inline = (method.in_lanes || method.function.is_some()).then(|| quote!(#[inline(always)]));
    if let Results::Written { by, length } = method.results {
        debug_assert!(
            !asked,
            "nothing that is put into a writer starts from accelerations"
        );
        let by = ident(by);
        let writer = format_ident!("{}writer", if puts_any { "" } else { "_" });
        let in_array: Option<ImplItemFn> = length.map(|length| {
            let length = results::written_length(length);
            parse_quote! {
                #[doc = #documentation]
                #[inline(always)]
                pub fn #name(&self, #(#every),*) -> [T; #length] {
                    let mut found = [T::from_f64(0.0); #length];
                    self.#by(#(#given,)* &mut found);
                    found
                }
            }
        });
        let text = match length {
            Some(_) => format!(" [`Self::{name}`] one by one, each as soon as it is found."),
            None => documentation.clone(),
        };
        let one_by_one = with_body(
            body,
            parse_quote! {
                #[doc = #text]
                #[inline(always)]
                pub fn #by(&self, #(#arguments,)* #writer: &mut impl OutputWriter<T>) {}
            },
        );
        return in_array.into_iter().chain([one_by_one]).collect();
    }
    let mut written = with_body(
        body,
        parse_quote! {
            #[doc = #documentation]
            #inline
            pub fn #name(&self, #(#arguments),*) -> #returned {}
        },
    );
    if asked {
        written
            .block
            .stmts
            .insert(0, parse_quote!(let a = &self.accelerations(#(#given),*);));
    }
    vec![written]
}
