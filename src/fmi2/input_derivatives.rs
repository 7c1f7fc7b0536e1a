//! Taylor terms of the inputs over a communication step (FMI 2.0 section 4.2.1).

use serde::{Deserialize, Serialize};

use super::layout::{Layout, Table};
use super::model::StepInputs;

/// Highest order of an input derivative that is kept.
pub const MAX_ORDER: usize = 4;

/// Derivatives of the continuous Real inputs of orders 1 to [`MAX_ORDER`].
///
/// They hold for one step from the time they were set at. After it they still tell the inputs'
/// rates at its end, which output derivatives need, but a further step has constant inputs unless
/// new ones are set.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct InputDerivatives {
    /// By continuous input and order - 1, unit of the input by s^order.
    terms: Vec<[f64; MAX_ORDER]>,
    phase: Phase,
    /// Start of the step that used the terms, seconds.
    origin: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum Phase {
    /// The inputs are constant.
    None,
    /// Set for the step to come.
    Pending,
    /// Of the step that was made last.
    Used,
}

impl Clone for InputDerivatives {
    fn clone(&self) -> Self {
        Self { terms: self.terms.clone(), ..*self }
    }

    fn clone_from(&mut self, source: &Self) {
        self.terms.clone_from(&source.terms);
        (self.phase, self.origin) = (source.phase, source.origin);
    }
}

impl InputDerivatives {
    /// None set, for a model with so many continuous inputs.
    pub fn new(inputs: usize) -> Self {
        Self { terms: vec![[0.0; MAX_ORDER]; inputs], phase: Phase::None, origin: 0.0 }
    }

    /// The number of inputs.
    pub fn len(&self) -> usize {
        self.terms.len()
    }

    /// Whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.origin.is_finite() && self.terms.iter().flatten().all(|x| x.is_finite())
    }

    /// Sets a derivative for the step to come; `order` is 1 to [`MAX_ORDER`].
    pub fn set(&mut self, input: usize, order: usize, value: f64) {
        if self.phase != Phase::Pending {
            self.terms.fill([0.0; MAX_ORDER]);
            self.phase = Phase::Pending;
        }
        self.terms[input][order - 1] = value;
    }

    /// Ties the terms to the start of the step that is made now, seconds.
    pub fn begin_step(&mut self, from: f64) {
        if self.phase == Phase::Pending {
            self.origin = from;
        }
    }

    /// Whether a step to be made now has constant inputs.
    pub fn constant(&self) -> bool {
        self.phase != Phase::Pending
    }

    /// Takes note that a step was made.
    pub fn step_done(&mut self) {
        self.phase = match self.phase {
            Phase::Pending => Phase::Used,
            Phase::Used | Phase::None => Phase::None,
        };
    }

    /// Leads the inputs among the Real values by slot from the step's start, where they were set, to `t`, its end.
    pub fn lead(&self, layout: &Layout, reals: &mut [f64], t: f64) {
        if self.constant() {
            return;
        }
        for (value, entry) in reals.iter_mut().zip(&layout.reals.entries) {
            if let Some(input) = entry.continuous_input {
                *value += self.deviation(input, t);
            }
        }
    }

    /// Deviation of `input` from its value at the origin, at time `t`.
    fn deviation(&self, input: usize, t: f64) -> f64 {
        horner(&self.terms[input], t - self.origin, |k| 1.0 / (k + 1) as f64) * (t - self.origin)
    }

    /// Rate of `input` at the current time `t`: at the end of the last step, or, once new terms are
    /// set, at the beginning of the next.
    pub fn rate(&self, input: usize, t: f64) -> f64 {
        match self.phase {
            Phase::None => 0.0,
            Phase::Pending => self.terms[input][0],
            Phase::Used => horner(&self.terms[input], t - self.origin, |k| if k == 0 { 1.0 } else { 1.0 / k as f64 }),
        }
    }
}

/// Sum of `terms[k] h^k product(scale(0) .. scale(k))`: a Taylor polynomial with its factorials.
fn horner(terms: &[f64; MAX_ORDER], h: f64, scale: impl Fn(usize) -> f64) -> f64 {
    let mut sum = 0.0;
    for k in (0..MAX_ORDER).rev() {
        sum = scale(k) * (terms[k] + h * sum);
    }
    sum
}

/// Inputs over one step: values at its start and their derivatives.
pub struct Inputs<'a> {
    start: &'a [f64],
    derivatives: &'a InputDerivatives,
    table: &'a Table,
}

impl<'a> Inputs<'a> {
    /// `start` holds the Real values by slot at the beginning of the step.
    pub fn new(layout: &'a Layout, start: &'a [f64], derivatives: &'a InputDerivatives) -> Self {
        Self { start, derivatives, table: &layout.reals }
    }
}

impl StepInputs for Inputs<'_> {
    fn at(&self, slot: usize, t: f64) -> f64 {
        match self.table.entries[slot].continuous_input {
            Some(input) if !self.constant() => self.start[slot] + self.derivatives.deviation(input, t),
            _ => self.start[slot],
        }
    }

    fn constant(&self) -> bool {
        self.derivatives.constant()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn taylor_terms_carry_their_factorials() {
        // u = t^3 about t = 1: u' = 3, u'' = 6, u''' = 6
        let mut derivatives = InputDerivatives::new(1);
        for (order, value) in [(1, 3.0), (2, 6.0), (3, 6.0)] {
            derivatives.set(0, order, value);
        }
        derivatives.begin_step(1.0);
        assert_eq!(1.0 + derivatives.deviation(0, 3.0), 27.0);
        derivatives.step_done();
        assert_eq!(derivatives.rate(0, 3.0), 27.0);
    }

    #[test]
    fn new_derivatives_leave_nothing_of_the_last_step_s() {
        let mut derivatives = InputDerivatives::new(2);
        derivatives.set(0, 1, 2.0);
        derivatives.set(1, 2, 3.0);
        derivatives.begin_step(0.0);
        derivatives.step_done();
        derivatives.set(1, 1, 5.0);
        derivatives.begin_step(1.0);
        assert_eq!((derivatives.deviation(0, 3.0), derivatives.deviation(1, 3.0)), (0.0, 10.0));
    }

    #[test]
    fn derivatives_hold_for_one_step() {
        let mut derivatives = InputDerivatives::new(1);
        derivatives.set(0, 1, 2.0);
        assert!(!derivatives.constant());
        derivatives.step_done();
        assert!(derivatives.constant());
        assert_eq!(derivatives.rate(0, 1.0), 2.0, "the left limit at the end of the step");
        derivatives.step_done();
        assert_eq!(derivatives.rate(0, 1.0), 0.0);
    }
}
