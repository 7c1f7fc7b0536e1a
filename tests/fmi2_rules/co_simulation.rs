//! Co-Simulation (section 4.2).

use std::ptr;

use rps3::fmi2::types::{Status, status_kind};
use rps3::fmi2::{MAX_INPUT_DERIVATIVE_ORDER, MAX_STEP};

use crate::host::{CoSimulation, Host, call};
use crate::toy::{integer, real, trouble};
use crate::*;

fn set_derivative(host: &Host, reference: u32, order: i32, value: f64) -> Status {
    call!(fmi2SetRealInputDerivatives(host.c, &reference, 1, &order, &value))
}

fn output_derivative(host: &Host, reference: u32, order: i32) -> (Status, f64) {
    let mut value = f64::NAN;
    (call!(fmi2GetRealOutputDerivatives(host.c, &reference, 1, &order, &mut value)), value)
}

/// A free mass: x'' = u.
fn mass(u: f64) -> Host {
    let host = Host::new(CoSimulation);
    for (reference, value) in [(real::K, 0.0), (real::C, 0.0), (real::U, u), (real::X_START, 0.0)] {
        assert_eq!(host.set_real(reference, value), Status::Ok);
    }
    host.initialize();
    host
}

#[test]
fn a_step_size_must_be_positive_finite_and_not_endless() {
    let host = Host::new(CoSimulation);
    assert_eq!(host.setup(0.0, None), Status::Ok);
    assert_eq!(call!(fmi2EnterInitializationMode(host.c)), Status::Ok);
    assert_eq!(call!(fmi2ExitInitializationMode(host.c)), Status::Ok);
    let before = host.fingerprint();
    for size in [0.0, -0.01, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, 2.0 * MAX_STEP] {
        assert_eq!(host.step(0.0, size), Status::Error, "step {size}");
    }
    assert_eq!(host.fingerprint(), before);
    assert_eq!(host.step(0.0, 0.01), Status::Ok, "a refused step does no harm");
    assert_eq!(host.step(0.01, 1e-20), Status::Error, "a step that the time cannot resolve");
}

#[test]
fn the_first_communication_point_is_the_start_time() {
    let host = Host::initialized(CoSimulation);
    for point in [0.01, -0.01, f64::NAN, f64::INFINITY, 1e308] {
        assert_eq!(host.step(point, 0.01), Status::Error, "point {point}");
    }
    assert_eq!(host.step(0.0, 0.01), Status::Ok);
    assert_eq!(host.step(0.0, 0.01), Status::Error, "a step cannot be repeated without its state");
}

#[test]
fn steps_end_exactly_at_the_masters_point_plus_size() {
    let host = Host::new(CoSimulation);
    host.setup(0.3, None);
    call!(fmi2EnterInitializationMode(host.c));
    call!(fmi2ExitInitializationMode(host.c));
    for n in 0..10_000 {
        let point = 0.3 + f64::from(n) * 1e-3; // drifts by ulps against the sum of steps
        assert_eq!(host.step(point, 1e-3), Status::Ok, "step {n}");
        assert_eq!(host.real(real::TIME).to_bits(), (point + 1e-3).to_bits());
    }
    assert_eq!(host.integer(integer::TICKS), 100, "no tick is lost or gained: 0, 0.1 .. 9.9 s");
}

#[test]
fn results_do_not_depend_on_the_communication_step_beyond_the_tolerance() {
    let x = |steps: i32| {
        let host = Host::initialized(CoSimulation);
        for n in 0..steps {
            assert_eq!(host.step(f64::from(n) / f64::from(steps), 1.0 / f64::from(steps)), Status::Ok);
        }
        host.real(real::X)
    };
    assert!((x(1) - x(100)).abs() < 1e-7);
    assert!((x(7) - x(100)).abs() < 1e-7);
}

#[test]
fn the_stop_time_is_kept_but_for_rounding_and_one_small_overshoot() {
    let run = |h: f64| {
        let host = Host::initialized(CoSimulation);
        let mut time = 0.0;
        while time < 1.0 - h / 2.0 {
            assert_eq!(host.step(time, h), Status::Ok);
            time += h;
        }
        (host, time)
    };
    let (host, time) = run(1e-3); // the sum of 1000 steps is not 1
    assert_eq!(host.step(time, 1e-3), Status::Ok, "one step past the stop time");
    assert_eq!(host.step(time + 1e-3, 1e-3), Status::Error, "but no second");
    let (host, time) = run(0.25);
    assert_eq!(host.step(time, 0.25), Status::Error, "and no large one");
    assert_eq!(Host::initialized(CoSimulation).step(0.0, 10.0), Status::Error);
}

#[test]
fn after_discard_last_successful_time_and_terminated_are_served() {
    let host = Host::initialized(CoSimulation);
    assert_eq!(host.step(0.0, 0.25), Status::Ok);
    host.trouble(trouble::DISCARD);
    assert_eq!(host.step(0.25, 0.25), Status::Discard);
    let (mut time, mut terminated) = (f64::NAN, -1);
    assert_eq!(call!(fmi2GetRealStatus(host.c, status_kind::LAST_SUCCESSFUL_TIME, &mut time)), Status::Ok);
    assert_eq!(call!(fmi2GetBooleanStatus(host.c, status_kind::TERMINATED, &mut terminated)), Status::Ok);
    assert_eq!((time, terminated), (0.25, 0));
    assert_eq!(host.step(0.25, 0.25), Status::Error, "stepFailed: a step needs fmi2SetFMUstate first");
}

#[test]
fn after_discard_a_shorter_step_works_from_a_stored_state() {
    let host = Host::initialized(CoSimulation);
    let state = host.state();
    host.trouble(trouble::DISCARD);
    assert_eq!(host.step(0.0, 0.5), Status::Discard);
    assert_eq!(call!(fmi2SetFMUstate(host.c, state)), Status::Ok);
    assert_eq!(host.step(0.0, 0.25), Status::Ok);
}

#[test]
fn a_failed_step_leaves_model_and_values_as_they_were() {
    for (kind, status) in
        [(trouble::DISCARD, Status::Discard), (trouble::ERROR, Status::Error), (trouble::NAN, Status::Error)]
    {
        let host = Host::initialized(CoSimulation);
        assert_eq!(host.step(0.0, 0.15), Status::Ok);
        let before = (host.fingerprint(), output_derivative(&host, real::X, 1));
        host.trouble(kind);
        assert_eq!(host.step(0.15, 0.15), status);
        // the derivative is computed from the model, not read from the values
        assert_eq!((host.fingerprint(), output_derivative(&host, real::X, 1)), before);
    }
}

#[test]
fn no_step_succeeds_with_values_that_are_not_finite() {
    let host = Host::initialized(CoSimulation);
    host.trouble(trouble::NAN);
    assert_eq!(host.step(0.0, 0.01), Status::Error);
    assert!(host.take_messages().last().unwrap().text.contains("held is not finite"));
}

#[test]
fn asynchronous_functions_have_nothing_to_tell() {
    let host = Host::initialized(CoSimulation);
    assert_eq!(call!(fmi2CancelStep(host.c)), Status::Error);
    for kind in [0, 1, 2, 3, 4, -1] {
        assert_eq!(call!(fmi2GetStatus(host.c, kind, &mut 0)), Status::Discard);
        assert_eq!(call!(fmi2GetIntegerStatus(host.c, kind, &mut 0)), Status::Discard);
        assert_eq!(call!(fmi2GetStringStatus(host.c, kind, &mut ptr::null())), Status::Discard);
    }
    assert_eq!(call!(fmi2GetRealStatus(host.c, status_kind::TERMINATED, &mut 0.0)), Status::Discard);
    assert_eq!(call!(fmi2GetBooleanStatus(host.c, status_kind::LAST_SUCCESSFUL_TIME, &mut 0)), Status::Discard);
    assert_eq!(call!(fmi2GetRealStatus(host.c, 2, ptr::null_mut())), Status::Error);
    assert_eq!(host.step(0.0, 0.01), Status::Ok);
}

#[test]
fn a_fmu_state_rolled_back_allows_an_earlier_communication_point() {
    let host = Host::initialized(CoSimulation);
    host.step(0.0, 0.1);
    let state = host.state();
    host.step(0.1, 0.1);
    assert_eq!(host.step(0.1, 0.1), Status::Error);
    call!(fmi2SetFMUstate(host.c, state));
    assert_eq!(host.step(0.1, 0.05), Status::Ok);
}

#[test]
fn input_derivatives_are_taylor_terms_from_the_beginning_of_the_step() {
    // u = 2 + 3 t: x = t^2 + t^3 / 2, to be met by one step exactly
    let host = mass(2.0);
    assert_eq!(set_derivative(&host, real::U, 1, 3.0), Status::Ok);
    assert_eq!(host.step(0.0, 0.5), Status::Ok);
    assert!((host.real(real::X) - 0.3125).abs() < 1e-14, "{}", host.real(real::X));
    assert!((host.real(real::V) - 1.375).abs() < 1e-14);
    assert_eq!(host.real(real::U), 3.5);
}

#[test]
fn input_derivatives_hold_for_the_following_step_only() {
    let host = mass(1.0);
    set_derivative(&host, real::U, 1, 4.0);
    host.step(0.0, 0.25);
    let (v, u) = (host.real(real::V), host.real(real::U));
    assert_eq!(u, 2.0);
    host.step(0.25, 0.25);
    assert!((host.real(real::V) - v - 0.25 * u).abs() < 1e-14, "the input stays at its last value");
}

#[test]
fn second_order_input_derivatives_carry_their_factorial() {
    let host = mass(0.0);
    set_derivative(&host, real::U, 2, 6.0); // u = 3 t^2: v = t^3
    host.step(0.0, 0.5);
    assert!((host.real(real::V) - 0.125).abs() < 1e-14);
}

#[test]
fn input_derivatives_are_of_order_one_or_more_and_of_continuous_inputs() {
    let host = Host::initialized(CoSimulation);
    for order in [0, -1, i32::MIN, MAX_INPUT_DERIVATIVE_ORDER as i32 + 1] {
        assert_eq!(set_derivative(&host, real::U, order, 1.0), Status::Error, "order {order}");
    }
    for reference in [real::W, real::X, real::K, real::TIME, 999] {
        assert_eq!(set_derivative(&host, reference, 1, 1.0), Status::Error, "reference {reference}");
    }
    assert_eq!(set_derivative(&host, real::U, 1, f64::NAN), Status::Error);
    let references = [real::U, real::W];
    let refused =
        call!(fmi2SetRealInputDerivatives(host.c, references.as_ptr(), 2, [1; 2].as_ptr(), [1.0; 2].as_ptr()));
    assert_eq!(refused, Status::Error);
    assert_eq!(output_derivative(&host, real::Y, 1), (Status::Ok, 0.0), "nothing was set by a refused call");
}

#[test]
fn output_derivatives_are_rates_at_the_current_time() {
    let host = mass(1.0);
    set_derivative(&host, real::U, 1, 2.0);
    set_derivative(&host, real::U, 2, 6.0);
    assert_eq!(output_derivative(&host, real::Y, 1), (Status::Ok, 2.0), "v + du/dt at the start");
    host.step(0.0, 0.5);
    let (x_rate, y_rate) = (output_derivative(&host, real::X, 1).1, output_derivative(&host, real::Y, 1).1);
    assert_eq!(x_rate, host.real(real::V));
    assert_eq!(y_rate, x_rate + 5.0, "du/dt = 2 + 6 t at the end of the step");
}

#[test]
fn output_derivatives_above_the_order_are_zero_and_of_order_zero_illegal() {
    let host = mass(1.0);
    host.step(0.0, 0.5);
    for order in [2, 3, i32::MAX] {
        assert_eq!(output_derivative(&host, real::X, order), (Status::Ok, 0.0));
    }
    for order in [0, -1, i32::MIN] {
        assert_eq!(output_derivative(&host, real::X, order).0, Status::Error);
    }
    for reference in [real::U, real::A, real::K, real::TIME, 999] {
        assert_eq!(output_derivative(&host, reference, 1).0, Status::Error, "reference {reference}");
    }
}
