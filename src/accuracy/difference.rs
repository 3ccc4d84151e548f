//! The difference of the outputs of two runs.

use crate::table::{Column, Table};
use std::collections::HashMap;
use std::hash::Hash;

/// Size below which an output is noise whose error does not matter, as a share of the largest output with the same
/// unit.
pub(super) const NOISE: f64 = 1e-9;
/// A signal whose size has fallen to this share of that in the first run counts as decreasing with the tolerance.
pub(super) const SHRUNK: f64 = 1e-2;
/// An output whose difference is smaller is known, even if the output is small.
const NEGLIGIBLE: f64 = 1e-3;

/// The difference of two runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The difference of each output, relative to its largest magnitude; 0 for noise.
    pub outputs: Vec<f64>,
    /// The largest of the differences of outputs.
    pub worst: f64,
    /// Name of the output with the largest difference, "" if there is none.
    pub output: String,
    /// The difference of each requested response, relative to itself; empty if one of the runs has no responses. They
    /// do not affect [`Difference::worst`].
    pub responses: Vec<f64>,
    /// The largest of the differences of responses, without responses of signals that are noise or vanish.
    pub worst_response: f64,
    /// Outputs that differ, but are below their floors.
    pub vanishing: Vec<Vanishing>,
}

/// An output of which only a bound is known, such as one that is exactly 0 and decreases with the tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Vanishing {
    /// Its name.
    pub output: String,
    /// Unit of the bound.
    pub unit: String,
    /// Its largest magnitude.
    pub bound: f64,
}

impl Difference {
    /// The difference of the outputs of a run from those of a sharper run; infinite if one of them has fewer samples.
    pub fn of(coarse: &Table, sharp: &Table) -> Difference {
        Self::beyond(coarse, sharp, &[])
    }

    /// The difference of the outputs as [`Difference::of`] computes it, with floors: an output that never exceeds its
    /// floor is vanishing, and its error does not count.
    pub fn beyond(coarse: &Table, sharp: &Table, floors: &[f64]) -> Difference {
        // the first column is the time
        let columns: Vec<(&Column, &Column)> =
            coarse.columns.iter().zip(&sharp.columns).skip(1).collect();
        let size = |(a, b): &(&Column, &Column)| largest(&a.values).max(largest(&b.values));
        let sizes: Vec<f64> = columns.iter().map(size).collect();
        let units = columns.iter().map(|(_, sharp)| sharp.unit.as_str());
        let scales = largest_by_unit(units.zip(sizes.iter().copied()));
        let mut vanishing = Vec::new();
        let outputs: Vec<f64> = columns
            .iter()
            .enumerate()
            .map(|(index, (coarse, sharp))| {
                if coarse.values.len() != sharp.values.len() {
                    return f64::INFINITY;
                }
                if sizes[index] <= NOISE * scales[sharp.unit.as_str()] {
                    return 0.0;
                }
                let own = largest(&sharp.values);
                let both = coarse.values.iter().zip(&sharp.values);
                let error = both.fold(0.0f64, |m, (a, b)| m.max(apart(*a, *b))) / own;
                let counts = floors.get(index).is_none_or(|floor| own > *floor);
                if counts || error <= NEGLIGIBLE {
                    return error;
                }
                vanishing.push(Vanishing {
                    output: sharp.name.clone(),
                    unit: sharp.unit.clone(),
                    bound: own,
                });
                0.0
            })
            .collect();
        let worst = outputs.iter().fold(0.0f64, |m, x| m.max(*x));
        let index = outputs.iter().position(|error| *error == worst);
        let output = index.and_then(|index| sharp.columns.get(index + 1));
        Difference {
            output: output.map_or(String::new(), |column| column.name.clone()),
            outputs,
            worst,
            responses: Vec::new(),
            worst_response: 0.0,
            vanishing,
        }
    }

    /// True if no output and no response differs by more than `limit`.
    pub fn is_within(&self, limit: f64) -> bool {
        self.worst <= limit && self.worst_response <= limit
    }

    /// Raises each error to at least the share `share` of the error in `other`.
    // Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
    #[doc(hidden)]
    pub fn at_least(mut self, other: Option<&Difference>, share: f64) -> Difference {
        let Some(other) = other else { return self };
        for (error, other) in self.outputs.iter_mut().zip(&other.outputs) {
            *error = error.max(share * other);
        }
        for (error, other) in self.responses.iter_mut().zip(&other.responses) {
            *error = error.max(share * other);
        }
        self.worst_response = self.worst_response.max(share * other.worst_response);
        if self.worst < share * other.worst {
            self.worst = share * other.worst;
            self.output.clone_from(&other.output);
        }
        self
    }
}

/// The difference of two values; infinite if exactly one of them is NaN.
fn apart(a: f64, b: f64) -> f64 {
    match a == b || (a.is_nan() && b.is_nan()) {
        true => 0.0,
        false => Some((a - b).abs())
            .filter(|d| !d.is_nan())
            .unwrap_or(f64::INFINITY),
    }
}

/// The largest size for each unit.
pub(super) fn largest_by_unit<U: Eq + Hash>(
    sizes: impl Iterator<Item = (U, f64)>,
) -> HashMap<U, f64> {
    let mut scales = HashMap::new();
    for (unit, size) in sizes {
        let scale = scales.entry(unit).or_insert(0.0f64);
        *scale = scale.max(size);
    }
    scales
}

/// The largest magnitude of some values.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0f64, |m, x| m.max(x.abs()))
}
