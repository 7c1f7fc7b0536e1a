//! `cargo xtask demo`: the study with the packaged FMUs.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};
use clap::Args;

use crate::{command, package, python, setup, workspace};

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
    let directory = dist.join("analysis");
    fs::create_dir_all(&directory).with_context(|| format!("cannot create {}", directory.display()))?;
    let (baselines, convergence) = (baselines(&dist, &directory)?, convergence(&directory)?);
    let mut study = python::command(&["-m", "rps3_study.demo"]);
    study.arg("--dist").arg(&dist).arg("--baselines").arg(baselines).arg("--convergence").arg(convergence);
    study.args(&options.study);
    command::run(&mut study)
}

/// Hands the study's tasks to examples/baselines.rs; returns the file of its figures.
fn baselines(dist: &Path, directory: &Path) -> Result<PathBuf> {
    let (tasks, figures) = (directory.join("tasks.json"), directory.join("baselines.json"));
    command::run(python::command(&["-m", "rps3_study.baselines"]).arg("--dist").arg(dist).stdout(create(&tasks)?))?;
    let tasks = File::open(&tasks).with_context(|| format!("cannot read {}", tasks.display()))?;
    command::run(example("baselines").stdin(tasks).stdout(create(&figures)?))?;
    Ok(figures)
}

/// Lets examples/convergence.rs watch the swarm; returns the file of its table.
fn convergence(directory: &Path) -> Result<PathBuf> {
    let table = directory.join("convergence.csv");
    command::run(example("convergence").stdout(create(&table)?))?;
    Ok(table)
}

fn example(name: &str) -> Command {
    command::cargo(&["run", "--quiet", "--package", "rps3", "--example", name])
}

fn create(path: &Path) -> Result<File> {
    File::create(path).with_context(|| format!("cannot write {}", path.display()))
}
