//! Rigid-body dynamics of the mechanism and its DC motors.
//!
//! The platform and the two links of each limb move with the three generalized coordinates
//! s = (heave, tilt_x, tilt_y): M(s) s_ddot + h(s, s_dot) = Q. This explicit form stays regular at
//! direct singularities, where the joint-side coordinates do not.
#![forbid(unsafe_code)]

mod appendix_a;
mod bodies;
mod end_stop;
mod energy;
mod forward;
mod inverse;
mod motor;
mod parameters;
mod reaction;
pub mod solver;
mod state;

pub use appendix_a::{JointForces, joint_forces};
pub use bodies::{Bodies, MechanismDynamics};
pub use end_stop::{EndStop, EndStops};
pub use energy::{electric_power, energy};
pub use forward::{
    Evaluation, current_maps, derivative, evaluate, settled_currents, solve_positive_definite, static_load,
};
pub use inverse::{Demand, DriveDemand, InverseDynamics, TrajectoryPoint};
pub use motor::{Drive, Motors};
pub use parameters::{MechanismParameters, ParameterError, PlantParameters};
pub use reaction::{Reactions, reactions};
pub use state::{Inputs, NOMINAL, PlantModel, PlantState, STATES, moving};
