//! A bounded run of the fuzz targets with seeded random bytes. The long run, with libFuzzer and
//! its coverage feedback, is `cargo xtask fuzz`; inputs that once broke a promise are in
//! `fuzz/regressions/` and run here first.

#[path = "../fuzz/src/lib.rs"]
mod harness;

use std::path::Path;
use std::time::{Duration, Instant};

use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Inputs a target, and the time after which a slow machine may stop.
const INPUTS: u64 = 300;
const AT_MOST: Duration = Duration::from_secs(5);

fn run<T>(target: &str, harness: impl Fn(&[u8]) -> T) {
    let regressions = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/regressions").join(target);
    for file in std::fs::read_dir(&regressions).into_iter().flatten() {
        let path = file.expect("a readable directory").path();
        println!("{}", path.display());
        harness(&std::fs::read(&path).expect("a readable file"));
    }
    let begin = Instant::now();
    for seed in 0..INPUTS {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut data = vec![0; rng.random_range(1..2048)];
        rng.fill_bytes(&mut data);
        println!("seed {seed}"); // shown if it panics
        harness(&data);
        if begin.elapsed() > AT_MOST {
            break;
        }
    }
    println!("so far {}", harness::TALLY);
}

#[test]
fn random_calls_keep_the_promises() {
    run("calls", harness::calls);
}

#[test]
fn random_states_keep_the_promises() {
    run("states", harness::states);
}

#[test]
fn random_parameters_keep_the_promises() {
    run("parameters", harness::parameters);
}
