//! The part of `bryant_runtime` that equations need, as a crate of its own: scalars, curves, force laws, and what a model is.
//!
//! No integrator and no time loop: what is compiled on demand contains none, and this compiles in a quarter of the time. It is the root of
//! a crate that is called `bryant_runtime` too, and no module of the crate itself.

pub mod apart;
pub mod curve;
pub mod dynamics;
pub mod force;
pub mod model;
pub mod real;
mod version;

pub use curve::{Curve, Extrapolate};
pub use dynamics::{
    Adjustable, Compiled, Differentiable, Direct, Dynamics, Family, Owned,
};
pub use model::{
    Behind, Beyond, Change, CurveInfo, CurveKind, Info, Model, OutputInfo, ParameterInfo, ParameterSet, Sink,
    StateKind, Vector, part,
};
pub use real::{DoubleDouble, Dual, Fast, Mask, Real, Several, Task, Width};
pub use version::{GENERATED_CODE_VERSION, check_generated_code_version};
