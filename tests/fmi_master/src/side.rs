//! One FMU, with its variables by name.

use std::path::PathBuf;

use anyhow::{Context, Result};
use fmi::fmi2::import::Fmi2Import;
use fmi::traits::FmiImport;

/// States of the plant, in order.
pub const STATES: [&str; 12] = [
    "heave",
    "tilt_x",
    "tilt_y",
    "heave_dot",
    "tilt_x_dot",
    "tilt_y_dot",
    "i_leg1",
    "i_leg2",
    "i_leg3",
    "i_rev1",
    "i_rev2",
    "i_rev3",
];
/// What the controller measures of the plant.
pub const MEASURED: [&str; 21] = [
    "d1",
    "d2",
    "d3",
    "d1_dot",
    "d2_dot",
    "d3_dot",
    "theta1",
    "theta2",
    "theta3",
    "theta1_dot",
    "theta2_dot",
    "theta3_dot",
    "i_leg1",
    "i_leg2",
    "i_leg3",
    "i_rev1",
    "i_rev2",
    "i_rev3",
    "a_x",
    "a_y",
    "a_z",
];
/// What the controller does to the plant.
pub const VOLTAGES: [&str; 6] = ["v_leg1", "v_leg2", "v_leg3", "v_rev1", "v_rev2", "v_rev3"];
/// The controller's reference.
pub const REFERENCE: [&str; 3] = ["heave_ref", "tilt_x_ref", "tilt_y_ref"];

/// The archive of an FMU: in the directory RPS3_DIST, else in `dist/`.
pub fn archive(model: &str) -> PathBuf {
    let default = concat!(env!("CARGO_MANIFEST_DIR"), "/../../dist");
    let directory = std::env::var_os("RPS3_DIST").map_or_else(|| PathBuf::from(default), PathBuf::from);
    directory.join(format!("{model}.fmu"))
}

/// Imports `Rps3Plant` or `Rps3Controller`.
///
/// # Errors
/// When the archive is missing, or not to the crate's liking.
pub fn import(model: &str) -> Result<Fmi2Import> {
    let path = archive(model);
    fmi::import::from_path(&path).with_context(|| format!("{}: `cargo xtask package` makes it", path.display()))
}

/// Value references of variables.
///
/// # Errors
/// When there is no such variable.
pub fn references<const N: usize>(import: &Fmi2Import, names: [&str; N]) -> Result<[u32; N]> {
    let mut references = [0; N];
    for (reference, name) in references.iter_mut().zip(names) {
        *reference = import.model_description().model_variable_by_name(name)?.value_reference;
    }
    Ok(references)
}
