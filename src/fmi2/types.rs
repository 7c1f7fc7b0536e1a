//! The C types of `fmi2TypesPlatform.h` and `fmi2FunctionTypes.h` (FMI 2.0 sections 2.1.2 to 2.1.5).
//!
//! What comes from C is taken as the integer it is, never as a Rust `bool` or `enum`: a host may
//! pass any bit pattern.

use std::ffi::{c_char, c_int, c_uint, c_void};

/// `fmi2Component`
pub type Component = *mut c_void;
/// `fmi2ComponentEnvironment`
pub type ComponentEnvironment = *mut c_void;
/// `fmi2FMUstate`
pub type FmuState = *mut c_void;
/// `fmi2ValueReference`
pub type ValueReference = c_uint;
/// `fmi2Boolean`: 0 is false, anything else is taken as true.
pub type Boolean = c_int;

/// The only value the layer writes for true.
pub const TRUE: Boolean = 1;
/// The value of false.
pub const FALSE: Boolean = 0;

/// `fmi2Status`
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(i32)]
pub enum Status {
    Ok = 0,
    Warning = 1,
    Discard = 2,
    Error = 3,
    Fatal = 4,
    /// Of asynchronous steps only; this layer never returns it.
    Pending = 5,
}

/// `fmi2Type`: the interface an instance was made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[repr(i32)]
pub enum Interface {
    ModelExchange = 0,
    CoSimulation = 1,
}

impl Interface {
    /// From C's `fmi2Type`, `None` for what the standard does not define.
    pub fn from_c(value: c_int) -> Option<Self> {
        match value {
            0 => Some(Self::ModelExchange),
            1 => Some(Self::CoSimulation),
            _ => None,
        }
    }
}

/// `fmi2StatusKind` values, as C passes them.
pub mod status_kind {
    use std::ffi::c_int;
    /// `fmi2DoStepStatus`
    pub const DO_STEP_STATUS: c_int = 0;
    /// `fmi2PendingStatus`
    pub const PENDING_STATUS: c_int = 1;
    /// `fmi2LastSuccessfulTime`
    pub const LAST_SUCCESSFUL_TIME: c_int = 2;
    /// `fmi2Terminated`
    pub const TERMINATED: c_int = 3;
}

/// The logger callback; variadic like `printf`. It must not unwind; if it does all the same, that
/// ends at the panic boundary and not in undefined behaviour.
pub type LoggerCallback =
    unsafe extern "C-unwind" fn(ComponentEnvironment, *const c_char, c_int, *const c_char, *const c_char, ...);

/// `fmi2CallbackFunctions`. The memory functions and `stepFinished` are never called.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CallbackFunctions {
    pub logger: Option<LoggerCallback>,
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    pub step_finished: Option<unsafe extern "C" fn(ComponentEnvironment, c_int)>,
    pub component_environment: ComponentEnvironment,
}

/// `fmi2EventInfo`
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct EventInfo {
    pub new_discrete_states_needed: Boolean,
    pub terminate_simulation: Boolean,
    pub nominals_of_continuous_states_changed: Boolean,
    pub values_of_continuous_states_changed: Boolean,
    pub next_event_time_defined: Boolean,
    /// Seconds
    pub next_event_time: f64,
}
