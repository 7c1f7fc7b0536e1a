//! What the layer needs to know of a definition, by value reference and slot.

use std::ops::Range;

use super::call_table::{Mode, Modes};
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

/// The variables of one base type, by slot.
#[derive(Debug, Clone, Default)]
pub struct Table {
    pub entries: Vec<Entry>,
    /// By value reference: these are small numbers, and hosts ask for dozens a step.
    places: Vec<Place>,
    /// By slot.
    gates: Vec<Gate>,
}

/// Where a value reference leads.
#[derive(Debug, Clone, Copy)]
struct Place {
    slot: u32,
    /// How many references from this one on lead to slots that follow each other; zero where there is no variable.
    run: u32,
}

/// What a value must pass to be set by no more than a copy.
#[derive(Debug, Clone, Copy)]
struct Gate {
    /// As [`Entry::min`], but finite, so that infinities are below.
    min: f64,
    /// As [`Entry::max`], but finite.
    max: f64,
    /// As [`Entry::settable`]; nowhere for states, which the model has to be told of.
    settable: Modes,
    /// How many slots from this one on have the same gate.
    alike: u32,
}

impl Table {
    /// The slot behind a value reference.
    #[inline]
    pub fn slot(&self, reference: u32) -> Option<usize> {
        self.places.get(reference as usize).filter(|place| place.run > 0).map(|place| place.slot as usize)
    }

    /// The slots behind `references` if these follow each other and so do the slots, as those of most requests do.
    #[inline]
    pub fn run(&self, references: &[u32]) -> Option<Range<usize>> {
        let first = *references.first()?;
        let Place { slot, run } = *self.places.get(first as usize)?;
        // without an early end, so that several are compared at once
        let follow = |differences, (reference, expected)| differences | (reference ^ expected);
        let run = references.len() <= run as usize && references.iter().zip(first..).fold(0, follow) == 0;
        run.then(|| slot as usize..slot as usize + references.len())
    }

    /// Copies the `values` behind `references` one by one; the error is a reference behind which there is none.
    pub fn gather(&self, values: &[f64], references: &[u32], out: &mut [f64]) -> Result<(), u32> {
        for (&reference, out) in references.iter().zip(out) {
            *out = values[self.slot(reference).ok_or(reference)?];
        }
        Ok(())
    }

    /// Whether `values` may be copied into `slots` in `mode`: variables other than states, with the same gate, settable,
    /// the values finite and within their limits.
    #[inline]
    pub fn admits(&self, slots: &Range<usize>, values: &[f64], mode: Mode) -> bool {
        let Gate { min, max, settable, alike } = self.gates[slots.start];
        // without an early end, so that several are compared at once
        let within = |all, value: &f64| all & (min <= *value) & (*value <= max);
        values.len() <= alike as usize && settable.contains(mode) && values.iter().fold(true, within)
    }

    fn new(definition: &Definition, variable_type: VariableType) -> Self {
        let variables = definition.variables.iter().enumerate().filter(|(_, v)| v.variable_type() == variable_type);
        let mut inputs = 0;
        let entries: Vec<Entry> = variables.clone().map(|(i, v)| entry(definition, i, v, &mut inputs)).collect();
        let largest = variables.clone().map(|(_, v)| v.value_reference).max();
        let mut places = vec![Place { slot: 0, run: 0 }; largest.map_or(0, |reference| reference as usize + 1)];
        for (slot, (_, v)) in (0..).zip(variables) {
            places[v.value_reference as usize] = Place { slot, run: 1 };
        }
        for reference in (1..places.len()).rev() {
            let next = places[reference];
            let place = &mut places[reference - 1];
            if place.run > 0 && next.run > 0 && next.slot == place.slot + 1 {
                place.run += next.run;
            }
        }
        let mut gates: Vec<Gate> = entries.iter().map(Gate::new).collect();
        for slot in (1..gates.len()).rev() {
            let next = gates[slot];
            let gate = &mut gates[slot - 1];
            if (gate.min, gate.max, gate.settable) == (next.min, next.max, next.settable) {
                gate.alike += next.alike;
            }
        }
        Self { entries, places, gates }
    }
}

impl Gate {
    fn new(entry: &Entry) -> Self {
        let settable = if entry.state.is_some() { Modes::NONE } else { entry.settable };
        Self { min: entry.min.max(f64::MIN), max: entry.max.min(f64::MAX), settable, alike: 1 }
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
