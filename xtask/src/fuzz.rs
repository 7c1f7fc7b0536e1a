//! `cargo xtask fuzz`: the fuzz targets under libFuzzer, which breeds inputs that reach new code.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

use anyhow::{Result, bail};
use clap::Args;

use crate::{command, library, workspace};

/// The targets in `fuzz/fuzz_targets/`.
const TARGETS: [&str; 3] = ["calls", "states", "parameters"];

/// Coverage as libFuzzer wants it: counters, program locations and compared values.
const COVERAGE: [&str; 6] = [
    "-Cpasses=sancov-module",
    "-Cllvm-args=-sanitizer-coverage-level=4",
    "-Cllvm-args=-sanitizer-coverage-inline-8bit-counters",
    "-Cllvm-args=-sanitizer-coverage-pc-table",
    "-Cllvm-args=-sanitizer-coverage-trace-compares",
    "-Ccodegen-units=1",
];

/// Options of `fuzz`.
#[derive(Debug, Args)]
pub struct Options {
    /// Minutes for each target
    #[arg(long, default_value_t = 10)]
    minutes: u64,
    /// Only this target: calls, states or parameters
    #[arg(long, value_parser = TARGETS)]
    target: Option<String>,
    /// With AddressSanitizer (slower; switches the stable compiler's unstable options on)
    #[arg(long)]
    address_sanitizer: bool,
}

/// Builds the targets with coverage and runs them one after the other. What they find is left in
/// `fuzz/artifacts/`; a finding worth keeping goes to `fuzz/regressions/`, which every
/// `cargo test` runs.
///
/// # Errors
/// When a target finds something, ends before its time without a finding, or cannot be built.
pub fn run(options: &Options) -> Result<()> {
    let directory = workspace::root().join("fuzz");
    let binaries = build(&directory, options.address_sanitizer)?;
    let mut failures = Vec::new();
    for target in TARGETS {
        if options.target.as_ref().is_some_and(|only| only != target) {
            continue;
        }
        let artifacts = directory.join("artifacts").join(target);
        // what libFuzzer breeds stays out of the committed seeds
        let bred = directory.join("target/corpus").join(target);
        let seeds = directory.join("corpus").join(target);
        for path in [&artifacts, &bred] {
            fs::create_dir_all(path)?;
        }
        let mut fuzzer = Command::new(binaries.join(target));
        fuzzer.arg(bred);
        if seeds.is_dir() {
            fuzzer.arg(seeds);
        }
        fuzzer
            .arg(format!("-max_total_time={}", 60 * options.minutes))
            .arg(format!("-artifact_prefix={}/", artifacts.display()))
            // the harness measures each call's CPU time; this limit is for calls that never return
            .args([
                "-max_len=2048",
                "-len_control=0",
                "-timeout=3000",
                "-report_slow_units=600",
                "-rss_limit_mb=4096",
                "-print_final_stats=1",
            ])
            .env("RUST_BACKTRACE", "1");
        let before = findings(&artifacts)?;
        if let Err(error) = command::run(&mut fuzzer) {
            failures.push(if findings(&artifacts)? == before {
                format!("{target} found nothing, but was cut short: {error:#}")
            } else {
                format!("{target} found something, see fuzz/artifacts/{target}/")
            });
        }
    }
    if !failures.is_empty() {
        bail!("{}", failures.join("\n"));
    }
    Ok(())
}

/// Inputs that broke a promise, crashed, hung or took too much memory, with the time they were written. Slow ones, of
/// which libFuzzer only takes note, do not count.
fn findings(artifacts: &Path) -> Result<BTreeMap<PathBuf, SystemTime>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(artifacts)? {
        let entry = entry?;
        if !entry.file_name().to_string_lossy().starts_with("slow-unit-") {
            found.insert(entry.path(), entry.metadata()?.modified()?);
        }
    }
    Ok(found)
}

/// The directory with the targets' binaries.
fn build(directory: &Path, address_sanitizer: bool) -> Result<PathBuf> {
    let host = library::host()?;
    let manifest = format!("--manifest-path={}", directory.join("Cargo.toml").display());
    // named, so that build scripts are compiled without the flags
    let mut cargo = command::cargo(&["build", "--release", "--target", &host, &manifest]);
    let mut flags = COVERAGE.to_vec();
    if address_sanitizer {
        flags.push("-Zsanitizer=address");
        cargo.env("RUSTC_BOOTSTRAP", "1");
    }
    cargo.env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"));
    command::run(&mut cargo)?;
    Ok(directory.join("target").join(host).join("release"))
}
