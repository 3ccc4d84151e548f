//! Calls machine code, and lets machine code call functions. All `unsafe` code for machine code is here and in
//! `memory`.
//!
//! Only [`assemble`] makes the code that is run here. The code reads and writes only slots of the regions that it is
//! given, and says how many slots it needs of each. Tests run the code for x86-64 on an emulated processor that checks
//! every access.

#![expect(
    unsafe_code,
    reason = "machine code is run, and functions are handed to it by address"
)]

use super::memory::Executable;
use super::processor::{Target, assemble};
use crate::call;
use crate::execute::Given;
use bryant_generator::expression::Function;
use bryant_generator::program::{Curve, List};
use bryant_generator::target::machine::{Base, Callee, Code};
use bryant_runtime::Real;
use std::cell::RefCell;
use std::ffi::c_void;
use std::marker::PhantomData;

/// A function, or its type, with the calling convention of machine code.
#[cfg(target_arch = "x86_64")]
macro_rules! convention {
    ($($function:tt)*) => { extern "sysv64" $($function)* };
}
#[cfg(not(target_arch = "x86_64"))]
macro_rules! convention {
    ($($function:tt)*) => { extern "C" $($function)* };
}

/// A function that machine code calls.
pub trait Call<T> {
    /// Writes the results. Both slices are as long as the function requires.
    fn call(&self, arguments: &[T], results: &mut [T]);
}

/// The pointers that are passed to machine code, in the order of [`Base`].
#[repr(C)]
struct Pointers<T> {
    time: *const T,
    state: *const T,
    parameters: *const T,
    derived: *const T,
    results: *mut T,
    frame: *mut T,
    functions: *const Entry,
}

/// A function in the form in which machine code calls it.
#[repr(C)]
struct Entry {
    function: *const c_void,
    context: *const c_void,
}

/// A function with the numbers of its arguments and results.
#[derive(Debug)]
struct Called<C> {
    function: C,
    arguments: usize,
    results: usize,
}

/// A list as machine code over a scalar that consists of numbers side by side. `C` is the type of the functions that
/// the code calls.
pub struct Compiled<T, C> {
    memory: Executable,
    /// The number of slots of each region.
    slots: [u32; Base::ALL.len()],
    entries: Vec<Entry>,
    /// The functions that the entries point to.
    _called: Vec<Box<Called<C>>>,
    of: PhantomData<fn(T)>,
}

// SAFETY: the memory is never written again. The entries point to functions, which are code, and to `_called`, which
// moves with them.
unsafe impl<T, C: Send> Send for Compiled<T, C> {}
// SAFETY: as above. Evaluations of several threads share nothing that is written: each has a frame of its own.
unsafe impl<T, C: Sync> Sync for Compiled<T, C> {}

impl<T: Real, C: Call<T>> Compiled<T, C> {
    /// Compiles a list of a model with these curves. `function` gives the functions that the list calls, except sine,
    /// cosine and `atan2`, which are those of the scalar. `None` if the system does not allow executable memory.
    ///
    /// # Panics
    /// If `target` is not the [`target`](super::target) of the scalar.
    pub(crate) fn new(
        list: &List,
        curves: &[Curve],
        target: &Target,
        mut function: impl FnMut(Function) -> C,
    ) -> Option<Self> {
        assert_eq!(super::target::<T>().as_ref(), Some(target));
        let Code {
            bytes,
            callees,
            slots,
        } = assemble(list, curves, target);
        let mut called = Vec::new();
        let mut entries = Vec::with_capacity(callees.len());
        for callee in callees {
            entries.push(match callee {
                Callee::SinCos => direct(sin_cos::<T>),
                Callee::Atan2 => direct(atan2::<T>),
                Callee::Function(name) => {
                    let context = Box::new(Called {
                        function: function(name),
                        arguments: callee.arguments(),
                        results: callee.results(),
                    });
                    let entry = Entry {
                        context: (&raw const *context).cast(),
                        ..direct(any::<T, C>)
                    };
                    called.push(context);
                    entry
                }
            });
        }
        Some(Compiled {
            memory: Executable::new(&bytes)?,
            slots,
            entries,
            _called: called,
            of: PhantomData,
        })
    }

    /// Length of the code in bytes, with its constants.
    pub fn bytes(&self) -> usize {
        self.memory.len()
    }

    /// Evaluates the list. Values are kept in `room`, which is made as long as it has to be and may serve many lists.
    ///
    /// # Panics
    /// If a slice is too short.
    #[inline]
    pub fn run(
        &self,
        given: Given<T>,
        (parameters, derived): (&[T], &[T]),
        room: &RefCell<Vec<T>>,
        results: &mut [T],
    ) {
        let slots = |base: Base| self.slots[base as usize] as usize;
        let enough = given.state.len() >= slots(Base::State)
            && parameters.len() >= slots(Base::Parameters)
            && derived.len() >= slots(Base::Derived)
            && results.len() >= slots(Base::Results);
        assert!(enough, "a slice is shorter than the list needs");
        // a called function may evaluate the list again, with another frame
        let mut frame = room.take();
        if frame.len() < slots(Base::Frame) {
            frame.resize(slots(Base::Frame), T::from_f64(0.0));
        }
        let pointers = Pointers {
            time: &raw const given.time,
            state: given.state.as_ptr(),
            parameters: parameters.as_ptr(),
            derived: derived.as_ptr(),
            results: results.as_mut_ptr(),
            frame: frame.as_mut_ptr(),
            functions: self.entries.as_ptr(),
        };
        // SAFETY: the code was assembled for the layout of T and has this signature. The processor has the instructions
        // of the code, because `target` has checked it. The code reads and writes only the slots that it declares, and
        // these exist, because the lengths are checked above. Nothing else uses results and frame meanwhile. Every bit
        // pattern of numbers is a T.
        unsafe {
            let function: convention!(fn(*const Pointers<T>)) =
                std::mem::transmute(self.memory.as_ptr());
            function(&raw const pointers);
        }
        room.replace(frame);
    }
}

impl<T, C> std::fmt::Debug for Compiled<T, C> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let bytes = self.memory.len();
        f.debug_struct("Compiled")
            .field("bytes", &bytes)
            .finish_non_exhaustive()
    }
}

/// The entry of a function that needs no context.
fn direct<T>(function: convention!(fn(*const c_void, *const T, *mut T))) -> Entry {
    Entry {
        function: function as *const c_void,
        context: std::ptr::null(),
    }
}

// Machine code calls the following three functions. A panic cannot unwind through machine code: `extern` functions end
// the process instead.

convention! {
    fn sin_cos<T: Real>(_: *const c_void, arguments: *const T, results: *mut T) {
        // SAFETY: code passes one argument and room for two results.
        unsafe {
            let (sine, cosine) = call::sin_cos(*arguments);
            *results = sine;
            *results.add(1) = cosine;
        }
    }
}

convention! {
    fn atan2<T: Real>(_: *const c_void, arguments: *const T, results: *mut T) {
        // SAFETY: code passes two arguments and room for one result.
        unsafe { *results = T::dispatch(call::Atan2(*arguments, *arguments.add(1))) };
    }
}

convention! {
    fn any<T: Real, C: Call<T>>(context: *const c_void, arguments: *const T, results: *mut T) {
        // SAFETY: the context is the `Called` of the same entry, and lives as long as the code. The code passes as many
        // arguments as the function has, and room for its results, which do not overlap. All of them are initialised,
        // because the frame and all slices are.
        unsafe {
            let called = &*context.cast::<Called<C>>();
            let arguments = std::slice::from_raw_parts(arguments, called.arguments);
            let results = std::slice::from_raw_parts_mut(results, called.results);
            called.function.call(arguments, results);
        }
    }
}
