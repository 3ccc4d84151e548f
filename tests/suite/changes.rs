//! Changing a state and normalizing it at once gives the same bits as doing it in two steps.

use bryant_runtime::{Change, Model, ParameterSet, Vector};
use bryant_tests::models::{free_top, free_tree, poles_bryant, sliding_block};
use bryant_tests::trees::Random;

struct Scaled<S> {
    by: S,
}

impl<S: Vector<f64>> Change<f64> for Scaled<S> {
    fn of(&self, index: usize, value: f64) -> f64 {
        self.by[index] * value + 0.01 * index as f64
    }
}

/// The number of changed entries that normalization changes, too.
fn normalized<M: Model<f64>>() -> usize {
    let model = M::new(M::Parameters::defaults());
    let mut random = Random::new(11);
    let (start, mut by) = (model.initial_state(), model.initial_state());
    for i in 0..M::State::LEN {
        by[i] = random.uniform(0.5, 1.5);
    }
    let change = Scaled { by };
    let mut changed = start;
    for i in 0..M::State::LEN {
        changed[i] = change.of(i, start[i]);
    }
    let (mut expected, mut found) = (changed, start);
    model.normalize(&mut expected);
    model.normalize_changed(&mut found, &change);
    assert_eq!(found.as_ref(), expected.as_ref(), "{}", M::INFO.name);
    let pairs = changed.as_ref().iter().zip(expected.as_ref());
    pairs
        .filter(|(changed, normalized)| changed != normalized)
        .count()
}

#[test]
fn entries_are_changed_and_quaternions_normalized_in_one_pass() {
    assert_eq!(normalized::<free_top::Mechanism<f64>>(), 4);
    // two trees, each with three coordinates of its reference joint
    let quaternions = free_tree::Mechanism::<f64>::INFO.coordinates.len() - 2 * 3;
    assert_eq!(normalized::<free_tree::Mechanism<f64>>(), quaternions);
    // Bryant angles and planar models have nothing to normalize
    assert_eq!(normalized::<poles_bryant::Mechanism<f64>>(), 0);
    assert_eq!(normalized::<sliding_block::Mechanism<f64>>(), 0);
}
