//! `cargo xtask audit`: licenses, sources, bans and advisories of all dependencies, by cargo-deny.

use std::process::Command;

use anyhow::{Context, Result, ensure};
use clap::Args;

use crate::command;

/// The version that deny.toml is written for.
const VERSION: &str = "0.20.2";

/// Options of `audit`.
#[derive(Debug, Args)]
pub struct Options {
    /// Ask the RustSec database, too, which is fetched from GitHub
    #[arg(long)]
    advisories: bool,
}

/// Checks what deny.toml says; without advisories nothing is fetched.
///
/// # Errors
/// When cargo-deny is not installed or finds something.
pub fn run(options: &Options) -> Result<()> {
    let version = Command::new("cargo-deny").arg("--version").output();
    let version = version.with_context(|| {
        format!("cargo-deny is missing: `cargo install --locked cargo-deny@{VERSION}`, some minutes of compiling")
    })?;
    ensure!(version.status.success(), "cargo-deny does not start");
    let checks: &[&str] = if options.advisories { &["all"] } else { &["bans", "licenses", "sources"] };
    command::run(command::cargo(&["deny", "--all-features", "check"]).args(checks))?;
    if !options.advisories {
        println!("advisories: not asked for (--advisories)");
    }
    Ok(())
}
