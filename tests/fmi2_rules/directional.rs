//! Directional derivatives (section 2.1.9).

use rps3::fmi2::types::Status;

use crate::host::{CoSimulation, Host, ModelExchange, call};
use crate::toy::real;
use crate::*;

fn derivative(host: &Host, unknowns: &[u32], knowns: &[u32], seed: &[f64]) -> (Status, Vec<f64>) {
    let mut out = vec![f64::NAN; unknowns.len()];
    let status = call!(fmi2GetDirectionalDerivative(
        host.c,
        unknowns.as_ptr(),
        unknowns.len(),
        knowns.as_ptr(),
        knowns.len(),
        seed.as_ptr(),
        out.as_mut_ptr()
    ));
    (status, out)
}

#[test]
fn derivatives_along_states_and_inputs_are_those_of_the_equations() {
    for host in [Host::continuous(), Host::initialized(ModelExchange), Host::initialized(CoSimulation)] {
        let knowns = [real::X, real::V, real::U];
        let (status, out) = derivative(&host, &[real::A, real::V, real::Y], &knowns, &[1.0, 10.0, 100.0]);
        assert_eq!(status, Status::Ok, "{:?}", host.take_messages());
        assert_eq!(out, [-4.0 - 1.0 + 100.0, 10.0, 101.0]);
    }
}

#[test]
fn in_initialization_mode_parameters_are_the_knowns() {
    let host = Host::new(ModelExchange);
    host.setup(0.0, None);
    call!(fmi2EnterInitializationMode(host.c));
    let out = derivative(&host, &[real::A, real::X], &[real::X_START, real::K], &[1.0, 1.0]);
    assert_eq!(out, (Status::Ok, vec![-4.0 - 1.0, 1.0]));
    assert_eq!(derivative(&host, &[real::A], &[real::X], &[1.0]).0, Status::Error, "x is unknown there");
}

#[test]
fn unknowns_and_knowns_must_be_those_of_the_mode() {
    let host = Host::continuous();
    for (unknown, known) in [
        (real::U, real::X),    // an input is no unknown
        (real::K, real::X),    // nor is a parameter
        (real::HELD, real::X), // nor a discrete output in Continuous-Time Mode
        (real::A, real::K),    // a parameter is no known once initialized
        (real::A, real::Y),    // nor is an output that is no state
        (real::A, real::W),    // nor a discrete input in Continuous-Time Mode
        (999, real::X),
        (real::A, 999),
    ] {
        assert_eq!(derivative(&host, &[unknown], &[known], &[1.0]).0, Status::Error, "{unknown} by {known}");
    }
    let event = Host::initialized(ModelExchange);
    assert_eq!(derivative(&event, &[real::HELD], &[real::W], &[1.0]).0, Status::Ok, "both exist at events");
}

#[test]
fn the_independent_variable_is_a_known() {
    assert_eq!(derivative(&Host::continuous(), &[real::A], &[real::TIME], &[1.0]), (Status::Ok, vec![0.0]));
}

#[test]
fn empty_lists_and_seeds_that_are_not_finite() {
    let host = Host::continuous();
    assert_eq!(derivative(&host, &[], &[], &[]).0, Status::Ok);
    assert_eq!(derivative(&host, &[real::A], &[], &[]), (Status::Ok, vec![0.0]));
    assert_eq!(derivative(&host, &[real::A], &[real::X], &[f64::NAN]).0, Status::Error);
}
