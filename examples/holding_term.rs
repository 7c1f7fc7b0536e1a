//! What the fitness's term for poses that three motors cannot hold is worth, and with which constants: peak pose
//! errors of random crossings at constant speed, over share and weight of the term. Crossings whose end
//! the motors cannot hold are left out, since there the platform falls whatever is done:
//! `cargo run --release --example holding_term [crossings, default 300]`.

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use rps3::control::{HoldingTerm, Profile};
use rps3::dynamics::{Inputs, PlantModel, PlantParameters, settled_currents};
use rps3::study::{Crossing, Distribution, MODES, in_parallel};

const SHARES: [f64; 4] = [0.9, 0.94, 0.97, 0.99];
const WEIGHTS: [f64; 4] = [1e-8, 1e-7, 1e-6, 1e-5];
/// A peak that differs by less than this factor counts as the same.
const CLEAR: f64 = 1.1;

fn main() -> Result<(), std::num::ParseIntError> {
    let count = std::env::args().nth(1).map_or(Ok(300), |argument| argument.parse())?;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let crossings: Vec<_> = (0..count).map(|_| Crossing::random(&PlantParameters::default(), &mut rng)).collect();
    let held: Vec<_> = crossings.into_iter().filter(end_can_be_held).collect();
    println!("{} of {count} crossings end in a pose that three motors can hold; peak pose errors, mm\n", held.len());
    println!("| share | weight, m2/V2 | median | 75 % | 90 % | max | mean | better than without | worse |");
    println!("|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    let without = peaks(&held, &HoldingTerm { weight: 0.0, ..HoldingTerm::default() });
    print_row("-", "0", &without, &without);
    for usable in SHARES {
        for weight in WEIGHTS {
            let with = peaks(&held, &HoldingTerm { usable, weight });
            print_row(&usable.to_string(), &format!("{weight:e}"), &with, &without);
        }
    }
    Ok(())
}

fn end_can_be_held(crossing: &Crossing) -> bool {
    let model = PlantModel::new(&crossing.experiment(false).plant);
    settled_currents(&model, &Vector3::from(crossing.waypoints[2]), &Inputs::zero()).is_some()
}

/// Peak pose error of each crossing under the swarm, mm.
fn peaks(crossings: &[Crossing], holding: &HoldingTerm) -> Vec<f64> {
    in_parallel(crossings, |_, crossing| {
        let mut experiment = crossing.experiment(false);
        experiment.controller.profile = Profile::ConstantSpeed;
        experiment.tuning.holding = *holding;
        let [.., swarm] = MODES;
        swarm.figures(&experiment).peak * 1e3
    })
}

fn print_row(share: &str, weight: &str, peaks: &[f64], without: &[f64]) {
    let changed =
        |is: fn(f64) -> bool| peaks.iter().zip(without).filter(|(with, without)| is(*with / *without)).count();
    let (better, worse) = (changed(|ratio| ratio < 1.0 / CLEAR), changed(|ratio| ratio > CLEAR));
    let mean = peaks.iter().sum::<f64>() / peaks.len() as f64;
    let mut sorted = peaks.to_vec();
    let Distribution { median, ninety, max } = Distribution::of(&mut sorted);
    let three_quarters = sorted[(sorted.len() - 1) * 3 / 4];
    println!(
        "| {share} | {weight} | {median:.3} | {three_quarters:.3} | {ninety:.3} | {max:.3} | {mean:.3} | {better} | {worse} |"
    );
}
