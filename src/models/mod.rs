//! The two models behind the FMUs: variable tables and the glue between the core and [`crate::fmi2`].
#![forbid(unsafe_code)]

pub mod common_table;
pub mod controller;
pub mod descriptions;
pub mod plant;
mod slots;

pub use controller::Controller;
pub use plant::{Plant, TOLERANCE_MARGIN};
