//! Integrators on the plant: error against right-hand sides and time.
//!
//! Two problems, both of the default crossing under HDRAC: *held* repeats what Co-Simulation does,
//! voltages that jump at each tick, hence a start each millisecond; *smooth* keeps the voltages of the
//! start and a force on the platform for 0.3 s in one piece.

mod integrators;

use std::cell::Cell;
use std::time::Instant;

use anyhow::Result;
use nalgebra::Vector3;
use num_dual::Dual64;
use rps3::dynamics::solver::{Settings, Solver};
use rps3::dynamics::{Inputs, NOMINAL, PlantModel, PlantParameters, PlantState, derivative};
use serde::Serialize;

use crate::crossing::{TICK, inputs, record};

pub type State = [f64; 12];

/// The plant between two changes of its inputs, counting how often it is asked.
pub struct Segment<'a> {
    model: &'a PlantModel<f64>,
    dual: &'a PlantModel<Dual64>,
    inputs: Inputs<f64>,
    pub duration: f64,
    evaluations: &'a Cell<u64>,
    jacobian_products: &'a Cell<u64>,
}

impl Segment<'_> {
    pub fn derivative(&self, x: &State) -> State {
        self.evaluations.set(self.evaluations.get() + 1);
        derivative(self.model, &PlantState::from(*x), &self.inputs).into()
    }

    /// Directional derivative of the right-hand side.
    pub fn along(&self, x: &State, direction: &State) -> State {
        self.jacobian_products.set(self.jacobian_products.get() + 1);
        let x = PlantState::from_fn(|i, _| Dual64::new(x[i], direction[i]));
        let u = Inputs {
            v_leg: self.inputs.v_leg.map(Dual64::from),
            v_rev: self.inputs.v_rev.map(Dual64::from),
            force: self.inputs.force.map(Dual64::from),
            moment: self.inputs.moment.map(Dual64::from),
        };
        derivative(self.dual, &x, &u).map(|value| value.eps).into()
    }
}

/// An integrator at a tolerance.
#[derive(Serialize)]
pub struct Row {
    problem: &'static str,
    /// Method and crate.
    integrator: &'static str,
    tolerance: f64,
    /// Largest error at the ends of segments, over the states' nominal magnitudes.
    error: f64,
    /// Right-hand sides a millisecond.
    evaluations: f64,
    /// Products of the Jacobian with a vector a millisecond (implicit methods).
    jacobian_products: f64,
    /// Of the fastest round, a millisecond of the plant.
    seconds: f64,
}

/// All integrators, interleaved, `rounds` times.
pub fn table(rounds: usize) -> Result<Vec<Row>> {
    let parameters = PlantParameters::default();
    let (model, dual) = (PlantModel::new(&parameters), PlantModel::new(&parameters.map(Dual64::from)));
    let (evaluations, jacobian_products) = (Cell::new(0), Cell::new(0));
    let segment = |inputs: Inputs<f64>, duration: f64| Segment {
        model: &model,
        dual: &dual,
        inputs,
        duration,
        evaluations: &evaluations,
        jacobian_products: &jacobian_products,
    };
    let records = record()?;
    let held: Vec<Segment> = records.iter().map(|record| segment(inputs(record), TICK)).collect();
    let push = Inputs { force: Vector3::new(20.0, -10.0, 15.0), ..inputs(&records[0]) };
    let smooth = vec![segment(push, 0.3)];
    let start: State = records[0].state.into();

    let mut rows: Vec<Row> = Vec::new();
    for (problem, segments) in [("held", held), ("smooth", smooth)] {
        let milliseconds = segments.iter().map(|segment| segment.duration).sum::<f64>() / 1e-3;
        let exact = reference(&segments, start)?;
        let first = rows.len();
        for round in 0..rounds {
            let mut place = first;
            for (integrator, solve) in integrators::ALL {
                for tolerance in [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9] {
                    evaluations.set(0);
                    jacobian_products.set(0);
                    let begin = Instant::now();
                    let found = solve(&segments, start, tolerance)?;
                    let seconds = begin.elapsed().as_secs_f64() / milliseconds;
                    if round == 0 {
                        rows.push(Row {
                            problem,
                            integrator,
                            tolerance,
                            error: largest_error(&found, &exact),
                            evaluations: evaluations.get() as f64 / milliseconds,
                            jacobian_products: jacobian_products.get() as f64 / milliseconds,
                            seconds,
                        });
                    } else {
                        rows[place].seconds = rows[place].seconds.min(seconds);
                    }
                    place += 1;
                }
            }
        }
    }
    Ok(rows)
}

/// States at the ends of all segments, to rounding.
fn reference(segments: &[Segment], start: State) -> Result<Vec<State>> {
    let settings = Settings { tolerance: 1e-13, nominal: NOMINAL, max_step: 2e-4 };
    let (mut x, mut solver) = (PlantState::from(start), Solver::default());
    let mut ends = Vec::new();
    for segment in segments {
        let f = |_: f64, x: &PlantState<f64>| segment.derivative(&(*x).into()).into();
        solver.integrate(f, &mut x, 0.0, segment.duration, &settings)?;
        ends.push(x.into());
    }
    Ok(ends)
}

fn largest_error(found: &[State], exact: &[State]) -> f64 {
    let mut largest: f64 = 0.0;
    for (found, exact) in found.iter().zip(exact) {
        for i in 0..12 {
            largest = largest.max((found[i] - exact[i]).abs() / NOMINAL[i].max(exact[i].abs()));
        }
    }
    largest
}
