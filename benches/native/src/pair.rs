//! Plant and controller together, the controller first at each tick, by ways of different length.

use std::time::Instant;

use anyhow::{Context, Result};
use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation as _, Common as _, InstanceCS};
use rps3::control::{Mode, Tuning};
use rps3::coupling::Experiment;
use rps3::fmi2::Model;
use rps3::models::{Controller, Plant, descriptions};
use serde_json::{Value, json};

use crate::crossing::TICK;
use crate::fmu::{Fmu, Instance, references};
use crate::seconds;

/// Seconds of each tick in process.
pub fn native(mode: i32, ticks: usize) -> Result<Vec<f64>> {
    let mode = [Mode::Rac, Mode::Drac, Mode::Hdrac, Mode::HdracMpso][usize::try_from(mode - 1)?];
    let experiment = Experiment {
        tuning: Tuning { mode, ..Tuning::default() },
        duration: ticks as f64 * TICK,
        // where the FMU's solver works by default
        tolerance: 1e-7,
        ..Experiment::default()
    };
    let (mut times, mut last) = (Vec::with_capacity(ticks), Instant::now());
    experiment.run(|_| {
        let now = Instant::now();
        times.push(now.duration_since(last).as_secs_f64());
        last = now;
    })?;
    Ok(times)
}

/// Variables that lead from one to the other: names and value references on both sides.
pub struct Wires {
    pub measured: [Vec<u32>; 2],
    pub voltages: [Vec<u32>; 2],
    pub mode: u32,
}

impl Wires {
    pub fn new() -> Result<Self> {
        use rps3::description::Causality::{Input, Output};
        let shared = |from: &rps3::description::Definition, to: &rps3::description::Definition| {
            let inputs: Vec<_> = to.variables.iter().filter(|v| v.causality == Input).map(|v| v.name.clone()).collect();
            let outputs = from.variables.iter().filter(|v| v.causality == Output).map(|v| v.name.clone());
            outputs.filter(|name| inputs.contains(name)).collect::<Vec<_>>()
        };
        let measured = shared(Plant::definition(), Controller::definition());
        let voltages = shared(Controller::definition(), Plant::definition());
        Ok(Self {
            measured: [references::<Plant>(&measured)?, references::<Controller>(&measured)?],
            voltages: [references::<Controller>(&voltages)?, references::<Plant>(&voltages)?],
            mode: references::<Controller>(&["control_mode".to_owned()])?[0],
        })
    }
}

/// Both instances, initialized with each other's values.
pub fn instances(plant: Fmu, controller: Fmu, wires: &Wires, mode: i32) -> Result<(Instance, Instance)> {
    let mut plant = plant.instantiate(descriptions::PLANT.guid)?;
    plant.initialize(1e-6)?;
    let mut controller = controller.instantiate(descriptions::CONTROLLER.guid)?;
    controller.set_integer(wires.mode, mode)?;
    let mut values = vec![0.0; wires.measured[0].len()];
    plant.get(&wires.measured[0], &mut values)?;
    controller.set(&wires.measured[1], &values)?;
    controller.initialize(1e-6)?;
    Ok((plant, controller))
}

/// Seconds of each tick through the shared libraries, and of which in the two `fmi2DoStep`.
pub fn libraries(plant: &str, controller: &str, mode: i32, ticks: usize) -> Result<Value> {
    let wires = Wires::new()?;
    let (mut p, mut c) = instances(Fmu::load(plant)?, Fmu::load(controller)?, &wires, mode)?;
    let mut measured = vec![0.0; wires.measured[0].len()];
    let mut voltages = vec![0.0; wires.voltages[0].len()];
    let (mut in_plant, mut in_controller) = (Vec::new(), Vec::new());
    let mut tick = |k: usize| -> Result<()> {
        let time = k as f64 * TICK;
        p.get(&wires.measured[0], &mut measured)?;
        c.set(&wires.measured[1], &measured)?;
        let mut result = Ok(());
        in_controller.push(seconds(|| result = c.step(time, TICK)));
        result?;
        c.get(&wires.voltages[0], &mut voltages)?;
        p.set(&wires.voltages[1], &voltages)?;
        let mut result = Ok(());
        in_plant.push(seconds(|| result = p.step(time, TICK)));
        result
    };
    let times = each(ticks, &mut tick)?;
    Ok(json!({ "seconds": times, "plant": in_plant, "controller": in_controller }))
}

/// Seconds of each tick through the crate `fmi` from the archives.
pub fn fmi_crate(plant: &str, controller: &str, mode: i32, ticks: usize) -> Result<Vec<f64>> {
    let wires = Wires::new()?;
    let open = |path: &str| fmi::import::from_path::<Fmi2Import>(path).with_context(|| path.to_owned());
    let (plant, controller) = (open(plant)?, open(controller)?);
    let mut p: InstanceCS = plant.instantiate_cs("plant", false, false)?;
    let mut c: InstanceCS = controller.instantiate_cs("controller", false, false)?;
    let mut measured = vec![0.0; wires.measured[0].len()];
    let mut voltages = vec![0.0; wires.voltages[0].len()];
    p.setup_experiment(Some(1e-6), 0.0, None)?;
    p.enter_initialization_mode()?;
    p.exit_initialization_mode()?;
    p.get_real(&wires.measured[0], &mut measured)?;
    c.set_integer(&[wires.mode], &[mode])?;
    c.setup_experiment(None, 0.0, None)?;
    c.enter_initialization_mode()?;
    c.set_real(&wires.measured[1], &measured)?;
    c.exit_initialization_mode()?;
    each(ticks, &mut |k| {
        let time = k as f64 * TICK;
        p.get_real(&wires.measured[0], &mut measured)?;
        c.set_real(&wires.measured[1], &measured)?;
        c.do_step(time, TICK, true)?;
        c.get_real(&wires.voltages[0], &mut voltages)?;
        p.set_real(&wires.voltages[1], &voltages)?;
        p.do_step(time, TICK, true)?;
        Ok(())
    })
}

/// Seconds of each call of `tick`.
fn each(ticks: usize, tick: &mut dyn FnMut(usize) -> Result<()>) -> Result<Vec<f64>> {
    let mut times = Vec::with_capacity(ticks);
    for k in 0..ticks {
        let mut outcome = Ok(());
        times.push(seconds(|| outcome = tick(k)));
        outcome?;
    }
    Ok(times)
}
