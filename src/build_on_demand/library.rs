//! A library that was compiled on demand and loaded into this process. Only this file calls functions by their
//! addresses in it.
//!
//! [`exports`](super::exports) writes the exports of a library; `bryant_runtime::ffi` has the caller's and the callee's
//! side of each call. A library stays loaded until the process ends, because anything may still call its functions.
#![expect(
    unsafe_code,
    reason = "what is loaded is called by its address; the compiler does not see that it fits"
)]

use bryant_runtime::ffi::{
    Call, DONE, Discard, Evaluate, Make, NOTHING, PANICKED, VERSION, What, number_of,
};
use bryant_runtime::real::Form;
use std::ffi::c_void;
use std::path::Path;

/// Names of the exports of a library.
pub mod names {
    /// `extern "C" fn() -> u32`: starts to record panics, and returns [`VERSION`](super::VERSION)
    pub const START: &str = "bryant_start";
    /// `extern "C" fn(function: u32, base: u32, order: u32) -> Option<Call>`: finds a user function
    pub const FUNCTION: &str = "bryant_function";
    /// `unsafe extern "C" fn(place: *mut u8, length: usize) -> usize`: writes the last panic
    pub const SAID: &str = "bryant_said";
    /// [`Make`](super::Make)
    pub const MAKE: &str = "bryant_make";
    /// [`Discard`](super::Discard)
    pub const DISCARD: &str = "bryant_discard";
    /// [`Evaluate`](super::Evaluate)
    pub const EVALUATE: &str = "bryant_evaluate";
}

type Start = extern "C" fn() -> u32;
type Find = extern "C" fn(function: u32, base: u32, order: u32) -> Option<Call>;
type Said = unsafe extern "C" fn(place: *mut u8, length: usize) -> usize;

/// Why a library cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The system cannot load the library, or the library lacks an export.
    #[error("{0}")]
    System(#[from] libloading::Error),
    /// Another version of the program wrote the library.
    #[error("it was written by another version of this program")]
    Version,
}

/// The message and the place of a panic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Panic {
    /// The source file; empty if it is not known.
    pub file: String,
    /// The line, counted from 1.
    pub line: usize,
    /// The column, counted from 1.
    pub column: usize,
    /// The message.
    pub message: String,
}

/// A loaded library.
#[derive(Debug)]
struct Loaded {
    library: &'static libloading::Library,
    said: Said,
}

impl Loaded {
    fn open(path: &Path) -> Result<Self, LoadError> {
        // SAFETY: this program wrote the text of the library around the user's functions, and the library does nothing
        // while it is loaded. `Cache` has compared it with its checksum, and only this user and root may write there.
        let library = unsafe { libloading::Library::new(path)? };
        let library: &'static _ = Box::leak(Box::new(library));
        // SAFETY: libraries that this program wrote export these names with these types; the version excludes other
        // libraries.
        let start = unsafe { *library.get::<Start>(names::START)? };
        if start() != VERSION {
            return Err(LoadError::Version);
        }
        // SAFETY: as above.
        let said = unsafe { *library.get::<Said>(names::SAID)? };
        Ok(Self { library, said })
    }

    /// The last panic on this thread.
    fn panic(&self) -> Panic {
        let mut text = vec![0; 4096];
        // SAFETY: the buffer has room for as many bytes as its length says.
        let length = unsafe { (self.said)(text.as_mut_ptr(), text.len()) };
        text.truncate(length);
        let text = String::from_utf8_lossy(&text);
        let mut parts = text.splitn(4, '\n');
        let mut part = || parts.next().unwrap_or_default();
        let number = |text: &str| text.parse().unwrap_or(0);
        Panic {
            file: part().to_owned(),
            line: number(part()),
            column: number(part()),
            message: part().to_owned(),
        }
    }
}

/// A library of user functions.
#[derive(Debug)]
pub struct Functions {
    loaded: Loaded,
    find: Find,
}

/// A user function, compiled over one scalar.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    call: Call,
    /// Number of words of the arguments and of the results of one lane.
    words: [usize; 2],
}

impl Functions {
    /// Loads a library of user functions.
    pub fn open(path: &Path) -> Result<Self, LoadError> {
        let loaded = Loaded::open(path)?;
        // SAFETY: as in `Loaded::open`.
        let find = unsafe { *loaded.library.get::<Find>(names::FUNCTION)? };
        Ok(Self { loaded, find })
    }

    /// A user function over a scalar, by its index; it must have these numbers of arguments and results. `None` if the
    /// library does not have it, or the processor cannot run it.
    pub fn function(
        &self,
        index: usize,
        (arguments, results): (usize, usize),
        form: Form,
    ) -> Option<Function> {
        let (base, order) = number_of(form);
        Some(Function {
            call: (self.find)(index.try_into().ok()?, base, order)?,
            words: [arguments, results].map(|length| length * form.words()),
        })
    }

    /// Calls a function of this library with the words of one lane; an error if the function panics. Does nothing if
    /// the numbers of words are not those of the function.
    #[inline]
    pub fn call(
        &self,
        function: Function,
        arguments: &[f64],
        results: &mut [f64],
    ) -> Result<(), Panic> {
        let fits = [arguments.len(), results.len()] == function.words;
        debug_assert!(fits);
        if !fits {
            return Ok(());
        }
        // SAFETY: the slices have as many words as the function takes and returns.
        match unsafe { (function.call)(arguments.as_ptr(), results.as_mut_ptr()) } {
            PANICKED => Err(self.loaded.panic()),
            _ => Ok(()),
        }
    }
}

/// A library of a generated model.
#[derive(Debug)]
pub struct Compiled {
    loaded: Loaded,
    make: Make,
    discard: Discard,
    evaluate: Evaluate,
}

impl Compiled {
    /// Loads a library of a generated model.
    pub fn open(path: &Path) -> Result<Self, LoadError> {
        let loaded = Loaded::open(path)?;
        // SAFETY: as in `Loaded::open`.
        unsafe {
            Ok(Self {
                make: *loaded.library.get::<Make>(names::MAKE)?,
                discard: *loaded.library.get::<Discard>(names::DISCARD)?,
                evaluate: *loaded.library.get::<Evaluate>(names::EVALUATE)?,
                loaded,
            })
        }
    }

    /// A model at the default values of its parameters.
    pub fn model(&self) -> CompiledModel<'_> {
        CompiledModel {
            of: self,
            model: (self.make)(),
        }
    }
}

/// A generated model with one set of parameters.
#[derive(Debug)]
pub struct CompiledModel<'a> {
    of: &'a Compiled,
    model: *mut c_void,
}

// SAFETY: a model consists of numbers, and has no reference to any thread.
unsafe impl Send for CompiledModel<'_> {}

impl CompiledModel<'_> {
    /// Evaluates one method; false if the model does not have it. Slices must have the lengths of the model.
    pub fn evaluate(
        &self,
        what: What,
        t: f64,
        y: &[f64],
        results: &mut [f64],
    ) -> Result<bool, Panic> {
        debug_assert!(what != What::SetParameters);
        self.status(what, t, y, results)
    }

    /// Sets the values of all parameters.
    pub fn set_parameters(&mut self, values: &[f64]) -> Result<bool, Panic> {
        self.status(What::SetParameters, 0.0, values, &mut [])
    }

    fn status(&self, what: What, t: f64, y: &[f64], results: &mut [f64]) -> Result<bool, Panic> {
        let (evaluate, what) = (self.of.evaluate, what.number());
        // SAFETY: this library made the model; only `set_parameters` changes it, and nobody else uses it meanwhile. The
        // slices have the given lengths, and the generated functions check that these suffice.
        let status = unsafe {
            evaluate(
                self.model,
                what,
                t,
                y.as_ptr(),
                y.len(),
                results.as_mut_ptr(),
                results.len(),
            )
        };
        match status {
            DONE => Ok(true),
            NOTHING => Ok(false),
            _ => Err(self.of.loaded.panic()),
        }
    }
}

impl Drop for CompiledModel<'_> {
    fn drop(&mut self) {
        // SAFETY: this library made the model, and nobody uses it any more.
        unsafe { (self.of.discard)(self.model) };
    }
}
