//! `cargo xtask package`: the FMUs and the SSP package.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use clap::Args;

use crate::{documentation, fmu, library, licenses, platform, ssp, workspace};

/// Options of `package`.
#[derive(Debug, Args)]
pub struct Options {
    /// Cargo profile of the libraries
    #[arg(long, default_value = "release")]
    profile: String,
}

impl Default for Options {
    fn default() -> Self {
        Self { profile: "release".into() }
    }
}

/// Writes `dist/Rps3Plant.fmu`, `dist/Rps3Controller.fmu` and `dist/Rps3.ssp` for the host's platform.
///
/// # Errors
/// When the build fails or a part cannot be read or written.
pub fn run(options: &Options) -> Result<()> {
    let platform = platform::host()?;
    let build = library::build(&options.profile)?;
    let dist = workspace::dist();
    fs::create_dir_all(&dist)?;
    let crates = licenses::linked()?;
    let bare = fmu::ALL.into_iter().map(|fmu| Ok((fmu, fmu.archive(&build)?))).collect::<Result<Vec<_>>>()?;
    let documentation = documentation::render(&bare, &crates)?;
    let mut fmus = Vec::new();
    for (fmu, mut archive) in bare {
        archive.insert_tree(&documentation.join(fmu.identifier))?;
        licenses::insert(&mut archive, &crates)?;
        let bytes = archive.bytes()?;
        write(&dist.join(fmu.archive_file()), &bytes)?;
        fmus.push((fmu, fmu.description(&build)?, bytes));
    }
    write(&dist.join("Rps3.ssp"), &ssp::archive(&fmus)?.bytes()?)?;
    println!("built for {} only", platform.directory);
    Ok(())
}

fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
    let name = path.strip_prefix(workspace::root()).unwrap_or(path);
    println!("{:24} {:6.0} KiB", name.display(), bytes.len() as f64 / 1024.0);
    Ok(())
}
