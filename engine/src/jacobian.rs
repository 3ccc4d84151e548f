//! The derivatives of ẏ with respect to y and t: the equations over dual numbers, with as many columns at once as a
//! register has lanes.

use crate::evaluate::Evaluator;
use crate::execute::{Execute, Given};
use crate::model::{Shared, derive};
use crate::native;
use bryant_generator::program::Method;
#[cfg(target_arch = "aarch64")]
use bryant_runtime::real::Array2;
#[cfg(not(target_arch = "aarch64"))]
use bryant_runtime::real::{Array4, Array8};
use bryant_runtime::{Dual, Real};
use std::any::{Any, TypeId};
use std::fmt::Debug;
use std::sync::Arc;

/// The Jacobian of a model over a scalar.
pub(crate) trait Jacobian<T>: Debug + Send {
    /// Must be called when the parameters change.
    fn forget_parameters(&mut self);
    /// Writes ∂ẏ/∂y, by rows, and ∂ẏ/∂t, for the time and state `at`.
    fn evaluate(&mut self, parameters: &[T], at: (T, &[T]), by_state: &mut [T], by_time: &mut [T]);
}

/// The fastest implementation for this processor. All implementations give the same bits.
pub(crate) fn jacobian<T: Real>(shared: &Arc<Shared>) -> Box<dyn Jacobian<T>> {
    let of_doubles = match TypeId::of::<T>() == TypeId::of::<f64>() {
        true => several(shared),
        false => None,
    };
    let found = of_doubles.map(|of_doubles| -> Box<dyn Any> { Box::new(of_doubles) });
    match found.and_then(|found| found.downcast::<Box<dyn Jacobian<T>>>().ok()) {
        Some(found) => *found,
        None => Box::new(Differentiated::<T, T>::new(shared)),
    }
}

/// An implementation with several columns at once, if there is machine code for it.
#[cfg(target_arch = "aarch64")]
fn several(shared: &Arc<Shared>) -> Option<Box<dyn Jacobian<f64>>> {
    native::has_machine_code::<Dual<Array2>>()
        .then(|| -> Box<dyn Jacobian<f64>> { Box::new(Differentiated::<f64, Array2>::new(shared)) })
}

/// An implementation with several columns at once, if there is machine code for it.
#[cfg(not(target_arch = "aarch64"))]
fn several(shared: &Arc<Shared>) -> Option<Box<dyn Jacobian<f64>>> {
    if Array8::is_available() && native::has_machine_code::<Dual<Array8>>() {
        Some(Box::new(Differentiated::<f64, Array8>::new(shared)))
    } else if Array4::is_available() && native::has_machine_code::<Dual<Array4>>() {
        Some(Box::new(Differentiated::<f64, Array4>::new(shared)))
    } else {
        None
    }
}

/// A scalar that has several lanes of type `T`; each lane has the bits of a `T` alone.
trait Holds<T>: Real {
    const LANES: usize;
    /// The same value in every lane.
    fn all(value: T) -> Self;
    /// 1 in one lane, 0 in the others.
    fn unit(lane: usize) -> Self;
    fn lane(self, lane: usize) -> T;
}

impl<T: Real> Holds<T> for T {
    const LANES: usize = 1;

    fn all(value: T) -> T {
        value
    }

    fn unit(_: usize) -> T {
        T::from_f64(1.0)
    }

    fn lane(self, _: usize) -> T {
        self
    }
}

macro_rules! holds_doubles {
    ($array:ident, $lanes:literal) => {
        impl Holds<f64> for $array {
            const LANES: usize = $lanes;

            fn all(value: f64) -> Self {
                $array([value; $lanes])
            }

            fn unit(lane: usize) -> Self {
                $array(std::array::from_fn(|i| f64::from(u8::from(i == lane))))
            }

            fn lane(self, lane: usize) -> f64 {
                self.0[lane]
            }
        }
    };
}

#[cfg(target_arch = "aarch64")]
holds_doubles!(Array2, 2);
#[cfg(not(target_arch = "aarch64"))]
holds_doubles!(Array4, 4);
#[cfg(not(target_arch = "aarch64"))]
holds_doubles!(Array8, 8);

/// The derivatives over dual numbers, with a column in each lane of `S`.
#[derive(Debug)]
struct Differentiated<T, S: Real> {
    evaluator: Evaluator<Dual<S>>,
    state: Vec<Dual<S>>,
    rate: Vec<Dual<S>>,
    derived: usize,
    /// True if the evaluator has the current parameters of the model.
    current: bool,
    of: std::marker::PhantomData<T>,
}

impl<T: Real, S: Holds<T>> Differentiated<T, S> {
    fn new(shared: &Arc<Shared>) -> Self {
        let zeros = |length| vec![Dual::constant(S::from_f64(0.0)); length];
        Differentiated {
            evaluator: Evaluator::new(shared.clone()),
            state: zeros(shared.info().state_length()),
            rate: zeros(shared.info().varying_length()),
            derived: shared.lists.derived,
            current: false,
            of: std::marker::PhantomData,
        }
    }

    fn set_parameters(&mut self, parameters: &[T]) {
        let parameters = parameters
            .iter()
            .map(|value| Dual::constant(S::all(*value)));
        let parameters: Vec<Dual<S>> = parameters.collect();
        let mut derived = vec![Dual::constant(S::from_f64(0.0)); self.derived];
        derive(&mut self.evaluator, &parameters, &mut derived);
        self.current = true;
    }
}

impl<T: Real, S: Holds<T>> Jacobian<T> for Differentiated<T, S> {
    fn forget_parameters(&mut self) {
        self.current = false;
    }

    /// Computes the columns of the varying entries of y, then that of t, `LANES` columns at each evaluation.
    fn evaluate(
        &mut self,
        parameters: &[T],
        (t, y): (T, &[T]),
        by_state: &mut [T],
        by_time: &mut [T],
    ) {
        if !self.current {
            self.set_parameters(parameters);
        }
        let zero = T::from_f64(0.0);
        for (entry, value) in self.state.iter_mut().zip(y) {
            *entry = Dual::constant(S::all(*value));
        }
        by_state.fill(zero);
        by_time.fill(zero);
        let varying = self.rate.len();
        for first in (0..=varying).step_by(S::LANES) {
            let end = (first + S::LANES).min(varying + 1);
            let mut time = Dual::constant(S::all(t));
            for column in first..end {
                let entry = match column == varying {
                    true => &mut time,
                    false => &mut self.state[column],
                };
                entry.slope = S::unit(column - first);
            }
            let given = Given {
                time,
                state: &self.state,
            };
            self.evaluator
                .run(Method::Derivative.into(), given, &mut self.rate);
            for entry in &mut self.state[first..end.min(varying)] {
                entry.slope = S::from_f64(0.0);
            }
            for (row, rate) in self.rate.iter().enumerate() {
                for column in first..end {
                    let place = match column == varying {
                        true => &mut by_time[row],
                        false => &mut by_state[row * y.len() + column],
                    };
                    *place = rate.slope.lane(column - first);
                }
            }
        }
    }
}
