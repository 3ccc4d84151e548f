//! The settings of a study: series, each from coarse to fine.
//!
//! | series | steps, tolerances | scalars | kinks |
//! |---|---|---|---|
//! | every formula with fixed steps | half decades | `f64`, and decades in `f32` | located and, by decades, passed |
//! | every formula with an error estimate | half decades of tolerances | as above, in `f32` not below its rounding | as above |
//! | the default method of runs, which changes to the Rosenbrock method where the scene is stiff | half decades of tolerances | `f64` | as above |
//! | some, with fast sine and cosine | decades | `fast` | located |
//!
//! Settings that cannot differ are not run twice: kinks are passed only if the scene has kinks, and sines are fast only
//! if there are sines.

use super::setting::{Pace, Scheme, Setting};
use bryant_runtime::Formula;
use bryant_runtime::program::Scalar;

/// The request of the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Schemes, each once.
    pub schemes: Vec<Scheme>,
    /// Tolerances from the largest to the smallest.
    pub tolerances: Range,
    /// Steps from the longest to the shortest \[s\].
    pub steps: Range,
    /// True if only few points are run.
    pub quick: bool,
}

/// A range from the larger to the smaller of two positive numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    from: f64,
    to: f64,
}

/// The properties of a scene that decide which settings can differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModelFeatures {
    /// The motion comes to kinks of force laws.
    pub kinks: bool,
    /// The equations have sines and cosines.
    pub sines: bool,
}

/// Settings that differ only in their pace, from coarse to fine.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The setting, except its pace.
    pub of: Setting,
    /// The paces, from coarse to fine.
    pub paces: Vec<Pace>,
}

/// Smallest tolerance that `f32` can resolve.
const SINGLE: f64 = 1e-7;

/// The range is invalid; the message.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct RangeError(String);

impl Range {
    /// A range between two numbers in any order.
    ///
    /// # Errors
    /// A number is not positive and finite.
    pub fn new(a: f64, b: f64) -> Result<Range, RangeError> {
        match [a, b].into_iter().find(|x| !(*x > 0.0 && x.is_finite())) {
            Some(wrong) => Err(RangeError(format!("{wrong} is not a positive number"))),
            None => Ok(Range {
                from: a.max(b),
                to: a.min(b),
            }),
        }
    }

    /// Reads a range "1e-2..1e-8", or one number; `number` reads a number.
    ///
    /// # Errors
    /// Those of `number`, and those of [`Range::new`].
    pub fn read<E: std::fmt::Display>(
        text: &str,
        number: impl Fn(&str) -> Result<f64, E>,
    ) -> Result<Range, RangeError> {
        let (from, to) = text.split_once("..").unwrap_or((text, text));
        let number = |text: &str| number(text.trim()).map_err(|e| RangeError(e.to_string()));
        Range::new(number(from)?, number(to)?)
    }

    /// The larger end.
    pub fn largest(&self) -> f64 {
        self.from
    }

    /// The ends of the range and the powers of ten between them; with `halves`, also three times these powers.
    // Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
    #[doc(hidden)]
    pub fn ladder(&self, halves: bool) -> Vec<f64> {
        let digits: &[u32] = if halves { &[3, 1] } else { &[1] };
        let (high, low) = (
            libm::log10(self.from).ceil() as i32,
            libm::log10(self.to).floor() as i32,
        );
        let mut values = vec![self.from];
        for exponent in (low..=high).rev() {
            for digit in digits {
                // numbers are parsed from text, so that they are exactly those that people write
                let value: f64 = format!("{digit}e{exponent}").parse().unwrap_or(f64::NAN);
                let inside = value < self.from * (1.0 - 1e-9) && value > self.to * (1.0 + 1e-9);
                values.extend(inside.then_some(value));
            }
        }
        if self.to < self.from {
            values.push(self.to);
        }
        values
    }

    /// The part of the range that is not below a limit; `None` if there is none.
    fn above(&self, limit: f64) -> Option<Range> {
        (self.from >= limit).then(|| Range {
            from: self.from,
            to: self.to.max(limit),
        })
    }

    /// The default steps for a run of this duration with this time between samples. The largest is the longest step
    /// 1·10ⁿ or 3·10ⁿ that is not longer than the time between samples and a tenth of the duration; the smallest is a
    /// thousandth of it.
    pub fn of_steps(every: f64, duration: f64) -> Range {
        let longest = every.min(0.1 * duration);
        let exponent = libm::log10(longest).floor() as i32;
        let of = |digit: u32| format!("{digit}e{exponent}").parse().unwrap_or(longest);
        let [one, three]: [f64; 2] = [of(1), of(3)];
        let hair = longest * (1.0 + 1e-9);
        let from = if three <= hair {
            three
        } else {
            one.min(longest)
        };
        Range {
            from,
            to: from * 1e-3,
        }
    }
}

/// All series of a plan.
pub fn series(request: &Request, scene: ModelFeatures) -> Vec<Series> {
    let mut all = Vec::new();
    for &Scheme { formula, switches } in &request.schemes {
        for (scalar, locate) in [
            (Scalar::F64, true),
            (Scalar::F64, false),
            (Scalar::F32, true),
            (Scalar::F32, false),
        ] {
            if !locate && (!scene.kinks || request.quick && scalar == Scalar::F32) {
                continue;
            }
            if switches && scalar != Scalar::F64 {
                continue;
            }
            let of = Setting {
                formula,
                switches,
                pace: Pace::Tolerance(1.0),
                scalar,
                locate,
            };
            let halves = !request.quick && locate && scalar == Scalar::F64;
            all.extend(both(request, of, halves));
        }
    }
    let with_fast_sines = compared(&request.schemes)
        .into_iter()
        .filter(|_| scene.sines);
    for formula in with_fast_sines {
        let of = Setting {
            formula,
            switches: false,
            pace: Pace::Tolerance(1.0),
            scalar: Scalar::Fast,
            locate: true,
        };
        all.extend(both(request, of, false));
    }
    all
}

/// The formulas that are run with fast sines: a usual one of each kind; if the request has none of these, its formulas.
fn compared(schemes: &[Scheme]) -> Vec<Formula> {
    let alone = schemes.iter().filter(|scheme| !scheme.switches);
    let formulas: Vec<Formula> = alone.map(|scheme| scheme.formula).collect();
    let usual = [Formula::Rk4, Formula::Tsit5, Formula::Dop853];
    let found: Vec<Formula> = usual.into_iter().filter(|f| formulas.contains(f)).collect();
    match found.is_empty() {
        true => formulas,
        false => found,
    }
}

/// A series of fixed steps and, if the formula estimates its error, a series of tolerances.
fn both(request: &Request, of: Setting, halves: bool) -> Vec<Series> {
    let steps = request.steps.ladder(halves).into_iter().map(Pace::Step);
    let mut all = Vec::new();
    if !of.switches {
        all.push(Series {
            of,
            paces: steps.collect(),
        });
    }
    let tolerances = match of.scalar {
        Scalar::F32 => request.tolerances.above(SINGLE),
        _ => Some(request.tolerances),
    };
    if let Some(tolerances) = tolerances.filter(|_| of.formula.estimates_error()) {
        let values = tolerances.ladder(halves).into_iter();
        let mut paces: Vec<Pace> = values.map(Pace::Tolerance).collect();
        if request.quick {
            // keep every other pace, and the last one
            let last = paces.len().saturating_sub(1);
            let mut indices = 0..;
            paces.retain(|_| indices.next().is_some_and(|i| i % 2 == 0 || i == last));
        }
        all.push(Series { of, paces });
    }
    all
}

impl Series {
    /// The settings, from coarse to fine.
    pub fn settings(&self) -> impl Iterator<Item = Setting> + '_ {
        self.paces.iter().map(|&pace| Setting { pace, ..self.of })
    }
}
