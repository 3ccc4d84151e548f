//! The methods of a model: the inputs and results of each, and the models that have it.
//!
//! | file | content |
//! |---|---|
//! | here | the methods with their names and sentences |
//! | `table` | a specification for each emitted method, in the order of the emitted text |
//! | `argument` | their arguments |
//! | `inputs` | their inputs: arguments, parameters, values computed before |
//! | `results` | how methods return their results |
//!
//! [`program`](crate::program) puts the operations of each method in order, and [`target`](crate::target) writes them;
//! both walk the table.

pub mod argument;
pub mod inputs;
pub mod results;
pub mod table;

use serde::{Deserialize, Serialize};

/// Declares the methods of a model, in the order of their numbers: each with its name in all targets, and a sentence
/// that stands there and in the generated text.
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
        "The event functions, in the order of the list of their names. Where one changes its sign, a step ends and the memory is renewed.";
    Kinks "kinks" "The kinks, in the order of the list of their names. Where one changes its sign, a force law is not smooth.";
    Onsets "onsets"
        "The gaps of all onsets, in the order of the list of their names, then the largest speed at which each gap can close.";
    Renewed "renewed" "The entries of the state that change after an accepted step."
        /// [`Lists::renewed`](crate::program::Lists::renewed) has their places.
        ;
    Curves "curves"
        "The arguments of the curves that depend on the state, and other values that a run watches, in the order of the list of their names.";
    Pivots "pivots"
        "The pivots of the elimination that may vanish, each divided by its diagonal entry of S.";
    Conditions "conditions" "The values that the conditions on parameters restrict."
        /// Each has its rule in [`Lists::rules`](crate::program::Lists::rules). Starts from parameters and the values
        /// derived from them.
        ;
    KinkRates "kink_rates"
        "The factors of time in the arguments of curves that parameters stretch."
        /// Those in [`Lists::stretched`](crate::program::Lists::stretched). Starts from parameters and the values
        /// derived from them.
        ;
    KineticEnergy "kinetic_energy" "The kinetic energy T of all elements, in J.";
    Powers "powers"
        "The power of each effect, in W, in the order of the list of their names. Their sum is the rate of the kinetic energy.";
    Momentum "momentum"
        "The linear momentum, in N s, and the angular momentum about the origin, in N m s, of all free systems, in absolute axes."
        /// Six results; none if no system is free.
        ;
    ExternalWrench "external_wrench"
        "The external force, in N, and its moment about the origin, in N m, on all free systems: the rate of their momentum."
        /// Six results; none if no system is free.
        ;
    Outputs "outputs" "The outputs, in the order of the list of their names.";
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Start {
    /// Nothing.
    #[default]
    State,
    /// v̇: the results of [`Method::Derivative`] after q̇, as many as there are velocities.
    Accelerations,
    /// The results of [`Method::EventFunctions`].
    EventFunctions,
}
