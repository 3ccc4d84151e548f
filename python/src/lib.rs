//! `bryant._bryant`: the compiled part of the Python package. It takes and returns arrays, names and texts; the package
//! around it says what users see.
//!
//! | file | what |
//! |---|---|
//! | `arrays` | arrays of numpy as slices, and back |
//! | `model` | a model at many states |
//! | `simulation` | a run that is driven from outside |
//! | `command` | commands of the program, in this process |

mod arrays;
mod command;
mod model;
mod simulation;

use pyo3::prelude::*;

pyo3::create_exception!(
    bryant,
    Error,
    pyo3::exceptions::PyException,
    "What is wrong, where, and what to do: the text that the command prints."
);

/// An error of the program as one of Python.
fn wrong(error: impl std::fmt::Display) -> PyErr {
    Error::new_err(error.to_string())
}

#[pymodule]
fn _bryant(module: &Bound<'_, PyModule>) -> PyResult<()> {
    bryant::interrupt::is_handled();
    module.add("Error", module.py().get_type::<Error>())?;
    module.add("VERSION", bryant::VERSION)?;
    module.add_class::<model::Model>()?;
    module.add_class::<simulation::Simulation>()?;
    module.add_function(wrap_pyfunction!(command::command, module)?)?;
    Ok(())
}
