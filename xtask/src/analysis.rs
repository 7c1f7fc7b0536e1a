//! `cargo xtask atlas` and `cargo xtask torque`: an example of the library prints a table, Python draws it.

use std::process::Stdio;

use anyhow::Result;

use crate::{command, example, python, setup, workspace};

/// Writes `dist/analysis/<name>.csv` and the picture beside it, for which Python also reads the
/// files `also`, by their paths from the workspace's root.
///
/// # Errors
/// When the example does not build or run, or the picture cannot be drawn.
pub fn run(name: &str, also: &[&str]) -> Result<()> {
    setup::run()?;
    let table = example::run(name, Stdio::null(), &format!("{name}.csv"))?;
    let also = also.iter().map(|path| workspace::root().join(path));
    command::run(python::command(&["-m", &format!("rps3_study.{name}")]).arg(&table).args(also))?;
    println!("{} and {}", table.display(), table.with_extension("png").display());
    Ok(())
}
