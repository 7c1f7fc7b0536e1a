//! `cargo xtask atlas` and `cargo xtask torque`: an example of the library prints a table, Python draws it.

use std::fs::{self, File};

use anyhow::{Context, Result};

use crate::{command, python, setup, workspace};

/// Writes `dist/analysis/<example>.csv` and the picture beside it, for which Python also reads the
/// files `also`, by their paths from the workspace's root.
///
/// # Errors
/// When the example does not build or run, or the picture cannot be drawn.
pub fn run(example: &str, also: &[&str]) -> Result<()> {
    setup::run()?;
    let directory = workspace::dist().join("analysis");
    fs::create_dir_all(&directory).with_context(|| format!("cannot create {}", directory.display()))?;
    let table = directory.join(example).with_extension("csv");
    let file = File::create(&table).with_context(|| format!("cannot write {}", table.display()))?;
    command::run(command::cargo(&["run", "--quiet", "--package", "rps3", "--example", example]).stdout(file))?;
    let also = also.iter().map(|path| workspace::root().join(path));
    command::run(python::command(&["-m", &format!("rps3_study.{example}")]).arg(&table).args(also))?;
    println!("{} and {}", table.display(), table.with_extension("png").display());
    Ok(())
}
