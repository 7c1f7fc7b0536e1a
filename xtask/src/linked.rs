//! The crates that are linked into the FMUs.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, Result, ensure};
use cargo_metadata::{MetadataCommand, Package, PackageId};

use crate::{command, workspace};

/// Crates of others, and which of them each needs.
#[derive(Debug)]
pub struct Linked {
    /// By name and version.
    pub packages: Vec<Package>,
    /// What each of [`Self::packages`] needs of them.
    pub needs: BTreeMap<PackageId, Vec<PackageId>>,
    /// What our own crates need of them.
    pub direct: Vec<PackageId>,
}

/// What is linked into the FMUs for any of the platforms; no platform stands for the host.
///
/// # Errors
/// When cargo fails.
pub fn crates(triples: &[&str]) -> Result<Linked> {
    let names = names(triples)?;
    let metadata = MetadataCommand::new().current_dir(workspace::root()).exec()?;
    let linked = |package: &&Package| names.contains(&(package.name.to_string(), package.version.to_string()));
    let (mut packages, ours): (Vec<_>, Vec<_>) =
        metadata.packages.iter().filter(linked).cloned().partition(|package| package.source.is_some());
    packages.sort_by_key(|package| (package.name.to_string(), package.version.clone()));

    let order: BTreeMap<_, _> = packages.iter().enumerate().map(|(place, package)| (&package.id, place)).collect();
    let nodes = metadata.resolve.context("cargo resolved nothing")?.nodes;
    let needs = |id: &PackageId| {
        let node = nodes.iter().find(|node| node.id == *id);
        let found =
            node.into_iter().flat_map(|node| &node.dependencies).filter_map(|needed| order.get(needed).copied());
        found.collect::<BTreeSet<_>>()
    };
    let ids = |places: BTreeSet<usize>| places.into_iter().map(|place| packages[place].id.clone()).collect();
    let direct = ids(ours.iter().flat_map(|package| needs(&package.id)).collect());
    let needs = packages.iter().map(|package| (package.id.clone(), ids(needs(&package.id)))).collect();
    Ok(Linked { packages, needs, direct })
}

/// Name and version of what `cargo tree` finds linked: unlike the metadata it leaves out what only tests,
/// build scripts and macros use, and optional parts that the FMUs do not switch on.
fn names(triples: &[&str]) -> Result<BTreeSet<(String, String)>> {
    let mut tree = command::cargo(&["tree", "--package=rps3-plant", "--package=rps3-controller"]);
    tree.args(triples.iter().map(|triple| format!("--target={triple}")));
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
    fn every_linked_crate_is_needed_by_ours_or_by_another() {
        let linked = crates(&[]).unwrap();
        let needed: BTreeSet<_> = linked.needs.values().flatten().chain(&linked.direct).collect();
        assert!(!linked.direct.is_empty());
        assert!(linked.packages.iter().all(|package| needed.contains(&package.id)));
    }
}
