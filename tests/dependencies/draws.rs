//! Where the points lie: around the defaults, wide enough that every equation and every limit has its say.

use rps3::description::{Kind, Variable};

use crate::probe::Dice;

/// The start of a Real.
fn start(variable: &Variable) -> f64 {
    match variable.kind {
        Kind::Real { start: Some(start), .. } => start,
        _ => 0.0,
    }
}

/// What both models have: the mechanism.
fn draw_mechanism(variable: &Variable, dice: &mut Dice) -> f64 {
    match variable.name.as_str() {
        "time" => dice.uniform(0.0, 1.0),
        "base_radius" | "joint_spacing" => start(variable) * dice.uniform(0.9, 1.1),
        // zero stands for the uniform disc; what is drawn here is some rigid body's
        "plate_ixx" if dice.chance(0.6) => dice.uniform(0.1, 0.2),
        "plate_izz" if dice.chance(0.6) => dice.uniform(0.01, 0.05),
        "plate_ixx" | "plate_izz" => 0.0,
        // around what holding the robot takes, so that the limit is met, or out of reach
        "v_max" if dice.chance(0.4) => dice.scale(0.2, 40.0),
        "v_max" => dice.scale(1e3, 1e4),
        _ if matches!(variable.kind, Kind::Boolean { .. }) => dice.whole(0, 1),
        _ => start(variable) * dice.scale(0.6, 1.6),
    }
}

/// A value for an input, a state or a parameter of the plant.
pub fn draw_plant(variable: &Variable, dice: &mut Dice) -> f64 {
    let name = variable.name.as_str();
    match name {
        "heave" | "heave_start" => dice.uniform(0.02, 0.09),
        "tilt_x" | "tilt_y" | "tilt_x_start" | "tilt_y_start" => dice.uniform(-0.25, 0.25),
        "heave_dot" | "tilt_x_dot" | "tilt_y_dot" => dice.uniform(-0.5, 0.5),
        // wide enough for all start poses: outside the limits there is none
        "d_min" => dice.uniform(0.01, 0.05),
        "d_max" => dice.uniform(0.6, 1.0),
        "theta_min" => dice.uniform(-1.5, -1.0),
        "theta_max" => dice.uniform(1.0, 1.5),
        "relative_tolerance" => dice.uniform(0.0, 0.1),
        _ if name.starts_with("v_leg") || name.starts_with("v_rev") => dice.uniform(-20.0, 20.0),
        _ if name.starts_with("f_ext") => dice.uniform(-50.0, 50.0),
        _ if name.starts_with("m_ext") => dice.uniform(-5.0, 5.0),
        _ if name.starts_with("i_") => dice.uniform(-2.0, 2.0),
        _ => draw_mechanism(variable, dice),
    }
}

/// A value for an input or a parameter of the controller.
pub fn draw_controller(variable: &Variable, dice: &mut Dice) -> f64 {
    let name = variable.name.as_str();
    if variable.may_be_missing {
        return draw_measurement(variable, dice);
    }
    let (point, coordinate) = name.split_once('_').unwrap_or(("", name));
    match name {
        "control_mode" => dice.whole(1, 4),
        "computation_delay" => dice.whole(0, 1),
        "reference_mode" | "profile" => dice.whole(1, 2),
        "swarm_size" => dice.whole(2, 8),
        "max_iterations" => dice.whole(1, 8),
        "stall_iterations" => dice.whole(1, 4),
        "seed" => dice.whole(0, 1000),
        "k_a" => dice.uniform(-0.3, 0.3),
        "velocity_limit" => dice.uniform(0.1, 1.0),
        "decay_min" => dice.uniform(0.0, 0.6),
        // wide, so that the search has something to find everywhere and its target is not the start
        "delta_hd_fixed" | "delta_hd_max" => dice.scale(0.05, 1.0),
        "horizon" => dice.scale(0.005, 0.5),
        "weight_velocity" | "weight_acceleration" => start(variable) * dice.scale(0.1, 1e3),
        "filter_time" | "sensor_scale" if dice.chance(0.5) => 0.0,
        "sensor_scale" => dice.uniform(0.3, 2.0),
        _ if name.ends_with("_ddot") => dice.uniform(-1.0, 1.0),
        _ if name.ends_with("_dot") => dice.uniform(-0.1, 0.1),
        _ if ["ref", "start", "via", "end"].contains(&point) => match coordinate {
            "heave" => dice.uniform(0.03, 0.08),
            _ => dice.uniform(-0.2, 0.2),
        },
        _ => draw_mechanism(variable, dice),
    }
}

/// A measurement, now and then a missing one.
fn draw_measurement(variable: &Variable, dice: &mut Dice) -> f64 {
    let name = variable.name.as_str();
    match name {
        _ if dice.chance(0.02) => f64::NAN,
        // some pose must fit them
        _ if name.len() == 2 && name.starts_with('d') => start(variable) + dice.uniform(-0.01, 0.01),
        _ if name.len() == 6 && name.starts_with("theta") => start(variable) + dice.uniform(-0.03, 0.03),
        _ if name.ends_with("_dot") => dice.uniform(-0.1, 0.1),
        _ => dice.uniform(-1.0, 1.0),
    }
}
