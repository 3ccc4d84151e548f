//! A state that is changed and put on its manifold at once is what it is one after the other, to the last bit.

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

/// Of how many entries it changes the normalization changes as well.
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
    // two trees, whose reference joints have three coordinates each
    let quaternions = free_tree::Mechanism::<f64>::INFO.coordinates.len() - 2 * 3;
    assert_eq!(normalized::<free_tree::Mechanism<f64>>(), quaternions);
    // in charts of angles and in the plane there is nothing to normalize
    assert_eq!(normalized::<poles_bryant::Mechanism<f64>>(), 0);
    assert_eq!(normalized::<sliding_block::Mechanism<f64>>(), 0);
}
