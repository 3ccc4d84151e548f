//! What the equations written by `bryant-generator` link against: scalars, curves, force laws, integrators, simulation.
//!
//! | module | what |
//! |---|---|
//! | [`real`] | the scalar everything is generic over, and those that are not `f64` or `f32` |
//! | [`curve`] | functions given by points: linear pieces, or cubic ones |
//! | [`force`] | the constitutive laws of friction, contact, belts and switches; where ellipsoids are nearest |
//! | [`model`] | what a generated module implements |
//! | [`dynamics`] | the same as a table of functions over slices, which everything else in here works with |
//! | [`integrate`] | one step of a method: where it leads, how far it errs, what lies inside it |
//! | [`response`] | one number for a whole signal: peaks, injury criteria |
//! | [`simulate`](mod@simulate) | a run, sampled; [`failure`]: how it can fail |
//! | `batch` (feature `std`) | many runs at once, one in each lane of a register |
//! | `apart` (feature `std`) | what is compiled apart and loaded: calls with plain numbers |
//! | `program` (feature `std`) | a run described by words and delivered as a stream: the stand-alone program |
//! | `source` (feature `embedded-source`) | the text of this crate, for compiling a scene on demand |
//!
//! Nothing allocates and nothing needs the standard library, except `apart`, `batch`, `program` and `real::lanes`. Without `std` and `libm` the crate builds,
//! but `f64` and `f32` lack elementary functions and so are no scalars; [`DoubleDouble`] has its own.
#![cfg_attr(not(any(feature = "std", test)), no_std)]

#[cfg(feature = "std")]
pub mod apart;
#[cfg(feature = "std")]
pub mod batch;
pub mod curve;
pub mod dynamics;
pub mod failure;
pub mod force;
pub mod integrate;
pub mod model;
pub mod real;
pub mod response;
pub mod simulate;
mod version;

#[cfg(feature = "std")]
pub mod program;
#[cfg(feature = "embedded-source")]
pub mod source;

#[cfg(test)]
mod test_models;
#[cfg(test)]
mod test_scalars;

pub use curve::{Curve, Extrapolate};
pub use dynamics::{Adjustable, Arrival, Differentiable, Direct, Dynamics, Owned, Schedule};
#[cfg(feature = "std")]
pub use dynamics::{Compiled, Family};
pub use failure::{Failure, Reason, Refusal};
pub use integrate::Formula;
pub use integrate::control::Tolerances;
pub use model::{
    Behind, Beyond, Change, CurveInfo, Info, Model, OutputInfo, ParameterInfo, ParameterSet, Sink,
    StateKind, Vector, part,
};
#[cfg(any(feature = "std", feature = "libm", test))]
pub use real::Fast;
pub use real::{DoubleDouble, Dual, Mask, Real, Task};
#[cfg(feature = "std")]
pub use real::{Layout, Several, Width};
pub use response::{Response, reduce};
#[cfg(feature = "std")]
pub use simulate::simulate;
pub use simulate::{
    Adaptive, Balance, Cause, Doubt, ENERGY_LIMIT, Method, Pace, Report, Sample, Settings,
    Suspicion, Watch,
};
pub use version::{GENERATED_CODE_VERSION, check_generated_code_version};

#[cfg(feature = "nalgebra")]
pub use nalgebra;

/// Brings in the module that `bryant-generator` wrote to `OUT_DIR` from a build script.
///
/// It expands to items, so give it a module of its own:
///
/// ```ignore
/// mod arm {
///     bryant_runtime::include_model!("arm");
/// }
/// ```
#[macro_export]
macro_rules! include_model {
    ($name:tt) => {
        // A macro with an arm for each model, and an error that lists them for any other name.
        ::core::include!(::core::concat!(
            ::core::env!("OUT_DIR"),
            "/bryant-models.rs"
        ));
        bryant_models!($name);
    };
}

/// The types of S, r_s and r_k in generated modules, which contain `bryant_runtime::use_nalgebra!(SMatrix, SVector);`. Without the
/// feature `nalgebra` it is an error that says what to do.
#[cfg(feature = "nalgebra")]
#[doc(hidden)]
#[macro_export]
macro_rules! use_nalgebra {
    ($($name:ident),*) => {
        use $crate::nalgebra::{$($name),*};
    };
}

/// The error.
#[cfg(not(feature = "nalgebra"))]
#[doc(hidden)]
#[macro_export]
macro_rules! use_nalgebra {
    ($($name:ident),*) => {
        ::core::compile_error!(
            "the methods for S, r_s and r_k need the feature `nalgebra` of bryant-runtime: turn it on in Cargo.toml (it does not need \
             `std`), or leave the methods out by `.matrices(false)` in build.rs"
        );
    };
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_same_version_passes() {
        const { super::check_generated_code_version(super::GENERATED_CODE_VERSION) };
    }

    #[test]
    #[should_panic(expected = "older")]
    fn older_code_is_refused() {
        super::check_generated_code_version(0);
    }

    #[test]
    #[should_panic(expected = "newer")]
    fn newer_code_is_refused() {
        super::check_generated_code_version(u32::MAX);
    }
}
