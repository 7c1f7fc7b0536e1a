//! Reference, estimator, sensors, control law and swarm.
#![forbid(unsafe_code)]
