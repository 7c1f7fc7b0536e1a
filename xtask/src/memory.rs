//! `cargo xtask memory`: leaks, growth, races and stray accesses of the shared libraries, at length.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::{command, library, package, python, setup, workspace};

/// Packages the FMUs, builds their libraries once more for AddressSanitizer and ThreadSanitizer where these are to be
/// had, and runs `tests/python/test_memory.py` with its large counts; `cargo xtask test` runs it with
/// small ones.
///
/// # Errors
/// When a test fails or something cannot be built.
pub fn run() -> Result<()> {
    setup::run()?;
    package::run(&package::Options::default())?;
    let mut pytest = python::command(&["-m", "pytest", "tests/python/test_memory.py", "--long", "-rs", "-s"]);
    pytest.env("RPS3_DIST", workspace::dist());
    if cfg!(all(target_os = "linux", any(target_arch = "x86_64", target_arch = "aarch64"))) {
        pytest.env("RPS3_ADDRESS_SANITIZED", sanitized("address", &[])?);
        // the standard library at hand is not built for it
        pytest.env("RPS3_THREAD_SANITIZED", sanitized("thread", &["-Cunsafe-allow-abi-mismatch=sanitizer"])?);
        pytest.env("RPS3_THREAD_SANITIZER", thread_sanitizer()?);
    } else {
        println!("AddressSanitizer, ThreadSanitizer: skipped on this platform");
    }
    command::run(&mut pytest)
}

/// The directory of the libraries whose every access a sanitizer of the compiler checks.
fn sanitized(sanitizer: &str, options: &[&str]) -> Result<PathBuf> {
    let host = library::host()?;
    let target = workspace::root().join("target").join(format!("{sanitizer}-sanitizer"));
    // named, so that build scripts are compiled without the flag; no link-time optimization, which
    // would cost minutes and find nothing more
    let mut cargo = command::cargo(&["build", "--release", "--package=rps3-plant", "--package=rps3-controller"]);
    cargo.args(["--target", &host, "--config=profile.release.lto=false", "--config=profile.release.codegen-units=16"]);
    cargo.arg("--target-dir").arg(&target);
    let sanitizer = format!("-Zsanitizer={sanitizer}");
    let flags = [&[sanitizer.as_str()], options].concat();
    // an option of the compiler that is not stable yet
    cargo.env("RUSTC_BOOTSTRAP", "1").env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"));
    command::run(&mut cargo)?;
    Ok(target.join(host).join("release"))
}

/// ThreadSanitizer itself as it comes with the compiler, for the host in C: gcc's may lack functions that the
/// libraries call.
fn thread_sanitizer() -> Result<PathBuf> {
    let output = Command::new("rustc").args(["--print", "target-libdir"]).current_dir(workspace::root()).output()?;
    ensure!(output.status.success(), "rustc does not tell where its libraries are");
    let directory = PathBuf::from(String::from_utf8(output.stdout)?.trim());
    let mut files = std::fs::read_dir(&directory)?.filter_map(|entry| entry.ok().map(|entry| entry.path()));
    let archive = files.find(|path| path.to_string_lossy().ends_with("_rt.tsan.a"));
    archive.with_context(|| format!("no ThreadSanitizer in {}", directory.display()))
}
