//! The call tables of sections 3.2.3 and 4.2.4, row by row.

use std::ptr;

use rps3::fmi2::types::{Interface, Status};

use crate::host::{CoSimulation, Host, ModelExchange, call};
use crate::toy::{real, trouble};
use crate::*;

/// Calls a function with arguments that are harmless wherever it is legal.
type Call = fn(&Host) -> Status;

/// The standard's rows: function, legal modes of Model Exchange (instantiated, initialization,
/// event, continuous time, terminated, error) and of Co-Simulation (instantiated, initialization,
/// stepComplete, stepFailed, terminated, error).
const ROWS: [(&str, &str, &str, Call); 40] = [
    ("fmi2SetDebugLogging", "xxxxxx", "xxxxxx", |h| call!(fmi2SetDebugLogging(h.c, 1, 0, ptr::null()))),
    ("fmi2SetupExperiment", "x.....", "x.....", |h| h.setup(0.0, None)),
    ("fmi2EnterInitializationMode", "x.....", "x.....", |h| call!(fmi2EnterInitializationMode(h.c))),
    ("fmi2ExitInitializationMode", ".x....", ".x....", |h| call!(fmi2ExitInitializationMode(h.c))),
    ("fmi2Terminate", "..xx..", "..xx..", |h| call!(fmi2Terminate(h.c))),
    ("fmi2Reset", "xxxxxx", "xxxxxx", |h| call!(fmi2Reset(h.c))),
    ("fmi2GetReal", ".xxxxx", ".xxxxx", |h| h.get_real(real::TIME).0),
    ("fmi2GetInteger", ".xxxxx", ".xxxxx", |h| call!(fmi2GetInteger(h.c, ptr::null(), 0, ptr::null_mut()))),
    ("fmi2GetBoolean", ".xxxxx", ".xxxxx", |h| call!(fmi2GetBoolean(h.c, ptr::null(), 0, ptr::null_mut()))),
    ("fmi2GetString", ".xxxxx", ".xxxxx", |h| call!(fmi2GetString(h.c, ptr::null(), 0, ptr::null_mut()))),
    ("fmi2SetReal", "xxxx..", "xxx...", |h| call!(fmi2SetReal(h.c, ptr::null(), 0, ptr::null()))),
    ("fmi2SetInteger", "xxx...", "xxx...", |h| call!(fmi2SetInteger(h.c, ptr::null(), 0, ptr::null()))),
    ("fmi2SetBoolean", "xxx...", "xxx...", |h| call!(fmi2SetBoolean(h.c, ptr::null(), 0, ptr::null()))),
    ("fmi2SetString", "xxx...", "xxx...", |h| call!(fmi2SetString(h.c, ptr::null(), 0, ptr::null()))),
    ("fmi2GetFMUstate", "xxxxxx", "xxxxxx", |h| call!(fmi2GetFMUstate(h.c, &mut ptr::null_mut()))),
    ("fmi2SetFMUstate", "xxxxxx", "xxxxxx", |h| call!(fmi2SetFMUstate(h.c, ptr::null_mut()))),
    ("fmi2FreeFMUstate", "xxxxxx", "xxxxxx", |h| call!(fmi2FreeFMUstate(h.c, &mut ptr::null_mut()))),
    ("fmi2SerializedFMUstateSize", "xxxxxx", "xxxxxx", |h| {
        call!(fmi2SerializedFMUstateSize(h.c, ptr::null_mut(), &mut 0))
    }),
    ("fmi2SerializeFMUstate", "xxxxxx", "xxxxxx", |h| {
        call!(fmi2SerializeFMUstate(h.c, ptr::null_mut(), ptr::null_mut(), 0))
    }),
    ("fmi2DeSerializeFMUstate", "xxxxxx", "xxxxxx", |h| h.deserialize(&[]).0),
    ("fmi2GetDirectionalDerivative", ".xxxxx", ".xxxxx", |h| {
        call!(fmi2GetDirectionalDerivative(h.c, ptr::null(), 0, ptr::null(), 0, ptr::null(), ptr::null_mut()))
    }),
    ("fmi2EnterEventMode", "..xx..", "......", |h| call!(fmi2EnterEventMode(h.c))),
    ("fmi2NewDiscreteStates", "..x...", "......", |h| h.new_discrete_states().0),
    ("fmi2EnterContinuousTimeMode", "..x...", "......", |h| call!(fmi2EnterContinuousTimeMode(h.c))),
    ("fmi2CompletedIntegratorStep", "...x..", "......", |h| call!(fmi2CompletedIntegratorStep(h.c, 1, &mut 0, &mut 0))),
    // legal in Event Mode under a condition of its own, see the test below
    ("fmi2SetTime", "..xx..", "......", |h| call!(fmi2SetTime(h.c, 0.0))),
    ("fmi2SetContinuousStates", "...x..", "......", |h| call!(fmi2SetContinuousStates(h.c, [0.0; 2].as_ptr(), 2))),
    ("fmi2GetEventIndicators", ".xxxxx", "......", |h| call!(fmi2GetEventIndicators(h.c, ptr::null_mut(), 0))),
    ("fmi2GetContinuousStates", ".xxxxx", "......", |h| call!(fmi2GetContinuousStates(h.c, [0.0; 2].as_mut_ptr(), 2))),
    ("fmi2GetDerivatives", ".xxxxx", "......", |h| call!(fmi2GetDerivatives(h.c, [0.0; 2].as_mut_ptr(), 2))),
    ("fmi2GetNominalsOfContinuousStates", "xxxxxx", "......", |h| {
        call!(fmi2GetNominalsOfContinuousStates(h.c, [0.0; 2].as_mut_ptr(), 2))
    }),
    ("fmi2SetRealInputDerivatives", "......", "xxx...", |h| {
        call!(fmi2SetRealInputDerivatives(h.c, ptr::null(), 0, ptr::null(), ptr::null()))
    }),
    ("fmi2GetRealOutputDerivatives", "......", "..xxxx", |h| {
        call!(fmi2GetRealOutputDerivatives(h.c, ptr::null(), 0, ptr::null(), ptr::null_mut()))
    }),
    ("fmi2DoStep", "......", "..x...", |h| h.step(0.0, 0.01)),
    ("fmi2CancelStep", "......", "......", |h| call!(fmi2CancelStep(h.c))),
    ("fmi2GetStatus", "......", "..xxx.", |h| call!(fmi2GetStatus(h.c, 0, &mut 0))),
    ("fmi2GetRealStatus", "......", "..xxx.", |h| call!(fmi2GetRealStatus(h.c, 2, &mut 0.0))),
    ("fmi2GetIntegerStatus", "......", "..xxx.", |h| call!(fmi2GetIntegerStatus(h.c, 0, &mut 0))),
    ("fmi2GetBooleanStatus", "......", "..xxx.", |h| call!(fmi2GetBooleanStatus(h.c, 3, &mut 0))),
    ("fmi2GetStringStatus", "......", "..xxx.", |h| call!(fmi2GetStringStatus(h.c, 1, &mut ptr::null()))),
];

/// An instance in the mode of the given column.
fn in_mode(interface: Interface, column: usize) -> Host {
    if column < 2 {
        let host = Host::new(interface);
        if column == 1 {
            assert_eq!(host.setup(0.0, Some(1.0)), Status::Ok);
            assert_eq!(call!(fmi2EnterInitializationMode(host.c)), Status::Ok);
        }
        return host;
    }
    match (interface, column) {
        (_, 5) => Host::in_error(interface),
        (_, 4) => {
            let host = Host::initialized(interface);
            assert_eq!(call!(fmi2Terminate(host.c)), Status::Ok);
            host
        }
        (ModelExchange, 3) => Host::continuous(),
        (CoSimulation, 3) => {
            let host = Host::initialized(interface);
            host.trouble(trouble::DISCARD);
            assert_eq!(host.step(0.0, 0.01), Status::Discard);
            host
        }
        _ => Host::initialized(interface),
    }
}

fn refused_for_its_order(host: &Host, call: Call) -> bool {
    host.take_messages();
    let status = call(host);
    let refused = host.take_messages().iter().any(|m| m.text.contains("not allowed in"));
    assert!(!refused || status == Status::Error, "a call in the wrong order is an error, not {status:?}");
    refused
}

#[test]
fn calls_are_legal_exactly_where_the_tables_of_3_2_3_and_4_2_4_say_so() {
    for (name, model_exchange, co_simulation, call) in ROWS {
        for (interface, row) in [(ModelExchange, model_exchange), (CoSimulation, co_simulation)] {
            for (column, mark) in row.chars().enumerate() {
                let host = in_mode(interface, column);
                let refused = refused_for_its_order(&host, call);
                assert_eq!(refused, mark == '.', "{name} of {interface:?}, column {column}");
            }
        }
    }
}

#[test]
fn a_call_in_the_wrong_order_changes_nothing() {
    for (_, _, row, call) in ROWS {
        if row.chars().nth(2) == Some('.') {
            let host = Host::initialized(CoSimulation);
            let before = host.fingerprint();
            assert!(refused_for_its_order(&host, call));
            assert_eq!(host.fingerprint(), before);
            assert_eq!(host.step(0.0, 0.01), Status::Ok, "the instance goes on");
        }
    }
}

#[test]
fn after_fatal_no_function_does_anything() {
    let host = Host::initialized(CoSimulation);
    host.trouble(trouble::PANIC);
    assert_eq!(host.step(0.0, 0.01), Status::Fatal);
    for (name, _, _, call) in ROWS {
        assert_eq!(call(&host), Status::Fatal, "{name}");
    }
}

#[test]
fn time_stands_still_in_event_mode_of_a_model_with_continuous_states() {
    let host = Host::initialized(ModelExchange);
    assert_eq!(host.new_discrete_states().0, Status::Ok);
    assert_eq!(call!(fmi2SetTime(host.c, 0.0)), Status::Ok, "the time it is already");
    assert_eq!(call!(fmi2SetTime(host.c, 0.1)), Status::Error);
}

#[test]
fn a_null_component_is_an_error_of_every_function() {
    let host = std::mem::ManuallyDrop::new(Host { c: ptr::null_mut(), messages: Box::default() });
    for (name, _, _, call) in ROWS {
        assert_eq!(call(&host), Status::Error, "{name}");
    }
}
