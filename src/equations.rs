//! The equations of a model, ready to be evaluated over any scalar.

use crate::build_on_demand::UserForces;
use bryant_engine::{Error, UserFunctions};
use bryant_generator::Config;
use bryant_generator::model::Model;
use bryant_generator::program::Lists;
use std::sync::Arc;

pub use bryant_engine::Engine;

/// Derives the equations of a model without user forces. Nothing is compiled.
///
/// # Errors
/// The model calls a user function.
pub fn of(model: &Model) -> Result<Engine, Error> {
    with_users(model, None)
}

/// Derives the equations of a model. `users` are the functions of its user forces.
///
/// # Errors
/// The model calls a user function that is not available.
pub fn with_users(model: &Model, users: Option<Arc<UserForces>>) -> Result<Engine, Error> {
    of_lists(Config::new().matrices(false).lists(model), users)
}

/// Makes an engine from the lists of a model. `users` are the functions of its user forces.
///
/// # Errors
/// Those of [`with_users`].
pub fn of_lists(lists: Lists, users: Option<Arc<UserForces>>) -> Result<Engine, Error> {
    let users = users.map(|users| users as Arc<dyn UserFunctions>);
    Engine::with_functions(lists, users)
}
