//! From equations to Rust: one file per model, of items only, so that it can be `include!`d into a module.
//!
//! Equations ─plan→ one graph per method ─schedule→ lines ─split→ pieces ─print→ tokens ─format→ text
//!
//! What depends on parameters alone is computed once, in `Mechanism::new`; what is known to a method before it runs
//! stands in its graph as an input. Every method is straight-line code: no branch, no loop, no index that is not a number.

mod called;
mod calls;
mod comment;
pub(crate) mod expression;
mod function;
mod header;
pub(crate) mod items;
pub(crate) mod library;
pub(crate) mod method;
mod operations;
pub(crate) mod results;
pub(crate) mod syntax;
mod user;

use crate::equations::Equations;
use crate::method::inputs::Inputs;
use crate::model::Model;
use crate::program::{Options, plan};
use library::{Calls, Library};
use method::{Function, Request};
use syn::{File, ImplItem, Item, parse_quote};

pub(crate) use user::pasted;
pub use user::{Adapter, Apart, apart, skeleton};

/// Version of the contract with `bryant_runtime`, checked where the emitted text is compiled.
pub const GENERATED_CODE_VERSION: u32 = 14;

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
