//! A method as calls: the texts that like elements have in common as functions, and the function that calls them.

use super::expression::{Printer, Words, ident, number, scalar};
use super::function::{SinkOfTask, Writer, arrow, with_body};
use super::header::plain;
use super::inputs::{Argument, Input};
use super::like::{Gathered, Item, Like, Number, Place, Port, Sharing};
use super::names::{Names, camel, snake};
use super::program::Statement;
use super::syntax;
use crate::expression::{Node, NodeId, owner};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use rustc_hash::FxHashMap;
use std::cell::Cell;
use std::collections::BTreeSet;
use syn::{BinOp, Block, Expr, ImplItemFn, Stmt, parse_quote};

/// A text as a function: what it and what it deals with are called.
struct Called {
    function: Ident,
    task: Ident,
    returned: Ident,
    /// By value of a block.
    values: Vec<String>,
    /// By port.
    ports: Vec<String>,
    /// The struct of what is carried from call to call.
    carried: Ident,
}

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
    pub(super) fn in_calls(&mut self, sharing: &Sharing) -> (Vec<TokenStream>, Vec<ImplItemFn>) {
        let likes = &sharing.likes;
        let called: Vec<Called> = likes
            .iter()
            .enumerate()
            .map(|(i, like)| self.called(i, like, likes))
            .collect();
        let bodies: Vec<Block> = (likes.iter().zip(&called))
            .map(|(like, function)| self.common_body(like, function, &called))
            .collect();

        // From here on the values of blocks are fields of what the calls return.
        let mut names = Names::with(&["self", "num", "sink", "q", "v", "z", "m", "a", "g", "t"]);
        for name in self.program.all_names() {
            names.take(name);
        }
        let (mut returned, mut variables) = (Vec::new(), Vec::new());
        for (like, function) in likes.iter().zip(&called) {
            let of_like = like.blocks.iter().map(|block| {
                let name = names.take(&snake(&self.owner(block.lines.end - 1)));
                let fields = like.outputs.iter();
                let fields =
                    fields.map(|&n| (block.values[n], format!("{name}.{}", function.values[n])));
                (name.clone(), fields.collect::<Vec<_>>())
            });
            let of_like: Vec<_> = of_like.collect();
            let (names_of_like, fields): (Vec<String>, Vec<_>) = of_like.into_iter().unzip();
            self.program.rename(fields.into_iter().flatten());
            returned.push(names_of_like);
            let mut runs = Vec::new();
            if let Some(carried) = &like.carried {
                let count = carried.runs.iter().max().map_or(0, |run| run + 1);
                runs.extend((0..count).map(|_| names.take("carried")));
                let places = carried.runs.iter().zip(&carried.last);
                for (block, (&run, _)) in like
                    .blocks
                    .iter()
                    .zip(places)
                    .filter(|(_, (_, last))| **last)
                {
                    let fields = carried.numbers.iter().map(|&n| {
                        let place = format!("{}.{}", runs[run], function.values[n]);
                        (block.values[n], place)
                    });
                    self.program.rename(fields);
                }
            }
            variables.push(runs);
        }

        let (mut structs, mut methods) = (Vec::new(), Vec::new());
        let mut given = Vec::new();
        let printer = Printer::new(&self.program, self.inputs, self.library, false);
        for (i, body) in bodies.into_iter().enumerate() {
            let (like, function) = (&likes[i], &called[i]);
            let arguments = self.given(sharing, i, &called, &returned, &variables[i], &printer);
            structs.extend(self.returned_struct(like, function));
            structs.extend(self.carried_struct(like, function));
            structs.push(self.task_struct(like, function, &arguments));
            methods.push(self.common_method(like, function, &arguments, body));
            given.push(arguments);
        }
        methods
            .extend(self.calling_method(sharing, &called, &returned, &variables, &given, &printer));
        (structs, methods)
    }

    fn owner(&self, line: usize) -> String {
        let section = self.program.lines[line].section;
        owner(&self.program.graph.sections()[section]).to_owned()
    }

    /// Names that do not name the element of the first block, which is one of many.
    fn called(&self, i: usize, like: &Like, likes: &[Like]) -> Called {
        let (method, number) = (self.request.name, i + 1);
        let own = self.owner(like.first().lines.end - 1);
        let element = snake(own.split_once(' ').map_or(own.as_str(), |(_, name)| name));
        let mut names = Names::with(&["self", "num", "t", "x", "c", "at", "sink"]);
        let ports = like.ports.iter().map(|port| {
            names.take(match port {
                Port::Argument { argument, .. } => argument.name(),
                Port::Returned { like, blocks, .. } => {
                    let source = blocks[0].map(|block| likes[*like].blocks[block].lines.end - 1);
                    let same = source.is_some_and(|line| self.owner(line) == own);
                    if same { "own" } else { "other" }
                }
            })
        });
        let ports = ports.collect();
        let mut temporaries = 0;
        let values = like.first().values.iter().map(|&id| {
            let name = self.program.name(id).unwrap_or_default();
            let nameless = name
                .strip_prefix('t')
                .is_some_and(|n| n.parse::<usize>().is_ok());
            if nameless {
                temporaries += 1;
                return names.take(&format!("t{temporaries}"));
            }
            names.take(&snake(&without(name, &element)))
        });
        let values = values.collect();
        Called {
            function: format_ident!("{method}_like_{number}"),
            task: format_ident!("{}LikeTask{number}", camel(method)),
            returned: format_ident!("{}Like{number}", camel(method)),
            carried: format_ident!("{}Carried{number}", camel(method)),
            values,
            ports,
        }
    }

    /// What the function computes, in the words of the first block.
    fn common_body(&self, like: &Like, function: &Called, called: &[Called]) -> Block {
        let plain = Printer::new(&self.program, self.inputs, self.library, false);
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
            first_put: first.first_put.unwrap_or_default(),
        };
        let printer = Printer::in_words(&self.program, self.inputs, self.library, &words);
        let names: FxHashMap<NodeId, &String> =
            first.values.iter().copied().zip(&function.values).collect();
        let sections = self.program.graph.sections();
        let mut current = None;
        let mut lines = Vec::new();
        for line in &self.program.lines[first.lines.clone()] {
            if let Statement::Put(_) = line.statement {
                lines.push(syntax::does(printer.statement(line.statement)));
                continue;
            }
            let new = current.replace(line.section) != Some(line.section);
            let section = sections[line.section].as_str();
            let section = section.split_once(": ").map_or(section, |(_, what)| what);
            let name = |id| names.get(&id).map(|name| name.to_string());
            let comment = new.then_some(section);
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
        returned: &[Vec<String>],
        variables: &[String],
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
                    let variable = ident(&variables[run]);
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
                            let name = ident(&returned[*of][*block]);
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
        if like.puts() {
            let places = like.blocks.iter().filter_map(|block| block.first_put);
            let places = places.map(|place| {
                let place = Literal::usize_unsuffixed(place);
                quote!(#place)
            });
            given.push(Given {
                passed: Passed::ByValue,
                ..Given::named("at", quote!(usize), places)
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
        variables: &[String],
        block: usize,
        printer: &Printer<'_>,
    ) -> Option<Stmt> {
        let carried = like.carried.as_ref()?;
        let Port::Returned { gathered, .. } = &like.ports[carried.port] else {
            return None;
        };
        gathered[block].as_ref()?;
        let (name, variable) = (&function.carried, ident(&variables[carried.runs[block]]));
        let fields = gathered_fields(&gathered[block], &carried.numbers, function, printer);
        Some(parse_quote!(let mut #variable = #name { #(#fields),* };))
    }

    fn is_time(&self, id: NodeId) -> bool {
        match self.program.graph.node(id) {
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
        returned: &[Vec<String>],
        variables: &[Vec<String>],
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
                        gathered.for_each(|&(_, id)| self.program.reads(id, &mut reads));
                    }
                }
            }
            for &id in like.copied.iter().flatten() {
                self.program.reads(id, &mut reads);
            }
            let common = like.slots.iter().filter_map(|place| match *place {
                Place::Common(id) => Some(id),
                _ => None,
            });
            arguments.extend(self.arguments_of(&common.collect()));
        }
        let sections = self.program.graph.sections();
        let mut current = None;
        let mut lines = Vec::new();
        for item in &sharing.items {
            match *item {
                Item::Line(line) => {
                    let line = &self.program.lines[line];
                    for id in self.program.needs(line.statement) {
                        self.program.reads(id, &mut reads);
                    }
                    if let Statement::Put(_) = line.statement {
                        lines.push(syntax::does(printer.statement(line.statement)));
                        continue;
                    }
                    let new = current.replace(line.section) != Some(line.section);
                    let comment = new.then(|| sections[line.section].as_str());
                    let name = |id| self.program.name(id).map(str::to_owned);
                    lines.push(self.line(line.statement, comment, printer, name));
                }
                Item::Call { like, block } => {
                    current = None;
                    let task = &called[like].task;
                    let names = given[like].iter().map(|given| &given.name);
                    let values = given[like].iter().map(|given| &given.values[block]);
                    let (of, function) = (&sharing.likes[like], &called[like]);
                    let first = self.first_carried(of, function, &variables[like], block, printer);
                    lines.extend(first);
                    let sink = of.puts().then(|| quote!(sink: &mut *sink));
                    let call = quote! {
                        T::enable_apart(#task { mechanism: self, #(#names: #values,)* #sink })
                    };
                    let name = ident(&returned[like][block]);
                    lines.push(match of.outputs.is_empty() {
                        true => parse_quote!(#call;),
                        false => parse_quote!(let #name = #call;),
                    });
                }
            }
        }
        for &root in self.program.returned() {
            self.program.reads(root, &mut reads);
        }
        let results = self.request.results.written(&self.program, printer, true);
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

/// A name without the words of an element.
fn without(name: &str, element: &str) -> String {
    let (words, left_out): (Vec<&str>, Vec<&str>) =
        (name.split('_').collect(), element.split('_').collect());
    let found = words
        .windows(left_out.len())
        .position(|some| some == left_out);
    match found {
        Some(at) => [&words[..at], &words[at + left_out.len()..]]
            .concat()
            .join("_"),
        None => name.to_owned(),
    }
}

/// The first and the last of many.
fn list(words: &[String]) -> String {
    match words {
        [first, second, .., last] if words.len() > 4 => format!("{first}, {second} … {last}"),
        _ => words.join(", "),
    }
}

/// What a value is called in a common text.
enum Word<'a> {
    Name(&'a str),
    Field(&'a str, &'a str),
    Element(&'a str, usize),
    Input,
}

/// The words of a common text: those of the first block, what it is handed, and numbers in their order.
struct CommonWords<'a> {
    plain: &'a Printer<'a>,
    words: FxHashMap<NodeId, Word<'a>>,
    numbers: &'a [Number],
    next: Cell<usize>,
    first_put: usize,
}

impl Words for CommonWords<'_> {
    fn value(&self, id: NodeId) -> Expr {
        match self.words.get(&id) {
            Some(Word::Name(name)) => syntax::word(name),
            Some(Word::Field(base, name)) => syntax::field(syntax::word(base), name),
            Some(Word::Element(array, index)) => syntax::element(array, *index),
            // and a block reads nothing but its slots
            Some(Word::Input) | None => self.plain.value(id),
        }
    }

    fn number(&self, _value: f64) -> Expr {
        let next = self.next.replace(self.next.get() + 1);
        match self.numbers[next] {
            Number::Same(value) => scalar(value),
            Number::Listed(index) => {
                syntax::call(syntax::word("num"), [syntax::element("c", index)])
            }
        }
    }

    fn place(&self, place: usize) -> Expr {
        match place - self.first_put {
            0 => syntax::word("at"),
            offset => syntax::binary(
                syntax::word("at"),
                BinOp::Add(Default::default()),
                syntax::literal(Literal::usize_unsuffixed(offset)),
            ),
        }
    }
}
