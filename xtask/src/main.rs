//! The project's chores: `cargo xtask <command>`. One module a command; a new command is a module
//! with `run` and a line in [`Task`] and in `main`.
#![forbid(unsafe_code)]

mod analysis;
mod archive;
mod audit;
mod bench;
mod command;
mod demo;
mod describe;
mod documentation;
mod example;
mod fmu;
mod fuzz;
mod instructions;
mod library;
mod licenses;
mod linked;
mod lint;
mod masters;
mod memory;
mod package;
mod platform;
mod python;
mod sbom;
mod setup;
mod soak;
mod ssp;
mod targets;
mod test;
mod workspace;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

#[derive(Parser)]
#[command(name = "cargo xtask", about = "The project's chores", version)]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Create .venv with the pinned Python packages (nothing to do when it is up to date)
    Setup,
    /// Refresh modelDescription/*.xml from the variable tables
    Describe,
    /// Build both FMUs and the SSP package into dist/, for this machine or for all platforms
    Package(package::Options),
    /// Couple the packaged FMUs through the singularity and write dist/report/
    Demo(demo::Options),
    /// Map the direct singularities: dist/analysis/atlas.csv and .png
    Atlas,
    /// Inverse dynamics of the crossing: dist/analysis/torque.csv and .png
    Torque,
    /// Run the FMUs in every master and renew the table in docs/masters.md
    Masters(masters::Options),
    /// Run every test: Rust, then the packaged FMUs through Python
    Test(test::Options),
    /// Count the instructions of the hot paths and compare with the record
    Instructions(instructions::Options),
    /// Measure against other engines and masters: dist/bench/
    Bench(bench::Options),
    /// Check the licenses, sources and advisories of all dependencies with cargo-deny
    Audit(audit::Options),
    /// Run the fuzz targets under libFuzzer
    Fuzz(fuzz::Options),
    /// Look for leaks, growth and races in the shared libraries
    Memory,
    /// Run both FMUs coupled for an hour and through a thousand crossings
    Soak(soak::Options),
    /// Check format, lints, documentation and Python code
    Lint,
}

fn main() -> ExitCode {
    let outcome = match Cli::parse().task {
        Task::Setup => setup::run(),
        Task::Describe => describe::run(),
        Task::Package(options) => package::run(&options),
        Task::Demo(options) => demo::run(&options),
        Task::Atlas => analysis::run("atlas", &["modelDescription/Rps3Controller.xml"]),
        Task::Torque => analysis::run("torque", &[]),
        Task::Masters(options) => masters::run(&options),
        Task::Test(options) => test::run(&options),
        Task::Instructions(options) => instructions::run(&options),
        Task::Bench(options) => bench::run(&options),
        Task::Audit(options) => audit::run(&options),
        Task::Fuzz(options) => fuzz::run(&options),
        Task::Memory => memory::run(),
        Task::Soak(options) => soak::run(&options),
        Task::Lint => lint::run(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // without the backtrace that `main -> Result` would print: what failed is another program
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
