//! `cargo xtask demo`: the study with the packaged FMUs.

use anyhow::Result;
use clap::Args;

use crate::{command, package, python, setup, workspace};

/// Options of `demo`.
#[derive(Debug, Args)]
pub struct Options {
    /// Handed on to the Python study; `-- --help` lists them
    #[arg(last = true)]
    study: Vec<String>,
}

/// Packages the FMUs, couples them in FMPy and writes `dist/report/`.
///
/// # Errors
/// When one of the steps fails.
pub fn run(options: &Options) -> Result<()> {
    setup::run()?;
    package::run(&package::Options::default())?;
    let mut study = python::command(&["-m", "rps3_study.demo"]);
    study.arg("--dist").arg(workspace::dist()).args(&options.study);
    command::run(&mut study)
}
