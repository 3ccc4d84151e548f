//! Steps of the method of Adams and Bashforth.

use crate::models::{Counter, Kepler, Pendulum, Spin};
use bryant_runtime::integrate::{march_adams, march_dop853};
use bryant_runtime::{DoubleDouble, Model, Real, Vector};

/// The weights of the derivatives in the formula, the latest first, times [`OVER`].
const WEIGHTS: [f64; ORDER] = [4277.0, -7923.0, 9982.0, -7298.0, 2877.0, -475.0];
const OVER: f64 = 1440.0;
const ORDER: usize = 6;

/// The same steps, written as in the formula.
fn textbook<T: Real, M: Model<T>>(model: &M, h: f64, steps: u32, y: &mut M::State) {
    let number = T::from_f64;
    let mut rates = Vec::new();
    for step in 0..steps {
        let t = number(f64::from(step) * h);
        rates.insert(0, model.derivative(t, y));
        if rates.len() < ORDER {
            march_dop853(model, t, number(h), 1, y);
            continue;
        }
        for i in 0..M::State::LEN {
            let terms = rates.iter().zip(WEIGHTS);
            let terms = terms.map(|(f, b)| number(b) / number(OVER) * f[i]);
            let sum = terms.fold(number(0.0), |sum, term| sum + term);
            y[i] += number(h) * sum;
        }
        model.normalize(y);
    }
}

fn compare<T: Real, M: Model<T>>(model: &M, epsilon: f64) {
    let (h, steps) = (1.0 / 64.0, 120);
    let (mut expected, mut found) = (model.initial_state(), model.initial_state());
    textbook(model, h, steps, &mut expected);
    let (start, step) = (T::from_f64(0.0), T::from_f64(h));
    let end = march_adams(model, start, step, steps, &mut found);
    assert_eq!(end.to_f64(), h * f64::from(steps));
    // derivatives below 100 count 23 h in each step, with a rounding for each of six weights, and what they grow by in
    // two seconds
    let bound = 6.0 * epsilon * 100.0 * 23.0 * h * f64::from(steps) * 10.0;
    for i in 0..M::State::LEN {
        let difference = (found[i] - expected[i]).to_f64().abs();
        let size = expected[i].to_f64().abs().max(1.0);
        assert!(difference <= bound * size, "{i}: {difference:e}, {bound:e}");
    }
}

#[test]
fn a_march_goes_where_the_formula_does() {
    compare::<f64, _>(&Pendulum, f64::EPSILON);
    compare::<f64, _>(&Kepler, f64::EPSILON);
    compare::<f64, _>(&Spin, f64::EPSILON);
    // to all digits
    compare::<DoubleDouble, _>(&Kepler, f64::EPSILON * f64::EPSILON);
}

/// Half the step divides the error by 2 to the order; a tenth of an order is left for higher terms.
#[test]
fn it_is_of_order_six() {
    let end = |steps: u32| {
        let mut y: [DoubleDouble; 4] = Kepler.initial_state();
        let h = DoubleDouble::from_f64(2.0) / DoubleDouble::from_f64(f64::from(steps));
        march_adams(&Kepler, DoubleDouble::from_f64(0.0), h, steps, &mut y);
        y
    };
    let exact = end(16384);
    let error = |steps| {
        let y = end(steps);
        let each = (0..4).map(|i| (y[i] - exact[i]).to_f64().abs());
        each.fold(0.0, f64::max)
    };
    let order = (error(1024) / error(2048)).log2();
    assert!((order - 6.0).abs() < 0.1, "{order}");
}

#[test]
fn few_steps_are_those_of_order_eight_and_none_changes_nothing() {
    for steps in 0..ORDER as u32 {
        let (mut y, mut expected) = ([0.5, 0.0, 0.0, 1.7], [0.5, 0.0, 0.0, 1.7]);
        for step in 0..steps {
            march_dop853(&Kepler, f64::from(step) * 0.1, 0.1, 1, &mut expected);
        }
        march_adams(&Kepler, 0.0, 0.1, steps, &mut y);
        assert_eq!(y, expected);
    }
}

#[test]
#[should_panic(expected = "without memory")]
fn a_model_with_memory_is_refused() {
    let mut y = Model::<f64>::initial_state(&Counter);
    march_adams(&Counter, 0.0, 0.1, 1, &mut y);
}
