//! Instantiation, experiment, initialization, reset (sections 2.1.5, 2.1.6).

use std::ffi::c_int;
use std::ptr;

use rps3::fmi2::types::{Interface, Status};

use crate::host::{CoSimulation, Host, Messages, ModelExchange, call, callbacks, instantiate};
use crate::toy::{GUID, integer, real, trouble};
use crate::*;

#[test]
fn version_and_platform_are_those_of_the_standard() {
    // SAFETY: both return static C strings.
    unsafe {
        assert_eq!(std::ffi::CStr::from_ptr(fmi2GetVersion()), c"2.0");
        assert_eq!(std::ffi::CStr::from_ptr(fmi2GetTypesPlatform()), c"default");
    }
}

#[test]
fn instantiate_returns_null_and_logs_why() {
    let kind = CoSimulation as c_int;
    for (name, fmu_type, guid, reason) in [
        (None, kind, Some(GUID), "instance name"),
        (Some(""), kind, Some(GUID), "instance name"),
        (Some(" \t\n"), kind, Some(GUID), "instance name"),
        (Some("toy"), kind, None, "GUID"),
        (Some("toy"), kind, Some(""), "GUID"),
        (Some("toy"), kind, Some("{00000000-0000-4000-8000-000000000002}"), "GUID"),
        (Some("toy"), 2, Some(GUID), "fmuType"),
        (Some("toy"), -1, Some(GUID), "fmuType"),
    ] {
        let messages = Messages::default();
        assert!(instantiate(name, fmu_type, guid, &messages, false).is_null());
        let messages = messages.0.take();
        assert_eq!(messages.len(), 1);
        assert!(messages[0].text.contains(reason), "{messages:?}");
        assert_eq!((messages[0].status, messages[0].category.as_str()), (3, "logStatusError"));
    }
}

#[test]
fn any_resource_location_is_accepted() {
    let messages = Messages::default();
    let functions = callbacks(&messages);
    let guid = std::ffi::CString::new(GUID).unwrap();
    for location in
        [c"file:///x", c"file:/x", c"file:////x/", c"file:///a%20b/resources", c"", c"\xff", c"http://x/y", c"no uri"]
    {
        let name = c"toy".as_ptr();
        let c = call!(fmi2Instantiate(name, 1, guid.as_ptr(), location.as_ptr(), &functions, 1, 1));
        assert!(!c.is_null());
        call!(fmi2FreeInstance(c));
    }
}

#[test]
fn the_instance_name_may_be_a_path_or_no_utf_8() {
    let messages = Messages::default();
    for name in ["/tmp/x.fmu", "C:\\x\\y", "a.b[1]", "%s%n", "日本"] {
        let c = instantiate(Some(name), 0, Some(GUID), &messages, true);
        assert!(!c.is_null());
        call!(fmi2FreeInstance(c));
    }
    let guid = std::ffi::CString::new(GUID).unwrap();
    let c = call!(fmi2Instantiate(c"\xff\xfe".as_ptr(), 1, guid.as_ptr(), ptr::null(), ptr::null(), 0, 0));
    assert!(!c.is_null());
    call!(fmi2FreeInstance(c));
}

#[test]
fn everything_that_instantiate_is_given_is_copied() {
    let messages = Messages::default();
    let mut functions = callbacks(&messages);
    let mut name = *b"toy\0";
    let mut guid = std::ffi::CString::new(GUID).unwrap().into_bytes_with_nul();
    let c = call!(fmi2Instantiate(name.as_ptr().cast(), 1, guid.as_ptr().cast(), ptr::null(), &functions, 0, 1));
    functions.logger = None;
    functions.component_environment = ptr::null_mut();
    std::hint::black_box((&functions, name.as_mut_slice().fill(b'z'), guid.as_mut_slice().fill(b'z')));
    assert_eq!(call!(fmi2EnterInitializationMode(c)), Status::Error);
    assert_eq!(messages.0.borrow()[0].instance, "toy");
    call!(fmi2FreeInstance(c));
}

#[test]
fn freeing_null_is_no_op() {
    call!(fmi2FreeInstance(ptr::null_mut()));
}

#[test]
fn callbacks_may_be_null() {
    let messages = Messages::default();
    let mut functions = callbacks(&messages);
    functions.logger = None;
    let guid = std::ffi::CString::new(GUID).unwrap();
    for functions in [&raw const functions, ptr::null()] {
        let c = call!(fmi2Instantiate(c"toy".as_ptr(), 1, guid.as_ptr(), ptr::null(), functions, 0, 1));
        assert!(!c.is_null());
        assert_eq!(call!(fmi2EnterInitializationMode(c)), Status::Error, "an error without a logger");
        call!(fmi2FreeInstance(c));
    }
}

#[test]
fn setup_experiment_comes_before_initialization() {
    let host = Host::new(CoSimulation);
    assert_eq!(call!(fmi2EnterInitializationMode(host.c)), Status::Error);
    assert_eq!(host.setup(0.0, None), Status::Ok);
    assert_eq!(call!(fmi2EnterInitializationMode(host.c)), Status::Ok);
}

#[test]
fn setup_experiment_refuses_what_is_no_experiment() {
    let host = Host::new(CoSimulation);
    for start in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -1e308] {
        assert_eq!(host.setup(start, None), Status::Error, "start {start}");
    }
    for stop in [f64::NAN, f64::INFINITY, 1.0, 0.5, -1.0] {
        assert_eq!(host.setup(1.0, Some(stop)), Status::Error, "stop {stop}");
    }
    for tolerance in [f64::NAN, f64::INFINITY, 0.0, -1e-6] {
        assert_eq!(call!(fmi2SetupExperiment(host.c, 1, tolerance, 0.0, 0, 0.0)), Status::Error);
    }
    let undefined = call!(fmi2SetupExperiment(host.c, 0, f64::NAN, 0.0, 0, f64::NAN));
    assert_eq!(undefined, Status::Ok, "undefined arguments are meaningless (2.1.6)");
}

#[test]
fn the_independent_variable_is_readable_and_begins_at_the_start_time() {
    let host = Host::new(CoSimulation);
    assert_eq!(host.setup(5.0, None), Status::Ok);
    assert_eq!(call!(fmi2EnterInitializationMode(host.c)), Status::Ok);
    assert_eq!(host.real(real::TIME), 5.0);
    assert_eq!(call!(fmi2ExitInitializationMode(host.c)), Status::Ok);
    assert_eq!(host.step(5.0, 0.25), Status::Ok);
    assert_eq!(host.real(real::TIME), 5.25);
}

#[test]
fn start_values_are_those_of_the_description_after_instantiation_and_reset() {
    for interface in [ModelExchange, CoSimulation] {
        let fresh = Host::initialized(interface).fingerprint();
        let host = Host::new(interface);
        host.set_real(real::K, 9.0);
        host.set_real(real::X_START, -3.0);
        host.set_integer(integer::SELECTOR, 3);
        host.initialize();
        if interface == CoSimulation {
            host.step(0.0, 0.1);
        }
        assert_ne!(host.fingerprint(), fresh);
        assert_eq!(call!(fmi2Reset(host.c)), Status::Ok);
        host.initialize();
        assert_eq!(host.fingerprint(), fresh);
    }
}

#[test]
fn bad_parameters_end_initialization_with_a_logged_error_and_reset_leads_out() {
    for interface in [Interface::ModelExchange, Interface::CoSimulation] {
        let host = Host::with_logging(interface, false);
        host.trouble(trouble::BAD_PARAMETERS);
        host.setup(0.0, None);
        assert_eq!(call!(fmi2EnterInitializationMode(host.c)), Status::Ok);
        assert_eq!(call!(fmi2ExitInitializationMode(host.c)), Status::Error);
        let messages = host.take_messages();
        assert_eq!(messages.len(), 1);
        assert_eq!(messages[0].text, "fmi2ExitInitializationMode: these parameters make no oscillator");
        assert_eq!(call!(fmi2ExitInitializationMode(host.c)), Status::Error, "the instance is in state error");
        assert_eq!(call!(fmi2Reset(host.c)), Status::Ok);
        host.initialize();
    }
}

#[test]
fn values_stay_readable_after_terminate() {
    let host = Host::initialized(CoSimulation);
    assert_eq!(host.step(0.0, 0.5), Status::Ok);
    let x = host.real(real::X);
    assert_eq!(call!(fmi2Terminate(host.c)), Status::Ok);
    assert_eq!(host.real(real::X), x);
    assert_eq!(host.real(real::TIME), 0.5);
}

#[test]
fn after_an_error_reset_and_set_fmu_state_lead_out() {
    let host = Host::initialized(CoSimulation);
    let state = host.state();
    let expected = host.fingerprint();
    for way_out in [false, true] {
        host.trouble(trouble::ERROR);
        assert_eq!(host.step(host.real(real::TIME), 0.1), Status::Error);
        assert_eq!(host.step(0.0, 0.1), Status::Error);
        assert_eq!(host.set_real(real::U, 1.0), Status::Error);
        if way_out {
            assert_eq!(call!(fmi2Reset(host.c)), Status::Ok);
            host.initialize();
        } else {
            assert_eq!(call!(fmi2SetFMUstate(host.c, state)), Status::Ok);
        }
        assert_eq!(host.fingerprint(), expected);
        assert_eq!(host.step(0.0, 0.1), Status::Ok);
        call!(fmi2SetFMUstate(host.c, state));
    }
}
