//! What the calls of an FMU cost.

use anyhow::Result;
use rps3::models::{Plant, descriptions};
use serde_json::{Value, json};

use crate::crossing::{TICK, record, tick_at};
use crate::fmu::{Fmu, references};
use crate::seconds;

/// Calls that are timed together, so that the clock's resolution does not matter.
const BATCH: usize = 1000;

/// Seconds a call: the fastest of `rounds` batches each.
pub fn calls(library: &str, guid: &str, get: &[u32], set: &[u32], step: f64, rounds: usize) -> Result<Value> {
    let mut instance = Fmu::load(library)?.instantiate(guid)?;
    instance.initialize(1e-6)?;
    let mut values = vec![0.0; get.len()];
    let mut inputs = vec![0.0; set.len()];
    instance.get(set, &mut inputs)?;
    let (mut best, mut time) = ([f64::INFINITY; 3], 0.0);
    for _ in 0..rounds {
        let mut outcome = Ok(());
        let mut timed = |place: usize, call: &mut dyn FnMut() -> Result<()>| {
            let elapsed = seconds(|| {
                for _ in 0..BATCH {
                    if let Err(error) = call() {
                        outcome = Err(error);
                    }
                }
            });
            best[place] = best[place].min(elapsed / BATCH as f64);
        };
        timed(0, &mut || instance.set(set, &inputs));
        timed(1, &mut || {
            instance.step(time, step)?;
            time += step;
            Ok(())
        });
        timed(2, &mut || instance.get(get, &mut values));
        outcome?;
    }
    Ok(json!({ "set": best[0], "step": best[1], "get": best[2] }))
}

/// Seconds of each `fmi2DoStep` of the plant along the crossing.
pub fn plant_step(library: &str, step: f64, tolerance: f64) -> Result<Vec<f64>> {
    let names = ["v_leg1", "v_leg2", "v_leg3", "v_rev1", "v_rev2", "v_rev3"].map(String::from);
    let voltages = references::<Plant>(&names)?;
    let records = record()?;
    let steps = (records.len() as f64 * TICK / step).floor() as usize;
    let mut plant = Fmu::load(library)?.instantiate(descriptions::PLANT.guid)?;
    plant.initialize(tolerance)?;
    let mut times = Vec::with_capacity(steps);
    for k in 0..steps {
        let from = k as f64 * step;
        plant.set(&voltages, records[tick_at(from)].diagnostics.voltages.as_slice())?;
        let mut outcome = Ok(());
        times.push(seconds(|| outcome = plant.step(from, step)));
        outcome?;
    }
    Ok(times)
}
