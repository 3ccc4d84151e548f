//! The functions of FMI 2.0.

#![expect(unsafe_code, reason = "the interface consists of C functions")]

use crate::handle::{self, Handle, Status, call, refuse, string};
use bryant_fmu::Instance;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::PathBuf;

type Logger =
    unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// The functions of the importer; those for memory and for steps in the background are not called.
#[repr(C)]
struct Callbacks {
    logger: Option<Logger>,
    allocate: *const c_void,
    free: *const c_void,
    finished: *const c_void,
    environment: *mut c_void,
}

/// The type of an instance that is integrated inside.
const CO_SIMULATION: c_int = 1;

#[unsafe(no_mangle)]
extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    guid: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: c_int,
    _logging: c_int,
) -> *mut c_void {
    // SAFETY: the importer's, by the standard
    let (name, guid, resources) = unsafe { (string(name), string(guid), string(resources)) };
    // SAFETY: the callbacks live as long as the instance, by the standard
    let (logger, environment) = match unsafe { callbacks.as_ref() } {
        Some(callbacks) => (callbacks.logger, callbacks.environment),
        None => (None, std::ptr::null_mut()),
    };
    let name = CString::new(name).unwrap_or_default();
    let log = move |status: Status, message: &CStr| {
        // the message is a format of printf
        let message = message.to_string_lossy().replace('%', "percent");
        let message = CString::new(message).unwrap_or_default();
        if let Some(logger) = logger {
            let (category, status) = (status.category(), status as c_int);
            // SAFETY: by the standard
            unsafe {
                logger(
                    environment,
                    name.as_ptr(),
                    status,
                    category.as_ptr(),
                    message.as_ptr(),
                )
            };
        }
    };
    Handle::open(Box::new(log), || match kind {
        CO_SIMULATION => Instance::new(&path(&resources)?, &guid),
        _ => Err("there is no model exchange here, only co-simulation".to_owned()),
    })
}

/// The folder that a URI names.
fn path(uri: &str) -> Result<PathBuf, String> {
    let rest = uri.strip_prefix("file:").unwrap_or(uri);
    let rest = match rest.strip_prefix("//") {
        // the name of a host, which is this one
        Some(rest) => &rest[rest.find('/').unwrap_or(0)..],
        None => rest,
    };
    let mut bytes = Vec::new();
    let mut rest = rest.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let digits = [rest.next(), rest.next()].map(|digit| digit.unwrap_or(b'?') as char);
                let code = u8::from_str_radix(&digits.iter().collect::<String>(), 16);
                code.map_err(|_| format!("{uri} is no URI"))?
            }
            byte => byte,
        });
    }
    let path = String::from_utf8(bytes).map_err(|_| format!("{uri} is no URI of UTF-8"))?;
    // /C:/folder
    let drive = path.as_bytes().get(2) == Some(&b':');
    Ok(PathBuf::from(if drive { &path[1..] } else { &path[..] }))
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2FreeInstance(instance: *mut c_void) {
    // SAFETY: the importer's
    unsafe { Handle::close(instance) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetupExperiment(
    instance: *mut c_void,
    has_tolerance: c_int,
    tolerance: f64,
    start: f64,
    has_stop: c_int,
    stop: f64,
) -> Status {
    let tolerance = (has_tolerance != 0).then_some(tolerance);
    let stop = (has_stop != 0).then_some(stop);
    // SAFETY: the importer's
    unsafe {
        call(instance, |instance| {
            instance.set_up(start, stop, tolerance).map(|()| Vec::new())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2EnterInitializationMode(instance: *mut c_void) -> Status {
    // SAFETY: the importer's
    unsafe { call(instance, |_| Ok(Vec::new())) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2ExitInitializationMode(instance: *mut c_void) -> Status {
    // SAFETY: the importer's
    unsafe { call(instance, |instance| instance.begin().map(|()| Vec::new())) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2Terminate(instance: *mut c_void) -> Status {
    // SAFETY: the importer's
    unsafe { call(instance, |instance| Ok(instance.end())) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2Reset(instance: *mut c_void) -> Status {
    // SAFETY: the importer's
    unsafe {
        call(instance, |instance| {
            instance.reset();
            Ok(Vec::new())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetReal(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut f64,
) -> Status {
    // SAFETY: the importer's
    unsafe { handle::get(instance, references, count, values, count) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetReal(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
) -> Status {
    // SAFETY: the importer's
    unsafe { handle::set(instance, references, count, values, count) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2DoStep(
    instance: *mut c_void,
    from: f64,
    length: f64,
    _no_return: c_int,
) -> Status {
    // SAFETY: the importer's
    unsafe {
        call(instance, |instance| {
            instance.step(from, length).map(|()| Vec::new())
        })
    }
}

/// The last time that a step reached.
const LAST_TIME: c_int = 2;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetRealStatus(
    instance: *mut c_void,
    kind: c_int,
    value: *mut f64,
) -> Status {
    // SAFETY: the importer's
    unsafe {
        call(instance, |instance| match (kind, value.as_mut()) {
            (LAST_TIME, Some(value)) => {
                *value = instance.time();
                Ok(Vec::new())
            }
            _ => Err("there is no such status".to_owned()),
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetDebugLogging(
    instance: *mut c_void,
    _on: c_int,
    _count: usize,
    _categories: *const c_void,
) -> Status {
    // SAFETY: the importer's
    unsafe { call(instance, |_| Ok(Vec::new())) }
}

/// Functions over variables of kinds that no model has.
macro_rules! of_other_kinds {
    ($($name:ident)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(instance: *mut c_void, _references: *const u32, count: usize, _values: *mut c_void) -> Status {
            match count {
                0 => Status::Ok,
                // SAFETY: the importer's
                _ => unsafe { refuse(instance, stringify!($name)) },
            }
        }
    )*};
}

of_other_kinds!(fmi2GetInteger fmi2GetBoolean fmi2GetString fmi2SetInteger fmi2SetBoolean fmi2SetString);

/// Functions that the description does not promise, but that importers look for.
macro_rules! refused {
    ($($name:ident)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(instance: *mut c_void) -> Status {
            // SAFETY: the importer's
            unsafe { refuse(instance, stringify!($name)) }
        }
    )*};
}

refused! {
    fmi2GetFMUstate fmi2SetFMUstate fmi2FreeFMUstate fmi2SerializedFMUstateSize fmi2SerializeFMUstate fmi2DeSerializeFMUstate
    fmi2GetDirectionalDerivative fmi2SetRealInputDerivatives fmi2GetRealOutputDerivatives fmi2CancelStep fmi2GetStatus
    fmi2GetIntegerStatus fmi2GetBooleanStatus fmi2GetStringStatus
}

#[cfg(test)]
mod tests {
    use super::path;

    #[test]
    fn a_uri_names_a_folder() {
        for (uri, folder) in [
            ("file:///some/a%20b/resources", "/some/a b/resources"),
            ("file://localhost/some/r", "/some/r"),
            ("file:/some/r", "/some/r"),
            ("file:///C:/some/r", "C:/some/r"),
            ("/some/r", "/some/r"),
        ] {
            assert_eq!(path(uri).unwrap().to_str(), Some(folder), "{uri}");
        }
        assert!(path("file:///a%zz").is_err());
    }
}
