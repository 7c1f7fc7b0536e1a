//! `cargo xtask memory`: leaks, growth, races and stray accesses of the shared libraries, at length.

use std::path::PathBuf;

use anyhow::Result;

use crate::{command, library, package, python, setup, workspace};

/// Packages the FMUs, builds their libraries once more for AddressSanitizer where it is to be had,
/// and runs `tests/python/test_memory.py` with its large counts; `cargo xtask test` runs it with
/// small ones.
///
/// # Errors
/// When a test fails or something cannot be built.
pub fn run() -> Result<()> {
    setup::run()?;
    package::run(&package::Options::default())?;
    let mut pytest = python::command(&["-m", "pytest", "tests/python/test_memory.py", "--long", "-rs", "-s"]);
    pytest.env("RPS3_DIST", workspace::dist());
    if let Some(directory) = address_sanitized()? {
        pytest.env("RPS3_ADDRESS_SANITIZED", directory);
    }
    command::run(&mut pytest)
}

/// The directory of the libraries whose every access AddressSanitizer checks.
fn address_sanitized() -> Result<Option<PathBuf>> {
    if !cfg!(all(target_os = "linux", any(target_arch = "x86_64", target_arch = "aarch64"))) {
        println!("AddressSanitizer: skipped on this platform");
        return Ok(None);
    }
    let host = library::host()?;
    let target = workspace::root().join("target/address-sanitizer");
    // named, so that build scripts are compiled without the flag; no link-time optimization, which
    // would cost minutes and find nothing more
    let mut cargo = command::cargo(&["build", "--release", "--package=rps3-plant", "--package=rps3-controller"]);
    cargo.args(["--target", &host, "--config=profile.release.lto=false", "--config=profile.release.codegen-units=16"]);
    cargo.arg("--target-dir").arg(&target);
    // an option of the compiler that is not stable yet
    cargo.env("RUSTC_BOOTSTRAP", "1").env("CARGO_ENCODED_RUSTFLAGS", "-Zsanitizer=address");
    command::run(&mut cargo)?;
    Ok(Some(target.join(host).join("release")))
}
