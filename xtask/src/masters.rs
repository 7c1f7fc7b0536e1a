//! `cargo xtask masters`: the FMUs in every master, and the table of results in docs/masters.md.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use clap::Args;
use serde::Deserialize;

use crate::{command, package, python, setup, workspace};

/// Between these lines of the page stands what is generated.
const MARKS: [&str; 2] = ["<!-- results -->\n", "<!-- end of results -->\n"];

/// What one test found of one feature of one master.
#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Finding {
    master: String,
    version: String,
    feature: String,
    /// `passed`, `failed` or `skipped`.
    outcome: String,
    /// Largest distance from the native trajectory, m.
    distance: Option<f64>,
    /// What the test allows, m.
    bound: Option<f64>,
}

/// Options of `masters`.
#[derive(Debug, Args)]
pub struct Options {
    /// Compare the page with the results instead of writing it
    #[arg(long)]
    check: bool,
}

/// Runs the tests of all masters with freshly packaged FMUs and writes their results into docs/masters.md.
///
/// # Errors
/// When something cannot be built or a test fails, or when the page is to be checked and differs.
pub fn run(options: &Options) -> Result<()> {
    setup::run()?;
    package::run(&package::Options::default())?;
    let results = clear_results()?;
    command::run(&mut rust_masters(&results))?;
    let mut pytest = python::command(&["-m", "pytest", "tests/python", "-m", "master", "--color=no", "-ra"]);
    pytest.env("RPS3_DIST", workspace::dist()).env("RPS3_RESULTS", &results);
    command::run(&mut pytest)?;
    if options.check {
        return check(&results);
    }
    let findings = findings(&results)?;
    if let Some(skipped) = findings.iter().find(|finding| finding.outcome == "skipped") {
        eprintln!("{} could not run on this machine: the page will say so", skipped.master);
    }
    let text = fs::read_to_string(page())?;
    fs::write(page(), with_table(&text, &table(&findings))?)?;
    Ok(())
}

/// An empty directory for findings.
///
/// # Errors
/// When it cannot be made.
pub fn clear_results() -> Result<PathBuf> {
    let results = workspace::root().join("target/masters");
    if results.exists() {
        fs::remove_dir_all(&results)?;
    }
    fs::create_dir_all(&results)?;
    Ok(results)
}

/// The tests of the masters that are written in Rust; they leave their findings in `results`.
pub fn rust_masters(results: &Path) -> std::process::Command {
    let manifest = "--manifest-path=tests/fmi_master/Cargo.toml";
    let mut cargo = command::cargo(&["test", "--locked", manifest, "--target-dir=target/fmi-master"]);
    cargo.env("RPS3_DIST", workspace::dist()).env("RPS3_RESULTS", results);
    cargo
}

/// Compares the committed page with the findings, but for measured numbers and for what could not run here.
///
/// # Errors
/// When they differ.
pub fn check(results: &Path) -> Result<()> {
    let findings = findings(results)?;
    let committed = fs::read_to_string(page())?;
    let absent = findings.iter().filter(|finding| finding.outcome == "skipped").map(|finding| finding.master.as_str());
    let absent = absent.collect::<BTreeSet<_>>();
    let generated = comparable(&table(&findings), &absent);
    ensure!(
        comparable(generated_part(&committed)?, &absent) == generated,
        "docs/masters.md is out of date: `cargo xtask masters` renders it anew; the tests found\n{generated}"
    );
    Ok(())
}

fn page() -> PathBuf {
    workspace::root().join("docs/masters.md")
}

fn findings(results: &Path) -> Result<Vec<Finding>> {
    let mut findings = Vec::new();
    for entry in fs::read_dir(results)? {
        let path = entry?.path();
        let text = fs::read_to_string(&path)?;
        findings.push(serde_json::from_str(&text).with_context(|| path.display().to_string())?);
    }
    Ok(findings)
}

/// A row for each feature, a column for each master.
fn table(findings: &[Finding]) -> String {
    let name = |finding: &Finding| format!("{} {}", finding.master, finding.version);
    let masters: BTreeSet<String> = findings.iter().map(name).collect();
    let features: BTreeSet<&str> = findings.iter().map(|finding| finding.feature.as_str()).collect();
    let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut text =
        format!("\n{}", row([vec![String::new()], masters.iter().cloned().collect(), vec!["bound".into()]].concat()));
    text += &format!("|{}\n", "---|".repeat(masters.len() + 2));
    for feature in features {
        let of_feature = || findings.iter().filter(|finding| finding.feature == feature);
        let cell = |master: &String| cell(&of_feature().filter(|f| name(f) == *master).collect::<Vec<_>>());
        let bound = of_feature().filter_map(|f| f.bound).reduce(f64::max).filter(|bound| *bound > 0.0);
        let bound = bound.map_or(String::new(), |bound| format!("{bound:.0e} m"));
        text += &row([vec![feature.to_owned()], masters.iter().map(cell).collect(), vec![bound]].concat());
    }
    text.push('\n');
    text
}

/// What the tests of one feature of one master found.
fn cell(findings: &[&Finding]) -> String {
    if findings.is_empty() {
        return String::new();
    }
    for outcome in ["failed", "skipped"] {
        if findings.iter().any(|finding| finding.outcome == outcome) {
            return outcome.to_owned();
        }
    }
    match findings.iter().filter_map(|finding| finding.distance).reduce(f64::max) {
        None => "passed".to_owned(),
        Some(0.0) => "identical".to_owned(),
        Some(distance) => format!("{distance:.1e} m"),
    }
}

fn generated_part(page: &str) -> Result<&str> {
    let (_, rest) = page.split_once(MARKS[0]).context("docs/masters.md has no mark where results begin")?;
    Ok(rest.split_once(MARKS[1]).context("docs/masters.md has no mark where results end")?.0)
}

fn with_table(page: &str, table: &str) -> Result<String> {
    let old = generated_part(page)?;
    Ok(page.replace(&format!("{}{old}{}", MARKS[0], MARKS[1]), &format!("{}{table}{}", MARKS[0], MARKS[1])))
}

/// A table without measured distances and without the columns of masters in `absent`.
fn comparable(table: &str, absent: &BTreeSet<&str>) -> String {
    let header = table.lines().find(|line| line.starts_with('|')).unwrap_or_default();
    let is_absent = |cell: &str| absent.iter().any(|master| cell.trim().starts_with(&format!("{master} ")));
    let kept: Vec<bool> = header.split('|').map(|cell| !is_absent(cell)).collect();
    let measured = |cell: &str| cell.ends_with(" m ") && cell.contains('.');
    let row = |line: &str| {
        let cells = line.split('|').zip(&kept).filter(|(_, kept)| **kept);
        cells.map(|(cell, _)| if measured(cell) { " measured " } else { cell }).collect::<Vec<_>>().join("|")
    };
    table.lines().map(row).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(feature: &str, outcome: &str, distance: Option<f64>) -> Finding {
        Finding {
            master: "Solo".into(),
            version: "1.2".into(),
            feature: feature.into(),
            outcome: outcome.into(),
            distance,
            bound: Some(2e-4),
        }
    }

    #[test]
    fn a_feature_passes_if_each_of_its_tests_does_and_shows_the_largest_distance() {
        let one = [finding("ME", "passed", Some(1e-6)), finding("ME", "passed", Some(2.34e-5))];
        assert!(
            table(&one).contains("|  | Solo 1.2 | bound |\n|---|---|---|\n| ME | 2.3e-5 m | 2e-4 m |"),
            "{}",
            table(&one)
        );
        let failed = [one[0].clone(), finding("ME", "failed", None)];
        assert!(table(&failed).contains("| ME | failed |"));
        assert!(table(&[finding("ME", "passed", Some(0.0))]).contains("| ME | identical |"));
        assert!(table(&[finding("ME", "passed", None)]).contains("| ME | passed |"));
    }

    #[test]
    fn measured_numbers_may_differ_and_nothing_else() {
        let rows = |outcome, distance| comparable(&table(&[finding("ME", outcome, Some(distance))]), &BTreeSet::new());
        assert_eq!(rows("passed", 1e-6), rows("passed", 2e-6));
        assert_ne!(rows("passed", 1e-6), rows("passed", 0.0));
        assert_ne!(rows("passed", 1e-6), rows("failed", 1e-6));
    }

    #[test]
    fn masters_that_could_not_run_here_are_left_out() {
        let skipped = table(&[finding("ME", "skipped", None)]);
        let passed = table(&[finding("ME", "passed", None)]);
        let absent = BTreeSet::from(["Solo"]);
        assert_eq!(comparable(&skipped, &absent), comparable(&passed, &absent));
    }

    #[test]
    fn the_table_replaces_what_stands_between_the_marks() {
        let page = format!("before\n{}old\n{}after\n", MARKS[0], MARKS[1]);
        let new = with_table(&page, "new\n").unwrap();
        assert_eq!(generated_part(&new).unwrap(), "new\n");
        assert!(new.starts_with("before\n") && new.ends_with("after\n"));
    }
}
