//! Places in the repository.

use std::path::{Path, PathBuf};

/// The workspace's root directory.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the workspace")
}

/// Where archives and reports go.
pub fn dist() -> PathBuf {
    root().join("dist")
}

/// Where the archives with binaries for all platforms go.
pub fn release() -> PathBuf {
    dist().join("all-targets")
}

/// The virtual environment of tests and demo.
pub fn venv() -> PathBuf {
    root().join(".venv")
}

/// The committed, rendered model descriptions.
pub fn descriptions() -> PathBuf {
    root().join("modelDescription")
}
