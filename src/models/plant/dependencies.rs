//! What each output and derivative of Rps3Plant depends on (section 2.2.8); a test moves every known and looks.

use super::table::state_names;
use crate::models::common_table::{coordinates, per_limb};

/// Knowns (inputs and states) of an output or derivative at a communication point or event.
pub fn dependencies(name: &str) -> Vec<String> {
    let pose = coordinates("").to_vec();
    let rates = coordinates("_dot").to_vec();
    let currents = [per_limb("i_leg", ""), per_limb("i_rev", "")].concat();
    let loads: Vec<String> =
        ["f_ext_x", "f_ext_y", "f_ext_z", "m_ext_x", "m_ext_y", "m_ext_z"].map(String::from).to_vec();
    let limb = |prefix: &str| name.strip_prefix(prefix).and_then(|rest| rest.chars().next());
    if state_names().iter().any(|s| s == name) {
        return vec![name.to_owned()];
    }
    if name.ends_with("_ddot") || name.starts_with("a_") || name.starts_with("f_") {
        return [loads, pose, rates, currents].concat();
    }
    for motor in ["leg", "rev"] {
        if name.starts_with(&format!("i_{motor}")) {
            let i = limb(&format!("i_{motor}")).unwrap_or('1');
            return [vec![format!("v_{motor}{i}")], pose, rates, vec![format!("i_{motor}{i}")]].concat();
        }
    }
    match name {
        "power_electric" => {
            let voltages = [per_limb("v_leg", ""), per_limb("v_rev", "")].concat();
            [voltages, currents].concat()
        }
        "energy" => [pose, rates, currents].concat(),
        "p_z" => vec!["heave".into()],
        "v_z" => vec!["heave_dot".into()],
        "p_x" | "p_y" | "q_w" | "q_x" | "q_y" => pose[1..].to_vec(),
        "q_z" => vec![],
        "v_x" | "v_y" => [&pose[1..], &rates[1..]].concat(),
        "w_x" | "w_y" | "w_z" => [&pose[1..], &rates[1..]].concat(),
        "sigma_min" | "det_a" => pose,
        _ if name.ends_with("_dot") => [pose, rates].concat(),
        _ => pose,
    }
}

/// Knowns (inputs and parameters) of an unknown in Initialization Mode.
pub fn initial_dependencies(name: &str, exact: &[String]) -> Vec<String> {
    let geometry = ["base_radius", "joint_spacing"].map(String::from).to_vec();
    let start = coordinates("_start").to_vec();
    let own = |suffix: &str| vec![format!("{name}{suffix}")];
    match name {
        "heave" | "tilt_x" | "tilt_y" => own("_start"),
        "p_z" => vec!["heave_start".into()],
        "q_w" | "q_x" | "q_y" => start[1..].to_vec(),
        "p_x" | "p_y" => [vec!["joint_spacing".into()], start[1..].to_vec()].concat(),
        // the plant starts at rest; q_z is zero for want of torsion
        "q_z" | "v_x" | "v_y" | "v_z" | "w_x" | "w_y" | "w_z" => vec![],
        _ if name.ends_with("_dot") && !name.starts_with("i_") => vec![],
        "sigma_min" | "det_a" => [geometry, start].concat(),
        _ if name.starts_with('d') || name.starts_with("theta") => [geometry, start].concat(),
        _ => exact.iter().filter(|known| !is_foreign(name, known)).cloned().collect(),
    }
}

/// Whether a current, its rate, an acceleration, force, power or energy does not depend on a known at the start: at rest
/// between the end stops, with the currents that hold the pose, if there are such.
fn is_foreign(name: &str, known: &str) -> bool {
    let motor = name.strip_prefix("i_");
    let static_alone = motor.is_some() || ["power_electric", "energy"].contains(&name);
    match known {
        "relative_tolerance" | "max_step" | "motor_bm" => true,
        "d_min" | "d_max" | "theta_min" | "theta_max" | "stop_stiffness" | "stop_damping" => true,
        // inertia
        "plate_radius" | "plate_ixx" | "plate_izz" | "lower_inertia" | "upper_inertia" | "motor_jm" => static_alone,
        // magnetic energy, and the circuit's equation
        "motor_la" => name != "energy" && !motor.is_some_and(|motor| motor.ends_with("_dot")),
        // inputs alone have names that begin so, but for the limit
        _ if known.starts_with("v_") && known != "v_max" => {
            name != "power_electric" && motor.and_then(|motor| motor.strip_suffix("_dot")) != Some(&known[2..])
        }
        _ => false,
    }
}
