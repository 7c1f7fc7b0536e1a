//! An FMU instance: what belongs to its state, and what does not.

use std::collections::BTreeMap;
use std::ffi::CStr;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::Values;
use super::call_table::{Function, Mode};
use super::error::{CallError, CallResult};
use super::input_derivatives::InputDerivatives;
use super::layout::Layout;
use super::logger::Logger;
use super::model::{Experiment, Model};
use super::types::{Interface, Status};
use crate::description::LogCategory;

/// Everything that an FMU state holds: cloned by `fmi2GetFMUstate`, serialized to bytes.
#[derive(Serialize, Deserialize)]
#[serde(bound(serialize = "M: Serialize", deserialize = "M: DeserializeOwned"))]
pub(super) struct Snapshot<M> {
    pub interface: Interface,
    pub mode: Mode,
    /// Current time, seconds.
    pub time: f64,
    pub experiment: Option<Experiment>,
    pub model: M,
    pub values: Values,
    /// An input, parameter, state or the time was changed since the values were computed.
    pub stale: bool,
    /// `fmi2NewDiscreteStates` was called in the current Event Mode.
    pub discrete_states_settled: bool,
    pub input_derivatives: InputDerivatives,
}

/// An instance behind an `fmi2Component`.
pub struct Instance<M> {
    pub(super) layout: &'static Layout,
    pub(super) logger: Logger,
    pub(super) now: Snapshot<M>,
    /// Model and values before a communication step or a refresh during initialization, which may fail; kept to
    /// step without allocating.
    pub(super) step_start: (M, Values),
    /// The states handed out, by the address that is their handle.
    pub(super) states: BTreeMap<usize, Box<Snapshot<M>>>,
    /// Slots of unknowns and knowns, and the seed, of a directional derivative.
    pub(super) scratch: (Vec<usize>, Vec<usize>, Vec<f64>),
}

impl<M: Model> Instance<M> {
    /// A new instance in the state `instantiated`.
    pub(super) fn new(interface: Interface, layout: &'static Layout, logger: Logger) -> Self {
        let now: Snapshot<M> = Snapshot::new(interface, layout);
        let step_start = (now.model.clone(), now.values.clone());
        let reals = layout.reals.entries.len();
        let scratch = (Vec::with_capacity(reals), Vec::with_capacity(reals), Vec::with_capacity(reals));
        Self { layout, logger, now, step_start, states: BTreeMap::new(), scratch }
    }

    /// Runs `body` as the C function `function`: the one place where call order is checked and
    /// where errors become a status, a log line and a mode.
    pub(super) fn call(&mut self, function: Function, body: impl FnOnce(&mut Self) -> CallResult) -> Status {
        if self.now.mode == Mode::Fatal {
            return Status::Fatal;
        }
        let result =
            if function.is_legal(self.now.interface, self.now.mode) { body(self) } else { Err(self.out_of_order()) };
        match result {
            Ok(()) => Status::Ok,
            Err(error) => self.report(function, &error),
        }
    }

    #[cold]
    fn out_of_order(&self) -> CallError {
        CallError::refused(format!("not allowed in {}", self.state_name()))
    }

    #[cold]
    fn report(&mut self, function: Function, error: &CallError) -> Status {
        if let CallError::Failed(_) = error {
            self.now.mode = Mode::Error;
        }
        self.logger.log(error.status(), error.category(), &format!("{}: {error}", function.name()));
        error.status()
    }

    /// Marks the instance unusable after a panic in `function`.
    pub(super) fn poison(&mut self, function: Function, message: &str) {
        self.now.mode = Mode::Fatal;
        let message = format!("{}: internal error, the instance cannot be used any more: {message}", function.name());
        self.logger.log(Status::Fatal, LogCategory::StatusFatal, &message);
    }

    fn state_name(&self) -> String {
        let interface = match self.now.interface {
            Interface::ModelExchange => "Model Exchange",
            Interface::CoSimulation => "Co-Simulation",
        };
        format!("state {:?} of {interface}", self.now.mode)
    }

    /// `fmi2SetDebugLogging`
    pub(super) fn set_debug_logging(&mut self, on: bool, categories: &[&CStr]) -> CallResult {
        self.logger
            .switch(on, categories)
            .map_err(|name| CallError::refused(format!("log category {} is not declared", name.to_string_lossy())))
    }

    /// `fmi2Reset`: as after `fmi2Instantiate`. Handed-out states and log switches stay.
    pub(super) fn reset(&mut self) {
        self.now = Snapshot::new(self.now.interface, self.layout);
    }

    /// Sets the time and the independent variable.
    pub(super) fn set_current_time(&mut self, time: f64) {
        self.now.time = time;
        if let Some(slot) = self.layout.time {
            self.now.values.reals[slot] = time;
        }
    }

    /// Computes the calculated variables if something they depend on has changed.
    ///
    /// After an error or a discarded step values are for debugging only and stay as they are.
    pub(super) fn refresh(&mut self) -> CallResult {
        if !self.now.stale || matches!(self.now.mode, Mode::Instantiated | Mode::StepFailed | Mode::Error | Mode::Fatal)
        {
            return Ok(());
        }
        if let (Mode::Initialization, Some(experiment)) = (self.now.mode, self.now.experiment) {
            // what the parameters are worth is judged on leaving the mode: until then a host may
            // still be on its way to a consistent set
            self.back_up();
            let Snapshot { model, values, .. } = &mut self.now;
            let outcome = model
                .initialize(values, &experiment, false, &mut self.logger)
                .map_err(CallError::from)
                .and_then(|()| self.check_finite());
            if let Err(error) = outcome {
                self.roll_back();
                return Err(CallError::Refused(error.to_string()));
            }
        } else {
            let Snapshot { model, values, time, .. } = &mut self.now;
            model.update(values, *time)?;
            self.check_finite()?;
        }
        self.now.stale = false;
        Ok(())
    }

    /// Keeps model and values for [`roll_back`](Self::roll_back), reusing what is allocated.
    pub(super) fn back_up(&mut self) {
        self.step_start.0.clone_from(&self.now.model);
        self.step_start.1.clone_from(&self.now.values);
    }

    /// Undoes what happened to model and values since [`back_up`](Self::back_up).
    pub(super) fn roll_back(&mut self) {
        std::mem::swap(&mut self.now.model, &mut self.step_start.0);
        std::mem::swap(&mut self.now.values, &mut self.step_start.1);
    }

    /// No call succeeds with a value that is not finite.
    pub(super) fn check_finite(&self) -> CallResult {
        match self.now.values.reals.iter().position(|x| !x.is_finite()) {
            None => Ok(()),
            Some(slot) => Err(self.not_finite(slot)),
        }
    }

    /// The error of a Real that is not finite.
    pub(super) fn not_finite(&self, slot: usize) -> CallError {
        let name = self.layout.name(&self.layout.reals.entries[slot]);
        CallError::Discard(format!("{name} is not finite"))
    }
}

impl<M: Clone> Clone for Snapshot<M> {
    fn clone(&self) -> Self {
        Self {
            model: self.model.clone(),
            values: self.values.clone(),
            input_derivatives: self.input_derivatives.clone(),
            ..*self
        }
    }

    /// Reuses what is allocated, so that getting and setting a state again and again is cheap.
    fn clone_from(&mut self, source: &Self) {
        self.model.clone_from(&source.model);
        self.values.clone_from(&source.values);
        self.input_derivatives.clone_from(&source.input_derivatives);
        self.interface = source.interface;
        self.mode = source.mode;
        self.time = source.time;
        self.experiment = source.experiment;
        self.stale = source.stale;
        self.discrete_states_settled = source.discrete_states_settled;
    }
}

impl<M: Model> Snapshot<M> {
    fn new(interface: Interface, layout: &Layout) -> Self {
        Self {
            interface,
            mode: Mode::Instantiated,
            time: 0.0,
            experiment: None,
            model: M::instantiate(),
            values: Values::start(layout.definition),
            stale: true,
            discrete_states_settled: false,
            input_derivatives: InputDerivatives::new(layout.continuous_inputs),
        }
    }

    /// Whether a deserialized snapshot fits the definition and holds what could be saved.
    pub fn fits(&self, interface: Interface, layout: &Layout) -> bool {
        self.interface == interface
            && self.mode != Mode::Fatal
            && self.time.is_finite()
            && self.values.reals.len() == layout.reals.entries.len()
            && self.values.integers.len() == layout.integers.entries.len()
            && self.values.booleans.len() == layout.booleans.entries.len()
            && self
                .values
                .reals
                .iter()
                .zip(&layout.reals.entries)
                .all(|(x, entry)| x.is_finite() || (entry.calculated && (self.stale || self.mode == Mode::Error)))
            && self.values.missing.len() == layout.reals.entries.len()
            && self.values.missing.iter().zip(&layout.reals.entries).all(|(missing, e)| !missing || e.may_be_missing)
            && self.model.continuous_states().len() == layout.derivatives.len()
            && self.model.continuous_states().iter().all(|x| x.is_finite())
            && self.input_derivatives.len() == layout.continuous_inputs
            && self.input_derivatives.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::VariableType;
    use crate::models::Controller;

    #[test]
    fn a_snapshot_fits_only_if_it_could_have_been_saved() {
        type Spoil = fn(&mut Snapshot<Controller>);
        let layout = Layout::new(Controller::definition());
        let (time, slot) =
            (layout.time.unwrap(), |name| Values::slot(layout.definition, VariableType::Real, name).unwrap());
        assert_eq!((time, slot("d1"), slot("ref_heave")), (0, 1, 22), "what the closures below spoil");
        let spoiled = |spoil: Spoil| {
            let mut snapshot = Snapshot::<Controller>::new(Interface::CoSimulation, &layout);
            spoil(&mut snapshot);
            snapshot.fits(Interface::CoSimulation, &layout)
        };
        assert!(spoiled(|_| {}));
        assert!(spoiled(|snapshot| snapshot.values.missing[1] = true), "a measurement may be missing");
        let spoils: [Spoil; 10] = [
            |snapshot| snapshot.interface = Interface::ModelExchange,
            |snapshot| snapshot.mode = Mode::Fatal,
            |snapshot| snapshot.time = f64::NAN,
            |snapshot| snapshot.values.reals.push(0.0),
            |snapshot| snapshot.values.integers.clear(),
            |snapshot| snapshot.values.booleans.clear(),
            |snapshot| snapshot.values.reals[1] = f64::INFINITY,
            |snapshot| snapshot.values.missing[22] = true,
            |snapshot| snapshot.input_derivatives.set(0, 1, f64::NAN),
            |snapshot| snapshot.input_derivatives = InputDerivatives::new(1),
        ];
        for (k, spoil) in spoils.into_iter().enumerate() {
            assert!(!spoiled(spoil), "{k}");
        }
    }
}
