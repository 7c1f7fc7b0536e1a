//! Peak pose errors over random crossings: tilt 3 to 12 deg in any direction, any sheet of the
//! singular surface within the joints' limits, three and six motors, with and without noise on the
//! limb lengths. Prints the distribution for each mode and every crossing in which the swarm
//! is worse than the best fixed damping:
//! `cargo run --release --example random_crossings [crossings, default 500]`.

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use rps3::coupling::Experiment;
use rps3::defaults::DEG;
use rps3::dynamics::PlantParameters;
use rps3::study::{Crossing, Distribution, Figures, MODES};

/// Standard deviations of the noise on the limb lengths, m.
const NOISES: [f64; 2] = [0.0, 1e-4];

fn main() -> Result<(), std::num::ParseIntError> {
    let count = std::env::args().nth(1).map_or(Ok(500), |argument| argument.parse())?;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let crossings: Vec<_> = (0..count).map(|_| Crossing::random(&PlantParameters::default(), &mut rng)).collect();
    for (variant, revolute_motors) in [("six motors", true), ("three motors", false)] {
        for length_noise in NOISES {
            println!("\n{variant}, length noise {} mm: peak pose error, mm\n", length_noise * 1e3);
            let results = in_parallel(&crossings, |k, crossing| {
                let experiment =
                    Experiment { length_noise, noise_seed: k as u64, ..crossing.experiment(revolute_motors) };
                MODES.map(|scheme| scheme.figures(&experiment))
            });
            print_distributions(&results);
            print_losses(&crossings, &results);
        }
    }
    Ok(())
}

/// Applies `run` to all items, in their order, on all processors.
fn in_parallel<T: Sync, R: Send>(items: &[T], run: impl Fn(usize, &T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
    let work = || {
        let mut done = Vec::new();
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(k) else { return done };
            done.push((k, run(k, item)));
        }
    };
    let mut results: Vec<_> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("no run panics")).collect()
    });
    results.sort_unstable_by_key(|(k, _)| *k);
    results.into_iter().map(|(_, result)| result).collect()
}

fn print_distributions(results: &[[Figures; MODES.len()]]) {
    println!("| mode | median | 90 % | max | ended early |");
    println!("|---|---|---|---|---|");
    for (i, scheme) in MODES.iter().enumerate() {
        let mut peaks: Vec<_> = results.iter().map(|figures| figures[i].peak * 1e3).collect();
        let failures = results.iter().filter(|figures| figures[i].failure.is_some()).count();
        let Distribution { median, ninety, max } = Distribution::of(&mut peaks);
        println!("| {} | {median:.3} | {ninety:.3} | {max:.3} | {failures} |", scheme.name);
    }
}

fn print_losses(crossings: &[Crossing], results: &[[Figures; MODES.len()]]) {
    println!();
    for (crossing, figures) in crossings.iter().zip(results) {
        let [fixed @ .., swarm] = figures;
        let (best, name) = fixed
            .iter()
            .zip(MODES)
            .filter(|(f, _)| f.failure.is_none())
            .map(|(f, scheme)| (f.peak, scheme.name))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap_or((f64::INFINITY, "none"));
        // (a NaN counts as worse)
        if swarm.peak.partial_cmp(&best).is_none_or(std::cmp::Ordering::is_gt) {
            let [heave, x, y] = crossing.waypoints[1];
            println!(
                "swarm worse: heave {:.2} cm, tilt {:.2} deg, direction {:.1} deg: {:.3} mm, {name} {:.3} mm",
                heave * 1e2,
                x.hypot(y) / DEG,
                y.atan2(x) / DEG,
                swarm.peak * 1e3,
                best * 1e3
            );
        }
    }
}
