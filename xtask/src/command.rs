//! Child processes: shown before they run, named when they fail.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};

use crate::{setup, workspace};

/// `cargo` in the workspace root, with libclang in reach of the build scripts that generate C bindings.
pub fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments).current_dir(workspace::root());
    if std::env::var_os("LIBCLANG_PATH").is_none()
        && let Some(directory) = setup::libclang()
    {
        command.env("LIBCLANG_PATH", directory);
        // PyPI's libclang comes without the compiler's own headers, such as stddef.h
        if std::env::var_os("BINDGEN_EXTRA_CLANG_ARGS").is_none()
            && let Some(headers) = compiler_headers()
        {
            command.env("BINDGEN_EXTRA_CLANG_ARGS", format!("-I{headers}"));
        }
    }
    command
}

/// Where the C compiler, if it is gcc or clang, has its own headers.
fn compiler_headers() -> Option<String> {
    let output = Command::new("cc").arg("-print-file-name=include").output().ok()?;
    let path = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    std::path::Path::new(&path).is_absolute().then_some(path)
}

/// Runs a command that inherits the terminal.
///
/// # Errors
/// When it cannot be started or does not end with success.
pub fn run(command: &mut Command) -> Result<()> {
    announce(command);
    let status = command.status().with_context(|| format!("cannot start {}", show(command)))?;
    ensure!(status.success(), "{} ended with {status}", show(command));
    Ok(())
}

/// Runs a command, passing its standard output on line by line, and returns the lines that `keep`
/// picks, whether or not it succeeded.
///
/// # Errors
/// When it cannot be started or its output cannot be read.
pub fn tee(command: &mut Command, keep: impl Fn(&str) -> bool) -> Result<(bool, Vec<String>)> {
    announce(command);
    let mut child =
        command.stdout(Stdio::piped()).spawn().with_context(|| format!("cannot start {}", show(command)))?;
    let output = child.stdout.take().expect("stdout is piped");
    let mut kept = Vec::new();
    for line in BufReader::new(output).lines() {
        let line = line?;
        println!("{line}");
        if keep(&line) {
            kept.push(line);
        }
    }
    Ok((child.wait()?.success(), kept))
}

fn announce(command: &Command) {
    eprintln!("$ {}", show(command));
}

/// Program and arguments, the program without its directory.
pub fn show(command: &Command) -> String {
    let program = std::path::Path::new(command.get_program());
    let name = program.file_name().unwrap_or(command.get_program());
    let words = std::iter::once(name).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}
