//! Steps of one length by the classical method of Runge and Kutta, and nothing else: what a loop of one's own calls that wants neither samples
//! nor events nor estimates of the error, at the cost of little more than four evaluations a step.
//!
//! With the states of the stages Y₁ = y, Y₂ = y + h/2 k₁, Y₃ = y + h/2 k₂, Y₄ = y + h k₃ and kᵢ = f(Yᵢ),
//!
//! y⁺ = y + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄) = Y₃ + ((Y₂ − y) + (Y₄ − Y₃)) / 3 + h/6 k₄
//!
//! Derivatives are not stored at all: each entry becomes one of the next stage's state as soon as it is found ([`Sink`]), and a step keeps
//! four states. In wide registers those of a larger model leave the first cache otherwise. To first order in h a step rounds an entry by at most
//! 5/3 ε|y|, ε being the distance from 1 to the next number: 2/3 because Y₂, Y₃ and Y₄ are rounded, and twice 1/2 for the sums.
//! [`Formula::Rk4`](super::Formula::Rk4), which adds four terms one after the other, rounds it by at most 2 ε|y|.

use crate::{Model, Real, Sink, Task, Vector};

/// Takes `steps` steps of length `h` \[s\] from time `t` \[s\] and state `y`, where it leaves the last state, and says when that is.
///
/// Every step ends on the manifold ([`Model::normalize`]), and begins with memory that is renewed until nothing changes ([`Model::renew`]), as in
/// [`simulate`](crate::simulate()). Kinks and events are passed over, and a state that is no number any more is not found out: look at it. All
/// lanes have the same time and step.
///
/// ```
/// # use bryant_runtime::{Real, Model, integrate::march};
/// fn a_millisecond<M: Model<f64>>(model: &M) -> M::State {
///     let mut y = model.initial_state();
///     march(model, 0.0, 1e-4, 10, &mut y);
///     y
/// }
/// ```
#[inline(always)]
pub fn march<T: Real, M: Model<T>>(model: &M, t: T, h: T, steps: u32, y: &mut M::State) -> T {
    T::enable(March {
        model,
        t,
        h,
        steps,
        y,
    })
}

struct March<'a, T, M, S> {
    model: &'a M,
    t: T,
    h: T,
    steps: u32,
    y: &'a mut S,
}

impl<T: Real, M: Model<T>> Task for March<'_, T, M, M::State> {
    type Output = T;
    #[inline(always)]
    fn run(self) -> T {
        let March {
            model,
            t: start,
            h,
            steps,
            y,
        } = self;
        let number = T::from_f64;
        // divided here, to the precision of any scalar
        let (half, third, sixth) = (number(0.5) * h, number(1.0) / number(3.0), h / number(6.0));
        let mut t = start;
        if steps > 0 {
            renew(model, start, y);
        }
        let (mut second, mut third_stage, mut fourth) = (*y, *y, *y);
        for step in 0..steps {
            let middle = number(f64::from(step) + 0.5) * h + start;
            let end = number(f64::from(step) + 1.0) * h + start;
            let stage = |t, at: &M::State, from: &M::State, length, to: &mut M::State| {
                T::enable(Stage {
                    model,
                    t,
                    at,
                    from,
                    length,
                    to,
                });
            };
            stage(t, y, y, half, &mut second);
            stage(middle, &second, y, half, &mut third_stage);
            stage(middle, &third_stage, y, h, &mut fourth);
            // backwards: what the last stage found last is still near, and what the next one reads first is near then
            for i in (0..M::State::LEN).rev() {
                let sum = (second[i] - y[i]) + (fourth[i] - third_stage[i]);
                second[i] = third.mul_add(sum, third_stage[i]);
            }
            stage(end, &fourth, &second, sixth, y);
            model.normalize(y);
            renew(model, end, y);
            t = end;
        }
        t
    }
}

/// Renews memory until that changes nothing: what one switch does may be what another waits for. Each guard stands for at most one link
/// of such a chain.
#[inline(always)]
fn renew<T: Real, M: Model<T>>(model: &M, t: T, y: &mut M::State) {
    if M::INFO.memory.is_empty() {
        return;
    }
    for _ in 0..=M::Guards::LEN {
        let before = *y;
        model.renew(t, y);
        if y.as_ref() == before.as_ref() {
            break;
        }
    }
}

/// to = from + length · f(t, at)
struct Stage<'a, T, M, S> {
    model: &'a M,
    t: T,
    at: &'a S,
    from: &'a S,
    length: T,
    to: &'a mut S,
}

impl<T: Real, M: Model<T>> Task for Stage<'_, T, M, M::State> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Stage {
            model,
            t,
            at,
            from,
            length,
            to,
        } = self;
        model.each_rate(t, at, &mut Ahead { from, length, to });
    }
}

/// Makes of each rate the state that it leads to.
struct Ahead<'a, T, S> {
    from: &'a S,
    length: T,
    to: &'a mut S,
}

impl<T: Real, S: Vector<T>> Sink<T> for Ahead<'_, T, S> {
    #[inline(always)]
    fn put(&mut self, index: usize, rate: T) {
        self.to[index] = self.length.mul_add(rate, self.from[index]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DoubleDouble;
    #[cfg(feature = "std")]
    use crate::real::lanes::{MOST_LANES, OfAnyWidth, with_width};
    use crate::test_models::{Chain, Counter, Kepler, Pendulum, Ratchet, Spin};
    #[cfg(feature = "std")]
    use crate::{Several, Width};

    /// A model whose memory changes with every renewal is renewed once more for each of its guards.
    fn renew_all<T: Real, M: Model<T>>(model: &M, t: T, y: &mut M::State) {
        for _ in 0..=M::Guards::LEN {
            model.renew(t, y);
        }
    }

    /// The same steps as the textbook has them: y + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄).
    fn textbook<T: Real, M: Model<T>>(model: &M, h: f64, steps: u32, y: &mut M::State) {
        let number = T::from_f64;
        renew_all(model, number(0.0), y);
        for step in 0..steps {
            let t = f64::from(step) * h;
            let ahead = |k: &M::State, length: f64| {
                let mut to = *y;
                for i in 0..M::State::LEN {
                    to[i] += number(length) * k[i];
                }
                to
            };
            let k1 = model.derivative(number(t), y);
            let k2 = model.derivative(number(t + h / 2.0), &ahead(&k1, h / 2.0));
            let k3 = model.derivative(number(t + h / 2.0), &ahead(&k2, h / 2.0));
            let k4 = model.derivative(number(t + h), &ahead(&k3, h));
            for i in 0..M::State::LEN {
                let sum = k1[i] + number(2.0) * (k2[i] + k3[i]) + k4[i];
                y[i] += number(h) * sum / number(6.0);
            }
            model.normalize(y);
            renew_all(model, number(t + h), y);
        }
    }

    /// Both round to the precision of a scalar, and differ in nothing else.
    fn compare<T: Real, M: Model<T>>(model: &M, epsilon: f64) {
        // a power of two, so that half and all of it are known to the scalar
        let (h, steps) = (1.0 / 32.0, 60);
        let (mut expected, mut found) = (model.initial_state(), model.initial_state());
        textbook(model, h, steps, &mut expected);
        let end = march(model, T::from_f64(0.0), T::from_f64(h), steps, &mut found);
        assert_eq!(end.to_f64(), h * f64::from(steps));
        // some ten roundings of numbers below 100 in each step, and what they grow by in two seconds
        let bound = 10.0 * epsilon * 100.0 * f64::from(steps) * 10.0;
        for i in 0..M::State::LEN {
            let difference = (found[i] - expected[i]).to_f64().abs();
            let size = expected[i].to_f64().abs().max(1.0);
            assert!(difference <= bound * size, "{i}: {difference:e}, {bound:e}");
        }
    }

    #[test]
    fn a_march_goes_where_the_textbook_does() {
        fn all<T: Real>(epsilon: f64) {
            compare::<T, _>(&Pendulum, epsilon);
            compare::<T, _>(&Kepler, epsilon);
            compare::<T, _>(&Spin, epsilon);
            compare::<T, _>(&Ratchet, epsilon);
            compare::<T, _>(&Counter, epsilon);
            // one switch after the other at the same moment
            compare::<T, _>(&Chain, epsilon);
        }
        all::<f64>(f64::EPSILON);
        all::<DoubleDouble>(f64::EPSILON * f64::EPSILON);
    }

    /// A march of every lane from another start, and where each lane ends, in bits.
    #[cfg(feature = "std")]
    struct Abreast;

    #[cfg(feature = "std")]
    impl OfAnyWidth for Abreast {
        type Output = Vec<[u64; 4]>;

        fn run<T: Several<One = f64>>(self) -> Self::Output {
            let mut ends = Vec::new();
            for first in (0..MOST_LANES).step_by(T::LANES) {
                let start = Model::<f64>::initial_state(&Kepler);
                let mut y = start.map(|entry| {
                    let of_lane = |lane| entry * (1.0 + 0.01 * (first + lane) as f64);
                    T::of_lanes(&core::array::from_fn(of_lane))
                });
                march(&Kepler, T::from_f64(0.0), T::from_f64(0.01), 100, &mut y);
                let of_lane = |lane| y.map(|entry| entry.lane(lane).to_bits());
                ends.extend((0..T::LANES).map(of_lane));
            }
            ends
        }
    }

    #[cfg(feature = "std")]
    #[test]
    fn lanes_march_each_by_itself() {
        let Some(alone) = with_width(Width::One, Abreast) else {
            return;
        };
        for width in Width::ALL.into_iter().filter(|width| width.fuses()) {
            if let Some(abreast) = with_width(width, Abreast) {
                assert_eq!(abreast, alone, "{}", width.name());
            }
        }
    }

    #[test]
    fn no_step_changes_nothing() {
        let mut y = [0.5, 0.0, 0.0, 1.7];
        assert_eq!(march(&Kepler, 3.0, 0.1, 0, &mut y), 3.0);
        assert_eq!(y, [0.5, 0.0, 0.0, 1.7]);
    }
}
