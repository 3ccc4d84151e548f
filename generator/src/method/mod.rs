//! The methods of a model: the inputs and results of each, and the models that have it.
//!
//! | file | content |
//! |---|---|
//! | here | the methods with their names and sentences |
//! | `table` | a specification for each emitted method, in the order of the emitted text |
//! | `inputs` | inputs of methods: arguments, parameters, values computed before |
//! | `results` | how methods return their results |
//!
//! [`program`](crate::program) puts the operations of each method in order, and [`target`](crate::target) writes them;
//! both walk the table.

pub mod inputs;
pub mod results;
pub mod table;

/// Declares the methods of a model, in the order of their numbers: each with its name in all targets, and a sentence that
/// stands there and in the generated text.
macro_rules! methods {
    ($($method:ident $name:literal $sentence:literal $(#[$doc:meta])*;)*) => {
        /// A method of a model. A section of the runtime (`bryant_runtime::Section`) is the method of the same name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Method {
            $(#[doc = $sentence] $(#[$doc])* $method,)*
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

            /// What it computes.
            pub const fn sentence(self) -> &'static str {
                match self {
                    $(Method::$method => $sentence,)*
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
    Derived "derived" "The values that depend on parameters alone, computed once."
        /// [`Input::Derived`](crate::program::Input::Derived), in order. Starts from parameters.
        ;
    InitialState "initial_state" "The state in which a run begins."
        /// q, v, z and m. Starts from parameters and the values derived from them.
        ;
    Derivative "derivative" "The rate of the state at time t, in s."
        /// q̇, v̇ and ż: the memory has no results, because its rates are 0.
        ;
    CoordinateRates "coordinate_rates" "The rate of q, from q and v alone.";
    EventFunctions "event_functions"
        "Functions whose change of sign ends a step, after which the memory is renewed.";
    Kinks "kinks" "Functions whose change of sign is where a force law is not smooth.";
    Onsets "onsets"
        "When laws that do not act begin to, and how far the corners of curves are: the gap of each, then the speed at which each closes at most.";
    Renewed "renewed" "The entries of the state that are renewed after an accepted step."
        /// [`Lists::renewed`](crate::program::Lists::renewed) has their places.
        ;
    Curves "curves"
        "What the curves of the state are evaluated at, the bearings of bent joints and the directions of contacts.";
    Pivots "pivots"
        "Pivots of the elimination that may vanish, as shares of what stands in their place before.";
    Conditions "conditions" "What parameters must keep."
        /// Each has its rule in [`Lists::rules`](crate::program::Lists::rules). Starts from parameters and the values
        /// derived from them.
        ;
    KinkRates "kink_rates"
        "By what time is multiplied in the curves of time that parameters stretch."
        /// Those in [`Lists::stretched`](crate::program::Lists::stretched). Starts from parameters and the values
        /// derived from them.
        ;
    KineticEnergy "kinetic_energy" "The kinetic energy T of all elements, in J.";
    Powers "powers"
        "Power of each effect, in W: together the rate of the kinetic energy.";
    Momentum "momentum"
        "Linear momentum, in N s, and angular momentum about the origin, in N m s, of what is free, in absolute axes."
        /// Six results; none if no system is free.
        ;
    ExternalWrench "external_wrench"
        "Force, in N, and moment about the origin, in N m, on what is free: the rate of its momentum."
        /// Six results; none if no system is free.
        ;
    Outputs "outputs" "What the scene asks to see.";
    MassMatrix "mass_matrix" "S, the mass matrix: S dv/dt = r_s + r_k."
        /// The upper triangle, by rows; only if the option `matrices` is set.
        ;
    VelocityForces "velocity_forces" "r_s, the forces that depend on velocities: S dv/dt = r_s + r_k."
        /// Only if the option `matrices` is set.
        ;
    AppliedForces "applied_forces" "r_k, the applied forces: S dv/dt = r_s + r_k."
        /// Only if the option `matrices` is set.
        ;
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
