//! Arrays of numpy as slices, and back.

use pyo3::buffer::PyBuffer;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple};

/// An array of doubles, by rows, without gaps. It is kept alive, and not written, while this exists.
pub struct Array {
    buffer: PyBuffer<f64>,
}

impl Array {
    /// An array, or anything that numpy makes one of.
    pub fn of(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(buffer) = PyBuffer::<f64>::get(value)
            && buffer.is_c_contiguous()
        {
            return Ok(Array { buffer });
        }
        let py = value.py();
        let options = PyDict::new(py);
        options.set_item(intern!(py, "dtype"), intern!(py, "float64"))?;
        let made = numpy(py)?.getattr(intern!(py, "ascontiguousarray"))?;
        let made = made.call((value,), Some(&options))?;
        let buffer = PyBuffer::<f64>::get(&made)?;
        Ok(Array { buffer })
    }

    /// The lengths of its dimensions.
    pub fn shape(&self) -> &[usize] {
        self.buffer.shape()
    }

    /// All numbers, row by row.
    pub fn numbers(&self) -> &[f64] {
        match self.buffer.item_count() {
            0 => &[],
            // SAFETY: the buffer has no gaps and that many doubles, and is held. Python code that writes to an array while
            // a function reads it gets numbers that are its own fault, as with numpy; none of them is invalid.
            count => unsafe { std::slice::from_raw_parts(self.buffer.buf_ptr().cast(), count) },
        }
    }

    /// All numbers, to be written.
    pub fn numbers_mut(&mut self) -> PyResult<&mut [f64]> {
        if self.buffer.readonly() {
            return Err(PyValueError::new_err(
                "the array for results cannot be written",
            ));
        }
        match self.buffer.item_count() {
            0 => Ok(&mut []),
            // SAFETY: as above
            count => unsafe {
                Ok(std::slice::from_raw_parts_mut(
                    self.buffer.buf_ptr().cast(),
                    count,
                ))
            },
        }
    }
}

/// An array that is returned, with its numbers.
pub struct Filled<'py> {
    pub array: Bound<'py, PyAny>,
    pub room: Array,
}

impl<'py> Filled<'py> {
    /// The array `out`, or a new one if it is none. `out` must be an array of doubles of this shape, without gaps.
    pub fn new(
        py: Python<'py>,
        out: Option<&Bound<'py, PyAny>>,
        shape: &[usize],
    ) -> PyResult<Self> {
        let array = match out {
            Some(out) => out.clone(),
            None => {
                let empty = numpy(py)?.getattr(intern!(py, "empty"))?;
                empty.call1((PyTuple::new(py, shape)?,))?
            }
        };
        let buffer = PyBuffer::<f64>::get(&array).map_err(|_| {
            PyTypeError::new_err(
                "the array for results must be of doubles (float64), by rows without gaps",
            )
        })?;
        if !buffer.is_c_contiguous() || buffer.shape() != shape {
            return Err(PyValueError::new_err(format!(
                "the array for results must have the shape {shape:?}, by rows without gaps; it has {:?}",
                buffer.shape()
            )));
        }
        Ok(Filled {
            array,
            room: Array { buffer },
        })
    }
}

fn numpy(py: Python<'_>) -> PyResult<&Bound<'_, PyAny>> {
    static NUMPY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let found =
        NUMPY.get_or_try_init(py, || PyResult::Ok(py.import("numpy")?.into_any().unbind()))?;
    Ok(found.bind(py))
}
