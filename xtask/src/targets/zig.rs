//! Zig, which links for Linux: from PyPI, with cargo-zigbuild, into the Python environment.

use std::env;
use std::process::Command;

use anyhow::{Context, Result};

use crate::{command, python, setup, workspace};

/// Installs what is not yet installed; 100 MB that only a release needs.
///
/// # Errors
/// When that fails.
pub fn install() -> Result<()> {
    setup::run()?;
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "--requirement"];
    let mut pip = python::command(&pip);
    command::run(pip.arg("xtask/src/targets/requirements.txt")).context("cannot install Zig")
}

/// `cargo zigbuild`, which takes the arguments of `cargo build`, with Zig in reach.
pub fn cargo_build() -> Command {
    let scripts = python::interpreter().parent().expect("the interpreter lies in a directory").to_owned();
    let mut cargo = Command::new(scripts.join("cargo-zigbuild"));
    let rest = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths(std::iter::once(scripts).chain(env::split_paths(&rest)));
    cargo.arg("zigbuild").current_dir(workspace::root()).env("PATH", path.unwrap_or(rest));
    cargo.env("CARGO_ZIGBUILD_CACHE_DIR", workspace::root().join("target/zigbuild"));
    cargo
}
