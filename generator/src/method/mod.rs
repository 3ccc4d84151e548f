//! The methods of a model: the inputs and results of each, and the models that have it.
//!
//! | file | content |
//! |---|---|
//! | `table` | a specification for each emitted method, in the order of the emitted text |
//! | `inputs` | inputs of methods: arguments, parameters, values computed before |
//! | `results` | how methods return their results |
//!
//! [`program`](crate::program) puts the operations of each method in order, and [`target`](crate::target) writes them;
//! both walk the table.

pub mod inputs;
pub mod results;
pub mod table;

/// Declares the methods of a model, in the order of their numbers, each with its name in all targets.
macro_rules! methods {
    ($($(#[$doc:meta])* $method:ident $name:literal,)*) => {
        /// A method of a model. A section of the runtime (`bryant_runtime::Section`) is the method of the same name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Method {
            $($(#[$doc])* $method,)*
        }

        impl Method {
            /// All methods, in the order of their numbers.
            pub const ALL: [Method; [$($name),*].len()] = [$(Method::$method),*];

            /// The name of its function in all targets.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Method::$method => $name,)*
                }
            }

            /// The method of a name.
            pub const fn named(name: &str) -> Option<Method> {
                match name.as_bytes() {
                    $(name if same(name, $name.as_bytes()) => Some(Method::$method),)*
                    _ => None,
                }
            }
        }
    };
}

methods! {
    /// The values that depend on parameters alone: [`Input::Derived`](crate::program::Input::Derived), in order. Starts
    /// from parameters.
    Derived "derived",
    /// q, v, z and m at the start of a run. Starts from parameters and the values derived from them.
    InitialState "initial_state",
    /// q̇, v̇ and ż: the rates of the whole state except the memory, whose rates are 0.
    Derivative "derivative",
    /// q̇, from q and v alone.
    CoordinateRates "coordinate_rates",
    /// The event functions.
    EventFunctions "event_functions",
    /// The kinks.
    Kinks "kinks",
    /// The onsets: the gap of each, then the speed of each.
    Onsets "onsets",
    /// The entries of the state that are renewed after an accepted step:
    /// [`Lists::renewed`](crate::program::Lists::renewed).
    Renewed "renewed",
    /// The arguments of the curves of the state.
    Curves "curves",
    /// The pivots, each divided by its diagonal entry of S.
    Pivots "pivots",
    /// The values that the conditions on parameters restrict, each with its rule in
    /// [`Lists::rules`](crate::program::Lists::rules). Starts from parameters and the values derived from them.
    Conditions "conditions",
    /// The factors of time in the arguments of the curves [`Lists::stretched`](crate::program::Lists::stretched).
    /// Starts from parameters and the values derived from them.
    KinkRates "kink_rates",
    /// T \[J\], one result.
    KineticEnergy "kinetic_energy",
    /// Power of each effect \[W\].
    Powers "powers",
    /// Linear \[N s\] and angular momentum \[N m s\], six results; none if no system is free.
    Momentum "momentum",
    /// The rate of the momentum: force \[N\] and moment \[N m\], six results; none if no system is free.
    ExternalWrench "external_wrench",
    /// The outputs.
    Outputs "outputs",
    /// The upper triangle of S, by rows; only if the option `matrices` is set.
    MassMatrix "mass_matrix",
    /// r_s; only if the option `matrices` is set.
    VelocityForces "velocity_forces",
    /// r_k; only if the option `matrices` is set.
    AppliedForces "applied_forces",
}

/// Whether two names are the same, also at compile time.
const fn same(one: &[u8], other: &[u8]) -> bool {
    let mut at = 0;
    while at < one.len() && at < other.len() && one[at] == other[at] {
        at += 1;
    }
    at == one.len() && at == other.len()
}

/// The values from which a method starts, besides time, state and parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// Nothing.
    #[default]
    State,
    /// v̇: the results of [`Method::Derivative`] after q̇, as many as there are velocities.
    Accelerations,
    /// The results of [`Method::EventFunctions`].
    EventFunctions,
}
