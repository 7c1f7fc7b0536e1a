//! The 3-RPS parallel manipulator with DC motors and its hybrid damped resolved-acceleration
//! controller (HDRAC) tuned by a modified particle swarm (MPSO), after Zhan & Kao,
//! "Modified PSO Method for Robust Control of 3RPS Parallel Manipulators".
//!
//! Rooms: [`mechanism`] (geometry and kinematics), [`dynamics`] (bodies, motors, forward
//! dynamics), [`control`] (reference, estimator, control law, swarm), [`study`] (crossings and
//! baselines to compare with; no part of the FMUs), [`description`] (FMI 2.0 model description),
//! [`fmi2`] (the C interface; knows no robot) and [`models`] (the two FMUs: variable tables and the
//! glue between the core and `fmi2`).
#![deny(unsafe_code)]

pub mod control;
pub mod coupling;
pub mod defaults;
pub mod description;
pub mod dynamics;
#[allow(unsafe_code)]
pub mod fmi2;
pub mod mechanism;
pub mod models;
pub mod scalar;
pub mod study;
pub mod svd;
