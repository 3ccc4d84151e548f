//! How a method returns what it computed.

/// What a method returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Results {
    /// One number.
    Scalar,
    /// So many numbers.
    Array(Length),
    /// Nothing: each number goes to an output writer as soon as it is known, by a method of this name. Where a length is given, a second
    /// method returns so many numbers.
    Written {
        by: &'static str,
        length: Option<Length>,
    },
    /// q and v.
    Start,
    /// q, v and m.
    Renewed,
    /// A vector as long as v.
    Vector,
    /// A symmetric matrix as large as v; the results are its upper triangle, by rows.
    Matrix,
    /// The model at some parameters, with what is derived from these.
    Mechanism,
}

/// How many numbers a method returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Length {
    /// As many as q has.
    Coordinates,
    /// As many as v has.
    Velocities,
    /// As many as z has.
    Auxiliaries,
    /// As many as m has.
    Memory,
    Outputs,
    EventFunctions,
    Kinks,
    Powers,
    /// As many as there are curves of the state.
    Curves,
    Number(usize),
}

impl Results {
    /// Whether they go to an output writer one by one.
    pub fn one_by_one(self) -> bool {
        matches!(self, Results::Written { .. })
    }
}
