//! The license texts of every crate that is linked into the FMUs.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use cargo_metadata::{MetadataCommand, Package};
use serde::Serialize;

use crate::archive::Archive;
use crate::{command, workspace};

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

/// All crates that are linked into the FMUs for the host, by name.
///
/// # Errors
/// When cargo fails or a crate comes without license.
pub fn linked() -> Result<Vec<Crate>> {
    let linked = linked_names()?;
    let metadata = MetadataCommand::new().current_dir(workspace::root()).exec()?;
    let foreign = metadata.packages.iter().filter(|package| package.source.is_some());
    let mut packages: Vec<_> =
        foreign.filter(|package| linked.contains(&(package.name.to_string(), package.version.to_string()))).collect();
    packages.sort_by_key(|package| (package.name.to_string(), package.version.clone()));
    packages.into_iter().map(Crate::new).collect()
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

/// Name and version of what `cargo tree` finds linked: unlike the metadata it leaves out what only tests,
/// build scripts and macros use, and optional parts that the FMUs do not switch on.
fn linked_names() -> Result<BTreeSet<(String, String)>> {
    let mut tree = command::cargo(&["tree", "--package=rps3-plant", "--package=rps3-controller"]);
    let output = tree.args(["--edges=normal,no-proc-macro", "--prefix=none", "--format={p}"]).output()?;
    ensure!(output.status.success(), "cargo tree failed: {}", String::from_utf8_lossy(&output.stderr));
    Ok(names_in(&String::from_utf8(output.stdout)?))
}

fn names_in(tree: &str) -> BTreeSet<(String, String)> {
    let words = tree.lines().map(str::split_whitespace);
    words
        .filter_map(|mut words| Some((words.next()?.to_owned(), words.next()?.strip_prefix('v')?.to_owned())))
        .collect()
}

fn is_license(file: &str) -> bool {
    let name = file.to_uppercase();
    ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE"].iter().any(|start| name.starts_with(start))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crates_of_a_tree_are_named_once_with_their_versions() {
        let tree = "rps3-plant v0.1.0 (/somewhere)\nlibc v0.2.1\nserde v1.0.2\nlibc v0.2.1 (*)\n\n";
        let expected = [("libc", "0.2.1"), ("rps3-plant", "0.1.0"), ("serde", "1.0.2")];
        assert_eq!(names_in(tree), expected.map(|(name, version)| (name.into(), version.into())).into());
    }

    #[test]
    fn every_linked_crate_brings_its_license() {
        let crates = linked().unwrap();
        assert!(crates.iter().any(|one| one.name == "nalgebra"));
        assert!(crates.iter().all(|one| !one.name.starts_with("rps3") && !one.sources.is_empty()));
    }
}
