//! Compilers, and where their standard library for a platform comes from.

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Result, bail};

/// Where Debian's package `rustc-web` puts the compiler, which `rustup`'s hides on the path.
const DEBIAN: &str = "/usr/bin/rustc";

/// A compiler that can build for a platform.
#[derive(Debug)]
pub struct Toolchain {
    rustc: PathBuf,
    /// As `rustc --version` says.
    version: String,
    sysroot: PathBuf,
    standard_library: StandardLibrary,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum StandardLibrary {
    Installed,
    FromSource,
}

/// A compiler for the platform: one with its standard library, else one with the library's sources.
///
/// # Errors
/// When there is neither; the message says what to install.
pub fn find(triple: &str) -> Result<Toolchain> {
    let candidates = || ["rustc", DEBIAN].into_iter().filter_map(|rustc| Installation::ask(Path::new(rustc), triple));
    if let Some(found) = candidates().find(Installation::has_library) {
        return Ok(found.with(StandardLibrary::Installed));
    }
    if let Some(found) = candidates().find(Installation::has_sources) {
        return Ok(found.with(StandardLibrary::FromSource));
    }
    bail!(
        "no Rust standard library for {triple}, and no sources to build it from. With rustup: `rustup target add {triple}`. \
         On Debian, whose compiler comes with the sources: `apt install rustc-web rust-web-src`"
    )
}

impl Toolchain {
    /// As `rustc --version` says.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// Makes a cargo command use this compiler.
    pub fn apply(&self, cargo: &mut Command) {
        cargo.env("RUSTC", &self.rustc);
        if self.standard_library == StandardLibrary::FromSource {
            // building the standard library is not a stable feature yet
            cargo.env("RUSTC_BOOTSTRAP", "1").arg("-Zbuild-std=std,panic_unwind");
        }
    }

    /// Where the standard library's sources lie, which panic messages would show.
    pub fn sources(&self) -> PathBuf {
        sources(&self.sysroot)
    }
}

impl fmt::Display for Toolchain {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let library = match self.standard_library {
            StandardLibrary::Installed => "its installed standard library",
            StandardLibrary::FromSource => "the standard library from source",
        };
        write!(f, "{} with {library}", self.version)
    }
}

/// What a compiler says of itself.
struct Installation {
    rustc: PathBuf,
    version: String,
    sysroot: PathBuf,
    /// Directory of the platform's standard library, whether or not it exists.
    library: PathBuf,
}

impl Installation {
    fn ask(rustc: &Path, triple: &str) -> Option<Self> {
        let ask = |arguments: &[&str]| {
            let output = Command::new(rustc).args(arguments).output().ok().filter(|output| output.status.success())?;
            Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
        };
        Some(Self {
            version: ask(&["--version"])?,
            sysroot: ask(&["--print=sysroot"])?.into(),
            library: ask(&["--print=target-libdir", "--target", triple])?.into(),
            rustc: rustc.to_owned(),
        })
    }

    fn has_library(&self) -> bool {
        let mut files = self.library.read_dir().into_iter().flatten().flatten();
        files.any(|file| file.file_name().to_string_lossy().starts_with("libstd-"))
    }

    fn has_sources(&self) -> bool {
        sources(&self.sysroot).join("library/std/Cargo.toml").exists()
    }

    fn with(self, standard_library: StandardLibrary) -> Toolchain {
        Toolchain { rustc: self.rustc, version: self.version, sysroot: self.sysroot, standard_library }
    }
}

fn sources(sysroot: &Path) -> PathBuf {
    sysroot.join("lib/rustlib/src/rust")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_host_s_library_is_the_installed_one() {
        let host = format!("{}-unknown-linux-gnu", std::env::consts::ARCH);
        if cfg!(target_os = "linux") {
            assert_eq!(find(&host).unwrap().standard_library, StandardLibrary::Installed);
        }
    }

    #[test]
    fn an_unknown_platform_is_refused_with_what_to_install() {
        let message = find("no-such-platform").unwrap_err().to_string();
        assert!(message.contains("rustup target add no-such-platform"), "{message}");
    }
}
