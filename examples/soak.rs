//! Both FMUs coupled for a long time in one process, over their C functions: time, memory and accuracy by
//! window. `cargo xtask soak`, or `cargo run --release --example soak [seconds] [crossings]`.

#[path = "../tests/common/mod.rs"]
mod common;

use common::soak::{Window, random_crossings, to_and_fro};

/// A crossing with its rest, s.
const LAP: f64 = 1.4;
/// Rows of a table.
const WINDOWS: u32 = 12;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let seconds: f64 = arguments.next().map_or(Ok(3600.0), |argument| argument.parse())?;
    let crossings: u32 = arguments.next().map_or(Ok(1000), |argument| argument.parse())?;
    let laps = (seconds / LAP / f64::from(WINDOWS)).ceil() as u32;
    let mut all = true;
    for mode in [3, 4] {
        println!("\nmode {mode}, to and fro through the default singular pose\n");
        all &= table(|observe| to_and_fro(mode, WINDOWS, laps, observe));
    }
    println!("\nmode 4, random crossings, instances reset for each\n");
    all &= table(|observe| random_crossings(4, WINDOWS, crossings.div_ceil(WINDOWS), observe));
    if all { Ok(()) } else { Err("a step failed".into()) }
}

/// Prints the windows of a run as they come; whether no step failed.
fn table(run: impl FnOnce(&mut dyn FnMut(&Window))) -> bool {
    println!(
        "| simulated, s | CPU s a simulated s | resident, kB | peak error, mm | error at rest, mm | faults | failed |"
    );
    println!("| ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    let (mut crossings, mut failed, mut costs) = (0, 0, Vec::new());
    run(&mut |w: &Window| {
        crossings += w.crossings;
        failed += w.failed_steps;
        costs.push(w.cost);
        println!(
            "| {:.0} | {:.3} | {} | {:.2} | {:.3} | {} | {} |",
            f64::from(crossings) * LAP,
            w.cost,
            w.resident.map_or("?".into(), |kilobytes| kilobytes.to_string()),
            1e3 * w.peak_error,
            1e3 * w.end_error,
            w.faults,
            w.failed_steps
        );
    });
    let (first, last) = (costs.first().copied().unwrap_or(0.0), costs.last().copied().unwrap_or(0.0));
    println!(
        "\n{crossings} crossings, {failed} failed steps, last window {:.2} times the first's CPU time",
        last / first
    );
    failed == 0
}
