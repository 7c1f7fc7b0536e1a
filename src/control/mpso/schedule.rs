//! What changes from iteration to iteration: the inertia weight (3.2) and the decay scale (3.5).

use super::Settings;

/// Inertia weight w of an iteration (3.2), counted from 0: w_max in the first one, reaching w_min
/// after g_max of them.
pub fn inertia(settings: &Settings, iteration: usize) -> f64 {
    let slope = (settings.inertia_max - settings.inertia_min) / settings.max_iterations as f64;
    settings.inertia_max - slope * iteration as f64 // (3.2)
}

/// The adaptive decay scale s of (3.5), from `decay_max` down to `decay_min`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DecaySchedule {
    scale: f64,
    step: f64,
    min: f64,
}

impl DecaySchedule {
    /// The schedule before the first iteration.
    pub fn new(settings: &Settings) -> Self {
        let span = settings.decay_max - settings.decay_min;
        Self {
            scale: settings.decay_max,
            step: settings.regulating_scale * span / settings.max_iterations as f64, // (3.5)
            min: settings.decay_min,
        }
    }

    /// The scale in force.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Ends an iteration. `improved` tells whether F_min fell, that is whether the smallest error
    /// found so far did; as long as it does, the scale keeps its value.
    pub fn advance(&mut self, improved: bool) {
        if !improved {
            self.scale = (self.scale - self.step).max(self.min); // (3.5)
        }
    }
}
