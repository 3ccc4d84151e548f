//! Calls into a library that is compiled separately and loaded at run time. Both sides of a call exchange plain
//! numbers.
//!
//! | of | given | comes back |
//! |---|---|---|
//! | functions of the user ([`Adapter`], [`function`]) | arguments as [words](crate::real::Form) | results as words |
//! | a generated model ([`evaluate`]) | what to do ([`What`]), t, y | as many numbers as it takes |
//!
//! The loaded library has its own standard library, perhaps of another compiler. So only numbers and addresses cross
//! the boundary. A panic stays inside: the call returns [`PANICKED`], and [`said`] tells where it was and what it said.
//! Only this file of the library handles addresses.
#![expect(
    unsafe_code,
    reason = "addresses of numbers come from the program that loaded the library"
)]

use crate::dynamics::{Adjustable, Differentiable, Dynamics, Owned};
use crate::real::lanes::{Alone, Emulated, Fused, Instructions, Lanes};
use crate::real::{Base, Form, Task};
use crate::{DoubleDouble, Dual, Fast, Model, ParameterSet, Real, Section};
use core::ffi::c_void;
use core::marker::PhantomData;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Version of the exported functions. It changes whenever a library that was built for an earlier version would not
/// work.
pub const VERSION: u32 = 5;

/// The value that a call returns on success.
pub const DONE: i32 = 0;
/// The value that a call returns where there is no answer, for example for the Jacobian of a model that has none.
pub const NOTHING: i32 = 1;
/// The value that a call returns after a panic: [`said`] tells more, on the same thread.
pub const PANICKED: i32 = 2;

/// A function of the user over one scalar. `arguments` and `results` are words: the number of arguments or results
/// times [`Form::words`].
pub type Call = unsafe extern "C" fn(arguments: *const f64, results: *mut f64) -> i32;

/// A function of the user over any scalar.
pub trait Adapter<const ARGUMENTS: usize, const RESULTS: usize> {
    /// Calls the function.
    fn call<T: Real>(arguments: [T; ARGUMENTS]) -> [T; RESULTS];
}

/// A function of the user over the scalar with the number `base`, with slopes where `order` is 1. `None` where there is
/// no such scalar or order.
pub fn function<F: Adapter<A, R>, const A: usize, const R: usize>(
    base: u32,
    order: u32,
) -> Option<Call> {
    fn over<F: Adapter<A, R>, T: Real, const A: usize, const R: usize>(order: u32) -> Option<Call> {
        match order {
            0 => Some(call::<F, T, A, R>),
            1 => Some(call::<F, Dual<T>, A, R>),
            _ => None,
        }
    }
    let fuses = <Alone<f64, Fused> as Instructions>::is_available();
    match *Base::ALL.get(base as usize)? {
        Base::Double => over::<F, f64, A, R>(order),
        Base::Single => over::<F, f32, A, R>(order),
        Base::Fast => over::<F, Fast, A, R>(order),
        Base::DoubleDouble => over::<F, DoubleDouble, A, R>(order),
        // the scalar of fused registers may only be made where the processor has the instructions
        Base::Lane if fuses => over::<F, Lanes<Alone<f64, Fused>>, A, R>(order),
        Base::Lane => over::<F, Lanes<Alone<f64, Emulated>>, A, R>(order),
        Base::SingleLane if fuses => over::<F, Lanes<Alone<f32, Fused>>, A, R>(order),
        Base::SingleLane => over::<F, Lanes<Alone<f32, Emulated>>, A, R>(order),
    }
}

struct Evaluation<'a, F, T, const A: usize, const R: usize> {
    arguments: &'a [f64],
    results: &'a mut [f64],
    of: PhantomData<(F, T)>,
}

impl<F: Adapter<A, R>, T: Real, const A: usize, const R: usize> Task
    for Evaluation<'_, F, T, A, R>
{
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let words = words::<T>();
        let mut arguments = [T::from_f64(0.0); A];
        for (argument, from) in arguments.iter_mut().zip(self.arguments.chunks_exact(words)) {
            *argument = T::of_words(words, from);
        }
        let results = F::call(arguments);
        for (result, to) in results.iter().zip(self.results.chunks_exact_mut(words)) {
            result.put(words, to);
        }
    }
}

/// Number of words of a scalar of one lane.
const fn words<T: Real>() -> usize {
    match T::FORM {
        Some(form) => form.words(),
        None => 1,
    }
}

unsafe extern "C" fn call<F: Adapter<A, R>, T: Real, const A: usize, const R: usize>(
    arguments: *const f64,
    results: *mut f64,
) -> i32 {
    let words = words::<T>();
    // SAFETY: the caller passes as many words as the function has arguments and results, and nobody else uses them
    // during the call.
    let (arguments, results) = unsafe {
        (
            core::slice::from_raw_parts(arguments, A * words),
            core::slice::from_raw_parts_mut(results, R * words),
        )
    };
    caught(|| {
        T::dispatch(Evaluation::<F, T, A, R> {
            arguments,
            results,
            of: PhantomData,
        });
        DONE
    })
}

/// The methods of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// [`Adjustable::set_parameters`]: y has the values.
    SetParameters,
    /// [`Dynamics::parameter`]: t is the index.
    Parameter,
    /// [`Dynamics::initial_state`].
    InitialState,
    /// [`Dynamics::derivative`].
    Derivative,
    /// [`Dynamics::coordinate_rates`].
    CoordinateRates,
    /// [`Dynamics::jacobian`]: ∂ẏ/∂y by rows, then ∂ẏ/∂t.
    Jacobian,
    /// [`Dynamics::normalize`] of the state that stands in the results.
    Normalize,
    /// [`Dynamics::smallest_pivot`]: first the index, then the pivot.
    SmallestPivot,
    /// [`Dynamics::violated`]: the index.
    Violated,
    /// [`Dynamics::kink_after`].
    KinkAfter,
    /// [`Dynamics::section`].
    Section(Section),
}

impl What {
    /// Those with a number of their own; the sections follow them.
    const FIRST: [What; 10] = [
        What::SetParameters,
        What::Parameter,
        What::InitialState,
        What::Derivative,
        What::CoordinateRates,
        What::Jacobian,
        What::Normalize,
        What::SmallestPivot,
        What::Violated,
        What::KinkAfter,
    ];

    /// The number that it has across the boundary.
    pub fn number(self) -> u32 {
        let number = match self {
            What::Section(section) => What::FIRST.len() + section as usize,
            _ => What::FIRST
                .iter()
                .position(|what| *what == self)
                .unwrap_or_else(|| unreachable!("all others are among the first")),
        };
        number as u32
    }

    /// What has this number.
    fn numbered(number: u32) -> Option<Self> {
        let number = number as usize;
        let section = || Section::ALL.get(number - What::FIRST.len());
        match What::FIRST.get(number) {
            Some(what) => Some(*what),
            None => section().copied().map(What::Section),
        }
    }
}

/// A way to get the Jacobian of a model. Dual numbers need a second compilation of the equations, which takes longer
/// than the first.
pub trait Differentiate {
    /// [`Dynamics::jacobian`].
    fn jacobian<M: Model<f64>>(
        model: &M,
        t: f64,
        y: &[f64],
        by_state: &mut [f64],
        by_time: &mut [f64],
    ) -> bool;
}

/// The Jacobian by dual numbers.
#[derive(Clone, Copy, Debug)]
pub struct ByDuals;

/// No Jacobian.
#[derive(Clone, Copy, Debug)]
pub struct NoJacobian;

impl Differentiate for ByDuals {
    fn jacobian<M: Model<f64>>(
        model: &M,
        t: f64,
        y: &[f64],
        by_state: &mut [f64],
        by_time: &mut [f64],
    ) -> bool {
        Differentiable(model).jacobian(t, y, by_state, by_time)
    }
}

impl Differentiate for NoJacobian {
    fn jacobian<M: Model<f64>>(_: &M, _: f64, _: &[f64], _: &mut [f64], _: &mut [f64]) -> bool {
        false
    }
}

/// A function that makes a model with the default values of its parameters and hands it over.
pub type Make = extern "C" fn() -> *mut c_void;
/// A function that takes a model back and frees it.
pub type Discard = unsafe extern "C" fn(model: *mut c_void);
/// A function that calls one method of a model.
pub type Evaluate = unsafe extern "C" fn(
    model: *mut c_void,
    what: u32,
    t: f64,
    y: *const f64,
    y_length: usize,
    results: *mut f64,
    results_length: usize,
) -> i32;

/// [`Make`] of a generated model.
pub fn make<M: Model<f64>>() -> *mut c_void {
    let parameters = <M::Parameters as ParameterSet<f64>>::defaults();
    Box::into_raw(Box::new(Owned(M::new(parameters)))).cast()
}

/// [`Discard`] of a generated model.
///
/// # Safety
/// The model comes from [`make`] of the same `M`. Nobody uses it afterwards.
pub unsafe fn discard<M: Model<f64>>(model: *mut c_void) {
    // SAFETY: as above.
    drop(unsafe { Box::from_raw(model.cast::<Owned<M>>()) });
}

/// [`Evaluate`] of a generated model.
///
/// # Safety
/// The model comes from [`make`] of the same `M`. During the call nobody else changes it; while parameters are set,
/// nobody else uses it. `y` and `results` have as many numbers as their lengths say.
pub unsafe fn evaluate<M: Model<f64>, J: Differentiate>(
    model: *mut c_void,
    what: u32,
    t: f64,
    y: *const f64,
    y_length: usize,
    results: *mut f64,
    results_length: usize,
) -> i32 {
    // SAFETY: as above.
    let (y, results) = unsafe {
        (
            core::slice::from_raw_parts(y, y_length),
            core::slice::from_raw_parts_mut(results, results_length),
        )
    };
    let Some(what) = What::numbered(what) else {
        return NOTHING;
    };
    caught(|| {
        if what == What::SetParameters {
            // SAFETY: as above; nobody else uses it.
            unsafe { &mut *model.cast::<Owned<M>>() }.set_parameters(y);
            return DONE;
        }
        // SAFETY: as above; nobody changes it.
        let model = unsafe { &*model.cast::<Owned<M>>() };
        of_model::<M, J>(model, what, t, y, results)
    })
}

fn of_model<M: Model<f64>, J: Differentiate>(
    model: &Owned<M>,
    what: What,
    t: f64,
    y: &[f64],
    results: &mut [f64],
) -> i32 {
    match what {
        What::SetParameters => return NOTHING,
        What::Parameter => match model.parameter(t as usize) {
            Some(value) => results[0] = value,
            None => return NOTHING,
        },
        What::InitialState => model.initial_state(results),
        What::Derivative => model.derivative(t, y, results),
        What::CoordinateRates => model.coordinate_rates(y, results),
        What::Jacobian => {
            let (by_state, by_time) = results.split_at_mut(y.len() * y.len());
            if !J::jacobian(&model.0, t, y, by_state, by_time) {
                return NOTHING;
            }
        }
        What::Normalize => model.normalize(results),
        What::SmallestPivot => match model.smallest_pivot(t, y) {
            Some((index, pivot)) => results.copy_from_slice(&[index as f64, pivot]),
            None => return NOTHING,
        },
        What::Violated => match Dynamics::violated(model) {
            Some(index) => results[0] = index as f64,
            None => return NOTHING,
        },
        What::KinkAfter => results[0] = model.kink_after(t),
        What::Section(section) => model.section(section, t, y, results),
    }
    DONE
}

thread_local! {
    /// The last panic on this thread: file, line and column, each on a line of its own, then the message.
    static SAID: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Keeps the messages of panics instead of printing them. It holds for the whole of this library; call it once, when
/// the library is loaded.
pub fn keep_what_panics_say() {
    std::panic::set_hook(Box::new(|panic| {
        let at = panic.location();
        let (file, line, column) = at.map_or(("", 0, 0), |at| (at.file(), at.line(), at.column()));
        let payload = panic.payload();
        let text = payload.downcast_ref::<&str>().copied();
        let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
        let message = text.unwrap_or("it does not say why");
        let _ = SAID.try_with(|said| {
            if let Ok(mut said) = said.try_borrow_mut() {
                *said = format!("{file}\n{line}\n{column}\n{message}");
            }
        });
    }));
}

/// Copies what the last panic on this thread said, as far as there is room: file, line and column, each on a line of
/// its own, then the message. Returns the whole length.
///
/// # Safety
/// `place` has as many bytes as `length` says.
pub unsafe fn said(place: *mut u8, length: usize) -> usize {
    // SAFETY: as above.
    let place = unsafe { core::slice::from_raw_parts_mut(place, length) };
    let copied = SAID.try_with(|said| {
        let Ok(said) = said.try_borrow() else {
            return 0;
        };
        for (to, from) in place.iter_mut().zip(said.bytes()) {
            *to = from;
        }
        said.len()
    });
    copied.unwrap_or(0)
}

/// Runs the task, and returns [`PANICKED`] where it panics.
fn caught(task: impl FnOnce() -> i32) -> i32 {
    match catch_unwind(AssertUnwindSafe(task)) {
        Ok(status) => status,
        Err(payload) => {
            // a panic's payload may be of a user type that panics again when it is dropped
            core::mem::forget(payload);
            PANICKED
        }
    }
}

/// The number that a form has across the boundary: base and order.
pub const fn number_of(form: Form) -> (u32, u32) {
    (form.base as u32, form.order)
}
