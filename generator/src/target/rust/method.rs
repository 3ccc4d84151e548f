//! What a method is to be, and the shape in which it is written: as a whole, in calls of what its like elements have in common, or in pieces.

use super::expression::ident;
use super::function::{Writer, with_body};
use super::library::Library;
use super::results::{Each, Results};
use crate::expression::count::Table;
use crate::expression::passes::{Rewritten, repeat};
use crate::expression::{Graph, NodeId};
use crate::method::inputs::{Argument, Inputs};
use crate::program::Options;
use crate::program::like::Sharing;
use crate::program::order::{Order, blocks_by_owner};
use crate::program::schedule::Schedule;
use crate::program::split::pieces;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::BTreeSet;
use syn::{Block, ImplItemFn, parse_quote};

/// What is evaluated over lanes. The instructions of wide registers are such only in functions that are compiled for them, which are
/// the runtime's: all that they call must be part of them. So are methods with a sink.
const INLINED: [&str; 9] = [
    "guards",
    "initial_auxiliaries",
    "initial_conditions",
    "initial_memory",
    "kinks",
    "onsets",
    "outputs",
    "renewed",
    "renewed_memory",
];

/// Methods that the trait `Model` has too, of the whole state instead of its parts. Ones of the mechanism's own would hide those, so their
/// names say that they are evaluated at parts of a state: `outputs_at(t, q, v)`.
const ALSO_OF_THE_TRAIT: [&str; 10] = [
    "coordinate_rates",
    "curves",
    "guards",
    "kinetic_energy",
    "kinks",
    "momentum",
    "onsets",
    "outputs",
    "powers",
    "external_wrench",
];

/// The name of a method in the text.
pub(crate) fn method_name(name: &str) -> String {
    match ALSO_OF_THE_TRAIT.contains(&name) {
        true => format!("{name}_at"),
        false => name.to_string(),
    }
}

/// What a method is to be.
pub(crate) struct Request<'a> {
    pub name: &'static str,
    /// Documentation, by lines.
    pub documentation: Vec<String>,
    /// What it is given.
    pub arguments: Vec<Argument>,
    /// True where it starts from accelerations: it computes them first.
    pub from_accelerations: bool,
    /// What it computes with.
    pub graph: Graph,
    /// What it computes.
    pub roots: Vec<NodeId>,
    /// Names for roots that have none, one per root.
    pub labels: Vec<String>,
    /// How the roots are handed back.
    pub results: Results<'a>,
}

/// A method as text.
pub(crate) struct Function {
    pub name: &'static str,
    /// The pieces of the method, if it has any, and the method.
    pub methods: Vec<ImplItemFn>,
    /// What the pieces hand on.
    pub structs: Vec<TokenStream>,
    /// What it costs, by section.
    pub operations: Table,
}

impl Request<'_> {
    /// Writes the method, in calls or in pieces if it is long.
    pub(crate) fn write(
        mut self,
        inputs: &Inputs,
        library: &Library,
        options: &Options,
    ) -> Function {
        let (graph, roots) = (
            std::mem::take(&mut self.graph),
            std::mem::take(&mut self.roots),
        );
        let order = match self.results.one_by_one() {
            true => Order::Need,
            false => Order::Section,
        };
        let schedule = self.schedule(graph, roots, inputs, order);
        match self.shared(&schedule, inputs, library, options) {
            Some(shared) => self.in_calls(shared, inputs, library),
            None => self.in_pieces(schedule, inputs, library, options),
        }
    }

    fn schedule(
        &self,
        graph: Graph,
        roots: Vec<NodeId>,
        inputs: &Inputs,
        order: Order,
    ) -> Schedule {
        let (labels, arguments) = (&self.labels, &self.arguments);
        let puts = self.results.one_by_one();
        Schedule::new(graph, roots, labels, inputs, arguments, order, puts)
    }

    /// The same in the order of elements, with what those have in common, if it is long and they have much. What is soon made of inputs is not
    /// handed from call to call.
    fn shared(
        &self,
        schedule: &Schedule,
        inputs: &Inputs,
        library: &Library,
        options: &Options,
    ) -> Option<(Schedule, Sharing)> {
        if !self.exceeds(schedule, options) {
            return None;
        }
        let blocks = blocks_by_owner(&schedule.graph, &schedule.roots);
        let Rewritten { graph, roots } = repeat(&schedule.graph, &schedule.roots, &blocks);
        let schedule = self.schedule(graph, roots, inputs, Order::Owner);
        let sharing = Sharing::of(&schedule, inputs, library)?;
        Some((schedule, sharing))
    }

    /// Whether it is too long to be one function.
    fn exceeds(&self, schedule: &Schedule, options: &Options) -> bool {
        schedule.lines.len() > options.merged && !self.constructs()
    }

    /// True for the method that has no receiver, but makes one from parameters.
    pub(crate) fn constructs(&self) -> bool {
        matches!(self.results, Results::Mechanism(_))
    }

    fn in_calls(
        self,
        (schedule, sharing): (Schedule, Sharing),
        inputs: &Inputs,
        library: &Library,
    ) -> Function {
        let (name, operations) = (self.name, Table::of(&schedule.graph, &schedule.roots));
        let mut writer = Writer {
            request: self,
            schedule,
            pieces: Vec::new(),
            apart: true,
            inputs,
            library,
        };
        let (structs, methods) = writer.in_calls(&sharing);
        Function {
            name,
            methods,
            structs,
            operations,
        }
    }

    fn in_pieces(
        self,
        schedule: Schedule,
        inputs: &Inputs,
        library: &Library,
        options: &Options,
    ) -> Function {
        let (name, operations) = (self.name, Table::of(&schedule.graph, &schedule.roots));
        let pieces = pieces(&schedule, options.statements);
        let writer = Writer {
            apart: self.exceeds(&schedule, options) && pieces.len() > 1,
            request: self,
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

    /// Puts the results of `of`, from an index on that is the constant of this name, into a sink, and is called as if it computed them.
    pub(crate) fn beyond(&self, of: &str, from: &str) -> Vec<ImplItemFn> {
        let (of, from) = (ident(of), ident(from));
        let given = self.arguments.iter().map(|a| ident(a.name()));
        let body = parse_quote!({
            self.#of(#(#given,)* &mut bryant_runtime::Beyond::<_, #from>(sink));
        });
        let reads = self.arguments.iter().copied().collect();
        self.method(&reads, true, body)
    }

    /// The public method around a body that reads these arguments; two where a sink takes what is computed, if there is anything.
    pub(crate) fn method(
        &self,
        reads: &BTreeSet<Argument>,
        puts_any: bool,
        body: Block,
    ) -> Vec<ImplItemFn> {
        let Request {
            name,
            documentation,
            arguments,
            ..
        } = self;
        let name = ident(&method_name(name));
        let documentation = documentation.iter().map(|line| format!(" {line}"));
        let returned = self.results.returned();
        if self.constructs() {
            return vec![with_body(
                body,
                parse_quote! {
                    #(#[doc = #documentation])*
                    #[inline(always)]
                    pub fn #name(parameters: Parameters<T>) -> #returned {}
                },
            )];
        }
        let asked = self.from_accelerations;
        let arguments = arguments
            .iter()
            .filter(|&&argument| argument != Argument::Accelerations);
        let given: Vec<_> = arguments.clone().map(|a| ident(a.name())).collect();
        let every = arguments.clone().map(|argument| argument.declaration(true));
        let arguments =
            arguments.map(|argument| argument.declaration(asked || reads.contains(argument)));
        if let Results::Each(Each { method, length }) = self.results {
            debug_assert!(
                !asked,
                "nothing that is put into a sink starts from accelerations"
            );
            let method = ident(method);
            let sink = format_ident!("{}sink", if puts_any { "" } else { "_" });
            let in_array: Option<ImplItemFn> = length.map(|length| {
                let length = ident(length);
                parse_quote! {
                    #(#[doc = #documentation])*
                    #[inline(always)]
                    pub fn #name(&self, #(#every),*) -> [T; #length] {
                        let mut found = [T::from_f64(0.0); #length];
                        self.#method(#(#given,)* &mut found);
                        found
                    }
                }
            });
            let text = match length {
                Some(_) => format!(" [`Self::{name}`] one by one, each as soon as it is found."),
                None => format!(" {}", self.documentation.join("\n ")),
            };
            let one_by_one = with_body(
                body,
                parse_quote! {
                    #[doc = #text]
                    #[inline(always)]
                    pub fn #method(&self, #(#arguments,)* #sink: &mut impl Sink<T>) {}
                },
            );
            return in_array.into_iter().chain([one_by_one]).collect();
        }
        let inline = INLINED
            .contains(&self.name)
            .then(|| quote!(#[inline(always)]));
        let mut method = with_body(
            body,
            parse_quote! {
                #(#[doc = #documentation])*
                #inline
                pub fn #name(&self, #(#arguments),*) -> #returned {}
            },
        );
        if asked {
            method
                .block
                .stmts
                .insert(0, parse_quote!(let a = &self.accelerations(#(#given),*);));
        }
        vec![method]
    }
}
