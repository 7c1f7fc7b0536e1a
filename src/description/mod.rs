//! FMI 2.0 model description: the typed variable tables and their XML rendering.
//!
//! This module and the tables in `models::*::table` use nothing else of the crate but
//! [`crate::defaults`], since `build.rs` compiles them too.
#![forbid(unsafe_code)]

mod log_categories;
mod render;
mod schema;
mod table;
mod units;

pub use log_categories::{LOG_ALL, LogCategory};
pub use render::{RenderError, render};
pub use table::{
    Bounds, Capabilities, Causality, DefaultExperiment, Definition, Initial, Kind, Unknown, Variability, Variable,
    VariableType,
};
pub use units::{Exponents, display_factor};
