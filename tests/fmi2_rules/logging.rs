//! The logger (section 2.1.5); the host's callback itself asserts "%s" and a category.

use std::ffi::CStr;
use std::ptr;

use rps3::fmi2::types::Status;

use crate::host::{CoSimulation, Host, ModelExchange, call};
use crate::toy::{real, trouble};
use crate::*;

fn set_logging(host: &Host, on: i32, categories: &[&CStr]) -> Status {
    let pointers: Vec<_> = categories.iter().map(|c| c.as_ptr()).collect();
    call!(fmi2SetDebugLogging(host.c, on, pointers.len(), pointers.as_ptr()))
}

/// Categories of the messages that an initialization with a warning, an event and an error give.
fn categories_of_everything(host: &Host) -> Vec<String> {
    call!(fmi2Reset(host.c));
    host.trouble(trouble::WARNING);
    host.initialize();
    host.set_real(real::K, f64::NAN);
    host.trouble(trouble::DISCARD);
    host.step(0.0, 0.01);
    host.take_messages().into_iter().map(|m| m.category).collect()
}

#[test]
fn without_debug_logging_only_warnings_and_errors_are_logged() {
    let host = Host::with_logging(CoSimulation, false);
    assert_eq!(categories_of_everything(&host), ["logStatusWarning", "logStatusError"]);
}

#[test]
fn logging_on_enables_every_category() {
    let host = Host::new(CoSimulation);
    let all = ["logStatusWarning", "logEvents", "logStatusError", "logStatusDiscard"];
    assert_eq!(categories_of_everything(&host), all);
}

#[test]
fn set_debug_logging_without_categories_means_all() {
    let host = Host::with_logging(CoSimulation, false);
    assert_eq!(set_logging(&host, 1, &[]), Status::Ok);
    assert_eq!(categories_of_everything(&host).len(), 4);
    assert_eq!(set_logging(&host, 0, &[]), Status::Ok);
    assert_eq!(categories_of_everything(&host), [""; 0]);
    assert_eq!(set_logging(&host, 1, &[c"logAll"]), Status::Ok);
    assert_eq!(categories_of_everything(&host).len(), 4);
}

#[test]
fn only_enabled_categories_are_logged() {
    let host = Host::new(CoSimulation);
    assert_eq!(set_logging(&host, 1, &[c"logEvents", c"logStatusDiscard"]), Status::Ok);
    assert_eq!(categories_of_everything(&host), ["logEvents", "logStatusDiscard"]);
    assert_eq!(set_logging(&host, 0, &[c"logEvents"]), Status::Ok);
    assert_eq!(categories_of_everything(&host), ["logStatusDiscard"]);
}

#[test]
fn an_undeclared_category_is_refused_and_switches_nothing() {
    let host = Host::with_logging(CoSimulation, false);
    for categories in [[c"logEvents", c"logNonsense"], [c"", c"logEvents"]] {
        assert_eq!(set_logging(&host, 1, &categories), Status::Error);
        host.take_messages();
        assert_eq!(categories_of_everything(&host), ["logStatusWarning", "logStatusError"]);
    }
    assert_eq!(call!(fmi2SetDebugLogging(host.c, 1, 2, ptr::null())), Status::Error);
    assert_eq!(call!(fmi2SetDebugLogging(host.c, 1, 1, &ptr::null())), Status::Error);
}

#[test]
fn messages_bear_the_instance_name_the_status_and_the_environment() {
    let host = Host::new(ModelExchange);
    assert_eq!(host.set_real(real::K, -1.0), Status::Error);
    let messages = host.take_messages(); // collected through the environment
    assert_eq!(messages.len(), 1);
    assert_eq!((messages[0].instance.as_str(), messages[0].status), ("toy", 3));
    assert_eq!(messages[0].text, "fmi2SetReal: k = -1.0 is below its minimum 0.0");
}

#[test]
fn a_hash_in_a_message_is_escaped_and_a_percent_sign_is_no_format() {
    let host = Host::new(CoSimulation);
    host.trouble(trouble::WARNING);
    host.initialize();
    let warning = &host.take_messages()[0];
    assert_eq!((warning.text.as_str(), warning.status), ("something to know, ##1 of 100%", 1));
}

#[test]
fn the_format_is_percent_s_and_the_category_never_null() {
    // the host's logger asserts both for every message; here is one of each category
    let host = Host::new(CoSimulation);
    let categories = categories_of_everything(&host);
    assert!(!categories.is_empty() && categories.iter().all(|category| !category.is_empty()));
}

#[test]
fn every_category_in_use_is_declared_in_the_description() {
    let xml = rps3::models::descriptions::PLANT.xml;
    for category in rps3::description::LogCategory::ALL {
        assert!(xml.contains(&format!("<Category name=\"{}\"", category.name())));
    }
}
