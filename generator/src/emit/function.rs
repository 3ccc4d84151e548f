//! From scheduled values to a method: arguments, one `let` per line, comments, results, and the pieces of what is too long.

use super::comment;
use super::expression::{Printer, ident};
use super::inputs::{Argument, Inputs};
use super::library::Library;
use super::names::camel;
use super::program::{Program, Statement};
use super::split::{Piece, pieces};
use crate::expression::count::Table;
use crate::expression::{Graph, Node, NodeId};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeSet;

/// Rows up to which a matrix is written as a table.
const READABLE_ROWS: usize = 6;

/// What a method is to be.
pub(super) struct Request<'a> {
    pub name: &'static str,
    /// Documentation, by lines.
    pub documentation: Vec<String>,
    /// What it is given.
    pub arguments: &'static [Argument],
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

/// What a method returns.
#[derive(Clone, Copy)]
pub(super) enum Results<'a> {
    /// `[T; n]`, n being the constant of this name.
    Array(&'static str),
    /// `([T; COORDINATES], [T; VELOCITIES])`, this many in the first.
    Start(usize),
    /// A vector of nalgebra.
    Vector,
    /// A symmetric matrix of nalgebra with this many rows; the roots are its upper triangle, by rows.
    Matrix(usize),
    /// The mechanism itself, with these fields.
    Mechanism(&'a [String]),
}

/// A method as text.
pub(super) struct Function {
    pub name: &'static str,
    /// The pieces of the method, if it has any, and the method.
    pub methods: Vec<TokenStream>,
    /// What the pieces hand on.
    pub structs: Vec<TokenStream>,
    /// What it costs, by section.
    pub operations: Table,
}

impl Request<'_> {
    /// Writes the method, in pieces of at most `limit` lines if it is longer than that.
    pub(super) fn write(mut self, inputs: &Inputs, library: &Library, limit: usize) -> Function {
        let operations = Table::of(&self.graph, &self.roots);
        let graph = std::mem::take(&mut self.graph);
        let roots = std::mem::take(&mut self.roots);
        let program = Program::new(graph, roots, &self.labels, inputs, self.arguments);
        let pieces = pieces(&program, limit);
        let name = self.name;
        let writer = Writer {
            request: self,
            program,
            pieces,
            inputs,
            library,
        };
        let (structs, methods) = if writer.pieces.len() == 1 {
            (Vec::new(), vec![writer.whole()])
        } else {
            writer.in_pieces()
        };
        Function {
            name,
            methods,
            structs,
            operations,
        }
    }
}

struct Writer<'a> {
    request: Request<'a>,
    program: Program,
    pieces: Vec<Piece>,
    inputs: &'a Inputs,
    library: &'a Library,
}

impl Writer<'_> {
    fn whole(&self) -> TokenStream {
        let arguments = self.arguments(&self.pieces[0]);
        let body = self.body(0, &[]);
        self.method(&arguments, body)
    }

    /// What pieces hand on, and the pieces followed by the method that calls them.
    fn in_pieces(&self) -> (Vec<TokenStream>, Vec<TokenStream>) {
        let (mut structs, mut methods, mut calls) = (Vec::new(), Vec::new(), Vec::new());
        let mut all = BTreeSet::new();
        let last = self.pieces.len() - 1;
        for (i, piece) in self.pieces.iter().enumerate() {
            let arguments = self.arguments(piece);
            let sources = self.sources(piece);
            methods.push(self.piece(i, &arguments, &sources));
            calls.push(self.call(i, &arguments, &sources));
            if i < last {
                structs.push(self.hand_over(i));
            }
            all.extend(arguments);
        }
        methods.push(self.method(&all, quote!(#(#calls)*)));
        (structs, methods)
    }

    /// The public method around a body that reads these arguments.
    fn method(&self, reads: &BTreeSet<Argument>, body: TokenStream) -> TokenStream {
        let Request {
            name,
            documentation,
            arguments,
            ..
        } = &self.request;
        let name = ident(name);
        let documentation = documentation.iter().map(|line| format!(" {line}"));
        let returned = self.returned();
        if let Results::Mechanism(_) = self.request.results {
            return quote! {
                #(#[doc = #documentation])*
                pub fn #name(parameters: Parameters<T>) -> #returned { #body }
            };
        }
        let asked = self.request.from_accelerations;
        let accelerations = asked.then(|| quote!(let a = &self.accelerations(t, q, v);));
        let arguments = arguments
            .iter()
            .filter(|&&argument| argument != Argument::Accelerations);
        let arguments =
            arguments.map(|argument| argument.declaration(asked || reads.contains(argument)));
        quote! {
            #(#[doc = #documentation])*
            pub fn #name(&self, #(#arguments),*) -> #returned { #accelerations #body }
        }
    }

    /// One piece. Release builds merge it into its caller.
    fn piece(&self, i: usize, arguments: &BTreeSet<Argument>, sources: &[usize]) -> TokenStream {
        let name = format_ident!("{}_part_{}", self.request.name, i + 1);
        let text = format!(
            " Part {} of {} of `{}`.",
            i + 1,
            self.pieces.len(),
            self.request.name
        );
        let receiver = match self.request.results {
            Results::Mechanism(_) => quote!(parameters: &Parameters<T>),
            _ => quote!(&self),
        };
        let arguments = arguments.iter().map(|argument| argument.declaration(true));
        let parts = sources.iter().map(|&part| {
            let (part, of) = (part_name(part), self.part_type(part));
            quote!(#part: &#of<T>)
        });
        let returned = if i + 1 == self.pieces.len() {
            self.returned()
        } else {
            let part = self.part_type(i);
            quote!(#part<T>)
        };
        let body = self.body(i, sources);
        quote! {
            #[doc = #text]
            #[inline(always)]
            fn #name(#receiver #(, #arguments)* #(, #parts)*) -> #returned { #body }
        }
    }

    fn call(&self, i: usize, arguments: &BTreeSet<Argument>, sources: &[usize]) -> TokenStream {
        let name = format_ident!("{}_part_{}", self.request.name, i + 1);
        let arguments = arguments.iter().map(|argument| ident(argument.name()));
        let parts = sources.iter().map(|&part| part_name(part));
        let arguments = quote!(#(#arguments,)* #(&#parts),*);
        let call = match self.request.results {
            Results::Mechanism(_) => quote!(Self::#name(&parameters, #arguments)),
            _ => quote!(self.#name(#arguments)),
        };
        if i + 1 == self.pieces.len() {
            return call;
        }
        let part = part_name(i);
        quote!(let #part = #call;)
    }

    /// The struct that a piece returns.
    fn hand_over(&self, i: usize) -> TokenStream {
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
        let symbols = piece
            .reads
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

    fn body(&self, i: usize, sources: &[usize]) -> TokenStream {
        let piece = &self.pieces[i];
        let parameters = match self.request.results {
            Results::Mechanism(_) => quote!(parameters),
            _ => quote!(self.parameters),
        };
        let printer = Printer::new(&self.program, self.inputs, self.library, parameters);

        let arrays = Argument::ARRAYS
            .iter()
            .filter_map(|&argument| self.destructure(piece, argument));
        let parts = sources.iter().map(|&source| {
            let read = |id: &&NodeId| piece.reads.contains(id);
            let names = self.pieces[source]
                .passes_on
                .iter()
                .filter(read)
                .filter_map(|&id| self.program.name(id));
            let (part, of, names) = (part_name(source), self.part_type(source), names.map(ident));
            let rest = (!self.pieces[source]
                .passes_on
                .iter()
                .all(|id| piece.reads.contains(id)))
            .then(|| quote!(..));
            quote!(let &#of { #(#names,)* #rest } = #part;)
        });
        let prelude: Vec<TokenStream> = arrays.chain(parts).collect();
        let lines = self.lines(piece, &printer);
        let result = if i + 1 == self.pieces.len() {
            self.results(&printer)
        } else {
            self.hands_on(i)
        };
        // Known only now.
        let num = printer
            .prints_numbers()
            .then(|| quote!(let num = T::from_f64;));
        quote!(#num #(#prelude)* #(#lines)* #result)
    }

    /// `let &[_, z, ..] = q;`: the elements that a piece reads, by name.
    fn destructure(&self, piece: &Piece, argument: Argument) -> Option<TokenStream> {
        let mut names: Vec<Option<&str>> = vec![None; self.inputs.length(argument)];
        for &id in &piece.reads {
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

    fn lines(&self, piece: &Piece, printer: &Printer<'_>) -> Vec<TokenStream> {
        let sections = self.program.graph.sections();
        let mut current = None;
        let lines = self.program.lines[piece.lines.clone()].iter().map(|line| {
            let new = current != Some(line.section);
            current = Some(line.section);
            let comment = new.then(|| comment::marked(&sections[line.section]));
            let statement = self.line(line.statement, printer);
            quote!(#comment #statement)
        });
        lines.collect()
    }

    fn line(&self, statement: Statement, printer: &Printer<'_>) -> TokenStream {
        let name = |id: NodeId| match self.program.name(id) {
            Some(name) => {
                let name = ident(name);
                quote!(#name)
            }
            None => quote!(_),
        };
        match statement {
            Statement::Value(id) => {
                let (name, formula) = (name(id), printer.formula(id));
                quote!(let #name = #formula;)
            }
            Statement::SinCos { argument, sin, cos } => {
                let (sin, cos) = (sin.map_or(quote!(_), name), cos.map_or(quote!(_), name));
                let argument = printer.receiver(argument);
                quote!(let (#sin, #cos) = #argument.sin_cos();)
            }
        }
    }

    fn hands_on(&self, i: usize) -> TokenStream {
        let of = self.part_type(i);
        let fields = self.pieces[i]
            .passes_on
            .iter()
            .filter_map(|&id| self.program.name(id))
            .map(ident);
        quote!(#of { #(#fields),* })
    }

    fn returned(&self) -> TokenStream {
        match self.request.results {
            Results::Array(length) => {
                let length = ident(length);
                quote!([T; #length])
            }
            Results::Start(_) => quote!(([T; COORDINATES], [T; VELOCITIES])),
            Results::Vector => quote!(SVector<T, VELOCITIES>),
            Results::Matrix(_) => quote!(SMatrix<T, VELOCITIES, VELOCITIES>),
            Results::Mechanism(_) => quote!(Self),
        }
    }

    fn results(&self, printer: &Printer<'_>) -> TokenStream {
        let values: Vec<TokenStream> = self
            .program
            .roots
            .iter()
            .map(|&id| printer.value(id))
            .collect();
        match self.request.results {
            Results::Array(_) => quote!([#(#values),*]),
            Results::Start(coordinates) => {
                let (q, v) = values.split_at(coordinates);
                quote!(([#(#q),*], [#(#v),*]))
            }
            Results::Vector => quote!(SVector::from([#(#values),*])),
            Results::Matrix(rows) if rows <= READABLE_ROWS => {
                let rows = (0..rows).map(|row| {
                    let entries =
                        (0..rows).map(|column| &values[upper_triangle(rows, row, column)]);
                    quote!([#(#entries),*])
                });
                quote!(SMatrix::from([#(#rows),*]))
            }
            Results::Matrix(rows) => self.sparse_matrix(rows, &values, printer),
            Results::Mechanism(fields) => {
                let fields = fields.iter().zip(&values).map(|(field, value)| {
                    let field = ident(field);
                    // A field of its own name is written once.
                    if field == value.to_string() {
                        quote!(#field)
                    } else {
                        quote!(#field: #value)
                    }
                });
                let copied = if self.pieces.len() > 1 {
                    quote!(parameters: *parameters)
                } else {
                    quote!(parameters)
                };
                quote!(Self { #copied, #(#fields),* })
            }
        }
    }

    /// A large matrix entry by entry, without its zeros.
    fn sparse_matrix(
        &self,
        rows: usize,
        values: &[TokenStream],
        printer: &Printer<'_>,
    ) -> TokenStream {
        let entries = (0..rows).flat_map(|row| (row..rows).map(move |column| (row, column)));
        let entries = entries
            .zip(&self.program.roots)
            .zip(values)
            .filter(|&((_, &root), _)| {
                self.program.graph.node(root) != Node::Constant(0.0_f64.to_bits())
            });
        let entries = entries.map(|(((row, column), _), value)| {
            let (row, column) = (
                Literal::usize_unsuffixed(row),
                Literal::usize_unsuffixed(column),
            );
            if row.to_string() == column.to_string() {
                quote!(s[(#row, #column)] = #value;)
            } else {
                quote!(s[(#row, #column)] = #value; s[(#column, #row)] = #value;)
            }
        });
        let zero = printer.number(0.0);
        quote! {
            let mut s = SMatrix::from_element(#zero);
            #(#entries)*
            s
        }
    }
}

fn part_name(i: usize) -> proc_macro2::Ident {
    format_ident!("part_{}", i + 1)
}

/// Place of an entry of a symmetric matrix in its upper triangle by rows.
fn upper_triangle(rows: usize, row: usize, column: usize) -> usize {
    let (row, column) = (row.min(column), row.max(column));
    row * rows - row * (row + 1) / 2 + column
}

#[cfg(test)]
mod tests {
    use super::upper_triangle;

    #[test]
    fn the_upper_triangle_is_counted_by_rows() {
        let mut next = 0;
        for row in 0..5 {
            for column in row..5 {
                assert_eq!(upper_triangle(5, row, column), next);
                assert_eq!(upper_triangle(5, column, row), next);
                next += 1;
            }
        }
    }
}
