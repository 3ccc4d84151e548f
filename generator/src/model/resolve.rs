//! From the user's words to indices.

use super::Model;
use crate::Error;

/// Resolves and proves a description.
pub fn resolve() -> Result<Model, Error> {
    unimplemented!()
}
