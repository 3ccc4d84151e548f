//! All methods of a model as lists.

use super::{Facts, List};
use crate::model::{Extrapolate, Rule};
use std::ops::Range;

/// A method of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// What depends on parameters alone: [`Input::Derived`](super::Input::Derived), in order. It starts from parameters.
    Derived,
    /// q, v, z, m where a run starts. It starts from parameters and what is derived from them.
    InitialState,
    /// q̇, v̇ and ż: the rates of all but memory, which are 0.
    Derivative,
    /// q̇, from q and v alone.
    CoordinateRates,
    /// The entries of the state that are renewed when a step is accepted: [`Lists::renewed`].
    Renewed,
    /// The guards.
    Guards,
    /// The kinks.
    Kinks,
    /// The onsets: the gap of each, then the speed of each.
    Onsets,
    /// What the curves of the state are evaluated at.
    Curves,
    /// The pivots, as shares of what stands in their place before.
    Pivots,
    /// What parameters must keep: by [`Lists::rules`]. It starts from parameters and what is derived from them.
    Conditions,
    /// By what time is multiplied in the curves [`Lists::stretched`]. It starts from parameters and what is derived from them.
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
        Method::Guards,
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
    /// The results of [`Method::Guards`].
    Guards,
}

/// A method as a list.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Routine {
    /// What it computes.
    pub list: List,
    /// What is computed before.
    pub start: Start,
}

/// A curve of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name in the description.
    pub name: String,
    /// Abscissa and ordinate, abscissae increasing, at least two points.
    pub points: Vec<[f64; 2]>,
    /// The slope at each point of a cubic; `None` of straight lines.
    pub tangents: Option<Vec<f64>>,
    /// What holds beyond the outermost points.
    pub extrapolate: Extrapolate,
}

/// A model as lists: all that is needed to evaluate it.
///
/// The lists have the very operations of the Rust text that [`Config::source`](crate::Config::source) gives with the same options, in its
/// order, so their results have the same bits, signs of zero included. Methods that are longer than `Options::merged` are the one
/// exception: the sign of a zero may differ there.
#[derive(Clone, Debug, PartialEq)]
pub struct Lists {
    /// Names, units, sizes.
    pub facts: Facts,
    /// By method, in the order of [`Method::ALL`]. A list without results where there is nothing to compute.
    pub routines: Vec<Routine>,
    /// All curves of the model: [`Function::Curve`](crate::expression::Function::Curve) and its like say which by its index.
    pub curves: Vec<Curve>,
    /// By force of the model, which [`UserCall::force`](crate::expression::UserCall::force) counts: the name of the user's function,
    /// where it has one.
    pub users: Vec<Option<String>>,
    /// By condition, what its value may be.
    pub rules: Vec<Rule>,
    /// The curves of time that parameters stretch, by index, one for each result of [`Method::KinkRates`]. The first kink after a time t is
    /// the smallest of what the curves give for t and their rates (`kink_after` of the runtime's curves), +∞ where there are none.
    pub stretched: Vec<u32>,
    /// Ranges of coordinates, each a whole number of unit quaternions of four entries.
    pub quaternions: Vec<Range<usize>>,
    /// The entries of the state that the results of [`Method::Renewed`] replace, in order.
    pub renewed: Vec<u32>,
    /// Number of values that depend on parameters alone.
    pub derived: usize,
}

impl Lists {
    /// A method.
    pub fn routine(&self, method: Method) -> &Routine {
        &self.routines[method as usize]
    }

    /// Its list.
    pub fn list(&self, method: Method) -> &List {
        &self.routine(method).list
    }
}
