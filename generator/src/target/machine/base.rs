//! The memory of a function.
//!
//! A function in machine code has one argument: a struct of pointers, one for each [`Base`], in the order of its
//! variants. A function that it calls has the arguments `(context: *const (), arguments: *const S, results: *mut S)`.
//! The functions that a list calls are in a table of pairs of pointers: the function, then its context.

/// A region of memory that a function reads or writes, in the order of the pointers. All regions except the last
/// consist of slots of one scalar each. Two regions must not overlap if one of them is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Base {
    /// t, one slot.
    Time,
    /// The state y.
    State,
    /// Parameters of the model.
    Parameters,
    /// Values that depend on parameters alone.
    Derived,
    /// Results, which are written.
    Results,
    /// Working memory of the function, which is written.
    Frame,
    /// The functions that are called, each as a pair of pointers.
    Functions,
}

impl Base {
    /// All regions, in the order of their pointers.
    pub const ALL: [Base; 7] = [
        Base::Time,
        Base::State,
        Base::Parameters,
        Base::Derived,
        Base::Results,
        Base::Frame,
        Base::Functions,
    ];
}
