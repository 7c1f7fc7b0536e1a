//! Results for docs/masters.md.

use std::fs;
use std::path::PathBuf;

use anyhow::Result;
use serde_json::json;

/// Leaves a result in the directory RPS3_RESULTS, if there is one: a master's largest distance from the core's trajectory
/// in heave, and what the test allows, both in m.
///
/// # Errors
/// When it cannot be written.
pub fn passed(master: &str, version: &str, feature: &str, distance: f64, bound: f64) -> Result<()> {
    let Some(directory) = std::env::var_os("RPS3_RESULTS").map(PathBuf::from) else { return Ok(()) };
    fs::create_dir_all(&directory)?;
    let record = json!({
        "master": master,
        "version": version,
        "feature": feature,
        "outcome": "passed",
        "distance": distance,
        "bound": bound,
    });
    let name = format!("{master} {feature}").replace(|c: char| !c.is_ascii_alphanumeric(), "_");
    Ok(fs::write(directory.join(format!("{name}.json")), record.to_string())?)
}
