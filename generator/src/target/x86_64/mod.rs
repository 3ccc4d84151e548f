//! x86-64 with AVX, AVX2 and fused multiply-adds, or AVX-512.
//!
//! | module | what |
//! |---|---|
//! | `steps` | a list as steps of the processor |
//! | `numbers` | steps on numbers, with negations taken over by them |
//! | `terms` | steps on numbers with their slopes |
//! | `sine`, `angle` | sine and cosine, and the angle of a point, of doubles as steps, in place of calls |
//! | `approach` | two ellipsoids that are far from each other |
//! | `laws` | force laws and curves that are steps, too, in place of calls |
//! | `emit` | an instruction for each step, and the operands that it takes from memory |
//! | `rare` | the branch that rare numbers take |
//! | `registers` | which value is in which register, and which one goes |
//! | `slots` | places in the frame |
//! | `abi` | how a function is called, and how it finds its memory |
//! | `encode` | instructions as bytes |
//!
//! [`assemble`] makes one function of a whole list. The function branches for rare numbers alone, and has no stack of its own beyond what calls need; it works in a
//! frame that it is given. Results are written as soon as they are known.

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

/// What code is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// How much of a register a value takes. One number needs AVX, 32 bytes need AVX2, 64 bytes AVX-512 F and DQ.
    pub length: Length,
    /// Doubles or singles.
    pub precision: Precision,
    /// a · b + c is rounded once, which needs FMA; twice otherwise.
    pub fused: bool,
    /// Registers 16 to 31 are there: AVX-512 F, DQ and VL.
    pub many_registers: bool,
    /// Every scalar is a dual number: a value and, in the slot behind it, its slope.
    pub slopes: bool,
    /// The angle of a point is called, and not written out.
    pub calls_angle: bool,
}

/// A function in machine code.
#[derive(Clone, Debug)]
pub struct Code {
    /// The code, entered at its first byte, and constants behind it. It may lie anywhere, on a multiple of 64.
    pub bytes: Vec<u8>,
    /// Functions that it calls, in the order of the table that it expects.
    pub callees: Vec<Callee>,
    /// Scalars that it needs in each region; of [`Base::Functions`] entries of the table.
    pub slots: [u32; Base::ALL.len()],
}

/// The function that evaluates a list. `curves` are those of the model; what it does not have is called.
pub fn assemble(list: &List, curves: &[Curve], target: &Target) -> Code {
    emit::emit(steps::steps(list, curves, target), list, target)
}
