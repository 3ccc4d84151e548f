//! The symbolic core: one hash-consed graph of expressions over a model's inputs.
//!
//! Equations are built with [`Expr`]. Its operators fold constants, zeros, ones and signs at once, so terms that vanish
//! in a model never become nodes. All other operations are modules that work on the finished graph.

pub mod count;
pub mod differentiate;
pub mod evaluate;
pub mod graph;
pub mod liveness;
pub mod node;
pub mod passes;
pub mod print;
pub mod vector;

pub use graph::{Expr, Graph, choose, owner, sum};
pub use node::{ApproachCall, Function, Node, NodeId, Symbol, UserCall};
