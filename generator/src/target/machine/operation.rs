//! The operations of steps, and the operands of instructions that every processor has.

/// A vector register, 0 to 31.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Vector(pub u8);

/// An operation of two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binary {
    /// first + second
    Add,
    /// first · second
    Mul,
    /// first − second
    Sub,
    /// first / second
    Div,
    /// The larger operand; the second one if either is NaN or both are zero.
    Max,
    /// The smaller operand; the second one if either is NaN or both are zero.
    Min,
}

/// A bitwise operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bitwise {
    /// A bit is set where both operands have it.
    And,
    /// A bit is set where exactly one of the operands has it.
    Xor,
}

/// The signs of product and addend in a fused operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signs {
    /// −(a · b) instead of a · b
    pub product: bool,
    /// − c instead of + c
    pub addend: bool,
}

/// A position in the code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CodePosition(pub usize);

/// A jump whose target must still be filled in. On x86-64 it holds the position of the displacement, on AArch64 the
/// index of the branch.
#[derive(Debug)]
pub struct Jump(pub usize);
