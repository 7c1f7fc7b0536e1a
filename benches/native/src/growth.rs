//! Many instances, long runs.

use std::fs;

use anyhow::{Context, Result};
use rps3::control::{Mode, Tuning};
use rps3::coupling::Experiment;
use serde_json::{Value, json};

use crate::crossing::TICK;
use crate::fmu::{Fmu, Instance};
use crate::pair::{self, Wires};
use crate::seconds;

/// Ticks that are timed, of all pairs together and of each at least.
const TICKS: usize = 20_000;
const LEAST_TICKS: usize = 20;
const DRAC: i32 = 2;

/// Resident bytes an instance of each FMU (initialized and stepped once), and seconds a tick of a pair
/// when all pairs are stepped in turn.
pub fn instances(plant: &str, controller: &str, count: usize, threads: usize) -> Result<Value> {
    let wires = Wires::new()?;
    let (plant, controller) = (Fmu::load(plant)?, Fmu::load(controller)?);
    // what all instances share is there before any is counted
    let first = pair::instances(plant, controller, &wires, DRAC)?;
    let before = resident()?;
    let mut pairs = Vec::with_capacity(count);
    for _ in 0..count {
        let mut pair = pair::instances(plant, controller, &wires, DRAC)?;
        step(&mut pair, &wires, 0)?;
        pairs.push(pair);
    }
    let after = resident()?;
    let (share, ticks) = (count.div_ceil(threads), LEAST_TICKS.max(TICKS / count));
    let mut outcomes = Vec::new();
    let elapsed = seconds(|| {
        std::thread::scope(|scope| {
            let workers: Vec<_> = pairs
                .chunks_mut(share)
                .map(|pairs| {
                    let wires = &wires;
                    scope.spawn(move || -> Result<()> {
                        for k in 1..=ticks {
                            for pair in &mut *pairs {
                                step(pair, wires, k)?;
                            }
                        }
                        Ok(())
                    })
                })
                .collect();
            outcomes = workers.into_iter().map(|worker| worker.join()).collect();
        });
    });
    for outcome in outcomes {
        outcome.ok().context("a thread panicked")??;
    }
    drop(first);
    Ok(json!({
        "bytes": (after.saturating_sub(before)) as f64 / count as f64,
        "seconds": elapsed / (count * ticks) as f64,
    }))
}

fn step((plant, controller): &mut (Instance, Instance), wires: &Wires, k: usize) -> Result<()> {
    let time = k as f64 * TICK;
    let mut values = [0.0; 64];
    let measured = &mut values[..wires.measured[0].len()];
    plant.get(&wires.measured[0], measured)?;
    controller.set(&wires.measured[1], measured)?;
    controller.step(time, TICK)?;
    let voltages = &mut values[..wires.voltages[0].len()];
    controller.get(&wires.voltages[0], voltages)?;
    plant.set(&wires.voltages[1], voltages)?;
    plant.step(time, TICK)
}

/// Seconds a tick and resident bytes of each simulated minute of one run.
pub fn long_run(minutes: usize) -> Result<Value> {
    const TICKS_A_MINUTE: u64 = 60_000;
    let experiment = Experiment {
        tuning: Tuning { mode: Mode::Hdrac, ..Tuning::default() },
        duration: 60.0 * minutes as f64,
        tolerance: 1e-7,
        ..Experiment::default()
    };
    let (mut rows, mut tick, mut begin) = (Vec::new(), 0_u64, std::time::Instant::now());
    let mut last = None;
    experiment.run(|record| {
        last = Some(*record);
        tick += 1;
        if tick % TICKS_A_MINUTE == 0 {
            rows.push(json!({
                "seconds": begin.elapsed().as_secs_f64() / TICKS_A_MINUTE as f64,
                "bytes": resident().unwrap_or(0),
            }));
            begin = std::time::Instant::now();
        }
    })?;
    Ok(json!({ "minutes": rows, "pose_error": last.map(|record| record.pose_error(1.0)) }))
}

/// Memory that this process occupies, bytes (Linux).
fn resident() -> Result<usize> {
    let status = fs::read_to_string("/proc/self/status").context("resident memory is read from /proc")?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).context("no VmRSS")?;
    let kilobytes: usize = line.split_whitespace().nth(1).context("no number")?.parse()?;
    Ok(1024 * kilobytes)
}
