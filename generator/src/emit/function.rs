//! From scheduled values to a method: arguments, one `let` per line, comments, results, and the pieces of what is too long.

use super::Options;
use super::comment;
use super::expression::{Printer, ident};
use super::inputs::{Argument, Inputs};
use super::library::Library;
use super::like::Sharing;
use super::names::camel;
use super::program::{Order, Program, Statement};
use super::results::Results;
use super::split::{Piece, pieces};
use super::syntax;
use crate::expression::count::Table;
use crate::expression::{Graph, Node, NodeId};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::BTreeSet;
use syn::{Block, ImplItemFn, Stmt, parse_quote};

/// What is evaluated over lanes. The instructions of wide registers are such only in functions that are compiled for them, which are
/// the runtime's: all that they call must be part of them. So are methods with a sink.
const INLINED: [&str; 8] = [
    "guards",
    "initial_auxiliaries",
    "initial_conditions",
    "initial_memory",
    "kinks",
    "outputs",
    "renewed",
    "renewed_memory",
];

/// What a method is to be.
pub(super) struct Request<'a> {
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
pub(super) struct Function {
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
    pub(super) fn write(
        mut self,
        inputs: &Inputs,
        library: &Library,
        options: &Options,
    ) -> Function {
        let limit = options.statements;
        let operations = Table::of(&self.graph, &self.roots);
        let graph = std::mem::take(&mut self.graph);
        let roots = std::mem::take(&mut self.roots);
        let puts = self.results.one_by_one();
        let scheduled = |graph, roots, order| {
            let (labels, arguments) = (&self.labels, &self.arguments);
            Program::new(graph, roots, labels, inputs, arguments, order, puts)
        };
        let mut program = scheduled(graph, roots, Order::BySection);
        let constructs = matches!(self.results, Results::Mechanism(_));
        let mut sharing = None;
        let long = program.lines.len() > options.merged && !constructs;
        if long {
            program = scheduled(program.graph, program.roots, Order::ByOwner);
            sharing = Sharing::of(&program, inputs, library);
            sharing = sharing.filter(|sharing| sharing.binding(&program) <= limit);
            if sharing.is_none() {
                program = scheduled(program.graph, program.roots, Order::BySection);
            }
        }
        let pieces = match sharing {
            Some(_) => Vec::new(),
            None => pieces(&program, limit),
        };
        let name = self.name;
        let mut writer = Writer {
            request: self,
            apart: long && pieces.len() > 1,
            program,
            pieces,
            inputs,
            library,
        };
        let (structs, methods) = match sharing {
            Some(sharing) => writer.in_calls(&sharing),
            None if writer.pieces.len() == 1 => (Vec::new(), writer.whole()),
            None => writer.in_pieces(),
        };
        Function {
            name,
            methods,
            structs,
            operations,
        }
    }
}

pub(super) struct Writer<'a> {
    pub request: Request<'a>,
    pub program: Program,
    pieces: Vec<Piece>,
    /// Whether the pieces are functions of their own, and not merged into one.
    apart: bool,
    pub inputs: &'a Inputs,
    pub library: &'a Library,
}

impl Writer<'_> {
    fn whole(&self) -> Vec<ImplItemFn> {
        let arguments = self.arguments(&self.pieces[0]);
        let body = self.body(0, &[]);
        self.method(&arguments, body)
    }

    /// What pieces hand on, and the pieces followed by the method that calls them.
    fn in_pieces(&self) -> (Vec<TokenStream>, Vec<ImplItemFn>) {
        let (mut structs, mut methods, mut calls) = (Vec::new(), Vec::new(), Vec::new());
        let mut all = BTreeSet::new();
        let last = self.pieces.len() - 1;
        for (i, piece) in self.pieces.iter().enumerate() {
            let arguments = self.arguments(piece);
            let sources = self.sources(piece);
            methods.push(self.piece(i, &arguments, &sources));
            calls.push(self.call(i, &arguments, &sources));
            if i < last && self.hands_on(i) {
                structs.push(self.handed_on(i));
            }
            if self.apart {
                structs.push(self.task(i, &arguments, &sources));
            }
            all.extend(arguments);
        }
        methods.extend(self.method(&all, parse_quote!({ #(#calls)* })));
        (structs, methods)
    }

    /// The public method around a body that reads these arguments; two where a sink takes what is computed.
    pub(super) fn method(&self, reads: &BTreeSet<Argument>, body: Block) -> Vec<ImplItemFn> {
        let Request {
            name,
            documentation,
            arguments,
            ..
        } = &self.request;
        let name = ident(name);
        let documentation = documentation.iter().map(|line| format!(" {line}"));
        let returned = self.request.results.returned();
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
        let asked = self.request.from_accelerations;
        let given: Vec<_> = self
            .request
            .arguments
            .iter()
            .filter(|&&argument| argument != Argument::Accelerations)
            .map(|argument| ident(argument.name()))
            .collect();
        let arguments = arguments
            .iter()
            .filter(|&&argument| argument != Argument::Accelerations);
        let every = arguments.clone().map(|argument| argument.declaration(true));
        let arguments =
            arguments.map(|argument| argument.declaration(asked || reads.contains(argument)));
        if let Results::Each(each, length) = self.request.results {
            debug_assert!(
                !asked,
                "nothing that is put into a sink starts from accelerations"
            );
            let (each, length) = (ident(each), ident(length));
            let sink = format_ident!(
                "{}sink",
                if self.program.roots.is_empty() {
                    "_"
                } else {
                    ""
                }
            );
            let text = format!(" [`Self::{name}`] one by one, each as soon as it is found.");
            return vec![
                parse_quote! {
                    #(#[doc = #documentation])*
                    #[inline(always)]
                    pub fn #name(&self, #(#every),*) -> [T; #length] {
                        let mut found = [T::from_f64(0.0); #length];
                        self.#each(#(#given,)* &mut found);
                        found
                    }
                },
                with_body(
                    body,
                    parse_quote! {
                        #[doc = #text]
                        #[inline(always)]
                        pub fn #each(&self, #(#arguments,)* #sink: &mut impl Sink<T>) {}
                    },
                ),
            ];
        }
        let inline = INLINED
            .contains(&self.request.name)
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

    /// One piece. Release builds merge it into its caller, or into its task.
    fn piece(&self, i: usize, arguments: &BTreeSet<Argument>, sources: &[usize]) -> ImplItemFn {
        let name = format_ident!("{}_part_{}", self.request.name, i + 1);
        let (number, of) = (i + 1, self.pieces.len());
        let text = format!(" Part {number} of {of} of `{}`.", self.request.name);
        let receiver = match self.constructs() {
            true => quote!(parameters: &Parameters<T>),
            false => quote!(&self),
        };
        let arguments = arguments.iter().map(|argument| argument.declaration(true));
        let parts = sources.iter().map(|&part| {
            let (part, of) = (part_name(part), self.part_type(part));
            quote!(#part: &#of<T>)
        });
        let sink = self.puts(i).then(|| quote!(, sink: &mut impl Sink<T>));
        let returned = arrow(&self.returned(i));
        with_body(
            self.body(i, sources),
            parse_quote! {
                #[doc = #text]
                #[inline(always)]
                fn #name(#receiver #(, #arguments)* #(, #parts)* #sink) #returned {}
            },
        )
    }

    fn call(&self, i: usize, arguments: &BTreeSet<Argument>, sources: &[usize]) -> TokenStream {
        let name = format_ident!("{}_part_{}", self.request.name, i + 1);
        let arguments = arguments.iter().map(|argument| ident(argument.name()));
        let parts = sources.iter().map(|&part| part_name(part));
        let call = if self.constructs() {
            quote!(Self::#name(&parameters, #(#arguments,)* #(&#parts),*))
        } else if self.apart {
            let task = self.task_type(i);
            let parts = parts.map(|part| quote!(#part: &#part));
            let sink = self.puts(i).then(|| quote!(sink: &mut *sink));
            quote!(T::enable_apart(#task { mechanism: self, #(#arguments,)* #(#parts,)* #sink }))
        } else {
            let sink = self.puts(i).then(|| quote!(sink));
            quote!(self.#name(#(#arguments,)* #(&#parts,)* #sink))
        };
        if i + 1 == self.pieces.len() {
            return call;
        }
        if !self.hands_on(i) {
            return quote!(#call;);
        }
        let part = part_name(i);
        quote!(let #part = #call;)
    }

    /// The struct by which a piece is called as a function of its own.
    fn task(&self, i: usize, arguments: &BTreeSet<Argument>, sources: &[usize]) -> TokenStream {
        let piece = format_ident!("{}_part_{}", self.request.name, i + 1);
        let name = self.task_type(i);
        let fields: Vec<_> = arguments
            .iter()
            .map(|argument| ident(argument.name()))
            .collect();
        let types = arguments.iter().map(|argument| argument.borrowed());
        let parts: Vec<_> = sources.iter().map(|&part| part_name(part)).collect();
        let part_types = sources.iter().map(|&part| self.part_type(part));
        let returned = self.returned(i);
        let text = format!(" Part {} of `{}`, to be called.", i + 1, self.request.name);
        let SinkOfTask {
            generic,
            bound,
            field,
            value,
        } = SinkOfTask::of(self.puts(i));
        quote! {
            #[doc = #text]
            struct #name<'a, T #generic> {
                mechanism: &'a Mechanism<T>,
                #(#fields: #types,)*
                #(#parts: &'a #part_types<T>,)*
                #field
            }

            impl<T: Real #bound> bryant_runtime::Task for #name<'_, T #generic> {
                type Output = #returned;

                #[inline(always)]
                fn run(self) -> Self::Output {
                    self.mechanism.#piece(#(self.#fields,)* #(self.#parts,)* #value)
                }
            }
        }
    }

    /// Whether a piece hands anything over.
    fn puts(&self, i: usize) -> bool {
        let lines = &self.program.lines[self.pieces[i].lines.clone()];
        lines
            .iter()
            .any(|line| matches!(line.statement, Statement::Put(_)))
    }

    fn task_type(&self, i: usize) -> proc_macro2::Ident {
        format_ident!("{}Task{}", camel(self.request.name), i + 1)
    }

    /// What a piece returns.
    fn returned(&self, i: usize) -> TokenStream {
        if i + 1 == self.pieces.len() {
            return self.request.results.returned();
        }
        if !self.hands_on(i) {
            return quote!(());
        }
        let part = self.part_type(i);
        quote!(#part<T>)
    }

    /// Whether later pieces need anything of a piece, and not the sink alone.
    fn hands_on(&self, i: usize) -> bool {
        !self.pieces[i].passes_on.is_empty()
    }

    /// The struct that a piece returns.
    fn handed_on(&self, i: usize) -> TokenStream {
        let name = self.part_type(i);
        let fields = self.pieces[i]
            .passes_on
            .iter()
            .filter_map(|&id| self.program.name(id))
            .map(ident);
        let text = format!(" What part {} of `{}` hands on.", i + 1, self.request.name);
        quote! {
            #[doc = #text]
            struct #name<T> { #(#fields: T),* }
        }
    }

    fn part_type(&self, i: usize) -> proc_macro2::Ident {
        format_ident!("{}Part{}", camel(self.request.name), i + 1)
    }

    /// Which arguments a piece reads.
    fn arguments(&self, piece: &Piece) -> BTreeSet<Argument> {
        self.arguments_of(&piece.reads)
    }

    /// To which arguments values belong.
    pub(super) fn arguments_of(&self, reads: &BTreeSet<NodeId>) -> BTreeSet<Argument> {
        let symbols = reads
            .iter()
            .filter_map(|&id| match self.program.graph.node(id) {
                Node::Symbol(symbol) => Some(self.inputs.input(symbol)),
                _ => None,
            });
        symbols.filter_map(|input| input.argument()).collect()
    }

    /// From which earlier pieces a piece reads.
    fn sources(&self, piece: &Piece) -> Vec<usize> {
        let reads = |part: &Piece| part.passes_on.iter().any(|id| piece.reads.contains(id));
        (0..self.pieces.len())
            .filter(|&part| reads(&self.pieces[part]))
            .collect()
    }

    /// True for the method that has no receiver, but makes one from parameters.
    fn constructs(&self) -> bool {
        matches!(self.request.results, Results::Mechanism(_))
    }

    fn body(&self, i: usize, sources: &[usize]) -> Block {
        let piece = &self.pieces[i];
        let printer = Printer::new(&self.program, self.inputs, self.library, self.constructs());
        let lines = self.lines(piece, &printer);
        let result = if i + 1 == self.pieces.len() {
            self.request
                .results
                .written(&self.program, &printer, self.pieces.len() > 1)
        } else if self.hands_on(i) {
            self.hand_over(i)
        } else {
            TokenStream::new()
        };

        // Whether there are numbers is known only now.
        let num = printer
            .prints_numbers()
            .then(|| quote!(let num = T::from_f64;));
        let arrays = Argument::ARRAYS
            .iter()
            .filter_map(|&argument| self.destructure(&piece.reads, argument));
        let parts = sources.iter().map(|&source| self.take_over(piece, source));
        let mut body: Block = parse_quote!({ #num #(#arrays)* #(#parts)* });
        let end: Block = parse_quote!({ #result });
        body.stmts.extend(lines);
        body.stmts.extend(end.stmts);
        body
    }

    /// `let &Part { a, b, .. } = part;`: the values of an earlier piece that a piece reads.
    fn take_over(&self, piece: &Piece, source: usize) -> TokenStream {
        let passed = &self.pieces[source].passes_on;
        let read = passed.iter().filter(|id| piece.reads.contains(id));
        let names: Vec<_> = read
            .filter_map(|&id| self.program.name(id))
            .map(ident)
            .collect();
        let rest = (names.len() < passed.len()).then(|| quote!(..));
        let (part, of) = (part_name(source), self.part_type(source));
        quote!(let &#of { #(#names,)* #rest } = #part;)
    }

    /// `let &[_, z, ..] = q;`: the elements that a piece reads, by name.
    pub(super) fn destructure(
        &self,
        reads: &BTreeSet<NodeId>,
        argument: Argument,
    ) -> Option<TokenStream> {
        let mut names: Vec<Option<&str>> = vec![None; self.inputs.length(argument)];
        for &id in reads {
            if let Node::Symbol(symbol) = self.program.graph.node(id)
                && let Some((of, index)) = self.inputs.input(symbol).element()
                && of == argument
            {
                names[index] = self.program.name(id);
            }
        }
        if names.iter().all(Option::is_none) {
            return None;
        }
        // The longest run of what is not read becomes `..`.
        let run = |start: usize| {
            names[start..]
                .iter()
                .take_while(|name| name.is_none())
                .count()
        };
        let longest =
            (0..names.len()).max_by_key(|&start| (run(start), std::cmp::Reverse(start)))?;
        let skipped = if run(longest) > 1 {
            longest..longest + run(longest)
        } else {
            0..0
        };
        let patterns = names
            .iter()
            .enumerate()
            .filter_map(|(index, name)| match name {
                Some(name) => {
                    let name = ident(name);
                    Some(quote!(#name))
                }
                None if index == skipped.start && !skipped.is_empty() => Some(quote!(..)),
                None if skipped.contains(&index) => None,
                None => Some(quote!(_)),
            });
        let array = ident(argument.name());
        Some(quote!(let &[#(#patterns),*] = #array;))
    }

    fn lines(&self, piece: &Piece, printer: &Printer<'_>) -> Vec<Stmt> {
        let sections = self.program.graph.sections();
        let mut current = None;
        let lines = self.program.lines[piece.lines.clone()].iter().map(|line| {
            let comment = line
                .begins(&mut current)
                .map(|section| sections[section].as_str());
            let name = |id| self.program.name(id).map(str::to_owned);
            self.line(line.statement, comment, printer, name)
        });
        lines.collect()
    }

    /// `let name = formula;` or `sink.put(place, formula);`, under a comment.
    pub(super) fn line(
        &self,
        statement: Statement,
        comment: Option<&str>,
        printer: &Printer<'_>,
        name: impl Fn(NodeId) -> Option<String>,
    ) -> Stmt {
        if let Statement::Put(_) = statement {
            return syntax::does(printer.statement(statement));
        }
        let comment = comment.and_then(comment::marked);
        let bindings = self.program.bindings(statement);
        let mut patterns = bindings
            .iter()
            .map(|id| syntax::binding(id.and_then(&name).as_deref()));
        let pattern = match statement {
            Statement::Value(_) => patterns.next(),
            Statement::SinCos { .. } => patterns
                .next()
                .zip(patterns.next())
                .map(|(s, c)| syntax::pair(s, c)),
            Statement::Results(_) | Statement::Put(_) => None,
        };
        let pattern = pattern.unwrap_or_else(|| syntax::array_pattern(patterns));
        syntax::binds(comment, pattern, printer.statement(statement))
    }

    fn hand_over(&self, i: usize) -> TokenStream {
        let of = self.part_type(i);
        let fields = self.pieces[i]
            .passes_on
            .iter()
            .filter_map(|&id| self.program.name(id))
            .map(ident);
        quote!(#of { #(#fields),* })
    }
}

/// The parts of a task that are about a sink.
#[derive(Default)]
pub(super) struct SinkOfTask {
    pub generic: TokenStream,
    pub bound: TokenStream,
    pub field: TokenStream,
    pub value: TokenStream,
}

impl SinkOfTask {
    /// All empty where it has none.
    pub(super) fn of(puts: bool) -> Self {
        match puts {
            true => SinkOfTask {
                generic: quote!(, S),
                bound: quote!(, S: Sink<T>),
                field: quote!(sink: &'a mut S,),
                value: quote!(self.sink),
            },
            false => Self::default(),
        }
    }
}

/// `-> Type`, or nothing.
pub(super) fn arrow(returned: &TokenStream) -> TokenStream {
    match returned.to_string().as_str() {
        "()" => TokenStream::new(),
        _ => quote!(-> #returned),
    }
}

/// A method with this body.
pub(super) fn with_body(body: Block, mut method: ImplItemFn) -> ImplItemFn {
    method.block = body;
    method
}

fn part_name(i: usize) -> proc_macro2::Ident {
    format_ident!("part_{}", i + 1)
}
