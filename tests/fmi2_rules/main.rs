//! The rules of FMI 2.0.5 that the generic layer keeps, through the exported C functions, on a toy
//! model. Test names say the rule; section numbers are those of the standard.

mod call_order;
mod co_simulation;
mod directional;
mod host;
mod hostile;
mod instances;
mod lifecycle;
mod logging;
mod model_exchange;
mod panics;
mod state;
mod toy;
mod variables;

rps3::export_fmu!(toy::Oscillator);
