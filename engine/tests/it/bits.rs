//! The bits of engines: three ways to evaluate a model give the same bits in every method.
//!
//! | file | compares |
//! |---|---|
//! | `compiled` | generated Rust of every bundled model with machine code, over doubles with the Jacobian; of one model over lanes |
//! | `machine` | machine code of every bundled model with the interpreter, over every scalar that has machine code |
//! | `scenes` | machine code of scenes of real size with the interpreter |
//!
//! The text of generated Rust is the same for every scalar, so compiling it for one scalar tests all of it. With `--cfg
//! bryant_nightly` it is compared over every scalar (`every`): the compiler takes minutes for that.

pub mod common;

#[cfg(bryant_nightly)]
mod all_scalars;
mod generated_rust;
mod machine;
mod scenes;
