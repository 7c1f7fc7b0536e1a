//! A panic never crosses the boundary (section 2.1.3: `fmi2Fatal`).

use rps3::fmi2::types::Status;

use crate::host::{CoSimulation, Host, ModelExchange, call};
use crate::toy::{real, trouble};
use crate::*;

#[test]
fn a_panic_in_a_step_is_fatal_and_logged() {
    let host = Host::with_logging(CoSimulation, false);
    host.initialize();
    host.trouble(trouble::PANIC);
    assert_eq!(host.step(0.0, 0.01), Status::Fatal);
    let messages = host.take_messages();
    assert_eq!(messages.len(), 1);
    assert_eq!((messages[0].status, messages[0].category.as_str()), (4, "logStatusFatal"));
    assert!(messages[0].text.starts_with("fmi2DoStep: ") && messages[0].text.contains("100% wrong"));
}

#[test]
fn a_panic_while_values_are_computed_is_fatal() {
    for interface in [ModelExchange, CoSimulation] {
        let host = Host::initialized(interface);
        host.trouble(trouble::PANIC);
        assert_eq!(host.get_real(real::X).0, Status::Fatal);
    }
}

#[test]
fn a_panic_in_initialization_is_fatal() {
    let host = Host::new(CoSimulation);
    host.trouble(trouble::PANIC);
    host.setup(0.0, None);
    assert_eq!(call!(fmi2EnterInitializationMode(host.c)), Status::Ok);
    assert_eq!(call!(fmi2ExitInitializationMode(host.c)), Status::Fatal);
}

#[test]
fn other_instances_go_on_after_a_panic() {
    let (broken, other) = (Host::initialized(CoSimulation), Host::initialized(CoSimulation));
    broken.trouble(trouble::PANIC);
    assert_eq!(broken.step(0.0, 0.01), Status::Fatal);
    assert_eq!(other.step(0.0, 0.01), Status::Ok);
}
