//! `cargo xtask lint`: what a reviewer should not have to say.

use anyhow::Result;

use crate::{command, python, setup};

/// Checks format, lints and documentation of the Rust code, and the Python code.
///
/// # Errors
/// At the first finding.
pub fn run() -> Result<()> {
    setup::run()?;
    command::run(&mut command::cargo(&["fmt", "--all", "--check"]))?;
    command::run(&mut command::cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]))?;
    let mut doc = command::cargo(&["doc", "--workspace", "--no-deps", "--quiet"]);
    command::run(doc.env("RUSTDOCFLAGS", "-D warnings"))?;
    let python_code = ["python", "tests/python"];
    command::run(python::command(&["-m", "ruff", "check", "--quiet"]).args(python_code))?;
    command::run(python::command(&["-m", "ruff", "format", "--check", "--quiet"]).args(python_code))
}
