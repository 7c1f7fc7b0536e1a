//! What the layer needs to know of a definition, by value reference and slot.

use super::call_table::{Mode, Modes};
use super::spans::{Span, Spans};
use crate::description::{Causality, Definition, Initial, Kind, Unknown, Variability, Variable, VariableType};

/// A variable as the layer sees it.
#[derive(Debug, Clone)]
pub struct Entry {
    /// Position in [`Definition::variables`].
    pub variable: usize,
    /// Where it may be set (footnotes 1 and 3 to 6 of the call tables).
    pub settable: Modes,
    /// Inclusive limits, infinite where there is none.
    pub min: f64,
    /// See `min`.
    pub max: f64,
    /// Computed by the model, so that reading it may need an update first.
    pub calculated: bool,
    /// Index of the continuous state that this variable is.
    pub state: Option<usize>,
    /// Index among the continuous Real inputs.
    pub continuous_input: Option<usize>,
    /// Known of the model's equations once initialized (section 2.2.8).
    pub known: bool,
    /// Known of the initial equations.
    pub initial_known: bool,
    /// Unknown of the model's equations: an output or a state derivative.
    pub unknown: bool,
    /// Unknown of the initial equations.
    pub initial_unknown: bool,
    /// Changes at events only.
    pub discrete: bool,
    /// Has causality `output`.
    pub output: bool,
    /// Numbers that are not finite stand for a missing value and are no error.
    pub may_be_missing: bool,
}

/// The variables of one base type.
#[derive(Debug, Clone)]
pub struct Table {
    /// By slot.
    pub entries: Vec<Entry>,
    spans: Spans<()>,
    gates: Spans<Gate>,
}

/// What a value must pass to be set by no more than a copy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gate {
    /// As [`Entry::min`], but finite, so that infinities are below.
    min: f64,
    /// As [`Entry::max`], but finite.
    max: f64,
    /// As [`Entry::settable`]; nowhere for states, which the model has to be told of.
    settable: Modes,
}

impl Table {
    /// The slot behind a value reference.
    #[inline]
    pub fn slot(&self, reference: u32) -> Option<usize> {
        self.spans.of(reference).map(|(span, ())| span.slots().start + span.place(reference))
    }

    /// The variables around the one behind `reference` that have the same gate.
    #[inline]
    pub fn gate(&self, reference: u32) -> Option<&(Span, Gate)> {
        self.gates.of(reference)
    }

    /// Copies the `values` behind `references`; the error is a reference behind which there is none.
    #[inline]
    pub fn read(&self, values: &[f64], references: &[u32], out: &mut [f64]) -> Result<(), u32> {
        let Some(&first) = references.first() else { return Ok(()) };
        let (span, ()) = self.spans.of(first).ok_or(first)?;
        if let Some(slots) = span.run(references) {
            out.copy_from_slice(&values[slots]);
            return Ok(());
        }
        self.gather(values, references, out)
    }

    /// As [`read`](Self::read), one by one.
    #[inline(never)] // within `read` either would get too few registers
    fn gather(&self, values: &[f64], references: &[u32], out: &mut [f64]) -> Result<(), u32> {
        let mut done = 0;
        while let Some(&reference) = references.get(done) {
            let (span, ()) = self.spans.of(reference).ok_or(reference)?;
            done += span.gather(&values[span.slots()], &references[done..], &mut out[done..]);
        }
        Ok(())
    }

    fn new(definition: &Definition, variable_type: VariableType) -> Self {
        let variables = definition.variables.iter().enumerate().filter(|(_, v)| v.variable_type() == variable_type);
        let mut inputs = 0;
        let entries: Vec<Entry> = variables.clone().map(|(i, v)| entry(definition, i, v, &mut inputs)).collect();
        let references = variables.map(|(_, v)| v.value_reference);
        let spans = Spans::new(references.clone().map(|reference| (reference, ())));
        let gates = Spans::new(references.zip(entries.iter().map(Gate::new)));
        Self { entries, spans, gates }
    }
}

impl Gate {
    fn new(entry: &Entry) -> Self {
        let settable = if entry.state.is_some() { Modes::NONE } else { entry.settable };
        Self { min: entry.min.max(f64::MIN), max: entry.max.min(f64::MAX), settable }
    }

    /// Whether all `values` may pass in `mode`.
    #[inline]
    pub fn admits(&self, values: &[f64], mode: Mode) -> bool {
        // without an early end, so that several are compared at once
        let within = |all, &value: &f64| all & (self.min <= value) & (value <= self.max);
        self.settable.contains(mode) && values.iter().fold(true, within)
    }
}

/// All of it: the same for every instance of a model, never changed.
#[derive(Debug, Clone)]
pub struct Layout {
    pub(super) definition: &'static Definition,
    pub(super) reals: Table,
    pub(super) integers: Table,
    pub(super) booleans: Table,
    /// Slot of the independent variable.
    pub(super) time: Option<usize>,
    /// Slots of the state derivatives, in the order of the states.
    pub(super) derivatives: Vec<usize>,
    /// Number of continuous Real inputs.
    pub(super) continuous_inputs: usize,
    /// No continuous states and no event indicators (footnote 8 of section 3.2.3).
    pub(super) pure_discrete_time: bool,
}

impl Layout {
    /// The layout of `definition`.
    pub fn new(definition: &'static Definition) -> Self {
        let reals = Table::new(definition, VariableType::Real);
        let slot_of = |name: &str| super::Values::slot(definition, VariableType::Real, name);
        Self {
            time: definition
                .variables
                .iter()
                .find(|v| v.causality == Causality::Independent)
                .and_then(|v| slot_of(&v.name)),
            derivatives: definition.derivatives.iter().filter_map(|d| slot_of(&d.variable)).collect(),
            continuous_inputs: reals.entries.iter().filter(|e| e.continuous_input.is_some()).count(),
            pure_discrete_time: definition.derivatives.is_empty() && definition.event_indicators == 0,
            reals,
            integers: Table::new(definition, VariableType::Integer),
            booleans: Table::new(definition, VariableType::Boolean),
            definition,
        }
    }

    /// Name of the variable behind an entry.
    pub fn name(&self, entry: &Entry) -> &'static str {
        &self.definition.variables[entry.variable].name
    }
}

fn entry(definition: &Definition, index: usize, variable: &Variable, inputs: &mut usize) -> Entry {
    let is_in = |list: &[Unknown]| list.iter().any(|unknown| unknown.variable == variable.name);
    let state = definition.derivatives.iter().position(|derivative| {
        definition.variables.iter().any(|v| {
            v.name == derivative.variable
                && matches!(&v.kind, Kind::Real { derivative_of: Some(state), .. } if *state == variable.name)
        })
    });
    let (min, max) = match &variable.kind {
        Kind::Real { bounds, .. } => (bounds.min, bounds.max),
        Kind::Integer { bounds, .. } => (bounds.min.map(f64::from), bounds.max.map(f64::from)),
        Kind::Boolean { .. } => (None, None),
    };
    let input = variable.causality == Causality::Input;
    let discrete = variable.variability != Variability::Continuous;
    let continuous_input = (input && !discrete && matches!(variable.kind, Kind::Real { .. })).then(|| {
        *inputs += 1;
        *inputs - 1
    });
    let exact = variable.initial == Some(Initial::Exact) && variable.variability != Variability::Constant;
    let independent = variable.causality == Causality::Independent;
    Entry {
        variable: index,
        settable: settable(variable, state.is_some()),
        min: min.unwrap_or(f64::NEG_INFINITY),
        max: max.unwrap_or(f64::INFINITY),
        calculated: variable.initial == Some(Initial::Calculated) || state.is_some(),
        state,
        continuous_input,
        known: input || state.is_some() || independent,
        initial_known: input || exact || independent,
        unknown: is_in(&definition.outputs) || is_in(&definition.derivatives),
        initial_unknown: is_in(&definition.initial_unknowns),
        discrete,
        output: variable.causality == Causality::Output,
        may_be_missing: variable.may_be_missing,
    }
}

/// Footnotes 1 and 3 to 6 of the call tables, in one set of modes for both interfaces.
///
/// Inputs may be set before Initialization Mode too, where footnote 1 leaves them out: masters do
/// so with start values, and `fmi2SetRealInputDerivatives`, which has the restrictions of
/// `fmi2SetReal` (section 4.2.1), is legal there.
fn settable(variable: &Variable, is_state: bool) -> Modes {
    const BEFORE: Modes = Modes::of(&[Mode::Instantiated]);
    const INITIAL: Modes = Modes::of(&[Mode::Instantiated, Mode::Initialization]);
    const COMMUNICATION: Modes = Modes::of(&[Mode::Event, Mode::StepComplete]);
    const CONTINUOUS: Modes = Modes::of(&[Mode::ContinuousTime]);
    if variable.variability == Variability::Constant {
        return Modes::NONE;
    }
    let initially = match variable.initial {
        Some(Initial::Exact) => INITIAL,
        Some(Initial::Approx) => BEFORE,
        Some(Initial::Calculated) | None => Modes::NONE,
    };
    match (variable.causality, variable.variability) {
        (Causality::Input, Variability::Continuous) => INITIAL.and(COMMUNICATION).and(CONTINUOUS),
        (Causality::Input, _) => INITIAL.and(COMMUNICATION),
        (Causality::Parameter, Variability::Tunable) => initially.and(COMMUNICATION),
        (Causality::Independent, _) => Modes::NONE,
        _ if is_state => initially.and(CONTINUOUS),
        _ => initially,
    }
}
