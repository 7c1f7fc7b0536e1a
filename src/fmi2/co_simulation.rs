//! Co-Simulation (FMI 2.0 section 4.2).

use super::call_table::Mode;
use super::error::{CallError, CallResult};
use super::input_derivatives::{Inputs, MAX_ORDER};
use super::instance::{Instance, Snapshot};
use super::lifecycle::MAX_TIME;
use super::model::Model;
use super::types::{ValueReference, status_kind};
use super::variables::slot;

/// Longest communication step, seconds: with it a host gets its answer before it seems to hang.
pub const MAX_STEP: f64 = 100.0;

/// Largest overshoot over the stop time, as a part of the experiment's duration: room for the one
/// step that some masters make too many.
pub const STOP_TIME_OVERSHOOT: f64 = 0.1;

/// How far the host's idea of the current time may be from ours: rounding of `start + n * h` and
/// the like, never a noticeable part of a step.
fn time_tolerance(time: f64, step: f64) -> f64 {
    1e-6 * step + 64.0 * f64::EPSILON * time.abs()
}

/// Why a step cannot be made.
enum StepFault {
    Size,
    ElsewhereInTime,
    BeyondResolution,
    /// The stop time, seconds.
    PastStopTime(f64),
}

impl<M: Model> Instance<M> {
    /// `fmi2DoStep`: from the instance's own time to exactly `point + step`.
    pub(super) fn do_step(&mut self, point: f64, step: f64) -> CallResult {
        let (from, to) = self.check_step(point, step)?;
        self.now.input_derivatives.begin_step(from);
        let idle = self.now.input_derivatives.constant() && self.now.model.idle_until(to);
        if !idle {
            self.advance(from, to)?;
        }
        self.now.input_derivatives.step_done();
        self.set_current_time(to);
        Ok(())
    }

    /// The step itself; if it fails, model and values are as before.
    fn advance(&mut self, from: f64, to: f64) -> CallResult {
        self.back_up();
        let Snapshot { model, values, input_derivatives, .. } = &mut self.now;
        input_derivatives.lead(self.layout, &mut values.reals, to);
        let inputs = Inputs::new(self.layout, &self.step_start.1.reals, input_derivatives);
        let result = model
            .step(values, &inputs, from, to, &mut self.logger)
            .map_err(CallError::from)
            .and_then(|()| self.check_finite().map_err(CallError::without_discard));
        if let Err(error) = result {
            self.roll_back();
            if let CallError::Discard(_) = error {
                self.now.mode = Mode::StepFailed;
            }
            return Err(error);
        }
        self.now.stale = false;
        Ok(())
    }

    /// Start and end of the step that the host asks for.
    fn check_step(&self, point: f64, step: f64) -> CallResult<(f64, f64)> {
        let refuse = |fault| Err(self.impossible(fault, point, step));
        let (from, to) = (self.now.time, point + step);
        // no comparison with what is not a number is true
        let proper = 0.0 < step && step <= MAX_STEP;
        if !proper {
            return refuse(StepFault::Size);
        }
        let tolerance = time_tolerance(from, step);
        let here = (point - from).abs() <= tolerance;
        if !here {
            return refuse(StepFault::ElsewhereInTime);
        }
        if to <= from || to.abs() > MAX_TIME {
            return refuse(StepFault::BeyondResolution);
        }
        if let Some(experiment) = self.now.experiment
            && let Some(stop) = experiment.stop_time
        {
            let overshoot = STOP_TIME_OVERSHOOT * (stop - experiment.start_time);
            if from > stop + tolerance || to > stop + overshoot + tolerance {
                return refuse(StepFault::PastStopTime(stop));
            }
        }
        Ok((from, to))
    }

    #[cold]
    fn impossible(&self, fault: StepFault, point: f64, step: f64) -> CallError {
        let (from, to) = (self.now.time, point + step);
        CallError::Refused(match fault {
            StepFault::Size if step.is_finite() && step > 0.0 => {
                format!("communication step size {step:?} s is larger than {MAX_STEP:?} s")
            }
            StepFault::Size => format!("communication step size {step:?} s is not positive and finite"),
            StepFault::ElsewhereInTime => {
                format!("communication point {point:?} s is not the current time {from:?} s")
            }
            StepFault::BeyondResolution => {
                format!("a step of {step:?} s from {point:?} s is beyond the resolution of time")
            }
            StepFault::PastStopTime(stop) => format!("a step to {to:?} s is past the stop time {stop:?} s"),
        })
    }

    /// `fmi2SetRealInputDerivatives`: all or nothing.
    pub(super) fn set_real_input_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[i32],
        values: &[f64],
    ) -> CallResult {
        let Self { layout, now, .. } = self;
        let input = |reference| {
            let slot = slot(&layout.reals, "Real", reference)?;
            let entry = &layout.reals.entries[slot];
            entry
                .continuous_input
                .ok_or_else(|| CallError::Refused(format!("{} is not a continuous input", layout.name(entry))))
        };
        let order_of = |order: i32| {
            usize::try_from(order).ok().filter(|order| (1..=MAX_ORDER).contains(order)).ok_or_else(|| {
                CallError::Refused(format!("input derivatives are of order 1 to {MAX_ORDER}, not {order}"))
            })
        };
        for ((&reference, &order), &value) in references.iter().zip(orders).zip(values) {
            input(reference)?;
            order_of(order)?;
            if !value.is_finite() {
                return Err(CallError::Refused(format!("input derivative {value:?} is not finite")));
            }
        }
        for ((&reference, &order), &value) in references.iter().zip(orders).zip(values) {
            now.input_derivatives.set(input(reference)?, order_of(order)?, value);
        }
        Ok(())
    }

    /// `fmi2GetRealOutputDerivatives`; above the order that the model provides they are zero.
    pub(super) fn get_real_output_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[i32],
        out: &mut [f64],
    ) -> CallResult {
        for (&reference, &order) in references.iter().zip(orders) {
            let entry = &self.layout.reals.entries[slot(&self.layout.reals, "Real", reference)?];
            if !entry.output {
                return Err(CallError::Refused(format!("{} is not an output", self.layout.name(entry))));
            }
            if order < 1 {
                return Err(CallError::Refused(format!("output derivatives are of order 1 or more, not {order}")));
            }
        }
        self.refresh().map_err(CallError::without_discard)?;
        let Snapshot { model, values, time, input_derivatives, .. } = &mut self.now;
        let entries = &self.layout.reals.entries;
        let rates = |slot: usize| entries[slot].continuous_input.map_or(0.0, |i| input_derivatives.rate(i, *time));
        for ((&reference, &order), out) in references.iter().zip(orders).zip(out) {
            *out = if order.cast_unsigned() > self.layout.definition.capabilities.max_output_derivative_order {
                0.0
            } else {
                let slot = slot(&self.layout.reals, "Real", reference)?;
                model
                    .output_derivative(values, *time, slot, &rates)
                    .map_err(|error| CallError::from(error).without_discard())?
            };
            if !out.is_finite() {
                return Err(CallError::Failed("an output derivative is not finite".to_owned()));
            }
        }
        Ok(())
    }

    /// `fmi2GetRealStatus`: the end of the last step that succeeded.
    pub(super) fn get_real_status(&self, kind: i32) -> CallResult<f64> {
        if kind == status_kind::LAST_SUCCESSFUL_TIME { Ok(self.now.time) } else { Err(no_such_status(kind)) }
    }

    /// `fmi2GetBooleanStatus`: the slave never asks for the end of the simulation.
    pub(super) fn get_boolean_status(&self, kind: i32) -> CallResult<bool> {
        if kind == status_kind::TERMINATED { Ok(false) } else { Err(no_such_status(kind)) }
    }
}

/// What belongs to asynchronous steps, or to another of the `fmi2GetXXXStatus` functions.
pub(super) fn no_such_status(kind: i32) -> CallError {
    CallError::NoSuchStatus(format!("status {kind} is not available here: steps are synchronous"))
}
