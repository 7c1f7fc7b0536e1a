//! Prints what the sensor errors of Table 1 cost on the default crossing, by the pose filter's time constant and by
//! whether the controller knows that lengths can have a static error:
//! `cargo run --release --example sensing [seeds, default 40]`.

use nalgebra::Vector3;
use rand::distr::{Distribution as _, Uniform};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rps3::control::{Controller, ReferencePoint};
use rps3::coupling::Experiment;
use rps3::defaults as d;
use rps3::dynamics::PlantModel;
use rps3::study::{Crossing, Distribution};

/// From here on the estimate has settled, s.
const SETTLED: f64 = 0.2;

fn main() -> anyhow::Result<()> {
    let seeds = std::env::args().nth(1).map_or(Ok(40), |argument| argument.parse())?;
    println!("Default crossing in mode 4; largest errors of {seeds} seeds, median and 90 %, mm.\n");
    println!("| motors | static error | filter, s | estimate | estimate after {SETTLED} s | pose | pose at the end |");
    println!("|---|---|---:|---|---|---|---|");
    for (variant, revolute_motors) in [("six", true), ("three", false)] {
        for (name, bias, known) in [
            ("none", 0.0, true),
            ("up to 3 mm", d::SENSOR_LENGTH_BIAS, true),
            ("up to 3 mm, not estimated", d::SENSOR_LENGTH_BIAS, false),
        ] {
            for filter_time in [0.0, d::FILTER_TIME, 0.2] {
                let mut experiment = Crossing::default().experiment(revolute_motors);
                experiment.controller.sensors.scale = 1.0;
                experiment.controller.sensors.length_bias = if known { bias } else { 0.0 };
                experiment.controller.filter_time = filter_time;
                let mut columns = [const { Vec::new() }; 4];
                for seed in 0..seeds {
                    experiment.controller.seed = seed;
                    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
                    let unknown = if known { Vector3::zeros() } else { static_errors(&mut rng, bias) };
                    for (column, peak) in columns.iter_mut().zip(peaks(&experiment, &unknown)) {
                        column.push(peak * 1e3);
                    }
                }
                let cells = columns.map(|mut column| {
                    let Distribution { median, ninety, .. } = Distribution::of(&mut column);
                    format!("{median:.2}, {ninety:.2}")
                });
                println!("| {variant} | {name} | {filter_time} | {} |", cells.join(" | "));
            }
        }
    }
    Ok(())
}

/// Static errors of three lengths, m, uniform within +-`largest`.
fn static_errors(rng: &mut impl Rng, largest: f64) -> Vector3<f64> {
    let uniform = Uniform::new_inclusive(-largest, largest).expect("a range");
    Vector3::from_fn(|_, _| uniform.sample(rng))
}

/// Largest errors of the estimate over the run and after [`SETTLED`], of the pose over the run and at its end, m;
/// `unknown` is added to the lengths.
fn peaks(experiment: &Experiment, unknown: &Vector3<f64>) -> [f64; 4] {
    let r_b = PlantModel::<f64>::without_stops(&experiment.plant.mechanism).geometry.joint_radius;
    let mut controller = Controller::new(experiment.controller).expect("parameters that make sense");
    let external = ReferencePoint::default();
    let mut peaks = [0.0_f64; 4];
    let outcome = experiment.run_with(
        |t, measured| {
            let mut measured = *measured;
            measured.lengths += unknown;
            controller.tick(t, &measured, &external, &experiment.tuning, true)
        },
        |record| {
            let (estimated, pose) = (record.estimate_error(r_b), record.pose_error(r_b));
            peaks[0] = peaks[0].max(estimated);
            if record.time >= SETTLED {
                peaks[1] = peaks[1].max(estimated);
            }
            peaks[2] = peaks[2].max(pose);
            peaks[3] = pose;
        },
    );
    if outcome.is_ok() { peaks } else { [f64::INFINITY; 4] }
}
