//! Random sequences of calls.

use std::ffi::{c_char, c_int};
use std::ptr;

use arbitrary::{Result, Unstructured};
use rps3::description::{Variable, VariableType};
use rps3::fmi2::api;
use rps3::fmi2::call_table::{Function, Mode, TABLE};
use rps3::fmi2::types::{EventInfo, FmuState, Interface, Status};
use rps3::models::{Controller, Plant};

use super::host::{Fmu, Host, call};
use super::numbers;

/// Calls as the bytes say on one of the FMUs, and returns how many were made.
pub fn calls(data: &[u8]) -> u64 {
    let mut u = Unstructured::new(data);
    let interface = if u.arbitrary().unwrap_or(false) { Interface::ModelExchange } else { Interface::CoSimulation };
    if u.arbitrary().unwrap_or(false) { run::<Plant>(&mut u, interface) } else { run::<Controller>(&mut u, interface) }
}

fn run<M: Fmu>(u: &mut Unstructured, interface: Interface) -> u64 {
    let mut caller = Caller::<M> { host: Host::new(interface), saved: Vec::new() };
    caller.host.quick_ticks(u);
    // most errors need an instance that runs
    if u.ratio(3, 4).unwrap_or(false) {
        caller.host.initialize(0.0);
    }
    let mut made = 0;
    while !u.is_empty() && caller.call(u).is_ok() {
        caller.host.check_mode();
        made += 1;
    }
    made
}

struct Caller<M: Fmu> {
    host: Host<M>,
    /// States handed out, with the mode that they hold.
    saved: Vec<(FmuState, Mode)>,
}

/// Sizes of arrays.
const MOST_VARIABLES: usize = 4;

impl<M: Fmu> Caller<M> {
    /// Variables of a type, now and then of another, and what to use as their references.
    fn variables(u: &mut Unstructured, wanted: VariableType) -> Result<(Vec<&'static Variable>, Vec<u32>)> {
        let all = numbers::of_type(M::definition(), wanted);
        let mut chosen = Vec::new();
        for _ in 0..u.int_in_range(0..=MOST_VARIABLES)? {
            chosen.push(*u.choose(&all)?);
        }
        let mut references: Vec<u32> = chosen.iter().map(|v| v.value_reference).collect();
        if u.ratio(1, 16)?
            && let Some(reference) = references.last_mut()
        {
            *reference = u.arbitrary()?;
        }
        Ok((chosen, references))
    }

    /// One call.
    fn call(&mut self, u: &mut Unstructured) -> Result<()> {
        let host = &mut self.host;
        // half of the calls are those that lead on
        let function = match u.int_in_range(0..=9)? {
            0 | 1 => Function::DoStep,
            2 => Function::SetReal,
            3 => Function::NewDiscreteStates,
            4 => Function::SetTime,
            _ => u.choose(&TABLE)?.function,
        };
        match function {
            Function::SetDebugLogging => {
                let names = [c"logEvents".as_ptr(), c"logAll".as_ptr(), c"nonsense".as_ptr(), ptr::null()];
                let (on, count) = (u.arbitrary()?, u.int_in_range(0..=names.len())?);
                let pointer = if u.ratio(1, 8)? { ptr::null() } else { names.as_ptr() };
                if call!(host, SetDebugLogging, set_debug_logging(on, count, pointer)) == Status::Ok {
                    host.silenced = true;
                }
            }
            Function::FreeInstance => {
                *host = Host::new(host.interface);
                // gone with their instance; their addresses may come again
                self.saved.clear();
            }
            Function::SetupExperiment => {
                let (tolerance, start, stop) = (numbers::any(u)?, numbers::any(u)?, numbers::any(u)?);
                let start = if u.arbitrary()? { 0.0 } else { start };
                let defined: [bool; 2] = u.arbitrary()?;
                let [tolerance_defined, stop_defined] = defined.map(c_int::from);
                call!(host, SetupExperiment, setup_experiment(tolerance_defined, tolerance, start, stop_defined, stop));
            }
            Function::EnterInitializationMode => {
                host.enter_initialization_mode();
            }
            Function::ExitInitializationMode => {
                host.exit_initialization_mode();
            }
            Function::Terminate => {
                if call!(host, Terminate, terminate()) == Status::Ok {
                    host.mode = Mode::Terminated;
                }
            }
            Function::Reset => {
                if call!(host, Reset, reset()) == Status::Ok {
                    host.mode = Mode::Instantiated;
                    if u.ratio(3, 4)? {
                        host.initialize(0.0);
                    }
                }
            }
            Function::GetReal => {
                let (_, references) = Self::variables(u, VariableType::Real)?;
                let mut values = [f64::NAN; MOST_VARIABLES];
                let n = references.len();
                let target = if u.ratio(1, 16)? { ptr::null_mut() } else { values.as_mut_ptr() };
                if call!(host, GetReal, get_real(references.as_ptr(), n, target)) == Status::Ok
                    && host.mode != Mode::Error
                    && !target.is_null()
                {
                    assert!(values[..n].iter().all(|x| x.is_finite()), "{values:?}");
                }
            }
            Function::GetInteger => {
                let (_, references) = Self::variables(u, VariableType::Integer)?;
                let mut values = [0; MOST_VARIABLES];
                call!(host, GetInteger, get_integer(references.as_ptr(), references.len(), values.as_mut_ptr()));
            }
            Function::GetBoolean => {
                let (_, references) = Self::variables(u, VariableType::Boolean)?;
                let mut values = [0; MOST_VARIABLES];
                call!(host, GetBoolean, get_boolean(references.as_ptr(), references.len(), values.as_mut_ptr()));
            }
            Function::GetString => {
                let (reference, n, mut value) = (u.arbitrary()?, u.int_in_range(0..=1)?, ptr::null::<c_char>());
                call!(host, GetString, get_string(&reference, n, &mut value));
            }
            Function::SetReal => {
                let (variables, references) = Self::variables(u, VariableType::Real)?;
                let mut values = Vec::new();
                for variable in variables {
                    values.push(numbers::real(u, variable)?);
                }
                let source = if u.ratio(1, 16)? { ptr::null() } else { values.as_ptr() };
                let status = call!(host, SetReal, set_real(references.as_ptr(), references.len(), source));
                if values.iter().any(|x| !x.is_finite()) {
                    assert_ne!(status, Status::Ok, "fmi2OK with {values:?}");
                }
            }
            Function::SetInteger => {
                let (variables, references) = Self::variables(u, VariableType::Integer)?;
                let mut values = Vec::new();
                for variable in variables {
                    values.push(numbers::integer(u, variable)?);
                }
                call!(host, SetInteger, set_integer(references.as_ptr(), references.len(), values.as_ptr()));
            }
            Function::SetBoolean => {
                let (_, references) = Self::variables(u, VariableType::Boolean)?;
                let values: [c_int; MOST_VARIABLES] = u.arbitrary()?;
                call!(host, SetBoolean, set_boolean(references.as_ptr(), references.len(), values.as_ptr()));
            }
            Function::SetString => {
                let (reference, n, value) = (u.arbitrary()?, u.int_in_range(0..=1)?, c"text".as_ptr());
                call!(host, SetString, set_string(&reference, n, &value));
            }
            Function::GetFmuState => {
                let mut handle = self.handle(u)?.0;
                let host = &mut self.host;
                if call!(host, GetFmuState, get_fmu_state(&mut handle)) == Status::Ok {
                    self.saved.retain(|(known, _)| *known != handle);
                    self.saved.push((handle, self.host.mode));
                }
            }
            Function::SetFmuState => {
                let (handle, mode) = self.handle(u)?;
                let host = &mut self.host;
                if call!(host, SetFmuState, set_fmu_state(handle)) == Status::Ok {
                    host.mode = mode.expect("a state that was handed out");
                }
            }
            Function::FreeFmuState => {
                let mut handle = self.handle(u)?.0;
                let freed = handle;
                let host = &mut self.host;
                if call!(host, FreeFmuState, free_fmu_state(&mut handle)) == Status::Ok {
                    assert!(handle.is_null());
                    self.saved.retain(|(known, _)| *known != freed);
                }
            }
            Function::SerializedFmuStateSize => {
                let (handle, _) = self.handle(u)?;
                let (host, mut size) = (&mut self.host, 0);
                call!(host, SerializedFmuStateSize, serialized_fmu_state_size(handle, &mut size));
            }
            Function::SerializeFmuState => {
                let (handle, _) = self.handle(u)?;
                let mut bytes = vec![0; u.int_in_range(0..=8192)?];
                let host = &mut self.host;
                call!(host, SerializeFmuState, serialize_fmu_state(handle, bytes.as_mut_ptr(), bytes.len()));
            }
            Function::DeSerializeFmuState => {
                let (mode, mut bytes) = (host.mode, host.fingerprint());
                let spoiled = u.ratio(1, 2)?;
                if spoiled {
                    let place = u.choose_index(bytes.len())?;
                    bytes[place] ^= u.int_in_range(1..=255)?;
                }
                let mut handle = ptr::null_mut();
                let (pointer, n) = (bytes.as_ptr(), bytes.len());
                let status = call!(host, DeSerializeFmuState, deserialize_fmu_state(pointer, n, &mut handle));
                assert_eq!(status == Status::Ok, !spoiled, "{status:?}");
                if status == Status::Ok {
                    self.saved.push((handle, mode));
                }
            }
            Function::GetDirectionalDerivative => {
                let (_, unknowns) = Self::variables(u, VariableType::Real)?;
                let (_, knowns) = Self::variables(u, VariableType::Real)?;
                let seed = [numbers::near(u, 1.0)?; MOST_VARIABLES];
                let mut result = [f64::NAN; MOST_VARIABLES];
                let status = call!(
                    host,
                    GetDirectionalDerivative,
                    get_directional_derivative(
                        unknowns.as_ptr(),
                        unknowns.len(),
                        knowns.as_ptr(),
                        knowns.len(),
                        seed.as_ptr(),
                        result.as_mut_ptr()
                    )
                );
                if status == Status::Ok {
                    assert!(result[..unknowns.len()].iter().all(|x| x.is_finite()), "{result:?}");
                }
            }
            Function::EnterEventMode => {
                if call!(host, EnterEventMode, enter_event_mode()) == Status::Ok {
                    host.mode = Mode::Event;
                }
            }
            Function::NewDiscreteStates => {
                let mut info = EventInfo::default();
                if call!(host, NewDiscreteStates, new_discrete_states(&mut info)) == Status::Ok {
                    assert!(info.next_event_time_defined == 0 || info.next_event_time > host.time());
                    if u.arbitrary()? {
                        assert_eq!(call!(host, EnterContinuousTimeMode, enter_continuous_time_mode()), Status::Ok);
                        host.mode = Mode::ContinuousTime;
                    }
                }
            }
            Function::EnterContinuousTimeMode => {
                if call!(host, EnterContinuousTimeMode, enter_continuous_time_mode()) == Status::Ok {
                    host.mode = Mode::ContinuousTime;
                }
            }
            Function::CompletedIntegratorStep => {
                let (mut event, mut end) = (-1, -1);
                call!(host, CompletedIntegratorStep, completed_integrator_step(0, &mut event, &mut end));
            }
            Function::SetTime => {
                let time = if u.ratio(1, 4)? { numbers::any(u)? } else { host.time() + Self::step_size(u)? };
                call!(host, SetTime, set_time(time));
            }
            Function::SetContinuousStates => {
                let n = if u.ratio(1, 8)? { u.int_in_range(0..=32)? } else { M::definition().derivatives.len() };
                let mut states = vec![0.0; n];
                // legal only in some modes; elsewhere the values stay as they are
                let host = &mut self.host;
                call!(host, GetContinuousStates, get_continuous_states(states.as_mut_ptr(), n));
                for state in &mut states {
                    *state = numbers::near(u, *state)?;
                }
                let host = &mut self.host;
                call!(host, SetContinuousStates, set_continuous_states(states.as_ptr(), n));
            }
            Function::GetEventIndicators => {
                let mut values = [0.0; 2];
                let n = u.int_in_range(0..=2)?;
                call!(host, GetEventIndicators, get_event_indicators(values.as_mut_ptr(), n));
            }
            Function::GetContinuousStates | Function::GetDerivatives | Function::GetNominalsOfContinuousStates => {
                let n = if u.ratio(1, 8)? { u.int_in_range(0..=32)? } else { M::definition().derivatives.len() };
                let mut values = vec![f64::NAN; n];
                let target = values.as_mut_ptr();
                let status = match function {
                    Function::GetContinuousStates => {
                        call!(host, GetContinuousStates, get_continuous_states(target, n))
                    }
                    Function::GetDerivatives => call!(host, GetDerivatives, get_derivatives(target, n)),
                    _ => {
                        call!(host, GetNominalsOfContinuousStates, get_nominals_of_continuous_states(target, n))
                    }
                };
                if status == Status::Ok && host.mode != Mode::Error {
                    assert!(values.iter().all(|x| x.is_finite()), "{function:?}: {values:?}");
                }
            }
            Function::SetRealInputDerivatives => {
                let (_, references) = Self::variables(u, VariableType::Real)?;
                let orders = [u.int_in_range(-1..=6)?; MOST_VARIABLES];
                let values = [numbers::near(u, 1.0)?; MOST_VARIABLES];
                let n = references.len();
                let (orders, values) = (orders.as_ptr(), values.as_ptr());
                call!(
                    host,
                    SetRealInputDerivatives,
                    set_real_input_derivatives(references.as_ptr(), n, orders, values)
                );
            }
            Function::GetRealOutputDerivatives => {
                let (_, references) = Self::variables(u, VariableType::Real)?;
                let orders = [u.int_in_range(-1..=3)?; MOST_VARIABLES];
                let mut values = [f64::NAN; MOST_VARIABLES];
                let n = references.len();
                let target = values.as_mut_ptr();
                let status = call!(
                    host,
                    GetRealOutputDerivatives,
                    get_real_output_derivatives(references.as_ptr(), n, orders.as_ptr(), target)
                );
                if status == Status::Ok {
                    assert!(values[..n].iter().all(|x| x.is_finite()), "{values:?}");
                }
            }
            Function::DoStep => {
                let point = if u.ratio(1, 16)? { numbers::any(u)? } else { host.time() };
                let size = Self::step_size(u)?;
                if u.ratio(7, 8)? {
                    host.do_step(point, size);
                } else {
                    self.step_twice(point, size);
                }
            }
            Function::CancelStep => {
                call!(host, CancelStep, cancel_step());
            }
            Function::GetStatus => {
                let (kind, mut value) = (u.int_in_range(-1..=4)?, 0);
                call!(host, GetStatus, get_status(kind, &mut value));
            }
            Function::GetRealStatus => {
                let mut value = f64::NAN;
                let kind = u.int_in_range(-1..=4)?;
                if call!(host, GetRealStatus, get_real_status(kind, &mut value)) == Status::Ok {
                    assert!(value.is_finite());
                }
            }
            Function::GetIntegerStatus => {
                let (kind, mut value) = (u.int_in_range(-1..=4)?, 0);
                call!(host, GetIntegerStatus, get_integer_status(kind, &mut value));
            }
            Function::GetBooleanStatus => {
                let (kind, mut value) = (u.int_in_range(-1..=4)?, 0);
                call!(host, GetBooleanStatus, get_boolean_status(kind, &mut value));
            }
            Function::GetStringStatus => {
                let (kind, mut value) = (u.int_in_range(-1..=4)?, ptr::null());
                call!(host, GetStringStatus, get_string_status(kind, &mut value));
            }
        }
        Ok(())
    }

    /// Steps, restores and steps again: the same bits.
    fn step_twice(&mut self, point: f64, size: f64) {
        let (host, mut state) = (&mut self.host, ptr::null_mut());
        let mode = host.mode;
        assert_eq!(call!(host, GetFmuState, get_fmu_state(&mut state)), Status::Ok);
        let outcomes = [(); 2].map(|()| {
            let outcome = (host.do_step(point, size), host.fingerprint());
            assert_eq!(call!(host, SetFmuState, set_fmu_state(state)), Status::Ok);
            host.mode = mode;
            outcome
        });
        assert!(outcomes[0] == outcomes[1], "a repeated step has another result");
        assert_eq!(call!(host, FreeFmuState, free_fmu_state(&mut state)), Status::Ok);
    }

    /// Mostly a step that a master would make; longer ones than 0.1 s only cost time.
    fn step_size(u: &mut Unstructured) -> Result<f64> {
        let usual = [1e-6, 1e-4, 1e-3, 1e-3, 1e-3, 5e-3, 0.1];
        let size = if u.ratio(7, 8)? { *u.choose(&usual)? } else { numbers::any(u)? };
        Ok(if (0.1..=100.0).contains(&size) { 0.1 } else { size })
    }

    /// A state of this instance with its mode, null, or a made-up handle.
    fn handle(&self, u: &mut Unstructured) -> Result<(FmuState, Option<Mode>)> {
        if self.saved.is_empty() || u.ratio(1, 4)? {
            return Ok((ptr::without_provenance_mut(*u.choose(&[0, 1, 8, usize::MAX])?), None));
        }
        let (handle, mode) = *u.choose(&self.saved)?;
        Ok((handle, Some(mode)))
    }
}
