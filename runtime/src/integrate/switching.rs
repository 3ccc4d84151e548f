//! A stepper that uses an explicit method, or the Rosenbrock method for as long as the scene is stiff.
//!
//! A scene is stiff where stability and not accuracy limits the steps of an explicit method. The test is that of DOPRI5
//! (Hairer & Wanner, *Solving ODEs II*, IV.2, after Shampine 1977): h|λ| of the fastest motion is at the limit of the
//! method in many accepted steps, and is never below it in [`CALM`] steps in a row. Then the Rosenbrock method is
//! tried, from the same step on. LSODA compares the steps that both methods could take (Petzold, *SIAM J. Sci. Stat.
//! Comput.* 4, 1983). Here the steps that both did take are compared: an implicit step costs a known multiple of an
//! explicit one, and if it does not reach that many times as far, the explicit method goes on, and waits twice as long
//! before the next trial. So vain trials cost only a small part of the run.
//!
//! The Rosenbrock method has the Jacobian J at hand. At each step, two products with J turn a vector towards the
//! fastest motion, and multiply it by |λ|²: over two products the growth does not depend on the phase of an
//! oscillation. If h|λ| is below the limit of the explicit method for [`SLOW`] steps in a row, the explicit method
//! takes over again.
//!
//! A model without its Jacobian stays with the explicit method.

use super::acceleration::limits;
use super::control::square_root;
use super::explicit::Explicit;
use super::rosenbrock::Rosenbrock;
use super::tableau::dormand_prince::{Dop853, Dopri5};
use super::tableau::kutta::{Heun, Merson};
use super::tableau::tsitouras::Tsit5;
use super::workspace::Workspace;
use super::{Evaluator, Formula, Span, Stepper};
use crate::failure::Reason;
use crate::{Info, Real};

/// Steps at the limit before the implicit method is tried for the first time. This many explicit steps take
/// milliseconds, and no scene that is over in a few hundred steps changes its method.
const WAIT: u32 = 1000;
/// Steps in a row below the limit after which the count begins anew (6 in DOPRI5).
const CALM: u32 = 6;
/// A step counts as at the limit if h|λ| is at least this share of the limit. The smaller the tolerated share of
/// accelerations, the further below the limit steps settle.
const AT: f64 = 0.6;
/// STRICT is the share of the limit above which an oscillation has at most a few hundredths of the largest acceleration
/// (`acceleration`). If at least the share MOST of the steps at the limit are above it, an implicit method may begin
/// with far longer steps, which damp the oscillation.
const STRICT: f64 = 0.9;
const MOST: f64 = 0.8;
/// Tries of implicit steps after which their cost is compared.
const TRIAL: u64 = 20;
/// LATELY is the number of steps at the limit over which the recent length of explicit steps is averaged. This average
/// counts only if it is below FAR_LESS times that of all such steps: a body that comes to rest on friction takes far
/// shorter steps than before.
const LATELY: u32 = 200;
const FAR_LESS: f64 = 0.1;
/// The factor by which the implicit method must be cheaper.
const PAYS: f64 = 2.0;
/// Implicit steps in a row below the limit of the explicit method, after which the explicit method takes over again.
const SLOW: u32 = 10;
/// Numbers of products with the first Jacobian, and with each later one. The growth over the last two counts.
const PRODUCTS: [usize; 2] = [20, 2];

/// A change of the formula for the next step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FormulaChange {
    /// True if the new formula is to begin with far longer steps, because it did not pay without them.
    pub leaps: bool,
    /// The longest step that the new formula may begin with \[s\].
    pub longest: f64,
}

/// A step of an explicit method with two stages at its end.
enum Limited<'w, T> {
    Heun(Explicit<'w, T, Heun>),
    Merson(Explicit<'w, T, Merson>),
    Dopri5(Explicit<'w, T, Dopri5>),
    Tsit5(Explicit<'w, T, Tsit5>),
    Dop853(Explicit<'w, T, Dop853>),
}

/// The counts that decide when to change the method.
struct SwitchingCounts {
    /// Steps at the limit before the implicit method is tried.
    wait: u32,
    /// Steps at the limit, and explicit steps in a row below it, or implicit steps in a row within it.
    at_limit: u32,
    calm: u32,
    /// Steps at the limit that are very close to it ([`STRICT`]).
    strict: u32,
    /// Time covered \[s\] and tries since the count began, and both at the start of the last [`LATELY`] steps at the
    /// limit.
    gone: f64,
    tries: u64,
    before: (f64, u64),
    /// Mean length per try of the explicit method, recently, and the value that counts \[s\].
    lately: f64,
    stride: f64,
}

impl SwitchingCounts {
    fn count_anew(&mut self) {
        (self.at_limit, self.calm, self.strict) = (0, 0, 0);
        (self.gone, self.tries) = (0.0, 0);
        self.before = (0.0, 0);
    }

    fn add(&mut self, length: f64, rejected: u64) {
        self.gone += length;
        self.tries += 1 + rejected;
    }

    /// Counts an accepted explicit step with (h|λ|)⁴ = `h_lambda_fourth` after this many `rejected` tries. True if the
    /// implicit method is to be tried. A step after a rejected try counts as at the limit, because the first try was
    /// above it: at the corner of a friction law |λ| changes from step to step.
    fn is_stiff(&mut self, [h_lambda_fourth, limit]: [f64; 2], rejected: u64) -> bool {
        let is_at = |share: f64| {
            let squared = (share * limit) * (share * limit);
            h_lambda_fourth >= squared * squared
        };
        if is_at(AT) || rejected > 0 {
            (self.at_limit, self.calm) = (self.at_limit + 1, 0);
            self.strict += u32::from(is_at(STRICT));
            if self.at_limit.is_multiple_of(LATELY) {
                let (gone, tries) = self.before;
                self.lately = (self.gone - gone) / (self.tries - tries) as f64;
                self.before = (self.gone, self.tries);
            }
        } else {
            self.calm += 1;
            if self.calm >= CALM {
                self.count_anew();
            }
        }
        self.at_limit >= self.wait
    }
}

/// A step of either method.
pub(crate) struct Switching<'w, T> {
    formula: Formula,
    explicit: Limited<'w, T>,
    rosenbrock: Rosenbrock<'w, T>,
    /// True while the implicit method is used.
    implicit: bool,
    /// True if the model has no Jacobian.
    never: bool,
    rule: SwitchingCounts,
    /// Cost of an implicit step over that of an explicit one.
    cost: f64,
    /// The derivative at the end of an implicit step, once it is known.
    end: &'w mut [T],
    has_end: bool,
    /// The direction of the fastest motion, and its product with the Jacobian.
    motion: &'w mut [T],
    product: &'w mut [T],
    /// |λ| of that motion \[1/s\].
    fastest: f64,
}

impl<T> Switching<'_, T> {
    /// Number of scalars of workspace that a step needs, beyond those of its explicit method.
    pub const fn more(state: usize) -> usize {
        Rosenbrock::<T>::length(state) + 3 * state
    }
}

impl<'w, T: Real> Switching<'w, T> {
    /// A step that begins with this explicit method.
    pub fn new(formula: Formula, info: &Info, workspace: &mut Workspace<'w, T>) -> Self {
        let state = info.state_length();
        let n = state as f64;
        // an implicit step evaluates the equations in each stage, for the slopes, and over dual numbers for several
        // columns of the Jacobian at once, and factors a matrix
        let implicit = 9.0 + 0.5 * n + 0.01 * n * n;
        let explicit = match formula {
            Formula::Dop853 => 12.0,
            _ => 6.0,
        };
        Switching {
            formula,
            explicit: match formula {
                Formula::Heun => Limited::Heun(Explicit::new(state, workspace)),
                Formula::Merson => Limited::Merson(Explicit::new(state, workspace)),
                Formula::Tsit5 => Limited::Tsit5(Explicit::new(state, workspace)),
                Formula::Dop853 => Limited::Dop853(Explicit::new(state, workspace)),
                _ => Limited::Dopri5(Explicit::new(state, workspace)),
            },
            rosenbrock: Rosenbrock::new(info, workspace),
            implicit: false,
            never: false,
            rule: SwitchingCounts {
                wait: WAIT,
                at_limit: 0,
                calm: 0,
                strict: 0,
                gone: 0.0,
                tries: 0,
                before: (0.0, 0),
                lately: 0.0,
                stride: 0.0,
            },
            cost: implicit / explicit,
            end: workspace.part(state),
            has_end: false,
            motion: workspace.part(state),
            product: workspace.part(state),
            fastest: 0.0,
        }
    }

    fn now(&self) -> &dyn Stepper<T> {
        match (self.implicit, &self.explicit) {
            (true, _) => &self.rosenbrock,
            (false, Limited::Heun(step)) => step,
            (false, Limited::Merson(step)) => step,
            (false, Limited::Dopri5(step)) => step,
            (false, Limited::Tsit5(step)) => step,
            (false, Limited::Dop853(step)) => step,
        }
    }

    fn now_mut(&mut self) -> &mut dyn Stepper<T> {
        match (self.implicit, &mut self.explicit) {
            (true, _) => &mut self.rosenbrock,
            (false, Limited::Heun(step)) => step,
            (false, Limited::Merson(step)) => step,
            (false, Limited::Dopri5(step)) => step,
            (false, Limited::Tsit5(step)) => step,
            (false, Limited::Dop853(step)) => step,
        }
    }

    /// The limit of h|λ| for the explicit method.
    fn limit(&self) -> f64 {
        limits(self.formula).map_or(f64::INFINITY, |[limit, _]| limit)
    }

    /// Estimates |λ| of the fastest motion \[1/s\], by products with the Jacobian.
    fn follow_fastest(&mut self) {
        let [first, later] = PRODUCTS;
        let anew = self.fastest.is_nan() || self.fastest <= 0.0;
        let varying = self.rosenbrock.varying();
        if anew {
            for (i, entry) in self.motion.iter_mut().enumerate() {
                // excites every entry, and no two neighbours alike
                *entry = T::from_f64(1.0 + 0.1 * (i % 7) as f64);
            }
        }
        let (products, mut before) = (if anew { first } else { later }, f64::NAN);
        for _ in 0..products {
            let size = self.multiply(varying);
            self.fastest = square_root(before * size);
            before = size;
        }
        if !self.fastest.is_finite() {
            self.fastest = 0.0;
        }
    }

    /// Multiplies the motion, of length 1, by the Jacobian. Returns the length of the product.
    fn multiply(&mut self, varying: usize) -> f64 {
        let jacobian = self.rosenbrock.jacobian();
        let order = self.motion.len();
        let mut sum = T::from_f64(0.0);
        for (i, to) in self.product[..varying].iter_mut().enumerate() {
            let row = &jacobian[i * order..][..varying];
            let mut product = T::from_f64(0.0);
            for (entry, x) in row.iter().zip(&self.motion[..varying]) {
                product = entry.mul_add(*x, product);
            }
            *to = product;
            sum = product.mul_add(product, sum);
        }
        let length = sum.sqrt();
        let inverse = T::from_f64(1.0) / length;
        for (x, product) in self.motion[..varying].iter_mut().zip(&*self.product) {
            *x = *product * inverse;
        }
        length.to_f64()
    }

    /// Counts an accepted implicit step. True if the explicit method is to take over again.
    fn goes_back(&mut self, length: f64) -> bool {
        let reach = length * self.fastest;
        self.rule.calm = if reach < self.limit() {
            self.rule.calm + 1
        } else {
            0
        };
        if self.rule.calm >= SLOW {
            return true;
        }
        if self.rule.tries < TRIAL {
            return false;
        }
        let pays = self.rule.gone > PAYS * self.cost * self.rule.stride * self.rule.tries as f64;
        (self.rule.gone, self.rule.tries) = (0.0, 0);
        self.rule.wait = match pays {
            true => WAIT,
            false => self.rule.wait.saturating_mul(2),
        };
        !pays
    }
}

impl<T: Real> Stepper<T> for Switching<'_, T> {
    fn order_of_estimate(&self) -> u32 {
        self.now().order_of_estimate()
    }

    fn begin(&mut self, t: f64, y: &[T], rate: &[T]) {
        self.has_end = false;
        self.now_mut().begin(t, y, rate);
    }

    fn take(&mut self, f: &mut Evaluator<'_, T>, h: f64) -> Result<(), Reason> {
        self.has_end = false;
        if self.implicit && !self.rosenbrock.knows_jacobian() {
            if self.rosenbrock.differentiate(f).is_err() {
                (self.implicit, self.never) = (false, true);
                let Span { t, y, .. } = self.rosenbrock.span();
                // both steps begin at the same state
                let (t, rate) = (*t, self.rosenbrock.rate());
                let explicit: &mut dyn Stepper<T> = match &mut self.explicit {
                    Limited::Heun(step) => step,
                    Limited::Merson(step) => step,
                    Limited::Dopri5(step) => step,
                    Limited::Tsit5(step) => step,
                    Limited::Dop853(step) => step,
                };
                explicit.begin(t, y, rate);
                return explicit.take(f, h);
            }
            self.follow_fastest();
        }
        self.now_mut().take(f, h)
    }

    fn span(&self) -> &Span<'_, T> {
        match (self.implicit, &self.explicit) {
            (true, _) => self.rosenbrock.span(),
            (false, Limited::Heun(step)) => step.span(),
            (false, Limited::Merson(step)) => step.span(),
            (false, Limited::Dopri5(step)) => step.span(),
            (false, Limited::Tsit5(step)) => step.span(),
            (false, Limited::Dop853(step)) => step.span(),
        }
    }

    fn finish(&mut self, f: &mut Evaluator<'_, T>) {
        match self.implicit {
            true if !self.has_end => {
                let Span { t, h, end, .. } = self.rosenbrock.span();
                f.at(*t + *h, end, self.end);
                self.has_end = true;
            }
            true => {}
            false => self.now_mut().finish(f),
        }
    }

    fn estimate(&mut self, errors: &mut [T]) {
        self.now_mut().estimate(errors);
    }

    fn complete(&mut self, f: &mut Evaluator<'_, T>) {
        self.now_mut().complete(f);
    }

    fn interpolate(&self, theta: f64, inside: &mut [T]) {
        self.now().interpolate(theta, inside);
    }

    fn cubic(&self, theta: f64, inside: &mut [T]) -> bool {
        self.now().cubic(theta, inside)
    }

    fn end_rate(&self) -> Option<&[T]> {
        match self.implicit {
            true => self.has_end.then_some(&*self.end),
            false => match &self.explicit {
                Limited::Heun(step) => step.end_rate(),
                Limited::Merson(step) => step.end_rate(),
                Limited::Dopri5(step) => step.end_rate(),
                Limited::Tsit5(step) => step.end_rate(),
                Limited::Dop853(step) => step.end_rate(),
            },
        }
    }

    fn neighbour(&self, state: &mut [T]) -> Option<&[T]> {
        match &self.explicit {
            _ if self.implicit => None,
            Limited::Heun(step) => step.neighbour(state),
            Limited::Merson(step) => step.neighbour(state),
            Limited::Dopri5(step) => step.neighbour(state),
            Limited::Tsit5(step) => step.neighbour(state),
            Limited::Dop853(step) => step.neighbour(state),
        }
    }

    fn switched(&self) -> bool {
        self.implicit
    }

    fn slope(&self, theta: f64, slope: &mut [T]) {
        self.rosenbrock.derive(theta, slope);
    }

    fn noise(&self, noise: &mut [T]) -> f64 {
        self.rosenbrock.rounded(noise);
        self.rosenbrock.span().h * self.fastest
    }

    fn turn(&mut self, length: f64, rejected: u64, h_lambda_fourth: f64) -> Option<FormulaChange> {
        if self.never {
            return None;
        }
        self.rule.add(length, rejected);
        if self.implicit {
            if !self.goes_back(length) {
                return None;
            }
            self.implicit = false;
            self.rule.count_anew();
            return Some(FormulaChange {
                leaps: false,
                longest: self.limit() / self.fastest,
            });
        }
        if !self
            .rule
            .is_stiff([h_lambda_fourth, self.limit()], rejected)
        {
            return None;
        }
        let mean = self.rule.gone / self.rule.tries as f64;
        self.rule.stride = match self.rule.lately < FAR_LESS * mean {
            true => self.rule.lately,
            false => mean,
        };
        let close = f64::from(self.rule.strict) >= MOST * f64::from(self.rule.at_limit);
        self.rule.count_anew();
        (self.implicit, self.fastest) = (true, 0.0);
        Some(FormulaChange {
            leaps: close && self.rule.wait > WAIT,
            longest: f64::INFINITY,
        })
    }
}
