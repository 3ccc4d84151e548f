//! All methods of a model as lists.

use super::{Facts, List};
use crate::method::{Method, Start};
use crate::model::{Extrapolate, Rule};
use std::ops::Range;

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
