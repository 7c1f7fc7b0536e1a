//! FMI 2.0's names for platforms (section 2.3.1).

use anyhow::{Result, bail};

/// Directory under `binaries/` and file name extension of a platform's libraries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Platform {
    /// A name of FMI 2.0's own, or a platform tuple of FMI 3.0, to which FMI 2.0 refers for all others.
    pub directory: &'static str,
    /// Extension of a shared library, without the dot.
    pub extension: &'static str,
}

/// Linux on 64-bit x86.
pub const LINUX_X86_64: Platform = Platform { directory: "linux64", extension: "so" };
/// Windows on 64-bit x86.
pub const WINDOWS_X86_64: Platform = Platform { directory: "win64", extension: "dll" };
/// Linux on 64-bit Arm.
pub const LINUX_AARCH64: Platform = Platform { directory: "aarch64-linux", extension: "so" };
/// macOS; FMPy looks here on Apple's processors, too.
const MACOS: Platform = Platform { directory: "darwin64", extension: "dylib" };

/// The host's platform.
///
/// # Errors
/// Where the FMUs cannot be packaged.
pub fn host() -> Result<Platform> {
    match (std::env::consts::OS, std::env::consts::ARCH) {
        ("linux", "x86_64") => Ok(LINUX_X86_64),
        ("windows", "x86_64") => Ok(WINDOWS_X86_64),
        ("macos", _) => Ok(MACOS),
        ("linux", "aarch64") => bail!(
            "FMPy, which writes the FMUs' documentation, does not find FMI 2.0 libraries on Arm; package for it on \
             x86-64 Linux with --all-targets"
        ),
        (system, processor) => bail!("FMI 2.0 has no platform name for {system} on {processor}"),
    }
}
