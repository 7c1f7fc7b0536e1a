//! Getting and setting variables (FMI 2.0 section 2.1.7).

use std::fmt::Debug;

use super::call_table::Mode;
use super::error::{CallError, CallResult};
use super::instance::Instance;
use super::layout::{Entry, Layout, Table};
use super::model::Model;
use super::types::{Boolean, FALSE, Interface, TRUE, ValueReference};

/// The slot behind `reference`, or why there is none.
pub(super) fn slot(table: &Table, type_name: &str, reference: ValueReference) -> CallResult<usize> {
    table
        .slot(reference)
        .ok_or_else(|| CallError::Refused(format!("there is no {type_name} variable with value reference {reference}")))
}

impl Layout {
    /// The slot behind `reference` if that variable may be set in `mode`.
    fn settable_slot(
        &self,
        table: &Table,
        type_name: &str,
        reference: ValueReference,
        mode: Mode,
    ) -> CallResult<usize> {
        let slot = slot(table, type_name, reference)?;
        let entry = &table.entries[slot];
        if entry.settable.contains(mode) {
            Ok(slot)
        } else {
            let variable = &self.definition.variables[entry.variable];
            Err(CallError::Refused(format!(
                "{} ({:?}, {:?}) cannot be set in state {mode:?}",
                variable.name, variable.causality, variable.variability
            )))
        }
    }

    fn check_limits<T: Copy + Debug + Into<f64>>(&self, entry: &Entry, value: T) -> CallResult {
        let (name, number) = (self.name(entry), value.into());
        if !number.is_finite() {
            Err(CallError::Refused(format!("{name} = {value:?} is not finite")))
        } else if number < entry.min {
            Err(CallError::Refused(format!("{name} = {value:?} is below its minimum {:?}", entry.min)))
        } else if number > entry.max {
            Err(CallError::Refused(format!("{name} = {value:?} is above its maximum {:?}", entry.max)))
        } else {
            Ok(())
        }
    }
}

impl<M: Model> Instance<M> {
    /// `fmi2GetReal`
    pub(super) fn get_real(&mut self, references: &[ValueReference], out: &mut [f64]) -> CallResult {
        let mut calculated = false;
        for (&reference, out) in references.iter().zip(&mut *out) {
            let slot = slot(&self.layout.reals, "Real", reference)?;
            calculated |= self.layout.reals.entries[slot].calculated;
            *out = self.now.values.reals[slot];
        }
        if calculated && self.now.stale {
            self.refresh_for_get(true)?;
            for (&reference, out) in references.iter().zip(out) {
                *out = self.now.values.reals[slot(&self.layout.reals, "Real", reference)?];
            }
        }
        Ok(())
    }

    /// `fmi2GetInteger`
    pub(super) fn get_integer(&mut self, references: &[ValueReference], out: &mut [i32]) -> CallResult {
        let mut calculated = false;
        for &reference in references {
            let slot = slot(&self.layout.integers, "Integer", reference)?;
            calculated |= self.layout.integers.entries[slot].calculated;
        }
        if calculated && self.now.stale {
            self.refresh_for_get(false)?;
        }
        for (&reference, out) in references.iter().zip(out) {
            *out = self.now.values.integers[slot(&self.layout.integers, "Integer", reference)?];
        }
        Ok(())
    }

    /// `fmi2GetBoolean`
    pub(super) fn get_boolean(&mut self, references: &[ValueReference], out: &mut [Boolean]) -> CallResult {
        let mut calculated = false;
        for &reference in references {
            let slot = slot(&self.layout.booleans, "Boolean", reference)?;
            calculated |= self.layout.booleans.entries[slot].calculated;
        }
        if calculated && self.now.stale {
            self.refresh_for_get(false)?;
        }
        for (&reference, out) in references.iter().zip(out) {
            let value = self.now.values.booleans[slot(&self.layout.booleans, "Boolean", reference)?];
            *out = if value { TRUE } else { FALSE };
        }
        Ok(())
    }

    /// A refresh before values are read; `fmi2Discard` exists for `fmi2GetReal` of Model Exchange
    /// alone (section 2.1.3).
    fn refresh_for_get(&mut self, discard: bool) -> CallResult {
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
        for (&reference, &value) in references.iter().zip(values) {
            let slot = layout.settable_slot(&layout.reals, "Real", reference, now.mode)?;
            let entry = &layout.reals.entries[slot];
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
            let slot = layout.settable_slot(&layout.integers, "Integer", reference, now.mode)?;
            layout.check_limits(&layout.integers.entries[slot], value)?;
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
            layout.settable_slot(&layout.booleans, "Boolean", reference, now.mode)?;
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
            Some(reference) => {
                Err(CallError::Refused(format!("there is no String variable with value reference {reference}")))
            }
        }
    }
}
