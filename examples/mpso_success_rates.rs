//! How often a swarm finds the global minimum of standard multimodal functions: plain, with the
//! combined population ranked by error alone, and with distance ranking as well (3.3). Prints the
//! Markdown tables of `docs/mpso.md`:
//!
//! ```sh
//! cargo run --release --example mpso_success_rates [seeds, default 1000]
//! ```

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;
use rps3::control::mpso::{Bounds, Selection, Settings, Swarm};

#[path = "../tests/mpso_functions/mod.rs"]
mod functions;
use functions::{Function, MULTIMODAL};

/// The variants compared, in the columns' order.
const VARIANTS: [&str; 3] = ["plain", "ranked, s = 0", "ranked, s = 0.7 to 0.005"];

fn variant(index: usize, max_iterations: usize) -> Settings {
    // No variant stops early: all use the same number of evaluations.
    let mpso = Settings { max_iterations, stall_iterations: max_iterations, ..Settings::default() };
    match index {
        0 => Settings { selection: Selection::Plain, ..mpso },
        1 => Settings { decay_max: 0.0, decay_min: 0.0, ..mpso },
        _ => mpso,
    }
}

fn successes<const D: usize>(function: &Function, settings: Settings, seeds: u64) -> u64 {
    let bounds = Bounds::new([function.lower; D], [function.upper; D]).expect("the functions' ranges are finite");
    let mut swarm = Swarm::new(bounds, settings).expect("the variants are within the settings' ranges");
    let mut found = 0;
    for seed in 0..seeds {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let solution = swarm.minimize(&mut rng, &[], |x: &[f64; D]| (function.value)(x));
        found += u64::from(solution.value < function.basin);
    }
    found
}

fn row<const D: usize>(function: &Function, max_iterations: usize, seeds: u64) {
    let rates = std::array::from_fn::<_, { VARIANTS.len() }, _>(|v| {
        let found = successes::<D>(function, variant(v, max_iterations), seeds);
        format!("{:.1}", 100.0 * found as f64 / seeds as f64)
    });
    println!("| {} | {D} | {} |", function.name, rates.join(" | "));
}

fn main() -> Result<(), std::num::ParseIntError> {
    let seeds = std::env::args().nth(1).map_or(Ok(1000), |argument| argument.parse())?;
    for max_iterations in [30, 200] {
        let size = Settings::default().swarm_size;
        println!("\nSuccess in %, {size} individuals, {max_iterations} iterations, {seeds} seeds:\n");
        println!("| function | members | {} |", VARIANTS.join(" | "));
        println!("|---|---|{}", "---|".repeat(VARIANTS.len()));
        for function in &MULTIMODAL {
            row::<2>(function, max_iterations, seeds);
            row::<3>(function, max_iterations, seeds);
            row::<4>(function, max_iterations, seeds);
            row::<5>(function, max_iterations, seeds);
            row::<6>(function, max_iterations, seeds);
        }
    }
    Ok(())
}
