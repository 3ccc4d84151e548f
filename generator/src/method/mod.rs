//! The methods of a model: what each is given and returns.

pub(crate) mod inputs;
