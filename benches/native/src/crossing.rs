//! The default crossing under HDRAC with fixed damping: states and voltages at every tick.

use nalgebra::Vector3;
use rps3::control::{Mode, Tuning};
use rps3::coupling::{Experiment, Record};
use rps3::dynamics::Inputs;

/// Duration of a tick, s.
pub const TICK: f64 = 1e-3;

/// Ticks of the recorded run.
const TICKS: usize = 1400;

/// The recorded run.
pub fn record() -> anyhow::Result<Vec<Record>> {
    let tuning = Tuning { mode: Mode::Hdrac, ..Tuning::default() };
    let mut records = Vec::new();
    Experiment { tuning, tolerance: 1e-10, duration: TICKS as f64 * TICK, ..Experiment::default() }
        .run(|record| records.push(*record))?;
    Ok(records)
}

/// The plant's inputs from a tick on.
pub fn inputs(record: &Record) -> Inputs<f64> {
    let v = &record.diagnostics.voltages;
    Inputs { v_leg: Vector3::new(v[0], v[1], v[2]), v_rev: Vector3::new(v[3], v[4], v[5]), ..Inputs::zero() }
}

/// The tick in force at a time, s; the last one's voltages stay.
pub fn tick_at(time: f64) -> usize {
    // the time of a communication point is rounded
    ((time / TICK + 1e-6) as usize).min(TICKS - 1)
}
