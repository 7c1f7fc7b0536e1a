//! Prints what the sensor errors of Table 1 cost on the default crossing, by the pose filter's time constant:
//! `cargo run --release --example sensing [seeds, default 40]`.

use nalgebra::Vector3;
use rps3::coupling::{Experiment, Record};
use rps3::dynamics::PlantModel;
use rps3::study::{Crossing, Distribution, MODES};

/// From here on the estimate has settled, s.
const SETTLED: f64 = 0.2;

fn main() -> anyhow::Result<()> {
    let seeds = std::env::args().nth(1).map_or(Ok(40), |argument| argument.parse())?;
    println!("Default crossing in mode 4; largest errors of {seeds} seeds in mm, median and 90 %.\n");
    println!(
        "| motors | static error, mm | filter, s | estimate | estimate after {SETTLED} s | pose | pose after {SETTLED} s | pose at the end |"
    );
    println!("|---|---:|---:|---|---|---|---|---|");
    for (variant, revolute_motors) in [("six", true), ("three", false)] {
        for length_bias in [0.0, 3e-3] {
            for filter_time in [0.0, 0.02, 0.05, 0.2, 1.0] {
                let mut experiment = Crossing::default().experiment(revolute_motors);
                experiment.controller.sensors.scale = 1.0;
                experiment.controller.sensors.length_bias = length_bias;
                experiment.controller.filter_time = filter_time;
                let mut columns = [const { Vec::new() }; 5];
                for seed in 0..seeds {
                    experiment.controller.seed = seed;
                    for (column, peak) in columns.iter_mut().zip(peaks(&experiment)) {
                        column.push(peak * 1e3);
                    }
                }
                let cells = columns.map(|mut column| {
                    let Distribution { median, ninety, .. } = Distribution::of(&mut column);
                    format!("{median:.2}, {ninety:.2}")
                });
                println!("| {variant} | {} | {filter_time} | {} |", length_bias * 1e3, cells.join(" | "));
            }
        }
    }
    Ok(())
}

/// Largest errors of the estimate and of the pose, m: over the run and after [`SETTLED`]; of the pose at the end.
fn peaks(experiment: &Experiment) -> [f64; 5] {
    let r_b = PlantModel::<f64>::without_stops(&experiment.plant.mechanism).geometry.joint_radius;
    let mut peaks = [0.0_f64; 5];
    let outcome = MODES[5].run(experiment, |record: &Record| {
        let s = Vector3::new(record.state[0], record.state[1], record.state[2]);
        let estimated = (record.diagnostics.estimate - s).component_mul(&Vector3::new(1.0, r_b, r_b)).amax();
        let pose = record.pose_error(r_b);
        peaks[0] = peaks[0].max(estimated);
        peaks[2] = peaks[2].max(pose);
        if record.time >= SETTLED {
            peaks[1] = peaks[1].max(estimated);
            peaks[3] = peaks[3].max(pose);
        }
        peaks[4] = pose;
    });
    if outcome.is_ok() { peaks } else { [f64::INFINITY; 5] }
}
