//! Writes Rust: one file for a model, of items only, so that it can be `include!`d into a module.
//!
//! [`program`](crate::program) decides what is written; this module prints it.
//!
//! | file | what |
//! |---|---|
//! | `method`, `argument`, `results` | a method: its signature, arguments and results |
//! | `function` | its body, or the bodies of its pieces |
//! | `expression`, `syntax`, `naming` | statements and formulas as syntax trees, with names |
//! | `implementation` | the trait `Model`, by the methods |
//! | `items`, `library`, `user` | sizes, parameters, constants; curves and laws; functions of the user's |
//! | `header`, `operations`, `comment` | the comment at the top of the file; comments between statements |
//!
//! Values that depend on parameters alone are computed once, in `Mechanism::new`. A value that is known before a method
//! runs is an input of the method's graph. Every method is straight-line code: no branch, no loop, no index that is not
//! a number.

mod argument;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod comment;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod expression;
mod function;
mod header;
mod implementation;
mod items;
mod library;
mod method;
mod naming;
mod operations;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod results;
mod syntax;
mod user;

use crate::equations::Equations;
use crate::method::inputs::Inputs;
use crate::method::table::{EACH_MOTION, Specification};
use crate::model::Model;
use crate::program::Options;
use crate::program::plan::{Plan, Procedure};
use library::{Calls, Library};
use method::Function;
use syn::{File, ImplItem, Item, parse_quote};

pub(crate) use user::pasted;
pub use user::{Adapter, Apart, apart, skeleton};

/// Version of the contract with `bryant_runtime`, checked where the emitted text is compiled.
pub const GENERATED_CODE_VERSION: u32 = 19;

/// The text of the module of a model. It depends only on the arguments and the version of this crate.
pub fn module(model: &Model, equations: &Equations, options: &Options) -> String {
    let mut plan = Plan::new(model, equations, options, None);
    drop_repeated(&mut plan.procedures);
    let library = Library::new(model);
    let mut calls = Calls::default();
    for procedure in &plan.procedures {
        calls.add(&procedure.graph, &procedure.roots);
    }
    calls.add_user(model);
    let motion = plan.motion();
    let Plan { inputs, procedures } = plan;
    let methods: Vec<Specification> = (procedures.iter())
        .map(|procedure| procedure.method.clone())
        .collect();
    let functions = functions(procedures, motion, &inputs, &library, options);

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
    let implementation = implementation::implementation(equations, &methods, &library);
    // No program uses every method, and numbers of a model may come close to π by chance: hence the attributes.
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

/// Leaves out functions that are asked for but are methods of each model: both would have one name.
fn drop_repeated(procedures: &mut Vec<Procedure>) {
    let methods = procedures.iter().filter(|of| of.method.function.is_none());
    let names: Vec<_> = methods.map(|of| of.method.name.clone()).collect();
    procedures.retain(|of| of.method.function.is_none() || !names.contains(&of.method.name));
}

/// Writes the methods. The method for v̇ calls a part of the method for q̇ and v̇.
fn functions(
    procedures: Vec<Procedure>,
    mut motion: Option<Procedure>,
    inputs: &Inputs,
    library: &Library,
    options: &Options,
) -> Vec<Function> {
    let written = procedures.into_iter().map(|procedure| {
        let method = &procedure.method;
        let at_once = motion.take_if(|_| method.part_of.is_none() && method.function.is_none());
        match at_once {
            Some(motion) => {
                let part = method::part_of(&procedure.method, EACH_MOTION, "COORDINATES");
                let mut motion = method::write(motion, inputs, library, options);
                motion.methods.extend(part);
                motion
            }
            None => method::write(procedure, inputs, library, options),
        }
    });
    written.collect()
}
