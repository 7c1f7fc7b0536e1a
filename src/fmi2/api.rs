//! The C functions of FMI 2.0, generic in the model; [`crate::export_fmu!`] gives them their names.
//!
//! # Safety
//! What the standard asks of the caller holds for every function here: a component is null or came
//! from [`instantiate`], of this model or another, and was not freed, arrays have the stated lengths,
//! strings end with NUL, and the logger returns. All else (null pointers, wrong references, wrong order,
//! non-finite numbers, corrupted states, components of another FMU, calls from within the logger or
//! from two threads at once, as long as neither frees the instance) is checked.
#![allow(clippy::missing_safety_doc)] // said once, above
#![allow(clippy::too_many_arguments)] // the standard's signatures

use std::ffi::{CStr, c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::boundary::{apart, array, enter, panic_message, slice, slice_mut, target, text};
use super::call_table::Function;
use super::co_simulation::no_such_status;
use super::error::{CallError, CallResult};
use super::handle::Handle;
use super::instance::Instance;
use super::lasting::{Lasting, Stay};
use super::layout::Layout;
use super::logger::Logger;
use super::model::Model;
use super::types::{
    Boolean, CallbackFunctions, Component, EventInfo, FALSE, FmuState, Interface, Status, TRUE, ValueReference,
};
use crate::description::LogCategory;

/// `fmi2GetTypesPlatform`
pub fn get_types_platform() -> *const c_char {
    c"default".as_ptr()
}

/// `fmi2GetVersion`
pub fn get_version() -> *const c_char {
    c"2.0".as_ptr()
}

/// `fmi2Instantiate`. The resource location is not needed, so any is accepted; there is nothing to
/// be made visible either. `layout` is where the library keeps what all its instances share.
pub unsafe fn instantiate<M: Model>(
    instance_name: *const c_char,
    fmu_type: c_int,
    guid: *const c_char,
    functions: *const CallbackFunctions,
    logging_on: Boolean,
    layout: &'static Lasting<Layout>,
) -> Component {
    // SAFETY: the caller's promise (module documentation).
    let (name, guid) = unsafe { (text(instance_name), text(guid)) };
    if !functions.is_aligned() {
        return std::ptr::null_mut();
    }
    // SAFETY: as above; aligned as just checked.
    let callbacks = unsafe { functions.as_ref() }.copied();
    let instance = catch_unwind(AssertUnwindSafe(|| {
        let logger = Logger::new(callbacks, name.unwrap_or_default(), logging_on != FALSE);
        let made = check_instantiation::<M>(name, fmu_type, guid).and_then(|interface| {
            let stay = Stay::begin().ok_or_else(|| CallError::refused("the library is being unloaded"))?;
            let layout = layout.get_or_init(|| Layout::new(M::definition()));
            Ok(Handle::hand_out(Instance::<M>::new(interface, layout, logger.clone()), stay))
        });
        made.unwrap_or_else(|refusal| {
            logger.log(Status::Error, LogCategory::StatusError, &format!("fmi2Instantiate: {refusal}"));
            std::ptr::null_mut()
        })
    }));
    instance.unwrap_or_else(|payload| {
        // as in `enter`: neither the report nor the payload may panic across the border
        let _ = catch_unwind(AssertUnwindSafe(|| {
            let message = format!("fmi2Instantiate: internal error: {}", panic_message(&*payload));
            let logger = Logger::new(callbacks, name.unwrap_or_default(), logging_on != FALSE);
            logger.log(Status::Error, LogCategory::StatusError, &message);
        }));
        let _ = catch_unwind(AssertUnwindSafe(|| drop(payload)));
        std::ptr::null_mut()
    })
}

fn check_instantiation<M: Model>(name: Option<&CStr>, fmu_type: c_int, guid: Option<&CStr>) -> CallResult<Interface> {
    if name.is_none_or(|name| name.to_bytes().trim_ascii().is_empty()) {
        return Err(CallError::refused("the instance name is NULL or blank"));
    }
    let interface = Interface::from_c(fmu_type)
        .ok_or_else(|| CallError::Refused(format!("fmuType {fmu_type} is neither Model Exchange nor Co-Simulation")))?;
    match guid {
        None => Err(CallError::refused("the GUID is NULL")),
        Some(guid) if guid.to_bytes() != M::guid().as_bytes() => {
            Err(CallError::Refused(format!("the GUID is {}, this FMU has {}", guid.to_string_lossy(), M::guid())))
        }
        Some(_) => Ok(interface),
    }
}

/// `fmi2FreeInstance`; ignores null, and frees in every mode, since a leak would help nobody. Only
/// an instance with a call under way stays: the call will want it when the logger returns.
pub unsafe fn free_instance<M: Model>(component: Component) {
    // SAFETY: the caller's promise (module documentation).
    if let Some(handle) = unsafe { Handle::<M>::take_back(component) } {
        // A destructor that panics has no one to report to.
        let _ = catch_unwind(AssertUnwindSafe(|| drop(handle)));
    }
}

/// Defines functions whose first argument is the component and whose body runs on the instance.
/// Within it, raw pointers are read under the promise of the module documentation.
macro_rules! on_instance {
    ($($(#[$doc:meta])* $name:ident ( $instance:ident $(, $argument:ident : $type:ty)* ) as $function:ident $body:block)*) => {
        $(
            $(#[$doc])*
            pub unsafe fn $name<M: Model>(component: Component $(, $argument: $type)*) -> Status {
                // SAFETY: the caller's promise (module documentation).
                unsafe { enter(component, Function::$function, |$instance: &mut Instance<M>| $body) }
            }
        )*
    };
}

on_instance! {
    /// `fmi2SetDebugLogging`
    set_debug_logging(instance, on: Boolean, count: usize, categories: *const *const c_char) as SetDebugLogging {
        let mut names = Vec::new();
        for &category in slice(categories, count, "categories")? {
            names.push(text(category).ok_or_else(|| CallError::refused("a category is NULL"))?);
        }
        instance.set_debug_logging(on != FALSE, &names)
    }

    /// `fmi2SetupExperiment`
    setup_experiment(
        instance, tolerance_defined: Boolean, tolerance: f64, start_time: f64, stop_time_defined: Boolean, stop_time: f64
    ) as SetupExperiment {
        let tolerance = (tolerance_defined != FALSE).then_some(tolerance);
        let stop_time = (stop_time_defined != FALSE).then_some(stop_time);
        instance.setup_experiment(tolerance, start_time, stop_time)
    }

    /// `fmi2EnterInitializationMode`
    enter_initialization_mode(instance) as EnterInitializationMode { instance.enter_initialization_mode() }

    /// `fmi2ExitInitializationMode`
    exit_initialization_mode(instance) as ExitInitializationMode { instance.exit_initialization_mode() }

    /// `fmi2Terminate`
    terminate(instance) as Terminate { instance.terminate(); Ok(()) }

    /// `fmi2Reset`
    reset(instance) as Reset { instance.reset(); Ok(()) }

    /// `fmi2GetReal`
    get_real(instance, vr: *const ValueReference, count: usize, value: *mut f64) as GetReal {
        apart(array(value, count, "value")?, [array(vr, count, "vr")?])?;
        instance.get_real(slice(vr, count, "vr")?, slice_mut(value, count, "value")?)
    }

    /// `fmi2GetInteger`
    get_integer(instance, vr: *const ValueReference, count: usize, value: *mut c_int) as GetInteger {
        apart(array(value, count, "value")?, [array(vr, count, "vr")?])?;
        instance.get_integer(slice(vr, count, "vr")?, slice_mut(value, count, "value")?)
    }

    /// `fmi2GetBoolean`
    get_boolean(instance, vr: *const ValueReference, count: usize, value: *mut Boolean) as GetBoolean {
        apart(array(value, count, "value")?, [array(vr, count, "vr")?])?;
        instance.get_boolean(slice(vr, count, "vr")?, slice_mut(value, count, "value")?)
    }

    /// `fmi2GetString`
    get_string(instance, vr: *const ValueReference, count: usize, _value: *mut *const c_char) as GetString {
        instance.no_strings(slice(vr, count, "vr")?)
    }

    /// `fmi2SetReal`
    set_real(instance, vr: *const ValueReference, count: usize, value: *const f64) as SetReal {
        instance.set_real(slice(vr, count, "vr")?, slice(value, count, "value")?)
    }

    /// `fmi2SetInteger`
    set_integer(instance, vr: *const ValueReference, count: usize, value: *const c_int) as SetInteger {
        instance.set_integer(slice(vr, count, "vr")?, slice(value, count, "value")?)
    }

    /// `fmi2SetBoolean`
    set_boolean(instance, vr: *const ValueReference, count: usize, value: *const Boolean) as SetBoolean {
        instance.set_boolean(slice(vr, count, "vr")?, slice(value, count, "value")?)
    }

    /// `fmi2SetString`
    set_string(instance, vr: *const ValueReference, count: usize, _value: *const *const c_char) as SetString {
        instance.no_strings(slice(vr, count, "vr")?)
    }

    /// `fmi2GetFMUstate`
    get_fmu_state(instance, state: *mut FmuState) as GetFmuState {
        let state = target(state, "FMUstate")?;
        *state = instance.get_fmu_state(*state)?;
        Ok(())
    }

    /// `fmi2SetFMUstate`
    set_fmu_state(instance, state: FmuState) as SetFmuState { instance.set_fmu_state(state) }

    /// `fmi2FreeFMUstate`; ignores null.
    free_fmu_state(instance, state: *mut FmuState) as FreeFmuState {
        if state.is_null() {
            return Ok(());
        }
        let state = target(state, "FMUstate")?;
        if state.is_null() {
            return Ok(());
        }
        instance.free_fmu_state(*state)?;
        *state = std::ptr::null_mut();
        Ok(())
    }

    /// `fmi2SerializedFMUstateSize`
    serialized_fmu_state_size(instance, state: FmuState, size: *mut usize) as SerializedFmuStateSize {
        *target(size, "size")? = instance.serialize(state)?.len();
        Ok(())
    }

    /// `fmi2SerializeFMUstate`; `size` is what `fmi2SerializedFMUstateSize` said.
    serialize_fmu_state(instance, state: FmuState, bytes: *mut u8, size: usize) as SerializeFmuState {
        let serialized = instance.serialize(state)?;
        if size != serialized.len() {
            return Err(CallError::Refused(format!("the state takes {} bytes, not {size}", serialized.len())));
        }
        slice_mut(bytes, size, "serializedState")?.copy_from_slice(&serialized);
        Ok(())
    }

    /// `fmi2DeSerializeFMUstate`
    deserialize_fmu_state(instance, bytes: *const u8, size: usize, state: *mut FmuState) as DeSerializeFmuState {
        target(state, "FMUstate")?;
        let bytes = slice(bytes, size, "serializedState")?;
        *target(state, "FMUstate")? = instance.deserialize(bytes)?;
        Ok(())
    }

    /// `fmi2GetDirectionalDerivative`
    get_directional_derivative(
        instance, unknowns: *const ValueReference, unknown_count: usize, knowns: *const ValueReference, known_count: usize,
        seed: *const f64, derivative: *mut f64
    ) as GetDirectionalDerivative {
        let results = array(derivative, unknown_count, "dvUnknown")?;
        let arguments = [
            array(unknowns, unknown_count, "vUnknown_ref")?,
            array(knowns, known_count, "vKnown_ref")?,
            array(seed, known_count, "dvKnown")?,
        ];
        apart(results, arguments)?;
        instance.get_directional_derivative(
            slice(unknowns, unknown_count, "vUnknown_ref")?,
            slice(knowns, known_count, "vKnown_ref")?,
            slice(seed, known_count, "dvKnown")?,
            slice_mut(derivative, unknown_count, "dvUnknown")?,
        )
    }

    /// `fmi2EnterEventMode`
    enter_event_mode(instance) as EnterEventMode { instance.enter_event_mode(); Ok(()) }

    /// `fmi2NewDiscreteStates`
    new_discrete_states(instance, event_info: *mut EventInfo) as NewDiscreteStates {
        let event_info = target(event_info, "eventInfo")?;
        *event_info = instance.new_discrete_states()?;
        Ok(())
    }

    /// `fmi2EnterContinuousTimeMode`
    enter_continuous_time_mode(instance) as EnterContinuousTimeMode { instance.enter_continuous_time_mode(); Ok(()) }

    /// `fmi2CompletedIntegratorStep`; no model asks for an event or the end there.
    completed_integrator_step(
        _instance, _no_set_fmu_state: Boolean, enter_event_mode: *mut Boolean, terminate: *mut Boolean
    ) as CompletedIntegratorStep {
        target(terminate, "terminateSimulation")?;
        *target(enter_event_mode, "enterEventMode")? = FALSE;
        *target(terminate, "terminateSimulation")? = FALSE;
        Ok(())
    }

    /// `fmi2SetTime`
    set_time(instance, time: f64) as SetTime { instance.set_time(time) }

    /// `fmi2SetContinuousStates`
    set_continuous_states(instance, states: *const f64, count: usize) as SetContinuousStates {
        instance.set_continuous_states(slice(states, count, "x")?)
    }

    /// `fmi2GetEventIndicators`
    get_event_indicators(instance, indicators: *mut f64, count: usize) as GetEventIndicators {
        instance.get_event_indicators(slice(indicators, count, "eventIndicators")?)
    }

    /// `fmi2GetContinuousStates`
    get_continuous_states(instance, states: *mut f64, count: usize) as GetContinuousStates {
        instance.get_continuous_states(slice_mut(states, count, "x")?)
    }

    /// `fmi2GetDerivatives`
    get_derivatives(instance, derivatives: *mut f64, count: usize) as GetDerivatives {
        instance.get_derivatives(slice_mut(derivatives, count, "derivatives")?)
    }

    /// `fmi2GetNominalsOfContinuousStates`
    get_nominals_of_continuous_states(instance, nominals: *mut f64, count: usize) as GetNominalsOfContinuousStates {
        instance.get_nominals(slice_mut(nominals, count, "x_nominal")?)
    }

    /// `fmi2SetRealInputDerivatives`
    set_real_input_derivatives(
        instance, vr: *const ValueReference, count: usize, order: *const c_int, value: *const f64
    ) as SetRealInputDerivatives {
        instance.set_real_input_derivatives(
            slice(vr, count, "vr")?,
            slice(order, count, "order")?,
            slice(value, count, "value")?,
        )
    }

    /// `fmi2GetRealOutputDerivatives`
    get_real_output_derivatives(
        instance, vr: *const ValueReference, count: usize, order: *const c_int, value: *mut f64
    ) as GetRealOutputDerivatives {
        apart(array(value, count, "value")?, [array(vr, count, "vr")?, array(order, count, "order")?])?;
        instance.get_real_output_derivatives(
            slice(vr, count, "vr")?,
            slice(order, count, "order")?,
            slice_mut(value, count, "value")?,
        )
    }

    /// `fmi2DoStep`; nothing is kept that `noSetFMUStatePriorToCurrentPoint` would allow to drop.
    do_step(instance, point: f64, step: f64, _no_set_fmu_state: Boolean) as DoStep { instance.do_step(point, step) }

    /// `fmi2CancelStep`: never legal, since no step is ever pending.
    cancel_step(_instance) as CancelStep { Ok(()) }

    /// `fmi2GetStatus`
    get_status(_instance, kind: c_int, _value: *mut c_int) as GetStatus { Err(no_such_status(kind)) }

    /// `fmi2GetRealStatus`
    get_real_status(instance, kind: c_int, value: *mut f64) as GetRealStatus {
        *target(value, "value")? = instance.get_real_status(kind)?;
        Ok(())
    }

    /// `fmi2GetIntegerStatus`
    get_integer_status(_instance, kind: c_int, _value: *mut c_int) as GetIntegerStatus { Err(no_such_status(kind)) }

    /// `fmi2GetBooleanStatus`
    get_boolean_status(instance, kind: c_int, value: *mut Boolean) as GetBooleanStatus {
        let terminated = instance.get_boolean_status(kind)?;
        *target(value, "value")? = if terminated { TRUE } else { FALSE };
        Ok(())
    }

    /// `fmi2GetStringStatus`
    get_string_status(_instance, kind: c_int, _value: *mut *const c_char) as GetStringStatus { Err(no_such_status(kind)) }
}
