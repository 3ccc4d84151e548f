//! What the values of a program are.

/// The part of a register that an instruction works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Length {
    /// The lowest number.
    Scalar,
    /// 16 bytes.
    Sixteen,
    /// 32 bytes.
    ThirtyTwo,
    /// 64 bytes.
    SixtyFour,
}

/// Doubles or singles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// `f64`
    Double,
    /// `f32`
    Single,
}

impl Precision {
    /// Size of a number in bytes.
    pub const fn bytes(self) -> u32 {
        match self {
            Precision::Double => 8,
            Precision::Single => 4,
        }
    }
}

/// The length and precision of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// The part of a register that it works on.
    pub length: Length,
    /// The numbers that it works on.
    pub precision: Precision,
}

impl Shape {
    /// Number of bytes of memory that it reads or writes.
    pub const fn bytes(self) -> u32 {
        match self.length {
            Length::Scalar => self.precision.bytes(),
            Length::Sixteen => 16,
            Length::ThirtyTwo => 32,
            Length::SixtyFour => 64,
        }
    }

    /// The whole register that contains it: moves and bitwise operations of registers work on whole registers.
    pub(crate) const fn whole(self) -> Shape {
        match self.length {
            Length::Scalar => Shape {
                length: Length::Sixteen,
                ..self
            },
            _ => self,
        }
    }
}

/// The scalar that code is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Values {
    /// The part of a register that a value takes.
    pub shape: Shape,
    /// Whether a · b + c is rounded once; otherwise it is rounded twice.
    pub fused: bool,
    /// Whether every scalar is a dual number: a value and, in the next slot, its slope.
    pub slopes: bool,
}
