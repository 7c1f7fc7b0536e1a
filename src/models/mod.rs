//! The two models behind the FMUs: variable tables and the glue between the core and [`crate::fmi2`].
#![forbid(unsafe_code)]

pub mod common_table;
pub mod controller;
pub mod plant;

pub use controller::Controller;
pub use plant::Plant;
