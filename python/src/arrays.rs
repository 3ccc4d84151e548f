//! Arrays of numpy as slices, and back.

use pyo3::buffer::PyBuffer;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyTuple;
use pyo3::{ffi, intern};
use std::ffi::{c_char, c_int, c_void};
use std::ops::Deref;

/// An array of doubles, by rows, without gaps. It is kept alive, and not written, while this exists.
pub struct Array {
    numbers: *mut f64,
    lengths: *const usize,
    dimensions: usize,
    is_writable: bool,
    _kept: Kept,
}

/// What keeps the numbers where they are.
enum Kept {
    Array { _it: Py<PyAny> },
    Buffer { _it: PyBuffer<f64> },
}

// SAFETY: the pointers are to memory that `_kept` keeps, which may be read and written on any thread.
unsafe impl Send for Array {}
// SAFETY: as above; `&Array` only reads.
unsafe impl Sync for Array {}

impl Array {
    /// An array, or anything that numpy makes one of.
    pub fn of(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Some(array) = Self::direct(value)? {
            return Ok(array);
        }
        if let Ok(buffer) = doubles(value)
            && buffer.is_c_contiguous()
        {
            return Ok(Self::of_buffer(buffer));
        }
        let py = value.py();
        let require = numpy(py)?.require.bind(py);
        // by rows, at an address of doubles
        let made = require.call1((value, intern!(py, "float64"), intern!(py, "CA")))?;
        match Self::direct(&made)? {
            Some(array) => Ok(array),
            None => Ok(Self::of_buffer(doubles(&made)?)),
        }
    }

    fn of_buffer(buffer: PyBuffer<f64>) -> Self {
        Array {
            numbers: buffer.buf_ptr().cast(),
            lengths: buffer.shape().as_ptr(),
            dimensions: buffer.dimensions(),
            is_writable: !buffer.readonly(),
            _kept: Kept::Buffer { _it: buffer },
        }
    }

    /// An array of numpy, without gaps and of doubles, by its fields: the buffers of four arrays would take longer than
    /// the accelerations of a robot. `None` for all others.
    fn direct(value: &Bound<'_, PyAny>) -> PyResult<Option<Self>> {
        let numpy = numpy(value.py())?;
        // SAFETY: an object has a type, and one of this very type has the fields, as `numpy` has seen.
        let fields = unsafe {
            if !numpy.has_fields || ffi::Py_TYPE(value.as_ptr()).cast() != numpy.array.as_ptr() {
                return Ok(None);
            }
            &*value.as_ptr().cast::<Fields>()
        };
        let plain = CONTIGUOUS | ALIGNED;
        if fields.descr != numpy.double.as_ptr() || fields.flags & plain != plain {
            return Ok(None);
        }
        Ok(Some(Array {
            numbers: fields.data.cast(),
            lengths: fields.dimensions.cast(),
            dimensions: usize::try_from(fields.nd).unwrap_or(0),
            is_writable: fields.flags & WRITABLE != 0,
            _kept: Kept::Array {
                _it: value.clone().unbind(),
            },
        }))
    }

    /// The lengths of its dimensions.
    pub fn shape(&self) -> &[usize] {
        match self.dimensions {
            0 => &[],
            // SAFETY: the array, or its buffer, is held, and has as many lengths; none is negative.
            count => unsafe { std::slice::from_raw_parts(self.lengths, count) },
        }
    }

    /// All numbers, row by row.
    pub fn numbers(&self) -> &[f64] {
        match self.shape().iter().product() {
            0 => &[],
            // SAFETY: the array has no gaps and that many doubles, and is held. Python code that writes to an array
            // while a function reads it gets numbers that are its own fault, as with numpy; none of them is invalid.
            count => unsafe { std::slice::from_raw_parts(self.numbers, count) },
        }
    }

    /// Whether some of its numbers are those of another array, too.
    pub fn overlaps(&self, other: &Array) -> bool {
        let range = |of: &Array| {
            let length: usize = of.shape().iter().product();
            (of.numbers.addr(), length * size_of::<f64>())
        };
        let ((a, long), (b, other)) = (range(self), range(other));
        a < b + other && b < a + long
    }

    /// All numbers, to be written.
    pub fn numbers_mut(&mut self) -> PyResult<&mut [f64]> {
        if !self.is_writable {
            return Err(PyValueError::new_err(
                "the array for results cannot be written",
            ));
        }
        match self.shape().iter().product() {
            0 => Ok(&mut []),
            // SAFETY: as above
            count => unsafe { Ok(std::slice::from_raw_parts_mut(self.numbers, count)) },
        }
    }
}

/// A buffer of doubles of this processor. PyO3 also takes those whose bytes are in the other order, and would read them
/// as other numbers.
fn doubles(value: &Bound<'_, PyAny>) -> PyResult<PyBuffer<f64>> {
    let buffer = PyBuffer::<f64>::get(value)?;
    let turned: &[u8] = match cfg!(target_endian = "little") {
        true => b">!",
        false => b"<",
    };
    match buffer.format().to_bytes() {
        [order, ..] if turned.contains(order) => Err(PyTypeError::new_err(
            "the bytes of the doubles are in the order of other processors",
        )),
        _ => Ok(buffer),
    }
}

/// The lengths of the dimensions of an array.
#[derive(Clone, Copy, Default)]
pub struct Shape {
    lengths: [usize; 4],
    dimensions: usize,
}

impl Shape {
    /// This shape, and more dimensions behind its own: four at most in all.
    pub fn and(mut self, more: &[usize]) -> Self {
        let end = self.dimensions + more.len();
        self.lengths[self.dimensions..end].copy_from_slice(more);
        self.dimensions = end;
        self
    }
}

impl Deref for Shape {
    type Target = [usize];
    fn deref(&self) -> &[usize] {
        &self.lengths[..self.dimensions]
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
                let empty = numpy(py)?.empty.bind(py);
                empty.call1((PyTuple::new(py, shape)?,))?
            }
        };
        let is = |room: &Array| room.shape() == shape;
        if let Some(room) = Array::direct(&array)?.filter(is) {
            return Ok(Filled { array, room });
        }
        let buffer = doubles(&array).map_err(|_| {
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
        let room = Array::of_buffer(buffer);
        Ok(Filled { array, room })
    }
}

/// The beginning of `PyArrayObject_fields`, which numpy's C interface has had since version 1.7, and keeps in
/// version 2.
#[repr(C)]
struct Fields {
    head: ffi::PyObject,
    data: *mut c_char,
    nd: c_int,
    dimensions: *const isize,
    strides: *const isize,
    base: *mut ffi::PyObject,
    descr: *mut ffi::PyObject,
    flags: c_int,
}

/// `NPY_ARRAY_C_CONTIGUOUS`, `NPY_ARRAY_ALIGNED`, `NPY_ARRAY_WRITEABLE`.
const CONTIGUOUS: c_int = 0x1;
const ALIGNED: c_int = 0x100;
const WRITABLE: c_int = 0x400;

/// What is needed of numpy, found once.
struct Numpy {
    require: Py<PyAny>,
    empty: Py<PyAny>,
    /// The type of arrays, and the one of doubles.
    array: Py<PyAny>,
    double: Py<PyAny>,
    /// Whether arrays have the fields of `Fields`.
    has_fields: bool,
}

impl Numpy {
    fn find(py: Python<'_>) -> PyResult<Self> {
        let module = py.import("numpy")?;
        let double = module.call_method1("dtype", ("float64",))?;
        let empty = module.getattr("empty")?;
        let version: String = module.getattr("__version__")?.extract()?;
        let mut numpy = Numpy {
            array: module.getattr("ndarray")?.unbind(),
            has_fields: version.starts_with("1.") || version.starts_with("2."),
            empty: empty.clone().unbind(),
            double: double.clone().unbind(),
            require: module.getattr("require")?.unbind(),
        };
        // a version that calls itself 2 and has other fields is found by an array whose fields are known
        if numpy.has_fields {
            let probe = empty.call1(((2, 3),))?;
            let interface = probe.getattr("__array_interface__")?;
            let (address, _): (usize, bool) = interface.get_item("data")?.extract()?;
            // SAFETY: an array of any version of numpy is longer than the fields
            let fields = unsafe { &*probe.as_ptr().cast::<Fields>() };
            let expected = CONTIGUOUS | ALIGNED | WRITABLE;
            numpy.has_fields = fields.data.cast::<c_void>().addr() == address
                && fields.nd == 2
                && fields.descr == double.as_ptr()
                && fields.flags & expected == expected
                // SAFETY: two numbers, as `nd` says
                && unsafe { std::slice::from_raw_parts(fields.dimensions, 2) } == [2, 3];
        }
        Ok(numpy)
    }
}

fn numpy(py: Python<'_>) -> PyResult<&Numpy> {
    static NUMPY: PyOnceLock<Numpy> = PyOnceLock::new();
    NUMPY.get_or_try_init(py, || Numpy::find(py))
}
