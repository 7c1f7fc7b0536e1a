//! Examples of the library whose output is wanted in a file.

use std::fs::{self, File};
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context, Result};

use crate::{command, workspace};

/// Writes what `command` prints to `dist/analysis/<file>`.
///
/// # Errors
/// When the command fails or the file cannot be written.
pub fn print_to(file: &str, command: &mut Command) -> Result<PathBuf> {
    let directory = workspace::dist().join("analysis");
    fs::create_dir_all(&directory).with_context(|| format!("cannot create {}", directory.display()))?;
    let path = directory.join(file);
    let output = File::create(&path).with_context(|| format!("cannot write {}", path.display()))?;
    command::run(command.stdout(output))?;
    Ok(path)
}

/// Runs `examples/<name>.rs` on `input`; what it prints goes to `dist/analysis/<file>`.
///
/// # Errors
/// When the example does not build or run, or the file cannot be written.
pub fn run(name: &str, input: Stdio, file: &str) -> Result<PathBuf> {
    let mut example = command::cargo(&["run", "--quiet", "--package", "rps3", "--example", name]);
    print_to(file, example.stdin(input))
}
