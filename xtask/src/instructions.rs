//! `cargo xtask instructions`: instruction counts of the hot paths against recorded ones.
//!
//! Counts do not depend on how busy the machine is, but on compiler and processor: they are
//! compared only where both are those of the record, and skipped, visibly, elsewhere.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, bail};
use clap::Args;
use serde::{Deserialize, Serialize};

use crate::{command, workspace};

/// Options of `instructions`.
#[derive(Debug, Args, Default)]
pub struct Options {
    /// Record the counts of this build as the new baseline
    #[arg(long)]
    record: bool,
}

/// Functions of examples/instructions.rs and how often it calls each.
const PATHS: [&str; 6] =
    ["right_hand_side", "plant_step", "controller_tick", "fmi_outputs", "fmi_inputs", "fmi_empty_step"];
const CALLS: u64 = 100;
/// Largest relative change that is not a finding.
const BAND: f64 = 0.05;

#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Baseline {
    compiler: String,
    architecture: String,
    /// Instructions a call.
    instructions: BTreeMap<String, u64>,
}

/// Counts, prints, and compares or records.
///
/// # Errors
/// When a count has changed by more than 5 %.
pub fn run(options: &Options) -> Result<()> {
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("instruction counts: skipped, there is no valgrind");
        return Ok(());
    }
    command::run(&mut command::cargo(&[
        "build",
        "--quiet",
        "--release",
        "--package",
        "rps3",
        "--example",
        "instructions",
    ]))?;
    let program = workspace::root().join("target/release/examples/instructions");
    let mut instructions = BTreeMap::new();
    for path in PATHS {
        let output = Command::new("valgrind")
            .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
            .arg(format!("--toggle-collect=*{path}*"))
            .arg(&program)
            .output()?;
        let total = collected(&String::from_utf8_lossy(&output.stderr)).context("callgrind told no count")?;
        instructions.insert(path.to_owned(), total / CALLS);
    }
    let compiler = Command::new("rustc").arg("--version").output()?.stdout;
    let now = Baseline {
        compiler: String::from_utf8_lossy(&compiler).trim().to_owned(),
        architecture: std::env::consts::ARCH.to_owned(),
        instructions,
    };
    if options.record {
        fs::write(record(), serde_json::to_string_pretty(&now)? + "\n")?;
    }
    compare(&now, &serde_json::from_str(&fs::read_to_string(record())?)?)
}

fn record() -> PathBuf {
    workspace::root().join("benches/instructions.json")
}

/// The number in callgrind's line `Collected : N`.
fn collected(stderr: &str) -> Option<u64> {
    stderr.lines().find_map(|line| line.split("Collected :").nth(1)?.trim().parse().ok())
}

fn compare(now: &Baseline, before: &Baseline) -> Result<()> {
    println!("| hot path | instructions a call | recorded | change |\n| --- | ---: | ---: | ---: |");
    let mut worst = 0.0_f64;
    for (path, &count) in &now.instructions {
        let recorded = *before.instructions.get(path).context("path without record")?;
        let change = count as f64 / recorded as f64 - 1.0;
        worst = worst.max(change.abs());
        println!("| {path} | {count} | {recorded} | {:+.1} % |", 100.0 * change);
    }
    if (&now.compiler, &now.architecture) != (&before.compiler, &before.architecture) {
        println!("not compared: recorded with {} on {}", before.compiler, before.architecture);
    } else if worst > BAND {
        bail!("a hot path changed by more than 5 %; if that is meant, `cargo xtask instructions --record`");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn baseline(count: u64, compiler: &str) -> Baseline {
        let instructions = BTreeMap::from([("plant_step".to_owned(), count)]);
        Baseline { compiler: compiler.to_owned(), architecture: "x86_64".to_owned(), instructions }
    }

    #[test]
    fn a_change_beyond_the_band_fails_and_one_within_passes() {
        assert!(compare(&baseline(1040, "a"), &baseline(1000, "a")).is_ok());
        assert!(compare(&baseline(1060, "a"), &baseline(1000, "a")).is_err());
        assert!(compare(&baseline(940, "a"), &baseline(1000, "a")).is_err());
        assert!(compare(&baseline(2000, "b"), &baseline(1000, "a")).is_ok());
    }

    #[test]
    fn callgrind_s_count_is_found() {
        assert_eq!(collected("==1== Events : Ir\n==1== Collected : 2788000\n"), Some(2_788_000));
    }
}
