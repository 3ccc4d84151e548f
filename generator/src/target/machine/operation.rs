//! The operations of which steps consist, and the operands of instructions that every processor has.

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
    /// The larger one; the second where either is NaN or both are zero.
    Max,
    /// The smaller one; the second where either is NaN or both are zero.
    Min,
}

/// An operation on bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bitwise {
    /// Set where both bits are set.
    And,
    /// Set where exactly one of the bits is set.
    Xor,
}

/// The signs in a fused operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signs {
    /// −(a · b) instead of a · b
    pub product: bool,
    /// − c instead of + c
    pub addend: bool,
}

/// A place in the code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place(pub usize);

/// A jump whose displacement must still be filled in; it contains the position of the displacement.
#[derive(Debug)]
pub struct Jump(pub usize);
