//! The license texts of every crate that is linked into the FMUs.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use cargo_metadata::Package;
use serde::Serialize;

use crate::archive::Archive;
use crate::linked::Linked;

/// A linked crate, as the documentation's table names it.
#[derive(Debug, Serialize)]
pub struct Crate {
    name: String,
    version: String,
    /// SPDX expression.
    license: String,
    /// Its license files, relative to `documentation/`.
    files: Vec<String>,
    #[serde(skip)]
    sources: Vec<PathBuf>,
}

impl Crate {
    fn new(package: &Package) -> Result<Self> {
        let directory = package.manifest_path.parent().context("a manifest without directory")?;
        let name = format!("{}-{}", package.name, package.version);
        let mut sources = Vec::new();
        for entry in fs::read_dir(directory).with_context(|| format!("cannot read {directory}"))? {
            let entry = entry?;
            if entry.file_type()?.is_file() && is_license(&entry.file_name().to_string_lossy()) {
                sources.push(entry.path());
            }
        }
        sources.sort();
        ensure!(!sources.is_empty(), "{name} comes without its license's text");
        let file_names = sources.iter().filter_map(|path| path.file_name());
        Ok(Self {
            version: package.version.to_string(),
            license: package.license.clone().with_context(|| format!("{name} names no license"))?,
            files: file_names.map(|file| format!("licenses/third-party/{name}/{}", file.to_string_lossy())).collect(),
            name: package.name.to_string(),
            sources,
        })
    }
}

/// The licenses of linked crates.
///
/// # Errors
/// When a crate comes without.
pub fn of(crates: &Linked) -> Result<Vec<Crate>> {
    crates.packages.iter().map(Crate::new).collect()
}

/// The page of licenses that the compiler brings for the standard library, which the FMUs link too; `None`, visibly, where
/// the compiler was installed without.
///
/// # Errors
/// When the compiler does not say where it is.
pub fn of_the_standard_library() -> Result<Option<PathBuf>> {
    let output = Command::new("rustc").args(["--print", "sysroot"]).output().context("cannot start rustc")?;
    let sysroot = PathBuf::from(String::from_utf8(output.stdout)?.trim());
    let page = sysroot.join("share/doc/rust/COPYRIGHT-library.html");
    if page.exists() {
        return Ok(Some(page));
    }
    println!("licenses of the standard library: left out, the compiler comes without {}", page.display());
    Ok(None)
}

/// Adds the license texts of `crates` to an FMU's archive.
///
/// # Errors
/// When one cannot be read.
pub fn insert(archive: &mut Archive, crates: &[Crate]) -> Result<()> {
    for (file, source) in crates.iter().flat_map(|one| one.files.iter().zip(&one.sources)) {
        archive.insert_file(format!("documentation/{file}"), source)?;
    }
    Ok(())
}

fn is_license(file: &str) -> bool {
    let name = file.to_uppercase();
    ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE"].iter().any(|start| name.starts_with(start))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linked;

    #[test]
    fn every_linked_crate_brings_its_license() {
        let crates = of(&linked::crates(&[]).unwrap()).unwrap();
        assert!(crates.iter().any(|one| one.name == "nalgebra"));
        assert!(crates.iter().all(|one| !one.name.starts_with("rps3") && !one.sources.is_empty()));
    }
}
