//! Inverse dynamics of the default crossing as CSV: torque, current and voltage of every motor,
//! with six motors and with three.
//!
//! `cargo xtask torque` runs this and draws the table.

use std::io::{BufWriter, Write};

use nalgebra::Vector3;
use rps3::defaults as d;
use rps3::dynamics::{Demand, Inputs, InverseDynamics, MechanismParameters, TrajectoryPoint};

/// Time step of the table, s.
const STEP: f64 = 1e-3;

/// The quintic from rest to rest along the straight line through the singular pose.
fn crossing(t: f64) -> TrajectoryPoint {
    let start = Vector3::new(d::START_HEAVE, d::START_TILT_X, d::START_TILT_Y);
    let end = Vector3::new(d::END_HEAVE, d::END_TILT_X, d::END_TILT_Y);
    let (path, tau) = (end - start, t / d::MOVE_TIME);
    let rate = |order: i32| d::MOVE_TIME.powi(-order);
    TrajectoryPoint {
        position: start + path * (tau.powi(3) * (10.0 - 15.0 * tau + 6.0 * tau * tau)),
        velocity: path * (30.0 * tau.powi(2) * (1.0 - tau).powi(2) * rate(1)),
        acceleration: path * (60.0 * tau * (1.0 - tau) * (1.0 - 2.0 * tau) * rate(2)),
        jerk: path * (60.0 * (1.0 - 6.0 * tau + 6.0 * tau * tau) * rate(3)),
    }
}

fn row(out: &mut impl Write, t: f64, motors: usize, demand: &Demand) -> std::io::Result<()> {
    write!(out, "{t:.3},{motors}")?;
    for drive in [&demand.leg, &demand.revolute] {
        for values in [&drive.torque, &drive.current, &drive.voltage] {
            write!(out, ",{:.9},{:.9},{:.9}", values.x, values.y, values.z)?;
        }
    }
    writeln!(out, ",{:.6e},{:.6e}", demand.condition, demand.joint_forces.condition)
}

fn main() -> std::io::Result<()> {
    let mut out = BufWriter::new(std::io::stdout().lock());
    write!(out, "time_s,motors")?;
    for drive in ["leg", "rev"] {
        for quantity in ["torque_Nm", "current_A", "voltage_V"] {
            for i in 1..=3 {
                write!(out, ",{drive}{i}_{quantity}")?;
            }
        }
    }
    writeln!(out, ",condition_motors,condition_joints")?;
    for revolute_motors in [true, false] {
        let inverse = InverseDynamics::new(&MechanismParameters { revolute_motors, ..MechanismParameters::default() });
        for k in 0..=(d::MOVE_TIME / STEP).round() as usize {
            let t = k as f64 * STEP;
            let demand = inverse.demand(&crossing(t), &Inputs::zero());
            row(&mut out, t, if revolute_motors { 6 } else { 3 }, &demand)?;
        }
    }
    out.flush()
}
