//! Figures of merit of runs.

use nalgebra::Vector3;

use super::crossing::within_stops;
use crate::coupling::{Experiment, Record, RunError};
use crate::mechanism::{Geometry, Limb, Pose};

/// Figures of one run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Figures {
    /// Largest pose error, m: of heave and r_b times tilt.
    pub peak: f64,
    /// Root mean square of it, m.
    pub rms: f64,
    /// Largest voltage, V.
    pub voltage: f64,
    /// Time with a voltage at its limit, s.
    pub saturation: f64,
    /// A limb went beyond an end stop.
    pub end_stop: bool,
    /// Swarm iterations a tick.
    pub iterations: f64,
    /// Why the run ended early.
    pub failure: Option<RunError>,
}

impl Figures {
    /// Of the run that `run` makes of `experiment`, handing each record on.
    pub fn of(experiment: &Experiment, run: impl FnOnce(&mut dyn FnMut(&Record)) -> Result<(), RunError>) -> Self {
        let plant = &experiment.plant;
        let geometry = Geometry::new(plant.mechanism.base_radius, plant.mechanism.joint_spacing);
        let mut figures = Self::default();
        let (mut ticks, mut squares, mut iterations) = (0.0, 0.0, 0.0);
        let outcome = run(&mut |record| {
            let error = record.pose_error(geometry.joint_radius);
            figures.peak = figures.peak.max(error);
            figures.voltage = figures.voltage.max(record.diagnostics.voltages.amax());
            if record.diagnostics.saturated {
                figures.saturation += experiment.controller.sample_time;
            }
            let pose = Pose::new(&geometry, &Vector3::new(record.state[0], record.state[1], record.state[2]));
            figures.end_stop |= !within_stops(plant, &Limb::all(&geometry, &pose));
            squares += error * error;
            iterations += record.diagnostics.iterations as f64;
            ticks += 1.0;
        });
        figures.rms = (squares / ticks).sqrt();
        figures.iterations = iterations / ticks;
        figures.failure = outcome.err();
        figures
    }
}

/// Median, 90 % quantile and maximum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distribution {
    pub median: f64,
    pub ninety: f64,
    pub max: f64,
}

impl Distribution {
    /// Of `values`, which are sorted thereby; there must be at least one.
    pub fn of(values: &mut [f64]) -> Self {
        values.sort_unstable_by(f64::total_cmp);
        let last = values.len() - 1;
        Self { median: values[last / 2], ninety: values[last * 9 / 10], max: values[last] }
    }
}
