//! What can be set about a swarm, and the ranges in which it makes sense.

use serde::{Deserialize, Serialize};

use crate::defaults as d;

/// Which individuals of an iteration live on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Selection {
    /// Plain particle swarm, the baseline: the offspring replace their parents.
    Plain,
    /// Modified particle swarm: the PS smallest scores (3.3) of parents and offspring together.
    Ranked,
}

/// Settings of a swarm. [`Swarm::new`](super::Swarm::new) checks them.
///
/// Defaults marked * are printed in the paper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Number of individuals PS, 2 to [`Settings::MAX_SWARM_SIZE`]. Default 20.
    pub swarm_size: usize,
    /// First stopping criterion: iterations g_max, at least 1. Default 30.
    pub max_iterations: usize,
    /// Second stopping criterion: iterations in a row without a better solution, at least 1; as
    /// many as `max_iterations` turn it off. Default 12.
    pub stall_iterations: usize,
    /// Pull to the individual's own best c1 (3.1), at least 0. Default 2.
    pub c1: f64,
    /// Pull to the swarm's best c2 (3.1), at least 0. Default 2.
    pub c2: f64,
    /// Inertia w_max of the first iteration (3.2). Default 0.9 *.
    pub inertia_max: f64,
    /// Inertia w_min that g_max iterations lead to (3.2), 0 to `inertia_max`. Default 0.4 *.
    pub inertia_min: f64,
    /// Decay scale of the first iteration (3.5). Default 0.7 *.
    pub decay_max: f64,
    /// Smallest decay scale (3.5), 0 to `decay_max`; with both 0 distance plays no part. Default 0.005 *.
    pub decay_min: f64,
    /// Regulating scale R of the decay's steps (3.5), at least 0. Default 1.25 *.
    pub regulating_scale: f64,
    /// Largest velocity V_max per iteration as a fraction of a member's range, above 0, at most 1.
    /// Default 0.2.
    pub velocity_limit: f64,
    /// Modified or plain swarm. Default [`Selection::Ranked`].
    pub selection: Selection,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            swarm_size: d::SWARM_SIZE as usize,
            max_iterations: d::MAX_ITERATIONS as usize,
            stall_iterations: d::STALL_ITERATIONS as usize,
            c1: d::C1,
            c2: d::C2,
            inertia_max: d::INERTIA_MAX,
            inertia_min: d::INERTIA_MIN,
            decay_max: d::DECAY_MAX,
            decay_min: d::DECAY_MIN,
            regulating_scale: d::REGULATING_SCALE,
            velocity_limit: d::VELOCITY_LIMIT,
            selection: Selection::Ranked,
        }
    }
}

impl Settings {
    /// Largest swarm.
    pub const MAX_SWARM_SIZE: usize = 1024;

    /// Checks every range.
    ///
    /// # Errors
    /// The first setting that is out of its range.
    pub fn check(&self) -> Result<(), SettingsError> {
        if !(2..=Self::MAX_SWARM_SIZE).contains(&self.swarm_size) {
            return Err(SettingsError::SwarmSize(self.swarm_size));
        }
        for (name, count) in [("max_iterations", self.max_iterations), ("stall_iterations", self.stall_iterations)] {
            if count == 0 {
                return Err(SettingsError::NoIterations(name));
            }
        }
        for (name, value) in [("c1", self.c1), ("c2", self.c2), ("regulating_scale", self.regulating_scale)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(SettingsError::Negative { name, value });
            }
        }
        for (name, min, max) in
            [("inertia", self.inertia_min, self.inertia_max), ("decay", self.decay_min, self.decay_max)]
        {
            if !(max.is_finite() && 0.0 <= min && min <= max) {
                return Err(SettingsError::Order { name, min, max });
            }
        }
        if !(self.velocity_limit > 0.0 && self.velocity_limit <= 1.0) {
            return Err(SettingsError::VelocityLimit(self.velocity_limit));
        }
        Ok(())
    }
}

/// Settings or bounds no swarm can work with.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SettingsError {
    /// Too few individuals to rank or too many for the workspace.
    #[error("swarm_size {0} is outside 2 to {max}", max = Settings::MAX_SWARM_SIZE)]
    SwarmSize(usize),
    /// A stopping criterion that holds before the first iteration.
    #[error("{0} must be at least 1")]
    NoIterations(&'static str),
    /// A weight that is negative or not finite.
    #[error("{name} {value} must be finite and not negative")]
    Negative {
        /// The setting.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A range that is empty, negative or not finite.
    #[error("{name} must satisfy 0 <= min <= max, finite, but min is {min} and max {max}")]
    Order {
        /// The range.
        name: &'static str,
        /// Its lower end.
        min: f64,
        /// Its upper end.
        max: f64,
    },
    /// A velocity that stops the swarm or leaps over the whole range.
    #[error("velocity_limit {0} must be above 0 and at most 1")]
    VelocityLimit(f64),
    /// A member whose search range is empty or not finite.
    #[error("member {member}: bounds {lower} to {upper} are not a finite range")]
    Bounds {
        /// Index of the member.
        member: usize,
        /// Lower bound.
        lower: f64,
        /// Upper bound.
        upper: f64,
    },
}
