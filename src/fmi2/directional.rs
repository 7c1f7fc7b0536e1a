//! Directional derivatives (FMI 2.0 section 2.1.9).

use super::call_table::Mode;
use super::error::{CallError, CallResult};
use super::instance::{Instance, Snapshot};
use super::layout::Entry;
use super::model::{Direction, Model};
use super::types::{Interface, ValueReference};
use super::variables::slot;

impl<M: Model> Instance<M> {
    /// `fmi2GetDirectionalDerivative`
    pub(super) fn get_directional_derivative(
        &mut self,
        unknowns: &[ValueReference],
        knowns: &[ValueReference],
        seed: &[f64],
        out: &mut [f64],
    ) -> CallResult {
        if !self.layout.definition.capabilities.provides_directional_derivative {
            return Err(CallError::refused("the model provides no directional derivatives"));
        }
        self.scratch.0.clear();
        for &reference in unknowns {
            let slot = slot(&self.layout.reals, "Real", reference)?;
            let entry = &self.layout.reals.entries[slot];
            if !self.is_unknown(entry) {
                return Err(CallError::Refused(format!("{} is no unknown of this mode", self.layout.name(entry))));
            }
            self.scratch.0.push(slot);
        }
        self.scratch.1.clear();
        self.scratch.2.clear();
        for (&reference, &factor) in knowns.iter().zip(seed) {
            let slot = slot(&self.layout.reals, "Real", reference)?;
            let entry = &self.layout.reals.entries[slot];
            if !self.is_known(entry) {
                return Err(CallError::Refused(format!("{} is no known of this mode", self.layout.name(entry))));
            }
            if !factor.is_finite() {
                return Err(CallError::Refused(format!("the seed of {} is not finite", self.layout.name(entry))));
            }
            self.scratch.1.push(slot);
            self.scratch.2.push(factor);
        }
        let initialization = self.now.mode == Mode::Initialization;
        if initialization {
            // elsewhere the equations stand by themselves, whatever becomes of the outputs
            self.refresh().map_err(CallError::without_discard)?;
        }
        let Snapshot { model, values, .. } = &mut self.now;
        let (unknowns, knowns, seed) = &self.scratch;
        let direction = Direction { initialization, knowns, seed };
        model
            .directional_derivative(values, &direction, unknowns, out)
            .map_err(|error| CallError::from(error).without_discard())?;
        if out.iter().all(|x| x.is_finite()) {
            Ok(())
        } else {
            Err(CallError::refused("the derivative is not finite here"))
        }
    }

    /// Discrete outputs are unknowns at events and communication points only.
    fn is_unknown(&self, entry: &Entry) -> bool {
        match self.now.mode {
            Mode::Initialization => entry.initial_unknown,
            Mode::ContinuousTime => entry.unknown && !entry.discrete,
            _ => entry.unknown,
        }
    }

    /// Discrete inputs are knowns at events and communication points only.
    fn is_known(&self, entry: &Entry) -> bool {
        match (self.now.mode, self.now.interface) {
            (Mode::Initialization, _) => entry.initial_known,
            (Mode::ContinuousTime, Interface::ModelExchange) => entry.known && !entry.discrete,
            _ => entry.known,
        }
    }
}
