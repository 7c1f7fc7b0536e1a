//! Builds the shared libraries and finds what the build left behind.

use std::collections::BTreeMap;
use std::io::BufReader;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use cargo_metadata::{CrateType, Message};

use crate::platform::{self, Platform};
use crate::{command, workspace};

/// Output of a build.
#[derive(Debug)]
pub struct Build {
    /// What the libraries are for.
    pub platform: Platform,
    /// The compiler, as `rustc --version` says.
    pub compiler: String,
    /// Shared libraries by target name, which is the model identifier.
    pub libraries: BTreeMap<String, PathBuf>,
    /// Directory into which build.rs rendered the model descriptions that the libraries belong to.
    pub descriptions: PathBuf,
}

/// Builds both FMUs' libraries for the host.
///
/// # Errors
/// When the build fails or the host cannot be packaged for.
pub fn build(profile: &str) -> Result<Build> {
    let platform = platform::host()?;
    let version = Command::new("rustc").arg("--version").output().context("cannot start rustc")?;
    let compiler = String::from_utf8(version.stdout)?.trim().to_owned();
    build_with(command::cargo(&["build"]), profile, platform, compiler, Vec::new())
}

/// Builds both FMUs' libraries with a command that takes the arguments of `cargo build`, so that the bytes depend on
/// sources and compiler alone: no paths of this machine, no debug information. A target directory of its own keeps
/// these flags from rebuilding everything else. `foreign` are further directories whose path is not to be seen.
///
/// # Errors
/// When the build fails.
pub fn build_with(
    mut cargo: Command,
    profile: &str,
    platform: Platform,
    compiler: String,
    foreign: Vec<(PathBuf, &str)>,
) -> Result<Build> {
    let ours = [(workspace::root().to_owned(), ".")];
    let hidden = ours.into_iter().chain(cargo_home().map(|home| (home, "cargo"))).chain(foreign);
    let flags = hidden.map(|(path, shown)| format!("--remap-path-prefix={}={shown}", path.display()));
    cargo.args(["--package=rps3-plant", "--package=rps3-controller", "--target-dir=target/package"]);
    cargo.arg(format!("--profile={profile}"));
    cargo.env("CARGO_ENCODED_RUSTFLAGS", flags.collect::<Vec<_>>().join("\u{1f}"));
    cargo.env(format!("CARGO_PROFILE_{}_STRIP", profile.to_uppercase().replace('-', "_")), "debuginfo");
    let mut products = Products::default();
    products.collect(&mut cargo, platform.extension)?;
    let Products { libraries, descriptions } = products;
    ensure!(descriptions.is_dir(), "the build rendered no model descriptions");
    Ok(Build { platform, compiler, libraries, descriptions })
}

/// Runs only what renders the model descriptions and returns the directory that holds them.
///
/// # Errors
/// When the build script fails.
pub fn descriptions() -> Result<PathBuf> {
    // The build script runs before the library is compiled, so what follows it may fail.
    let mut products = Products::default();
    let outcome = products.collect(&mut command::cargo(&["check", "--package=rps3"]), std::env::consts::DLL_EXTENSION);
    if products.descriptions.as_os_str().is_empty() {
        outcome.map(|()| products.descriptions)
    } else {
        Ok(products.descriptions)
    }
}

/// What cargo's messages tell of.
#[derive(Debug, Default)]
struct Products {
    libraries: BTreeMap<String, PathBuf>,
    descriptions: PathBuf,
}

impl Products {
    fn collect(&mut self, cargo: &mut Command, extension: &str) -> Result<()> {
        eprintln!("$ {}", command::show(cargo));
        let mut child = cargo
            .arg("--message-format=json-render-diagnostics")
            .stdout(Stdio::piped())
            .spawn()
            .with_context(|| format!("cannot start {}", command::show(cargo)))?;
        let output = BufReader::new(child.stdout.take().expect("stdout is piped"));
        for message in Message::parse_stream(output) {
            match message? {
                Message::CompilerArtifact(artifact) if artifact.target.crate_types.contains(&CrateType::CDyLib) => {
                    let library = artifact.filenames.into_iter().find(|path| path.extension() == Some(extension));
                    self.libraries.extend(library.map(|path| (artifact.target.name, path.into_std_path_buf())));
                }
                // Of all build scripts in the graph only ours has a package at the workspace's root.
                Message::BuildScriptExecuted(script) if is_ours(&script.package_id.repr) => {
                    self.descriptions = script.out_dir.into_std_path_buf();
                }
                _ => {}
            }
        }
        let status = child.wait()?;
        ensure!(status.success(), "{} ended with {status}", command::show(cargo));
        Ok(())
    }
}

fn is_ours(package: &str) -> bool {
    package.starts_with("path+file://") && package.rsplit(['#', '/']).next().is_some_and(|id| id.starts_with("rps3@"))
}

fn cargo_home() -> Option<PathBuf> {
    let named = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    named.or_else(|| std::env::home_dir().map(|home| home.join(".cargo")))
}

/// The compiler's host triple.
///
/// # Errors
/// When the compiler does not tell.
pub fn host() -> Result<String> {
    let output = Command::new("rustc").args(["--print", "host-tuple"]).output()?;
    ensure!(output.status.success(), "rustc does not tell its host");
    Ok(String::from_utf8(output.stdout)?.trim().to_owned())
}
