//! One of the FMUs as a Co-Simulation slave over its C functions, by variable names.
#![allow(dead_code)] // each test uses a part

pub mod soak;

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::marker::PhantomData;
use std::ptr;

use rps3::control::{ControllerParameters, Mode, Tuning};
use rps3::coupling::Experiment;
use rps3::description::{Causality, Kind, VariableType};
use rps3::dynamics::PlantParameters;
use rps3::fmi2::types::{CallbackFunctions, Component, FmuState, Interface, LoggerCallback, Status, ValueReference};
use rps3::fmi2::{Lasting, Layout, Model, api};
use rps3::models::{Controller, Plant};

/// s
pub const COUPLED_STEP: f64 = 1e-3;

/// The default crossing in one of the control modes, in process.
pub fn crossing(mode: i32) -> Experiment {
    let mode = match mode {
        1 => Mode::Rac,
        2 => Mode::Drac,
        3 => Mode::Hdrac,
        _ => Mode::HdracMpso,
    };
    Experiment {
        plant: PlantParameters::default(),
        controller: ControllerParameters::default(),
        tuning: Tuning { mode, ..Tuning::default() },
        duration: 1.4,
        tolerance: 1e-7,
        push: None,
        length_noise: 0.0,
        noise_seed: 0,
    }
}

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

/// A message that the logger was called with.
#[derive(Debug, Clone)]
pub struct Message {
    pub status: c_int,
    pub text: String,
}

type Messages = RefCell<Vec<Message>>;

/// # Safety
/// As the FMI logger; `environment` is a `Messages`.
unsafe extern "C" fn collect(
    environment: *mut c_void,
    _instance: *const c_char,
    status: c_int,
    _category: *const c_char,
    _format: *const c_char,
    text: *const c_char,
) {
    // SAFETY: the layer passes C strings, and the host its own environment.
    let (messages, text) = unsafe { (&*environment.cast::<Messages>(), CStr::from_ptr(text)) };
    messages.borrow_mut().push(Message { status, text: text.to_string_lossy().into_owned() });
}

/// The slave.
pub struct Slave<M: Fmu> {
    pub c: Component,
    messages: Box<Messages>,
    model: PhantomData<M>,
}

impl<M: Fmu> Drop for Slave<M> {
    fn drop(&mut self) {
        // SAFETY: freed once.
        unsafe { api::free_instance::<M>(self.c) }
    }
}

/// Calls a function of the slave's model.
macro_rules! call {
    ($slave:expr, $name:ident ( $($argument:expr),* )) => {
        // SAFETY: valid pointers and sizes.
        unsafe { api::$name::<M>($slave.c $(, $argument)*) }
    };
}

impl<M: Fmu> Slave<M> {
    pub fn new() -> Self {
        Self::of(Interface::CoSimulation)
    }

    /// An instance for one of the interfaces.
    pub fn of(interface: Interface) -> Self {
        let messages = Box::new(Messages::default());
        // SAFETY: Rust cannot define variadic functions; the layer passes exactly one argument, a
        // pointer, which arrives in the same place in both kinds of call on the platforms we test on.
        let logger = unsafe {
            std::mem::transmute::<
                unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, *const c_char),
                LoggerCallback,
            >(collect)
        };
        let callbacks = CallbackFunctions {
            logger: Some(logger),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: ptr::from_ref(&*messages).cast_mut().cast(),
        };
        let guid = CString::new(M::guid()).unwrap();
        let kind = interface as c_int;
        // SAFETY: C strings and callbacks that live through the call.
        let c = unsafe { api::instantiate::<M>(c"slave".as_ptr(), kind, guid.as_ptr(), &callbacks, 0, M::layout()) };
        assert!(!c.is_null());
        Self { c, messages, model: PhantomData }
    }

    pub fn reference(name: &str, variable_type: VariableType) -> ValueReference {
        let variable = M::definition().variables.iter().find(|v| v.name == name).expect(name);
        assert_eq!(variable.variable_type(), variable_type);
        variable.value_reference
    }

    pub fn set_reals(&self, values: &[(&str, f64)]) -> Status {
        let references: Vec<_> = values.iter().map(|(name, _)| Self::reference(name, VariableType::Real)).collect();
        let values: Vec<_> = values.iter().map(|(_, value)| *value).collect();
        self.set_references(&references, &values)
    }

    /// Sets Reals by value reference.
    pub fn set_references(&self, references: &[ValueReference], values: &[f64]) -> Status {
        assert_eq!(references.len(), values.len());
        call!(self, set_real(references.as_ptr(), references.len(), values.as_ptr()))
    }

    /// Reads Reals by value reference.
    pub fn get_references(&self, references: &[ValueReference]) -> Vec<f64> {
        let mut values = vec![f64::NAN; references.len()];
        assert_eq!(self.read_references(references, &mut values), Status::Ok);
        values
    }

    /// Reads Reals by value reference, into `values`.
    pub fn read_references(&self, references: &[ValueReference], values: &mut [f64]) -> Status {
        assert_eq!(references.len(), values.len());
        call!(self, get_real(references.as_ptr(), references.len(), values.as_mut_ptr()))
    }

    pub fn set_real(&self, name: &str, value: f64) -> Status {
        self.set_reals(&[(name, value)])
    }

    pub fn set_integer(&self, name: &str, value: c_int) {
        let reference = Self::reference(name, VariableType::Integer);
        assert_eq!(call!(self, set_integer(&reference, 1, &value)), Status::Ok);
    }

    pub fn set_boolean(&self, name: &str, value: bool) {
        let (reference, value) = (Self::reference(name, VariableType::Boolean), c_int::from(value));
        assert_eq!(call!(self, set_boolean(&reference, 1, &value)), Status::Ok);
    }

    pub fn real(&self, name: &str) -> f64 {
        let (reference, mut value) = (Self::reference(name, VariableType::Real), f64::NAN);
        assert_eq!(call!(self, get_real(&reference, 1, &mut value)), Status::Ok);
        value
    }

    pub fn boolean(&self, name: &str) -> bool {
        let (reference, mut value) = (Self::reference(name, VariableType::Boolean), 0);
        assert_eq!(call!(self, get_boolean(&reference, 1, &mut value)), Status::Ok);
        value != 0
    }

    /// The start value of a Real.
    pub fn start(&self, name: &str) -> f64 {
        let variable = M::definition().variables.iter().find(|v| v.name == name).expect(name);
        match variable.kind {
            Kind::Real { start: Some(start), .. } => start,
            _ => panic!("{name} has no start value"),
        }
    }

    /// All Reals that are outputs, in the table's order.
    pub fn outputs(&self) -> Vec<f64> {
        self.get_references(&Self::references(Causality::Output))
    }

    /// Value references of all Reals of one causality, in the table's order.
    pub fn references(causality: Causality) -> Vec<ValueReference> {
        let variables = &M::definition().variables;
        let reals = variables.iter().filter(|v| v.causality == causality && v.variable_type() == VariableType::Real);
        reals.map(|v| v.value_reference).collect()
    }

    pub fn setup(&self, start: f64, stop: Option<f64>) -> Status {
        call!(self, setup_experiment(0, 0.0, start, c_int::from(stop.is_some()), stop.unwrap_or(0.0)))
    }

    /// As [`setup`](Self::setup) from 0 s on without an end, with a relative tolerance.
    pub fn setup_tolerance(&self, tolerance: f64) -> Status {
        call!(self, setup_experiment(1, tolerance, 0.0, 0, 0.0))
    }

    /// The rate of an input, for the step to come.
    pub fn set_input_derivative(&self, name: &str, rate: f64) {
        let reference = Self::reference(name, VariableType::Real);
        assert_eq!(call!(self, set_real_input_derivatives(&reference, 1, &1, &rate)), Status::Ok);
    }

    /// Initialization Mode from end to end; the outcome of its last call.
    fn initialization(&self) -> Status {
        assert_eq!(call!(self, enter_initialization_mode()), Status::Ok);
        call!(self, exit_initialization_mode())
    }

    /// From 0 s on; the outcome of the last call.
    pub fn try_initialize(&self) -> Status {
        assert_eq!(self.setup(0.0, None), Status::Ok);
        self.initialization()
    }

    /// After [`setup`](Self::setup).
    pub fn pass_initialization(&self) {
        assert_eq!(self.initialization(), Status::Ok, "{:?}", self.messages);
    }

    pub fn initialize(&self) {
        assert_eq!(self.setup(0.0, None), Status::Ok);
        self.pass_initialization();
    }

    pub fn step(&self, point: f64, size: f64) -> Status {
        call!(self, do_step(point, size, 1))
    }

    pub fn reset(&self) {
        assert_eq!(call!(self, reset()), Status::Ok);
    }

    pub fn state(&self) -> FmuState {
        let mut state = ptr::null_mut();
        assert_eq!(call!(self, get_fmu_state(&mut state)), Status::Ok);
        state
    }

    /// The bytes of a state.
    pub fn serialize(&self, state: FmuState) -> Vec<u8> {
        let mut size = 0;
        assert_eq!(call!(self, serialized_fmu_state_size(state, &mut size)), Status::Ok);
        let mut bytes = vec![0; size];
        assert_eq!(call!(self, serialize_fmu_state(state, bytes.as_mut_ptr(), size)), Status::Ok);
        bytes
    }

    /// A state from bytes, null if they are refused.
    pub fn deserialize(&self, bytes: &[u8]) -> FmuState {
        let mut state = ptr::null_mut();
        let status = call!(self, deserialize_fmu_state(bytes.as_ptr(), bytes.len(), &mut state));
        assert_eq!(status == Status::Ok, !state.is_null());
        state
    }

    pub fn restore(&self, state: FmuState) {
        assert_eq!(call!(self, set_fmu_state(state)), Status::Ok);
    }

    pub fn take_messages(&self) -> Vec<Message> {
        self.messages.take()
    }
}

/// What the controller reads of the plant, and the plant of the controller.
pub fn connections() -> (Vec<String>, Vec<String>) {
    use Causality::{Input, Output};
    fn names<M: Model>(causality: Causality) -> Vec<String> {
        M::definition().variables.iter().filter(|v| v.causality == causality).map(|v| v.name.clone()).collect()
    }
    let common = |outputs: Vec<String>, inputs: &[String]| -> Vec<String> {
        outputs.into_iter().filter(|name| inputs.contains(name)).collect()
    };
    (
        common(names::<Plant>(Output), &names::<Controller>(Input)),
        common(names::<Controller>(Output), &names::<Plant>(Input)),
    )
}

/// Hands the plant's measurements to the controller.
pub fn measure(plant: &Slave<Plant>, controller: &Slave<Controller>) {
    let (measurements, _) = connections();
    let measured: Vec<(&str, f64)> = measurements.iter().map(|name| (name.as_str(), plant.real(name))).collect();
    assert_eq!(controller.set_reals(&measured), Status::Ok);
}

/// Value references of what goes from the plant to the controller and back.
pub struct Wires {
    /// In the plant and in the controller.
    measured: (Vec<ValueReference>, Vec<ValueReference>),
    commands: (Vec<ValueReference>, Vec<ValueReference>),
}

impl Wires {
    pub fn new() -> Self {
        let references = |names: &[String]| -> (Vec<ValueReference>, Vec<ValueReference>) {
            let both = |name: &String| {
                let of_type = VariableType::Real;
                (Slave::<Plant>::reference(name, of_type), Slave::<Controller>::reference(name, of_type))
            };
            names.iter().map(both).unzip()
        };
        let (measurements, voltages) = connections();
        Self { measured: references(&measurements), commands: references(&voltages) }
    }

    /// Exchanges values and steps, controller first; whether all calls returned `fmi2OK`.
    pub fn step(&self, plant: &Slave<Plant>, controller: &Slave<Controller>, point: f64, step: f64) -> bool {
        let values = plant.get_references(&self.measured.0);
        controller.set_references(&self.measured.1, &values) == Status::Ok
            && controller.step(point, step) == Status::Ok
            && plant.set_references(&self.commands.0, &controller.get_references(&self.commands.1)) == Status::Ok
            && plant.step(point, step) == Status::Ok
    }
}

/// The pair, controller first, from `from` to `to` (in steps of `step` s).
pub fn couple(plant: &Slave<Plant>, controller: &Slave<Controller>, from: u32, to: u32, step: f64) {
    let wires = Wires::new();
    for k in from..to {
        let good = wires.step(plant, controller, f64::from(k) * step, step);
        assert!(good, "step {k}: {:?} {:?}", controller.take_messages(), plant.take_messages());
    }
}
