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

/// A method of a model. Those that the runtime calls are also in the runtime's table of functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// The values that depend on parameters alone: [`Input::Derived`](crate::program::Input::Derived), in order. Starts
    /// from parameters.
    Derived,
    /// q, v, z and m at the start of a run. Starts from parameters and the values derived from them.
    InitialState,
    /// q̇, v̇ and ż: the rates of the whole state except the memory, whose rates are 0.
    Derivative,
    /// q̇, from q and v alone.
    CoordinateRates,
    /// The entries of the state that are renewed after an accepted step:
    /// [`Lists::renewed`](crate::program::Lists::renewed).
    Renewed,
    /// The event functions.
    EventFunctions,
    /// The kinks.
    Kinks,
    /// The onsets: the gap of each, then the speed of each.
    Onsets,
    /// The arguments of the curves of the state.
    Curves,
    /// The pivots, each divided by its diagonal entry of S.
    Pivots,
    /// The values that the conditions on parameters restrict, each with its rule in
    /// [`Lists::rules`](crate::program::Lists::rules). Starts from parameters and the values derived from them.
    Conditions,
    /// The factors of time in the arguments of the curves [`Lists::stretched`](crate::program::Lists::stretched).
    /// Starts from parameters and the values derived from them.
    KinkRates,
    /// T \[J\], one result.
    KineticEnergy,
    /// Power of each effect \[W\].
    Powers,
    /// Linear \[N s\] and angular momentum \[N m s\], six results; none if no system is free.
    Momentum,
    /// The rate of the momentum: force \[N\] and moment \[N m\], six results; none if no system is free.
    ExternalWrench,
    /// The outputs.
    Outputs,
    /// The upper triangle of S, by rows; only if the option `matrices` is set.
    MassMatrix,
    /// r_s; only if the option `matrices` is set.
    VelocityForces,
    /// r_k; only if the option `matrices` is set.
    AppliedForces,
}

impl Method {
    /// All methods, in the order of their numbers.
    pub const ALL: [Method; 20] = [
        Method::Derived,
        Method::InitialState,
        Method::Derivative,
        Method::CoordinateRates,
        Method::Renewed,
        Method::EventFunctions,
        Method::Kinks,
        Method::Onsets,
        Method::Curves,
        Method::Pivots,
        Method::Conditions,
        Method::KinkRates,
        Method::KineticEnergy,
        Method::Powers,
        Method::Momentum,
        Method::ExternalWrench,
        Method::Outputs,
        Method::MassMatrix,
        Method::VelocityForces,
        Method::AppliedForces,
    ];
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
