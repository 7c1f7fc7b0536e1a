//! `cargo xtask package`: the FMUs and the SSP package.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use clap::Args;

use crate::{command, documentation, fmu, library, licenses, linked, python, sbom, ssp, targets, workspace};

/// Options of `package`.
#[derive(Debug, Args)]
pub struct Options {
    /// Cargo profile of the libraries
    #[arg(long, default_value = "release")]
    profile: String,
    /// One FMU for x86-64 Linux (old glibc), x86-64 Windows and 64-bit Arm Linux, into dist/all-targets/
    #[arg(long)]
    all_targets: bool,
    /// Then load and run all of them: Windows' under wine, Arm's under qemu-user
    #[arg(long, requires = "all_targets")]
    check: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { profile: "release".into(), all_targets: false, check: false }
    }
}

/// Packages, and checks the result where asked for.
///
/// # Errors
/// When packaging or a check fails.
pub fn run(options: &Options) -> Result<()> {
    package(options)?;
    if !options.check {
        return Ok(());
    }
    // the host's own build, which the others are to agree with
    package(&Options { profile: options.profile.clone(), ..Options::default() })?;
    let mut pytest = python::command(&["-m", "pytest", "tests/python/test_platforms.py", "--color=no", "-ra"]);
    command::run(pytest.env("RPS3_DIST", workspace::dist()).env("RPS3_RELEASE", workspace::release()))
}

/// Writes `Rps3Plant.fmu`, `Rps3Controller.fmu`, their bills of materials and `Rps3.ssp`: for the host's platform into
/// `dist/`, for all platforms into `dist/all-targets/`.
///
/// # Errors
/// When a build fails or a part cannot be read or written.
fn package(options: &Options) -> Result<()> {
    let (builds, triples, dist) = if options.all_targets {
        let triples = targets::ALL.iter().map(|target| target.triple).collect();
        (targets::build(&options.profile)?, triples, workspace::release())
    } else {
        (vec![library::build(&options.profile)?], Vec::new(), workspace::dist())
    };
    fs::create_dir_all(&dist)?;
    let linked = linked::crates(&triples)?;
    let crates = licenses::of(&linked)?;
    let bare = fmu::ALL.into_iter().map(|fmu| Ok((fmu, fmu.archive(&builds)?))).collect::<Result<Vec<_>>>()?;
    let documentation = documentation::render(&bare, &crates)?;
    let mut fmus = Vec::new();
    for (fmu, mut archive) in bare {
        archive.insert_tree(&documentation.join(fmu.identifier))?;
        licenses::insert(&mut archive, &crates)?;
        let bill = sbom::render(fmu, &builds, &linked)?;
        write(&dist.join(format!("{}.cdx.json", fmu.identifier)), bill.as_bytes())?;
        archive.insert(sbom::IN_ARCHIVE, bill);
        let bytes = archive.bytes()?;
        write(&dist.join(fmu.archive_file()), &bytes)?;
        fmus.push((fmu, fmu.description(&builds[0])?, bytes));
    }
    write(&dist.join("Rps3.ssp"), &ssp::archive(&fmus)?.bytes()?)?;
    match &builds[..] {
        [host] => println!("built for {} only", host.platform.directory),
        all => {
            println!("built for {}", all.iter().map(|build| build.platform.directory).collect::<Vec<_>>().join(", "))
        }
    }
    Ok(())
}

fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
    let name = path.strip_prefix(workspace::root()).unwrap_or(path);
    println!("{:36} {:6.0} KiB", name.display(), bytes.len() as f64 / 1024.0);
    Ok(())
}
