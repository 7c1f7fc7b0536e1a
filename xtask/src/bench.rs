//! `cargo xtask bench`: the table of ratios, `benches/suite` on what is built here.

use anyhow::Result;
use clap::Args;

use crate::{command, package, python, setup, workspace};

/// Options of `bench`.
#[derive(Debug, Args)]
pub struct Options {
    /// Handed on to the suite, e.g. `-- step pair`; `-- --help` tells what there is
    #[arg(last = true)]
    suite: Vec<String>,
}

/// Builds the FMUs and the programs they are compared with, measures, prints the table and writes
/// `dist/bench/`.
///
/// # Errors
/// When something does not build or cannot be measured.
pub fn run(options: &Options) -> Result<()> {
    setup::run()?;
    package::run(&package::Options::default())?;
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "--requirement"];
    command::run(python::command(&pip).arg("benches/requirements.txt"))?;
    let manifest = "--manifest-path=benches/native/Cargo.toml";
    command::run(&mut command::cargo(&["build", "--release", manifest, "--target-dir=target/bench"]))?;
    let mut suite = python::command(&["-m", "suite"]);
    let paths = std::env::join_paths(["benches", "tests/python"].map(|path| workspace::root().join(path)))?;
    suite.env("PYTHONPATH", paths).env("RPS3_BENCH", workspace::root().join("target/bench/release/rps3-bench"));
    command::run(suite.args(&options.suite))
}
