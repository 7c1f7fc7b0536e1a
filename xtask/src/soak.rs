//! `cargo xtask soak`: both FMUs coupled for a long time.

use anyhow::Result;
use clap::Args;

use crate::command;

/// Options of `soak`.
#[derive(Debug, Args)]
pub struct Options {
    /// Simulated time of the pair that moves to and fro, s, in each of the modes 3 and 4
    #[arg(long, default_value_t = 3600.0)]
    seconds: f64,
    /// Random crossings
    #[arg(long, default_value_t = 1000)]
    crossings: u32,
}

/// Runs `examples/soak.rs`.
///
/// # Errors
/// When a step of the pair fails.
pub fn run(options: &Options) -> Result<()> {
    let mut example = command::cargo(&["run", "--quiet", "--release", "--package", "rps3", "--example", "soak", "--"]);
    command::run(example.arg(options.seconds.to_string()).arg(options.crossings.to_string()))
}
