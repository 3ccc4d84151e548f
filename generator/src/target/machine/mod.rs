//! The part of making machine code that is the same for every processor.
//!
//! | module | what |
//! |---|---|
//! | `shape` | what a value is: a number or a register full of numbers |
//! | `operation` | the operations of steps, and operands of instructions |
//! | `steps` | a list as steps of a processor |
//! | `numbers` | steps on numbers, which absorb negations |
//! | `terms` | steps on numbers with their slopes |
//! | `sine`, `angle` | sine, cosine and `atan2` of doubles as steps, in place of calls |
//! | `approach` | two ellipsoids that are far from each other |
//! | `laws` | force laws and curves as steps, in place of calls |
//! | `emit` | the order of instructions, with values in registers or memory |
//! | `rare_branches` | the branch that rare numbers take |
//! | `registers` | which value is in which register, and which one is evicted |
//! | `slots` | places in the frame |
//! | `base` | the memory of a function |
//!
//! A `Processor` (in `emit`) writes the instructions. Each processor has a folder beside this one.
//!
//! The code is one function for a whole list. The function branches only for rare numbers. It uses the stack only as
//! far as calls need it, and works in a frame that the caller provides. Results are written as soon as they are known.

mod angle;
mod approach;
mod base;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod emit;
mod laws;
mod numbers;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod operation;
mod rare_branches;
pub(crate) mod registers;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod shape;
mod sine;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod slots;
pub(crate) mod steps;
mod terms;

pub use base::Base;
pub use shape::{Length, Precision};
pub use steps::Callee;

/// A function in machine code.
#[derive(Clone, Debug)]
pub struct Code {
    /// The code, followed by its constants. Its first byte is the entry. Its address must be a multiple of 64.
    pub bytes: Vec<u8>,
    /// The functions that the code calls, in the order of the table that it expects.
    pub callees: Vec<Callee>,
    /// The number of scalars that the code needs in each region; for [`Base::Functions`] the number of entries of the
    /// table.
    pub slots: [u32; Base::ALL.len()],
}
