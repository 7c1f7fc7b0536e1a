//! Model Exchange (section 3.2).

use std::ptr;

use rps3::fmi2::types::{EventInfo, Status};

use crate::host::{Host, ModelExchange, call};
use crate::toy::{PERIOD, integer, real, trouble};
use crate::*;

fn states(host: &Host) -> [f64; 2] {
    let mut x = [f64::NAN; 2];
    assert_eq!(call!(fmi2GetContinuousStates(host.c, x.as_mut_ptr(), 2)), Status::Ok);
    x
}

fn derivatives(host: &Host) -> [f64; 2] {
    let mut x = [f64::NAN; 2];
    assert_eq!(call!(fmi2GetDerivatives(host.c, x.as_mut_ptr(), 2)), Status::Ok);
    x
}

#[test]
fn derivatives_are_ordered_as_the_states_are() {
    let host = Host::continuous();
    assert_eq!(call!(fmi2SetContinuousStates(host.c, [2.0, 3.0].as_ptr(), 2)), Status::Ok);
    assert_eq!(states(&host), [2.0, 3.0]);
    assert_eq!(derivatives(&host), [3.0, -4.0 * 2.0 - 0.1 * 3.0]);
    assert_eq!((host.real(real::X), host.real(real::V)), (2.0, 3.0));
}

#[test]
fn derivatives_states_and_nominals_are_readable_in_initialization_mode() {
    let host = Host::new(ModelExchange);
    host.setup(0.0, None);
    call!(fmi2EnterInitializationMode(host.c));
    host.set_real(real::X_START, 0.5);
    assert_eq!(states(&host), [0.5, 0.0]);
    assert_eq!(derivatives(&host), [0.0, -2.0]);
}

#[test]
fn nominals_are_positive() {
    let mut nominals = [f64::NAN; 2];
    let host = Host::new(ModelExchange);
    assert_eq!(call!(fmi2GetNominalsOfContinuousStates(host.c, nominals.as_mut_ptr(), 2)), Status::Ok);
    assert!(nominals.iter().all(|x| *x > 0.0));
}

#[test]
fn wrong_sizes_are_errors() {
    let host = Host::continuous();
    let mut buffer = [0.0; 3];
    for n in [0, 1, 3] {
        assert_eq!(call!(fmi2SetContinuousStates(host.c, buffer.as_ptr(), n)), Status::Error);
        assert_eq!(call!(fmi2GetContinuousStates(host.c, buffer.as_mut_ptr(), n)), Status::Error);
        assert_eq!(call!(fmi2GetDerivatives(host.c, buffer.as_mut_ptr(), n)), Status::Error);
        assert_eq!(call!(fmi2GetNominalsOfContinuousStates(host.c, buffer.as_mut_ptr(), n)), Status::Error);
    }
    assert_eq!(call!(fmi2GetEventIndicators(host.c, buffer.as_mut_ptr(), 1)), Status::Error);
    assert_eq!(call!(fmi2GetEventIndicators(host.c, ptr::null_mut(), 0)), Status::Ok);
    assert_eq!(call!(fmi2GetDerivatives(host.c, ptr::null_mut(), 2)), Status::Error);
}

#[test]
fn times_and_states_that_are_not_finite_are_refused() {
    let host = Host::continuous();
    for x in [f64::NAN, f64::INFINITY] {
        assert_eq!(call!(fmi2SetTime(host.c, x)), Status::Error);
        assert_eq!(call!(fmi2SetContinuousStates(host.c, [0.0, x].as_ptr(), 2)), Status::Error);
    }
    assert_eq!(call!(fmi2SetTime(host.c, 1e308)), Status::Error);
    assert_eq!(states(&host), [1.0, 0.0]);
    assert_eq!(host.real(real::TIME), 0.0);
}

#[test]
fn values_of_states_are_not_reported_as_changed_when_they_did_not() {
    let host = Host::initialized(ModelExchange);
    let (status, info) = host.new_discrete_states();
    assert_eq!(status, Status::Ok);
    let expected = EventInfo { next_event_time_defined: 1, next_event_time: PERIOD, ..EventInfo::default() };
    assert_eq!(info, expected);
}

#[test]
fn time_events_are_exact_and_do_not_drift_over_a_million_ticks() {
    let host = Host::new(ModelExchange);
    host.setup(0.0, None);
    call!(fmi2EnterInitializationMode(host.c));
    call!(fmi2ExitInitializationMode(host.c));
    let mut next = host.new_discrete_states().1.next_event_time;
    call!(fmi2EnterContinuousTimeMode(host.c));
    for n in 1..=1_000_000 {
        assert_eq!(next.to_bits(), (f64::from(n) * PERIOD).to_bits());
        call!(fmi2SetTime(host.c, next));
        call!(fmi2EnterEventMode(host.c));
        next = host.new_discrete_states().1.next_event_time;
        call!(fmi2EnterContinuousTimeMode(host.c));
    }
    assert_eq!(host.integer(integer::TICKS), 1_000_001);
}

#[test]
fn an_event_that_is_not_in_the_future_is_an_error() {
    let host = Host::initialized(ModelExchange);
    host.trouble(trouble::EVENT_IN_THE_PAST);
    assert_eq!(host.new_discrete_states().0, Status::Error);
}

#[test]
fn discrete_variables_change_in_event_mode_only() {
    let host = Host::continuous();
    host.set_real(real::U, 7.0);
    call!(fmi2SetTime(host.c, PERIOD));
    assert_eq!(host.real(real::HELD), 0.0);
    call!(fmi2EnterEventMode(host.c));
    assert_eq!(host.new_discrete_states().0, Status::Ok);
    assert_eq!(host.real(real::HELD), 7.0);
}

#[test]
fn going_back_in_time_and_state_gives_the_same_derivatives() {
    let host = Host::continuous();
    let before = derivatives(&host);
    call!(fmi2SetTime(host.c, 0.05));
    call!(fmi2SetContinuousStates(host.c, [5.0, 5.0].as_ptr(), 2));
    assert_ne!(derivatives(&host), before);
    call!(fmi2SetTime(host.c, 0.0));
    call!(fmi2SetContinuousStates(host.c, [1.0, 0.0].as_ptr(), 2));
    assert_eq!(derivatives(&host), before);
}

#[test]
fn completed_integrator_step_asks_for_nothing() {
    let host = Host::continuous();
    let (mut event, mut terminate) = (-1, -1);
    assert_eq!(call!(fmi2CompletedIntegratorStep(host.c, 1, &mut event, &mut terminate)), Status::Ok);
    assert_eq!((event, terminate), (0, 0));
    assert_eq!(call!(fmi2CompletedIntegratorStep(host.c, 1, ptr::null_mut(), &mut terminate)), Status::Error);
    assert_eq!(call!(fmi2CompletedIntegratorStep(host.c, 1, &mut event, ptr::null_mut())), Status::Error);
}

#[test]
fn what_cannot_be_computed_is_discarded_and_the_integrator_may_go_on() {
    for kind in [trouble::DISCARD, trouble::NAN] {
        let host = Host::initialized(ModelExchange);
        host.trouble(kind);
        assert_eq!(host.get_real(real::X).0, Status::Discard);
        assert_eq!(call!(fmi2GetDerivatives(host.c, [0.0; 2].as_mut_ptr(), 2)), Status::Discard);
        host.trouble(trouble::NONE);
        assert_eq!(host.get_real(real::X), (Status::Ok, 1.0));
    }
}

#[test]
fn integers_and_booleans_know_no_discard() {
    let host = Host::initialized(ModelExchange);
    host.trouble(trouble::DISCARD);
    assert_eq!(call!(fmi2GetInteger(host.c, &integer::TICKS, 1, &mut 0)), Status::Error);
}
