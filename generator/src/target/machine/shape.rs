//! Length and precision of the values of a program.

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
    /// The part of a register that the instruction works on.
    pub length: Length,
    /// The numbers that the instruction works on.
    pub precision: Precision,
}

impl Shape {
    /// Number of bytes of memory that the instruction reads or writes.
    pub const fn bytes(self) -> u32 {
        match self.length {
            Length::Scalar => self.precision.bytes(),
            Length::Sixteen => 16,
            Length::ThirtyTwo => 32,
            Length::SixtyFour => 64,
        }
    }

    /// The shape of the whole register: moves between registers and bitwise operations work on whole registers.
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
    /// The part of a register that a value takes up.
    pub shape: Shape,
    /// True if a · b + c is rounded once, false if it is rounded twice.
    pub fused: bool,
    /// True if every scalar is a dual number: a value and, in the next slot, its slope.
    pub slopes: bool,
}
