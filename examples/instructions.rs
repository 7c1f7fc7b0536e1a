//! The hot paths, each in a function of its own, for counting instructions:
//! `cargo xtask instructions` runs this under callgrind and compares with the recorded counts.

#[path = "../tests/common/mod.rs"]
mod common;

use std::hint::black_box;

use common::Slave;
use nalgebra::Vector3;
use rps3::control::{Controller, ControllerParameters, Diagnostics, Measurement, Mode, ReferencePoint, Tuning};
use rps3::coupling::{Experiment, Record, measure};
use rps3::description::Causality;
use rps3::dynamics::solver::{Settings, Solver};
use rps3::dynamics::{Inputs, NOMINAL, PlantModel, PlantParameters, PlantState, derivative};
use rps3::fmi2::types::{Status, ValueReference};
use rps3::models;

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
    let external = ReferencePoint::default();
    Ok(controller.tick(t, measured, &external, tuning, true)?)
}

#[inline(never)]
fn fmi_outputs(plant: &Slave<models::Plant>, references: &[ValueReference], values: &mut [f64]) -> Status {
    plant.read_references(references, values)
}

#[inline(never)]
fn fmi_inputs(controller: &Slave<models::Controller>, references: &[ValueReference], values: &[f64]) -> Status {
    controller.set_references(references, values)
}

#[inline(never)]
fn fmi_empty_step(controller: &Slave<models::Controller>, point: f64, size: f64) -> Status {
    controller.step(point, size)
}

/// The calls of the FMI layer with as little of the models in them as can be.
fn fmi_calls() {
    let (plant, controller) = (Slave::<models::Plant>::new(), Slave::<models::Controller>::new());
    plant.initialize();
    controller.initialize();
    let outputs = Slave::<models::Plant>::references(Causality::Output);
    let inputs = Slave::<models::Controller>::references(Causality::Input);
    let (mut read, written) = (vec![0.0; outputs.len()], controller.get_references(&inputs));
    // with the first tick past, so that none falls into the steps
    let (start, size) = (0.5 * rps3::defaults::SAMPLE_TIME, 1e-9);
    assert_eq!(controller.step(0.0, start), Status::Ok);
    let mut time = start;
    for _ in 0..TICKS {
        assert_eq!(fmi_outputs(&plant, &outputs, &mut read), Status::Ok);
        assert_eq!(fmi_inputs(&controller, &inputs, &written), Status::Ok);
        assert_eq!(fmi_empty_step(&controller, time, size), Status::Ok);
        time += size;
    }
    black_box(read);
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
    fmi_calls();
    println!("{TICKS} calls of each path");
    Ok(())
}
