//! The documentation inside the FMUs, written by the Python package from a run of the FMUs themselves.

use std::fs;
use std::path::PathBuf;

use anyhow::Result;

use crate::archive::Archive;
use crate::fmu::Fmu;
use crate::licenses::Crate;
use crate::{command, python, setup, workspace};

/// What is to be added to the archives of `fmus`, each given without its documentation; a directory for
/// each model identifier.
///
/// # Errors
/// When there is no Python environment, the reference run fails or something cannot be written.
pub fn render(fmus: &[(Fmu, Archive)], crates: &[Crate]) -> Result<PathBuf> {
    setup::run()?;
    let directory = workspace::root().join("target/documentation");
    let (bare, pages) = (directory.join("bare"), directory.join("pages"));
    if pages.exists() {
        fs::remove_dir_all(&pages)?;
    }
    fs::create_dir_all(&bare)?;
    for (fmu, archive) in fmus {
        fs::write(bare.join(fmu.archive_file()), archive.bytes()?)?;
    }
    let list = directory.join("crates.json");
    fs::write(&list, serde_json::to_string_pretty(crates)?)?;
    let mut writer = python::command(&["-m", "rps3_study.fmu_documentation"]);
    writer.arg("--fmus").arg(bare).arg("--crates").arg(list);
    writer.arg("--frames").arg(workspace::root().join("docs/figures/frames.svg")).arg("--out").arg(&pages);
    command::run(&mut writer)?;
    Ok(pages)
}
