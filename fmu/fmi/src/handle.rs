//! What both versions of the interface share: instances behind pointers, and messages.

#![expect(unsafe_code, reason = "the interface consists of C functions")]

use bryant_fmu::{Instance, Message};
use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// How a call went, with the numbers of both standards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    /// Well.
    Ok = 0,
    /// With a doubt that a message states.
    Warning = 1,
    /// Not at all; a message says why.
    Error = 3,
}

impl Status {
    /// The category of its messages.
    pub fn category(self) -> &'static CStr {
        match self {
            Status::Ok => c"logAll",
            Status::Warning => c"logStatusWarning",
            Status::Error => c"logStatusError",
        }
    }
}

/// Hands a message to the importer.
pub type Log = Box<dyn Fn(Status, &CStr)>;

/// What the pointers of the importer point to.
pub struct Handle {
    pub instance: Instance,
    log: Log,
}

impl Handle {
    /// The pointer to a new instance; a null pointer, and a message, if there can be none.
    pub fn open(log: Log, make: impl FnOnce() -> Result<Instance, Message>) -> *mut c_void {
        let made = catch_unwind(AssertUnwindSafe(make));
        match made.unwrap_or_else(|_| Err(PANIC.to_owned())) {
            Ok(instance) => Box::into_raw(Box::new(Handle { instance, log })).cast(),
            Err(message) => {
                log(Status::Error, &text(&message));
                std::ptr::null_mut()
            }
        }
    }

    /// # Safety
    /// The pointer is null or one of [`open`](Self::open) that was not closed.
    pub unsafe fn close(pointer: *mut c_void) {
        if !pointer.is_null() {
            // SAFETY: the caller's
            drop(unsafe { Box::from_raw(pointer.cast::<Handle>()) });
        }
    }
}

/// What is said of a failure that is one of this program.
const PANIC: &str = "the program failed: please report this with the model";

/// A message as the importer reads it.
fn text(message: &str) -> CString {
    CString::new(message.replace('\0', " ")).unwrap_or_default()
}

/// Calls a function of an instance, and hands its message to the importer.
///
/// # Safety
/// The pointer is null or one of [`Handle::open`] that was not closed, and no other thread uses it.
pub unsafe fn call(
    pointer: *mut c_void,
    function: impl FnOnce(&mut Instance) -> Result<Vec<Message>, Message>,
) -> Status {
    // SAFETY: the caller's
    let Some(handle) = (unsafe { pointer.cast::<Handle>().as_mut() }) else {
        return Status::Error;
    };
    let done = catch_unwind(AssertUnwindSafe(|| function(&mut handle.instance)));
    match done.unwrap_or_else(|_| Err(PANIC.to_owned())) {
        Ok(doubts) if doubts.is_empty() => Status::Ok,
        Ok(doubts) => {
            for doubt in doubts {
                (handle.log)(Status::Warning, &text(&doubt));
            }
            Status::Warning
        }
        Err(message) => {
            (handle.log)(Status::Error, &text(&message));
            Status::Error
        }
    }
}

/// Refuses a function that the description does not promise.
///
/// # Safety
/// As [`call`].
pub unsafe fn refuse(pointer: *mut c_void, name: &str) -> Status {
    // SAFETY: the caller's
    unsafe { call(pointer, |_| Err(format!("there is no {name} here"))) }
}

/// Reads variables into an array of C.
///
/// # Safety
/// As [`call`], with arrays of these lengths.
pub unsafe fn get(
    pointer: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut f64,
    length: usize,
) -> Status {
    // SAFETY: the caller's
    unsafe {
        call(pointer, |instance| {
            let references = array(references, count)?;
            check(count, length)?;
            if length > 0 && values.is_null() {
                return Err("there is no array for the values".to_owned());
            }
            let values = match length {
                0 => &mut [],
                _ => std::slice::from_raw_parts_mut(values, length),
            };
            instance.get(references, values).map(|()| Vec::new())
        })
    }
}

/// Sets variables from an array of C.
///
/// # Safety
/// As [`call`], with arrays of these lengths.
pub unsafe fn set(
    pointer: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
    length: usize,
) -> Status {
    // SAFETY: the caller's
    unsafe {
        call(pointer, |instance| {
            let (references, values) = (array(references, count)?, array(values, length)?);
            check(count, length)?;
            instance.set(references, values).map(|()| Vec::new())
        })
    }
}

fn check(references: usize, values: usize) -> Result<(), Message> {
    match references == values {
        true => Ok(()),
        false => Err(format!(
            "there are {references} value references, and {values} values"
        )),
    }
}

/// # Safety
/// The pointer is null or one to an array of this length.
unsafe fn array<'a, T>(pointer: *const T, length: usize) -> Result<&'a [T], Message> {
    match length {
        0 => Ok(&[]),
        _ if pointer.is_null() => Err("an array is missing".to_owned()),
        // SAFETY: the caller's
        _ => Ok(unsafe { std::slice::from_raw_parts(pointer, length) }),
    }
}

/// A text of C; nothing for a null pointer.
///
/// # Safety
/// The pointer is null or one to a text.
pub unsafe fn string(pointer: *const c_char) -> String {
    match pointer.is_null() {
        true => String::new(),
        // SAFETY: the caller's
        false => unsafe { CStr::from_ptr(pointer) }
            .to_string_lossy()
            .into_owned(),
    }
}
