//! FMI 2.0's names for platforms (section 2.3.1).

use anyhow::{Result, bail};

/// Directory under `binaries/` and file name extension of the host's libraries.
#[derive(Debug, Clone, Copy)]
pub struct Platform {
    /// `linux64`, `win64` or `darwin64`.
    pub directory: &'static str,
    /// Extension of a shared library, without the dot.
    pub extension: &'static str,
}

/// The host's platform.
///
/// # Errors
/// Where FMI 2.0 has no name for it.
pub fn host() -> Result<Platform> {
    let (directory, extension) = match (std::env::consts::OS, std::env::consts::ARCH) {
        ("linux", "x86_64") => ("linux64", "so"),
        ("windows", "x86_64") => ("win64", "dll"),
        ("macos", _) => ("darwin64", "dylib"),
        (system, processor) => bail!("FMI 2.0 has no platform name for {system} on {processor}"),
    };
    Ok(Platform { directory, extension })
}
