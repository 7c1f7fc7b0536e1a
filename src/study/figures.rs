//! Figures of merit of runs.

use crate::coupling::{Record, RunError};

/// Figures of one run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Figures {
    /// Largest pose error, m: of heave and r_b times tilt.
    pub peak: f64,
    /// Root mean square of it, m.
    pub rms: f64,
    /// Largest voltage, V.
    pub voltage: f64,
    /// Swarm iterations a tick.
    pub iterations: f64,
    /// Why the run ended early.
    pub failure: Option<RunError>,
}

impl Figures {
    /// Of the run that `run` makes, handing each record on; `joint_radius` r_b in m.
    pub fn of(joint_radius: f64, run: impl FnOnce(&mut dyn FnMut(&Record)) -> Result<(), RunError>) -> Self {
        let mut figures = Self::default();
        let (mut ticks, mut squares, mut iterations) = (0.0, 0.0, 0.0);
        let outcome = run(&mut |record| {
            let error = record.pose_error(joint_radius);
            figures.peak = figures.peak.max(error);
            figures.voltage = figures.voltage.max(record.diagnostics.voltages.amax());
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
