//! All methods of a model as lists.

use super::{Facts, List};
use crate::method::{Method, Start};
use crate::model::{self, Extrapolate, Interpolate, Rule};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::ops::Range;

/// A method as a list.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Routine {
    /// The computation.
    pub list: List,
    /// The values from which the computation starts.
    pub start: Start,
}

/// A curve of a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Name in the description.
    pub name: String,
    /// Abscissa and ordinate, abscissae increasing, at least two points.
    pub points: Vec<[f64; 2]>,
    /// The slope at each point of a cubic curve; `None` for a piecewise linear one.
    pub tangents: Option<Vec<f64>>,
    /// The extrapolation beyond the end points.
    pub extrapolate: Extrapolate,
}

impl From<&model::Curve> for Curve {
    fn from(curve: &model::Curve) -> Curve {
        let cubic = curve.interpolate == Interpolate::Cubic;
        let tangents = (0..curve.points.len()).map(|k| curve.tangent(k));
        Curve {
            name: curve.name.clone(),
            points: curve.points.clone(),
            tangents: cubic.then(|| tangents.collect()),
            extrapolate: curve.extrapolate,
        }
    }
}

/// A [function](crate::dynamics::functions) that was asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Function {
    /// Its name, with its argument: "jacobian(arm/hand)".
    pub name: String,
    /// Its name in Rust and C: "jacobian_arm_hand".
    pub identifier: String,
    /// What it computes.
    pub sentence: Cow<'static, str>,
    /// The names of its rows; a single row may have none.
    pub rows: Vec<String>,
    /// The names of its columns; a single column has none.
    pub columns: Vec<String>,
    /// True if it depends on given accelerations besides time and state.
    pub accelerations: bool,
    /// The computation; its results are the matrix, by rows.
    pub list: List,
}

/// A model as lists: everything needed to evaluate it.
///
/// The lists have exactly the operations of the Rust text that [`Config::source`](crate::Config::source) gives with the
/// same options, in the same order, so their results have the same bits, including the signs of zeros.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lists {
    /// Names, units, sizes.
    pub facts: Facts,
    /// By method, in the order of [`Method::ALL`]. The list of a method with nothing to compute has no results.
    pub routines: Vec<Routine>,
    /// The functions that were asked for, in the order of the requests.
    pub functions: Vec<Function>,
    /// All curves of the model. [`Function::Curve`](crate::expression::Function::Curve) and its like refer to them by
    /// index.
    pub curves: Vec<Curve>,
    /// The name of the user's function, by index of the force
    /// ([`UserCall::force`](crate::expression::UserCall::force)); `None` for other forces.
    pub users: Vec<Option<String>>,
    /// By condition, the values that are allowed.
    pub rules: Vec<Rule>,
    /// The curves of time whose abscissae depend on parameters, by index, one for each result of [`Method::KinkRates`].
    /// The first kink after a time t is the smallest of the times that these curves give for t and their rates
    /// (`kink_after` of the runtime's curves), or +∞ if there are none.
    pub stretched: Vec<u32>,
    /// Ranges in q that consist of unit quaternions, four entries each.
    pub quaternions: Vec<Range<usize>>,
    /// Indices of the state's entries that the results of [`Method::Renewed`] replace, in order.
    pub renewed: Vec<u32>,
    /// Number of values that depend on parameters alone.
    pub derived: usize,
}

impl Lists {
    /// The routine of a method.
    pub fn routine(&self, method: Method) -> &Routine {
        &self.routines[method as usize]
    }

    /// The list of a method.
    pub fn list(&self, method: Method) -> &List {
        &self.routine(method).list
    }
}
