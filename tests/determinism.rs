//! Same inputs, same bits: run to run, in debug and release, on every platform that computes
//! doubles as IEEE 754 says. All functions beyond its operations come from the `libm` crate.

mod common;

use rps3::control::Mode;

/// Checksum over time, state, voltages and estimate at every tick of the default crossing.
fn checksum(mode: i32, revolute_motors: bool) -> u32 {
    let mut experiment = common::crossing(mode);
    experiment.plant.mechanism.revolute_motors = revolute_motors;
    experiment.controller.mechanism.revolute_motors = revolute_motors;
    let mut hasher = crc32fast::Hasher::new();
    let observe = |record: &rps3::coupling::Record| {
        let d = &record.diagnostics;
        let numbers = record.state.iter().chain(d.voltages.iter()).chain(d.estimate.iter());
        for number in numbers.chain([&record.time, &d.sigma_min, &d.fitness]) {
            hasher.update(&number.to_bits().to_le_bytes());
        }
    };
    experiment.run(observe).unwrap();
    hasher.finalize()
}

/// The numbers are those of x86-64 Linux in debug and release. A change of the models or the
/// controller changes them; a change of the compiler, its options or the platform must not.
#[test]
fn the_default_experiment_gives_known_bits() {
    let found = [(4, true), (4, false), (2, true), (2, false)].map(|(mode, six)| checksum(mode, six));
    assert_eq!(found, [0x91b2_48e2, 0xf8af_7799, 0xbf7e_24bc, 0x6d18_6aac], "{found:#x?}");
}

#[test]
fn a_second_run_gives_the_bits_of_the_first() {
    assert_eq!(common::crossing(4).tuning.mode, Mode::HdracMpso, "the mode with random numbers");
    assert_eq!(checksum(4, true), checksum(4, true));
}
