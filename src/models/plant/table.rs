//! Variable table of Rps3Plant.

use std::f64::consts::PI;

use super::dependencies::{dependencies, initial_dependencies};
use crate::defaults as d;
use crate::description::{Capabilities, Causality, DefaultExperiment, Definition, Unknown, Variable};
use crate::models::common_table::{COORDINATE_UNITS, RATE_UNITS, coordinates, mechanism_parameters, names, per_limb};

const INF: f64 = f64::INFINITY;
/// Largest relative tolerance of the solver; beyond it nothing would be held.
pub(super) const LARGEST_TOLERANCE: f64 = 0.1;

/// The model description of Rps3Plant.
pub fn definition() -> Definition {
    let inputs = inputs();
    let parameters = [mechanism_parameters(), parameters()].concat();
    let positions = states_and_rates();
    let variables =
        [vec![Variable::time()], inputs.clone(), positions, outputs(), locals(), parameters.clone()].concat();
    let outputs: Vec<String> =
        variables.iter().filter(|v| v.causality == Causality::Output).map(|v| v.name.clone()).collect();
    let state_names = state_names();
    let derivative_names =
        [coordinates("_dot"), coordinates("_ddot"), per_limb("i_leg", "_dot"), per_limb("i_rev", "_dot")].concat();
    let unknown = |name: &String| Unknown { variable: name.clone(), dependencies: dependencies(name) };
    let exact = [names(&inputs), names(&parameters)].concat();
    let initial = |name: &String| Unknown { variable: name.clone(), dependencies: initial_dependencies(name, &exact) };
    let mut initial_names = [outputs.clone(), derivative_names.clone()].concat();
    initial_names.sort_by_key(|name| variables.iter().position(|v| v.name == *name));
    initial_names.dedup();
    debug_assert!(state_names.iter().all(|s| outputs.contains(s)));
    Definition {
        model_identifier: "Rps3Plant",
        description: "3-RPS parallel manipulator with DC motors: rigid-body dynamics in heave and tilt",
        outputs: outputs.iter().map(unknown).collect(),
        derivatives: derivative_names.iter().map(unknown).collect(),
        initial_unknowns: initial_names.iter().map(initial).collect(),
        variables,
        default_experiment: DefaultExperiment {
            start_time: 0.0,
            stop_time: d::STOP_TIME,
            tolerance: d::TOLERANCE,
            step_size: d::STEP_SIZE,
        },
        capabilities: Capabilities {
            max_output_derivative_order: 1,
            can_interpolate_inputs: true,
            provides_directional_derivative: true,
        },
        event_indicators: 0,
    }
}

/// The twelve continuous states in order.
pub fn state_names() -> Vec<String> {
    [coordinates(""), coordinates("_dot"), per_limb("i_leg", ""), per_limb("i_rev", "")].concat()
}

fn inputs() -> Vec<Variable> {
    let mut list = Vec::new();
    for (k, (prefix, text)) in [("v_leg", "leg"), ("v_rev", "revolute")].into_iter().enumerate() {
        for (i, name) in per_limb(prefix, "").iter().enumerate() {
            let text = format!("Terminal voltage of the {text} motor of limb {}; limited to +-v_max", i + 1);
            list.push(Variable::real(name, (1 + 3 * k + i) as u32, Some("V"), &text).input().start(0.0).nominal(10.0));
        }
    }
    for (k, (prefix, unit, text)) in
        [("f_ext", "N", "External force at P"), ("m_ext", "N.m", "External moment on the platform")]
            .into_iter()
            .enumerate()
    {
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let text = format!("{text}, base frame, {axis} component");
            list.push(
                Variable::real(&format!("{prefix}_{axis}"), (7 + 3 * k + i) as u32, Some(unit), &text)
                    .input()
                    .start(0.0),
            );
        }
    }
    list
}

/// Generalized coordinates, their rates and the currents: states that are outputs as well.
fn states_and_rates() -> Vec<Variable> {
    let mut list = Vec::new();
    let what = ["Height of P above the base plane", "Tilt vector's x component", "Tilt vector's y component"];
    for (i, name) in coordinates("").iter().enumerate() {
        let (unit, display) = COORDINATE_UNITS[i];
        list.push(Variable::real(name, 100 + i as u32, Some(unit), what[i]).output().display(display).nominal(0.1));
    }
    for (i, name) in coordinates("_dot").iter().enumerate() {
        let (unit, display) = RATE_UNITS[i];
        let text = format!("Rate of {}", coordinates("")[i]);
        list.push(
            Variable::real(name, 103 + i as u32, Some(unit), &text)
                .output()
                .display(display)
                .derivative_of(&coordinates("")[i]),
        );
    }
    for (k, (prefix, text)) in [("i_leg", "leg"), ("i_rev", "revolute")].into_iter().enumerate() {
        for (i, name) in per_limb(prefix, "").iter().enumerate() {
            let text = format!("Armature current of the {text} motor of limb {}", i + 1);
            list.push(Variable::real(name, (106 + 3 * k + i) as u32, Some("A"), &text).output());
        }
    }
    list
}

fn outputs() -> Vec<Variable> {
    let mut list = Vec::new();
    let limb_quantities = [
        ("d", "", "m", Some("cm"), "Length of limb", 0.2),
        ("d", "_dot", "m/s", Some("cm/s"), "Rate of the length of limb", 1.0),
        ("theta", "", "rad", Some("deg"), "Angle from the horizontal of limb", 0.1),
        ("theta", "_dot", "rad/s", Some("deg/s"), "Rate of the angle of limb", 1.0),
        ("f_axial", "", "N", None, "Force on the platform at B along limb", 10.0),
        ("f_normal", "", "N", None, "Force on the platform at B in the plane of and normal to limb", 10.0),
        ("f_lateral", "", "N", None, "Force on the platform at B out of the plane of limb", 10.0),
    ];
    for (k, (prefix, suffix, unit, display, text, nominal)) in limb_quantities.into_iter().enumerate() {
        for (i, name) in per_limb(prefix, suffix).iter().enumerate() {
            let text = format!("{text} {}", i + 1);
            let variable = Variable::real(name, (112 + 3 * k + i) as u32, Some(unit), &text).output().nominal(nominal);
            list.push(if let Some(display) = display { variable.display(display) } else { variable });
        }
    }
    let vectors = [
        ("p", "m", Some("cm"), "Position of P, base frame,", 0.1),
        ("v", "m/s", Some("cm/s"), "Velocity of P, base frame,", 1.0),
        ("a", "m/s2", None, "Acceleration of P, base frame,", 1.0),
        ("w", "rad/s", Some("deg/s"), "Angular velocity of the platform, base frame,", 1.0),
    ];
    for (k, (prefix, unit, display, text, nominal)) in vectors.into_iter().enumerate() {
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let text = format!("{text} {axis} component");
            let variable = Variable::real(&format!("{prefix}_{axis}"), (133 + 3 * k + i) as u32, Some(unit), &text)
                .output()
                .nominal(nominal);
            list.push(if let Some(display) = display { variable.display(display) } else { variable });
        }
    }
    for (i, part) in ["w", "x", "y", "z"].into_iter().enumerate() {
        let text = format!("Orientation of the platform, unit quaternion, {part} component");
        list.push(Variable::real(&format!("q_{part}"), 145 + i as u32, None, &text).output().range(-1.0, 1.0));
    }
    list.push(
        Variable::real("sigma_min", 149, None, "Smallest singular value of the scaled 6x6 Jacobian J")
            .output()
            .nominal(0.1),
    );
    list.push(Variable::real("det_a", 150, None, "Determinant of A (Appendix B), lengths divided by a").output());
    list.push(
        Variable::real("power_electric", 151, Some("W"), "Power that enters at the motor terminals")
            .output()
            .nominal(10.0),
    );
    list.push(Variable::real("energy", 152, Some("J"), "Kinetic, potential, magnetic and end-stop energy").output());
    list
}

/// Derivatives of states that are no outputs.
fn locals() -> Vec<Variable> {
    let mut list = Vec::new();
    for (i, name) in coordinates("_ddot").iter().enumerate() {
        let unit = if i == 0 { "m/s2" } else { "rad/s2" };
        let text = format!("Acceleration of {}", coordinates("")[i]);
        list.push(Variable::real(name, 200 + i as u32, Some(unit), &text).derivative_of(&coordinates("_dot")[i]));
    }
    for (k, (prefix, text)) in [("i_leg", "leg"), ("i_rev", "revolute")].into_iter().enumerate() {
        for (i, name) in per_limb(prefix, "_dot").iter().enumerate() {
            let text = format!("Rate of the current of the {text} motor of limb {}", i + 1);
            list.push(
                Variable::real(name, (203 + 3 * k + i) as u32, Some("A/s"), &text)
                    .derivative_of(&per_limb(prefix, "")[i])
                    .nominal(1e3),
            );
        }
    }
    list
}

/// What only the plant has: end stops, initial pose, solver. Value references 2000 and up.
fn parameters() -> Vec<Variable> {
    let real = |vr, name: &str, unit, start, min, max, text: &str| {
        Variable::real(name, vr, unit, text).parameter().start(start).range(min, max)
    };
    vec![
        real(2000, "d_min", Some("m"), d::D_MIN, -INF, INF, "End stop: shortest limb").display("cm"),
        real(2001, "d_max", Some("m"), d::D_MAX, -INF, INF, "End stop: longest limb").display("cm"),
        real(2002, "theta_min", Some("rad"), d::THETA_MIN, -PI, PI, "End stop: lowest limb angle").display("deg"),
        real(2003, "theta_max", Some("rad"), d::THETA_MAX, -PI, PI, "End stop: highest limb angle").display("deg"),
        real(
            2004,
            "stop_stiffness",
            Some("N/m"),
            d::STOP_STIFFNESS,
            0.0,
            INF,
            "End stops: stiffness; at a lever r_b for angles",
        )
        .nominal(1e6),
        real(
            2005,
            "stop_damping",
            Some("N.s/m"),
            d::STOP_DAMPING,
            0.0,
            INF,
            "End stops: damping; at a lever r_b for angles",
        )
        .nominal(1e3),
        real(2006, "heave_start", Some("m"), d::START_HEAVE, -INF, INF, "Initial heave").display("cm"),
        real(2007, "tilt_x_start", Some("rad"), d::START_TILT_X, -INF, INF, "Initial tilt_x").display("deg"),
        real(2008, "tilt_y_start", Some("rad"), d::START_TILT_Y, -INF, INF, "Initial tilt_y").display("deg"),
        real(
            2009,
            "relative_tolerance",
            None,
            0.0,
            0.0,
            LARGEST_TOLERANCE,
            "Co-simulation solver's tolerance; 0: that of the experiment",
        )
        .nominal(1e-6),
        real(2010, "max_step", Some("s"), 0.01, 1e-6, INF, "Co-simulation solver's largest step").nominal(1e-3),
        Variable::boolean("settled_start", 2000, "Initial currents hold the initial pose")
            .parameter()
            .start_boolean(true),
    ]
}
