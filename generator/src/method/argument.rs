//! The arguments of methods.

/// An argument of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Argument {
    /// t
    Time,
    /// q
    Coordinates,
    /// v
    Velocities,
    /// z
    Auxiliaries,
    /// m
    Memory,
    /// v̇
    Accelerations,
    /// The event functions
    EventFunctions,
}

impl Argument {
    /// The array arguments, in the order in which they are unpacked: z and m first, because a coordinate may have the
    /// same name.
    pub const ARRAYS: [Argument; 6] = [
        Argument::Auxiliaries,
        Argument::Memory,
        Argument::Coordinates,
        Argument::Velocities,
        Argument::Accelerations,
        Argument::EventFunctions,
    ];

    /// The name of the argument in all methods.
    pub fn name(self) -> &'static str {
        match self {
            Argument::Time => "t",
            Argument::Coordinates => "q",
            Argument::Velocities => "v",
            Argument::Auxiliaries => "z",
            Argument::Memory => "m",
            Argument::Accelerations => "a",
            Argument::EventFunctions => "g",
        }
    }
}
