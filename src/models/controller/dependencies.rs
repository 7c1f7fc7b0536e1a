//! What each output of Rps3Controller depends on (section 2.2.8); a test moves every known and looks.

use crate::models::common_table::{coordinates, per_limb};

/// What a tick's measurement consists of, and the external reference; each list in the order of the inputs.
struct Inputs {
    positions: Vec<String>,
    rates: Vec<String>,
    currents: Vec<String>,
    accelerations: Vec<String>,
    reference: [String; 3],
}

impl Inputs {
    fn new() -> Self {
        Self {
            positions: [per_limb("d", ""), per_limb("theta", "")].concat(),
            rates: [per_limb("d", "_dot"), per_limb("theta", "_dot")].concat(),
            currents: [per_limb("i_leg", ""), per_limb("i_rev", "")].concat(),
            accelerations: ["a_x", "a_y", "a_z"].map(String::from).to_vec(),
            reference: coordinates("").map(|name| format!("ref_{name}")),
        }
    }

    fn measurements(&self) -> Vec<String> {
        [&self.positions[..], &self.rates, &self.currents, &self.accelerations].concat()
    }
}

/// Knowns (inputs and time) of an output at a tick.
pub fn dependencies(name: &str, all: &[String]) -> Vec<String> {
    let inputs = Inputs::new();
    // the filter of the estimate trusts rates
    let estimate = [&inputs.positions[..], &inputs.rates].concat();
    // the internal reference runs with time
    let time = ["time".to_owned()];
    match name {
        "heave_est" | "tilt_x_est" | "tilt_y_est" => estimate,
        // with a computation delay it is that of the predicted pose
        "sigma_min" | "in_singular_region" => [estimate, inputs.currents].concat(),
        "heave_ref" => [&time[..], &inputs.reference[..1]].concat(),
        "tilt_x_ref" => [&time[..], &inputs.reference[1..2]].concat(),
        "tilt_y_ref" => [&time[..], &inputs.reference[2..]].concat(),
        "err_position" => [&time[..], &estimate, &inputs.reference].concat(),
        "err_rotation" => [&time[..], &estimate, &inputs.reference[1..]].concat(),
        "sensor_fault" => inputs.measurements(),
        // three motors have it, and no currents of others
        "lambda_f" => all.iter().filter(|known| !known.starts_with("i_rev")).cloned().collect(),
        _ => all.to_vec(),
    }
}

/// Knowns (inputs and parameters) of an output in Initialization Mode, when it is that of the first tick: without
/// computation delay, and before filters and time-outs have anything to remember.
pub fn initial_dependencies(name: &str, all: &[String]) -> Vec<String> {
    let inputs = Inputs::new();
    let starts = coordinates("").map(|name| format!("start_{name}"));
    let strings = |names: &[&str]| -> Vec<String> { names.iter().map(|name| (*name).to_owned()).collect() };
    let sensors = all.iter().filter(|known| known.starts_with("sensor_") && *known != "sensor_timeout").cloned();
    // the start is where the fit of the pose begins
    let estimate = [
        inputs.positions.clone(),
        strings(&["base_radius", "joint_spacing", "seed"]),
        sensors.collect(),
        starts.to_vec(),
    ]
    .concat();
    let mode = strings(&["reference_mode"]);
    let reference = |coordinate: usize| {
        [mode.clone(), vec![inputs.reference[coordinate].clone(), starts[coordinate].clone()]].concat()
    };
    match name {
        "heave_est" | "tilt_x_est" | "tilt_y_est" | "sigma_min" => estimate,
        "heave_ref" => reference(0),
        "tilt_x_ref" => reference(1),
        "tilt_y_ref" => reference(2),
        "in_singular_region" => [estimate, strings(&["delta_hd_fixed"])].concat(),
        "err_position" => [estimate, mode, inputs.reference.to_vec()].concat(),
        "err_rotation" => [estimate, mode, inputs.reference[1..].to_vec()].concat(),
        "sensor_fault" => inputs.measurements(),
        _ => all.iter().filter(|known| !is_foreign(name, known)).cloned().collect(),
    }
}

/// Whether an output of control law or search does not depend on a known at the first tick.
fn is_foreign(name: &str, known: &str) -> bool {
    let voltage = name.strip_prefix("v_");
    let electric = voltage.is_some() || name == "saturated";
    match known {
        "computation_delay" | "filter_time" | "sensor_timeout" => true,
        "motor_la" => !electric,
        "rho_fixed" => !(electric || ["rho", "lyapunov", "lyapunov_dot"].contains(&name)),
        "delta_hd_fixed" => !(electric || ["delta_hd", "rho_hd", "lyapunov_dot"].contains(&name)),
        // three motors alone damp their force distribution
        "lambda_f_fixed" => !(name.starts_with("v_leg") || ["lambda_f", "saturated"].contains(&name)),
        "lambda_f_max" => name.starts_with("v_rev"),
        _ => match known.strip_prefix("i_") {
            // each motor's own current; of the inputs alone do names begin so
            Some(motor) => voltage.map_or(name != "saturated", |of| of != motor),
            None => false,
        },
    }
}
