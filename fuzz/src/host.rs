//! A host that knows in which mode its instance should be, and checks every call it makes.

use std::ffi::{CString, c_char, c_int, c_void};
use std::ptr;

use arbitrary::Unstructured;
use rps3::description::VariableType;
use rps3::fmi2::api;
use rps3::fmi2::call_table::{Function, Mode};
use rps3::fmi2::types::{CallbackFunctions, Component, FmuState, Interface, LoggerCallback, Status};
use rps3::fmi2::{Lasting, Layout, Model};
use rps3::models::{Controller, Plant};

use super::numbers;
use super::tally::{TALLY, count};

/// A model with the place that the export macro would give its layout.
pub trait Fmu: Model {
    fn layout() -> &'static Lasting<Layout>;
}

impl Fmu for Plant {
    fn layout() -> &'static Lasting<Layout> {
        static LAYOUT: Lasting<Layout> = Lasting::new();
        &LAYOUT
    }
}

impl Fmu for Controller {
    fn layout() -> &'static Lasting<Layout> {
        static LAYOUT: Lasting<Layout> = Lasting::new();
        &LAYOUT
    }
}

/// CPU time of one call, s, beyond which a host would think that it hangs: the work of a call is
/// bounded to a fraction of it at full speed, and sanitizers are slow.
const LONGEST_CALL: f64 = 120.0;

/// # Safety
/// As the FMI logger; `environment` points to the number of messages.
unsafe extern "C" fn hear(
    environment: *mut c_void,
    instance: *const c_char,
    status: c_int,
    category: *const c_char,
    format: *const c_char,
    message: *const c_char,
) {
    for text in [instance, category, format, message] {
        assert!(!text.is_null());
        // SAFETY: the layer passes C strings.
        assert!(unsafe { std::ffi::CStr::from_ptr(text) }.to_str().is_ok());
    }
    assert!((0..=4).contains(&status));
    // SAFETY: the host's own environment.
    unsafe { *environment.cast::<u64>() += 1 };
}

/// CPU time of this thread, s.
fn cpu_time() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: a valid clock and a place for the answer.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// The host with its instance.
pub struct Host<M: Fmu> {
    pub component: Component,
    pub interface: Interface,
    /// Where the instance should be.
    pub mode: Mode,
    /// Handle to look at the state.
    probe: FmuState,
    messages: Box<u64>,
    /// `fmi2SetDebugLogging` was called, so that errors may be silent.
    pub silenced: bool,
    model: std::marker::PhantomData<M>,
}

impl<M: Fmu> Drop for Host<M> {
    fn drop(&mut self) {
        // SAFETY: made by `instantiate`, freed once.
        unsafe { api::free_instance::<M>(self.component) }
    }
}

/// Calls an FMI function of the host's model as `Function::$row`, checked.
macro_rules! call {
    ($host:expr, $row:ident, $name:ident ( $($argument:expr),* $(,)? )) => {
        // SAFETY: all pointers are valid for the stated sizes, or null, or handles that the layer
        // looks up.
        $host.checked(Function::$row, |component| unsafe { api::$name::<M>(component $(, $argument)*) })
    };
}
pub(super) use call;

impl<M: Fmu> Host<M> {
    /// A new instance.
    pub fn new(interface: Interface) -> Self {
        let mut messages = Box::new(0_u64);
        // SAFETY: Rust cannot define variadic functions; the layer passes exactly one argument, a
        // pointer, which arrives in the same place in both kinds of call on the fuzzed platforms.
        let logger = unsafe {
            std::mem::transmute::<
                unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, *const c_char),
                LoggerCallback,
            >(hear)
        };
        let callbacks = CallbackFunctions {
            logger: Some(logger),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: ptr::from_mut(&mut *messages).cast(),
        };
        let guid = CString::new(M::guid()).expect("no NUL in a GUID");
        // SAFETY: C strings and callbacks that live through the call.
        let component = unsafe {
            api::instantiate::<M>(c"fuzz".as_ptr(), interface as c_int, guid.as_ptr(), &callbacks, 1, M::layout())
        };
        assert!(!component.is_null());
        let model = std::marker::PhantomData;
        Self {
            component,
            interface,
            mode: Mode::Instantiated,
            probe: ptr::null_mut(),
            messages,
            silenced: false,
            model,
        }
    }

    /// Mostly has a controller damp with fixed factors: what the swarm does has its own tests.
    pub fn quick_ticks(&mut self, u: &mut Unstructured) {
        let mode = M::definition().variables.iter().find(|variable| variable.name == "control_mode");
        if let Some(variable) = mode
            && u.ratio(7, 8).unwrap_or(true)
        {
            let (reference, drac) = (variable.value_reference, 2);
            assert_eq!(call!(self, SetInteger, set_integer(&reference, 1, &drac)), Status::Ok);
        }
    }

    /// The serialized state.
    pub fn fingerprint(&mut self) -> Vec<u8> {
        let c = self.component;
        let mut size = 0;
        // SAFETY: valid pointers and sizes.
        unsafe {
            assert_eq!(api::get_fmu_state::<M>(c, &mut self.probe), Status::Ok);
            assert_eq!(api::serialized_fmu_state_size::<M>(c, self.probe, &mut size), Status::Ok);
            let mut bytes = vec![0; size];
            assert_eq!(api::serialize_fmu_state::<M>(c, self.probe, bytes.as_mut_ptr(), size), Status::Ok);
            bytes
        }
    }

    /// Makes a call as `function` and checks what must hold whatever the arguments.
    pub fn checked(&mut self, function: Function, call: impl FnOnce(Component) -> Status) -> Status {
        if function == Function::DeSerializeFmuState {
            count(&TALLY.states);
        }
        let before = self.fingerprint();
        let messages = *self.messages;
        let begin = cpu_time();
        count(&TALLY.calls);
        let status = call(self.component);
        let took = cpu_time() - begin;
        assert!(took < LONGEST_CALL, "{} took {took} s", function.name());
        assert_ne!(status, Status::Fatal, "{} panicked", function.name());
        if status != Status::Ok {
            // discards are silent until their category is switched on
            let silent = self.silenced || status == Status::Discard;
            assert!(silent || *self.messages > messages, "{}: {status:?} unlogged", function.name());
        }
        if !function.is_legal(self.interface, self.mode) {
            assert_eq!(status, Status::Error, "{} in {:?}", function.name(), self.mode);
        }
        let exchange = self.interface == Interface::ModelExchange;
        match status {
            Status::Ok => {}
            Status::Warning => assert_eq!(function, Function::SetReal),
            Status::Discard => match function {
                Function::DoStep => self.mode = Mode::StepFailed,
                Function::GetReal | Function::GetDerivatives | Function::GetContinuousStates => assert!(exchange),
                Function::GetStatus
                | Function::GetRealStatus
                | Function::GetIntegerStatus
                | Function::GetBooleanStatus
                | Function::GetStringStatus => assert!(!exchange),
                _ => panic!("{} returned fmi2Discard", function.name()),
            },
            Status::Error => {
                let after = self.fingerprint();
                if after != before {
                    // not refused but failed: only what computes can fail
                    assert_eq!(mode_in(&after), Mode::Error as u16, "a refused {} left traces", function.name());
                    self.mode = Mode::Error;
                }
            }
            Status::Fatal | Status::Pending => panic!("{} returned {status:?}", function.name()),
        }
        status
    }

    /// Asserts that the instance is in the mode it should be in.
    pub fn check_mode(&mut self) {
        let mode = mode_in(&self.fingerprint());
        assert_eq!(mode, self.mode as u16, "expected {:?}", self.mode);
    }

    /// Reads every variable where that is legal: nothing that is not finite comes with `fmi2OK`.
    pub fn read_everything(&mut self) -> Status {
        let references = |variable_type| -> Vec<u32> {
            numbers::of_type(M::definition(), variable_type).iter().map(|v| v.value_reference).collect()
        };
        let reals = references(VariableType::Real);
        let mut values = vec![f64::NAN; reals.len()];
        let status = call!(self, GetReal, get_real(reals.as_ptr(), reals.len(), values.as_mut_ptr()));
        if status == Status::Ok && self.mode != Mode::Error {
            let wrong = values.iter().position(|x| !x.is_finite());
            assert_eq!(wrong, None, "a Real is not finite in {:?}", self.mode);
        }
        let booleans = references(VariableType::Boolean);
        let mut values = vec![-1; booleans.len()];
        if call!(self, GetBoolean, get_boolean(booleans.as_ptr(), booleans.len(), values.as_mut_ptr())) == Status::Ok {
            assert!(values.iter().all(|value| matches!(value, 0 | 1)));
        }
        status
    }

    /// To the first step or event over `start` to for ever.
    pub fn initialize(&mut self, start: f64) -> Status {
        let setup = call!(self, SetupExperiment, setup_experiment(0, 0.0, start, 0, 0.0));
        if setup != Status::Ok {
            return setup;
        }
        self.enter_initialization_mode();
        self.exit_initialization_mode()
    }

    pub fn enter_initialization_mode(&mut self) -> Status {
        let status = call!(self, EnterInitializationMode, enter_initialization_mode());
        if status == Status::Ok {
            self.mode = Mode::Initialization;
        }
        status
    }

    pub fn exit_initialization_mode(&mut self) -> Status {
        let status = call!(self, ExitInitializationMode, exit_initialization_mode());
        if status == Status::Ok {
            self.mode = match self.interface {
                Interface::ModelExchange => Mode::Event,
                Interface::CoSimulation => Mode::StepComplete,
            };
            assert_eq!(self.read_everything(), Status::Ok);
        }
        status
    }

    /// The instance's own time, s.
    pub fn time(&mut self) -> f64 {
        let (reference, mut time) = (0, 0.0);
        // SAFETY: valid pointers; where reading is illegal the time does not matter.
        unsafe { api::get_real::<M>(self.component, &reference, 1, &mut time) };
        time
    }

    pub fn do_step(&mut self, point: f64, size: f64) -> Status {
        let status = call!(self, DoStep, do_step(point, size, 1));
        if status == Status::Ok {
            assert_eq!(self.time(), point + size, "the step ends exactly where it should");
            assert_eq!(self.read_everything(), Status::Ok);
        }
        status
    }
}

/// The mode in a serialized state, as the number that [`Mode`] gives it: the second byte of the
/// payload, which follows magic, version, GUID and length.
pub fn mode_in(bytes: &[u8]) -> u16 {
    let guid = u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
    1 << bytes[16 + guid + 8 + 1]
}
