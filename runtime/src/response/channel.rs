//! A signal that is formed from outputs: each is filtered, then they are combined.
//!
//! Sensors measure components, and standards filter what a sensor measures. So components are filtered before their
//! resultant is formed.

use super::filter::{Filter, filtered};
use crate::Real;

/// The signal of a response: one or several outputs, filtered or unfiltered, combined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel {
    outputs: [usize; MOST],
    count: usize,
    /// The filter of each output, if any.
    pub filter: Option<Filter>,
    /// How the outputs are combined.
    pub combination: Combination,
}

/// The largest number of outputs of a channel.
pub const MOST: usize = 3;

impl Channel {
    /// A single output without filter: its index in [`Info::outputs`](crate::Info::outputs).
    pub const fn output(index: usize) -> Channel {
        Channel {
            outputs: [index, 0, 0],
            count: 1,
            filter: None,
            combination: Combination::Itself,
        }
    }

    /// Several outputs; `None` if their number does not fit the combination.
    pub fn of(outputs: &[usize], filter: Option<Filter>, combination: Combination) -> Option<Self> {
        if !combination.takes(outputs.len()) {
            return None;
        }
        let mut all = [0; MOST];
        all[..outputs.len()].copy_from_slice(outputs);
        Some(Channel {
            outputs: all,
            count: outputs.len(),
            filter,
            combination,
        })
    }

    /// The indices of its outputs, in the order of its combination.
    pub fn outputs(&self) -> &[usize] {
        &self.outputs[..self.count]
    }

    /// The output, if the channel is a single output without filter.
    pub fn plain(&self) -> Option<usize> {
        match (self.filter, self.combination) {
            (None, Combination::Itself) => Some(self.outputs[0]),
            _ => None,
        }
    }

    /// The samples of the channel from those of its outputs, which are `every` \[s\] apart; `None` where they cannot be
    /// filtered, or where there are none.
    pub fn form<T: Real>(&self, samples: impl Fn(usize) -> Vec<T>, every: f64) -> Option<Vec<T>> {
        let signal = |output: &usize| match self.filter {
            Some(Filter { class, standard }) => filtered(&samples(*output), every, class, standard),
            None => Some(samples(*output)),
        };
        let signals: Option<Vec<Vec<T>>> = self.outputs().iter().map(signal).collect();
        self.combination.form(&signals?, every)
    }
}

/// How several signals are combined into one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Combination {
    /// The single signal itself.
    Itself,
    /// max(s x, 0) of the single signal x: its part along the sign s.
    Positive(f64),
    /// √(x² + y² + z²) of two or three signals.
    Resultant,
    /// Nij of the shear force Fx, the axial force Fz and the moment My at the load cell of the upper neck \[49 CFR
    /// 571.208 S6.6\]: the larger of Fz/Fzc over tension and compression, and the larger of M/Mc over flexion and
    /// extension, with M = My − e Fx.
    Nij(Neck),
    /// max(−M, 0) of Fx and My, with M = My − e Fx: the moment that bends the head back.
    Extension,
    /// S (D/D₀) dD/dt of a deflection D. The rate is that of five points; the result is 0 at the two samples of either
    /// end \[Euro NCAP TB 021\].
    Viscous(Chest),
    /// The tibia index √(Mx² + My²)/Mc + |Fz|/Fc of Mx, My and Fz.
    Tibia {
        /// Mc \[N m\]
        moment: f64,
        /// Fc \[N\]
        force: f64,
    },
    /// √Σ (max |ωᵢ|/ωᵢc)² of three angular velocities, with the maximum up to each time. Its last value is BrIC
    /// \[Takhounts 2013\].
    Rotation([f64; 3]),
}

/// Critical values of Nij.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neck {
    /// \[N\]
    pub tension: f64,
    /// \[N\]
    pub compression: f64,
    /// \[N m\]
    pub flexion: f64,
    /// \[N m\]
    pub extension: f64,
}

/// The constants of the viscous criterion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chest {
    /// Scaling factor of the dummy, S \[1\].
    pub factor: f64,
    /// Depth of its chest, D₀ \[m\].
    pub depth: f64,
}

/// The distance e \[m\] from the load cell at the upper neck to the joint of head and neck, for all Hybrid III dummies
/// \[49 CFR Part 572\].
pub const ARM: f64 = 0.01778;

impl Combination {
    /// Whether it combines this number of signals.
    pub fn takes(self, count: usize) -> bool {
        match self {
            Combination::Itself | Combination::Positive(_) | Combination::Viscous(_) => count == 1,
            Combination::Resultant => count == 2 || count == 3,
            Combination::Extension => count == 2,
            Combination::Nij(_) | Combination::Tibia { .. } | Combination::Rotation(_) => {
                count == 3
            }
        }
    }

    /// Whether the result has the unit of the first signal, and not a unit of its own.
    pub fn keeps_unit(self) -> bool {
        matches!(
            self,
            Combination::Itself | Combination::Positive(_) | Combination::Resultant
        )
    }

    /// The combination of signals of equal length, whose samples are `every` \[s\] apart; `None` if their number is
    /// wrong or they are empty.
    pub fn form<T: Real>(self, signals: &[Vec<T>], every: f64) -> Option<Vec<T>> {
        let first = signals.first().filter(|_| self.takes(signals.len()))?;
        if signals.iter().any(|other| other.len() != first.len()) {
            return None;
        }
        let zero = T::from_f64(0.0);
        let over = |x: T, size: f64| x * T::from_f64(1.0 / size);
        let moment = |fx: T, my: T| my - T::from_f64(ARM) * fx;
        let each = |f: &dyn Fn(usize) -> T| Some((0..first.len()).map(f).collect());
        match self {
            Combination::Itself => Some(first.clone()),
            Combination::Positive(sign) => {
                each(&|i| (first[i] * T::from_f64(sign)).max(zero) + first[i].taint())
            }
            Combination::Resultant => each(&|i| {
                let squares = signals.iter().map(|x| x[i] * x[i]);
                root(squares.fold(zero, |sum, square| sum + square))
            }),
            Combination::Nij(neck) => each(&|i| {
                let (fz, m) = (signals[1][i], moment(first[i], signals[2][i]));
                // one of each pair is not negative
                over(fz, neck.tension).max(over(-fz, neck.compression))
                    + over(m, neck.flexion).max(over(-m, neck.extension))
                    + (fz + m).taint()
            }),
            Combination::Extension => each(&|i| {
                let m = moment(first[i], signals[1][i]);
                (-m).max(zero) + m.taint()
            }),
            Combination::Viscous(chest) => {
                let end = first.len().saturating_sub(2);
                let (eight, per) = (
                    T::from_f64(8.0),
                    T::from_f64(chest.factor / (chest.depth * 12.0 * every)),
                );
                each(&|i| match (2..end).contains(&i) {
                    true => {
                        let d = |j: usize| first[i + j - 2];
                        d(2) * ((d(3) - d(1)) * eight - (d(4) - d(0))) * per
                    }
                    false => zero,
                })
            }
            Combination::Tibia { moment, force } => each(&|i| {
                let (mx, my, fz) = (first[i], signals[1][i], signals[2][i]);
                over(root(mx * mx + my * my), moment) + over(fz.abs(), force)
            }),
            Combination::Rotation(critical) => {
                let mut largest = [zero; MOST];
                let mut at = |i: usize| {
                    let mut sum = zero;
                    for (axis, size) in critical.into_iter().enumerate() {
                        let x = signals[axis][i];
                        largest[axis] = largest[axis].max(over(x.abs(), size));
                        sum += largest[axis] * largest[axis] + x.taint();
                    }
                    root(sum)
                };
                Some((0..first.len()).map(&mut at).collect())
            }
        }
    }
}

/// The square root, with a slope of 0 at 0.
fn root<T: Real>(square: T) -> T {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let some = zero.lt(square);
    let root = T::select(some, square, one).sqrt();
    // NaN stays NaN
    T::select(some, root, zero) + square.taint()
}
