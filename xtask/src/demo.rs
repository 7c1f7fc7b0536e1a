//! `cargo xtask demo`: the study with the packaged FMUs.

use std::fs::File;
use std::process::Stdio;

use anyhow::{Context, Result};
use clap::Args;

use crate::{command, example, package, python, setup, workspace};

/// Options of `demo`.
#[derive(Debug, Args)]
pub struct Options {
    /// Handed on to the Python study; `-- --help` lists them
    #[arg(last = true)]
    study: Vec<String>,
}

/// Packages the FMUs, couples them in FMPy, runs the baselines and watches the swarm in process, and writes `dist/report/`.
///
/// # Errors
/// When one of the steps fails.
pub fn run(options: &Options) -> Result<()> {
    setup::run()?;
    package::run(&package::Options::default())?;
    let dist = workspace::dist();
    let mut tasks = python::command(&["-m", "rps3_study.baselines"]);
    let tasks = example::print_to("tasks.json", tasks.arg("--dist").arg(&dist))?;
    let tasks = File::open(&tasks).with_context(|| format!("cannot read {}", tasks.display()))?;
    let baselines = example::run("baselines", tasks.into(), "baselines.json")?;
    let convergence = example::run("convergence", Stdio::null(), "convergence.csv")?;
    let mut study = python::command(&["-m", "rps3_study.demo"]);
    study.arg("--dist").arg(&dist).arg("--baselines").arg(baselines).arg("--convergence").arg(convergence);
    command::run(study.args(&options.study))
}
