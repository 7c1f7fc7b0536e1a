//! Builds the shared libraries and finds what the build left behind.

use std::collections::BTreeMap;
use std::io::BufReader;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use cargo_metadata::{CrateType, Message};

use crate::{command, workspace};

/// Output of a build.
#[derive(Debug, Default)]
pub struct Build {
    /// Shared libraries by target name, which is the model identifier.
    pub libraries: BTreeMap<String, PathBuf>,
    /// Directory into which build.rs rendered the model descriptions that the libraries belong to.
    pub descriptions: PathBuf,
}

/// Builds both FMUs' libraries so that the bytes depend on sources and compiler alone: no paths of
/// this machine, no debug information. A target directory of its own keeps these flags from
/// rebuilding everything else.
///
/// # Errors
/// When the build fails.
pub fn build(profile: &str) -> Result<Build> {
    let root = workspace::root().display().to_string();
    let mut flags = vec![format!("--remap-path-prefix={root}=.")];
    if let Some(home) = cargo_home() {
        flags.push(format!("--remap-path-prefix={}=cargo", home.display()));
    }
    let arguments = ["build", "--package=rps3-plant", "--package=rps3-controller", "--target-dir=target/package"];
    let mut cargo = command::cargo(&arguments);
    cargo.arg(format!("--profile={profile}"));
    cargo.env("CARGO_ENCODED_RUSTFLAGS", flags.join("\u{1f}"));
    cargo.env(format!("CARGO_PROFILE_{}_STRIP", profile.to_uppercase().replace('-', "_")), "debuginfo");
    collect(&mut cargo)
}

/// Runs only what renders the model descriptions and returns the directory that holds them.
///
/// # Errors
/// When the build script fails.
pub fn descriptions() -> Result<PathBuf> {
    // The build script runs before the library is compiled, so what follows it may fail.
    let mut build = Build::default();
    let outcome = collect_into(&mut command::cargo(&["check", "--package=rps3"]), &mut build);
    if build.descriptions.as_os_str().is_empty() {
        outcome.map(|()| build.descriptions)
    } else {
        Ok(build.descriptions)
    }
}

fn collect(cargo: &mut Command) -> Result<Build> {
    let mut build = Build::default();
    collect_into(cargo, &mut build)?;
    ensure!(build.descriptions.is_dir(), "the build rendered no model descriptions");
    Ok(build)
}

fn collect_into(cargo: &mut Command, build: &mut Build) -> Result<()> {
    eprintln!("$ {}", command::show(cargo));
    let mut child = cargo
        .arg("--message-format=json-render-diagnostics")
        .stdout(Stdio::piped())
        .spawn()
        .context("cannot start cargo")?;
    let output = BufReader::new(child.stdout.take().expect("stdout is piped"));
    for message in Message::parse_stream(output) {
        match message? {
            Message::CompilerArtifact(artifact) if artifact.target.crate_types.contains(&CrateType::CDyLib) => {
                let library = artifact.filenames.into_iter().find(|path| {
                    path.extension().is_some_and(|extension| extension == std::env::consts::DLL_EXTENSION)
                });
                build.libraries.extend(library.map(|path| (artifact.target.name, path.into_std_path_buf())));
            }
            // Of all build scripts in the graph only ours has a package at the workspace's root.
            Message::BuildScriptExecuted(script) if is_ours(&script.package_id.repr) => {
                build.descriptions = script.out_dir.into_std_path_buf();
            }
            _ => {}
        }
    }
    let status = child.wait()?;
    ensure!(status.success(), "{} ended with {status}", command::show(cargo));
    Ok(())
}

fn is_ours(package: &str) -> bool {
    package.starts_with("path+file://") && package.rsplit(['#', '/']).next().is_some_and(|id| id.starts_with("rps3@"))
}

fn cargo_home() -> Option<PathBuf> {
    let named = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    named.or_else(|| std::env::home_dir().map(|home| home.join(".cargo")))
}
