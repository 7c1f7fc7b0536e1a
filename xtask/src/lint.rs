//! `cargo xtask lint`: what a reviewer should not have to say.

use anyhow::Result;

use crate::{command, python, setup};

/// Manifests of programs whose dependencies concern nobody else, and where they are built.
const WORKSPACES_OF_THEIR_OWN: [(&str, &str); 3] = [
    ("tests/fmi_master/Cargo.toml", "target/fmi-master"),
    ("benches/native/Cargo.toml", "target/bench"),
    ("fuzz/Cargo.toml", "target/fuzz"),
];

/// Checks format, lints and documentation of the Rust code, and the Python code.
///
/// # Errors
/// At the first finding.
pub fn run() -> Result<()> {
    setup::run()?;
    command::run(&mut command::cargo(&["fmt", "--all", "--check"]))?;
    command::run(&mut command::cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]))?;
    for (manifest, target) in WORKSPACES_OF_THEIR_OWN {
        let (manifest, target) = (format!("--manifest-path={manifest}"), format!("--target-dir={target}"));
        command::run(&mut command::cargo(&["fmt", "--check", &manifest]))?;
        let clippy = ["clippy", "--locked", "--all-targets", &manifest, &target, "--", "-D", "warnings"];
        command::run(&mut command::cargo(&clippy))?;
    }
    let mut doc = command::cargo(&["doc", "--workspace", "--no-deps", "--quiet"]);
    command::run(doc.env("RUSTDOCFLAGS", "-D warnings"))?;
    let python_code = ["python", "tests/python", "examples", "benches"];
    command::run(python::command(&["-m", "ruff", "check", "--quiet"]).args(python_code))?;
    command::run(python::command(&["-m", "ruff", "format", "--check", "--quiet"]).args(python_code))
}
