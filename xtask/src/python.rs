//! The Python interpreters: the one that is installed, and the environment's.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Result, bail};

use crate::workspace;

/// Oldest version for which all pinned packages exist (tests/python/requirements.txt).
const OLDEST: (u32, u32) = (3, 11);

/// An installed Python that is new enough; `PYTHON` in the environment goes first.
///
/// # Errors
/// When there is none; the message lists what was tried.
pub fn find() -> Result<PathBuf> {
    let named = std::env::var_os("PYTHON").map(PathBuf::from);
    let usual = ["python3", "python", "python3.14", "python3.13", "python3.12", "python3.11"].map(PathBuf::from);
    let mut tried = Vec::new();
    for candidate in named.into_iter().chain(usual) {
        match version(&candidate) {
            Some(found) if found >= OLDEST => return Ok(candidate),
            Some((major, minor)) => tried.push(format!("{} is {major}.{minor}", candidate.display())),
            None => tried.push(format!("{} does not start", candidate.display())),
        }
    }
    bail!(
        "Python {}.{} or newer is needed and was not found ({}). Install it (Debian: apt install python3 python3-venv) or \
         name it in the environment variable PYTHON.",
        OLDEST.0,
        OLDEST.1,
        tried.join(", ")
    )
}

fn version(python: &Path) -> Option<(u32, u32)> {
    let output = Command::new(python).args(["-c", "import sys; print(*sys.version_info[:2])"]).output().ok()?;
    let text = String::from_utf8(output.stdout).ok().filter(|_| output.status.success())?;
    let (major, minor) = text.trim().split_once(' ')?;
    Some((major.parse().ok()?, minor.parse().ok()?))
}

/// The environment's interpreter.
pub fn interpreter() -> PathBuf {
    let [directory, name] = if cfg!(windows) { ["Scripts", "python.exe"] } else { ["bin", "python"] };
    workspace::venv().join(directory).join(name)
}

/// A command for the environment's interpreter, in the workspace root.
pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(interpreter());
    command.args(arguments).current_dir(workspace::root()).env("PYTHONUNBUFFERED", "1");
    command
}
