//! Hosts that break the rules of section 2.1: calls from within the logger or on a busy instance,
//! components of another FMU, lying sizes, overlapping arrays, a logger that unwinds.

use std::cell::{Cell, RefCell};
use std::ffi::{CString, c_char, c_int, c_void};
use std::ptr;

use rps3::fmi2::types::{CallbackFunctions, Component, LoggerCallback, Status};
use rps3::fmi2::{Lasting, Layout, Model, api};
use rps3::models::{Controller, Plant};

use crate::host::{CoSimulation, Host, ModelExchange, call};
use crate::toy::{GUID, real, trouble};
use crate::*;

type Logger =
    unsafe extern "C-unwind" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, *const c_char);

/// An instance of the toy model with a logger and its environment.
fn instance(logger: Logger, environment: *mut c_void, guid: &str) -> Component {
    // SAFETY: as in `host::callbacks`.
    let logger = unsafe { std::mem::transmute::<Logger, LoggerCallback>(logger) };
    let callbacks = CallbackFunctions {
        logger: Some(logger),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: environment,
    };
    let guid = CString::new(guid).unwrap();
    call!(fmi2Instantiate(c"toy".as_ptr(), CoSimulation as c_int, guid.as_ptr(), ptr::null(), &callbacks, 0, 1))
}

fn initialize(c: Component) -> [Status; 3] {
    [
        call!(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0)),
        call!(fmi2EnterInitializationMode(c)),
        call!(fmi2ExitInitializationMode(c)),
    ]
}

/// What a logger that calls back needs and finds.
#[derive(Default)]
struct Meddler {
    component: Cell<Component>,
    other: Cell<Component>,
    statuses: RefCell<Vec<Status>>,
    of_other: Cell<Option<Status>>,
}

/// # Safety
/// As the FMI logger; `environment` is a `Meddler`.
unsafe extern "C-unwind" fn meddle(
    environment: *mut c_void,
    _: *const c_char,
    _: c_int,
    _: *const c_char,
    _: *const c_char,
    _: *const c_char,
) {
    // SAFETY: the host's own environment.
    let meddler = unsafe { &*environment.cast::<Meddler>() };
    let c = meddler.component.get();
    let (mut value, mut state) = (0.0, ptr::null_mut());
    meddler.statuses.borrow_mut().extend([
        call!(fmi2GetReal(c, &real::X, 1, &mut value)),
        call!(fmi2DoStep(c, 0.0, 0.01, 1)),
        call!(fmi2Reset(c)),
        call!(fmi2GetFMUstate(c, &mut state)),
    ]);
    call!(fmi2FreeInstance(c));
    meddler.of_other.set(Some(call!(fmi2GetReal(meddler.other.get(), &real::X, 1, &mut value))));
}

#[test]
fn a_logger_that_calls_back_is_refused_and_frees_nothing() {
    let meddler = Box::new(Meddler::default());
    let environment = ptr::from_ref(&*meddler).cast_mut().cast();
    let other = Host::initialized(CoSimulation);
    let c = instance(meddle, environment, GUID);
    meddler.component.set(c);
    meddler.other.set(other.c);
    let (reference, warning) = (crate::toy::integer::TROUBLE, trouble::WARNING);
    assert_eq!(call!(fmi2SetInteger(c, &reference, 1, &warning)), Status::Ok);
    assert_eq!(initialize(c), [Status::Ok; 3], "in whose last the model warns");
    assert!(!meddler.statuses.borrow().is_empty());
    assert!(meddler.statuses.borrow().iter().all(|status| *status == Status::Error), "{:?}", meddler.statuses);
    assert_eq!(meddler.of_other.get(), Some(Status::Ok), "another instance is free");
    assert_eq!(call!(fmi2DoStep(c, 0.0, 0.01, 1)), Status::Ok, "it still lives");
    call!(fmi2FreeInstance(c));
}

/// # Safety
/// As the FMI logger.
unsafe extern "C-unwind" fn unwind(
    _: *mut c_void,
    _: *const c_char,
    _: c_int,
    _: *const c_char,
    _: *const c_char,
    _: *const c_char,
) {
    panic!("the logger has enough");
}

#[test]
fn a_logger_that_unwinds_ends_the_instance_and_not_the_host() {
    let c = instance(unwind, ptr::null_mut(), GUID);
    assert_eq!(call!(fmi2DoStep(c, 0.0, 0.01, 1)), Status::Fatal, "the refusal is logged");
    assert_eq!(call!(fmi2Reset(c)), Status::Fatal);
    call!(fmi2FreeInstance(c));
    assert!(instance(unwind, ptr::null_mut(), "wrong").is_null());
}

#[test]
fn two_threads_on_one_instance_get_errors_and_no_race() {
    let host = Host::initialized(CoSimulation);
    call!(fmi2SetDebugLogging(host.c, 0, 0, ptr::null())); // the messages are one thread's
    let c = host.c.expose_provenance();
    let done: Vec<usize> = std::thread::scope(|scope| {
        let work = move || {
            let c: Component = ptr::with_exposed_provenance_mut(c);
            let set = |k| call!(fmi2SetReal(c, &real::U, 1, &f64::from(k)));
            (0..10_000).map(set).filter(|status| *status == Status::Ok).count()
        };
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(work)).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert!(done.iter().sum::<usize>() > 0);
    assert_eq!(host.step(0.0, 0.01), Status::Ok);
}

fn component<M: Model>(layout: &'static Lasting<Layout>) -> Component {
    let guid = CString::new(M::guid()).unwrap();
    // SAFETY: C strings, no callbacks.
    unsafe { api::instantiate::<M>(c"other".as_ptr(), CoSimulation as c_int, guid.as_ptr(), ptr::null(), 0, layout) }
}

#[test]
fn a_component_of_another_model_is_refused() {
    static LAYOUTS: [Lasting<Layout>; 2] = [Lasting::new(), Lasting::new()];
    let (plant, controller) = (component::<Plant>(&LAYOUTS[0]), component::<Controller>(&LAYOUTS[1]));
    // SAFETY: they live, and are freed by their own models in the end.
    unsafe {
        assert_eq!(api::setup_experiment::<Controller>(plant, 0, 0.0, 0.0, 0, 0.0), Status::Error);
        assert_eq!(api::setup_experiment::<Plant>(controller, 0, 0.0, 0.0, 0, 0.0), Status::Error);
        api::free_instance::<Controller>(plant);
        api::free_instance::<Plant>(controller);
        assert_eq!(api::setup_experiment::<Plant>(plant, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
        assert_eq!(api::setup_experiment::<Controller>(controller, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
        api::free_instance::<Plant>(plant);
        api::free_instance::<Controller>(controller);
    }
}

#[test]
fn what_is_no_component_is_refused() {
    let zeros = [0_u64; 64];
    let wild: [Component; 3] = [
        ptr::null_mut(),
        ptr::from_ref(&zeros).cast_mut().cast(),
        ptr::from_ref(&zeros).cast::<u8>().wrapping_add(1).cast_mut().cast(),
    ];
    for c in wild {
        assert_eq!(call!(fmi2Terminate(c)), Status::Error);
        call!(fmi2FreeInstance(c));
    }
}

#[test]
fn impossible_sizes_and_null_arrays_are_refused_and_no_element_is_none() {
    let host = Host::initialized(CoSimulation);
    let (reference, mut value, mut integer) = (real::U, 7.0, 7);
    for n in [usize::MAX, usize::MAX / 4, isize::MAX as usize / 2] {
        assert_eq!(call!(fmi2GetReal(host.c, &reference, n, &mut value)), Status::Error);
        assert_eq!(call!(fmi2SetReal(host.c, &reference, n, &value)), Status::Error);
        assert_eq!(call!(fmi2GetInteger(host.c, &reference, n, &mut integer)), Status::Error);
        assert_eq!(call!(fmi2SetBoolean(host.c, &reference, n, &integer)), Status::Error);
        assert_eq!(call!(fmi2SetDebugLogging(host.c, 1, n, &c"logAll".as_ptr())), Status::Error);
        let (mut state, byte) = (ptr::null_mut(), 0);
        assert_eq!(call!(fmi2DeSerializeFMUstate(host.c, &byte, n, &mut state)), Status::Error);
        assert!(state.is_null());
    }
    assert_eq!(call!(fmi2GetReal(host.c, ptr::null(), 1, &mut value)), Status::Error);
    assert_eq!(call!(fmi2GetReal(host.c, &reference, 1, ptr::null_mut())), Status::Error);
    assert_eq!(call!(fmi2SetReal(host.c, &reference, 1, ptr::null())), Status::Error);
    assert_eq!(call!(fmi2GetReal(host.c, ptr::null(), 0, ptr::null_mut())), Status::Ok);
    assert_eq!(call!(fmi2SetReal(host.c, ptr::null(), 0, ptr::null())), Status::Ok);
    assert_eq!(value, 7.0);
}

#[test]
fn a_length_beyond_the_bytes_of_a_state_does_not_reach_beyond_them() {
    // the header tells the true length, which is compared before anything after it is read
    let host = Host::initialized(CoSimulation);
    let bytes = host.serialize(host.state());
    let mut state = ptr::null_mut();
    for more in [1, 4096, 1 << 40] {
        assert_eq!(
            call!(fmi2DeSerializeFMUstate(host.c, bytes.as_ptr(), bytes.len() + more, &mut state)),
            Status::Error
        );
    }
}

#[test]
fn results_over_arguments_are_refused() {
    let host = Host::initialized(ModelExchange);
    let mut buffer = [real::U, real::X, real::U, real::X];
    let (references, results) = (buffer.as_ptr(), buffer.as_mut_ptr());
    // 8-aligned or not, both are errors
    assert_eq!(call!(fmi2GetReal(host.c, references, 2, results.cast())), Status::Error);
    assert_eq!(call!(fmi2GetInteger(host.c, references, 2, results.wrapping_add(1).cast())), Status::Error);
    assert_eq!(buffer, [real::U, real::X, real::U, real::X]);
    let mut seed = [1.0];
    let in_place = seed.as_mut_ptr();
    let status = call!(fmi2GetDirectionalDerivative(host.c, &real::A, 1, &real::X, 1, in_place, in_place));
    assert_eq!((status, seed), (Status::Error, [1.0]));
    assert!(host.take_messages().last().unwrap().text.contains("dvUnknown and dvKnown overlap"));
}

#[test]
fn names_need_not_be_unicode() {
    let messages = crate::host::Messages::default();
    let callbacks = CallbackFunctions { logger: None, ..crate::host::callbacks(&messages) };
    let (name, guid) = (c"\xff\xfe %s %n", CString::new(GUID).unwrap());
    let kind = CoSimulation as c_int;
    let c = call!(fmi2Instantiate(name.as_ptr(), kind, guid.as_ptr(), ptr::null(), &callbacks, 0, 1));
    assert!(!c.is_null());
    assert_eq!(call!(fmi2SetDebugLogging(c, 1, 1, &c"\xff".as_ptr())), Status::Error);
    assert_eq!(call!(fmi2SetString(c, &0, 1, &c"\xff".as_ptr())), Status::Error);
    call!(fmi2FreeInstance(c));
    let wrong = c"\xff\xfe";
    assert!(call!(fmi2Instantiate(name.as_ptr(), kind, wrong.as_ptr(), ptr::null(), &callbacks, 0, 1)).is_null());
}
