//! A model over its C functions, and what in it moves when one of its knowns does.

use std::collections::BTreeSet;
use std::marker::PhantomData;
use std::ptr;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rps3::description::{Definition, Kind, Unknown, Variable, VariableType};
use rps3::fmi2::api;
use rps3::fmi2::types::{EventInfo, FmuState, Interface, Status};

use crate::common::{Fmu, Slave};

/// Calls a function of the probe's model.
macro_rules! call {
    ($probe:expr, $name:ident ( $($argument:expr),* )) => {
        // SAFETY: valid pointers and sizes.
        unsafe { api::$name::<M>($probe.slave.c $(, $argument)*) }
    };
}

/// An instance for Model Exchange, where states can be set.
pub struct Probe<M: Fmu> {
    slave: Slave<M>,
    model: PhantomData<M>,
}

impl<M: Fmu> Probe<M> {
    pub fn new() -> Self {
        Self { slave: Slave::of(Interface::ModelExchange), model: PhantomData }
    }

    /// Sets a variable of any type from a number; NaN for a measurement that is missing.
    pub fn set(&self, variable: &Variable, value: f64) {
        let reference = variable.value_reference;
        let status = match variable.variable_type() {
            VariableType::Real => call!(self, set_real(&reference, 1, &value)),
            VariableType::Integer => call!(self, set_integer(&reference, 1, &(value as i32))),
            VariableType::Boolean => call!(self, set_boolean(&reference, 1, &i32::from(value != 0.0))),
        };
        assert!(matches!(status, Status::Ok | Status::Warning), "{} = {value}", variable.name);
    }

    /// The values of variables of any type, `None` where the model refuses its parameters.
    pub fn get(&self, variables: &[&Variable]) -> Option<Vec<f64>> {
        let value = |variable: &&Variable| {
            let (reference, mut real, mut whole) = (variable.value_reference, f64::NAN, 0);
            let status = match variable.variable_type() {
                VariableType::Real => call!(self, get_real(&reference, 1, &mut real)),
                VariableType::Integer => call!(self, get_integer(&reference, 1, &mut whole)),
                VariableType::Boolean => call!(self, get_boolean(&reference, 1, &mut whole)),
            };
            let number = if variable.variable_type() == VariableType::Real { real } else { f64::from(whole) };
            (status == Status::Ok).then_some(number)
        };
        variables.iter().map(value).collect()
    }

    pub fn reset(&self) {
        self.slave.reset();
    }

    pub fn enter_initialization(&self, start_time: f64) {
        assert_eq!(call!(self, setup_experiment(0, 0.0, start_time, 0, 0.0)), Status::Ok);
        assert_eq!(call!(self, enter_initialization_mode()), Status::Ok);
    }

    /// Leaves Initialization Mode, unless the model refuses its parameters.
    pub fn exit_initialization(&self) -> bool {
        call!(self, exit_initialization_mode()) == Status::Ok
    }

    /// Handles an event; the time of the next one, unless the model cannot go on.
    pub fn event(&self) -> Option<f64> {
        let mut info = EventInfo::default();
        (call!(self, new_discrete_states(&mut info)) == Status::Ok).then_some(info.next_event_time)
    }

    pub fn enter_continuous_time(&self) {
        assert_eq!(call!(self, enter_continuous_time_mode()), Status::Ok);
    }

    /// To Event Mode at `time`.
    pub fn enter_event(&self, time: f64) {
        self.enter_continuous_time();
        self.set_time(time);
        assert_eq!(call!(self, enter_event_mode()), Status::Ok);
    }

    pub fn set_time(&self, time: f64) {
        assert_eq!(call!(self, set_time(time)), Status::Ok);
    }

    pub fn store(&self, state: &mut FmuState) {
        assert_eq!(call!(self, get_fmu_state(state)), Status::Ok);
    }

    pub fn restore(&self, state: FmuState) {
        self.slave.restore(state);
    }
}

/// Random numbers of a test.
pub struct Dice(Xoshiro256PlusPlus);

impl Dice {
    pub fn new() -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(4))
    }

    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        self.0.random_range(low..high)
    }

    /// Uniform in the logarithm.
    pub fn scale(&mut self, low: f64, high: f64) -> f64 {
        self.uniform(low.ln(), high.ln()).exp()
    }

    /// One of the whole numbers from `low` to `high`.
    pub fn whole(&mut self, low: i32, high: i32) -> f64 {
        f64::from(self.0.random_range(low..=high))
    }

    pub fn chance(&mut self, probability: f64) -> bool {
        self.0.random_bool(probability)
    }
}

/// Entries of `ModelStructure` and what of them has been seen.
pub struct Structure<'a> {
    pub knowns: Vec<&'a Variable>,
    pub unknowns: Vec<&'a Variable>,
    declared: Vec<BTreeSet<String>>,
    seen: Vec<BTreeSet<String>>,
}

impl<'a> Structure<'a> {
    pub fn new(definition: &'a Definition, knowns: Vec<&'a Variable>, list: &[Unknown]) -> Self {
        let of_name = |name: &str| definition.variables.iter().find(|v| v.name == name).expect("a variable");
        Self {
            knowns,
            unknowns: list.iter().map(|unknown| of_name(&unknown.variable)).collect(),
            declared: list.iter().map(|unknown| unknown.dependencies.iter().cloned().collect()).collect(),
            seen: vec![BTreeSet::new(); list.len()],
        }
    }

    /// Draws `least` points and redraws the knowns one by one at each, noting which unknowns follow; goes on, up to `most`
    /// points, while a known has not moved all that is declared to depend on it.
    ///
    /// `prepare` is called before each point; `evaluate` returns the unknowns' values at a point. Both may say that there
    /// is none.
    pub fn observe(
        &mut self,
        (least, most): (usize, usize),
        dice: &mut Dice,
        draw: impl Fn(&Variable, &mut Dice) -> f64,
        mut prepare: impl FnMut(&mut Dice) -> bool,
        mut evaluate: impl FnMut(&[f64]) -> Option<Vec<f64>>,
    ) {
        let mut points = 0;
        while points < least || (points < most && !self.knowns.iter().all(|known| self.complete(known))) {
            points += 1;
            if !prepare(dice) {
                continue;
            }
            let point: Vec<f64> = self.knowns.iter().map(|known| draw(known, dice)).collect();
            let Some(before) = evaluate(&point) else { continue };
            let mut edges = Vec::new();
            for k in 0..self.knowns.len() {
                let value = draw(self.knowns[k], dice);
                if let Some(after) = self.move_one(&point, k, value, &before, &mut evaluate) {
                    edges.extend(self.flipped(&before, &after).map(|u| (u, k, value)));
                }
            }
            // A Boolean or Integer follows small moves on the edge of a jump only: go there.
            edges.sort_unstable_by_key(|(u, ..)| *u);
            edges.dedup_by_key(|(u, ..)| *u);
            for (u, k, value) in edges {
                let Some(edge) = edge(&point, k, value, u, &mut evaluate) else { continue };
                let Some(before) = evaluate(&edge) else { continue };
                for k in 0..self.knowns.len() {
                    if points <= least || !self.complete(self.knowns[k]) {
                        let value = draw(self.knowns[k], dice);
                        self.move_one(&edge, k, value, &before, &mut evaluate);
                    }
                }
            }
        }
    }

    fn complete(&self, known: &Variable) -> bool {
        let both = self.declared.iter().zip(&self.seen);
        both.into_iter().all(|(declared, seen)| !declared.contains(&known.name) || seen.contains(&known.name))
    }

    /// Moves the known `k` to `value` and notes what follows.
    fn move_one(
        &mut self,
        point: &[f64],
        k: usize,
        value: f64,
        before: &[f64],
        evaluate: &mut impl FnMut(&[f64]) -> Option<Vec<f64>>,
    ) -> Option<Vec<f64>> {
        let mut moved = point.to_vec();
        moved[k] = value;
        let after = evaluate(&moved)?;
        self.note(self.knowns[k], before, &after);
        Some(after)
    }

    /// Notes which unknowns differ beyond rounding.
    pub fn note(&mut self, known: &Variable, before: &[f64], after: &[f64]) {
        for (u, unknown) in self.unknowns.iter().enumerate() {
            let nominal = match unknown.kind {
                Kind::Real { nominal: Some(nominal), .. } => nominal,
                _ => 1.0,
            };
            // A billionth lies far above what rounding leaves of independence, and far below what moving a known by some
            // ten per cent does somewhere among hundreds of points.
            if (before[u] - after[u]).abs() > 1e-9 * (nominal + before[u].abs()) {
                self.seen[u].insert(known.name.clone());
            }
        }
    }

    /// Booleans and Integers that differ.
    fn flipped<'b>(&'b self, before: &'b [f64], after: &'b [f64]) -> impl Iterator<Item = usize> + 'b {
        let whole = |u: &usize| self.unknowns[*u].variable_type() != VariableType::Real;
        (0..self.unknowns.len()).filter(whole).filter(|&u| before[u] != after[u])
    }

    /// Asserts that every unknown follows exactly the knowns that it declares.
    pub fn assert_true(&self) {
        let mut wrong = String::new();
        for ((unknown, declared), seen) in self.unknowns.iter().zip(&self.declared).zip(&self.seen) {
            let lists = [(seen - declared, "undeclared"), (declared - seen, "declared for nothing")];
            for (names, what) in lists.into_iter().filter(|(names, _)| !names.is_empty()) {
                let names = names.into_iter().collect::<Vec<_>>().join(" ");
                wrong += &format!("\n{}, {what}: {names}", unknown.name);
            }
        }
        assert!(wrong.is_empty(), "{wrong}");
    }
}

/// The point between `point` and the one with `value` for the known `k` where the unknown `u` jumps, by bisection.
fn edge(
    point: &[f64],
    k: usize,
    value: f64,
    u: usize,
    evaluate: &mut impl FnMut(&[f64]) -> Option<Vec<f64>>,
) -> Option<Vec<f64>> {
    let mut near = point.to_vec();
    let (mut low, mut high) = (point[k], value);
    let before = evaluate(&near)?[u];
    for _ in 0..40 {
        near[k] = 0.5 * (low + high);
        if evaluate(&near)?[u] == before {
            low = near[k];
        } else {
            high = near[k];
        }
    }
    near[k] = low;
    Some(near)
}

/// An FMU state to be allocated.
pub const NO_STATE: FmuState = ptr::null_mut();
