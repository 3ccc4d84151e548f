//! Writes a method as calls: a function for each subroutine that similar elements share, and the method that calls
//! these functions.

use super::expression::{Printer, ident, number};
use super::function::{Writer, WriterOfTask, arrow, with_body};
use super::results;
use super::subroutine_names::{Called, CommonWords, Places, Word};
use crate::expression::{Node, NodeId};
use crate::method::inputs::{Argument, Input};
use crate::names::plain;
use crate::program::share::{Gathered, Item, Place, Port, Sharing, Subroutine};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use rustc_hash::FxHashMap;
use std::cell::Cell;
use std::collections::BTreeSet;
use syn::{Block, Expr, ImplItemFn, Stmt, parse_quote};

/// An argument of a called function.
struct Parameter {
    name: Ident,
    of: TokenStream,
    passed: Passed,
    /// The value that is passed, for each block.
    values: Vec<TokenStream>,
}

/// How an argument is passed.
enum Passed {
    ByValue,
    ByReference,
    ToBeChanged,
}

impl Parameter {
    fn named(name: &str, of: TokenStream, values: impl IntoIterator<Item = TokenStream>) -> Self {
        Self {
            name: ident(name),
            of,
            passed: Passed::ByReference,
            values: values.into_iter().collect(),
        }
    }

    /// The type of the argument; for a reference, with this lifetime.
    fn of(&self, lifetime: &TokenStream) -> TokenStream {
        let of = &self.of;
        match self.passed {
            Passed::ByValue => quote!(#of),
            Passed::ByReference => quote!(&#lifetime #of),
            Passed::ToBeChanged => quote!(&#lifetime mut #of),
        }
    }
}

impl Writer<'_> {
    /// The structs of results and tasks; the called functions, followed by the method that calls them.
    pub(crate) fn in_calls(&mut self, sharing: &Sharing) -> (Vec<TokenStream>, Vec<ImplItemFn>) {
        let subroutines = &sharing.subroutines;
        let called: Vec<Called> = subroutines
            .iter()
            .enumerate()
            .map(|(i, subroutine)| self.called(i, subroutine, subroutines))
            .collect();
        let bodies: Vec<Block> = (subroutines.iter().zip(&called))
            .map(|(subroutine, function)| self.common_body(subroutine, function, &called))
            .collect();

        let places = self.name_places(subroutines, &called);
        let (mut structs, mut methods) = (Vec::new(), Vec::new());
        let mut given = Vec::new();
        let printer = self.printer();
        for (i, body) in bodies.into_iter().enumerate() {
            let (subroutine, function) = (&subroutines[i], &called[i]);
            let arguments = self.given(sharing, i, &called, &places, &printer);
            structs.extend(self.returned_struct(subroutine, function));
            structs.extend(self.live_through_struct(subroutine, function));
            structs.push(self.task_struct(subroutine, function, &arguments));
            methods.push(self.common_method(subroutine, function, &arguments, body));
            given.push(arguments);
        }
        methods.extend(self.calling_method(sharing, &called, &places, &given, &printer));
        (structs, methods)
    }

    /// The body of a called function, made from the lines of the first block.
    fn common_body(&self, subroutine: &Subroutine, function: &Called, called: &[Called]) -> Block {
        let plain = self.printer();
        let first = subroutine.first();
        let place = |place: &Place| match *place {
            Place::Common(_) => Word::Input,
            Place::Element { port, index } => Word::Element(&function.ports[port], index),
            Place::Value { port, number } => {
                let name = match &subroutine.ports[port] {
                    Port::Returned { subroutine, .. } => {
                        called[*subroutine].values[number].as_str()
                    }
                    Port::Argument { .. } => "",
                };
                Word::Field(&function.ports[port], name)
            }
            Place::Copied(index) => Word::Element("x", index),
        };
        let values = first.values.iter().zip(&function.values);
        let values = values.map(|(&id, name)| (id, Word::Name(name)));
        let slots = first.slots.iter().zip(&subroutine.slots);
        let words = CommonWords {
            plain: &plain,
            words: values
                .chain(slots.map(|(&id, at)| (id, place(at))))
                .collect(),
            numbers: &subroutine.numbers,
            next: Cell::new(0),
            puts: (&first.puts, &function.puts),
        };
        let printer = plain.in_words(&words);
        let names: FxHashMap<NodeId, &String> =
            first.values.iter().copied().zip(&function.values).collect();
        let sections = self.schedule.graph.sections();
        let mut current = None;
        let mut lines = Vec::new();
        for line in &self.schedule.lines[first.lines.clone()] {
            let comment = line.begins(&mut current).map(|section| {
                let section = sections[section].as_str();
                section.split_once(": ").map_or(section, |(_, what)| what)
            });
            let name = |id| names.get(&id).map(|name| name.to_string());
            lines.push(self.line(line.statement, comment, &printer, name));
        }
        let returned = &function.returned;
        let fields = subroutine
            .outputs
            .iter()
            .map(|&n| ident(&function.values[n]));
        let num = printer
            .prints_numbers()
            .then(|| quote!(let num = T::from_f64;));
        let mut body: Block = parse_quote!({ #num });
        body.stmts.extend(lines);
        if let Some(live_through) = &subroutine.live_through {
            let (name, port) = (
                &function.live_through,
                ident(&function.ports[live_through.port]),
            );
            let fields = live_through.numbers.iter();
            let fields = fields.map(|&n| ident(&function.values[n]));
            body.stmts
                .push(parse_quote!(*#port = #name { #(#fields),* };));
        }
        if !subroutine.outputs.is_empty() {
            let end: Block = parse_quote!({ #returned { #(#fields),* } });
            body.stmts.extend(end.stmts);
        }
        body
    }

    /// The arguments of a called function.
    // Long: a part for each kind of argument, in the order in which they are passed.
    fn given(
        &self,
        sharing: &Sharing,
        i: usize,
        called: &[Called],
        places: &[Places],
        printer: &Printer<'_>,
    ) -> Vec<Parameter> {
        let subroutines = &sharing.subroutines;
        let (subroutine, function) = (&subroutines[i], &called[i]);
        let mut given = Vec::new();
        let time = |place: &Place| match *place {
            Place::Common(id) => self.is_time(id),
            _ => false,
        };
        if subroutine.slots.iter().any(time) {
            given.push(Parameter {
                passed: Passed::ByValue,
                ..Parameter::named("t", quote!(T), vec![quote!(t); subroutine.blocks.len()])
            });
        }
        for (place, (port, name)) in subroutine.ports.iter().zip(&function.ports).enumerate() {
            if let Some(live_through) = &subroutine.live_through
                && live_through.port == place
            {
                let type_of = &function.live_through;
                let values = live_through.runs.iter().map(|&run| {
                    let variable = ident(&places[i].live_through[run]);
                    quote!(&mut #variable)
                });
                given.push(Parameter {
                    passed: Passed::ToBeChanged,
                    ..Parameter::named(name, quote!(#type_of<T>), values)
                });
                continue;
            }
            given.push(match port {
                Port::Argument {
                    argument,
                    starts,
                    length,
                } => {
                    let all = ident(argument.name());
                    let length = Literal::usize_unsuffixed(*length);
                    let from = starts.iter().map(|&start| Literal::usize_unsuffixed(start));
                    let values =
                        from.map(|from| quote!(bryant_runtime::part::<#from, _, _, _>(#all)));
                    Parameter::named(name, quote!([T; #length]), values)
                }
                Port::Returned {
                    subroutine: of,
                    blocks,
                    gathered,
                } => {
                    let type_of = &called[*of].returned;
                    let value = |(block, gathered): (&Option<usize>, &Option<Gathered>)| {
                        if let (Some(block), None) = (block, gathered) {
                            let name = ident(&places[*of].returned[*block]);
                            return quote!(&#name);
                        }
                        let (outputs, of) = (&subroutines[*of].outputs, &called[*of]);
                        let fields = gathered_fields(gathered, outputs, of, printer);
                        quote!(&#type_of { #(#fields),* })
                    };
                    let values = blocks.iter().zip(gathered).map(value);
                    Parameter::named(name, quote!(#type_of<T>), values)
                }
            });
        }
        for (run, name) in function.puts.iter().enumerate() {
            let places = subroutine.blocks.iter().map(|block| {
                let place = Literal::usize_unsuffixed(block.puts[run].start);
                quote!(#place)
            });
            given.push(Parameter {
                passed: Passed::ByValue,
                ..Parameter::named(name, quote!(usize), places)
            });
        }
        let copied = subroutine.copied[0].len();
        if copied > 0 {
            let length = Literal::usize_unsuffixed(copied);
            let values = subroutine.copied.iter().map(|copied| {
                let copied = copied.iter().map(|&id| printer.value(id));
                quote!(&[#(#copied),*])
            });
            given.push(Parameter::named("x", quote!([T; #length]), values));
        }
        let listed = subroutine.listed[0].len();
        if listed > 0 {
            let length = Literal::usize_unsuffixed(listed);
            let values = subroutine.listed.iter().map(|list| {
                let list = list.iter().map(|&value| number(value));
                quote!(&[#(#list),*])
            });
            given.push(Parameter::named("c", quote!([f64; #length]), values));
        }
        given
    }

    /// `let mut carried = …;`: the values that the first call of a run gets in place of those of a previous call.
    fn first_live_through(
        &self,
        subroutine: &Subroutine,
        function: &Called,
        places: &Places,
        block: usize,
        printer: &Printer<'_>,
    ) -> Option<Stmt> {
        let live_through = subroutine.live_through.as_ref()?;
        let Port::Returned { gathered, .. } = &subroutine.ports[live_through.port] else {
            return None;
        };
        gathered[block].as_ref()?;
        let (name, variable) = (
            &function.live_through,
            ident(&places.live_through[live_through.runs[block]]),
        );
        let fields = gathered_fields(&gathered[block], &live_through.numbers, function, printer);
        Some(parse_quote!(let mut #variable = #name { #(#fields),* };))
    }

    fn is_time(&self, id: NodeId) -> bool {
        match self.schedule.graph.node(id) {
            Node::Symbol(symbol) => self.inputs.input(symbol) == Input::Time,
            _ => false,
        }
    }

    fn returned_struct(&self, subroutine: &Subroutine, function: &Called) -> Option<TokenStream> {
        let text = format!(" What `{}` returns.", function.function);
        let returned = &function.returned;
        let fields = subroutine
            .outputs
            .iter()
            .map(|&n| ident(&function.values[n]));
        (!subroutine.outputs.is_empty()).then(|| {
            quote! {
                #[doc = #text]
                struct #returned<T> { #(#fields: T),* }
            }
        })
    }

    fn live_through_struct(
        &self,
        subroutine: &Subroutine,
        function: &Called,
    ) -> Option<TokenStream> {
        let text = format!(
            " What a call of `{}` leaves for the next.",
            function.function
        );
        let live_through = &function.live_through;
        let numbers = &subroutine.live_through.as_ref()?.numbers;
        let fields = numbers.iter().map(|&n| ident(&function.values[n]));
        Some(quote! {
            #[doc = #text]
            struct #live_through<T> { #(#fields: T),* }
        })
    }

    fn task_struct(
        &self,
        subroutine: &Subroutine,
        function: &Called,
        given: &[Parameter],
    ) -> TokenStream {
        let Called {
            function: name,
            task,
            ..
        } = function;
        let returned = returned(subroutine, function);
        let text = format!(" A call of `{name}`.");
        let names: Vec<_> = given.iter().map(|given| &given.name).collect();
        let types = given.iter().map(|given| given.of(&quote!('a)));
        let WriterOfTask {
            generic,
            bound,
            field,
            value,
        } = WriterOfTask::of(subroutine.puts());
        quote! {
            #[doc = #text]
            struct #task<'a, T #generic> {
                mechanism: &'a Mechanism<T>,
                #(#names: #types,)*
                #field
            }

            impl<T: Real #bound> bryant_runtime::Task for #task<'_, T #generic> {
                type Output = #returned;

                #[inline(always)]
                fn run(self) -> Self::Output {
                    self.mechanism.#name(#(self.#names,)* #value)
                }
            }
        }
    }

    fn common_method(
        &self,
        subroutine: &Subroutine,
        function: &Called,
        given: &[Parameter],
        body: Block,
    ) -> ImplItemFn {
        let name = &function.function;
        let returned = arrow(&returned(subroutine, function));
        let writer = subroutine
            .puts()
            .then(|| quote!(writer: &mut impl OutputWriter<T>));
        let owners = subroutine
            .blocks
            .iter()
            .map(|b| self.owner(b.lines.end - 1));
        let owners: Vec<String> = owners.collect();
        let text = format!(
            " What {} elements have in common in `{}`, as it is for {}: {}.",
            owners.len(),
            self.method.name,
            owners[0],
            list(&owners)
        );
        let text = plain(&text);
        let names = given.iter().map(|given| &given.name);
        let types = given.iter().map(|given| given.of(&quote!()));
        with_body(
            body,
            parse_quote! {
                #[doc = #text]
                #[inline(always)]
                fn #name(&self, #(#names: #types,)* #writer) #returned {}
            },
        )
    }

    /// The method that calls the functions. It also has the lines that no subroutine contains.
    // Long: it goes over lines and calls once, and collects what they read on the way.
    fn calling_method(
        &self,
        sharing: &Sharing,
        called: &[Called],
        places: &[Places],
        given: &[Vec<Parameter>],
        printer: &Printer<'_>,
    ) -> Vec<ImplItemFn> {
        let (mut reads, mut arguments) = (BTreeSet::new(), BTreeSet::new());
        for subroutine in &sharing.subroutines {
            for port in &subroutine.ports {
                match port {
                    Port::Argument { argument, .. } => {
                        arguments.insert(*argument);
                    }
                    Port::Returned { gathered, .. } => {
                        let gathered = gathered.iter().flatten().flatten();
                        gathered.for_each(|&(_, id)| self.schedule.reads(id, &mut reads));
                    }
                }
            }
            for &id in subroutine.copied.iter().flatten() {
                self.schedule.reads(id, &mut reads);
            }
            let common = subroutine.slots.iter().filter_map(|place| match *place {
                Place::Common(id) => Some(id),
                _ => None,
            });
            arguments.extend(self.arguments_of(&common.collect()));
        }
        let sections = self.schedule.graph.sections();
        let read = sharing.read(&self.schedule);
        let mut current = None;
        let mut lines = Vec::new();
        for item in &sharing.items {
            match *item {
                Item::Line(line) => {
                    let line = &self.schedule.lines[line];
                    for id in self.schedule.needs(line.statement) {
                        self.schedule.reads(id, &mut reads);
                    }
                    let comment = line.begins(&mut current);
                    let comment = comment.map(|section| sections[section].as_str());
                    let name = |id| self.names.of(id).map(str::to_owned);
                    lines.push(self.line(line.statement, comment, printer, name));
                }
                Item::Call { subroutine, block } => {
                    current = None;
                    let task = &called[subroutine].task;
                    let names = given[subroutine].iter().map(|given| &given.name);
                    let values = given[subroutine].iter().map(|given| &given.values[block]);
                    let (of, function) = (&sharing.subroutines[subroutine], &called[subroutine]);
                    let first =
                        self.first_live_through(of, function, &places[subroutine], block, printer);
                    lines.extend(first);
                    let writer = of.puts().then(|| quote!(writer: &mut *writer));
                    let call = quote! {
                        T::dispatch_apart(#task { mechanism: self, #(#names: #values,)* #writer })
                    };
                    let name = ident(&places[subroutine].returned[block]);
                    // nothing may read the results of the last element of a series
                    let values = &of.blocks[block].values;
                    let asked_for = of.outputs.iter().any(|&n| read.contains(&values[n]));
                    lines.push(match asked_for {
                        true => parse_quote!(let #name = #call;),
                        false => parse_quote!(#call;),
                    });
                }
            }
        }
        for &root in self.schedule.returned() {
            self.schedule.reads(root, &mut reads);
        }
        let results = results::written(
            self.method.results,
            &self.schedule,
            self.inputs,
            printer,
            true,
        );
        arguments.extend(self.arguments_of(&reads));
        let arrays = Argument::ARRAYS
            .iter()
            .filter_map(|&argument| self.destructure(&reads, argument));
        let num = printer
            .prints_numbers()
            .then(|| quote!(let num = T::from_f64;));
        let mut body: Block = parse_quote!({ #num #(#arrays)* });
        let end: Block = parse_quote!({ #results });
        body.stmts.extend(lines);
        body.stmts.extend(end.stmts);
        self.method(&arguments, body)
    }
}

/// The return type of a called function.
fn returned(subroutine: &Subroutine, function: &Called) -> TokenStream {
    let returned = &function.returned;
    match subroutine.outputs.is_empty() {
        true => quote!(()),
        false => quote!(#returned<T>),
    }
}

/// The fields of a struct of results, filled with values that no single call returned.
fn gathered_fields(
    gathered: &Option<Gathered>,
    fields: &[usize],
    of: &Called,
    printer: &Printer<'_>,
) -> Vec<TokenStream> {
    let gathered: FxHashMap<usize, NodeId> = gathered.iter().flatten().copied().collect();
    let field = |number: &usize| {
        let name = ident(&of.values[*number]);
        let value = match gathered.get(number) {
            Some(&id) => printer.value(id),
            // this field is never read
            None => printer.number(0.0),
        };
        // If the value has the name of the field, the name is written only once.
        match &value {
            Expr::Path(path) if path.path.is_ident(&name) => quote!(#name),
            _ => quote!(#name: #value),
        }
    };
    fields.iter().map(field).collect()
}

/// The words, separated by commas; of more than four only the first two and the last.
fn list(words: &[String]) -> String {
    match words {
        [first, second, .., last] if words.len() > 4 => format!("{first}, {second} … {last}"),
        _ => words.join(", "),
    }
}
