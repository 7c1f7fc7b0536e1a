//! Both FMUs in a master built on the `fmi` crate.

use anyhow::{Result, ensure};
use fmi_master::pair::{Exchange, Pair, STEPS, model_exchange};
use fmi_master::record::passed;
use rps3::study::{Sample, trajectory};

const MASTER: &str = "fmi crate";
const VERSION: &str = fmi::built_info::PKG_VERSION;

/// Both trajectories to the last bit of plant, measurements, voltages and reference.
fn assert_identical(run: &[Sample], native: &[Sample]) {
    for (k, (run, native)) in run.iter().zip(native).enumerate() {
        assert_eq!(run, native, "at tick {k}");
    }
}

/// Largest distance in heave, m.
fn distance(run: &[Sample], native: &[Sample]) -> f64 {
    run.iter().zip(native).map(|(a, b)| (a.state[0] - b.state[0]).abs()).fold(0.0, f64::max)
}

#[test]
fn co_simulation_with_the_controller_first_is_the_native_coupling_to_the_last_bit() -> Result<()> {
    let run = Pair::new(0)?.run(0..STEPS, Exchange::GaussSeidel)?;
    assert_identical(&run, &trajectory()?);
    passed(MASTER, VERSION, "CS pair, controller first", 0.0, 0.0)
}

#[test]
fn model_exchange_with_the_same_solver_is_the_native_coupling_to_the_last_bit() -> Result<()> {
    assert_identical(&model_exchange()?, &trajectory()?);
    passed(MASTER, VERSION, "ME pair, the core's solver", 0.0, 0.0)
}

#[test]
fn a_state_serialized_half_way_continues_the_native_trajectory_in_another_pair() -> Result<()> {
    let native = trajectory()?;
    let mut first = Pair::new(0)?;
    first.run(0..STEPS / 2, Exchange::GaussSeidel)?;
    let mut second = Pair::new(0)?;
    second.restore(&first.save()?)?;
    assert_identical(&second.run(STEPS / 2..STEPS, Exchange::GaussSeidel)?, &native[STEPS / 2..]);
    passed(MASTER, VERSION, "FMU state, serialized", 0.0, 0.0)
}

#[test]
fn computation_delay_makes_good_for_the_sample_that_a_jacobi_exchange_costs() -> Result<()> {
    // Voltages come one sample late, in which heave moves by 0.1 mm at most.
    const LATE: f64 = 1e-4;
    // A controller that knows of the delay predicts the state with a tolerance of 1e-7; the rest is as without delay.
    const PREDICTED: f64 = 1e-6;
    let native = trajectory()?;
    let distance = |delay: i32| Ok(distance(&Pair::new(delay)?.run(0..STEPS, Exchange::Jacobi)?, &native));
    let distances: Result<Vec<f64>> = [0, 1].into_iter().map(distance).collect();
    let [ignored, planned] = distances?[..] else { unreachable!("two delays") };
    println!("off by {ignored:e} m without computation_delay, by {planned:e} m with it");
    ensure!(ignored < LATE && planned < PREDICTED);
    ensure!(planned < 0.01 * ignored);
    passed(MASTER, VERSION, "CS pair, Jacobi", ignored, LATE)?;
    passed(MASTER, VERSION, "CS pair, Jacobi, computation_delay = 1", planned, PREDICTED)
}
