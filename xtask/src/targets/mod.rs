//! The platforms of a release, and building for those that are not this machine's.
//!
//! Zig links for Linux ([`zig`]), since it brings glibc's old versions; MinGW for Windows. Rust's standard library is
//! the installed one where there is one, and else compiled from source ([`toolchain`]).

mod toolchain;
pub mod zig;

use std::collections::BTreeSet;
use std::process::Command;

use anyhow::{Context, Result, ensure};

use self::toolchain::Toolchain;
use crate::library::{self, Build};
use crate::platform::{self, Platform};
use crate::{command, fmu};

/// A platform of the release.
#[derive(Debug, Clone, Copy)]
pub struct Target {
    /// Where its libraries lie in the FMU.
    pub platform: Platform,
    /// Rust's name for it.
    pub triple: &'static str,
    linker: Linker,
}

#[derive(Debug, Clone, Copy)]
enum Linker {
    /// Zig, and the oldest glibc on which the libraries are to load.
    Zig { glibc: &'static str },
    /// GCC for Windows under the name that rustc looks for. Zig's libraries would export some functions of their own.
    MinGw { gcc: &'static str },
}

/// What `cargo xtask package --all-targets` builds for.
pub const ALL: [Target; 3] = [
    Target {
        platform: platform::LINUX_X86_64,
        triple: "x86_64-unknown-linux-gnu",
        linker: Linker::Zig { glibc: "2.17" },
    },
    Target {
        platform: platform::WINDOWS_X86_64,
        triple: "x86_64-pc-windows-gnu",
        linker: Linker::MinGw { gcc: "x86_64-w64-mingw32-gcc" },
    },
    Target {
        platform: platform::LINUX_AARCH64,
        triple: "aarch64-unknown-linux-gnu",
        linker: Linker::Zig { glibc: "2.17" },
    },
];

/// Both FMUs' libraries for all platforms.
///
/// # Errors
/// When a tool is missing, which is found out before anything is compiled, or a build fails.
pub fn build(profile: &str) -> Result<Vec<Build>> {
    ensure!(
        cfg!(all(target_os = "linux", target_arch = "x86_64")),
        "binaries for all platforms are built on x86-64 Linux"
    );
    let toolchains = ALL.iter().map(Target::toolchain).collect::<Result<Vec<_>>>()?;
    zig::install()?;
    let builds = ALL
        .iter()
        .zip(&toolchains)
        .map(|(target, toolchain)| target.build(profile, toolchain))
        .collect::<Result<Vec<_>>>()?;
    for fmu in fmu::ALL {
        let descriptions = builds.iter().map(|build| fmu.description(build)).collect::<Result<BTreeSet<_>>>()?;
        ensure!(descriptions.len() == 1, "the platforms' builds rendered different descriptions of {}", fmu.identifier);
    }
    Ok(builds)
}

impl Target {
    /// The compiler for this platform, once the linker is there.
    fn toolchain(&self) -> Result<Toolchain> {
        if let Linker::MinGw { gcc } = self.linker {
            let found = Command::new(gcc).arg("--version").output();
            found.with_context(|| format!("{gcc} is missing (Debian: apt install gcc-mingw-w64-x86-64-posix)"))?;
        }
        toolchain::find(self.triple)
    }

    fn build(&self, profile: &str, toolchain: &Toolchain) -> Result<Build> {
        eprintln!("{}: {toolchain}", self.platform.directory);
        let mut cargo = match self.linker {
            Linker::Zig { .. } => zig::cargo_build(),
            Linker::MinGw { .. } => command::cargo(&["build"]),
        };
        cargo.arg(match self.linker {
            Linker::Zig { glibc } => format!("--target={}.{glibc}", self.triple),
            Linker::MinGw { .. } => format!("--target={}", self.triple),
        });
        toolchain.apply(&mut cargo);
        let sources = vec![(toolchain.sources(), "rust")];
        library::build_with(cargo, profile, self.platform, toolchain.version().to_owned(), sources)
    }
}
