//! `cargo xtask setup`: the Python environment.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Duration;

use anyhow::{Context, Result, bail};
use indicatif::ProgressBar;

use crate::{command, python, workspace};

/// What the environment was made of; it is made anew when one of them changes.
const SOURCES: [&str; 3] =
    ["tests/python/requirements.txt", "python/pyproject.toml", "python/rps3_study/report_page/vendored.txt"];

/// Creates or renews `.venv`, unless it is up to date.
///
/// # Errors
/// When no usable Python is installed or the packages cannot be installed.
pub fn run() -> Result<()> {
    let stamp = workspace::venv().join("rps3-sources.txt");
    let wanted = sources()?;
    if python::interpreter().exists() && fs::read_to_string(&stamp).is_ok_and(|made_of| made_of == wanted) {
        eprintln!(".venv is up to date");
        return Ok(());
    }
    let base = python::find()?;
    quietly(Command::new(&base).args(["-m", "venv", "--clear"]).arg(workspace::venv()))
        .context("cannot create .venv (Debian and Ubuntu need the package python3-venv)")?;
    let pip = ["-m", "pip", "install", "--disable-pip-version-check", "--no-input"];
    quietly(python::command(&pip).args(["--requirement", SOURCES[0]]))?;
    quietly(python::command(&pip).args(["--no-deps", "--requirement", SOURCES[2]]))?;
    quietly(python::command(&pip).args(["--no-deps", "--no-build-isolation", "--editable", "python"]))?;
    fs::write(&stamp, wanted)?;
    eprintln!("created .venv");
    Ok(())
}

/// Directory of the environment's libclang, once there is one.
pub fn libclang() -> Option<PathBuf> {
    let library = if cfg!(windows) { "Lib/site-packages" } else { "lib" };
    let packages = if cfg!(windows) {
        workspace::venv().join(library)
    } else {
        let versions = fs::read_dir(workspace::venv().join(library)).ok()?;
        versions.flatten().map(|entry| entry.path().join("site-packages")).find(|path| path.exists())?
    };
    Some(packages.join("clang/native")).filter(|path| path.exists())
}

fn sources() -> Result<String> {
    let mut text = String::new();
    for source in SOURCES {
        let path = workspace::root().join(source);
        text += &fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    }
    Ok(text)
}

/// Runs a long command behind a spinner and shows its output only when it fails.
fn quietly(command: &mut Command) -> Result<()> {
    let spinner = ProgressBar::new_spinner().with_message(command::show(command));
    spinner.enable_steady_tick(Duration::from_millis(100));
    let output =
        command.stdin(Stdio::null()).output().with_context(|| format!("cannot start {}", command::show(command)));
    spinner.finish_and_clear();
    let output = output?;
    if !output.status.success() {
        eprint!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        bail!("{} ended with {}", command::show(command), output.status);
    }
    Ok(())
}
