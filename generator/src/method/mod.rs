//! The methods of a model: what each is given, what it returns, and when it exists.
//!
//! | file | what |
//! |---|---|
//! | `table` | a specification for each emitted method, in the order of the emitted text |
//! | `inputs` | what methods are given: arguments, parameters, what was computed before |
//! | `results` | how they return what they computed |
//!
//! [`program`](crate::program) puts the operations of each method in order, and [`target`](crate::target) writes them; both walk the table.

pub mod inputs;
pub mod results;
pub mod table;

/// A method by which a model is evaluated. Those that the runtime calls are in its table of functions, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// What depends on parameters alone: [`Input::Derived`](crate::program::Input::Derived), in order. It starts from parameters.
    Derived,
    /// q, v, z, m where a run starts. It starts from parameters and what is derived from them.
    InitialState,
    /// q̇, v̇ and ż: the rates of all but memory, which are 0.
    Derivative,
    /// q̇, from q and v alone.
    CoordinateRates,
    /// The entries of the state that are renewed when a step is accepted: [`Lists::renewed`](crate::program::Lists::renewed).
    Renewed,
    /// The event functions.
    EventFunctions,
    /// The kinks.
    Kinks,
    /// The onsets: the gap of each, then the speed of each.
    Onsets,
    /// What the curves of the state are evaluated at.
    Curves,
    /// The pivots, as shares of what stands in their place before.
    Pivots,
    /// What parameters must keep: by [`Lists::rules`](crate::program::Lists::rules). It starts from parameters and what is derived from them.
    Conditions,
    /// By what time is multiplied in the curves [`Lists::stretched`](crate::program::Lists::stretched). It starts from parameters and what is derived from them.
    KinkRates,
    /// T \[J\], one result.
    KineticEnergy,
    /// Power of each effect \[W\].
    Powers,
    /// Linear \[N s\] and angular momentum \[N m s\], six results; none where nothing is free.
    Momentum,
    /// Its rate, six results \[N\], \[N m\]; none where nothing is free.
    ExternalWrench,
    /// The outputs.
    Outputs,
    /// The upper triangle of S, by rows; only where it is asked for.
    MassMatrix,
    /// r_s; only where it is asked for.
    VelocityForces,
    /// r_k; only where it is asked for.
    AppliedForces,
}

impl Method {
    /// All of them, in the order of their numbers.
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

/// What a method starts from besides time, state and parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// Nothing.
    #[default]
    State,
    /// v̇: the results of [`Method::Derivative`] behind q̇, as many as velocities.
    Accelerations,
    /// The results of [`Method::EventFunctions`].
    EventFunctions,
}
