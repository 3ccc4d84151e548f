//! The symbolic core: one hash-consed graph of expressions over a model's inputs.
//!
//! Equations are built through [`Expr`], whose operators fold constants, zeros, ones and signs as they go, so that what a
//! scene does not need never becomes a node. Everything else is a separate module over the finished graph.

pub mod count;
pub mod differentiate;
pub mod evaluate;
pub mod graph;
pub mod live;
pub mod node;
pub mod passes;
pub mod print;
#[cfg(test)]
mod properties;
pub mod vector;

pub use graph::{Expr, Graph, owner, sum};
pub use node::{ApproachCall, Function, Node, NodeId, Symbol, UserCall};
