//! What `docs/mpso.md` says about the worth of the modification, in the cases where the difference
//! is far beyond chance. `cargo run --release --example mpso_success_rates` prints all of them.

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;
use rps3::control::mpso::{Bounds, Selection, Settings, Swarm};

mod mpso_functions;
use mpso_functions::{ACKLEY, Function, RASTRIGIN};

const SEEDS: u64 = 400;
/// One-sided binomial test: 4 standard deviations leave 3e-5 to chance.
const DEVIATIONS: f64 = 4.0;

/// Settings that use their whole budget: 20 individuals, `max_iterations`.
fn ranked(max_iterations: usize) -> Settings {
    Settings { max_iterations, stall_iterations: max_iterations, ..Settings::default() }
}

fn plain(max_iterations: usize) -> Settings {
    Settings { selection: Selection::Plain, ..ranked(max_iterations) }
}

fn without_distance(max_iterations: usize) -> Settings {
    Settings { decay_max: 0.0, decay_min: 0.0, ..ranked(max_iterations) }
}

/// Rate at which the global minimum's basin is found.
fn rate<const D: usize>(function: &Function, settings: Settings) -> f64 {
    let mut swarm = Swarm::new(Bounds::new([function.lower; D], [function.upper; D]).unwrap(), settings).unwrap();
    let found = |seed: &u64| {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(*seed);
        swarm.minimize(&mut rng, &[], |x| (function.value)(x)).value < function.basin
    };
    (0..SEEDS).filter(found).count() as f64 / SEEDS as f64
}

#[track_caller]
fn assert_higher(better: f64, worse: f64) {
    let variance = (better * (1.0 - better) + worse * (1.0 - worse)) / SEEDS as f64;
    assert!(better - worse > DEVIATIONS * variance.sqrt(), "{better} is not significantly above {worse}");
}

#[test]
fn the_combined_population_wins_where_few_iterations_must_do() {
    assert_higher(rate::<4>(&ACKLEY, ranked(30)), rate::<4>(&ACKLEY, plain(30)));
}

#[test]
fn the_plain_swarm_wins_where_many_minima_lie_in_many_iterations_reach() {
    assert_higher(rate::<3>(&RASTRIGIN, plain(200)), rate::<3>(&RASTRIGIN, ranked(200)));
}

#[test]
fn distance_ranking_helps_to_leave_a_local_minimum_in_two_members() {
    assert_higher(rate::<2>(&RASTRIGIN, ranked(200)), rate::<2>(&RASTRIGIN, without_distance(200)));
}

#[test]
fn distance_ranking_costs_convergence_where_few_iterations_must_do() {
    assert_higher(rate::<4>(&ACKLEY, without_distance(30)), rate::<4>(&ACKLEY, ranked(30)));
}
