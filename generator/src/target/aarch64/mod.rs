//! Machine code for AArch64: 64-bit Arm processors, with the vector registers of 16 bytes that all of them have
//! (Advanced SIMD).
//!
//! | module | what |
//! |---|---|
//! | `emit` | the instructions of each step |
//! | `pairs` | two loads or stores as one instruction |
//! | `abi` | the calling convention |
//! | `encode` | instructions as words |

// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod abi;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod emit;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod encode;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod pairs;

use super::machine::Code;
use super::machine::emit::emit;
use super::machine::shape::{Length, Precision, Shape, Values};
use super::machine::steps::steps;
use crate::program::{Curve, List};
use emit::Arm;

/// The scalar that code is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// True if a value is a whole register of 16 bytes, with a number in each lane; false if it is one number.
    pub lanes: bool,
    /// Doubles or singles.
    pub precision: Precision,
    /// True if a · b + c is rounded once, false if it is rounded twice.
    pub fused: bool,
    /// True if every scalar is a dual number: a value and, in the next slot, its slope.
    pub slopes: bool,
}

/// Makes the function that evaluates a list. `curves` are the curves of the model. The emitted code calls the functions
/// for which this target has no steps.
///
/// The emitted function is `extern "C"`, and so are the functions that it calls.
///
/// # Panics
/// If the code is longer than 128 MiB.
pub fn assemble(list: &List, curves: &[Curve], target: &Target) -> Code {
    let values = Values {
        shape: Shape {
            length: match target.lanes {
                true => Length::Sixteen,
                false => Length::Scalar,
            },
            precision: target.precision,
        },
        fused: target.fused,
        slopes: target.slopes,
    };
    let steps = steps(list, curves, &values);
    emit(&steps, list, &values, 32, |needs| Arm::new(needs.calls))
}
