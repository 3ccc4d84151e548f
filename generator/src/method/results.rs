//! How a method returns its results.

/// The form of a method's results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Results {
    /// One number.
    Scalar,
    /// An array of numbers.
    Array(Length),
    /// Nothing: each number is passed to an output writer as soon as it is known, by a method named `by`. If there is a
    /// `length`, a second method returns the numbers as an array.
    Written {
        by: &'static str,
        length: Option<Length>,
    },
    /// q and v.
    Start,
    /// q, v and m.
    Renewed,
    /// A vector of the length of v.
    Vector,
    /// A matrix with this number of rows and of columns; the roots are its entries, by rows.
    Table(usize, usize),
    /// A symmetric matrix of the size of v; the roots are its upper triangle, by rows.
    Matrix,
    /// The model with given parameters and the values derived from them.
    Mechanism,
}

/// The number of results of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Length {
    /// The length of q.
    Coordinates,
    /// The length of v.
    Velocities,
    /// The length of z.
    Auxiliaries,
    /// The length of m.
    Memory,
    Outputs,
    EventFunctions,
    Number(usize),
}

impl Results {
    /// True if the results are passed to an output writer one by one.
    pub fn one_by_one(self) -> bool {
        matches!(self, Results::Written { .. })
    }
}
