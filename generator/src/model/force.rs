//! Force interactions.

use super::law::Law;
use super::switch::Active;
use serde::Serialize;

/// A named force interaction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Force {
    /// Name as in the YAML: "chest"; for a joint force, the path of the element ("man/head"). Unique among forces of
    /// the same law.
    pub name: String,
    /// The law.
    pub law: Box<dyn Law>,
    /// The switches between which the force acts.
    pub active: Active,
}
