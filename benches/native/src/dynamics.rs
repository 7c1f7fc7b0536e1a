//! The plant without FMI: right-hand side, solver.

use std::hint::black_box;

use rps3::dynamics::solver::{Settings, Solver};
use rps3::dynamics::{Inputs, NOMINAL, PlantModel, PlantParameters, PlantState, derivative};
use serde_json::{Value, json};

use crate::crossing::{TICK, inputs, record, tick_at};
use crate::seconds;

/// Without end stops, which the engines it is compared with do not have either.
pub fn right_hand_side(states: &[[f64; 12]], rounds: usize) -> f64 {
    let model = PlantModel::without_stops(&PlantParameters::default().mechanism);
    let states: Vec<PlantState<f64>> = states.iter().map(|state| PlantState::from(*state)).collect();
    let u = Inputs::zero();
    let elapsed = seconds(|| {
        for _ in 0..rounds {
            for x in &states {
                black_box(derivative(black_box(&model), x, &u));
            }
        }
    });
    elapsed / (rounds * states.len()) as f64
}

/// Seconds of each step, and right-hand sides in the mean; a step longer than a tick keeps its first tick's
/// voltages.
pub fn solver_step(step: f64, tolerance: f64) -> anyhow::Result<Value> {
    let model = PlantModel::new(&PlantParameters::default());
    let records = record()?;
    let settings = Settings { tolerance, nominal: NOMINAL, max_step: f64::INFINITY };
    let steps = (records.len() as f64 * TICK / step).floor() as usize;
    let (mut x, mut solver) = (records[0].state, Solver::default());
    let mut times = Vec::with_capacity(steps);
    for k in 0..steps {
        let from = k as f64 * step;
        let u = inputs(&records[tick_at(from)]);
        let mut outcome = Ok(());
        times.push(seconds(|| {
            outcome = solver.integrate(|_, x| derivative(&model, x, &u), &mut x, from, from + step, &settings);
        }));
        outcome?;
    }
    Ok(json!({ "seconds": times, "evaluations": solver.evaluations as f64 / steps as f64 }))
}
