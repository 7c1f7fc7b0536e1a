//! Runs tasks of the study with what one would otherwise pick, coupled in process, and prints their figures
//! as JSON. `cargo xtask demo` hands it the tasks and takes the figures into the report:
//!
//! ```sh
//! python -m rps3_study.baselines | cargo run --release --example baselines
//! ```
//!
//! DRAC is among them: what the packaged FMUs make of it in FMPy has to be the same.

use std::io;

use nalgebra::Vector3;
use rps3::control::{ControllerParameters, Profile};
use rps3::coupling::{Experiment, Push};
use rps3::dynamics::PlantParameters;
use rps3::study::{BASELINES, MODES, Scheme};
use serde::{Deserialize, Serialize};

#[derive(Deserialize)]
struct Task {
    key: String,
    /// As the controller's parameter of that name.
    profile: i32,
    waypoints: [[f64; 3]; 3],
    push: Option<Load>,
}

#[derive(Deserialize)]
struct Load {
    span: (f64, f64),
    force: [f64; 3],
    moment: [f64; 3],
}

/// One run; errors in mm, SI units otherwise.
#[derive(Serialize)]
struct Row<'a> {
    task: &'a str,
    revolute_motors: bool,
    scheme: &'a str,
    peak_error: f64,
    rms_error: f64,
    peak_voltage: f64,
    saturation_time: f64,
    end_stop: bool,
    failure: Option<String>,
}

impl Task {
    fn experiment(&self, revolute_motors: bool) -> Experiment {
        let profile = if self.profile == 1 { Profile::ConstantSpeed } else { Profile::Quintic };
        let mut plant = PlantParameters { start: self.waypoints[0], ..PlantParameters::default() };
        let mut controller =
            ControllerParameters { waypoints: self.waypoints, profile, ..ControllerParameters::default() };
        plant.mechanism.revolute_motors = revolute_motors;
        controller.mechanism.revolute_motors = revolute_motors;
        let push = self.push.as_ref().map(|load| Push {
            span: load.span,
            force: Vector3::from(load.force),
            moment: Vector3::from(load.moment),
        });
        Experiment { plant, controller, push, ..Experiment::default() }
    }

    fn row(&self, revolute_motors: bool, scheme: &'static Scheme) -> Row<'_> {
        let figures = scheme.figures(&self.experiment(revolute_motors));
        Row {
            task: &self.key,
            revolute_motors,
            scheme: scheme.name,
            peak_error: 1e3 * figures.peak,
            rms_error: 1e3 * figures.rms,
            peak_voltage: figures.voltage,
            saturation_time: figures.saturation,
            end_stop: figures.end_stop,
            failure: figures.failure.map(|error| error.to_string()),
        }
    }
}

fn main() -> Result<(), serde_json::Error> {
    let tasks: Vec<Task> = serde_json::from_reader(io::stdin())?;
    let drac = &MODES[1];
    let mut rows = Vec::new();
    for task in &tasks {
        for revolute_motors in [true, false] {
            rows.extend([drac].into_iter().chain(&BASELINES).map(|scheme| task.row(revolute_motors, scheme)));
        }
    }
    serde_json::to_writer_pretty(io::stdout(), &rows)
}
