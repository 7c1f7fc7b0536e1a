//! The controller: reference, sensors, estimator, damped resolved acceleration, actuation, swarm.
//!
//! At each tick the [`Controller`] estimates the state, forms the [`Situation`] (everything that
//! does not depend on the damping), chooses the [`Damping`] by its mode, resolves the acceleration
//! (4.14) and turns it into motor voltages.
#![forbid(unsafe_code)]

mod actuation;
mod allowed;
mod controller;
mod damping;
mod estimator;
mod fitness;
mod holding;
pub mod mpso;
mod parameters;
mod preview;
mod reference;
mod search;
mod sensor_watch;
mod sensors;
mod singular;
mod situation;
mod stability;

pub use actuation::{ForceDistribution, VoltageCommand, voltages};
pub use allowed::AllowedMotion;
pub use controller::{Controller, Diagnostics, LEAST_WORK};
pub use damping::{Damping, Mode};
pub use estimator::{Deviations, Estimate, Estimator, Fit};
pub use fitness::{Fitness, fitness_of_currents};
pub use holding::HoldingTerm;
pub use parameters::{ControlError, ControllerParameters, Gains, SwarmParameters, Tuning};
pub use preview::{Start, preview};
pub(crate) use preview::{pose_errors, stacked_currents};
pub use reference::{ExternalReference, Profile, Reference, ReferencePoint};
pub use sensor_watch::{CHANNELS, SensorFaults, SensorWatch};
pub use sensors::{Measurement, SensorParameters, Sensors};
pub use singular::SingularBasis;
pub use situation::Situation;
pub use stability::{lyapunov, lyapunov_rate};
