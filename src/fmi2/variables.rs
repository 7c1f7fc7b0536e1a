//! Getting and setting variables (FMI 2.0 section 2.1.7).

use std::fmt::Debug;

use super::call_table::Mode;
use super::error::{CallError, CallResult};
use super::instance::Instance;
use super::layout::{Entry, Layout, Table};
use super::model::Model;
use super::types::{Boolean, FALSE, Interface, TRUE, ValueReference};
use crate::description::Variable;

/// The slot behind `reference`, or why there is none.
#[inline]
pub(super) fn slot(table: &Table, type_name: &str, reference: ValueReference) -> CallResult<usize> {
    match table.slot(reference) {
        Some(slot) => Ok(slot),
        None => Err(no_such_variable(type_name, reference)),
    }
}

#[cold]
fn no_such_variable(type_name: &str, reference: ValueReference) -> CallError {
    CallError::Refused(format!("there is no {type_name} variable with value reference {reference}"))
}

impl Layout {
    /// The variable behind `reference`, if it may be set in `mode`.
    #[inline]
    fn settable<'a>(
        &'a self,
        table: &'a Table,
        type_name: &str,
        reference: ValueReference,
        mode: Mode,
    ) -> CallResult<&'a Entry> {
        let entry = &table.entries[slot(table, type_name, reference)?];
        if entry.settable.contains(mode) { Ok(entry) } else { Err(self.not_settable(entry, mode)) }
    }

    #[cold]
    fn not_settable(&self, entry: &Entry, mode: Mode) -> CallError {
        let Variable { name, causality, variability, .. } = &self.definition.variables[entry.variable];
        CallError::Refused(format!("{name} ({causality:?}, {variability:?}) cannot be set in state {mode:?}"))
    }

    #[inline]
    fn check_limits<T: Copy + Debug + Into<f64>>(&self, entry: &Entry, value: T) -> CallResult {
        let number = value.into();
        if number.is_finite() && entry.min <= number && number <= entry.max {
            Ok(())
        } else {
            Err(self.beyond_limits(entry, value))
        }
    }

    #[cold]
    fn beyond_limits<T: Copy + Debug + Into<f64>>(&self, entry: &Entry, value: T) -> CallError {
        let (name, number) = (self.name(entry), value.into());
        if !number.is_finite() {
            CallError::Refused(format!("{name} = {value:?} is not finite"))
        } else if number < entry.min {
            CallError::Refused(format!("{name} = {value:?} is below its minimum {:?}", entry.min))
        } else {
            CallError::Refused(format!("{name} = {value:?} is above its maximum {:?}", entry.max))
        }
    }
}

impl<M: Model> Instance<M> {
    /// `fmi2GetReal`
    pub(super) fn get_real(&mut self, references: &[ValueReference], out: &mut [f64]) -> CallResult {
        if self.now.stale {
            self.bring_up_to_date(&self.layout.reals, "Real", references, true)?;
        }
        let read = self.layout.reals.read(&self.now.values.reals, references, out);
        read.map_err(|reference| no_such_variable("Real", reference))
    }

    /// `fmi2GetInteger`
    pub(super) fn get_integer(&mut self, references: &[ValueReference], out: &mut [i32]) -> CallResult {
        if self.now.stale {
            self.bring_up_to_date(&self.layout.integers, "Integer", references, false)?;
        }
        for (&reference, out) in references.iter().zip(out) {
            *out = self.now.values.integers[slot(&self.layout.integers, "Integer", reference)?];
        }
        Ok(())
    }

    /// `fmi2GetBoolean`
    pub(super) fn get_boolean(&mut self, references: &[ValueReference], out: &mut [Boolean]) -> CallResult {
        if self.now.stale {
            self.bring_up_to_date(&self.layout.booleans, "Boolean", references, false)?;
        }
        for (&reference, out) in references.iter().zip(out) {
            let value = self.now.values.booleans[slot(&self.layout.booleans, "Boolean", reference)?];
            *out = if value { TRUE } else { FALSE };
        }
        Ok(())
    }

    /// Computes the variables behind `references` before they are read, if they are computed and something has changed.
    ///
    /// `fmi2Discard` exists for `fmi2GetReal` of Model Exchange alone (section 2.1.3).
    #[inline(never)] // called when something has changed, which is seldom
    fn bring_up_to_date(
        &mut self,
        table: &Table,
        type_name: &str,
        references: &[ValueReference],
        discard: bool,
    ) -> CallResult {
        let mut calculated = false;
        for &reference in references {
            calculated |= table.entries[slot(table, type_name, reference)?].calculated;
        }
        if !calculated {
            return Ok(());
        }
        let result = self.refresh();
        if discard && self.now.interface == Interface::ModelExchange {
            result
        } else {
            result.map_err(CallError::without_discard)
        }
    }

    /// `fmi2SetReal`: all or nothing, but for measurements that may be missing: these keep their
    /// last value, the others are set, and the host is warned.
    pub(super) fn set_real(&mut self, references: &[ValueReference], values: &[f64]) -> CallResult {
        let Self { layout, now, .. } = self;
        let nearby = references.first().and_then(|&first| layout.reals.gate(first));
        let Some((span, _)) = nearby.filter(|(_, gate)| gate.admits(values, now.mode)) else {
            return self.set_one_by_one(references, values);
        };
        if let Some(slots) = span.run(references) {
            now.values.reals[slots.clone()].copy_from_slice(values);
            now.values.missing[slots].fill(false);
        } else if span.contains(references) {
            let (reals, missing) = (&mut now.values.reals[span.slots()], &mut now.values.missing[span.slots()]);
            for (&reference, &value) in references.iter().zip(values) {
                let place = span.place(reference);
                (reals[place], missing[place]) = (value, false);
            }
        } else {
            return self.set_one_by_one(references, values);
        }
        now.stale = true;
        Ok(())
    }

    /// As [`set_real`](Self::set_real), for what is not copied at once: variables with different limits, states, missing
    /// measurements, and values that are refused.
    #[inline(never)] // within `set_real` either would get too few registers
    fn set_one_by_one(&mut self, references: &[ValueReference], values: &[f64]) -> CallResult {
        let Self { layout, now, .. } = self;
        let table = &layout.reals;
        for (&reference, &value) in references.iter().zip(values) {
            if table.gate(reference).is_some_and(|(_, gate)| gate.admits(&[value], now.mode)) {
                continue;
            }
            let entry = layout.settable(table, "Real", reference, now.mode)?;
            if value.is_finite() || !entry.may_be_missing {
                layout.check_limits(entry, value)?;
            }
        }
        let mut missing = None;
        for (&reference, &value) in references.iter().zip(values) {
            let slot = slot(&layout.reals, "Real", reference)?;
            now.values.missing[slot] = !value.is_finite();
            if !value.is_finite() {
                missing = Some((slot, value));
                continue;
            }
            now.values.reals[slot] = value;
            if let Some(state) = layout.reals.entries[slot].state {
                now.model.continuous_states_mut()[state] = value;
            }
        }
        now.stale |= !references.is_empty();
        match missing {
            None => Ok(()),
            Some((slot, value)) => {
                let (name, kept) = (layout.name(&layout.reals.entries[slot]), now.values.reals[slot]);
                Err(CallError::Warned(format!("{name} = {value:?} counts as missing and stays {kept:?}")))
            }
        }
    }

    /// `fmi2SetInteger`: all or nothing.
    pub(super) fn set_integer(&mut self, references: &[ValueReference], values: &[i32]) -> CallResult {
        let Self { layout, now, .. } = self;
        for (&reference, &value) in references.iter().zip(values) {
            let entry = layout.settable(&layout.integers, "Integer", reference, now.mode)?;
            layout.check_limits(entry, value)?;
        }
        for (&reference, &value) in references.iter().zip(values) {
            now.values.integers[slot(&layout.integers, "Integer", reference)?] = value;
        }
        now.stale |= !references.is_empty();
        Ok(())
    }

    /// `fmi2SetBoolean`: all or nothing.
    pub(super) fn set_boolean(&mut self, references: &[ValueReference], values: &[Boolean]) -> CallResult {
        let Self { layout, now, .. } = self;
        for &reference in references {
            layout.settable(&layout.booleans, "Boolean", reference, now.mode)?;
        }
        for (&reference, &value) in references.iter().zip(values) {
            now.values.booleans[slot(&layout.booleans, "Boolean", reference)?] = value != FALSE;
        }
        now.stale |= !references.is_empty();
        Ok(())
    }

    /// `fmi2GetString` and `fmi2SetString`: no variable is a String.
    pub(super) fn no_strings(&self, references: &[ValueReference]) -> CallResult {
        match references.first() {
            None => Ok(()),
            Some(&reference) => Err(no_such_variable("String", reference)),
        }
    }
}
