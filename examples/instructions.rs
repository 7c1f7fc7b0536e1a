//! The hot paths, each in a function of its own, for counting instructions:
//! `cargo xtask instructions` runs this under callgrind and compares with the recorded counts.

use std::hint::black_box;

use nalgebra::Vector3;
use rps3::control::{Controller, ControllerParameters, Diagnostics, Measurement, Mode, ReferencePoint, Tuning};
use rps3::coupling::{Experiment, Record, measure};
use rps3::dynamics::solver::{Settings, Solver};
use rps3::dynamics::{Inputs, NOMINAL, PlantModel, PlantParameters, PlantState, derivative};

/// Ticks of the default crossing on which each path is run, and where they begin.
const TICKS: usize = 100;
const FIRST: usize = 450;

#[inline(never)]
fn right_hand_side(model: &PlantModel<f64>, x: &PlantState<f64>, u: &Inputs<f64>) -> PlantState<f64> {
    derivative(model, x, u)
}

#[inline(never)]
fn plant_step(
    model: &PlantModel<f64>,
    solver: &mut Solver,
    x: &mut PlantState<f64>,
    u: &Inputs<f64>,
) -> Result<(), Box<dyn std::error::Error>> {
    let settings = Settings { tolerance: 1e-7, nominal: NOMINAL, max_step: f64::INFINITY };
    Ok(solver.integrate(|_, x| derivative(model, x, u), x, 0.0, 1e-3, &settings)?)
}

#[inline(never)]
fn controller_tick(
    controller: &mut Controller,
    t: f64,
    measured: &Measurement<f64>,
    tuning: &Tuning,
) -> Result<Diagnostics, Box<dyn std::error::Error>> {
    let zero = Vector3::zeros();
    let external = ReferencePoint { position: zero, rate: zero, acceleration: zero };
    Ok(controller.tick(t, measured, &external, tuning, true)?)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let plant = PlantParameters::default();
    let parameters = ControllerParameters::default();
    let tuning = Tuning { mode: Mode::HdracMpso, ..Tuning::default() };
    let experiment = Experiment {
        plant,
        controller: parameters,
        tuning,
        duration: 1e-3 * (FIRST + TICKS) as f64,
        tolerance: 1e-7,
        push: None,
        length_noise: 0.0,
        noise_seed: 1,
    };
    let mut records = Vec::new();
    experiment.run(|record| records.push(*record))?;
    let model = PlantModel::new(&plant);
    let mut controller = Controller::new(parameters)?;
    let mut solver = Solver::default();
    for Record { time, state, diagnostics } in &records[FIRST..] {
        let v = &diagnostics.voltages;
        let u =
            Inputs { v_leg: Vector3::new(v[0], v[1], v[2]), v_rev: Vector3::new(v[3], v[4], v[5]), ..Inputs::zero() };
        black_box(right_hand_side(black_box(&model), state, &u));
        plant_step(&model, &mut solver, &mut state.clone(), &u)?;
        let measured = measure(&model, state, &u);
        black_box(controller_tick(&mut controller, *time, &measured, &tuning)?);
    }
    println!("{TICKS} calls of each path");
    Ok(())
}
