//! From equations to Rust: one file per model, of items only, so that it can be `include!`d into a module.
//!
//! Equations ─plan→ one graph per method ─schedule→ lines ─split→ pieces ─print→ tokens ─format→ text
//!
//! What depends on parameters alone is computed once, in `Mechanism::new`; what is known to a method before it runs
//! stands in its graph as an input. Every method is straight-line code: no branch, no loop, no index that is not a number.

pub(crate) mod breakpoints;
mod called;
mod calls;
mod carry;
mod comment;
mod expression;
mod formula;
mod function;
mod header;
mod hoist;
mod inline;
mod inputs;
mod items;
mod library;
mod like;
mod list;
mod lists;
mod names;
mod operations;
mod order;
mod plan;
mod prepare;
mod program;
mod request;
mod results;
mod split;
mod syntax;
mod user;

use crate::equations::Equations;
use crate::expression::count::{Count, Table};
use crate::expression::live::Live;
use crate::model::Model;
use inputs::Inputs;
use library::{Calls, Library};
use request::{Function, Request};
use syn::{File, ImplItem, Item, parse_quote};

pub use lists::{Costs, counted_lists, lists};
pub(crate) use user::pasted;
pub use user::{Adapter, Apart, apart, skeleton};

/// Version of the contract with `bryant_runtime`, checked where the emitted text is compiled.
pub const GENERATED_CODE_VERSION: u32 = 14;

/// What to emit, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// The methods `mass_matrix`, `velocity_forces` and `applied_forces`, which need the runtime's feature `nalgebra`.
    pub matrices: bool,
    /// Statements that one function may have, besides those that read inputs; longer ones are cut into pieces, which release builds merge
    /// again unless there are too many. What like elements share, and what is left beside it, is not cut.
    pub statements: usize,
    /// Statements up to which a method is one function when it is compiled, which makes the faster code, by 3 % over one double and by
    /// 5 to 15 % over eight, but takes more than proportionally long, and more than the caches of a processor hold. Of longer ones
    /// like elements share functions; where few are like each other, each piece is a function.
    pub merged: usize,
}

impl Options {
    /// What is emitted unless something else is asked for.
    pub const DEFAULT: Options = Options {
        matrices: true,
        statements: 900,
        merged: 3000,
    };
}

impl Default for Options {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// What each method of a model's module costs, by section: the operations after all passes, before long methods are joined, or repeat some
/// instead of keeping their results.
pub fn costs(
    model: &Model,
    equations: &Equations,
    options: &Options,
) -> Vec<(&'static str, Table)> {
    costs_of(model, equations, options, None)
}

/// The same of some methods, and of `new`, which has what these need of parameters alone.
pub fn costs_of(
    model: &Model,
    equations: &Equations,
    options: &Options,
    only: Option<&[&str]>,
) -> Vec<(&'static str, Table)> {
    let mut inputs = Inputs::new(model, equations);
    let derived = plan::derived(model, equations, options, only, &mut inputs);
    let requests = plan::requests(model, equations, options, derived, &inputs, only);
    requests
        .iter()
        .map(|request| (request.name, Table::of(&request.graph, &request.roots)))
        .collect()
}

/// By method: the operations that depend on parameters alone, and so are done at every call though nothing changes. There
/// are none but in `new` and `initial_conditions`, which is what they are for.
pub fn repeated(
    model: &Model,
    equations: &Equations,
    options: &Options,
) -> Vec<(&'static str, Count)> {
    let mut inputs = Inputs::new(model, equations);
    let derived = plan::derived(model, equations, options, None, &mut inputs);
    let requests = plan::requests(model, equations, options, derived, &inputs, None);
    let of = |request: &Request<'_>| {
        let live = Live::new(&request.graph, &request.roots);
        let alone = hoist::alone(&request.graph, &live, &inputs);
        let nodes = live.nodes().iter().copied();
        let nodes: Vec<_> = nodes.filter(|id| alone[id.0 as usize]).collect();
        let mut count = Count::of_nodes(&request.graph, &nodes);
        // A sign is no operation.
        count.neg = 0;
        (request.name, count)
    };
    requests.iter().map(of).collect()
}

/// What a model is, in lines: its tree, its coordinates, what acts in it.
pub fn about(model: &Model, equations: &Equations) -> Vec<String> {
    header::lines(model, equations)
}

/// The text of a model's module. It depends on nothing but the arguments and the version of this crate.
pub fn module(model: &Model, equations: &Equations, options: &Options) -> String {
    let mut inputs = Inputs::new(model, equations);
    let derived = plan::derived(model, equations, options, None, &mut inputs);
    let requests = plan::requests(model, equations, options, derived, &inputs, None);
    let library = Library::new(model);
    let mut calls = Calls::default();
    for request in &requests {
        calls.add(&request.graph, &request.roots);
    }
    calls.add_user(model);
    let functions = functions(requests, &inputs, &library, options);

    let uses = items::uses(model, equations, &calls, options);
    let curves = calls
        .curves
        .iter()
        .map(|&curve| library.constant(model, curve));
    let sizes = items::sizes(equations);
    let parameters = items::parameters(model, &inputs);
    let mechanism = items::mechanism(&inputs);
    let structs = functions.iter().flat_map(|function| &function.structs);
    let info = items::info(model, equations);
    let indices = items::indices(model, equations, &inputs);
    let implementation = items::implementation(equations, &library);
    // Nobody needs every method, and a model's numbers may come close to π without meaning it.
    let mut file: File = parse_quote! {
        #uses
        #sizes
        #(#curves)*
        #parameters
        #mechanism
        #(#structs)*
        #[allow(
            dead_code,
            clippy::approx_constant,
            clippy::let_and_return,
            clippy::too_many_arguments
        )]
        impl<T: Real> Mechanism<T> {}
        #implementation
        #info
        #indices
    };
    let header = header::header(model, equations, &functions);
    let mut methods = functions.into_iter().flat_map(|function| function.methods);
    for item in &mut file.items {
        if let Item::Impl(item) = item
            && item.trait_.is_none()
        {
            item.items.extend(methods.by_ref().map(ImplItem::Fn));
        }
    }
    format!(
        "{header}\n{}{}",
        comment::splice(&prettyplease::unparse(&file)),
        library.users(model)
    )
}

/// The methods. That for v̇ is a part of the one for q̇ and v̇ at once.
fn functions(
    requests: Vec<Request<'_>>,
    inputs: &Inputs,
    library: &Library,
    options: &Options,
) -> Vec<Function> {
    let mut motion = plan::motion(&requests);
    let written = requests.into_iter().map(|request| {
        let at_once = motion.take_if(|_| request.name == plan::ACCELERATIONS);
        match at_once {
            Some(motion) => {
                let part = request.beyond(plan::EACH_MOTION, "COORDINATES");
                let mut motion = motion.write(inputs, library, options);
                motion.methods.extend(part);
                motion
            }
            None => request.write(inputs, library, options),
        }
    });
    written.collect()
}
