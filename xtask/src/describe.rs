//! `cargo xtask describe`: the committed model descriptions.

use std::fs;

use anyhow::{Context, Result};

use crate::{fmu, library, workspace};

/// Copies what build.rs rendered to `modelDescription/`.
///
/// # Errors
/// When the descriptions cannot be rendered, read or written.
pub fn run() -> Result<()> {
    let rendered = library::descriptions()?;
    fs::create_dir_all(workspace::descriptions())?;
    for fmu in fmu::ALL {
        let name = fmu.description_file();
        let (from, to) = (rendered.join(&name), workspace::descriptions().join(&name));
        fs::copy(&from, &to).with_context(|| format!("cannot copy {} to {}", from.display(), to.display()))?;
        println!("{}", to.strip_prefix(workspace::root())?.display());
    }
    Ok(())
}
