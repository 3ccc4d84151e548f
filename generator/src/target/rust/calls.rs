//! A method as calls: the texts that like elements have in common as functions, and the function that calls them.

use super::called::{Called, CommonWords, Places, Word};
use super::expression::{Printer, ident, number};
use super::function::{SinkOfTask, Writer, arrow, with_body};
use super::header::plain;
use crate::expression::{Node, NodeId};
use crate::method::inputs::{Argument, Input};
use crate::program::like::{Gathered, Item, Like, Place, Port, Sharing};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use rustc_hash::FxHashMap;
use std::cell::Cell;
use std::collections::BTreeSet;
use syn::{Block, Expr, ImplItemFn, Stmt, parse_quote};

/// An argument of a called function.
struct Given {
    name: Ident,
    of: TokenStream,
    passed: Passed,
    /// By block.
    values: Vec<TokenStream>,
}

/// How an argument is passed.
enum Passed {
    ByValue,
    ByReference,
    ToBeChanged,
}

impl Given {
    fn named(name: &str, of: TokenStream, values: impl IntoIterator<Item = TokenStream>) -> Self {
        Self {
            name: ident(name),
            of,
            passed: Passed::ByReference,
            values: values.into_iter().collect(),
        }
    }

    /// Its type; with the lifetime of the reference, if it is one.
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
    /// What calls return and their tasks; the functions that are called, and the method that calls them.
    pub(crate) fn in_calls(&mut self, sharing: &Sharing) -> (Vec<TokenStream>, Vec<ImplItemFn>) {
        let likes = &sharing.likes;
        let called: Vec<Called> = likes
            .iter()
            .enumerate()
            .map(|(i, like)| self.called(i, like, likes))
            .collect();
        let bodies: Vec<Block> = (likes.iter().zip(&called))
            .map(|(like, function)| self.common_body(like, function, &called))
            .collect();

        let places = self.name_places(likes, &called);
        let (mut structs, mut methods) = (Vec::new(), Vec::new());
        let mut given = Vec::new();
        let printer = Printer::new(&self.schedule, self.inputs, self.library, false);
        for (i, body) in bodies.into_iter().enumerate() {
            let (like, function) = (&likes[i], &called[i]);
            let arguments = self.given(sharing, i, &called, &places, &printer);
            structs.extend(self.returned_struct(like, function));
            structs.extend(self.carried_struct(like, function));
            structs.push(self.task_struct(like, function, &arguments));
            methods.push(self.common_method(like, function, &arguments, body));
            given.push(arguments);
        }
        methods.extend(self.calling_method(sharing, &called, &places, &given, &printer));
        (structs, methods)
    }

    /// What the function computes, in the words of the first block.
    fn common_body(&self, like: &Like, function: &Called, called: &[Called]) -> Block {
        let plain = Printer::new(&self.schedule, self.inputs, self.library, false);
        let first = like.first();
        let place = |place: &Place| match *place {
            Place::Common(_) => Word::Input,
            Place::Element { port, index } => Word::Element(&function.ports[port], index),
            Place::Value { port, number } => {
                let name = match &like.ports[port] {
                    Port::Returned { like, .. } => called[*like].values[number].as_str(),
                    Port::Argument { .. } => "",
                };
                Word::Field(&function.ports[port], name)
            }
            Place::Copied(index) => Word::Element("x", index),
        };
        let values = first.values.iter().zip(&function.values);
        let values = values.map(|(&id, name)| (id, Word::Name(name)));
        let slots = first.slots.iter().zip(&like.slots);
        let words = CommonWords {
            plain: &plain,
            words: values
                .chain(slots.map(|(&id, at)| (id, place(at))))
                .collect(),
            numbers: &like.numbers,
            next: Cell::new(0),
            puts: (&first.puts, &function.puts),
        };
        let printer = Printer::in_words(&self.schedule, self.inputs, self.library, &words);
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
        let fields = like.outputs.iter().map(|&n| ident(&function.values[n]));
        let num = printer
            .prints_numbers()
            .then(|| quote!(let num = T::from_f64;));
        let mut body: Block = parse_quote!({ #num });
        body.stmts.extend(lines);
        if let Some(carried) = &like.carried {
            let (name, port) = (&function.carried, ident(&function.ports[carried.port]));
            let fields = carried.numbers.iter();
            let fields = fields.map(|&n| ident(&function.values[n]));
            body.stmts
                .push(parse_quote!(*#port = #name { #(#fields),* };));
        }
        if !like.outputs.is_empty() {
            let end: Block = parse_quote!({ #returned { #(#fields),* } });
            body.stmts.extend(end.stmts);
        }
        body
    }

    /// What the function is given.
    fn given(
        &self,
        sharing: &Sharing,
        i: usize,
        called: &[Called],
        places: &[Places],
        printer: &Printer<'_>,
    ) -> Vec<Given> {
        let likes = &sharing.likes;
        let (like, function) = (&likes[i], &called[i]);
        let mut given = Vec::new();
        let time = |place: &Place| match *place {
            Place::Common(id) => self.is_time(id),
            _ => false,
        };
        if like.slots.iter().any(time) {
            given.push(Given {
                passed: Passed::ByValue,
                ..Given::named("t", quote!(T), vec![quote!(t); like.blocks.len()])
            });
        }
        for (place, (port, name)) in like.ports.iter().zip(&function.ports).enumerate() {
            if let Some(carried) = &like.carried
                && carried.port == place
            {
                let type_of = &function.carried;
                let values = carried.runs.iter().map(|&run| {
                    let variable = ident(&places[i].carried[run]);
                    quote!(&mut #variable)
                });
                given.push(Given {
                    passed: Passed::ToBeChanged,
                    ..Given::named(name, quote!(#type_of<T>), values)
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
                    Given::named(name, quote!([T; #length]), values)
                }
                Port::Returned {
                    like: of,
                    blocks,
                    gathered,
                } => {
                    let type_of = &called[*of].returned;
                    let value = |(block, gathered): (&Option<usize>, &Option<Gathered>)| {
                        if let (Some(block), None) = (block, gathered) {
                            let name = ident(&places[*of].returned[*block]);
                            return quote!(&#name);
                        }
                        let (outputs, of) = (&likes[*of].outputs, &called[*of]);
                        let fields = gathered_fields(gathered, outputs, of, printer);
                        quote!(&#type_of { #(#fields),* })
                    };
                    let values = blocks.iter().zip(gathered).map(value);
                    Given::named(name, quote!(#type_of<T>), values)
                }
            });
        }
        for (run, name) in function.puts.iter().enumerate() {
            let places = like.blocks.iter().map(|block| {
                let place = Literal::usize_unsuffixed(block.puts[run].start);
                quote!(#place)
            });
            given.push(Given {
                passed: Passed::ByValue,
                ..Given::named(name, quote!(usize), places)
            });
        }
        let copied = like.copied[0].len();
        if copied > 0 {
            let length = Literal::usize_unsuffixed(copied);
            let values = like.copied.iter().map(|copied| {
                let copied = copied.iter().map(|&id| printer.value(id));
                quote!(&[#(#copied),*])
            });
            given.push(Given::named("x", quote!([T; #length]), values));
        }
        let listed = like.listed[0].len();
        if listed > 0 {
            let length = Literal::usize_unsuffixed(listed);
            let values = like.listed.iter().map(|list| {
                let list = list.iter().map(|&value| number(value));
                quote!(&[#(#list),*])
            });
            given.push(Given::named("c", quote!([f64; #length]), values));
        }
        given
    }

    /// `let mut carried = …;`: what the first call of a run finds.
    fn first_carried(
        &self,
        like: &Like,
        function: &Called,
        places: &Places,
        block: usize,
        printer: &Printer<'_>,
    ) -> Option<Stmt> {
        let carried = like.carried.as_ref()?;
        let Port::Returned { gathered, .. } = &like.ports[carried.port] else {
            return None;
        };
        gathered[block].as_ref()?;
        let (name, variable) = (
            &function.carried,
            ident(&places.carried[carried.runs[block]]),
        );
        let fields = gathered_fields(&gathered[block], &carried.numbers, function, printer);
        Some(parse_quote!(let mut #variable = #name { #(#fields),* };))
    }

    fn is_time(&self, id: NodeId) -> bool {
        match self.schedule.graph.node(id) {
            Node::Symbol(symbol) => self.inputs.input(symbol) == Input::Time,
            _ => false,
        }
    }

    fn returned_struct(&self, like: &Like, function: &Called) -> Option<TokenStream> {
        let text = format!(" What `{}` returns.", function.function);
        let returned = &function.returned;
        let fields = like.outputs.iter().map(|&n| ident(&function.values[n]));
        (!like.outputs.is_empty()).then(|| {
            quote! {
                #[doc = #text]
                struct #returned<T> { #(#fields: T),* }
            }
        })
    }

    fn carried_struct(&self, like: &Like, function: &Called) -> Option<TokenStream> {
        let text = format!(
            " What a call of `{}` leaves for the next.",
            function.function
        );
        let carried = &function.carried;
        let numbers = &like.carried.as_ref()?.numbers;
        let fields = numbers.iter().map(|&n| ident(&function.values[n]));
        Some(quote! {
            #[doc = #text]
            struct #carried<T> { #(#fields: T),* }
        })
    }

    fn task_struct(&self, like: &Like, function: &Called, given: &[Given]) -> TokenStream {
        let Called {
            function: name,
            task,
            ..
        } = function;
        let returned = returned(like, function);
        let text = format!(" A call of `{name}`.");
        let names: Vec<_> = given.iter().map(|given| &given.name).collect();
        let types = given.iter().map(|given| given.of(&quote!('a)));
        let SinkOfTask {
            generic,
            bound,
            field,
            value,
        } = SinkOfTask::of(like.puts());
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
        like: &Like,
        function: &Called,
        given: &[Given],
        body: Block,
    ) -> ImplItemFn {
        let name = &function.function;
        let returned = arrow(&returned(like, function));
        let sink = like.puts().then(|| quote!(sink: &mut impl Sink<T>));
        let owners = like.blocks.iter().map(|b| self.owner(b.lines.end - 1));
        let owners: Vec<String> = owners.collect();
        let text = format!(
            " What {} elements have in common in `{}`, as it is for {}: {}.",
            owners.len(),
            self.request.name,
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
                fn #name(&self, #(#names: #types,)* #sink) #returned {}
            },
        )
    }

    /// The method, with the lines that no others are like.
    fn calling_method(
        &self,
        sharing: &Sharing,
        called: &[Called],
        places: &[Places],
        given: &[Vec<Given>],
        printer: &Printer<'_>,
    ) -> Vec<ImplItemFn> {
        let (mut reads, mut arguments) = (BTreeSet::new(), BTreeSet::new());
        for like in &sharing.likes {
            for port in &like.ports {
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
            for &id in like.copied.iter().flatten() {
                self.schedule.reads(id, &mut reads);
            }
            let common = like.slots.iter().filter_map(|place| match *place {
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
                    let name = |id| self.schedule.name(id).map(str::to_owned);
                    lines.push(self.line(line.statement, comment, printer, name));
                }
                Item::Call { like, block } => {
                    current = None;
                    let task = &called[like].task;
                    let names = given[like].iter().map(|given| &given.name);
                    let values = given[like].iter().map(|given| &given.values[block]);
                    let (of, function) = (&sharing.likes[like], &called[like]);
                    let first = self.first_carried(of, function, &places[like], block, printer);
                    lines.extend(first);
                    let sink = of.puts().then(|| quote!(sink: &mut *sink));
                    let call = quote! {
                        T::enable_apart(#task { mechanism: self, #(#names: #values,)* #sink })
                    };
                    let name = ident(&places[like].returned[block]);
                    // the last element of many may compute what nobody asks for
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
        let results = self.request.results.written(&self.schedule, printer, true);
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

/// What a call returns.
fn returned(like: &Like, function: &Called) -> TokenStream {
    let returned = &function.returned;
    match like.outputs.is_empty() {
        true => quote!(()),
        false => quote!(#returned<T>),
    }
}

/// Fields with values that no one call returned.
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
            // never read
            None => printer.number(0.0),
        };
        // A field of its own name is written once.
        match &value {
            Expr::Path(path) if path.path.is_ident(&name) => quote!(#name),
            _ => quote!(#name: #value),
        }
    };
    fields.iter().map(field).collect()
}

/// The first and the last of many.
fn list(words: &[String]) -> String {
    match words {
        [first, second, .., last] if words.len() > 4 => format!("{first}, {second} … {last}"),
        _ => words.join(", "),
    }
}
