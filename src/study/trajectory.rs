//! The default crossing sample by sample: what every master's run of the FMUs is held against.

use crate::control::{Controller, ReferencePoint};
use crate::coupling::{Experiment, RunError};
use crate::defaults::{SAMPLE_TIME, STOP_TIME, TOLERANCE};
use crate::dynamics::STATES;
use crate::models::TOLERANCE_MARGIN;

/// What both sides say at a tick: the plant's state and measurements then, the voltages (V) from then on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    pub state: [f64; STATES],
    /// As a [`Measurement`](crate::control::Measurement) lists them.
    pub measured: [f64; 21],
    pub voltages: [f64; 6],
    /// Reference of (heave in m, tilt_x, tilt_y in rad).
    pub reference: [f64; 3],
}

/// The default experiment of both FMUs, coupled in process, controller first: a sample at the start, one a tick, and
/// one at the end.
///
/// # Errors
/// A controller or a plant that cannot go on.
pub fn trajectory() -> Result<Vec<Sample>, RunError> {
    // the tick at the end is one more than the default experiment has
    let experiment = Experiment {
        duration: STOP_TIME + SAMPLE_TIME,
        tolerance: TOLERANCE * TOLERANCE_MARGIN,
        ..Experiment::default()
    };
    let mut controller =
        Controller::new(experiment.controller).map_err(|error| RunError::Control { time: 0.0, error })?;
    let unused = ReferencePoint::default();
    let (mut measurements, mut samples) = (Vec::new(), Vec::new());
    experiment.run_with(
        |time, measured| {
            measurements.push(measured.to_array());
            controller.tick(time, measured, &unused, &experiment.tuning, true)
        },
        |record| {
            samples.push(Sample {
                state: record.state.into(),
                measured: Default::default(),
                voltages: record.diagnostics.voltages.into(),
                reference: record.diagnostics.reference.into(),
            });
        },
    )?;
    for (sample, measured) in samples.iter_mut().zip(measurements) {
        sample.measured = measured;
    }
    Ok(samples)
}
