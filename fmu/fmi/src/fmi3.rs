//! The functions of FMI 3.0.

#![expect(unsafe_code, reason = "the interface consists of C functions")]

use crate::handle::{self, Handle, Status, call, refuse, string};
use bryant_fmu::Instance;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::path::Path;

type Logger = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateCoSimulation(
    _name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    _logging: bool,
    _event_mode: bool,
    _early_return: bool,
    _intermediate: *const u32,
    _intermediate_count: usize,
    environment: *mut c_void,
    logger: Option<Logger>,
    _update: *const c_void,
) -> *mut c_void {
    // SAFETY: the importer's, by the standard
    let (token, resources) = unsafe { (string(token), string(resources)) };
    let log = move |status: Status, message: &CStr| {
        if let Some(logger) = logger {
            // SAFETY: by the standard
            unsafe {
                logger(
                    environment,
                    status as c_int,
                    status.category().as_ptr(),
                    message.as_ptr(),
                )
            };
        }
    };
    Handle::open(Box::new(log), || {
        Instance::new(Path::new(&resources), &token)
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateModelExchange() -> *mut c_void {
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateScheduledExecution() -> *mut c_void {
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeInstance(instance: *mut c_void) {
    // SAFETY: the importer's
    unsafe { Handle::close(instance) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: *mut c_void,
    has_tolerance: bool,
    tolerance: f64,
    start: f64,
    has_stop: bool,
    stop: f64,
) -> Status {
    let (tolerance, stop) = (has_tolerance.then_some(tolerance), has_stop.then_some(stop));
    // SAFETY: the importer's
    unsafe {
        call(instance, |instance| {
            instance.set_up(start, stop, tolerance).map(|()| Vec::new())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3ExitInitializationMode(instance: *mut c_void) -> Status {
    // SAFETY: the importer's
    unsafe { call(instance, |instance| instance.begin().map(|()| Vec::new())) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3Terminate(instance: *mut c_void) -> Status {
    // SAFETY: the importer's
    unsafe { call(instance, |instance| Ok(instance.end())) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3Reset(instance: *mut c_void) -> Status {
    // SAFETY: the importer's
    unsafe {
        call(instance, |instance| {
            instance.reset();
            Ok(Vec::new())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFloat64(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut f64,
    length: usize,
) -> Status {
    // SAFETY: the importer's
    unsafe { handle::get(instance, references, count, values, length) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFloat64(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
    length: usize,
) -> Status {
    // SAFETY: the importer's
    unsafe { handle::set(instance, references, count, values, length) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DoStep(
    instance: *mut c_void,
    from: f64,
    length: f64,
    _no_return: bool,
    event: *mut bool,
    terminate: *mut bool,
    early: *mut bool,
    last: *mut f64,
) -> Status {
    // SAFETY: the importer's
    unsafe {
        let status = call(instance, |instance| {
            let done = instance.step(from, length);
            if let Some(last) = last.as_mut() {
                *last = instance.time();
            }
            done.map(|()| Vec::new())
        });
        for answer in [event, terminate, early] {
            if let Some(answer) = answer.as_mut() {
                *answer = false;
            }
        }
        status
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetDebugLogging(
    instance: *mut c_void,
    _on: bool,
    _count: usize,
    _categories: *const c_void,
) -> Status {
    // SAFETY: the importer's
    unsafe { call(instance, |_| Ok(Vec::new())) }
}

/// Functions over variables of types that no model has.
macro_rules! of_other_types {
    ($($name:ident)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(instance: *mut c_void, _references: *const u32, count: usize) -> Status {
            match count {
                0 => Status::Ok,
                // SAFETY: the importer's
                _ => unsafe { refuse(instance, stringify!($name)) },
            }
        }
    )*};
}

of_other_types! {
    fmi3GetFloat32 fmi3GetInt8 fmi3GetUInt8 fmi3GetInt16 fmi3GetUInt16 fmi3GetInt32 fmi3GetUInt32 fmi3GetInt64 fmi3GetUInt64
    fmi3GetBoolean fmi3GetString fmi3GetBinary fmi3GetClock
    fmi3SetFloat32 fmi3SetInt8 fmi3SetUInt8 fmi3SetInt16 fmi3SetUInt16 fmi3SetInt32 fmi3SetUInt32 fmi3SetInt64 fmi3SetUInt64
    fmi3SetBoolean fmi3SetString fmi3SetBinary fmi3SetClock
}

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
    fmi3EnterEventMode fmi3GetNumberOfVariableDependencies fmi3GetVariableDependencies fmi3GetFMUState fmi3SetFMUState
    fmi3FreeFMUState fmi3SerializedFMUStateSize fmi3SerializeFMUState fmi3DeserializeFMUState fmi3GetDirectionalDerivative
    fmi3GetAdjointDerivative fmi3EnterConfigurationMode fmi3ExitConfigurationMode fmi3GetIntervalDecimal fmi3GetIntervalFraction
    fmi3GetShiftDecimal fmi3GetShiftFraction fmi3SetIntervalDecimal fmi3SetIntervalFraction fmi3SetShiftDecimal
    fmi3SetShiftFraction fmi3EvaluateDiscreteStates fmi3UpdateDiscreteStates fmi3EnterContinuousTimeMode
    fmi3CompletedIntegratorStep fmi3SetTime fmi3SetContinuousStates fmi3GetContinuousStateDerivatives fmi3GetEventIndicators
    fmi3GetContinuousStates fmi3GetNominalsOfContinuousStates fmi3GetNumberOfEventIndicators fmi3GetNumberOfContinuousStates
    fmi3EnterStepMode fmi3GetOutputDerivatives fmi3ActivateModelPartition
}
