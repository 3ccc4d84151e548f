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
use crate::{Dual, Info, Model, ParameterSet, Real, StateKind, Vector};
use core::marker::PhantomData;

/// A model at one set of parameters, over one scalar.
///
/// The state y is that of [`Model`]: q, v, z, m. Every slice has exactly the length that [`Info`] gives; with another
/// length an implementation may panic. Nothing here allocates after the model is made.
pub trait Dynamics<T: Real> {
    /// Names, units and sizes.
    fn info(&self) -> &'static Info;
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
    /// The outputs, in the order and units of [`Info::outputs`].
    fn outputs(&self, t: T, y: &[T], outputs: &mut [T]);
    /// Puts the state back on its manifold (unit quaternions).
    fn normalize(&self, y: &mut [T]);
    /// The discrete update of the state after a step: [`Model::renew`].
    fn renew(&self, t: T, y: &mut [T]);
    /// [`Dynamics::renew`], given event functions that are already known at this time and state. An implementation that
    /// uses them returns the same bits.
    fn renew_by(&self, t: T, y: &mut [T], event_functions: &[T]) {
        let _ = event_functions;
        self.renew(t, y);
    }
    /// The event functions, in the order of [`Info::event_functions`]: [`Model::event_functions`].
    fn event_functions(&self, t: T, y: &[T], event_functions: &mut [T]);
    /// The non-smooth switching functions (kinks), in the order of [`Info::kinks`]: [`Model::kinks`].
    fn kinks(&self, t: T, y: &[T], kinks: &mut [T]);
    /// The onsets: all gaps in the order of [`Info::onsets`], then all speeds: [`Model::onsets`].
    fn onsets(&self, t: T, y: &[T], onsets: &mut [T]);
    /// The arguments of the curves that depend on the state, in the order of [`Info::curves`]: [`Model::curves`].
    fn curves(&self, t: T, y: &[T], arguments: &mut [T]);
    /// The smallest pivot and the index of its element: [`Model::smallest_pivot`].
    fn smallest_pivot(&self, t: T, y: &[T]) -> Option<(usize, T)>;
    /// The first condition on parameters that does not hold: an index in [`Info::conditions`].
    fn violated(&self) -> Option<usize>;
    /// Kinetic energy T \[J\].
    fn kinetic_energy(&self, t: T, y: &[T]) -> T;
    /// The power of each effect \[W\], in the order of [`Info::powers`].
    fn powers(&self, t: T, y: &[T], powers: &mut [T]);
    /// Linear momentum \[N s\] and angular momentum about the origin \[N m s\] of the free systems:
    /// [`Model::momentum`].
    fn momentum(&self, t: T, y: &[T]) -> [T; 6];
    /// The net external wrench, the rate of the momentum: [`Model::external_wrench`].
    fn external_wrench(&self, t: T, y: &[T]) -> [T; 6];
    /// [`Dynamics::powers`], and [`Dynamics::external_wrench`] if a system is free; if none is free, `external_wrench`
    /// is not written. Balances need both inside a step. An implementation that computes both at once returns the same
    /// bits.
    fn exchange(&self, t: T, y: &[T], powers: &mut [T], external_wrench: &mut [T; 6]) {
        exchange(self, t, y, powers, external_wrench);
    }
    /// Everything that is needed at the end of a step. An implementation that computes it at once returns the same
    /// bits.
    fn arrive(&self, t: T, y: &[T], arrival: &mut Arrival<'_, T>) {
        arrive(self, t, y, arrival);
    }
    /// The first kink in time after `t` whose place depends on parameters: [`Model::kink_after`].
    fn kink_after(&self, t: f64) -> T;
}

/// Where [`Dynamics::arrive`] writes what is needed at the end of a step. The slices have the lengths that [`Info`]
/// gives. Most entries need the contacts. An implementation that computes all entries at once can share the searches
/// between ellipsoids: one for a force, one for a distance.
#[derive(Debug)]
pub struct Arrival<'a, T> {
    /// [`Dynamics::event_functions`]
    pub event_functions: &'a mut [T],
    /// [`Dynamics::onsets`]
    pub onsets: &'a mut [T],
    /// The state after [`Dynamics::renew_by`] with these event functions, if the model has memory; otherwise not
    /// written.
    pub renewed: &'a mut [T],
    /// [`Dynamics::curves`]; empty if they are not needed.
    pub curves: &'a mut [T],
    /// Further values that a watch needs.
    pub account: Option<AccountArrival<'a, T>>,
}

/// Values at the end of a step that the balances of energy and momentum need.
#[derive(Debug)]
pub struct AccountArrival<'a, T> {
    /// [`Dynamics::kinetic_energy`] \[J\]
    pub kinetic_energy: &'a mut T,
    /// [`Dynamics::powers`] \[W\]
    pub powers: &'a mut [T],
    /// [`Dynamics::momentum`]; not written where no system is free.
    pub momentum: &'a mut [T; 6],
    /// [`Dynamics::external_wrench`]; not written where no system is free.
    pub external_wrench: &'a mut [T; 6],
}

/// The default of [`Dynamics::exchange`]: calls one function after the other.
pub fn exchange<T: Real, M: Dynamics<T> + ?Sized>(
    model: &M,
    t: T,
    y: &[T],
    powers: &mut [T],
    external_wrench: &mut [T; 6],
) {
    model.powers(t, y, powers);
    if model.info().free {
        *external_wrench = model.external_wrench(t, y);
    }
}

/// The default of [`Dynamics::arrive`]: calls one function after the other.
pub fn arrive<T: Real, M: Dynamics<T> + ?Sized>(
    model: &M,
    t: T,
    y: &[T],
    arrival: &mut Arrival<'_, T>,
) {
    let info = model.info();
    if !info.event_functions.is_empty() {
        model.event_functions(t, y, arrival.event_functions);
    }
    if !info.onsets.is_empty() {
        model.onsets(t, y, arrival.onsets);
    }
    if !info.memory.is_empty() {
        arrival.renewed.copy_from_slice(y);
        model.renew_by(t, arrival.renewed, arrival.event_functions);
    }
    if !arrival.curves.is_empty() {
        model.curves(t, y, arrival.curves);
    }
    let Some(account) = &mut arrival.account else {
        return;
    };
    *account.kinetic_energy = model.kinetic_energy(t, y);
    exchange(model, t, y, account.powers, account.external_wrench);
    if info.free {
        *account.momentum = model.momentum(t, y);
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
    fn info(&self) -> &'static Info;
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

impl Info {
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
    Outputs { t: &'a T, y: &'a [T], out: &'a mut [T] } -> (), |model| {
        *M::Outputs::of_mut(out) = model.outputs(*t, M::State::of(y));
    };
    Normalize { y: &'a mut [T] } -> (), |model| model.normalize(M::State::of_mut(y));
    Renew { t: &'a T, y: &'a mut [T] } -> (), |model| model.renew(*t, M::State::of_mut(y));
    EventFunctions { t: &'a T, y: &'a [T], out: &'a mut [T] } -> (), |model| {
        *M::EventFunctions::of_mut(out) = model.event_functions(*t, M::State::of(y));
    };
    Kinks { t: &'a T, y: &'a [T], out: &'a mut [T] } -> (), |model| {
        *M::Kinks::of_mut(out) = model.kinks(*t, M::State::of(y));
    };
    Onsets { t: &'a T, y: &'a [T], out: &'a mut [T] } -> (), |model| {
        model.onsets(*t, M::State::of(y), out);
    };
    Curves { t: &'a T, y: &'a [T], out: &'a mut [T] } -> (), |model| {
        *M::Curves::of_mut(out) = model.curves(*t, M::State::of(y));
    };
    SmallestPivot { t: &'a T, y: &'a [T] } -> Option<(usize, T)>, |model| {
        model.smallest_pivot(*t, M::State::of(y))
    };
    KineticEnergy { t: &'a T, y: &'a [T] } -> T, |model| model.kinetic_energy(*t, M::State::of(y));
    Powers { t: &'a T, y: &'a [T], out: &'a mut [T] } -> (), |model| {
        *M::Powers::of_mut(out) = model.powers(*t, M::State::of(y));
    };
    Momentum { t: &'a T, y: &'a [T] } -> [T; 6], |model| model.momentum(*t, M::State::of(y));
    ExternalWrench { t: &'a T, y: &'a [T] } -> [T; 6], |model| model.external_wrench(*t, M::State::of(y));
    KinkAfter { t: f64 } -> T, |model| model.kink_after(t);
}

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

/// The methods of [`Dynamics`] that a run or a batch calls, for a type that holds a model.
macro_rules! stepping {
    () => {
        fn info(&self) -> &'static Info {
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

        fn outputs(&self, t: T, y: &[T], out: &mut [T]) {
            T::dispatch(Outputs {
                model: self.model(),
                of: PhantomData,
                t: &t,
                y,
                out,
            });
        }

        fn normalize(&self, y: &mut [T]) {
            T::dispatch(Normalize {
                model: self.model(),
                of: PhantomData,
                y,
            });
        }

        fn renew(&self, t: T, y: &mut [T]) {
            T::dispatch(Renew {
                model: self.model(),
                of: PhantomData,
                t: &t,
                y,
            });
        }

        fn event_functions(&self, t: T, y: &[T], out: &mut [T]) {
            T::dispatch(EventFunctions {
                model: self.model(),
                of: PhantomData,
                t: &t,
                y,
                out,
            });
        }

        fn kinks(&self, t: T, y: &[T], out: &mut [T]) {
            T::dispatch(Kinks {
                model: self.model(),
                of: PhantomData,
                t: &t,
                y,
                out,
            });
        }

        fn onsets(&self, t: T, y: &[T], out: &mut [T]) {
            T::dispatch(Onsets {
                model: self.model(),
                of: PhantomData,
                t: &t,
                y,
                out,
            });
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
    };
}

/// The methods of [`Dynamics`] that a watched run calls, for a type that holds a model: energies and momenta.
macro_rules! accounts {
    () => {
        fn kinetic_energy(&self, t: T, y: &[T]) -> T {
            T::dispatch(KineticEnergy {
                model: self.model(),
                of: PhantomData,
                t: &t,
                y,
            })
        }

        fn powers(&self, t: T, y: &[T], out: &mut [T]) {
            T::dispatch(Powers {
                model: self.model(),
                of: PhantomData,
                t: &t,
                y,
                out,
            });
        }

        fn momentum(&self, t: T, y: &[T]) -> [T; 6] {
            T::dispatch(Momentum {
                model: self.model(),
                of: PhantomData,
                t: &t,
                y,
            })
        }

        fn external_wrench(&self, t: T, y: &[T]) -> [T; 6] {
            T::dispatch(ExternalWrench {
                model: self.model(),
                of: PhantomData,
                t: &t,
                y,
            })
        }
    };
}

/// [`Dynamics`] for a type that holds a model; `jacobian` says how it is differentiated.
macro_rules! dynamics {
    ($holder:ty, $jacobian:expr) => {
        impl<T: Real, M: Model<T>> Dynamics<T> for $holder {
            stepping!();

            fn jacobian(&self, t: T, y: &[T], by_state: &mut [T], by_time: &mut [T]) -> bool {
                let jacobian: fn(&M, T, &[T], &mut [T], &mut [T]) -> bool = $jacobian;
                jacobian(self.model(), t, y, by_state, by_time)
            }

            fn curves(&self, t: T, y: &[T], out: &mut [T]) {
                T::dispatch(Curves {
                    model: self.model(),
                    of: PhantomData,
                    t: &t,
                    y,
                    out,
                });
            }

            fn smallest_pivot(&self, t: T, y: &[T]) -> Option<(usize, T)> {
                T::dispatch(SmallestPivot {
                    model: self.model(),
                    of: PhantomData,
                    t: &t,
                    y,
                })
            }

            accounts!();
        }
    };
}

dynamics!(Direct<'_, M>, |_, _, _, _, _| false);
dynamics!(Differentiable<'_, M>, jacobian_by_duals);
dynamics!(Owned<M>, |_, _, _, _, _| false);
dynamics!(OwnedDifferentiable<M>, jacobian_by_duals);

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
    fn info(&self) -> &'static Info {
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

#[cfg(feature = "std")]
impl<T: Real, M: Model<T>> Dynamics<T> for Batched<M> {
    stepping!();

    fn jacobian(&self, _: T, _: &[T], _: &mut [T], _: &mut [T]) -> bool {
        false
    }

    fn curves(&self, t: T, y: &[T], out: &mut [T]) {
        if const { !M::INFO.curves.is_empty() } {
            T::dispatch(Curves {
                model: self.model(),
                of: PhantomData,
                t: &t,
                y,
                out,
            });
        }
    }

    fn smallest_pivot(&self, _: T, _: &[T]) -> Option<(usize, T)> {
        None
    }

    accounts!();
}

#[cfg(feature = "std")]
impl<T: Real, M: Model<T>> Adjustable<T> for Batched<M> {
    fn set_parameters(&mut self, values: &[T]) {
        set_parameters(&mut self.0, values);
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
