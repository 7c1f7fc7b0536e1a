//! FMI 2.0 for any model: C types, call table, instance, panic boundary, export macro.
//! Knows no robot; a model implements [`Model`].

mod model;
mod values;

pub use model::{EventUpdate, Experiment, Log, Model, ModelError, ModelResult, StepInputs};
pub use values::Values;
