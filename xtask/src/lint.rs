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
    command::run(&mut command::cargo(&["fmt", "--manifest-path=benches/native/Cargo.toml", "--check"]))?;
    command::run(&mut command::cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]))?;
    let masters = ["--manifest-path=tests/fmi_master/Cargo.toml"];
    command::run(command::cargo(&["fmt", "--check"]).args(masters))?;
    let mut clippy = command::cargo(&["clippy", "--locked", "--all-targets", "--target-dir=target/fmi-master"]);
    command::run(clippy.args(masters).args(["--", "-D", "warnings"]))?;
    let mut doc = command::cargo(&["doc", "--workspace", "--no-deps", "--quiet"]);
    command::run(doc.env("RUSTDOCFLAGS", "-D warnings"))?;
    let python_code = ["python", "tests/python", "examples", "benches"];
    command::run(python::command(&["-m", "ruff", "check", "--quiet"]).args(python_code))?;
    command::run(python::command(&["-m", "ruff", "format", "--check", "--quiet"]).args(python_code))
}
