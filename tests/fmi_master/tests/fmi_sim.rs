//! Each FMU alone in fmi-sim, fed from a file with what the other one says in the native coupling.

use std::fmt::Write as _;

use anyhow::{Context, Result, ensure};
use arrow::array::{AsArray, RecordBatch};
use arrow::datatypes::Float64Type;
use fmi_master::pair::STEPS;
use fmi_master::record::passed;
use fmi_master::side::{MEASURED, STATES, VOLTAGES, archive};
use fmi_sim::options::{CoSimulationOptions, CommonOptions, FmiSimOptions, Interface, ModelExchangeOptions};
use rps3::defaults::STEP_SIZE as STEP;
use rps3::study::{Sample, trajectory};

const MASTER: &str = "fmi-sim";

/// fmi-sim's version: the crate itself does not tell.
fn version() -> Result<&'static str> {
    let lock = include_str!("../Cargo.lock");
    let entry = lock.split("name = \"fmi-sim\"\nversion = \"").nth(1).context("fmi-sim is not in Cargo.lock")?;
    entry.split('"').next().context("no version")
}

/// A signal as fmi-sim reads it: time (s) and values.
type Rows = Vec<(f64, Vec<f64>)>;

/// Values that fmi-sim finds at each tick to the last bit: it interpolates from the row before, which is the same.
fn at_ticks(samples: &[Sample], values: impl Fn(&Sample) -> Vec<f64>) -> Rows {
    let row = |(k, sample)| {
        let time = k as f64 * STEP;
        [(time - STEP / 2.0, values(sample)), (time, values(sample))]
    };
    samples.iter().enumerate().flat_map(row).skip(1).collect()
}

/// Values that jump at each tick and hold from there on.
fn held(samples: &[Sample], values: impl Fn(&Sample) -> Vec<f64>) -> Rows {
    let jump = |(k, pair): (usize, &[Sample])| {
        let time = (k + 1) as f64 * STEP;
        [(time, values(&pair[0])), (time, values(&pair[1]))]
    };
    let jumps = samples.windows(2).enumerate().flat_map(jump);
    std::iter::once((0.0, values(&samples[0]))).chain(jumps).collect()
}

/// Runs `model` until `stop` (s) and returns the recorded outputs.
fn simulate(model: &str, interface: Interface, names: &[&str], rows: &Rows) -> Result<RecordBatch> {
    let directory = tempfile::tempdir()?;
    let input_file = directory.path().join("inputs.csv");
    let mut text = format!("time,{}\n", names.join(","));
    for (time, values) in rows {
        write!(text, "{time:?}")?;
        values.iter().try_for_each(|value| write!(text, ",{value:?}"))?;
        text.push('\n');
    }
    std::fs::write(&input_file, text)?;
    let options =
        FmiSimOptions { interface, model: archive(model), input_file: Some(input_file), ..FmiSimOptions::default() };
    Ok(fmi_sim::simulate(&options)?.0)
}

fn common(stop: f64, interval: f64) -> CommonOptions {
    CommonOptions { stop_time: Some(stop), output_interval: Some(interval), ..CommonOptions::default() }
}

fn co_simulation() -> Interface {
    let common = common(STEPS as f64 * STEP, STEP);
    Interface::CoSimulation(CoSimulationOptions { common, ..CoSimulationOptions::default() })
}

fn model_exchange(stop: f64, interval: f64) -> Interface {
    Interface::ModelExchange(ModelExchangeOptions { common: common(stop, interval), ..ModelExchangeOptions::default() })
}

/// Columns by name, as rows.
fn table<const N: usize>(batch: &RecordBatch, names: [&str; N]) -> Result<Vec<[f64; N]>> {
    let mut rows = vec![[f64::NAN; N]; batch.num_rows()];
    for (k, name) in names.into_iter().enumerate() {
        let column = batch.column_by_name(name).with_context(|| format!("no output {name}"))?;
        let values = column.as_primitive_opt::<Float64Type>().with_context(|| format!("{name} is no Real"))?;
        rows.iter_mut().zip(values.values()).for_each(|(row, value)| row[k] = *value);
    }
    Ok(rows)
}

#[test]
fn the_plant_in_co_simulation_makes_the_native_trajectory_of_the_native_voltages_to_the_last_bit() -> Result<()> {
    let native = trajectory()?;
    let rows = at_ticks(&native, |sample| sample.voltages.to_vec());
    let states = table(&simulate("Rps3Plant", co_simulation(), &VOLTAGES, &rows)?, STATES)?;
    ensure!(states.len() == STEPS + 1);
    for (k, (state, sample)) in states.iter().zip(&native).enumerate() {
        assert_eq!(state, &sample.state, "at tick {k}");
    }
    passed(MASTER, version()?, "CS", 0.0, 0.0)
}

#[test]
fn the_controller_in_co_simulation_says_the_native_voltages_to_the_last_bit() -> Result<()> {
    let native = trajectory()?;
    let rows = at_ticks(&native, |sample| sample.measured.to_vec());
    let voltages = table(&simulate("Rps3Controller", co_simulation(), &MEASURED, &rows)?, VOLTAGES)?;
    ensure!(voltages.len() == STEPS + 1);
    // what is recorded at a tick was said at the one before
    for (k, (voltages, sample)) in voltages[1..].iter().zip(&native).enumerate() {
        assert_eq!(voltages, &sample.voltages, "of tick {k}");
    }
    Ok(())
}

#[test]
fn the_controller_in_model_exchange_says_the_native_voltages_at_its_time_events() -> Result<()> {
    let native = trajectory()?;
    let rows = at_ticks(&native, |sample| sample.measured.to_vec());
    let batch = simulate("Rps3Controller", model_exchange(STEPS as f64 * STEP, STEP), &MEASURED, &rows)?;
    let (times, voltages) = (table(&batch, ["time"])?, table(&batch, VOLTAGES)?);
    for (k, sample) in native.iter().enumerate().take(STEPS) {
        // the last record of a time is the one after its event
        let last = times.iter().rposition(|[time]| *time == k as f64 * STEP).with_context(|| format!("no tick {k}"))?;
        assert_eq!(voltages[last], sample.voltages, "of tick {k}");
    }
    passed(MASTER, version()?, "ME, time events", 0.0, 0.0)
}

#[test]
fn the_plant_in_model_exchange_converges_to_the_native_trajectory_with_eulers_order_one() -> Result<()> {
    const TICKS: usize = 100;
    let native = trajectory()?;
    let rows = held(&native[..=TICKS + 1], |sample| sample.voltages.to_vec());
    let stop = TICKS as f64 * STEP;
    let error = |interval: f64| -> Result<f64> {
        let states = table(&simulate("Rps3Plant", model_exchange(stop, interval), &VOLTAGES, &rows)?, STATES)?;
        Ok((states.last().context("no records")?[0] - native[TICKS].state[0]).abs())
    };
    let (coarse, fine) = (error(1e-4)?, error(5e-5)?);
    ensure!((1.8..2.2).contains(&(coarse / fine)), "{coarse:e} m and {fine:e} m");
    // half a step of what accelerates to 0.1 m/s within 0.1 s, added up over that time
    const BOUND: f64 = 0.5 * 5e-5 * 1.0 * 0.1;
    ensure!(fine < BOUND, "{fine:e} m");
    passed(MASTER, version()?, "ME, Euler", fine, BOUND)
}
