//! Names in a method that is written as calls of subroutines: the functions, their structs, arguments and values, and
//! the variables that hold results.

use super::expression::{Printer, Words, scalar};
use super::function::Writer;
use super::syntax;
use crate::expression::{NodeId, owner};
use crate::names::{Names, camel, snake};
use crate::program::share::LiveThrough;
use crate::program::share::{Number, Port, Subroutine, place_in};
use proc_macro2::Ident;
use quote::format_ident;
use rustc_hash::FxHashMap;
use std::cell::Cell;
use std::ops::Range;
use syn::Expr;

/// The names in the function of one subroutine, which serves several blocks.
pub(crate) struct Called {
    pub function: Ident,
    pub task: Ident,
    pub returned: Ident,
    /// Name of each value that the function computes, by the number of the value in a block.
    pub values: Vec<String>,
    /// Name of the argument of each port.
    pub ports: Vec<String>,
    /// Name of the argument for each run of results that a block puts into the writer: the index at which the run
    /// begins.
    pub puts: Vec<String>,
    /// The struct of values that a call leaves for the next call.
    pub live_through: Ident,
}

/// The variables in which the calling method keeps results of calls.
pub(crate) struct Places {
    /// For each block, the variable of the result of its call.
    pub returned: Vec<String>,
    /// For each run of calls, the variable of the values that a call leaves for the next one.
    pub live_through: Vec<String>,
}

impl Writer<'_> {
    /// The names in a subroutine. They do not mention the element of the first block, because the function serves many
    /// elements.
    pub(crate) fn called(
        &self,
        i: usize,
        subroutine: &Subroutine,
        subroutines: &[Subroutine],
    ) -> Called {
        let (method, number) = (self.method.name, i + 1);
        let own = self.owner(subroutine.first().lines.end - 1);
        let element = snake(own.split_once(' ').map_or(own.as_str(), |(_, name)| name));
        let mut names = Names::with(&["self", "num", "t", "x", "c", "writer"]);
        let puts = subroutine
            .first()
            .puts
            .iter()
            .map(|_| names.take("at"))
            .collect();
        let ports = subroutine.ports.iter().map(|port| {
            names.take(match port {
                Port::Argument { argument, .. } => argument.name(),
                Port::Returned {
                    subroutine, blocks, ..
                } => {
                    let source =
                        blocks[0].map(|block| subroutines[*subroutine].blocks[block].lines.end - 1);
                    let same = source.is_some_and(|line| self.owner(line) == own);
                    if same { "own" } else { "other" }
                }
            })
        });
        let ports = ports.collect();
        let mut temporaries = 0;
        let values = subroutine.first().values.iter().map(|&id| {
            let name = self.names.of(id).unwrap_or_default();
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
            live_through: format_ident!("{}Carried{number}", camel(method)),
            values,
            ports,
            puts,
        }
    }

    /// Names the variables of results. From here on, values that blocks bind are printed as fields of these variables.
    pub(crate) fn name_places(
        &mut self,
        subroutines: &[Subroutine],
        called: &[Called],
    ) -> Vec<Places> {
        let mut names = Names::with(&["self", "num", "writer", "q", "v", "z", "m", "a", "g", "t"]);
        for name in self.names.all() {
            names.take(name);
        }
        let mut places = Vec::new();
        for (subroutine, function) in subroutines.iter().zip(called) {
            let owners: Vec<String> = (subroutine.blocks.iter())
                .map(|block| self.owner(block.lines.end - 1))
                .collect();
            let returned: Vec<String> = (owners.iter())
                .map(|owner| names.take(&snake(owner)))
                .collect();
            let field = |place: &str, number: usize| format!("{place}.{}", function.values[number]);
            for (block, place) in subroutine.blocks.iter().zip(&returned) {
                let outputs = subroutine.outputs.iter();
                let fields = outputs.map(|&n| (block.values[n], field(place, n)));
                self.names.rename(fields);
            }
            let mut live_through = Vec::new();
            if let Some(LiveThrough {
                numbers,
                runs,
                last,
                ..
            }) = &subroutine.live_through
            {
                let count = runs.iter().max().map_or(0, |run| run + 1);
                live_through.extend((0..count).map(|_| names.take("carried")));
                for ((block, &run), &last) in subroutine.blocks.iter().zip(runs).zip(last) {
                    let numbers = numbers.iter().filter(|_| last);
                    let fields = numbers.map(|&n| (block.values[n], field(&live_through[run], n)));
                    self.names.rename(fields);
                }
            }
            places.push(Places {
                returned,
                live_through,
            });
        }
        places
    }

    /// The element to which a line belongs.
    pub(crate) fn owner(&self, line: usize) -> String {
        let section = self.schedule.lines[line].section;
        owner(&self.schedule.graph.sections()[section]).to_owned()
    }
}

/// A name without the words of the name of an element.
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

/// The way a value is written in the text of a subroutine: by its name, as a field, as an element of an array, or as an
/// input.
pub(crate) enum Word<'a> {
    Name(&'a str),
    Field(&'a str, &'a str),
    Element(&'a str, usize),
    Input,
}

/// The words in the text of a subroutine: names of values of the first block, of arguments, and the numbers in the
/// order of their use.
pub(crate) struct CommonWords<'a> {
    pub plain: &'a Printer<'a>,
    pub words: FxHashMap<NodeId, Word<'a>>,
    pub numbers: &'a [Number],
    pub next: Cell<usize>,
    /// The index ranges of the results that the first block puts into the writer, and the arguments that hold the
    /// beginning of each.
    pub puts: (&'a [Range<usize>], &'a [String]),
}

impl Words for CommonWords<'_> {
    fn value(&self, id: NodeId) -> Expr {
        match self.words.get(&id) {
            Some(Word::Name(name)) => syntax::word(name),
            Some(Word::Field(base, name)) => syntax::field(syntax::word(base), name),
            Some(Word::Element(array, index)) => syntax::element(array, *index),
            // anything else is an input: a block reads only its slots
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
        let (runs, names) = self.puts;
        let (run, distance) = place_in(runs, place);
        syntax::offset(&names[run], distance)
    }
}
