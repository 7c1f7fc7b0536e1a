//! Model Exchange (FMI 2.0 section 3.2).

use super::call_table::Mode;
use super::error::{CallError, CallResult};
use super::instance::Instance;
use super::lifecycle::MAX_TIME;
use super::model::Model;
use super::types::{EventInfo, FALSE, TRUE};

/// `expected` elements, whatever the host says.
fn check_length(what: &str, length: usize, expected: usize) -> CallResult {
    if length == expected {
        Ok(())
    } else {
        Err(CallError::Refused(format!("the model has {expected} {what}, not {length}")))
    }
}

impl<M: Model> Instance<M> {
    /// `fmi2EnterEventMode`
    pub(super) fn enter_event_mode(&mut self) {
        self.now.mode = Mode::Event;
        self.now.discrete_states_settled = false;
    }

    /// `fmi2NewDiscreteStates`. One iteration always settles the event.
    pub(super) fn new_discrete_states(&mut self) -> CallResult<EventInfo> {
        let now = &mut self.now;
        let update = now
            .model
            .new_discrete_states(&mut now.values, now.time, &mut self.logger)
            .map_err(|error| CallError::from(error).without_discard())?;
        now.stale = true;
        now.discrete_states_settled = true;
        let next_event_time = update.next_event_time.unwrap_or(0.0);
        if update.next_event_time.is_some() && !(next_event_time.is_finite() && next_event_time > now.time) {
            // the host would handle events for ever
            return Err(CallError::Failed(format!("the next event, at {next_event_time:?} s, is not in the future")));
        }
        Ok(EventInfo {
            values_of_continuous_states_changed: if update.states_changed { TRUE } else { FALSE },
            next_event_time_defined: if update.next_event_time.is_some() { TRUE } else { FALSE },
            next_event_time,
            ..EventInfo::default()
        })
    }

    /// `fmi2EnterContinuousTimeMode`
    pub(super) fn enter_continuous_time_mode(&mut self) {
        self.now.mode = Mode::ContinuousTime;
    }

    /// `fmi2SetTime`
    pub(super) fn set_time(&mut self, time: f64) -> CallResult {
        if !time.is_finite() || time.abs() > MAX_TIME {
            return Err(CallError::Refused(format!("time {time:?} s is not within +-{MAX_TIME:e} s")));
        }
        if time == self.now.time {
            return Ok(());
        }
        if self.now.mode == Mode::Event {
            // footnote 8 of section 3.2.3
            if !(self.layout.pure_discrete_time && self.now.discrete_states_settled) {
                return Err(CallError::refused("time stands still in Event Mode"));
            }
            self.now.discrete_states_settled = false;
        }
        self.set_current_time(time);
        self.now.stale = true;
        Ok(())
    }

    /// `fmi2SetContinuousStates`
    pub(super) fn set_continuous_states(&mut self, states: &[f64]) -> CallResult {
        check_length("continuous states", states.len(), self.layout.derivatives.len())?;
        if let Some(i) = states.iter().position(|x| !x.is_finite()) {
            return Err(CallError::Refused(format!("continuous state {i} = {:?} is not finite", states[i])));
        }
        self.now.model.continuous_states_mut().copy_from_slice(states);
        self.now.stale |= !states.is_empty();
        Ok(())
    }

    /// `fmi2GetContinuousStates`
    pub(super) fn get_continuous_states(&mut self, out: &mut [f64]) -> CallResult {
        check_length("continuous states", out.len(), self.layout.derivatives.len())?;
        if self.now.mode == Mode::Initialization {
            self.refresh()?;
        }
        out.copy_from_slice(self.now.model.continuous_states());
        Ok(())
    }

    /// `fmi2GetDerivatives`
    pub(super) fn get_derivatives(&mut self, out: &mut [f64]) -> CallResult {
        check_length("continuous states", out.len(), self.layout.derivatives.len())?;
        let now = &self.now;
        if now.stale && matches!(now.mode, Mode::Event | Mode::ContinuousTime) {
            now.model.derivatives(&now.values, now.time, out)?;
            return match out.iter().position(|x| !x.is_finite()) {
                None => Ok(()),
                Some(i) => Err(self.not_finite(self.layout.derivatives[i])),
            };
        }
        self.refresh()?;
        for (out, &slot) in out.iter_mut().zip(&self.layout.derivatives) {
            *out = self.now.values.reals[slot];
        }
        Ok(())
    }

    /// `fmi2GetEventIndicators`: a model has none, see [`crate::description::Definition::event_indicators`].
    pub(super) fn get_event_indicators(&self, out: &[f64]) -> CallResult {
        check_length("event indicators", out.len(), self.layout.definition.event_indicators)
    }

    /// `fmi2GetNominalsOfContinuousStates`
    pub(super) fn get_nominals(&self, out: &mut [f64]) -> CallResult {
        check_length("continuous states", out.len(), self.layout.derivatives.len())?;
        self.now.model.nominals(out);
        Ok(())
    }
}
