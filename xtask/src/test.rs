//! `cargo xtask test`: every test there is.

use std::time::Instant;

use anyhow::{Result, bail};
use clap::Args;

use crate::{command, instructions, masters, package, python, setup, workspace};

/// Options of `test`.
#[derive(Debug, Args)]
pub struct Options {
    /// Handed on to pytest, e.g. `-- -k energy`
    #[arg(last = true)]
    pytest: Vec<String>,
}

/// Runs the Rust tests, packages the FMUs and runs the Python tests on them; a failure of one does
/// not keep the other from running. The last line sums up.
///
/// # Errors
/// When a test fails or could not be built.
pub fn run(options: &Options) -> Result<()> {
    let start = Instant::now();
    setup::run()?;
    let is_result = |line: &str| line.starts_with("test result:");
    let (rust_passed, mut results) =
        command::tee(&mut command::cargo(&["test", "--workspace", "--no-fail-fast"]), is_result)?;
    let instructions = instructions::run(&instructions::Options::default());
    package::run(&package::Options::default())?;
    let found = masters::clear_results()?;
    let (masters_passed, of_masters) = command::tee(&mut masters::rust_masters(&found), is_result)?;
    results.extend(of_masters);
    let mut pytest = python::command(&["-m", "pytest", "tests/python", "--color=no", "-ra"]);
    pytest.env("RPS3_DIST", workspace::dist()).env("RPS3_RESULTS", &found).args(&options.pytest);
    let (python_passed, summary) = command::tee(&mut pytest, |line| line.starts_with('=') && line.contains(" in "))?;
    let python_summary = summary.last().map_or("no result", |line| line.trim_matches(['=', ' ']));
    println!("\nRust: {}; Python: {python_summary}; {} s in all", sum_up(&results), start.elapsed().as_secs());
    if !(rust_passed && masters_passed && python_passed) {
        bail!("tests failed");
    }
    // a selection of tests says little about the page
    if options.pytest.is_empty() {
        masters::check(&found)?;
    }
    instructions
}

/// Adds up the counts of libtest's result lines.
fn sum_up(results: &[String]) -> String {
    let count = |what: &str| -> usize {
        let counts =
            results.iter().flat_map(|line| line.split(['.', ';'])).filter_map(|part| part.trim().strip_suffix(what));
        counts.filter_map(|number| number.trim().parse::<usize>().ok()).sum()
    };
    format!("{} passed, {} failed, {} ignored", count("passed"), count("failed"), count("ignored"))
}

#[cfg(test)]
mod tests {
    use super::sum_up;

    #[test]
    fn counts_of_all_test_binaries_are_added() {
        let results = [
            "test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s",
            "test result: FAILED. 2 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s",
        ];
        assert_eq!(sum_up(&results.map(String::from)), "5 passed, 1 failed, 1 ignored");
    }
}
