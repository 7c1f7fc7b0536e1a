//! Time of a controller tick in each mode over the default crossing, with the default swarm:
//! `cargo run --release --example tick_times [runs, default 20]`.
//!
//! Every tick is measured in several runs. Its fastest time is what the computation takes; the times as they
//! came have in them what else the machine did. Quantiles are over the ticks of the crossing.

use std::time::Instant;

use rps3::control::{Controller, Mode, ReferencePoint, Tuning};
use rps3::study::{Crossing, Distribution};

fn main() -> anyhow::Result<()> {
    let runs = std::env::args().nth(1).map_or(Ok(20), |argument| argument.parse())?;
    println!(
        "| motors | mode | fastest of {runs} runs, us: median | 99 % | largest | as they came, us: median | 99 % |"
    );
    println!("|---|---|---:|---:|---:|---:|---:|");
    for (variant, revolute_motors) in [("six", true), ("three", false)] {
        for (name, mode) in [("RAC", Mode::Rac), ("HDRAC", Mode::Hdrac), ("HDRAC+MPSO", Mode::HdracMpso)] {
            let mut experiment = Crossing::default().experiment(revolute_motors);
            experiment.tuning = Tuning { mode, ..experiment.tuning };
            let (mut fastest, mut all) = (Vec::new(), Vec::new());
            for run in 0..runs {
                for (tick, time) in tick_times(&experiment)?.into_iter().enumerate() {
                    all.push(time);
                    if run == 0 {
                        fastest.push(time);
                    } else {
                        fastest[tick] = fastest[tick].min(time);
                    }
                }
            }
            let quantile = |times: &mut Vec<f64>, share: f64| {
                times.sort_unstable_by(f64::total_cmp);
                times[(share * (times.len() - 1) as f64) as usize]
            };
            let Distribution { median, max, .. } = Distribution::of(&mut fastest);
            let (ninety_nine, usual) = (quantile(&mut fastest, 0.99), quantile(&mut all, 0.5));
            println!(
                "| {variant} | {name} | {median:.1} | {ninety_nine:.1} | {max:.1} | {usual:.1} | {:.1} |",
                quantile(&mut all, 0.99)
            );
        }
    }
    Ok(())
}

/// Times of the ticks of a run, us.
fn tick_times(experiment: &rps3::coupling::Experiment) -> anyhow::Result<Vec<f64>> {
    let mut controller = Controller::new(experiment.controller)?;
    let external = ReferencePoint::default();
    let mut times = Vec::new();
    experiment.run_with(
        |t, measured| {
            let start = Instant::now();
            let diagnostics = controller.tick(t, measured, &external, &experiment.tuning, true);
            times.push(start.elapsed().as_secs_f64() * 1e6);
            diagnostics
        },
        |_| {},
    )?;
    Ok(times)
}
