//! Machine code for x86-64 with AVX, with AVX2 and fused multiply-adds, or with AVX-512.
//!
//! | module | what |
//! |---|---|
//! | `emit` | an instruction for each step, with operands in registers or memory |
//! | `abi` | the calling convention |
//! | `encode` | instructions as bytes |

mod abi;
mod emit;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod encode;

use super::machine::emit::emit;
use super::machine::shape::{Shape, Values};
use super::machine::steps::steps;
use super::machine::{Code, Length, Precision};
use crate::program::{Curve, List};
use emit::X86;

/// The processor features and the scalar that code is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// The part of a register that a value takes up. One number needs AVX, 32 bytes need AVX2, 64 bytes need AVX-512 F
    /// and DQ.
    pub length: Length,
    /// Doubles or singles.
    pub precision: Precision,
    /// True if a · b + c is rounded once, which needs FMA; false if it is rounded twice.
    pub fused: bool,
    /// True if registers 16 to 31 exist: AVX-512 F, DQ and VL.
    pub many_registers: bool,
    /// True if every scalar is a dual number: a value and, in the next slot, its slope.
    pub slopes: bool,
}

impl Target {
    fn values(&self) -> Values {
        Values {
            shape: Shape {
                length: self.length,
                precision: self.precision,
            },
            fused: self.fused,
            slopes: self.slopes,
        }
    }

    /// True if comparisons write to mask registers. There are then 32 vector registers.
    fn masks(&self) -> bool {
        self.many_registers || self.length == Length::SixtyFour
    }
}

/// Makes the function that evaluates a list. `curves` are the curves of the model. The emitted code calls the functions
/// for which this target has no steps.
///
/// The emitted function is `extern "sysv64"`, and so are the functions that it calls.
pub fn assemble(list: &List, curves: &[Curve], target: &Target) -> Code {
    let values = target.values();
    let steps = steps(list, curves, &values);
    let registers = if target.masks() { 32 } else { 16 };
    emit(&steps, list, &values, registers, |needs| {
        X86::new(target, needs)
    })
}
