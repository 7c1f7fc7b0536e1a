//! Serialized states that were damaged on the way.

mod common;

use common::{Fmu, Slave};
use rps3::fmi2::types::Status;
use rps3::models::{Controller, Plant};

/// Damages the bytes of a state in every way of one sort; returns how many there were.
fn every_damage_is_noticed<M: Fmu>() -> usize {
    let slave = Slave::<M>::new();
    slave.initialize();
    assert_eq!(slave.step(0.0, 2e-3), Status::Ok);
    let mut bytes = slave.serialize(slave.state());
    let mut tried = 0;
    let mut refused = |bytes: &[u8]| {
        tried += 1;
        slave.deserialize(bytes).is_null()
    };
    for place in 0..bytes.len() {
        for bit in 0..8 {
            bytes[place] ^= 1 << bit;
            assert!(refused(&bytes), "bit {bit} of byte {place}");
            bytes[place] ^= 1 << bit;
        }
        assert!(refused(&bytes[..place]), "cut off at {place}");
        let without: Vec<u8> = [&bytes[..place], &bytes[place + 1..]].concat();
        assert!(refused(&without), "without byte {place}");
    }
    assert!(!refused(&bytes), "undamaged it is taken");
    tried
}

#[test]
fn every_flipped_bit_lost_byte_and_cut_is_refused() {
    // a checksum of 32 bits sees every error of up to 32 bits in a row
    let tried = every_damage_is_noticed::<Plant>() + every_damage_is_noticed::<Controller>();
    println!("{tried} damaged states");
    assert!(tried > 10_000);
}
