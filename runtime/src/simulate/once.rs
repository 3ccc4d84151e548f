//! What a run asks its model, as functions that are compiled once for a model: inlined, every method of integration would
//! hold copies of all its equations.

use crate::integrate::Stepper;
use crate::{Model, Real};

/// [`Model::outputs`]
#[inline(never)]
pub fn outputs<T: Real, M: Model<T>>(model: &M, t: f64, y: &M::State) -> M::Outputs {
    model.outputs(T::from_f64(t), y)
}

/// [`Model::guards`]
#[inline(never)]
pub fn guards<T: Real, M: Model<T>>(model: &M, t: f64, y: &M::State) -> M::Guards {
    model.guards(T::from_f64(t), y)
}

/// [`Model::kinks`]
#[inline(never)]
pub fn kinks<T: Real, M: Model<T>>(model: &M, t: f64, y: &M::State) -> M::Kinks {
    model.kinks(T::from_f64(t), y)
}

/// [`Model::powers`]
#[inline(never)]
pub fn powers<T: Real, M: Model<T>>(model: &M, t: f64, y: &M::State) -> M::Powers {
    model.powers(T::from_f64(t), y)
}

/// [`Model::kinetic_energy`]
#[inline(never)]
pub fn kinetic_energy<T: Real, M: Model<T>>(model: &M, t: f64, y: &M::State) -> T {
    model.kinetic_energy(T::from_f64(t), y)
}

/// [`Model::momentum`]
#[inline(never)]
pub fn momentum<T: Real, M: Model<T>>(model: &M, t: f64, y: &M::State) -> [T; 6] {
    model.momentum(T::from_f64(t), y)
}

/// [`Model::thrust`]
#[inline(never)]
pub fn thrust<T: Real, M: Model<T>>(model: &M, t: f64, y: &M::State) -> [T; 6] {
    model.thrust(T::from_f64(t), y)
}

/// [`Model::curves`]
#[inline(never)]
pub fn curves<T: Real, M: Model<T>>(model: &M, t: f64, y: &M::State) -> M::Curves {
    model.curves(T::from_f64(t), y)
}

/// [`Model::renew`]
#[inline(never)]
pub fn renew<T: Real, M: Model<T>>(model: &M, t: f64, y: &mut M::State) {
    model.renew(T::from_f64(t), y);
}

/// The state at t + θh inside a step, on its manifold. After [`Stepper::complete`].
#[inline(never)]
pub fn inside<T: Real, M: Model<T>, S: Stepper<T, M>>(model: &M, step: &S, theta: f64) -> M::State {
    let mut y = step.interpolate(theta);
    model.normalize(&mut y);
    y
}
