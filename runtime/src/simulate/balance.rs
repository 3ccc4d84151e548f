//! Where the energy went: T(t) = T(0) + Σ W,   W = ∫ P dt; and whether momentum is explained: p(t) = p(0) + ∫ F dt.
//!
//! The work of each effect is summed up over accepted steps by a rule of Lobatto's, from the ends of the step and one or two places on its
//! interpolant. What is known at the end of a step serves the beginning of the next, too. What is missing in the balance at the end measures
//! the run as a whole: errors of integration, a step across a kink, a force that is not what its power says.

use super::Buffer;
use crate::{Formula, Real};

/// How a power is summed up over a step: two of Lobatto's rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rule {
    /// Three points, exact for powers of degree 3 (Simpson): its error, h⁵ P⁗/2880, falls like the estimate of methods of order 5.
    Three,
    /// Four points, exact for powers of degree 5.
    Five,
}

/// Places for what is known at the nodes: the first is the beginning of the step, the last its end. A rule may leave others unused.
pub(crate) const NODES: usize = 4;

impl Rule {
    /// That for steps under control of their error. Steps of methods of higher order are long, and fixed ones may be as long as they like:
    /// there the rule of degree 5 is needed.
    pub(super) fn of(formula: Formula) -> Rule {
        match formula.order() {
            0..=5 => Rule::Three,
            _ => Rule::Five,
        }
    }

    /// The nodes within the step, 0..1, with their places: ½, or ½ ∓ √(1/20).
    pub(crate) fn inner(self) -> impl Iterator<Item = (usize, f64)> {
        let nodes: &[f64] = match self {
            Rule::Three => &[0.5],
            Rule::Five => &[0.276_393_202_250_021_06, 0.723_606_797_749_979],
        };
        nodes.iter().enumerate().map(|(i, x)| (1 + i, *x))
    }

    /// The weights of all places.
    pub(crate) fn weights(self) -> [f64; NODES] {
        match self {
            Rule::Three => [1.0 / 6.0, 4.0 / 6.0, 0.0, 1.0 / 6.0],
            Rule::Five => [1.0 / 12.0, 5.0 / 12.0, 5.0 / 12.0, 1.0 / 12.0],
        }
    }

    /// The weights other than 0, with their places.
    fn terms(self) -> impl Iterator<Item = (usize, f64)> {
        let terms = self.weights().into_iter().enumerate();
        terms.filter(|(_, weight)| *weight != 0.0)
    }
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
    /// Σ ∫ |P| dt \[J\]: what was exchanged one way or the other, the measure of how small a gap is.
    pub exchanged: T,
    /// Of what moves freely: momentum at the start, at the time reached, and what forces gave it.
    pub momentum: Momentum<T>,
}

/// The balance of momentum: three components \[N s\], then three of the angular momentum about the origin \[N m s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Momentum<T> {
    /// At the start.
    pub start: [T; 6],
    /// At the time reached.
    pub end: [T; 6],
    /// ∫ of the forces and moments.
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

    /// What is missing \[N s\], and about the origin \[N m s\].
    pub(super) fn missing(&self) -> [f64; 2] {
        let part = |from: usize| {
            let gap = |i: usize| (self.end[i] - self.start[i] - self.given[i]).abs().to_f64();
            (from..from + 3).map(gap).fold(0.0, f64::max)
        };
        [part(0), part(3)]
    }

    /// The largest number in the balance, however the roundings of it matter.
    pub(super) fn size(&self) -> f64 {
        let sizes = [self.start, self.end, self.exchanged];
        let sizes = sizes.iter().flatten().map(|size| size.abs().to_f64());
        sizes.fold(0.0, f64::max)
    }

    /// What is missing, relative to the largest there was to miss: the larger of linear and angular momentum's. 0 where there
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
    /// Before a run, with place for the work of each effect.
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

    /// What is missing in the balance \[J\]: T(t) − T(0) − Σ W.
    pub fn gap(&self) -> T {
        let works = self.works.iter();
        works.fold(self.end - self.start, |gap, work| gap - *work)
    }

    /// Adds a step of this length with the forces on what moves freely, at the nodes.
    pub(super) fn push(&mut self, rule: Rule, length: f64, external_wrenches: &[[T; 6]; NODES]) {
        let momentum = &mut self.momentum;
        for (node, weight) in rule.terms() {
            let weight = T::from_f64(length * weight);
            for (i, force) in external_wrenches[node].iter().enumerate() {
                momentum.given[i] += weight * *force;
                momentum.exchanged[i] += weight * force.abs();
            }
        }
    }

    /// Adds a step of this length with its powers at the nodes, one node after the other.
    pub(super) fn add(&mut self, rule: Rule, length: f64, powers: &[T]) {
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
    use super::{Balance, Buffer, NODES, Rule};

    #[test]
    fn rules_are_exact_to_their_degree() {
        for (rule, exact_to) in [(Rule::Three, 3), (Rule::Five, 5)] {
            for degree in 0..=6 {
                is_exact(rule, degree, degree <= exact_to);
            }
        }
    }

    fn is_exact(rule: Rule, degree: i32, expected: bool) {
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
