//! A host over the exported C functions: an instance with its log.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::ptr;

use rps3::fmi2::types::{CallbackFunctions, Component, EventInfo, FmuState, Interface, LoggerCallback, Status};

use crate::toy::{GUID, integer, trouble};
use crate::*;

pub use rps3::fmi2::types::Interface::{CoSimulation, ModelExchange};

/// A message that the logger was called with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    pub instance: String,
    pub status: c_int,
    pub category: String,
    pub text: String,
}

/// What the logger collects; its address is the component environment.
#[derive(Debug, Default)]
pub struct Messages(pub std::cell::RefCell<Vec<Message>>);

/// # Safety
/// As the FMI logger; `environment` is a `Messages`.
unsafe extern "C" fn collect(
    environment: *mut c_void,
    instance: *const c_char,
    status: c_int,
    category: *const c_char,
    format: *const c_char,
    argument: *const c_char,
) {
    assert!(!category.is_null(), "a category is never NULL");
    // SAFETY: the layer passes "%s" and C strings, and the host its own environment.
    unsafe {
        assert_eq!(CStr::from_ptr(format), c"%s");
        let text = |s| CStr::from_ptr(s).to_str().unwrap().to_owned();
        let message = Message { instance: text(instance), status, category: text(category), text: text(argument) };
        (*environment.cast::<Messages>()).0.borrow_mut().push(message);
    }
}

pub fn callbacks(messages: &Messages) -> CallbackFunctions {
    // SAFETY: Rust cannot define variadic functions; the layer passes exactly one argument, a
    // pointer, which arrives in the same place in both kinds of call on the platforms we test on.
    let logger = unsafe {
        std::mem::transmute::<
            unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, *const c_char),
            LoggerCallback,
        >(collect)
    };
    CallbackFunctions {
        logger: Some(logger),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: ptr::from_ref(messages).cast_mut().cast(),
    }
}

/// An instance of the toy model.
pub struct Host {
    pub c: Component,
    pub messages: Box<Messages>,
}

impl Drop for Host {
    fn drop(&mut self) {
        // SAFETY: the instance is freed once, here.
        unsafe { fmi2FreeInstance(self.c) }
    }
}

/// Calls an exported function.
macro_rules! call {
    ($function:ident($($argument:expr),* $(,)?)) => {
        // SAFETY: arguments are valid as the standard asks, or null where a test says so.
        unsafe { $function($($argument),*) }
    };
}
pub(crate) use call;

impl Host {
    /// A new instance, with all logging on.
    pub fn new(interface: Interface) -> Self {
        Self::with_logging(interface, true)
    }

    pub fn with_logging(interface: Interface, logging_on: bool) -> Self {
        let messages = Box::new(Messages::default());
        let c = instantiate(Some("toy"), interface as c_int, Some(GUID), &messages, logging_on);
        assert!(!c.is_null());
        Self { c, messages }
    }

    /// An instance that was initialized with the start values over 0 to 1 s: in Event Mode or
    /// ready for the first step.
    pub fn initialized(interface: Interface) -> Self {
        let host = Self::new(interface);
        host.initialize();
        host
    }

    /// A model-exchange instance in Continuous-Time Mode.
    pub fn continuous() -> Self {
        let host = Self::initialized(ModelExchange);
        assert_eq!(host.new_discrete_states().0, Status::Ok);
        assert_eq!(call!(fmi2EnterContinuousTimeMode(host.c)), Status::Ok);
        host
    }

    pub fn initialize(&self) {
        assert_eq!(self.setup(0.0, Some(1.0)), Status::Ok);
        assert_eq!(call!(fmi2EnterInitializationMode(self.c)), Status::Ok);
        assert_eq!(call!(fmi2ExitInitializationMode(self.c)), Status::Ok);
    }

    pub fn setup(&self, start: f64, stop: Option<f64>) -> Status {
        call!(fmi2SetupExperiment(self.c, 0, 0.0, start, stop.is_some().into(), stop.unwrap_or(0.0)))
    }

    pub fn step(&self, point: f64, size: f64) -> Status {
        call!(fmi2DoStep(self.c, point, size, 1))
    }

    pub fn set_real(&self, reference: u32, value: f64) -> Status {
        call!(fmi2SetReal(self.c, &reference, 1, &value))
    }

    pub fn get_real(&self, reference: u32) -> (Status, f64) {
        let mut value = f64::NAN;
        (call!(fmi2GetReal(self.c, &reference, 1, &mut value)), value)
    }

    pub fn real(&self, reference: u32) -> f64 {
        let (status, value) = self.get_real(reference);
        assert_eq!(status, Status::Ok, "{:?}", self.messages);
        value
    }

    pub fn set_integer(&self, reference: u32, value: i32) -> Status {
        call!(fmi2SetInteger(self.c, &reference, 1, &value))
    }

    pub fn integer(&self, reference: u32) -> i32 {
        let mut value = i32::MIN;
        assert_eq!(call!(fmi2GetInteger(self.c, &reference, 1, &mut value)), Status::Ok);
        value
    }

    pub fn set_boolean(&self, reference: u32, value: c_int) -> Status {
        call!(fmi2SetBoolean(self.c, &reference, 1, &value))
    }

    pub fn boolean(&self, reference: u32) -> c_int {
        let mut value = c_int::MIN;
        assert_eq!(call!(fmi2GetBoolean(self.c, &reference, 1, &mut value)), Status::Ok);
        value
    }

    pub fn trouble(&self, kind: i32) {
        assert_eq!(self.set_integer(integer::TROUBLE, kind), Status::Ok);
    }

    pub fn new_discrete_states(&self) -> (Status, EventInfo) {
        let mut info = EventInfo::default();
        (call!(fmi2NewDiscreteStates(self.c, &mut info)), info)
    }

    pub fn state(&self) -> FmuState {
        let mut state = ptr::null_mut();
        assert_eq!(call!(fmi2GetFMUstate(self.c, &mut state)), Status::Ok);
        state
    }

    pub fn serialize(&self, state: FmuState) -> Vec<u8> {
        let mut size = 0;
        assert_eq!(call!(fmi2SerializedFMUstateSize(self.c, state, &mut size)), Status::Ok);
        let mut bytes = vec![0; size];
        assert_eq!(call!(fmi2SerializeFMUstate(self.c, state, bytes.as_mut_ptr(), size)), Status::Ok);
        bytes
    }

    pub fn deserialize(&self, bytes: &[u8]) -> (Status, FmuState) {
        let mut state = ptr::null_mut();
        (call!(fmi2DeSerializeFMUstate(self.c, bytes.as_ptr(), bytes.len(), &mut state)), state)
    }

    /// The bits of every Real, Integer and Boolean that has a value reference, with the states.
    pub fn fingerprint(&self) -> Vec<u64> {
        use crate::toy::{boolean, real};
        let reals = [
            real::TIME,
            real::U,
            real::W,
            real::X,
            real::V,
            real::A,
            real::Y,
            real::HELD,
            real::K,
            real::C,
            real::X_START,
            real::GAIN,
        ];
        let mut bits: Vec<u64> = reals.iter().map(|&r| self.real(r).to_bits()).collect();
        bits.extend([integer::TICKS, integer::SELECTOR].map(|r| self.integer(r) as u64));
        bits.extend([boolean::FLAG, boolean::POSITIVE].map(|r| self.boolean(r) as u64));
        bits
    }

    /// The last message, which is the only new one since `take`.
    pub fn take_messages(&self) -> Vec<Message> {
        self.messages.0.take()
    }

    /// An instance in the standard's state `error`, by a failed computation.
    pub fn in_error(interface: Interface) -> Self {
        let host = Self::initialized(interface);
        host.trouble(trouble::ERROR);
        let status = match interface {
            ModelExchange => host.get_real(crate::toy::real::X).0,
            CoSimulation => host.step(0.0, 0.01),
        };
        assert_eq!(status, Status::Error);
        host
    }
}

/// `fmi2Instantiate` with `None` for NULL.
pub fn instantiate(
    name: Option<&str>,
    fmu_type: c_int,
    guid: Option<&str>,
    messages: &Messages,
    logging_on: bool,
) -> Component {
    let c_string = |s: Option<&str>| s.map(|s| CString::new(s).unwrap());
    let (name, guid) = (c_string(name), c_string(guid));
    let pointer = |s: &Option<CString>| s.as_ref().map_or(ptr::null(), |s| s.as_ptr());
    let callbacks = callbacks(messages);
    call!(fmi2Instantiate(pointer(&name), fmu_type, pointer(&guid), ptr::null(), &callbacks, 0, logging_on.into()))
}
