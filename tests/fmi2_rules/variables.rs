//! Getting and setting variables (section 2.1.7, footnotes of 3.2.3 and 4.2.4).

use std::ptr;

use rps3::fmi2::types::{Interface, Status};

use crate::host::{CoSimulation, Host, ModelExchange, call};
use crate::toy::{boolean, integer, real};
use crate::*;

fn in_initialization(interface: Interface) -> Host {
    let host = Host::new(interface);
    host.setup(0.0, Some(1.0));
    assert_eq!(call!(fmi2EnterInitializationMode(host.c)), Status::Ok);
    host
}

/// Sets a variable to what is a legal value for all of them.
fn set(host: &Host, name: &str) -> Status {
    match name {
        "time" => host.set_real(real::TIME, 0.0),
        "u" => host.set_real(real::U, 0.0),
        "w" => host.set_real(real::W, 0.0),
        "x" => host.set_real(real::X, 0.0),
        "y" => host.set_real(real::Y, 0.0),
        "a" => host.set_real(real::A, 0.0),
        "k" => host.set_real(real::K, 0.0),
        "c" => host.set_real(real::C, 0.0),
        "gain" => host.set_real(real::GAIN, 2.0),
        "selector" => host.set_integer(integer::SELECTOR, 0),
        "trouble" => host.set_integer(integer::TROUBLE, 0),
        "ticks" => host.set_integer(integer::TICKS, 0),
        "flag" => host.set_boolean(boolean::FLAG, 0),
        _ => host.set_boolean(boolean::POSITIVE, 0),
    }
}

#[test]
fn a_variable_can_be_set_exactly_where_footnotes_1_to_6_allow_it() {
    // before and in Initialization Mode, Event Mode, Continuous-Time Mode, stepComplete
    let rows = [
        ("time", "....."),
        ("u", "xxxxx"),
        ("w", "xxx.x"),
        ("selector", "xxx.x"),
        ("flag", "xxx.x"),
        ("x", "...x."), // footnote 5: a continuous-time state
        ("y", "....."),
        ("a", "....."),
        ("ticks", "....."),
        ("positive", "....."),
        ("k", "xx..."),
        ("c", "xxx.x"),
        ("trouble", "xxx.x"),
        ("gain", "....."),
    ];
    for (name, marks) in rows {
        let hosts = [
            Host::new(ModelExchange),
            in_initialization(CoSimulation),
            Host::initialized(ModelExchange),
            Host::continuous(),
            Host::initialized(CoSimulation),
        ];
        for (column, (mark, host)) in marks.chars().zip(hosts).enumerate() {
            let expected = if mark == 'x' { Status::Ok } else { Status::Error };
            assert_eq!(set(&host, name), expected, "{name}, column {column}: {:?}", host.take_messages());
        }
    }
}

#[test]
fn a_wrong_value_reference_or_type_is_an_error() {
    let host = in_initialization(CoSimulation);
    for reference in [999, u32::MAX, integer::SELECTOR + 1000] {
        assert_eq!(host.get_real(reference).0, Status::Error);
        assert_eq!(host.set_real(reference, 0.0), Status::Error);
        assert_eq!(call!(fmi2GetInteger(host.c, &reference, 1, &mut 0)), Status::Error);
        assert_eq!(host.set_integer(reference, 0), Status::Error);
        assert_eq!(call!(fmi2GetBoolean(host.c, &reference, 1, &mut 0)), Status::Error);
        assert_eq!(host.set_boolean(reference, 0), Status::Error);
    }
    assert_eq!(host.set_integer(real::K, 1), Status::Error, "a Real is no Integer");
}

#[test]
fn string_functions_know_no_variable() {
    let host = in_initialization(CoSimulation);
    let mut text = ptr::null();
    assert_eq!(call!(fmi2GetString(host.c, &0, 1, &mut text)), Status::Error);
    assert_eq!(call!(fmi2SetString(host.c, &0, 1, &c"x".as_ptr())), Status::Error);
    assert_eq!(call!(fmi2GetString(host.c, ptr::null(), 0, ptr::null_mut())), Status::Ok);
}

#[test]
fn null_arrays_are_errors_unless_they_are_empty() {
    let host = in_initialization(CoSimulation);
    let vr = real::U;
    assert_eq!(call!(fmi2GetReal(host.c, ptr::null(), 1, &mut 0.0)), Status::Error);
    assert_eq!(call!(fmi2GetReal(host.c, &vr, 1, ptr::null_mut())), Status::Error);
    assert_eq!(call!(fmi2SetReal(host.c, ptr::null(), 1, &0.0)), Status::Error);
    assert_eq!(call!(fmi2SetReal(host.c, &vr, 1, ptr::null())), Status::Error);
    assert_eq!(call!(fmi2SetReal(host.c, &vr, usize::MAX, &0.0)), Status::Error, "no array is that long");
    assert_eq!(call!(fmi2GetReal(host.c, ptr::null(), 0, ptr::null_mut())), Status::Ok);
    assert_eq!(call!(fmi2SetReal(host.c, ptr::null(), 0, ptr::null())), Status::Ok);
}

#[test]
fn values_that_are_not_finite_are_refused() {
    for host in [Host::new(CoSimulation), Host::initialized(CoSimulation), Host::continuous()] {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(host.set_real(real::U, value), Status::Error);
        }
    }
}

#[test]
fn values_outside_min_and_max_are_refused_by_name_and_limit() {
    let host = Host::new(CoSimulation);
    for (status, text) in [
        (host.set_real(real::K, -0.5), "fmi2SetReal: k = -0.5 is below its minimum 0.0"),
        (host.set_real(real::U, 101.0), "fmi2SetReal: u = 101.0 is above its maximum 100.0"),
        (host.set_integer(integer::TROUBLE, 8), "fmi2SetInteger: trouble = 8 is above its maximum 7.0"),
    ] {
        assert_eq!(status, Status::Error);
        assert!(host.messages.0.borrow().iter().any(|m| m.text == text), "{text}");
    }
    assert_eq!(host.set_real(real::U, 100.0), Status::Ok, "limits are inclusive");
}

#[test]
fn a_refused_set_call_changes_nothing() {
    let host = in_initialization(CoSimulation);
    let before = host.fingerprint();
    let values = [7.0, f64::NAN];
    assert_eq!(call!(fmi2SetReal(host.c, [real::C, real::U].as_ptr(), 2, values.as_ptr())), Status::Error);
    assert_eq!(call!(fmi2SetReal(host.c, [real::C, real::Y].as_ptr(), 2, [7.0; 2].as_ptr())), Status::Error);
    let selectors = [integer::SELECTOR, integer::TICKS];
    assert_eq!(call!(fmi2SetInteger(host.c, selectors.as_ptr(), 2, [7; 2].as_ptr())), Status::Error);
    let flags = [boolean::FLAG, boolean::POSITIVE];
    assert_eq!(call!(fmi2SetBoolean(host.c, flags.as_ptr(), 2, [1; 2].as_ptr())), Status::Error);
    assert_eq!(host.fingerprint(), before);
}

#[test]
fn variables_read_together_are_those_read_one_by_one() {
    let host = Host::initialized(CoSimulation);
    let check = |references: &[u32]| {
        let alone: Vec<(Status, f64)> = references.iter().map(|&reference| host.get_real(reference)).collect();
        let mut values = vec![0.0; references.len()];
        let status = call!(fmi2GetReal(host.c, references.as_ptr(), references.len(), values.as_mut_ptr()));
        let all_are_there = alone.iter().all(|(status, _)| *status == Status::Ok);
        assert_eq!(status == Status::Ok, all_are_there, "{references:?}");
        if all_are_there {
            assert!(alone.iter().map(|(_, value)| value).eq(&values), "{references:?}");
        }
    };
    for first in 0..26 {
        for last in first..26 {
            let mut references: Vec<u32> = (first..=last).collect();
            check(&references);
            references.reverse();
            check(&references);
        }
    }
    // from end to end as if in order; the same twice; there and back
    check(&[real::X, real::V, real::A, real::Y]);
    check(&[real::X, real::X, real::V]);
    check(&[real::C, real::Y, real::K, real::U, real::Y]);
}

#[test]
fn variables_set_together_are_those_set_one_by_one() {
    // in order, and in an order that begins and ends as if it were; the same twice, of which the last counts
    for references in [[20, 21, 22], [22, 20, 21], [21, 21, 22], [20, 2, 22], [1, 2, 1]] {
        let values = [1.5, 2.5, 3.5];
        let (together, alone) = (in_initialization(CoSimulation), in_initialization(CoSimulation));
        assert_eq!(call!(fmi2SetReal(together.c, references.as_ptr(), 3, values.as_ptr())), Status::Ok);
        for (reference, value) in references.into_iter().zip(values) {
            assert_eq!(alone.set_real(reference, value), Status::Ok);
        }
        assert_eq!(together.fingerprint(), alone.fingerprint(), "{references:?}");
    }
}

#[test]
fn the_order_in_which_variables_are_set_does_not_matter() {
    let hosts: [fn() -> Host; 5] = [
        || Host::new(ModelExchange),
        || in_initialization(CoSimulation),
        || Host::initialized(ModelExchange),
        Host::continuous,
        || Host::initialized(CoSimulation),
    ];
    let values = [1.0, 100.0, 100.5, -0.5, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let pairs = (0..25).map(|reference| [reference, reference + 1]);
    for (make, references) in hosts.into_iter().flat_map(|make| pairs.clone().map(move |pair| (make, pair))) {
        for values in values.into_iter().flat_map(|a| values.map(|b| [a, b])) {
            let set = |references: [u32; 2], values: [f64; 2]| {
                let host = make();
                let before = host.serialize(host.state());
                let status = call!(fmi2SetReal(host.c, references.as_ptr(), 2, values.as_ptr()));
                let after = host.serialize(host.state());
                assert_eq!(status == Status::Ok, before != after, "{references:?} = {values:?}");
                (status, after)
            };
            let backward = |[a, b]: [f64; 2]| [b, a];
            let reversed = set([references[1], references[0]], backward(values));
            assert!(set(references, values) == reversed, "{references:?} = {values:?}");
        }
    }
}

#[test]
fn set_and_get_interchange_in_initialization_mode() {
    for interface in [ModelExchange, CoSimulation] {
        let host = in_initialization(interface);
        assert_eq!(host.real(real::Y), 1.0);
        host.set_real(real::U, 5.0);
        assert_eq!(host.real(real::Y), 6.0);
        host.set_real(real::X_START, 2.0);
        assert_eq!((host.real(real::X), host.real(real::Y)), (2.0, 7.0));
        assert_eq!(host.real(real::HELD), 5.0, "initialization does not depend on earlier calls");
    }
}

#[test]
fn a_feed_through_output_follows_its_input_without_a_step_between() {
    let host = Host::initialized(CoSimulation);
    host.set_real(real::U, 3.0);
    assert_eq!(host.real(real::Y), 4.0);
    assert_eq!(host.real(real::HELD), 0.0, "a sampled output does not");
}

#[test]
fn booleans_from_c_are_integers() {
    let host = in_initialization(CoSimulation);
    for value in [1, -1, 255, i32::MIN] {
        assert_eq!(host.set_boolean(boolean::FLAG, value), Status::Ok);
        assert_eq!(host.boolean(boolean::FLAG), 1);
    }
    host.set_boolean(boolean::FLAG, 0);
    assert_eq!(host.boolean(boolean::FLAG), 0);
}

#[test]
fn a_tunable_parameter_takes_effect_from_the_next_step_on() {
    let host = Host::initialized(CoSimulation);
    host.step(0.0, 0.1);
    let (x, v) = (host.real(real::X), host.real(real::V));
    assert_eq!(host.set_real(real::C, 100.0), Status::Ok);
    assert_eq!((host.real(real::X), host.real(real::V)), (x, v));
    host.step(0.1, 0.1);
    assert!(host.real(real::V).abs() < v.abs());
}

#[test]
fn the_variable_that_is_a_state_sets_the_state_in_continuous_time_mode() {
    let host = Host::continuous();
    assert_eq!(host.set_real(real::X, 3.0), Status::Ok);
    let mut states = [0.0; 2];
    assert_eq!(call!(fmi2GetContinuousStates(host.c, states.as_mut_ptr(), 2)), Status::Ok);
    assert_eq!(states, [3.0, 0.0]);
    assert_eq!(host.real(real::A), -12.0);
}
