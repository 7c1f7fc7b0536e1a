//! Experiment, initialization and termination (FMI 2.0 section 2.1.6).

use super::call_table::Mode;
use super::error::{CallError, CallResult};
use super::instance::Instance;
use super::model::{Experiment, Model};
use super::types::Interface;

/// Largest absolute time, seconds: beyond it a double resolves less than a microsecond, and clocks
/// that count ticks would stand still.
pub const MAX_TIME: f64 = 1e9;

impl<M: Model> Instance<M> {
    /// `fmi2SetupExperiment`
    pub(super) fn setup_experiment(
        &mut self,
        tolerance: Option<f64>,
        start_time: f64,
        stop_time: Option<f64>,
    ) -> CallResult {
        let refuse = |message: String| Err(CallError::Refused(message));
        if let Some(tolerance) = tolerance
            && !(tolerance.is_finite() && tolerance > 0.0)
        {
            return refuse(format!("tolerance {tolerance:?} is not positive and finite"));
        }
        if !start_time.is_finite() || start_time.abs() > MAX_TIME {
            return refuse(format!("start time {start_time:?} s is not within +-{MAX_TIME:e} s"));
        }
        if let Some(stop_time) = stop_time
            && !(stop_time.is_finite() && stop_time > start_time)
        {
            return refuse(format!("stop time {stop_time:?} s is not after the start time {start_time:?} s"));
        }
        self.now.experiment = Some(Experiment { start_time, stop_time, tolerance });
        self.set_current_time(start_time);
        Ok(())
    }

    /// `fmi2EnterInitializationMode`
    pub(super) fn enter_initialization_mode(&mut self) -> CallResult {
        if self.now.experiment.is_none() {
            return Err(CallError::refused("fmi2SetupExperiment has to be called first"));
        }
        self.now.mode = Mode::Initialization;
        self.now.stale = true;
        Ok(())
    }

    /// `fmi2ExitInitializationMode`
    pub(super) fn exit_initialization_mode(&mut self) -> CallResult {
        let Some(experiment) = self.now.experiment else {
            return Err(CallError::refused("fmi2SetupExperiment has to be called first"));
        };
        self.now
            .model
            .initialize(&mut self.now.values, &experiment, true, &mut self.logger)
            .map_err(CallError::from)
            .and_then(|()| self.check_finite())
            .map_err(CallError::without_discard)?;
        self.now.stale = false;
        self.now.discrete_states_settled = false;
        self.now.mode = match self.now.interface {
            Interface::ModelExchange => Mode::Event,
            Interface::CoSimulation => Mode::StepComplete,
        };
        Ok(())
    }

    /// `fmi2Terminate`
    pub(super) fn terminate(&mut self) {
        self.now.mode = Mode::Terminated;
    }
}
