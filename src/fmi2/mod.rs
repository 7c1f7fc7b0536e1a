//! FMI 2.0 for any model: C types, call table, instance, panic boundary, export macro.
//! Knows no robot; a model implements [`Model`], a shared library invokes [`crate::export_fmu!`].
//!
//! The way of a call: the exported function, [`api`] (one body a function), `boundary` and `handle`
//! (pointers, panics), `instance` (call table, errors to status and log line), then the part of the
//! standard it belongs to: `lifecycle`, `variables`, `state`, `directional`, `model_exchange`,
//! `co_simulation`.
//!
//! A *refused* call (wrong order, arguments or data) returns `fmi2Error` and changes nothing of the
//! instance, the mode included; what a refused Get has put into its result array means nothing. A
//! *failed* computation returns `fmi2Error` and leaves the instance in the standard's state `error`,
//! from which `fmi2Reset`, `fmi2SetFMUstate` and `fmi2FreeInstance` lead out (section 2.1.3). A panic
//! returns `fmi2Fatal`.

pub mod api;
mod boundary;
pub mod call_table;
mod co_simulation;
mod directional;
mod error;
mod export;
mod handle;
mod input_derivatives;
mod instance;
mod lasting;
mod layout;
mod lifecycle;
mod logger;
mod model;
mod model_exchange;
mod spans;
mod state;
mod state_bytes;
pub mod types;
mod values;
mod variables;

pub use co_simulation::{MAX_STEP, STOP_TIME_OVERSHOOT};
pub use error::{CallError, CallResult};
pub use input_derivatives::MAX_ORDER as MAX_INPUT_DERIVATIVE_ORDER;
pub use instance::Instance;
pub use lasting::Lasting;
pub use layout::Layout;
pub use lifecycle::MAX_TIME;
pub use model::{Direction, EventUpdate, Experiment, Log, Model, ModelError, ModelResult, StepInputs};
pub use values::Values;
