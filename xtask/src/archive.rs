//! Reproducible zip archives: equal contents give equal bytes.

use std::collections::BTreeMap;
use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Files of an archive by their name in it, sorted, with forward slashes.
#[derive(Debug, Default)]
pub struct Archive(BTreeMap<String, Vec<u8>>);

impl Archive {
    /// Adds a file with the given contents.
    pub fn insert(&mut self, name: impl Into<String>, contents: impl Into<Vec<u8>>) {
        self.0.insert(name.into(), contents.into());
    }

    /// Adds a file from the disk.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn insert_file(&mut self, name: impl Into<String>, path: &Path) -> Result<()> {
        let contents = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        self.insert(name, contents);
        Ok(())
    }

    /// Adds all files below a directory, named relative to it; nothing where it does not exist.
    ///
    /// # Errors
    /// When something cannot be read, or is neither file nor directory.
    pub fn insert_tree(&mut self, directory: &Path) -> Result<()> {
        if directory.exists() { self.insert_below(directory, "") } else { Ok(()) }
    }

    fn insert_below(&mut self, directory: &Path, prefix: &str) -> Result<()> {
        for entry in fs::read_dir(directory)? {
            let entry = entry?;
            let name = entry.file_name().into_string().ok().context("a file name is not UTF-8")?;
            let kind = entry.file_type()?;
            ensure!(kind.is_dir() || kind.is_file(), "{} is a link", entry.path().display());
            if kind.is_dir() {
                self.insert_below(&entry.path(), &format!("{prefix}{name}/"))?;
            } else {
                self.insert_file(format!("{prefix}{name}"), &entry.path())?;
            }
        }
        Ok(())
    }

    /// The zip file's bytes: sorted, deflated, without time stamps, links or directory entries.
    ///
    /// # Errors
    /// When compression fails.
    pub fn bytes(&self) -> Result<Vec<u8>> {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(0o644);
        let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
        for (name, contents) in &self.0 {
            writer.start_file(name.as_str(), options)?;
            writer.write_all(contents)?;
        }
        Ok(writer.finish()?.into_inner())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_contents_give_equal_bytes_in_any_order_of_insertion() {
        let [mut first, mut second] = [Archive::default(), Archive::default()];
        first.insert("b/x.txt", "x");
        first.insert("a.txt", "a");
        second.insert("a.txt", "a");
        second.insert("b/x.txt", "x");
        assert_eq!(first.bytes().unwrap(), second.bytes().unwrap());
    }

    #[test]
    fn other_contents_give_other_bytes() {
        let [mut first, mut second] = [Archive::default(), Archive::default()];
        first.insert("a.txt", "a");
        second.insert("a.txt", "b");
        assert_ne!(first.bytes().unwrap(), second.bytes().unwrap());
    }
}
