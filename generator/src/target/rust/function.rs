//! Writes a scheduled method: arguments, one `let` per line, comments, results, and pieces if the method is long.

use super::comment;
use super::expression::{Printer, ident};
use super::library::Library;
use super::method::{constructs, public_method};
use super::naming::Naming;
use super::results;
use super::syntax;
use crate::expression::{Node, NodeId};
use crate::method::inputs::{Argument, Inputs};
use crate::method::table::Specification;
use crate::names::camel;
use crate::program::schedule::{Line, Schedule, Statement};
use crate::program::split::Piece;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::BTreeSet;
use syn::{Attribute, Block, ImplItemFn, Stmt, parse_quote};

/// A method that is about to be written.
pub(crate) struct Writer<'a> {
    pub method: Specification,
    pub schedule: Schedule,
    pub names: Naming,
    /// The pieces of the method; a single one if it is short.
    pub pieces: Vec<Piece>,
    /// True if the pieces remain functions of their own, false if the compiler merges them into one.
    pub apart: bool,
    pub inputs: &'a Inputs,
    pub library: &'a Library,
}

impl Writer<'_> {
    /// The structs that pieces return, and the pieces followed by the method that calls them. If there is only one
    /// piece, the method alone.
    pub(crate) fn in_pieces(&self) -> (Vec<TokenStream>, Vec<ImplItemFn>) {
        if let [piece] = &self.pieces[..] {
            let arguments = self.arguments(piece);
            return (Vec::new(), self.method(&arguments, self.body(0, &[])));
        }
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

    fn printer(&self) -> Printer<'_> {
        let of_parameters = constructs(&self.method);
        Printer::new(
            &self.schedule,
            &self.names,
            self.inputs,
            self.library,
            of_parameters,
        )
    }

    /// The public method with this body. `reads` are the arguments that the body reads.
    fn method(&self, reads: &BTreeSet<Argument>, body: Block) -> Vec<ImplItemFn> {
        let puts_any = !self.schedule.roots.is_empty();
        public_method(&self.method, reads, puts_any, body)
    }

    /// One piece as a method. Release builds inline it into its caller, or into its task.
    fn piece(&self, i: usize, arguments: &BTreeSet<Argument>, sources: &[usize]) -> ImplItemFn {
        let name = format_ident!("{}_part_{}", self.method.name, i + 1);
        let (number, of) = (i + 1, self.pieces.len());
        let text = format!(" Part {number} of {of} of `{}`.", self.method.name);
        let receiver = match constructs(&self.method) {
            true => quote!(parameters: &Parameters<T>),
            false => quote!(&self),
        };
        let arguments = arguments.iter().map(|argument| argument.declaration(true));
        let parts = sources.iter().map(|&part| {
            let (part, of) = (part_name(part), self.part_type(part));
            quote!(#part: &#of<T>)
        });
        let writer = self
            .puts(i)
            .then(|| quote!(, writer: &mut impl OutputWriter<T>));
        let returned = arrow(&self.returned(i));
        with_body(
            self.body(i, sources),
            parse_quote! {
                #[doc = #text]
                #[inline(always)]
                fn #name(#receiver #(, #arguments)* #(, #parts)* #writer) #returned {}
            },
        )
    }

    fn call(&self, i: usize, arguments: &BTreeSet<Argument>, sources: &[usize]) -> TokenStream {
        let name = format_ident!("{}_part_{}", self.method.name, i + 1);
        let arguments = arguments.iter().map(|argument| ident(argument.name()));
        let parts = sources.iter().map(|&part| part_name(part));
        let call = if constructs(&self.method) {
            quote!(Self::#name(&parameters, #(#arguments,)* #(&#parts),*))
        } else if self.apart {
            let task = self.task_type(i);
            let parts = parts.map(|part| quote!(#part: &#part));
            let writer = self.puts(i).then(|| quote!(writer: &mut *writer));
            quote!(T::dispatch_apart(#task { mechanism: self, #(#arguments,)* #(#parts,)* #writer }))
        } else {
            let writer = self.puts(i).then(|| quote!(writer));
            quote!(self.#name(#(#arguments,)* #(&#parts,)* #writer))
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

    /// The struct (a `Task`) through which a piece is called as a function of its own.
    fn task(&self, i: usize, arguments: &BTreeSet<Argument>, sources: &[usize]) -> TokenStream {
        let piece = format_ident!("{}_part_{}", self.method.name, i + 1);
        let name = self.task_type(i);
        let fields: Vec<_> = arguments
            .iter()
            .map(|argument| ident(argument.name()))
            .collect();
        let types = arguments.iter().map(|argument| argument.borrowed());
        let parts: Vec<_> = sources.iter().map(|&part| part_name(part)).collect();
        let part_types = sources.iter().map(|&part| self.part_type(part));
        let returned = self.returned(i);
        let text = format!(" Part {} of `{}`, to be called.", i + 1, self.method.name);
        let WriterOfTask {
            generic,
            bound,
            field,
            value,
        } = WriterOfTask::of(self.puts(i));
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

    /// True if a piece puts results into the writer.
    fn puts(&self, i: usize) -> bool {
        let lines = &self.schedule.lines[self.pieces[i].lines.clone()];
        lines
            .iter()
            .any(|line| matches!(line.statement, Statement::Put(_)))
    }

    fn task_type(&self, i: usize) -> proc_macro2::Ident {
        format_ident!("{}Task{}", camel(&self.method.name), i + 1)
    }

    /// The type that a piece returns.
    fn returned(&self, i: usize) -> TokenStream {
        if i + 1 == self.pieces.len() {
            return results::returned(self.method.results);
        }
        if !self.hands_on(i) {
            return quote!(());
        }
        let part = self.part_type(i);
        quote!(#part<T>)
    }

    /// True if later pieces need values of this piece.
    fn hands_on(&self, i: usize) -> bool {
        !self.pieces[i].passes_on.is_empty()
    }

    /// The struct of the values that a piece returns.
    fn handed_on(&self, i: usize) -> TokenStream {
        let name = self.part_type(i);
        let fields = self.pieces[i]
            .passes_on
            .iter()
            .filter_map(|&id| self.names.of(id))
            .map(ident);
        let text = format!(" What part {} of `{}` hands on.", i + 1, self.method.name);
        quote! {
            #[doc = #text]
            struct #name<T> { #(#fields: T),* }
        }
    }

    fn part_type(&self, i: usize) -> proc_macro2::Ident {
        format_ident!("{}Part{}", camel(&self.method.name), i + 1)
    }

    /// The arguments that a piece reads.
    fn arguments(&self, piece: &Piece) -> BTreeSet<Argument> {
        let symbols = piece
            .reads
            .iter()
            .filter_map(|&id| match self.schedule.graph.node(id) {
                Node::Symbol(symbol) => Some(self.inputs.input(symbol)),
                _ => None,
            });
        symbols.filter_map(|input| input.argument()).collect()
    }

    /// The indices of the earlier pieces whose values a piece reads.
    fn sources(&self, piece: &Piece) -> Vec<usize> {
        let reads = |part: &Piece| part.passes_on.iter().any(|id| piece.reads.contains(id));
        (0..self.pieces.len())
            .filter(|&part| reads(&self.pieces[part]))
            .collect()
    }

    fn body(&self, i: usize, sources: &[usize]) -> Block {
        let piece = &self.pieces[i];
        let printer = self.printer();
        let lines = self.lines(piece, &printer);
        let result = if i + 1 == self.pieces.len() {
            let pieces = self.pieces.len() > 1;
            let results = self.method.results;
            results::written(results, &self.schedule, self.inputs, &printer, pieces)
        } else if self.hands_on(i) {
            self.hand_over(i)
        } else {
            TokenStream::new()
        };

        // Only now is it known whether numbers were printed.
        let num = printer
            .prints_numbers()
            .then(|| quote!(let num = T::from_f64;));
        let at_top = Argument::ARRAYS.iter().filter(|_| !self.reads_late());
        let arrays = at_top.filter_map(|&argument| self.destructure(&piece.reads, argument));
        let parts = sources.iter().map(|&source| self.take_over(piece, source));
        let mut body: Block = parse_quote!({ #num #(#arrays)* #(#parts)* });
        let end: Block = parse_quote!({ #result });
        body.stmts.extend(lines);
        body.stmts.extend(end.stmts);
        body
    }

    /// `let &Part { a, b, .. } = part;`: takes the values that a piece reads from an earlier piece.
    fn take_over(&self, piece: &Piece, source: usize) -> TokenStream {
        let passed = &self.pieces[source].passes_on;
        let read = passed.iter().filter(|id| piece.reads.contains(id));
        let names: Vec<_> = read
            .filter_map(|&id| self.names.of(id))
            .map(ident)
            .collect();
        let rest = (names.len() < passed.len()).then(|| quote!(..));
        let (part, of) = (part_name(source), self.part_type(source));
        quote!(let &#of { #(#names,)* #rest } = #part;)
    }

    /// `let &[_, z, ..] = q;`: names the elements of an argument that a piece reads.
    fn destructure(&self, reads: &BTreeSet<NodeId>, argument: Argument) -> Option<TokenStream> {
        let mut names: Vec<Option<&str>> = vec![None; self.inputs.length(argument)];
        for &id in reads {
            if let Node::Symbol(symbol) = self.schedule.graph.node(id)
                && let Some((of, index)) = self.inputs.input(symbol).element()
                && of == argument
            {
                names[index] = self.names.of(id);
            }
        }
        if names.iter().all(Option::is_none) {
            return None;
        }
        // The longest run of unread elements becomes `..`.
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

    /// True if inputs are read just before their first use, instead of at the top. For all a compiler knows, the memory
    /// that a writer writes may overlap the inputs, so it never moves the reading of an input past a write. Inputs that
    /// are read at the top would all have to be kept in memory until their use.
    fn reads_late(&self) -> bool {
        self.method.results.one_by_one()
    }

    fn lines(&self, piece: &Piece, printer: &Printer<'_>) -> Vec<Stmt> {
        let sections = self.schedule.graph.sections();
        let lines = &self.schedule.lines[piece.lines.clone()];
        let mut current = None;
        let comments: Vec<Option<&str>> = lines
            .iter()
            .map(|line| line.begins(&mut current))
            .map(|section| section.map(|section| sections[section].as_str()))
            .collect();
        // Late inputs are read at the beginning of each section, except an input that is itself a result: it is read
        // just before it is put into the writer.
        let reads = |number: usize| {
            let leaf = |place: usize| {
                self.schedule
                    .graph
                    .node(self.schedule.roots[place])
                    .is_leaf()
            };
            let put = matches!(lines[number].statement, Statement::Put(place) if leaf(place));
            number == 0 || comments[number].is_some() || put
        };
        let mut read = BTreeSet::new();
        let mut written = Vec::new();
        for (number, line) in lines.iter().enumerate() {
            let mut comment = comments[number];
            if self.reads_late() && reads(number) {
                let end = (number + 1..lines.len()).find(|&next| reads(next));
                let lines = &lines[number..end.unwrap_or(lines.len())];
                for elements in self.elements_read(lines, &mut read) {
                    let comment = comment.take().and_then(comment::marked);
                    written.push(self.reading(&elements, comment));
                }
            }
            written.push(self.line(line.statement, comment, printer));
        }
        written
    }

    /// The elements of arguments that the lines read and that `read` does not contain yet, grouped by argument. Adds
    /// them to `read`.
    fn elements_read(&self, lines: &[Line], read: &mut BTreeSet<NodeId>) -> Vec<Vec<Element>> {
        let mut found = BTreeSet::new();
        for line in lines {
            for id in self.schedule.needs(line.statement) {
                self.schedule.reads(id, &mut found);
            }
        }
        let element = |&id: &NodeId| match self.schedule.graph.node(id) {
            Node::Symbol(symbol) => self.inputs.input(symbol).element(),
            _ => None,
        };
        let elements = found
            .into_iter()
            .filter_map(|id| element(&id).map(|(argument, index)| (argument, index, id)));
        let mut new: Vec<Element> = elements.filter(|&(.., id)| read.insert(id)).collect();
        new.sort_unstable();
        let by_argument = new.chunk_by(|a, b| a.0 == b.0);
        by_argument.map(<[_]>::to_vec).collect()
    }

    /// `let [a, b] = [q[7], q[8]];`
    fn reading(&self, elements: &[Element], comment: Option<Attribute>) -> Stmt {
        let pattern = |&(.., id): &Element| syntax::binding(self.names.of(id));
        let value = |&(argument, index, _): &Element| syntax::element(argument.name(), index);
        match elements {
            [one] => syntax::binds(comment, pattern(one), value(one)),
            _ => {
                let patterns = syntax::array_pattern(elements.iter().map(pattern));
                syntax::binds(comment, patterns, syntax::array(elements.iter().map(value)))
            }
        }
    }

    /// `let name = formula;` or `writer.put(place, formula);`, with a comment above it.
    fn line(&self, statement: Statement, comment: Option<&str>, printer: &Printer<'_>) -> Stmt {
        if let Statement::Put(_) = statement {
            return syntax::does(printer.statement(statement));
        }
        let comment = comment.and_then(comment::marked);
        let bindings = self.schedule.results_by_place(statement);
        let mut patterns = bindings
            .iter()
            .map(|id| syntax::binding(id.and_then(|id| self.names.of(id))));
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
            .filter_map(|&id| self.names.of(id))
            .map(ident);
        quote!(#of { #(#fields),* })
    }
}

/// An element of an argument: the argument, the index in it, and the node of the input.
type Element = (Argument, usize, NodeId);

/// The parts of the declaration of a task that concern the writer.
#[derive(Default)]
struct WriterOfTask {
    generic: TokenStream,
    bound: TokenStream,
    field: TokenStream,
    value: TokenStream,
}

impl WriterOfTask {
    /// The parts for a task with a writer; all are empty if the task puts no results.
    fn of(puts: bool) -> Self {
        match puts {
            true => WriterOfTask {
                generic: quote!(, S),
                bound: quote!(, S: OutputWriter<T>),
                field: quote!(writer: &'a mut S,),
                value: quote!(self.writer),
            },
            false => Self::default(),
        }
    }
}

/// `-> Type`; nothing for `()`.
fn arrow(returned: &TokenStream) -> TokenStream {
    match returned.to_string().as_str() {
        "()" => TokenStream::new(),
        _ => quote!(-> #returned),
    }
}

/// A method with this body.
pub(crate) fn with_body(body: Block, mut method: ImplItemFn) -> ImplItemFn {
    method.block = body;
    method
}

fn part_name(i: usize) -> proc_macro2::Ident {
    format_ident!("part_{}", i + 1)
}
