//! One step of a method for ẏ = f(t, y): the state at its end, its error, and the states inside it.
//!
//! Steps of runs work on slices, call the model as [`Dynamics`], and take their memory from a workspace, so they are
//! compiled once for each scalar. Time and step are `f64` and the same for all lanes; where lanes need different steps,
//! the most demanding lane decides. Every method is a `Stepper`. The time loop in `simulate` chooses the steps and
//! looks for events.
//!
//! | file | what |
//! |---|---|
//! | `tableau` | coefficients of explicit Runge–Kutta methods, a file for each family |
//! | `explicit` | a step of any of them |
//! | `euler` | a step of the semi-implicit Euler method |
//! | `rosenbrock` | a step of the Rosenbrock method for stiff models, over `linear`, elimination |
//! | `switching` | a step of an explicit method, or of that one where the scene is stiff |
//! | `workspace` | the memory of steps and runs |
//! | [`march`](march()) | many steps of one length and nothing else, by Runge–Kutta methods |
//! | `adams` | the same by a multistep method |
//! | [`control`] | tolerances, first step, next step |
//! | `acceleration` | accelerations in that control |

pub(crate) mod acceleration;
mod adams;
pub mod control;
pub(crate) mod euler;
pub(crate) mod explicit;
pub(crate) mod linear;
mod march;
pub(crate) mod rosenbrock;
mod switching;
pub(crate) mod tableau;
pub(crate) mod workspace;

#[cfg(test)]
mod order;

use crate::failure::Reason;
use crate::simulate::Integrator;
use crate::{Dynamics, Info, Model, Real, Task, Vector};
pub use adams::march_adams;
use core::fmt;
use euler::SemiImplicitEuler;
use explicit::Explicit;
#[doc(hidden)]
pub use march::{Coefficients, DOP853};
pub use march::{march, march_dop853};
use rosenbrock::Rosenbrock;
pub(crate) use switching::FormulaChange;
use switching::Switching;
use tableau::dormand_prince::{Dop853, Dopri5};
use tableau::hermite;
use tableau::kutta::{Heun, Merson, Rk4};
use tableau::tsitouras::Tsit5;
use workspace::Workspace;

/// The integration methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Formula {
    /// Semi-implicit (symplectic) Euler: velocities first, coordinates with the new velocities; order 1.
    SemiImplicitEuler,
    /// Modified Euler (Heun): order 2, error by comparison with Euler's method.
    Heun,
    /// The classical Runge–Kutta method of order 4, without an error estimate.
    Rk4,
    /// Merson's method of order 4 with an error estimate.
    Merson,
    /// Dormand & Prince's pair of orders 5 and 4.
    Dopri5,
    /// Tsitouras's pair of orders 5 and 4.
    Tsit5,
    /// Dormand & Prince's method of order 8 with estimates of orders 5 and 3.
    Dop853,
    /// Steinebach's Rosenbrock method of order 5 for stiff models, with an exact Jacobian.
    Rodas5,
}

impl Formula {
    /// All of them, explicit ones first, by order.
    pub const ALL: [Formula; 8] = [
        Formula::SemiImplicitEuler,
        Formula::Heun,
        Formula::Rk4,
        Formula::Merson,
        Formula::Dopri5,
        Formula::Tsit5,
        Formula::Dop853,
        Formula::Rodas5,
    ];

    /// Its name in commands and files.
    pub const fn name(self) -> &'static str {
        match self {
            Formula::SemiImplicitEuler => "semi-implicit-euler",
            Formula::Heun => "heun",
            Formula::Rk4 => "rk4",
            Formula::Merson => "merson",
            Formula::Dopri5 => "dopri5",
            Formula::Tsit5 => "tsit5",
            Formula::Dop853 => "dop853",
            Formula::Rodas5 => "rodas5",
        }
    }

    /// Its name for people.
    pub const fn title(self) -> &'static str {
        match self {
            Formula::SemiImplicitEuler => "semi-implicit Euler",
            Formula::Heun => "modified Euler (Heun)",
            Formula::Rk4 => "Runge–Kutta 4",
            Formula::Merson => "Merson 4(5)",
            Formula::Dopri5 => "Dormand–Prince 5(4)",
            Formula::Tsit5 => "Tsitouras 5(4)",
            Formula::Dop853 => "Dormand–Prince 8(5,3)",
            Formula::Rodas5 => "Rosenbrock 5(4), stiff",
        }
    }

    /// The method with this name; `None` if there is none.
    pub fn named(name: &str) -> Option<Formula> {
        Self::ALL.into_iter().find(|formula| formula.name() == name)
    }

    /// The order of the method: where the model is smooth, the error of a run falls like this power of the step.
    pub const fn order(self) -> u32 {
        match self {
            Formula::SemiImplicitEuler => 1,
            Formula::Heun => 2,
            Formula::Rk4 | Formula::Merson => 4,
            Formula::Dopri5 | Formula::Tsit5 | Formula::Rodas5 => 5,
            Formula::Dop853 => 8,
        }
    }

    /// The largest |hλ|, Re λ ≤ 0, at which the method is stable in some direction of the complex plane. A step above
    /// this limit over the fastest motion of a scene grows without bound, whatever that motion is. `None` where there
    /// is no such limit.
    ///
    /// For explicit Runge–Kutta methods the limit is the farthest point of |R(z)| = 1 in the left half plane, where R
    /// is their stability polynomial (Hairer & Wanner, *Solving ODEs II*, IV.2); a test computes it from the tableau.
    /// For semi-implicit Euler it is hω of the undamped oscillator, and also hc of ẋ = −c x.
    pub const fn stability_limit(self) -> Option<f64> {
        match self {
            Formula::SemiImplicitEuler => Some(2.0),
            Formula::Heun => Some(LIMIT_HEUN),
            Formula::Rk4 => Some(LIMIT_RK4),
            Formula::Merson => Some(LIMIT_MERSON),
            Formula::Dopri5 => Some(LIMIT_DOPRI5),
            Formula::Tsit5 => Some(LIMIT_TSIT5),
            Formula::Dop853 => Some(LIMIT_DOP853),
            Formula::Rodas5 => None,
        }
    }

    /// Whether runs by this method may change to the Rosenbrock method where the scene is stiff. Such methods are
    /// explicit, and have two stages at the end of each step that tell how fast the fastest motion is.
    pub const fn may_switch(self) -> bool {
        acceleration::limits(self).is_some()
    }

    /// Whether the method estimates its error and so can choose its steps.
    pub const fn estimates_error(self) -> bool {
        !matches!(self, Formula::SemiImplicitEuler | Formula::Rk4)
    }
}

/// The largest number of stages of an explicit method, including those of its interpolant.
const MOST_STAGES: usize = 16;

/// [`Formula::stability_limit`], rounded up.
const LIMIT_HEUN: f64 = 2.198;
const LIMIT_RK4: f64 = 2.961;
const LIMIT_MERSON: f64 = 3.549;
const LIMIT_DOPRI5: f64 = 3.400;
const LIMIT_TSIT5: f64 = 3.545;
const LIMIT_DOP853: f64 = 6.793;

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A step of some method, which is begun, taken, judged and interpolated.
///
/// The value is kept from one step to the next and filled in place. Its memory is a part of the workspace of the run.
pub(crate) trait Stepper<T: Real> {
    /// The error estimate falls like this power of the step; 0 where there is no estimate.
    fn order_of_estimate(&self) -> u32;
    /// Begins the next step at (`t`, `y`), where the derivative is `rate`.
    fn begin(&mut self, t: f64, y: &[T], rate: &[T]);
    /// Takes the step of length `h`, forwards.
    ///
    /// # Errors
    /// [`Reason::NoJacobian`], if the method needs a Jacobian and the model has none.
    fn take(&mut self, f: &mut Evaluator<'_, T>, h: f64) -> Result<(), Reason>;
    /// The start of the step, its length, and its end.
    fn span(&self) -> &Span<'_, T>;
    /// Evaluates the derivative at the end, if the next step begins with it anyway. At most once a step.
    fn finish(&mut self, _: &mut Evaluator<'_, T>) {}
    /// Writes the estimated error of each entry at the end. Without an estimate the content is arbitrary.
    fn estimate(&mut self, errors: &mut [T]);
    /// Evaluates what [`Stepper::interpolate`] needs beyond the step itself, at most once a step.
    fn complete(&mut self, f: &mut Evaluator<'_, T>);
    /// The state at t + θh, θ in 0..=1, not normalised. Its order is that of the method or one less. Call
    /// [`Stepper::complete`] before.
    fn interpolate(&self, theta: f64, inside: &mut [T]);
    /// Hermite's cubic through the states and derivatives at both ends, at t + θh. Returns `false` for a method whose
    /// interpolant uses the stages of the step alone. Other interpolants evaluate the model at further states, and a
    /// force that acts there and nowhere else spoils them. Call [`Stepper::complete`] before.
    fn cubic(&self, _theta: f64, _inside: &mut [T]) -> bool {
        false
    }
    /// The derivative at the end of the step, if it is known.
    fn end_rate(&self) -> Option<&[T]>;
    /// Writes a state near the end of the step into `state` and returns the derivative there. The two, compared with
    /// the end, tell how fast the fastest motion is. The state is that of the last stage at the end time, or the start
    /// of the step. `None` for a step that nothing compares, such as an implicit one.
    fn neighbour(&self, state: &mut [T]) -> Option<&[T]>;
    /// True while the method is switched to an implicit one.
    fn switched(&self) -> bool {
        false
    }
    /// Writes the derivative of the interpolant with respect to time at t + θh, if the step is
    /// [switched](Stepper::switched).
    fn slope(&self, _theta: f64, _slope: &mut [T]) {}
    /// Writes the effect of rounding of the state on each entry of the derivative at the start of a
    /// [switched](Stepper::switched) step. Returns h|λ| of the fastest motion there.
    fn noise(&self, _noise: &mut [T]) -> f64 {
        0.0
    }
    /// Notes an accepted step of this length, which follows this many rejected tries; `h_lambda_fourth` is (h|λ|)⁴ of
    /// an explicit step. Returns `Some` if the next step uses another formula. The change takes effect with
    /// [`Stepper::begin`].
    fn turn(
        &mut self,
        _length: f64,
        _rejected: u64,
        _h_lambda_fourth: f64,
    ) -> Option<FormulaChange> {
        None
    }
}

/// Where a step begins, its length, and where it ends.
pub(crate) struct Span<'w, T> {
    /// Time at its beginning \[s\].
    pub t: f64,
    /// Its length \[s\].
    pub h: f64,
    /// The state at its beginning.
    pub y: &'w mut [T],
    /// The state at its end, not normalised.
    pub end: &'w mut [T],
}

impl<'w, T: Real> Span<'w, T> {
    /// A step that has not begun, for a state of this length. It needs twice as many scalars of workspace.
    fn new(state: usize, workspace: &mut Workspace<'w, T>) -> Self {
        Span {
            t: 0.0,
            h: 0.0,
            y: workspace.part(state),
            end: workspace.part(state),
        }
    }

    /// Begins the next step at (`t`, `y`).
    fn begin(&mut self, t: f64, y: &[T]) {
        self.t = t;
        self.y.copy_from_slice(y);
    }

    /// The state at t + θh on the cubic with these derivatives at both ends.
    fn cubic(&self, [first, last]: [&[T]; 2], theta: f64, inside: &mut [T]) {
        let [step, at_first, at_last] = hermite(T::from_f64(theta));
        let h = T::from_f64(self.h);
        let [at_first, at_last] = [at_first * h, at_last * h];
        for (i, state) in inside.iter_mut().enumerate() {
            let y = self.y[i];
            let moved = step.mul_add(self.end[i] - y, y);
            *state = at_last.mul_add(last[i], at_first.mul_add(first[i], moved));
        }
    }
}

/// Number of scalars of workspace that a step of a method needs for this model.
pub(crate) const fn step_length(method: &Integrator, info: &Info) -> usize {
    let state = info.state_length();
    let more = match method.switches() {
        true => Switching::<()>::more(state),
        false => 0,
    };
    more + match method.formula {
        Formula::SemiImplicitEuler => SemiImplicitEuler::<()>::length(state),
        Formula::Heun => Explicit::<(), Heun>::length(state),
        Formula::Rk4 => Explicit::<(), Rk4>::length(state),
        Formula::Merson => Explicit::<(), Merson>::length(state),
        Formula::Dopri5 => Explicit::<(), Dopri5>::length(state),
        Formula::Tsit5 => Explicit::<(), Tsit5>::length(state),
        Formula::Dop853 => Explicit::<(), Dop853>::length(state),
        Formula::Rodas5 => Rosenbrock::<()>::length(state),
    }
}

/// A step of any method.
#[expect(clippy::large_enum_variant, reason = "a run has one of them")]
pub(crate) enum AnyStepper<'w, T> {
    SemiImplicitEuler(SemiImplicitEuler<'w, T>),
    Heun(Explicit<'w, T, Heun>),
    Rk4(Explicit<'w, T, Rk4>),
    Merson(Explicit<'w, T, Merson>),
    Dopri5(Explicit<'w, T, Dopri5>),
    Tsit5(Explicit<'w, T, Tsit5>),
    Dop853(Explicit<'w, T, Dop853>),
    Rodas5(Rosenbrock<'w, T>),
    Switching(Switching<'w, T>),
}

impl<'w, T: Real> AnyStepper<'w, T> {
    /// A step of a method for this model that has not begun.
    pub fn new(method: &Integrator, info: &Info<'_>, workspace: &mut Workspace<'w, T>) -> Self {
        match method.switches() {
            true => AnyStepper::Switching(Switching::new(method.formula, info, workspace)),
            false => AnyStepper::by(method.formula, info, workspace),
        }
    }

    /// A step by one formula.
    fn by(formula: Formula, info: &Info<'_>, workspace: &mut Workspace<'w, T>) -> Self {
        let state = info.state_length();
        let coordinates = info.coordinates.len();
        match formula {
            Formula::SemiImplicitEuler => {
                AnyStepper::SemiImplicitEuler(SemiImplicitEuler::new(state, coordinates, workspace))
            }
            Formula::Heun => AnyStepper::Heun(Explicit::new(state, workspace)),
            Formula::Rk4 => AnyStepper::Rk4(Explicit::new(state, workspace)),
            Formula::Merson => AnyStepper::Merson(Explicit::new(state, workspace)),
            Formula::Dopri5 => AnyStepper::Dopri5(Explicit::new(state, workspace)),
            Formula::Tsit5 => AnyStepper::Tsit5(Explicit::new(state, workspace)),
            Formula::Dop853 => AnyStepper::Dop853(Explicit::new(state, workspace)),
            Formula::Rodas5 => AnyStepper::Rodas5(Rosenbrock::new(info, workspace)),
        }
    }

    /// The step as a trait object.
    pub fn stepper(&mut self) -> &mut dyn Stepper<T> {
        match self {
            AnyStepper::SemiImplicitEuler(step) => step,
            AnyStepper::Heun(step) => step,
            AnyStepper::Rk4(step) => step,
            AnyStepper::Merson(step) => step,
            AnyStepper::Dopri5(step) => step,
            AnyStepper::Tsit5(step) => step,
            AnyStepper::Dop853(step) => step,
            AnyStepper::Rodas5(step) => step,
            AnyStepper::Switching(step) => step,
        }
    }
}

/// Evaluates f for a step that must not look beyond its end, and counts the evaluations.
pub(crate) struct Evaluator<'a, T: Real> {
    pub model: &'a dyn Dynamics<T>,
    /// Number of evaluations so far.
    pub count: u64,
    /// Number of Jacobians so far.
    pub jacobians: u64,
    /// The latest time at which f is evaluated.
    ///
    /// A step that ends on a kink of a curve must see the curve as it is before the kink. So the time of its last
    /// stages is the largest floating-point number below the kink.
    pub latest: f64,
    /// Whether to search for the first evaluation with a value that is not finite.
    pub searching: bool,
    /// The evaluation found, if any.
    pub found: Option<NotFinite>,
    /// The state of that evaluation.
    pub found_at: &'a mut [T],
}

/// An evaluation with a value that is not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NotFinite {
    /// Time of the evaluation \[s\].
    pub t: f64,
    /// Index of the first entry that is not finite.
    pub index: usize,
    /// Whether the entry belongs to the derivative; otherwise it belongs to the state.
    pub in_derivative: bool,
}

impl<'a, T: Real> Evaluator<'a, T> {
    /// An evaluator for a model, with room for a state.
    pub fn new(model: &'a dyn Dynamics<T>, found_at: &'a mut [T]) -> Self {
        Evaluator {
            model,
            count: 0,
            jacobians: 0,
            latest: f64::INFINITY,
            searching: false,
            found: None,
            found_at,
        }
    }

    /// ẏ at (`t`, `y`).
    #[inline]
    pub fn at(&mut self, t: f64, y: &[T], rate: &mut [T]) {
        self.count += 1;
        self.model.derivative(T::from_f64(self.time(t)), y, rate);
        if self.searching {
            self.look(t, y, rate);
        }
    }

    /// The time at which f is evaluated when a stage asks for `t`.
    #[inline]
    pub fn time(&self, t: f64) -> f64 {
        t.min(self.latest)
    }

    /// Stores an evaluation if it is the first with a value that is not finite.
    #[cold]
    pub fn look(&mut self, t: f64, y: &[T], rate: &[T]) {
        if self.found.is_some() {
            return;
        }
        let of_state = first_non_finite(y).map(|index| (index, false));
        let found = of_state.or_else(|| first_non_finite(rate).map(|index| (index, true)));
        self.found = found.map(|(index, in_derivative)| NotFinite {
            t,
            index,
            in_derivative,
        });
        self.found_at.copy_from_slice(y);
    }
}

/// Writes ẏ at (`t`, `y`) into `rate`.
pub(crate) struct Rate<'a, T, M, S> {
    pub model: &'a M,
    pub t: T,
    pub y: &'a S,
    pub rate: &'a mut S,
}

impl<T: Real, M: Model<T>> Task for Rate<'_, T, M, M::State> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        self.model.each_rate(self.t, self.y, self.rate);
    }
}

/// Writes y + h Σ w_j k_j into `to`. `k` holds one k_j after the other, each as long as `y` and `to`. Weights of 0 cost
/// nothing where the compiler knows them.
#[inline(always)]
pub(crate) fn combine<T: Real>(y: &[T], h: f64, weights: &[f64], k: &[T], to: &mut [T]) {
    let length = to.len();
    let y = &y[..length];
    let mut rows = [y; MOST_STAGES];
    let mut lengths = [T::from_f64(0.0); MOST_STAGES];
    for (j, weight) in weights.iter().enumerate() {
        if *weight != 0.0 {
            rows[j] = &k[j * length..][..length];
            lengths[j] = T::from_product(h, *weight);
        }
    }
    // by index, so that the compiler sees that all have the same length
    for i in 0..length {
        let mut sum = y[i];
        for (j, weight) in weights.iter().enumerate() {
            if *weight != 0.0 {
                sum = lengths[j].mul_add(rows[j][i], sum);
            }
        }
        to[i] = sum;
    }
}

/// [`combine`] for arrays, with a step that may differ between lanes: its products with the weights are rounded to the
/// scalar first.
#[inline(always)]
pub(crate) fn combine_into<T: Real, S: Vector<T>>(
    y: &S,
    h: T,
    weights: &[f64],
    k: &[S],
    to: &mut S,
) {
    let mut lengths = [T::from_f64(0.0); MOST_STAGES];
    for (length, weight) in lengths.iter_mut().zip(weights) {
        *length = T::from_f64(*weight) * h;
    }
    for i in 0..S::LEN {
        let mut sum = y[i];
        for (j, weight) in weights.iter().enumerate() {
            if *weight != 0.0 {
                sum = lengths[j].mul_add(k[j][i], sum);
            }
        }
        to[i] = sum;
    }
}

/// Index of the first entry that is not finite.
#[inline(always)]
pub(crate) fn first_non_finite<T: Real>(y: &[T]) -> Option<usize> {
    y.iter().position(|entry| !entry.is_finite())
}
