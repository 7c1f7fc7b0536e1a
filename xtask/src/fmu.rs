//! The two FMUs and what goes into their archives.

use std::fs;

use anyhow::{Context, Result};

use crate::archive::Archive;
use crate::library::Build;
use crate::licenses;
use crate::platform::Platform;
use crate::workspace;

/// One of the FMUs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fmu {
    /// FMI's `modelIdentifier`, also the library's target name and the archive's stem.
    pub identifier: &'static str,
    /// Its directory under `fmus/`; name of its component in the SSP package.
    pub component: &'static str,
}

/// The controller's plant.
pub const PLANT: Fmu = Fmu { identifier: "Rps3Plant", component: "plant" };
/// The plant's controller.
pub const CONTROLLER: Fmu = Fmu { identifier: "Rps3Controller", component: "controller" };
/// In the order in which a sequential master calls them.
pub const ALL: [Fmu; 2] = [CONTROLLER, PLANT];

const LICENSE: &str = "\
The FMU is licensed under the MIT license (LICENSE-MIT.txt) or the Apache License, version 2.0
(LICENSE-APACHE.txt), at your option. Texts of the licenses of the crates that are linked into it:
third-party/. Its documentation, ../index.html, lists them. Rust's standard library and the crates within it have theirs in
rust-standard-library.html, if the compiler brought that page.
";

impl Fmu {
    /// File name of the model description, in the build's output and in `modelDescription/`.
    pub fn description_file(&self) -> String {
        format!("{}.xml", self.identifier)
    }

    /// File name of the archive.
    pub fn archive_file(&self) -> String {
        format!("{}.fmu", self.identifier)
    }

    /// The model description that belongs to the build's libraries.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn description(&self, build: &Build) -> Result<String> {
        let path = build.descriptions.join(self.description_file());
        fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))
    }

    /// The FMU's archive with the libraries of all `builds` (FMI 2.0, section 2.3.1), without what is only known from
    /// its runs: see [`crate::documentation`]. What lies in `fmus/<component>/archive/` goes in as it is.
    ///
    /// # Errors
    /// When a part is missing.
    pub fn archive(&self, builds: &[Build]) -> Result<Archive> {
        let mut archive = Archive::default();
        archive.insert_tree(&workspace::root().join("fmus").join(self.component).join("archive"))?;
        for build in builds {
            let Platform { directory, extension } = build.platform;
            let library = build.libraries.get(self.identifier);
            let library = library.with_context(|| format!("no library {} for {directory}", self.identifier))?;
            archive.insert("modelDescription.xml", self.description(build)?);
            archive.insert_file(format!("binaries/{directory}/{}.{extension}", self.identifier), library)?;
        }
        archive.insert("documentation/licenses/license.txt", LICENSE);
        for license in ["LICENSE-MIT", "LICENSE-APACHE"] {
            archive.insert_file(format!("documentation/licenses/{license}.txt"), &workspace::root().join(license))?;
        }
        if let Some(page) = licenses::of_the_standard_library()? {
            archive.insert_file("documentation/licenses/rust-standard-library.html", &page)?;
        }
        Ok(archive)
    }
}
