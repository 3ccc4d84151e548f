//! The samples of a run, which are compared by a norm (states) or by readings (outputs).

/// Samples of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Times \[s\], increasing.
    pub times: Vec<f64>,
    /// For each sample: coordinates, velocities, and states of force laws; orientations in space are quaternions.
    pub states: Vec<Vec<f64>>,
    /// For each sample the outputs, SI.
    pub outputs: Vec<Vec<f64>>,
}

impl Trajectory {
    /// One output over all samples.
    pub fn output(&self, column: usize) -> Vec<f64> {
        let value = |row: &Vec<f64>| row.get(column).copied().unwrap_or(f64::NAN);
        self.outputs.iter().map(value).collect()
    }

    /// One entry of the state over all samples.
    pub fn entry(&self, index: usize) -> impl Iterator<Item = f64> + '_ {
        let value = move |row: &Vec<f64>| row.get(index).copied().unwrap_or(f64::NAN);
        self.states.iter().map(value)
    }
}
