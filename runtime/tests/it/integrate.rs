//! Steps of a method, without a time loop.

mod adams;
mod march;
