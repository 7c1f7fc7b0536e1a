//! The complete FMU state (section 2.1.8).

use std::ptr;

use proptest::prelude::*;
use rps3::fmi2::types::{Interface, Status};

use crate::host::{CoSimulation, Host, ModelExchange, call};
use crate::toy::{real, trouble};
use crate::*;

fn advance(host: &Host, steps: i32) {
    for _ in 0..steps {
        let time = host.real(real::TIME);
        assert_eq!(host.set_real(real::U, (10.0 * time).sin()), Status::Ok);
        let (reference, order, rate) = (real::U, 1, 0.5);
        assert_eq!(call!(fmi2SetRealInputDerivatives(host.c, &reference, 1, &order, &rate)), Status::Ok);
        assert_eq!(host.step(time, 0.013), Status::Ok);
    }
}

#[test]
fn rollback_and_replay_are_bit_identical() {
    let host = Host::initialized(CoSimulation);
    advance(&host, 20);
    let state = host.state();
    let before = host.fingerprint();
    advance(&host, 20);
    let after = host.fingerprint();
    assert_eq!(call!(fmi2SetFMUstate(host.c, state)), Status::Ok);
    assert_eq!(host.fingerprint(), before);
    advance(&host, 20);
    assert_eq!(host.fingerprint(), after);
    assert_eq!(call!(fmi2SetFMUstate(host.c, state)), Status::Ok, "the state still exists");
    assert_eq!(host.fingerprint(), before);
}

#[test]
fn input_derivatives_and_pending_changes_are_part_of_the_state() {
    let host = Host::initialized(CoSimulation);
    let (reference, order, rate) = (real::U, 1, 3.0);
    host.set_real(real::U, 2.0);
    call!(fmi2SetRealInputDerivatives(host.c, &reference, 1, &order, &rate));
    let state = host.state();
    host.step(0.0, 0.1);
    let after = host.fingerprint();
    call!(fmi2SetFMUstate(host.c, state));
    assert_eq!(host.real(real::Y), 3.0);
    host.step(0.0, 0.1);
    assert_eq!(host.fingerprint(), after);
}

#[test]
fn a_null_handle_allocates_and_another_is_reused() {
    let host = Host::initialized(CoSimulation);
    let mut state = host.state();
    let first = state;
    advance(&host, 5);
    let now = host.fingerprint();
    assert_eq!(call!(fmi2GetFMUstate(host.c, &mut state)), Status::Ok);
    assert_eq!(state, first);
    advance(&host, 5);
    call!(fmi2SetFMUstate(host.c, state));
    assert_eq!(host.fingerprint(), now);
    assert_ne!(host.state(), first, "NULL makes a new one");
}

#[test]
fn free_nulls_the_handle_and_ignores_null() {
    let host = Host::initialized(CoSimulation);
    let mut state = host.state();
    assert_eq!(call!(fmi2FreeFMUstate(host.c, &mut state)), Status::Ok);
    assert!(state.is_null());
    assert_eq!(call!(fmi2FreeFMUstate(host.c, &mut state)), Status::Ok);
    assert_eq!(call!(fmi2FreeFMUstate(host.c, ptr::null_mut())), Status::Ok);
}

#[test]
fn foreign_and_freed_handles_are_refused_and_harm_nothing() {
    let (host, other) = (Host::initialized(CoSimulation), Host::initialized(CoSimulation));
    let mut freed = host.state();
    let stale = freed;
    call!(fmi2FreeFMUstate(host.c, &mut freed));
    let before = host.fingerprint();
    for handle in [ptr::null_mut(), stale, other.state(), ptr::without_provenance_mut(8), host.c] {
        assert_eq!(call!(fmi2SetFMUstate(host.c, handle)), Status::Error);
        assert_eq!(call!(fmi2SerializedFMUstateSize(host.c, handle, &mut 0)), Status::Error);
        assert_eq!(call!(fmi2SerializeFMUstate(host.c, handle, ptr::null_mut(), 0)), Status::Error);
        if !handle.is_null() {
            let mut handle = handle;
            assert_eq!(call!(fmi2GetFMUstate(host.c, &mut handle)), Status::Error);
            assert_eq!(call!(fmi2FreeFMUstate(host.c, &mut handle)), Status::Error);
            assert!(!handle.is_null());
        }
    }
    assert_eq!(host.fingerprint(), before);
    assert!(!host.take_messages().is_empty());
}

#[test]
fn states_survive_reset_and_restore_any_mode() {
    for host in [Host::new(ModelExchange), Host::initialized(ModelExchange), Host::continuous()] {
        let state = host.state();
        assert_eq!(call!(fmi2Reset(host.c)), Status::Ok);
        assert_eq!(call!(fmi2SetFMUstate(host.c, state)), Status::Ok);
    }
    let host = Host::continuous();
    let state = host.state();
    call!(fmi2Terminate(host.c));
    call!(fmi2SetFMUstate(host.c, state));
    assert_eq!(call!(fmi2EnterEventMode(host.c)), Status::Ok, "Continuous-Time Mode again");
}

#[test]
fn a_serialized_state_continues_bit_identically_in_another_instance() {
    let host = Host::initialized(CoSimulation);
    advance(&host, 20);
    let bytes = host.serialize(host.state());
    advance(&host, 20);
    let other = Host::new(CoSimulation);
    let (status, state) = other.deserialize(&bytes);
    assert_eq!(status, Status::Ok);
    assert_eq!(call!(fmi2SetFMUstate(other.c, state)), Status::Ok);
    advance(&other, 20);
    assert_eq!(other.fingerprint(), host.fingerprint());
    assert_eq!(other.serialize(other.state()), host.serialize(host.state()));
}

#[test]
fn a_serialized_state_takes_exactly_the_stated_size() {
    let host = Host::initialized(CoSimulation);
    let state = host.state();
    let bytes = host.serialize(state);
    let mut buffer = vec![0xaa; bytes.len() + 1];
    for size in [0, bytes.len() - 1, bytes.len() + 1] {
        assert_eq!(call!(fmi2SerializeFMUstate(host.c, state, buffer.as_mut_ptr(), size)), Status::Error);
    }
    assert!(buffer.iter().all(|b| *b == 0xaa), "nothing was written");
    assert_eq!(call!(fmi2SerializeFMUstate(host.c, state, ptr::null_mut(), bytes.len())), Status::Error);
    assert_eq!(call!(fmi2SerializedFMUstateSize(host.c, state, ptr::null_mut())), Status::Error);
}

#[test]
fn a_state_of_the_other_interface_is_refused() {
    let exchange = Host::initialized(ModelExchange);
    let bytes = exchange.serialize(exchange.state());
    assert_eq!(Host::initialized(CoSimulation).deserialize(&bytes).0, Status::Error);
}

#[test]
fn the_state_of_an_erroneous_instance_stays_erroneous() {
    let host = Host::in_error(Interface::CoSimulation);
    let state = host.state();
    call!(fmi2Reset(host.c));
    host.initialize();
    call!(fmi2SetFMUstate(host.c, state));
    assert_eq!(host.step(0.0, 0.1), Status::Error);
    host.take_messages();
    assert_eq!(host.set_integer(crate::toy::integer::TROUBLE, trouble::NONE), Status::Error);
}

/// A way to spoil bytes.
#[derive(Debug, Clone)]
enum Corruption {
    Flip(prop::sample::Index, u8),
    Truncate(prop::sample::Index),
    Append(Vec<u8>),
    Replace(Vec<u8>),
    Swap(prop::sample::Index, prop::sample::Index),
    Fill(prop::sample::Index, prop::sample::Index, u8),
}

fn corruption() -> impl Strategy<Value = Corruption> {
    let index = any::<prop::sample::Index>;
    prop_oneof![
        4 => (index(), 1..=u8::MAX).prop_map(|(i, mask)| Corruption::Flip(i, mask)),
        2 => index().prop_map(Corruption::Truncate),
        1 => prop::collection::vec(any::<u8>(), 1..64).prop_map(Corruption::Append),
        1 => prop::collection::vec(any::<u8>(), 0..512).prop_map(Corruption::Replace),
        1 => (index(), index()).prop_map(|(i, j)| Corruption::Swap(i, j)),
        1 => (index(), index(), any::<u8>()).prop_map(|(i, j, b)| Corruption::Fill(i, j, b)),
    ]
}

fn corrupt(bytes: &[u8], corruption: Corruption) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let n = bytes.len();
    match corruption {
        Corruption::Flip(i, mask) => bytes[i.index(n)] ^= mask,
        Corruption::Truncate(i) => bytes.truncate(i.index(n)),
        Corruption::Append(tail) => bytes.extend(tail),
        Corruption::Replace(other) => bytes = other,
        Corruption::Swap(i, j) => bytes.swap(i.index(n), j.index(n)),
        Corruption::Fill(i, j, byte) => {
            let (i, j) = (i.index(n), j.index(n));
            bytes[i.min(j)..=i.max(j)].fill(byte);
        }
    }
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn corrupted_states_are_refused_and_nothing_is_lost(corruption in corruption()) {
        let host = Host::initialized(CoSimulation);
        advance(&host, 3);
        let before = host.fingerprint();
        let bytes = host.serialize(host.state());
        let spoiled = corrupt(&bytes, corruption);
        prop_assume!(spoiled != bytes);
        host.take_messages();
        let (status, state) = host.deserialize(&spoiled);
        prop_assert_eq!(status, Status::Error);
        prop_assert!(state.is_null());
        prop_assert_eq!(host.take_messages().len(), 1);
        prop_assert_eq!(host.fingerprint(), before);
        advance(&host, 1);
    }
}
