//! The functions of a model, each a task of its own: compiled once, for the instructions of its scalar, with all that it calls inlined.

use crate::integrate::Rate;
use crate::real::Task;
use crate::{Model, Real};
use core::marker::PhantomData;

/// A function of a time and a state.
macro_rules! enabled {
    ($(#[$text:meta])* $function:ident, $task:ident, $answer:ident) => {
        $(#[$text])*
        #[inline(always)]
        pub fn $function<T: Real, M: Model<T>>(model: &M, t: T, y: &M::State) -> M::$answer {
            T::enable($task { model, t, y })
        }

        struct $task<'a, T, M, S> {
            model: &'a M,
            t: T,
            y: &'a S,
        }

        impl<T: Real, M: Model<T>> Task for $task<'_, T, M, M::State> {
            type Output = M::$answer;
            #[inline(always)]
            fn run(self) -> M::$answer {
                self.model.$function(self.t, self.y)
            }
        }
    };
}

/// [`Model::derivative`], put in its place.
#[inline(always)]
pub fn rate<T: Real, M: Model<T>>(model: &M, t: T, y: &M::State, rate: &mut M::State) {
    T::enable(Rate { model, t, y, rate });
}

enabled!(
    /// [`Model::outputs`]
    outputs, Outputs, Outputs
);
enabled!(
    /// [`Model::guards`]
    guards, Guards, Guards
);
enabled!(
    /// [`Model::kinks`]
    kinks, Kinks, Kinks
);

/// The state with its memory renewed: [`Model::renew`].
#[inline(always)]
pub fn renewed<T: Real, M: Model<T>>(model: &M, t: T, y: &M::State) -> M::State {
    T::enable(Renewed { model, t, y })
}

struct Renewed<'a, T, M, S> {
    model: &'a M,
    t: T,
    y: &'a S,
}

impl<T: Real, M: Model<T>> Task for Renewed<'_, T, M, M::State> {
    type Output = M::State;
    #[inline(always)]
    fn run(self) -> M::State {
        let mut y = *self.y;
        self.model.renew(self.t, &mut y);
        y
    }
}

/// The model with these parameters.
#[inline(always)]
pub fn made<T: Real, M: Model<T>>(parameters: M::Parameters) -> M {
    T::enable(Made::<T, M, M::Parameters> {
        parameters,
        of: PhantomData,
    })
}

struct Made<T, M, P> {
    parameters: P,
    of: PhantomData<(T, M)>,
}

impl<T: Real, M: Model<T>> Task for Made<T, M, M::Parameters> {
    type Output = M;
    #[inline(always)]
    fn run(self) -> M {
        M::new(self.parameters)
    }
}

/// The model with these parameters, and where it starts.
#[inline(always)]
pub fn begin<T: Real, M: Model<T>>(parameters: M::Parameters) -> (M, M::State) {
    T::enable(Begin::<T, M, M::Parameters> {
        parameters,
        of: PhantomData,
    })
}

struct Begin<T, M, P> {
    parameters: P,
    of: PhantomData<(T, M)>,
}

impl<T: Real, M: Model<T>> Task for Begin<T, M, M::Parameters> {
    type Output = (M, M::State);
    #[inline(always)]
    fn run(self) -> (M, M::State) {
        let model = M::new(self.parameters);
        let state = model.initial_state();
        (model, state)
    }
}

/// The state on its manifold: [`Model::normalize`].
#[inline(always)]
pub fn normalized<T: Real, M: Model<T>>(model: &M, y: &M::State) -> M::State {
    T::enable(Normalized::<T, M, M::State> {
        model,
        y,
        of: PhantomData,
    })
}

struct Normalized<'a, T, M, S> {
    model: &'a M,
    y: &'a S,
    of: PhantomData<T>,
}

impl<T: Real, M: Model<T>> Task for Normalized<'_, T, M, M::State> {
    type Output = M::State;
    #[inline(always)]
    fn run(self) -> M::State {
        let mut y = *self.y;
        self.model.normalize(&mut y);
        y
    }
}
