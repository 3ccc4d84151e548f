//! Machine code for x86-64 with AVX, with AVX2 and fused multiply-adds, or with AVX-512.
//!
//! | module | what |
//! |---|---|
//! | `steps` | a list as steps of the processor |
//! | `numbers` | steps on numbers, which absorb negations |
//! | `terms` | steps on numbers with their slopes |
//! | `sine`, `angle` | sine, cosine and `atan2` of doubles as steps, in place of calls |
//! | `approach` | two ellipsoids that are far from each other |
//! | `laws` | force laws and curves as steps, in place of calls |
//! | `emit` | an instruction for each step, with operands in registers or memory |
//! | `rare` | the branch that rare numbers take |
//! | `registers` | which value is in which register, and which one is evicted |
//! | `slots` | places in the frame |
//! | `abi` | the calling convention, and the memory of a function |
//! | `encode` | instructions as bytes |
//!
//! [`assemble`] makes one function from a whole list. The function branches only for rare numbers. It uses the stack only as far as calls need it,
//! and works in a frame that the caller provides. Results are written as soon as they are known.

mod abi;
mod angle;
mod approach;
mod emit;
mod encode;
mod laws;
mod numbers;
mod rare;
mod registers;
mod sine;
mod slots;
mod steps;
mod terms;
#[cfg(test)]
mod tests;

pub use abi::Base;
pub use encode::{Length, Precision};
pub use steps::Callee;

use crate::program::{Curve, List};

/// The processor features and the scalar that code is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// The part of a register that a value takes. One number needs AVX, 32 bytes need AVX2, 64 bytes need AVX-512 F and DQ.
    pub length: Length,
    /// Doubles or singles.
    pub precision: Precision,
    /// Whether a · b + c is rounded once, which needs FMA; otherwise it is rounded twice.
    pub fused: bool,
    /// Whether registers 16 to 31 exist: AVX-512 F, DQ and VL.
    pub many_registers: bool,
    /// Whether every scalar is a dual number: a value and, in the next slot, its slope.
    pub slopes: bool,
}

/// A function in machine code.
#[derive(Clone, Debug)]
pub struct Code {
    /// The code, entered at its first byte, followed by its constants. It may lie at any multiple of 64.
    pub bytes: Vec<u8>,
    /// The functions that it calls, in the order of the table that it expects.
    pub callees: Vec<Callee>,
    /// The number of scalars that it needs in each region; for [`Base::Functions`] the number of entries of the table.
    pub slots: [u32; Base::ALL.len()],
}

/// The function that evaluates a list. `curves` are those of the model. Functions that this target has no steps for are called.
pub fn assemble(list: &List, curves: &[Curve], target: &Target) -> Code {
    emit::emit(steps::steps(list, curves, target), list, target)
}
