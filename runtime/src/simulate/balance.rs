//! The balances of energy, T(t) = T(0) + Σ W with W = ∫ P dt, and of momentum, p(t) = p(0) + ∫ F dt.
//!
//! The work of each effect is integrated over accepted steps by a Lobatto rule, from the ends of the step and one or
//! two places on its interpolant. Values at the end of a step serve the start of the next, too. The gap of the balance
//! at the end measures the quality of the whole run: errors of integration, a step across a kink, a force that does not
//! belong to its power.

use super::Buffer;
use crate::{Dynamics, Formula, Real, Section};

/// The quadrature of powers over a step: one of two Lobatto rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quadrature {
    /// Three points, exact for powers of degree 3 (Simpson). Its error, h⁵ P⁗/2880, decreases with the step like the
    /// error estimate of methods of order 5.
    Degree3,
    /// Four points, exact for powers of degree 5.
    Degree5,
}

/// The number of nodes for which values are kept: the first is the start of the step, the last its end. A rule may
/// leave others unused.
pub(crate) const NODES: usize = 4;

impl Quadrature {
    /// The rule for steps under error control. Steps of methods of higher order are long, and fixed steps may be
    /// arbitrarily long: these need the rule of degree 5.
    pub(super) fn of(formula: Formula) -> Quadrature {
        match formula.order() {
            0..=5 => Quadrature::Degree3,
            _ => Quadrature::Degree5,
        }
    }

    /// The inner nodes, as parts of the step, with their indices: ½, or ½ ∓ √(1/20).
    pub(crate) fn inner(self) -> impl Iterator<Item = (usize, f64)> {
        let nodes: &[f64] = match self {
            Quadrature::Degree3 => &[0.5],
            Quadrature::Degree5 => &[0.276_393_202_250_021_06, 0.723_606_797_749_979],
        };
        nodes.iter().enumerate().map(|(i, x)| (1 + i, *x))
    }

    /// The weights of all nodes.
    pub(crate) fn weights(self) -> [f64; NODES] {
        match self {
            Quadrature::Degree3 => [1.0 / 6.0, 4.0 / 6.0, 0.0, 1.0 / 6.0],
            Quadrature::Degree5 => [1.0 / 12.0, 5.0 / 12.0, 5.0 / 12.0, 1.0 / 12.0],
        }
    }

    /// The weights other than 0, with the indices of their nodes.
    fn terms(self) -> impl Iterator<Item = (usize, f64)> {
        let terms = self.weights().into_iter().enumerate();
        terms.filter(|(_, weight)| *weight != 0.0)
    }
}

/// Evaluates what flows into the balances at a time and a state: the powers, and the external wrench if a system is
/// free.
pub(crate) fn exchange<T: Real>(
    model: &dyn Dynamics<T>,
    (t, y): (T, &[T]),
    powers: &mut [T],
    external_wrench: &mut [T; 6],
) {
    let six = model.info().length(Section::ExternalWrench);
    let external_wrench = &mut external_wrench[..six];
    let mut wanted = [
        (Section::Powers, powers),
        (Section::ExternalWrench, external_wrench),
    ];
    model.sections(t, y, &mut wanted);
}

/// The balance of energy of a run.
#[derive(Debug, PartialEq)]
pub struct Balance<'a, T> {
    /// Kinetic energy at the start \[J\].
    pub start: T,
    /// Kinetic energy at the time reached \[J\].
    pub end: T,
    /// Work of each effect \[J\], in the order of [`Info::powers`](crate::Info::powers).
    pub works: Buffer<'a, T>,
    /// Σ ∫ |P| dt \[J\]: the energy exchanged in either direction, by which to judge the size of a gap.
    pub exchanged: T,
    /// The balance of momentum of freely moving bodies.
    pub momentum: Momentum<T>,
}

/// The balance of momentum: three components \[N s\], then three of the angular momentum about the origin \[N m s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Momentum<T> {
    /// Momentum at the start.
    pub start: [T; 6],
    /// Momentum at the time reached.
    pub end: [T; 6],
    /// ∫ of the external forces and moments.
    pub given: [T; 6],
    /// ∫ of their magnitudes, component by component.
    pub exchanged: [T; 6],
}

impl<T: Real> Momentum<T> {
    fn new() -> Self {
        let zero = [T::from_f64(0.0); 6];
        Momentum {
            start: zero,
            end: zero,
            given: zero,
            exchanged: zero,
        }
    }

    /// The largest component missing in the balance \[N s\], and that about the origin \[N m s\].
    pub(super) fn missing(&self) -> [f64; 2] {
        let part = |from: usize| {
            let gap = |i: usize| (self.end[i] - self.start[i] - self.given[i]).abs().to_f64();
            (from..from + 3).map(gap).fold(0.0, f64::max)
        };
        [part(0), part(3)]
    }

    /// The largest number in the balance, which scales its rounding.
    pub(super) fn size(&self) -> f64 {
        let sizes = [self.start, self.end, self.exchanged];
        let sizes = sizes.iter().flatten().map(|size| size.abs().to_f64());
        sizes.fold(0.0, f64::max)
    }

    /// The gap relative to the largest term of the balance: the larger one for linear and angular momentum. 0 if there
    /// is no momentum at all.
    pub fn relative_gap(&self) -> f64 {
        let part = |from: usize| {
            let (mut gap, mut scale) = (0.0f64, 0.0f64);
            for i in from..from + 3 {
                let missing = self.end[i] - self.start[i] - self.given[i];
                gap = gap.max(missing.abs().to_f64());
                for size in [self.start[i], self.end[i], self.exchanged[i]] {
                    scale = scale.max(size.abs().to_f64());
                }
            }
            if scale > 0.0 { gap / scale } else { 0.0 }
        };
        part(0).max(part(3))
    }
}

impl<'a, T: Real> Balance<'a, T> {
    /// A balance before a run, with a buffer for the work of each effect.
    pub fn new(mut works: Buffer<'a, T>) -> Self {
        let zero = T::from_f64(0.0);
        works.fill(zero);
        Balance {
            start: zero,
            end: zero,
            works,
            exchanged: zero,
            momentum: Momentum::new(),
        }
    }

    /// The gap of the balance of energy \[J\]: T(t) − T(0) − Σ W.
    pub fn gap(&self) -> T {
        let works = self.works.iter();
        works.fold(self.end - self.start, |gap, work| gap - *work)
    }

    /// Adds the momentum given to freely moving bodies in a step of this length, from the wrenches at the nodes.
    pub(super) fn push(
        &mut self,
        rule: Quadrature,
        length: f64,
        external_wrenches: &[[T; 6]; NODES],
    ) {
        let momentum = &mut self.momentum;
        for (node, weight) in rule.terms() {
            let weight = T::from_f64(length * weight);
            for (i, force) in external_wrenches[node].iter().enumerate() {
                momentum.given[i] += weight * *force;
                momentum.exchanged[i] += weight * force.abs();
            }
        }
    }

    /// Adds the work in a step of this length, from its powers at the nodes, one node after the other.
    pub(super) fn add(&mut self, rule: Quadrature, length: f64, powers: &[T]) {
        let effects = self.works.len();
        for (node, weight) in rule.terms() {
            let weight = T::from_f64(length * weight);
            let powers = &powers[node * effects..][..effects];
            for (work, power) in self.works.iter_mut().zip(powers) {
                *work += weight * *power;
                self.exchanged += weight * power.abs();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Balance, Buffer, NODES, Quadrature};

    #[test]
    fn rules_are_exact_to_their_degree() {
        for (rule, exact_to) in [(Quadrature::Degree3, 3), (Quadrature::Degree5, 5)] {
            for degree in 0..=6 {
                is_exact(rule, degree, degree <= exact_to);
            }
        }
    }

    fn is_exact(rule: Quadrature, degree: i32, expected: bool) {
        let mut works = [f64::NAN; 2];
        let mut balance = Balance::new(Buffer::Lent(&mut works));
        let power = |x: f64| x.powi(degree);
        // from 1 to 3, and its opposite as a second effect; what no rule has there is no number
        let mut powers = [[f64::NAN; 2]; NODES];
        for (node, x) in rule.inner().chain([(0, 0.0), (NODES - 1, 1.0)]) {
            powers[node] = [power(1.0 + 2.0 * x), -1.0];
        }
        balance.add(rule, 2.0, powers.as_flattened());
        let exact = (3f64.powi(degree + 1) - 1.0) / f64::from(degree + 1);
        let error = (balance.works[0] / exact - 1.0).abs();
        assert_eq!(
            error < 1e-14,
            expected,
            "{rule:?}, degree {degree}: {error:e}"
        );
        assert!((balance.works[1] + 2.0).abs() < 1e-15);
        assert!((balance.gap() + balance.works[0] - 2.0).abs() < 1e-12);
        assert!((balance.exchanged - balance.works[0] - 2.0).abs() < 1e-12);
    }
}
