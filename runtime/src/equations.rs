//! The part of `bryant_runtime` that equations need, as a crate of its own: scalars, curves, force laws, and the trait
//! of models.
//!
//! This crate has no integrator and no time loop. Code that is compiled on demand needs neither, and this part compiles
//! in a quarter of the time. This file is the root of that crate, which is also called `bryant_runtime`; it is no
//! module of the full crate.

pub mod ffi;
pub mod curve;
pub mod dynamics;
pub mod force;
pub mod model;
pub mod real;
pub mod section;
mod version;

pub use curve::{Curve, Extrapolate};
pub use dynamics::{
    Adjustable, Compiled, Differentiable, Direct, Dynamics, Family, Owned,
};
pub use model::{
    OffsetView, TailView, Change, CurveInfo, CurveKind, Info, Model, OutputInfo, ParameterInfo, ParameterSet, OutputWriter,
    StateKind, Vector,
};
pub use real::{DoubleDouble, Dual, Fast, Mask, Real, Several, Task, Width};
pub use section::Section;
pub use version::{GENERATED_CODE_VERSION, check_generated_code_version};
