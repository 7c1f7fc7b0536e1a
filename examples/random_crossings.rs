//! Peak pose errors over random crossings: tilt 3 to 12 deg in any direction, any sheet of the
//! singular surface within the joints' limits, three and six motors, with and without noise on the
//! limb lengths; with `constant-speed` at constant speed instead of the quintic profile. Prints the distribution
//! for each mode and every crossing in which the swarm is worse than the best fixed damping, with the likely cause:
//! `cargo run --release --example random_crossings [crossings, default 500] [constant-speed]`.

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use rps3::control::Profile;
use rps3::coupling::Experiment;
use rps3::defaults::DEG;
use rps3::dynamics::{Inputs, PlantModel, PlantParameters, settled_currents};
use rps3::study::{Crossing, Distribution, Figures, MODES, in_parallel};

/// Standard deviations of the noise on the limb lengths, m.
const NOISES: [f64; 2] = [0.0, 1e-4];

fn main() -> anyhow::Result<()> {
    let count = std::env::args().nth(1).map_or(Ok(500), |argument| argument.parse())?;
    let profile = match std::env::args().nth(2).as_deref() {
        None => Profile::Quintic,
        Some("constant-speed") => Profile::ConstantSpeed,
        Some(other) => anyhow::bail!("unknown option {other}"),
    };
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let crossings: Vec<_> = (0..count).map(|_| Crossing::random(&PlantParameters::default(), &mut rng)).collect();
    for (variant, revolute_motors) in [("six motors", true), ("three motors", false)] {
        for length_noise in NOISES {
            println!("\n{variant}, {profile:?}, length noise {} mm: peak pose error, mm\n", length_noise * 1e3);
            let results = in_parallel(&crossings, |k, crossing| {
                let mut experiment =
                    Experiment { length_noise, noise_seed: k as u64, ..crossing.experiment(revolute_motors) };
                experiment.controller.profile = profile;
                MODES.map(|scheme| scheme.figures(&experiment))
            });
            print_distributions(&results);
            let model = PlantModel::new(&crossings[0].experiment(revolute_motors).plant);
            print_losses(&model, &crossings, &results);
        }
    }
    Ok(())
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

/// What the motors cannot hold of a crossing: kinds of crossings, from the hardest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    EndCannotBeHeld,
    StretchCannotBeHeld,
    HeldButNextToTheSingularity,
}

impl Kind {
    const ALL: [Self; 3] = [Self::EndCannotBeHeld, Self::StretchCannotBeHeld, Self::HeldButNextToTheSingularity];
    /// Share of a path next to the singular pose that three motors never hold.
    const USUAL: f64 = 0.1;

    fn of(model: &PlantModel<f64>, crossing: &Crossing) -> Self {
        let [start, _, end] = crossing.waypoints.map(Vector3::from);
        let points = 200;
        let held =
            |k: usize| settled_currents(model, &start.lerp(&end, k as f64 / points as f64), &Inputs::zero()).is_some();
        let lost = (0..=points).filter(|k| !held(*k)).count() as f64 / points as f64;
        if !held(points) {
            Self::EndCannotBeHeld
        } else if lost > Self::USUAL {
            Self::StretchCannotBeHeld
        } else {
            Self::HeldButNextToTheSingularity
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::EndCannotBeHeld => "the motors cannot hold the end",
            Self::StretchCannotBeHeld => "the motors cannot hold more than 10 % of the path",
            Self::HeldButNextToTheSingularity => "held but next to the singular pose",
        }
    }
}

/// The swarm's peaks by kind, and the crossings in which a fixed damping does better.
fn print_losses(model: &PlantModel<f64>, crossings: &[Crossing], results: &[[Figures; MODES.len()]]) {
    let kinds: Vec<_> = crossings.iter().map(|crossing| Kind::of(model, crossing)).collect();
    println!("\n| kind of crossing | crossings | median | 90 % | max | swarm worse |\n|---|---|---|---|---|---|");
    for kind in Kind::ALL {
        let of_kind: Vec<_> = results.iter().zip(&kinds).filter(|(_, k)| **k == kind).map(|(f, _)| f).collect();
        if of_kind.is_empty() {
            continue;
        }
        let mut peaks: Vec<_> = of_kind.iter().map(|figures| figures[MODES.len() - 1].peak * 1e3).collect();
        let worse = of_kind.iter().filter(|figures| swarm_is_worse(figures)).count();
        let Distribution { median, ninety, max } = Distribution::of(&mut peaks);
        println!("| {} | {} | {median:.3} | {ninety:.3} | {max:.3} | {worse} |", kind.name(), of_kind.len());
    }
    println!();
    for ((crossing, figures), kind) in crossings.iter().zip(results).zip(&kinds) {
        let (best, name) = best_fixed(figures);
        if swarm_is_worse(figures) {
            let [heave, x, y] = crossing.waypoints[1];
            println!(
                "swarm worse: heave {:.2} cm, tilt {:.2} deg, direction {:.1} deg: {:.3} mm, {name} {:.3} mm; {}",
                heave * 1e2,
                x.hypot(y) / DEG,
                y.atan2(x) / DEG,
                figures[MODES.len() - 1].peak * 1e3,
                best * 1e3,
                kind.name()
            );
        }
    }
}

/// Peak (m) and name of the best fixed damping.
fn best_fixed(figures: &[Figures; MODES.len()]) -> (f64, &'static str) {
    let [fixed @ .., _] = figures;
    fixed
        .iter()
        .zip(MODES)
        .filter(|(f, _)| f.failure.is_none())
        .map(|(f, scheme)| (f.peak, scheme.name))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap_or((f64::INFINITY, "none"))
}

fn swarm_is_worse(figures: &[Figures; MODES.len()]) -> bool {
    // (a NaN counts as worse)
    let swarm = figures[MODES.len() - 1].peak;
    swarm.partial_cmp(&best_fixed(figures).0).is_none_or(std::cmp::Ordering::is_gt)
}
