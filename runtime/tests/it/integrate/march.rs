//! Steps of one length.

use crate::models::{Chain, Counter, Kepler, Pendulum, Ratchet, Spin};
use bryant_runtime::integrate::{DOP853, march, march_dop853};
use bryant_runtime::real::lanes::{MOST_LANES, OfAnyWidth, with_width};
use bryant_runtime::{DoubleDouble, Model, Real, Several, Vector, Width};

/// A model whose discrete state changes with every update is updated once more than it has event functions.
fn renew_all<T: Real, M: Model<T>>(model: &M, t: T, y: &mut M::State) {
    for _ in 0..=M::INFO.event_functions.len() {
        model.renew(t, y);
    }
}

/// The same steps, written as in textbooks: y + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄).
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

/// y + h Σ b k, stage after stage, as the tableau says.
fn by_tableau<T: Real, M: Model<T>>(model: &M, h: f64, steps: u32, y: &mut M::State) {
    let number = T::from_f64;
    renew_all(model, number(0.0), y);
    for step in 0..steps {
        let t = f64::from(step) * h;
        let ahead = |k: &[M::State], weights: &[f64]| {
            let mut to = *y;
            for i in 0..M::State::LEN {
                let terms = k.iter().zip(weights).map(|(k, w)| number(*w) * k[i]);
                to[i] += number(h) * terms.fold(number(0.0), |sum, term| sum + term);
            }
            to
        };
        let mut k = vec![];
        for (nodes, row) in DOP853.c.iter().zip(DOP853.a) {
            let at = ahead(&k, row);
            k.push(model.derivative(number(*nodes) * number(h) + number(t), &at));
        }
        *y = ahead(&k, DOP853.b);
        model.normalize(y);
        renew_all(model, number(t + h), y);
    }
}

/// Checks that both ways round differently, and differ in nothing else, to the precision of a scalar.
fn compare<T: Real, M: Model<T>>(model: &M, epsilon: f64) {
    compare_with(model, epsilon, march, textbook);
    compare_with(model, epsilon, march_dop853, by_tableau);
}

fn compare_with<T: Real, M: Model<T>>(
    model: &M,
    epsilon: f64,
    march: fn(&M, T, T, u32, &mut M::State) -> T,
    textbook: fn(&M, f64, u32, &mut M::State),
) {
    // a power of two, so that it and its half are exact in every scalar
    let (h, steps) = (1.0 / 32.0, 60);
    let (mut expected, mut found) = (model.initial_state(), model.initial_state());
    textbook(model, h, steps, &mut expected);
    let end = march(model, T::from_f64(0.0), T::from_f64(h), steps, &mut found);
    assert_eq!(end.to_f64(), h * f64::from(steps));
    // some ten roundings of numbers below 100 in each step (weights of order 8 go up to 44, but are multiplied by h),
    // and their growth in two seconds
    let bound = 10.0 * epsilon * 100.0 * f64::from(steps) * 10.0;
    for i in 0..M::State::LEN {
        let difference = (found[i] - expected[i]).to_f64().abs();
        let size = expected[i].to_f64().abs().max(1.0);
        assert!(difference <= bound * size, "{i}: {difference:e}, {bound:e}");
    }
}

#[test]
fn a_march_goes_where_the_textbook_does() {
    compare::<f64, _>(&Pendulum, f64::EPSILON);
    compare::<f64, _>(&Kepler, f64::EPSILON);
    compare::<f64, _>(&Spin, f64::EPSILON);
    compare::<f64, _>(&Ratchet, f64::EPSILON);
    compare::<f64, _>(&Counter, f64::EPSILON);
    // one switch after the other at the same moment
    compare::<f64, _>(&Chain, f64::EPSILON);
    // to all digits
    compare::<DoubleDouble, _>(&Kepler, f64::EPSILON * f64::EPSILON);
}

/// A march with another start in every lane: the end of each lane, in bits.
struct Abreast;

impl OfAnyWidth for Abreast {
    type Output = Vec<[[u64; 4]; 2]>;

    fn run<T: Several<One = f64>>(self) -> Self::Output {
        let mut ends = Vec::new();
        for first in (0..MOST_LANES).step_by(T::LANES) {
            let start = Model::<f64>::initial_state(&Kepler);
            let mut y = start.map(|entry| {
                let of_lane = |lane| entry * (1.0 + 0.01 * (first + lane) as f64);
                T::of_lanes(&core::array::from_fn(of_lane))
            });
            let (t, h) = (T::from_f64(0.0), T::from_f64(0.01));
            let mut y8 = y;
            march(&Kepler, t, h, 100, &mut y);
            march_dop853(&Kepler, t, h, 100, &mut y8);
            let bits = |y: [T; 4], lane| y.map(|entry| entry.lane(lane).to_bits());
            ends.extend((0..T::LANES).map(|lane| [bits(y, lane), bits(y8, lane)]));
        }
        ends
    }
}

#[test]
fn lanes_march_each_by_itself() {
    let alone = with_width(Width::One, Abreast).expect("one lane");
    for width in Width::ALL {
        if let Some(abreast) = with_width(width, Abreast) {
            assert_eq!(abreast, alone, "{}", width.name());
        }
    }
}

/// How far Kepler's ellipse is off after so many steps of a march, compared with four times as many.
fn error(march: impl Fn(DoubleDouble, u32, &mut [DoubleDouble; 4]), steps: u32) -> f64 {
    let end = |steps: u32| {
        let mut y: [DoubleDouble; 4] = Kepler.initial_state();
        march(
            DoubleDouble::from_f64(2.0 / f64::from(steps)),
            steps,
            &mut y,
        );
        y
    };
    let (coarse, fine) = (end(steps), end(4 * steps));
    let each = (0..4).map(|i| (coarse[i] - fine[i]).to_f64().abs());
    each.fold(0.0, f64::max)
}

/// Half the step divides the error by 2 to the order; a tenth of an order is left for higher terms.
#[test]
fn marches_have_their_orders() {
    let nought = DoubleDouble::from_f64(0.0);
    let fourth = |h, steps, y: &mut _| {
        march(&Kepler, nought, h, steps, y);
    };
    let eighth = |h, steps, y: &mut _| {
        march_dop853(&Kepler, nought, h, steps, y);
    };
    let order = (error(fourth, 1024) / error(fourth, 2048)).log2();
    assert!((order - 4.0).abs() < 0.1, "{order}");
    // with few steps: the weights are given as doubles, and their error of 10⁻¹⁷ is of order 1
    let order = (error(eighth, 64) / error(eighth, 128)).log2();
    assert!((order - 8.0).abs() < 0.1, "{order}");
}

#[test]
fn no_step_changes_nothing() {
    let mut y = [0.5, 0.0, 0.0, 1.7];
    assert_eq!(march(&Kepler, 3.0, 0.1, 0, &mut y), 3.0);
    assert_eq!(march_dop853(&Kepler, 3.0, 0.1, 0, &mut y), 3.0);
    assert_eq!(y, [0.5, 0.0, 0.0, 1.7]);
}
