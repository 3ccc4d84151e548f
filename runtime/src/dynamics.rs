//! The boundary between a model and all code that works with one.
//!
//! [`Dynamics`] is a table of functions over slices. Time loops, batches, responses and programs take a `&dyn
//! Dynamics<T>`, so they are compiled once for each scalar and not again for each model. A call through the table takes
//! a few nanoseconds; an evaluation of a model takes a hundred or more.
//!
//! Every generated module implements [`Model`]. [`Direct`], [`Differentiable`] and [`Owned`] turn it into a `Dynamics`.
//! A model that is known only at run time implements `Dynamics` directly.
//!
//! Loops that fuse a step with the equations ([`march`](crate::integrate::march())) take a [`Model`] instead and are
//! compiled for each model.

use crate::model::over;
use crate::real::Task;
use crate::section::sections;
use crate::{Dual, Info, Model, ParameterSet, Real, Section, StateKind, Vector};
use core::marker::PhantomData;

/// The methods of [`Dynamics`] for its sections, in the forms that the table gives.
macro_rules! accessors {
    ($($(#[$doc:meta])* $section:ident $name:ident $form:ident |$info:ident| $length:expr;)*) => {
        $(accessor! { $(#[$doc])* $form $section $name })*
    };
}
macro_rules! accessor {
    ($(#[$doc:meta])* many $section:ident $name:ident) => {
        $(#[$doc])*
        fn $name(&self, t: T, y: &[T], results: &mut [T]) {
            self.section(Section::$section, t, y, results);
        }
    };
    ($(#[$doc:meta])* one $section:ident $name:ident) => {
        $(#[$doc])*
        fn $name(&self, t: T, y: &[T]) -> T {
            let mut result = [T::from_f64(0.0)];
            self.section(Section::$section, t, y, &mut result);
            result[0]
        }
    };
    ($(#[$doc:meta])* six $section:ident $name:ident) => {
        $(#[$doc])*
        fn $name(&self, t: T, y: &[T]) -> [T; 6] {
            let mut results = [T::from_f64(0.0); 6];
            let length = self.info().length(Section::$section);
            self.section(Section::$section, t, y, &mut results[..length]);
            results
        }
    };
    ($(#[$doc:meta])* state $section:ident $name:ident) => {
        $(#[$doc])*
        /// Without memory it is the same state.
        fn $name(&self, t: T, y: &[T], results: &mut [T]) {
            match self.info().length(Section::$section) {
                0 => results.copy_from_slice(y),
                _ => self.section(Section::$section, t, y, results),
            }
        }
    };
}

/// A model at one set of parameters, over one scalar.
///
/// The state y is that of [`Model`]: q, v, z, m. Every slice has exactly the length that [`Info`] gives; with another
/// length an implementation may panic. Nothing here allocates after the model is made.
pub trait Dynamics<T: Real> {
    /// Names, units and sizes.
    fn info(&self) -> &Info<'_>;
    /// The value of a parameter \[SI\], by its index in [`Info::parameters`]; `None` for an index beyond the last.
    fn parameter(&self, index: usize) -> Option<T>;
    /// The state at which a run starts.
    fn initial_state(&self, y: &mut [T]);
    /// ẏ at time `t` \[s\] and state `y`.
    fn derivative(&self, t: T, y: &[T], rate: &mut [T]);
    /// q̇, written into the coordinates of `rate`. The rest of `rate` is not changed.
    fn coordinate_rates(&self, y: &[T], rate: &mut [T]);
    /// ∂ẏ/∂y by rows, with as many rows and columns as `y` has entries, and ∂ẏ/∂t. Columns of discrete states
    /// ([`StateKind::Memory`]) are not written, because nothing integrates them. Returns false, and writes nothing,
    /// where the model has no Jacobian.
    fn jacobian(&self, t: T, y: &[T], by_state: &mut [T], by_time: &mut [T]) -> bool;
    /// Puts the state back on its manifold (unit quaternions).
    fn normalize(&self, y: &mut [T]);
    /// The smallest pivot and the index of its element: [`Model::smallest_pivot`].
    fn smallest_pivot(&self, t: T, y: &[T]) -> Option<(usize, T)>;
    /// The first condition on parameters that does not hold: an index in [`Info::conditions`].
    fn violated(&self) -> Option<usize>;
    /// The first kink in time after `t` whose place depends on parameters: [`Model::kink_after`].
    fn kink_after(&self, t: f64) -> T;
    /// Writes a section of the model. `results` has the length [`Info::length`].
    fn section(&self, section: Section, t: T, y: &[T], results: &mut [T]);
    /// Writes several sections at the same time and state, each to its slice; those with an empty slice are not wanted.
    /// It is fastest if they are in the order of [`Section::ALL`], each once.
    /// An implementation that computes them at once returns the same bits: most need the contacts, and can share the
    /// searches between ellipsoids.
    fn sections(&self, t: T, y: &[T], wanted: &mut [(Section, &mut [T])]) {
        one_by_one(self, t, y, wanted);
    }

    sections!(accessors);
}

/// The default of [`Dynamics::sections`]: writes one section after the other.
pub fn one_by_one<T: Real, M: Dynamics<T> + ?Sized>(
    model: &M,
    t: T,
    y: &[T],
    wanted: &mut [(Section, &mut [T])],
) {
    for (section, results) in wanted {
        if !results.is_empty() {
            model.section(*section, t, y, results);
        }
    }
}

/// A model whose parameters can be changed between runs.
pub trait Adjustable<T: Real>: Dynamics<T> {
    /// Sets all parameters, in the order of [`Info::parameters`] \[SI\]. Everything that depends on parameters alone is
    /// computed here.
    fn set_parameters(&mut self, values: &[T]);
    /// From now on only these outputs are needed, given by their index in [`Info::outputs`]. [`Dynamics::outputs`] need
    /// not write the others. The needed ones keep their bits. The default computes all outputs.
    fn want_outputs(&mut self, wanted: &[usize]) {
        let _ = wanted;
    }
}

/// The models of one description over any scalar, with the default values of all parameters.
#[cfg(feature = "std")]
pub trait Family {
    /// Names, units and sizes of all of them.
    fn info(&self) -> &Info<'_>;
    /// The model over a scalar. The caller may send it to another thread before it is used.
    fn over<T: Real>(&self) -> std::boxed::Box<dyn Adjustable<T> + '_>;
    /// The model over a scalar for a batch. A batch calls neither the Jacobian nor the smallest pivot, so these may
    /// return anything. A family that compiles its functions one by one saves time here; the default is
    /// [`Family::over`].
    fn for_batch<T: Real>(&self) -> std::boxed::Box<dyn Adjustable<T> + '_> {
        self.over()
    }
    /// The part of the model that depends on parameters alone, before a run, over a scalar. The default uses
    /// [`Family::over`].
    fn schedule<T: Real>(&self) -> std::boxed::Box<dyn Schedule<T> + '_> {
        std::boxed::Box::new(self.over())
    }
}

/// The part of a model that depends on parameters alone: whether the parameters are valid, and when curves of time have
/// kinks.
pub trait Schedule<T: Real> {
    /// Sets all parameters, in the order of [`Info::parameters`] \[SI\].
    fn set_parameters(&mut self, values: &[T]);
    /// [`Dynamics::violated`]
    fn violated(&self) -> Option<usize>;
    /// [`Dynamics::kink_after`]
    fn kink_after(&self, t: f64) -> T;
}

#[cfg(feature = "std")]
impl<T: Real> Schedule<T> for std::boxed::Box<dyn Adjustable<T> + '_> {
    fn set_parameters(&mut self, values: &[T]) {
        (**self).set_parameters(values);
    }

    fn violated(&self) -> Option<usize> {
        (**self).violated()
    }

    fn kink_after(&self, t: f64) -> T {
        (**self).kink_after(t)
    }
}

impl Info<'_> {
    /// Number of entries of the state: q, v, z and m.
    pub const fn state_length(&self) -> usize {
        self.kinds.len()
    }

    /// Number of entries of the state that change during a step: all but the discrete states, which come last.
    pub const fn varying_length(&self) -> usize {
        self.kinds.len() - self.memory.len()
    }

    /// The kind of an entry of the state.
    pub fn kind(&self, index: usize) -> StateKind {
        self.kinds.get(index).copied().unwrap_or(StateKind::Law)
    }
}

/// A derivative of at most this many entries is returned as a whole. Stores between its statements would keep the
/// compiler from pairing them, which costs 5 % with 18 entries. With a hundred entries, returning it as a whole is 2 %
/// slower than entry by entry.
const SHORT: usize = 32;

/// A function of a model, compiled for the instructions that its scalar needs ([`Real::dispatch`]).
macro_rules! enabled {
    ($($task:ident { $($field:ident: $type:ty),* } -> $output:ty, |$model:ident| $body:expr;)*) => {
        $(
            struct $task<'a, T, M> {
                model: &'a M,
                of: PhantomData<T>,
                $($field: $type,)*
            }

            impl<'a, T: Real, M: Model<T>> Task for $task<'a, T, M> {
                type Output = $output;
                #[inline(always)]
                fn run(self) -> $output {
                    let $task { model: $model, of: _, $($field),* } = self;
                    $body
                }
            }
        )*
    };
}

enabled! {
    InitialState { y: &'a mut [T] } -> (), |model| y.copy_from_slice(model.initial_state().as_ref());
    Derivative { t: &'a T, y: &'a [T], rate: &'a mut [T] } -> (), |model| {
        let (y, rate) = (M::State::of(y), M::State::of_mut(rate));
        if M::State::LEN <= SHORT {
            *rate = model.derivative(*t, y);
        } else {
            model.each_rate(*t, y, rate);
        }
    };
    CoordinateRates { y: &'a [T], rate: &'a mut [T] } -> (), |model| {
        model.coordinate_rates(M::State::of(y), M::State::of_mut(rate));
    };
    Normalize { y: &'a mut [T] } -> (), |model| model.normalize(M::State::of_mut(y));
    SmallestPivot { t: &'a T, y: &'a [T] } -> Option<(usize, T)>, |model| {
        model.smallest_pivot(*t, M::State::of(y))
    };
    KinkAfter { t: f64 } -> T, |model| model.kink_after(t);
}

/// Writes a section of a generated model, compiled for the instructions that the scalar needs. No section that the
/// model does not have is compiled, and each is a function of its own, so that none pays for the registers of another.
macro_rules! dispatched {
    ($($(#[$doc:meta])* $section:ident $name:ident $form:ident |$info:ident| $length:expr;)*) => {
        fn write_section<T: Real, M: Model<T>>(
            model: &M,
            section: Section,
            (t, y): (&T, &[T]),
            results: &mut [T],
        ) {
            match section {
                $(Section::$section => {
                    struct At<'a, T, M>(&'a M, &'a T, &'a [T], &'a mut [T]);

                    impl<T: Real, M: Model<T>> Task for At<'_, T, M> {
                        type Output = ();
                        #[inline(always)]
                        fn run(self) {
                            let At(model, t, y, results) = self;
                            written!($form $name, model, *t, y, results);
                        }
                    }

                    if const { M::INFO.length(Section::$section) > 0 } {
                        T::dispatch_apart(At(model, t, y, results));
                    }
                })*
            }
        }
    };
}
macro_rules! written {
    (state $name:ident, $model:ident, $t:expr, $y:ident, $results:ident) => {
        $results.copy_from_slice($y);
        $model.renew($t, M::State::of_mut($results));
    };
    ($form:ident $name:ident, $model:ident, $t:expr, $y:ident, $results:ident) => {
        $model.$name($t, M::State::of($y), $results)
    };
}
sections!(dispatched);

struct Made<T, M: Model<T>>
where
    T: Real,
{
    parameters: M::Parameters,
}

impl<T: Real, M: Model<T>> Task for Made<T, M> {
    type Output = M;
    #[inline(always)]
    fn run(self) -> M {
        M::new(self.parameters)
    }
}

/// A generated model by reference as [`Dynamics`], without a Jacobian.
#[derive(Clone, Copy, Debug)]
pub struct Direct<'a, M>(pub &'a M);

/// A generated model by reference as [`Dynamics`], with a Jacobian by dual numbers, which the Rosenbrock method needs.
/// It is a type of its own because it compiles the equations a second time, over dual numbers. No other method needs
/// that.
#[derive(Clone, Copy, Debug)]
pub struct Differentiable<'a, M>(pub &'a M);

/// A generated model as [`Adjustable`].
#[derive(Clone, Copy, Debug)]
pub struct Owned<M>(pub M);

/// A generated model as [`Adjustable`], with a Jacobian by dual numbers as [`Differentiable`].
#[derive(Clone, Copy, Debug)]
pub struct OwnedDifferentiable<M>(pub M);

impl<M> Direct<'_, M> {
    fn model(&self) -> &M {
        self.0
    }
}

impl<M> Differentiable<'_, M> {
    fn model(&self) -> &M {
        self.0
    }
}

impl<M> Owned<M> {
    fn model(&self) -> &M {
        &self.0
    }
}

impl<M> OwnedDifferentiable<M> {
    fn model(&self) -> &M {
        &self.0
    }
}

/// [`Dynamics`] for a type that holds a model. `jacobian` says how it is differentiated, `pivots` whether it has a
/// smallest pivot.
macro_rules! dynamics {
    ($holder:ty, $jacobian:expr, $pivots:literal) => {
        impl<T: Real, M: Model<T>> Dynamics<T> for $holder {
            fn info(&self) -> &Info<'_> {
                M::INFO
            }

            fn parameter(&self, index: usize) -> Option<T> {
                Model::parameters(self.model()).get(index)
            }

            fn initial_state(&self, y: &mut [T]) {
                T::dispatch(InitialState {
                    model: self.model(),
                    of: PhantomData,
                    y,
                });
            }

            fn derivative(&self, t: T, y: &[T], rate: &mut [T]) {
                T::dispatch(Derivative {
                    model: self.model(),
                    of: PhantomData,
                    t: &t,
                    y,
                    rate,
                });
            }

            fn coordinate_rates(&self, y: &[T], rate: &mut [T]) {
                T::dispatch(CoordinateRates {
                    model: self.model(),
                    of: PhantomData,
                    y,
                    rate,
                });
            }

            fn jacobian(&self, t: T, y: &[T], by_state: &mut [T], by_time: &mut [T]) -> bool {
                let jacobian: fn(&M, T, &[T], &mut [T], &mut [T]) -> bool = $jacobian;
                jacobian(self.model(), t, y, by_state, by_time)
            }

            fn normalize(&self, y: &mut [T]) {
                T::dispatch(Normalize {
                    model: self.model(),
                    of: PhantomData,
                    y,
                });
            }

            fn smallest_pivot(&self, t: T, y: &[T]) -> Option<(usize, T)> {
                if const { !$pivots } {
                    return None;
                }
                T::dispatch(SmallestPivot {
                    model: self.model(),
                    of: PhantomData,
                    t: &t,
                    y,
                })
            }

            fn violated(&self) -> Option<usize> {
                Model::violated(self.model())
            }

            fn kink_after(&self, t: f64) -> T {
                T::dispatch(KinkAfter {
                    model: self.model(),
                    of: PhantomData,
                    t,
                })
            }

            fn section(&self, section: Section, t: T, y: &[T], results: &mut [T]) {
                write_section(self.model(), section, (&t, y), results);
            }
        }
    };
}

dynamics!(Direct<'_, M>, |_, _, _, _, _| false, true);
dynamics!(Differentiable<'_, M>, jacobian_by_duals, true);
dynamics!(Owned<M>, |_, _, _, _, _| false, true);
dynamics!(OwnedDifferentiable<M>, jacobian_by_duals, true);
#[cfg(feature = "std")]
dynamics!(Batched<M>, |_, _, _, _, _| false, false);

/// [`Adjustable`] for a type that owns a model.
macro_rules! adjustable {
    ($holder:ident) => {
        impl<T: Real, M: Model<T>> Adjustable<T> for $holder<M> {
            fn set_parameters(&mut self, values: &[T]) {
                set_parameters(&mut self.0, values);
            }
        }
    };
}

adjustable!(Owned);
adjustable!(OwnedDifferentiable);
#[cfg(feature = "std")]
adjustable!(Batched);

/// A generated model with the default values of all parameters, without a Jacobian.
#[cfg(feature = "std")]
pub fn made<T: Real, M: Model<T> + 'static>() -> std::boxed::Box<dyn Adjustable<T>> {
    std::boxed::Box::new(Owned(with_defaults::<T, M>()))
}

/// [`made`] with a Jacobian by dual numbers.
#[cfg(feature = "std")]
pub fn made_differentiable<T: Real, M: Model<T> + 'static>() -> std::boxed::Box<dyn Adjustable<T>> {
    std::boxed::Box::new(OwnedDifferentiable(with_defaults::<T, M>()))
}

#[cfg(feature = "std")]
fn with_defaults<T: Real, M: Model<T>>() -> M {
    let parameters = M::Parameters::defaults();
    T::dispatch(Made::<T, M> { parameters })
}

fn set_parameters<T: Real, M: Model<T>>(model: &mut M, values: &[T]) {
    let mut parameters = model.parameters().clone();
    for (index, value) in values.iter().enumerate() {
        parameters.set(index, *value);
    }
    *model = T::dispatch(Made::<T, M> { parameters });
}

/// [`Dynamics::jacobian`] column by column: one evaluation over dual numbers for each entry that varies, and one for
/// the time.
fn jacobian_by_duals<T: Real, M: Model<T>>(
    model: &M,
    t: T,
    y: &[T],
    by_state: &mut [T],
    by_time: &mut [T],
) -> bool {
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let at = |value, slope| Dual { value, slope };
    let dual = over(model, |value| at(value, zero));
    let mut state = <M::With<Dual<T>> as Model<Dual<T>>>::State::splat(at(zero, zero));
    for (entry, value) in state.as_mut().iter_mut().zip(y) {
        entry.value = *value;
    }
    let rate = dual.derivative(at(t, one), &state);
    for (slope, rate) in by_time.iter_mut().zip(rate.as_ref()) {
        *slope = rate.slope;
    }
    for column in 0..M::INFO.varying_length() {
        state[column].slope = one;
        let rate = dual.derivative(at(t, zero), &state);
        state[column].slope = zero;
        for (row, rate) in rate.as_ref().iter().enumerate() {
            by_state[row * y.len() + column] = rate.slope;
        }
    }
    true
}

/// The family of a generated model.
#[cfg(feature = "std")]
#[derive(Clone, Copy, Debug)]
pub struct Compiled<M>(PhantomData<M>);

#[cfg(feature = "std")]
impl<M: Model<f64>> Compiled<M> {
    /// The family of the model `M`.
    pub const fn new() -> Self {
        Compiled(PhantomData)
    }
}

#[cfg(feature = "std")]
impl<M: Model<f64>> Default for Compiled<M> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(feature = "std")]
impl<M: Model<f64>> Family for Compiled<M> {
    fn info(&self) -> &Info<'_> {
        M::INFO
    }

    fn over<T: Real>(&self) -> std::boxed::Box<dyn Adjustable<T> + '_> {
        std::boxed::Box::new(Owned(with_defaults::<T, M::With<T>>()))
    }

    fn for_batch<T: Real>(&self) -> std::boxed::Box<dyn Adjustable<T> + '_> {
        std::boxed::Box::new(Batched(with_defaults::<T, M::With<T>>()))
    }

    fn schedule<T: Real>(&self) -> std::boxed::Box<dyn Schedule<T> + '_> {
        std::boxed::Box::new(Scheduled(with_defaults::<T, M::With<T>>()))
    }
}

/// A generated model for [`Family::for_batch`]. Methods that no batch calls are not compiled: it has neither a Jacobian
/// nor a smallest pivot.
#[cfg(feature = "std")]
struct Batched<M>(M);

#[cfg(feature = "std")]
impl<M> Batched<M> {
    fn model(&self) -> &M {
        &self.0
    }
}

/// A generated model for [`Family::schedule`].
#[cfg(feature = "std")]
struct Scheduled<M>(M);

#[cfg(feature = "std")]
impl<T: Real, M: Model<T>> Schedule<T> for Scheduled<M> {
    fn set_parameters(&mut self, values: &[T]) {
        set_parameters(&mut self.0, values);
    }

    fn violated(&self) -> Option<usize> {
        self.0.violated()
    }

    fn kink_after(&self, t: f64) -> T {
        T::dispatch(KinkAfter {
            model: &self.0,
            of: PhantomData,
            t,
        })
    }
}
