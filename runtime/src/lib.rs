//! The library that equations written by `bryant-generator` link against: scalars, curves, force laws, integrators,
//! simulation.
//!
//! ## Where to begin
//!
//! A build script calls `bryant_generator::Config`, which writes a module for each model. Your crate includes it by
//! [`include_model!`]. You implement nothing: the module has a struct `Mechanism`, generic over the scalar ([`Real`]),
//! which implements [`Model`]. The examples below use the double pendulum of `examples/own-crate`, whose crate has
//!
//! ```ignore
//! mod arm {
//!     bryant_runtime::include_model!("double-pendulum");
//! }
//! ```
//!
//! **Accelerations**, for a controller or an integrator of your own. Entries of arrays have names; the units are in
//! `INFO`.
//!
//! ```
//! # mod arm { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/doc/double-pendulum.rs")); }
//! use arm::{INFO, Mechanism, Parameters, coordinates, outputs, velocities};
//!
//! let model = Mechanism::<f64>::new(Parameters { brake: 0.01 });
//! let (mut q, v) = model.initial_conditions();
//! q[coordinates::LOWER_PHI] = 0.3;
//! let acceleration = model.accelerations(0.0, &q, &v)[velocities::LOWER_OMEGA];
//! let height = model.outputs_at(0.0, &q, &v)[outputs::TIP_Z];
//! assert!(acceleration.is_finite() && height < 1.0);
//! assert_eq!(INFO.state_unit(coordinates::LOWER_PHI), Some("rad"));
//! ```
//!
//! **S, r_s, r_k** are nalgebra's matrices (feature `nalgebra`):
//!
//! ```
//! # mod arm { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/doc/double-pendulum.rs")); }
//! let model = arm::Mechanism::<f64>::new(arm::Parameters { brake: 0.01 });
//! let (q, v) = model.initial_conditions();
//! let force = model.velocity_forces(&q, &v) + model.applied_forces(0.0, &q, &v);
//! let acceleration = model.mass_matrix(&q).cholesky().expect("positive definite").solve(&force);
//! let expected = model.accelerations(0.0, &q, &v);
//! assert!((0..2).all(|i| (acceleration[i] - expected[i]).abs() < 1e-9));
//! ```
//!
//! **A run** with error control, sampled as the model says: [`simulate()`], or [`simulate::Run`] to advance from time
//! to time as you ask.
//!
//! ```
//! # mod arm { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/doc/double-pendulum.rs")); }
//! use bryant_runtime::{Failure, Settings, simulate};
//!
//! # fn main() -> Result<(), Failure<'static>> {
//! let model = arm::Mechanism::<f64>::new(arm::Parameters { brake: 0.01 });
//! let mut highest = f64::NEG_INFINITY;
//! simulate(&model, &Settings::of(&arm::INFO), &mut |sample| {
//!     highest = highest.max(sample.outputs[arm::outputs::TIP_Z]);
//! })?;
//! assert!(highest < 0.7);
//! # Ok(())
//! # }
//! ```
//!
//! **A loop of your own**, in steps of one length: [`integrate::march`]. It works on the whole state y: q, v and, where
//! force laws have them, their continuous states z and discrete states m. So do the methods of [`Model`].
//!
//! ```
//! # mod arm { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/doc/double-pendulum.rs")); }
//! use bryant_runtime::Model;
//! use bryant_runtime::integrate::march;
//!
//! let model = arm::Mechanism::<f64>::new(arm::Parameters { brake: 0.01 });
//! let mut y = model.initial_state();
//! let mut t = 0.0;
//! for _ in 0..10 {
//!     t = march(&model, t, 1e-3, 100, &mut y); // 100 steps of 1 ms, then look
//!     let mut outputs = [0.0; arm::OUTPUTS];
//!     model.outputs(t, &y, &mut outputs);
//!     assert!(outputs[arm::outputs::TIP_X].abs() < 1.0);
//! }
//! assert!((t - 1.0).abs() < 1e-9);
//! ```
//!
//! **Lanes**: several scenarios at once, one in each lane of a register. You write a task for any width
//! ([`real::lanes::OfAnyWidth`]), and it runs with the widest registers that the processor has.
//!
//! ```
//! # mod arm { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/doc/double-pendulum.rs")); }
//! use bryant_runtime::integrate::march;
//! use bryant_runtime::real::lanes::{OfAnyWidth, with_width};
//! use bryant_runtime::{Model, Several, Width};
//!
//! /// The angle after 0.1 s, for brakes 0, 0.01, 0.02 …
//! struct Brakes;
//!
//! impl OfAnyWidth for Brakes {
//!     type Output = Vec<f64>;
//!     fn run<T: Several<One = f64>>(self) -> Vec<f64> {
//!         let mut brake = T::from_f64(0.0);
//!         for lane in 0..T::LANES {
//!             brake = brake.with_lane(lane, 0.01 * lane as f64);
//!         }
//!         let model = arm::Mechanism::new(arm::Parameters { brake });
//!         let mut y = model.initial_state();
//!         march(&model, T::from_f64(0.0), T::from_f64(1e-3), 100, &mut y);
//!         (0..T::LANES).map(|lane| y[0].lane(lane)).collect()
//!     }
//! }
//!
//! let angles = with_width(Width::widest(), Brakes).expect("a width that is there");
//! assert!(angles.windows(2).all(|two| two[0] != two[1]));
//! ```
//!
//! Many runs with error control, where each lane has its own steps, are in [`batch`].
//!
//! **Derivatives**: over [`Dual`] numbers every result comes with its slope.
//!
//! ```
//! # mod arm { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/doc/double-pendulum.rs")); }
//! use bryant_runtime::Dual;
//!
//! let brake = Dual { value: 0.01, slope: 1.0 }; // with respect to the brake
//! let model = arm::Mechanism::new(arm::Parameters { brake });
//! let (q, _) = model.initial_conditions();
//! let v = [2.0, 0.0].map(Dual::constant);
//! let slope = model.accelerations(Dual::constant(0.0), &q, &v)[0].slope;
//! assert!(slope < 0.0, "the brake slows the upper arm down");
//! ```
//!
//! **Single precision**: use `f32` in place of `f64`, or [`model::over`] to get the same model over another scalar.
//!
//! ```
//! # mod arm { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/doc/double-pendulum.rs")); }
//! let model = arm::Mechanism::<f32>::new(arm::Parameters { brake: 0.01 });
//! let (q, v) = model.initial_conditions();
//! let [upper, lower] = model.accelerations(0.0_f32, &q, &v);
//! assert!(upper.is_finite() && lower.is_finite());
//! ```
//!
//! **Without the standard library**: `bryant-runtime = { …, default-features = false, features = ["libm", "nalgebra"]
//! }`. The examples above work without change, except those of `simulate()`, lanes and batches; [`simulate::run_in`]
//! runs in memory that you give it. Without `nalgebra`, the build script must call `.matrices(false)`; if it does not,
//! a compiler error says so.
//!
//! ## What is where
//!
//! | module | what |
//! |---|---|
//! | [`real`] | the scalar that everything is generic over, and all scalars other than `f64` and `f32` |
//! | [`curve`] | functions given by points: linear pieces, or cubic ones |
//! | [`force`] | the constitutive laws of friction, contact, belts and switches; the penetration of ellipsoids |
//! | [`model`] | the trait that a generated module implements |
//! | [`dynamics`] | the same as a table of functions over slices, which all other modules here use |
//! | [`integrate`] | one step of a method: its end, its error, the states inside it |
//! | [`response`] | one number for a whole signal: peaks, injury criteria |
//! | [`simulate`](mod@simulate) | a sampled run; [`failure`]: how it can fail |
//! | `batch` (feature `std`) | many runs at once, one in each lane of a register |
//! | `ffi` (feature `std`) | models and functions that are compiled apart and loaded: calls with plain numbers |
//! | `program` (feature `std`) | a run described by a few words and delivered as a stream: the stand-alone program |
//! | `source` (feature `embedded-source`) | the text of this crate, for compiling a scene on demand |
//!
//! Nothing allocates and nothing needs the standard library, except `ffi`, `batch` and `program`; `real::lanes` needs
//! `libm` without it. Without both the crate still builds, but `f64` and `f32` then have no square roots and are no
//! scalars; [`DoubleDouble`] has its own.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]
#![cfg_attr(not(any(feature = "std", test)), no_std)]

#[cfg(feature = "std")]
pub mod batch;
pub mod curve;
pub mod dynamics;
pub mod failure;
#[cfg(feature = "std")]
pub mod ffi;
pub mod force;
pub mod integrate;
mod leap;
pub mod model;
#[cfg(feature = "std")]
mod patience;
pub mod real;
pub mod response;
pub mod section;
pub mod simulate;
mod version;

#[cfg(feature = "std")]
pub mod program;
#[cfg(feature = "embedded-source")]
pub mod source;

pub use curve::{Curve, Extrapolate};
pub use dynamics::{Adjustable, Differentiable, Direct, Dynamics, Owned, Schedule};
#[cfg(feature = "std")]
pub use dynamics::{Compiled, Family};
pub use failure::{Failure, Reason, Refusal};
pub use integrate::Formula;
pub use integrate::control::Tolerances;
pub use model::{
    Change, CurveInfo, CurveKind, Info, Model, OffsetView, OutputInfo, OutputWriter, ParameterInfo,
    ParameterSet, StateKind, TailView, Vector,
};
#[cfg(any(feature = "std", feature = "libm", test))]
pub use real::Fast;
pub use real::{DoubleDouble, Dual, Mask, Real, Task};
#[cfg(feature = "std")]
pub use real::{Layout, Several, Width};
pub use response::{Response, reduce};
pub use section::Section;
#[cfg(feature = "std")]
pub use simulate::simulate;
pub use simulate::{
    Adaptive, Balance, Cause, Diagnostic, ENERGY_LIMIT, Integrator, Pace, Problem, Report, Sample,
    SampleKind, Settings, Watch,
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
        // A macro that includes the model, or lists the models that exist.
        ::core::include!(::core::concat!(
            ::core::env!("OUT_DIR"),
            "/bryant-models.rs"
        ));
        bryant_models!($name);
    };
}

/// The types of S, r_s and r_k in generated modules, which contain `bryant_runtime::use_nalgebra!(SMatrix, SVector);`.
/// Without the feature `nalgebra` this is a compiler error that says what to do.
#[cfg(feature = "nalgebra")]
#[doc(hidden)]
#[macro_export]
macro_rules! use_nalgebra {
    ($($name:ident),*) => {
        use $crate::nalgebra::{$($name),*};
    };
}

/// The error without the feature.
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
