//! A controller tick in mode 4 near the singularity, and where its time goes.

use std::hint::black_box;

use anyhow::Result;
use rps3::control::{
    Controller, ControllerParameters, Estimator, Fitness, ForceDistribution, Mode, Reference, ReferencePoint,
    SingularBasis, Situation, Tuning,
};
use rps3::coupling::{Record, measure};
use rps3::dynamics::{PlantModel, PlantParameters};
use serde_json::{Value, json};

use crate::crossing::{inputs, record};
use crate::searches::{Budget, Optimizer, search};
use crate::timed;

/// Ticks of the recorded run that are measured.
const TICKS: std::ops::Range<usize> = 450..550;

/// Seconds of each of a hundred ticks.
pub fn ticks(swarm_size: usize, iterations: usize) -> Result<Vec<f64>> {
    let mut parameters = ControllerParameters::default();
    parameters.swarm.settings.swarm_size = swarm_size;
    parameters.swarm.settings.max_iterations = iterations;
    parameters.swarm.settings.stall_iterations = iterations;
    Ok(measured_ticks(&record()?[TICKS], parameters)?.0)
}

/// Seconds of each tick, and iterations of each search.
fn measured_ticks(records: &[Record], parameters: ControllerParameters) -> Result<(Vec<f64>, Vec<usize>)> {
    let model = PlantModel::new(&plant(&parameters));
    let tuning = Tuning { mode: Mode::HdracMpso, ..Tuning::default() };
    let external = ReferencePoint::default();
    let mut controller = Controller::new(parameters)?;
    let (mut times, mut iterations) = (Vec::new(), Vec::new());
    for record in records {
        let measured = measure(&model, &record.state, &inputs(record));
        let (time, diagnostics) = timed(|| controller.tick(record.time, &measured, &external, &tuning, true));
        times.push(time);
        iterations.push(diagnostics?.iterations);
    }
    Ok((times, iterations))
}

fn plant(parameters: &ControllerParameters) -> PlantParameters {
    PlantParameters { mechanism: parameters.mechanism, ..PlantParameters::default() }
}

/// Seconds a tick of each part, the mean over a hundred ticks with the default swarm.
pub fn parts(revolute_motors: bool) -> Result<Value> {
    let records = &record()?[TICKS];
    let mut parameters = ControllerParameters::default();
    parameters.mechanism.revolute_motors = revolute_motors;
    let (times, iterations) = measured_ticks(records, parameters)?;
    let size = parameters.swarm.settings.swarm_size;
    let mut parts = Parts::default();
    let mut estimator = Estimator::of(&parameters);
    for (record, iterations) in records.iter().zip(iterations) {
        parts.add(record, &parameters, &mut estimator, size * (1 + iterations));
        // on next to nothing, which leaves moves and ranks
        let budget = Budget { swarm_size: size, iterations };
        parts.moves += search(Optimizer::Mpso, if revolute_motors { 2 } else { 3 }, budget, 1)?;
    }
    let mean = |sum: f64| sum / records.len() as f64;
    Ok(json!({
        "whole": mean(times.iter().sum()),
        "estimate": mean(parts.estimate),
        "situation": mean(parts.situation),
        "bases": mean(parts.bases),
        "once": mean(parts.once),
        "evaluations": mean(parts.evaluations),
        "moves": mean(parts.moves),
    }))
}

/// Sums of seconds.
#[derive(Default)]
struct Parts {
    estimate: f64,
    situation: f64,
    bases: f64,
    once: f64,
    evaluations: f64,
    moves: f64,
}

impl Parts {
    fn add(&mut self, record: &Record, parameters: &ControllerParameters, estimator: &mut Estimator, count: usize) {
        let model = PlantModel::without_stops(&parameters.mechanism);
        let tuning = Tuning { mode: Mode::HdracMpso, ..Tuning::default() };
        let measured = measure(&PlantModel::new(&plant(parameters)), &record.state, &inputs(record));
        let reference = Reference::of(parameters);
        let (now, ahead) = (reference.at(record.time), reference.at(record.time + tuning.horizon));
        let (time, estimate) = timed(|| estimator.update(&model.geometry, &measured));
        self.estimate += time;
        let (time, situation) = timed(|| Situation::new(&model, &estimate, &now, &measured, &tuning.gains));
        self.situation += time;
        let (time, (basis, distribution)) =
            timed(|| (SingularBasis::new(&situation), ForceDistribution::new(&model, &situation)));
        self.bases += time;
        let sample_time = parameters.sample_time;
        let (time, fitness) =
            timed(|| Fitness::new(&model, &situation, &basis, &distribution, &ahead, &tuning, sample_time));
        self.once += time;
        let (largest, rho_hd) = (parameters.swarm.largest, fitness.rho_hd(&parameters.swarm.largest));
        let (time, ()) = timed(|| {
            for k in 0..count {
                let share = k as f64 / count as f64;
                black_box(fitness.of_factors(largest.rho * share, rho_hd * share, largest.lambda_f * share));
            }
        });
        self.evaluations += time;
    }
}
