//! The functions of FMI 2.0 and 3.0, for co-simulation: the shared library that every FMU of `bryant export fmu`
//! carries.
//!
//! | module | what |
//! |---|---|
//! | `handle` | what both versions share: instances behind pointers, messages |
//! | `fmi2`, `fmi3` | the functions of the standard |
//!
//! Source: Functional Mock-up Interface, versions 2.0.5 and 3.0.2, <https://fmi-standard.org>.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod fmi2;
mod fmi3;
mod handle;
