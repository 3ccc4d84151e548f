//! Inputs that follow curves of time, in place of values that are set during a run.

use super::curve::{Curve, Extrapolate, Interpolate};
use super::{Model, Number};
use crate::description::tree::MAX_POINTS;

impl Model {
    /// Lets an input follow points over time \[s; SI\], with straight lines between them and constant beyond them.
    ///
    /// `input` is its index in [`Model::parameters`]; there are at least two points, at increasing times. The input
    /// stays a parameter, which nothing depends on.
    pub fn set_over_time(&mut self, input: usize, points: Vec<[f64; 2]>) {
        let curve = self.curves.len();
        let name = format!("input {}", self.parameters[input].name);
        let all = Curve {
            name,
            points,
            interpolate: Interpolate::Linear,
            extrapolate: Extrapolate::Hold,
            states_extrapolation: true,
            thinned: None,
        };
        self.curves.push(all.with_at_most(MAX_POINTS));
        for number in self.numbers_mut() {
            *number = number.with_parameters(&|index| match index == input {
                true => Number::OverTime { curve, input },
                false => Number::Parameter(index),
            });
        }
    }
}
