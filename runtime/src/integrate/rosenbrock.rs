//! A step of a Rosenbrock method, for stiff models: linearly implicit, one matrix a step, no iterations.
//!
//! With J = ∂f/∂y and W = I/(hγ) − J,
//!
//! W u_i = f(t + c_i h, y + Σ_{j<i} a_ij u_j) + Σ_{j<i} C_ij u_j / h + h d_i ∂f/∂t,   y⁺ = y + Σ m_j u_j
//!
//! (Hairer & Wanner, *Solving ODEs II*, IV.7). The coefficients are those of Rodas5P (Steinebach, BIT Numer. Math. 63, 2023, as in the
//! tables of OrdinaryDiffEq.jl): order 5, L-stable, the last stages those of a stiffly accurate method, so that the last u is the
//! difference to an embedded result of order 4, and an interpolant of order 4 without further evaluations.
//!
//! J and ∂f/∂t are exact: each column is an evaluation over dual numbers ([`Dual`]), n + 1 of them for n entries of the state.
//! W is as large as the state; two such matrices are kept, on the stack.

use super::linear::Factored;
use super::{Evaluator, Span, Stepper, combine};
use crate::model::over;
use crate::{Dual, Model, Real, Vector};

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
/// a_ij; the last two stages, and the result, begin where the one before led.
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
/// What the interpolant has beyond the straight line through both ends: θ(1−θ)(h₁ + θ(h₂ + θ h₃)), over the u_j.
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
pub(crate) struct Rosenbrock<T: Real, M: Model<T>> {
    span: Span<M::State>,
    /// f at the beginning.
    rate: M::State,
    /// The model over dual numbers.
    dual: M::With<Dual<T>>,
    /// ∂f/∂y and ∂f/∂t at the beginning, once evaluated there.
    jacobian: <M::State as Vector<T>>::Square,
    in_time: M::State,
    has_jacobian: bool,
    factored: Factored<T, M::State>,
    /// u₁ … u₈
    u: [M::State; STAGES],
}

impl<T: Real, M: Model<T>> Rosenbrock<T, M> {
    /// ∂f/∂y and ∂f/∂t, column by column.
    #[inline(never)]
    fn differentiate(&mut self, f: &mut Evaluator<'_, T, M>) {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let t = T::from_f64(f.time(self.span.t));
        let at = |value, slope| Dual { value, slope };
        let mut y = <M::With<Dual<T>> as Model<Dual<T>>>::State::splat(at(zero, zero));
        for i in 0..M::State::LEN {
            y[i] = at(self.span.y[i], zero);
        }
        let rate = self.dual.derivative(at(t, one), &y);
        for i in 0..M::State::LEN {
            self.in_time[i] = rate[i].slope;
        }
        for j in 0..varying::<T, M>() {
            y[j].slope = one;
            let rate = self.dual.derivative(at(t, zero), &y);
            y[j].slope = zero;
            for (i, row) in self.jacobian.as_mut().iter_mut().enumerate() {
                row[j] = rate[i].slope;
            }
        }
        f.jacobians += 1;
        self.has_jacobian = true;
    }
}

/// Entries of the state that change during a step: all but the memory of force laws.
fn varying<T: Real, M: Model<T>>() -> usize {
    M::State::LEN - M::INFO.memory.len()
}

impl<T: Real, M: Model<T>> Stepper<T, M> for Rosenbrock<T, M> {
    const ESTIMATE: u32 = 5;

    #[inline(always)]
    fn new(model: &M, t: f64, y: M::State, rate: M::State) -> Self {
        let zero = M::State::splat(T::from_f64(0.0));
        Rosenbrock {
            span: Span {
                t,
                h: 0.0,
                y,
                end: y,
            },
            rate,
            dual: over(model, |value| Dual {
                value,
                slope: T::from_f64(0.0),
            }),
            jacobian: M::State::square(T::from_f64(0.0)),
            in_time: zero,
            has_jacobian: false,
            factored: Factored::new(),
            u: [zero; STAGES],
        }
    }

    #[inline(always)]
    fn begin(&mut self, t: f64, y: M::State, rate: M::State) {
        (self.span.t, self.span.y, self.rate) = (t, y, rate);
        self.has_jacobian = false;
    }

    #[inline(always)]
    fn take(&mut self, f: &mut Evaluator<'_, T, M>, h: f64) {
        if !self.has_jacobian {
            self.differentiate(f);
        }
        self.span.h = h;
        let diagonal = T::from_f64(1.0 / (h * GAMMA));
        let coordinates = M::INFO.coordinates.len();
        let size = varying::<T, M>();
        self.factored
            .factor(diagonal, &self.jacobian, size, coordinates);
        for i in 0..STAGES {
            let Span { t, y, .. } = &self.span;
            let rate = match i {
                0 => self.rate,
                _ => f.at(t + NODES[i] * h, &combine(y, 1.0, A[i], &self.u)),
            };
            let mut u = combine(&rate, 1.0 / h, C[i], &self.u);
            u = combine(&u, h, &[D[i]], &[self.in_time]);
            self.factored.solve(&mut u);
            self.u[i] = u;
        }
        self.span.end = combine(&self.span.y, 1.0, &M, &self.u);
    }

    #[inline(always)]
    fn span(&self) -> &Span<M::State> {
        &self.span
    }

    #[inline(always)]
    fn estimate(&self) -> M::State {
        self.u[STAGES - 1]
    }

    #[inline(always)]
    fn complete(&mut self, _: &mut Evaluator<'_, T, M>) {}

    #[inline(always)]
    fn interpolate(&self, theta: f64) -> M::State {
        combine(&self.span.y, 1.0, &weights(theta), &self.u)
    }

    #[inline(always)]
    fn end_rate(&self) -> Option<&M::State> {
        None
    }

    #[inline(always)]
    fn neighbour(&self) -> Option<(M::State, M::State)> {
        // it has no limit of stability to watch
        None
    }
}

/// Weights of the interpolant, over the u_j.
fn weights(theta: f64) -> [f64; STAGES] {
    let rest = 1.0 - theta;
    core::array::from_fn(|j| {
        let [first, second, third] = H.map(|row| row[j]);
        theta * (M[j] + rest * (first + theta * (second + theta * third)))
    })
}

/// α, Γ, and the weights b(θ) of the method as Hairer & Wanner write it, whose order conditions are known:
/// Γ⁻¹ = I/γ − C, α = a Γ, b = m Γ.
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

    /// Nodes c, and d.
    pub fn nodes() -> ([f64; STAGES], [f64; STAGES]) {
        (super::NODES, super::D)
    }
}
