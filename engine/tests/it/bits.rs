//! The bits of engines: every method of every bundled model over every scalar, compared with the generated Rust.
//!
//! | file | over |
//! |---|---|
//! | `doubles` | doubles, with the Jacobian |
//! | `singles` | singles |
//! | `fast` | doubles with a fast sine |
//! | `double_doubles` | double-doubles |
//! | `duals` | dual numbers |
//! | `lanes` | lanes of every width |
//! | `scenes` | scenes of real size, which have no generated Rust: machine code and interpreter |

#[macro_use]
mod common;

mod double_doubles;
mod doubles;
mod duals;
mod fast;
mod lanes;
mod scenes;
mod singles;
