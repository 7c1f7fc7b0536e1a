//! Imports the packaged FMUs through the `fmi` crate and holds them against the core coupled in process.
#![forbid(unsafe_code)]

pub mod pair;
pub mod record;
pub mod side;
