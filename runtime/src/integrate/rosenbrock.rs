//! A step of a Rosenbrock method for stiff models. It is linearly implicit: one matrix a step, no iterations.
//!
//! With J = ∂f/∂y and W = I/(hγ) − J,
//!
//! W u_i = f(t + c_i h, y + Σ_{j<i} a_ij u_j) + Σ_{j<i} C_ij u_j / h + h d_i ∂f/∂t,   y⁺ = y + Σ m_j u_j
//!
//! (Hairer & Wanner, *Solving ODEs II*, IV.7). The coefficients are those of Rodas5P (Steinebach, BIT Numer. Math. 63,
//! 2023, as in the tables of OrdinaryDiffEq.jl). The method has order 5 and is L-stable. Its last stages are those of a
//! stiffly accurate method, so the last u is the difference to an embedded result of order 4. The interpolant of order
//! 4 needs no further evaluations.
//!
//! The model gives J and ∂f/∂t ([`Dynamics::jacobian`](crate::Dynamics::jacobian)). J and W have as many rows and
//! columns as the state has entries; both are kept in the workspace.

use super::linear::Factored;
use super::workspace::Workspace;
use super::{Evaluator, Formula, Span, Stepper};
use crate::failure::Reason;
use crate::simulate::epsilon_of;
use crate::{Info, Real};

const STAGES: usize = 8;
const GAMMA: f64 = 0.21193756319429014;
/// c_i.
const NODES: [f64; STAGES] = [
    0.0,
    0.6358126895828704,
    0.4095798393397535,
    0.9769306725060716,
    0.4288403609558664,
    1.0,
    1.0,
    1.0,
];
/// a_ij. The last two stages, and the result, continue where the stage before ended.
const A: [&[f64]; STAGES] = [
    &[],
    &[3.0],
    &[2.849394379747939, 0.45842242204463923],
    &[-6.954028509809101, 2.489845061869568, -10.358996098473584],
    &[
        2.8029986275628964,
        0.5072464736228206,
        -0.3988312541770524,
        -0.04721187230404641,
    ],
    &[
        -7.502846399306121,
        2.561846144803919,
        -11.627539656261098,
        -0.18268767659942256,
        0.030198172008377946,
    ],
    &[
        -7.502846399306121,
        2.561846144803919,
        -11.627539656261098,
        -0.18268767659942256,
        0.030198172008377946,
        1.0,
    ],
    &[
        -7.502846399306121,
        2.561846144803919,
        -11.627539656261098,
        -0.18268767659942256,
        0.030198172008377946,
        1.0,
        1.0,
    ],
];
/// m_j.
const M: [f64; STAGES] = [
    -7.502846399306121,
    2.561846144803919,
    -11.627539656261098,
    -0.18268767659942256,
    0.030198172008377946,
    1.0,
    1.0,
    1.0,
];
/// C_ij.
const C: [&[f64]; STAGES] = [
    &[],
    &[-14.155112264123755],
    &[-17.97296035885952, -2.859693295451294],
    &[147.12150275711716, -1.41221402718213, 71.68940251302358],
    &[
        165.43517024871676,
        -0.4592823456491126,
        42.90938336958603,
        -5.961986721573306,
    ],
    &[
        24.854864614690072,
        -3.0009227002832186,
        47.4931110020768,
        5.5814197821558125,
        -0.6610691825249471,
    ],
    &[
        30.91273214028599,
        -3.1208243349937974,
        77.79954646070892,
        34.28646028294783,
        -19.097331116725623,
        -28.087943162872662,
    ],
    &[
        37.80277123390563,
        -3.2571969029072276,
        112.26918849496327,
        66.9347231244047,
        -40.06618937091002,
        -54.66780262877968,
        -9.48861652309627,
    ],
];
/// d_i.
const D: [f64; STAGES] = [
    0.21193756319429014,
    -0.42387512638858027,
    -0.3384627126235924,
    1.8046452872882734,
    2.325825639765069,
    0.0,
    0.0,
    0.0,
];
/// The part of the interpolant beyond the straight line through both ends: θ(1−θ)(h₁ + θ(h₂ + θ h₃)), weights of the
/// u_j.
const H: [[f64; STAGES]; 3] = [
    [
        25.948786856663858,
        -2.5579724845846235,
        10.433815404888879,
        -2.3679251022685204,
        0.524948541321073,
        1.1241088310450404,
        0.4272876194431874,
        -0.17202221070155493,
    ],
    [
        -9.91568850695171,
        -0.9689944594115154,
        3.0438037242978453,
        -24.495224566215796,
        20.176138334709044,
        15.98066361424651,
        -6.789040303419874,
        -6.710236069923372,
    ],
    [
        11.419903575922262,
        2.8879645146136994,
        72.92137995996029,
        80.12511834622643,
        -52.072871366152654,
        -59.78993625266729,
        -0.15582684282751913,
        4.883087185713722,
    ],
];

/// A step of the method.
pub(crate) struct Rosenbrock<'w, T> {
    span: Span<'w, T>,
    /// Number of coordinates.
    coordinates: usize,
    /// Number of entries of the state that change during a step: all but the discrete states.
    varying: usize,
    /// f at the beginning, then at a stage.
    rate: &'w mut [T],
    stage_rate: &'w mut [T],
    /// ∂f/∂y by rows and ∂f/∂t at the beginning, once they are evaluated there.
    jacobian: &'w mut [T],
    by_time: &'w mut [T],
    has_jacobian: bool,
    factored: Factored<'w, T>,
    /// u₁ … u₈, one after the other.
    u: &'w mut [T],
    /// The state of a stage.
    stage: &'w mut [T],
}

impl<T> Rosenbrock<'_, T> {
    /// Number of scalars of workspace that a step needs for a state of this length.
    pub const fn length(state: usize) -> usize {
        state * state + (STAGES + 6) * state + Factored::<T>::length(state)
    }
}

impl<'w, T: Real> Rosenbrock<'w, T> {
    /// A step for the states of a model.
    pub fn new(info: &Info, workspace: &mut Workspace<'w, T>) -> Self {
        let state = info.state_length();
        Rosenbrock {
            span: Span::new(state, workspace),
            coordinates: info.coordinates.len(),
            varying: info.varying_length(),
            rate: workspace.part(state),
            stage_rate: workspace.part(state),
            jacobian: workspace.part(state * state),
            by_time: workspace.part(state),
            has_jacobian: false,
            factored: Factored::new(state, workspace),
            u: workspace.part(STAGES * state),
            stage: workspace.part(state),
        }
    }

    /// Number of entries of the state that change during a step.
    pub fn varying(&self) -> usize {
        self.varying
    }

    /// f at the beginning, before the step is taken.
    pub fn rate(&self) -> &[T] {
        self.rate
    }

    /// True if ∂f/∂y has been evaluated at the start of this step.
    pub fn knows_jacobian(&self) -> bool {
        self.has_jacobian
    }

    /// ∂f/∂y at the beginning, by rows.
    pub fn jacobian(&self) -> &[T] {
        self.jacobian
    }

    /// Writes the effect of rounding of the state at the start on each entry of f: ε Σ |∂f/∂y_j| |y_j|.
    pub fn rounded(&self, noise: &mut [T]) {
        let y = &*self.span.y;
        let epsilon = T::from_f64(epsilon_of::<T>());
        for (noise, row) in noise.iter_mut().zip(self.jacobian.chunks_exact(y.len())) {
            let mut sum = T::from_f64(0.0);
            for (entry, y) in row.iter().zip(y) {
                sum = entry.abs().mul_add(y.abs(), sum);
            }
            *noise = epsilon * sum;
        }
    }

    /// Writes the derivative of the interpolant with respect to time at t + θh.
    pub fn derive(&self, theta: f64, slope: &mut [T]) {
        slope.fill(T::from_f64(0.0));
        for (j, weight) in slopes(theta).iter().enumerate() {
            add(
                slope,
                1.0 / self.span.h,
                *weight,
                &self.u[j * slope.len()..][..slope.len()],
            );
        }
    }

    /// Evaluates ∂f/∂y and ∂f/∂t at the beginning.
    ///
    /// # Errors
    /// [`Reason::NoJacobian`] of a model without them.
    pub fn differentiate(&mut self, f: &mut Evaluator<'_, T>) -> Result<(), Reason> {
        let t = T::from_f64(f.time(self.span.t));
        if !f
            .model
            .jacobian(t, self.span.y, self.jacobian, self.by_time)
        {
            let formula = Formula::Rodas5;
            return Err(Reason::NoJacobian { formula });
        }
        f.jacobians += 1;
        self.has_jacobian = true;
        Ok(())
    }
}

/// Writes y + h Σ w_j k_j into `to`, as [`combine`](super::combine) does, for weights that the compiler does not know.
fn combine<T: Real>(y: &[T], h: f64, weights: &[f64], k: &[T], to: &mut [T]) {
    to.copy_from_slice(y);
    for (j, weight) in weights.iter().enumerate() {
        add(to, h, *weight, &k[j * y.len()..][..y.len()]);
    }
}

/// Adds h w k to `to`.
fn add<T: Real>(to: &mut [T], h: f64, weight: f64, k: &[T]) {
    if weight != 0.0 {
        let length = T::from_product(h, weight);
        for (to, k) in to.iter_mut().zip(k) {
            *to = length.mul_add(*k, *to);
        }
    }
}

impl<T: Real> Stepper<T> for Rosenbrock<'_, T> {
    fn order_of_estimate(&self) -> u32 {
        5
    }

    fn begin(&mut self, t: f64, y: &[T], rate: &[T]) {
        self.span.begin(t, y);
        self.rate.copy_from_slice(rate);
        self.has_jacobian = false;
    }

    fn take(&mut self, f: &mut Evaluator<'_, T>, h: f64) -> Result<(), Reason> {
        if !self.has_jacobian {
            self.differentiate(f)?;
        }
        self.span.h = h;
        let diagonal = T::from_f64(1.0 / (h * GAMMA));
        self.factored
            .factor(diagonal, self.jacobian, self.varying, self.coordinates);
        let Span { t, y, end, .. } = &mut self.span;
        for i in 0..STAGES {
            let (before, rest) = self.u.split_at_mut(i * y.len());
            let u = &mut rest[..y.len()];
            let rate = match i {
                0 => &*self.rate,
                _ => {
                    combine(y, 1.0, A[i], before, self.stage);
                    f.at(*t + NODES[i] * h, self.stage, self.stage_rate);
                    &*self.stage_rate
                }
            };
            combine(rate, 1.0 / h, C[i], before, u);
            add(u, h, D[i], self.by_time);
            self.factored.solve(u);
        }
        combine(y, 1.0, &M, self.u, end);
        Ok(())
    }

    fn span(&self) -> &Span<'_, T> {
        &self.span
    }

    fn estimate(&mut self, errors: &mut [T]) {
        let last = (STAGES - 1) * errors.len();
        errors.copy_from_slice(&self.u[last..]);
    }

    fn complete(&mut self, _: &mut Evaluator<'_, T>) {}

    fn interpolate(&self, theta: f64, inside: &mut [T]) {
        combine(self.span.y, 1.0, &weights(theta), self.u, inside);
    }

    fn end_rate(&self) -> Option<&[T]> {
        None
    }

    fn neighbour(&self, _: &mut [T]) -> Option<&[T]> {
        // there is no stability limit to watch
        None
    }
}

/// Weights of the u_j in the interpolant.
fn weights(theta: f64) -> [f64; STAGES] {
    let rest = 1.0 - theta;
    core::array::from_fn(|j| {
        let [first, second, third] = H.map(|row| row[j]);
        theta * (M[j] + rest * (first + theta * (second + theta * third)))
    })
}

/// Their derivatives by θ.
fn slopes(theta: f64) -> [f64; STAGES] {
    let rest = 1.0 - theta;
    core::array::from_fn(|j| {
        let [first, second, third] = H.map(|row| row[j]);
        let bend = first + theta * (second + theta * third);
        M[j] + (rest - theta) * bend + theta * rest * (second + 2.0 * theta * third)
    })
}

/// α, Γ, and the weights b(θ) of the method in the form of Hairer & Wanner, whose order conditions are known: Γ⁻¹ = I/γ
/// − C, α = a Γ, b = m Γ.
#[cfg(test)]
pub(crate) mod original {
    use super::{A, C, GAMMA, STAGES, weights};

    pub type Matrix = [[f64; STAGES]; STAGES];

    /// Γ by forward substitution.
    pub fn gamma() -> Matrix {
        let mut inverse = [[0.0; STAGES]; STAGES];
        for (column, result) in (0..STAGES).map(|j| (j, unit(j))) {
            let mut x = [0.0; STAGES];
            for i in 0..STAGES {
                let sum: f64 = C[i].iter().zip(&x).map(|(c, x)| c * x).sum();
                x[i] = GAMMA * (result[i] + sum);
            }
            for i in 0..STAGES {
                inverse[i][column] = x[i];
            }
        }
        inverse
    }

    fn unit(j: usize) -> [f64; STAGES] {
        core::array::from_fn(|i| if i == j { 1.0 } else { 0.0 })
    }

    fn times_gamma(row: &[f64]) -> [f64; STAGES] {
        let gamma = gamma();
        core::array::from_fn(|j| row.iter().zip(&gamma).map(|(a, g)| a * g[j]).sum())
    }

    /// α
    pub fn alpha() -> Matrix {
        core::array::from_fn(|i| times_gamma(A[i]))
    }

    /// b(θ)
    pub fn b(theta: f64) -> [f64; STAGES] {
        times_gamma(&weights(theta))
    }

    /// The nodes c, and d.
    pub fn nodes() -> ([f64; STAGES], [f64; STAGES]) {
        (super::NODES, super::D)
    }
}

#[cfg(test)]
mod tests {
    use super::{slopes, weights};

    /// The weights are polynomials of order 4, for which a central difference of 1e-4 is exact to its square and to
    /// rounding over it.
    #[test]
    fn slopes_are_the_derivatives_of_the_weights() {
        for theta in [0.0, 0.1, 0.5, 0.9, 1.0] {
            let [before, after] = [-1e-4, 1e-4].map(|by| weights(theta + by));
            for (j, slope) in slopes(theta).into_iter().enumerate() {
                let quotient = (after[j] - before[j]) / 2e-4;
                assert!(
                    (slope - quotient).abs() < 1e-5,
                    "{j} at {theta}: {slope} {quotient}"
                );
            }
        }
    }
}
