//! Variable table of Rps3Controller.

use super::dependencies::{dependencies, initial_dependencies};
use crate::defaults as d;
use crate::description::{Capabilities, Causality, DefaultExperiment, Definition, Unknown, Variable};
use crate::models::common_table::{COORDINATE_UNITS, RATE_UNITS, coordinates, mechanism_parameters, names, per_limb};

const INF: f64 = f64::INFINITY;

/// The model description of Rps3Controller.
pub fn definition() -> Definition {
    let inputs = inputs();
    let parameters = [mechanism_parameters(), reals(), integers()].concat();
    let variables = [vec![Variable::time()], inputs.clone(), outputs(), parameters.clone()].concat();
    let outputs: Vec<String> =
        variables.iter().filter(|v| v.causality == Causality::Output).map(|v| v.name.clone()).collect();
    let input_names = names(&inputs);
    let exact = [input_names.clone(), names(&parameters)].concat();
    // the internal reference runs with time
    let at_ticks = [vec!["time".to_owned()], input_names].concat();
    let unknowns = |dependencies: fn(&str, &[String]) -> Vec<String>, knowns: &[String]| {
        let unknown = |name: &String| Unknown { variable: name.clone(), dependencies: dependencies(name, knowns) };
        outputs.iter().map(unknown).collect()
    };
    Definition {
        model_identifier: "Rps3Controller",
        description: "Hybrid damped resolved-acceleration control of a 3-RPS manipulator, damping tuned by a particle swarm",
        outputs: unknowns(dependencies, &at_ticks),
        derivatives: Vec::new(),
        initial_unknowns: unknowns(initial_dependencies, &exact),
        variables,
        default_experiment: DefaultExperiment {
            start_time: 0.0,
            stop_time: d::STOP_TIME,
            tolerance: d::TOLERANCE,
            step_size: d::STEP_SIZE,
        },
        capabilities: Capabilities {
            max_output_derivative_order: 0,
            can_interpolate_inputs: true,
            provides_directional_derivative: true,
        },
        event_indicators: 0,
    }
}

/// Measurements and the external reference.
fn inputs() -> Vec<Variable> {
    let mut list = Vec::new();
    let measurements = [
        ("d", "", "m", Some("cm"), "Measured length of limb"),
        ("d", "_dot", "m/s", Some("cm/s"), "Measured rate of the length of limb"),
        ("theta", "", "rad", Some("deg"), "Measured angle of limb"),
        ("theta", "_dot", "rad/s", Some("deg/s"), "Measured rate of the angle of limb"),
        ("i_leg", "", "A", None, "Measured current of the leg motor of limb"),
        ("i_rev", "", "A", None, "Measured current of the revolute motor of limb"),
    ];
    let starts = d::START_MEASUREMENTS;
    for (k, (prefix, suffix, unit, display, text)) in measurements.into_iter().enumerate() {
        for (i, name) in per_limb(prefix, suffix).iter().enumerate() {
            let text = format!("{text} {}", i + 1);
            let start = match (prefix, suffix) {
                ("d", "") => starts[i],
                ("theta", "") => starts[3 + i],
                _ => 0.0,
            };
            let variable = Variable::real(name, (1 + 3 * k + i) as u32, Some(unit), &text).measurement().start(start);
            list.push(if let Some(display) = display { variable.display(display) } else { variable });
        }
    }
    for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let text = format!("Measured acceleration of P, {axis} component, for the acceleration feedback k_a");
        list.push(Variable::real(&format!("a_{axis}"), 19 + i as u32, Some("m/s2"), &text).measurement().start(0.0));
    }
    let starts = [d::START_HEAVE, d::START_TILT_X, d::START_TILT_Y];
    let derivatives =
        [("", "Reference of"), ("_dot", "Rate of the reference of"), ("_ddot", "Acceleration of the reference of")];
    for (k, (suffix, text)) in derivatives.into_iter().enumerate() {
        for (i, name) in coordinates("").iter().enumerate() {
            let (unit, display) = match k {
                0 => (COORDINATE_UNITS[i].0, Some(COORDINATE_UNITS[i].1)),
                1 => (RATE_UNITS[i].0, Some(RATE_UNITS[i].1)),
                _ => (if i == 0 { "m/s2" } else { "rad/s2" }, None),
            };
            let text = format!("{text} {name}, used when reference_mode = 2");
            let variable = Variable::real(&format!("ref_{name}{suffix}"), (22 + 3 * k + i) as u32, Some(unit), &text)
                .input()
                .start(if k == 0 { starts[i] } else { 0.0 });
            list.push(if let Some(display) = display { variable.display(display) } else { variable });
        }
    }
    list
}

/// All outputs change at ticks only.
fn outputs() -> Vec<Variable> {
    let output = |vr, name: &str, unit, text: &str| Variable::real(name, vr, unit, text).output().discrete();
    let mut list = Vec::new();
    for (k, (prefix, text)) in [("v_leg", "leg"), ("v_rev", "revolute")].into_iter().enumerate() {
        for (i, name) in per_limb(prefix, "").iter().enumerate() {
            let text = format!("Voltage for the {text} motor of limb {}", i + 1);
            list.push(output((100 + 3 * k + i) as u32, name, Some("V"), &text).nominal(10.0));
        }
    }
    list.push(output(106, "rho", None, "Damping factor rho in force (4.11)").nominal(0.1));
    list.push(output(107, "rho_hd", Some("1/s"), "Velocity damping factor rho_hd in force (4.16)").nominal(1e3));
    list.push(
        output(108, "delta_hd", None, "Width delta_hd of the deceleration region in force (4.16), in mode 4 as tuned")
            .nominal(0.1),
    );
    list.push(output(109, "lambda_f", None, "Damping of the force distribution in force").nominal(0.1));
    list.push(output(110, "sigma_min", None, "Smallest singular value of J at the estimated pose").nominal(0.1));
    list.push(output(111, "lyapunov", Some("m2/s2"), "Lyapunov function (5.2)").nominal(1e-4));
    list.push(
        output(
            112,
            "lyapunov_dot",
            Some("m2/s3"),
            "Rate of the Lyapunov function (5.5); (5.6) while the reference rests",
        )
        .nominal(1e-4),
    );
    for (k, (suffix, text)) in [("_est", "Estimate of"), ("_ref", "Reference of")].into_iter().enumerate() {
        for (i, name) in coordinates("").iter().enumerate() {
            let (unit, display) = COORDINATE_UNITS[i];
            let text = format!("{text} {name}");
            list.push(
                output((113 + 3 * k + i) as u32, &format!("{name}{suffix}"), Some(unit), &text)
                    .display(display)
                    .nominal(0.1),
            );
        }
    }
    list.push(
        output(119, "err_position", Some("m"), "Distance of P from its reference, estimated")
            .display("mm")
            .nominal(1e-3),
    );
    list.push(
        output(120, "err_rotation", Some("rad"), "Angle between platform and its reference, estimated")
            .display("deg")
            .nominal(1e-3),
    );
    list.push(output(121, "mpso_fitness", Some("m2"), "Best fitness of the swarm; 0 in modes 1 to 3").nominal(1e-8));
    list.push(Variable::integer("mpso_iterations", 100, "Iterations of the swarm at the last tick").output());
    list.push(Variable::boolean("saturated", 100, "A voltage is at its limit").output());
    list.push(Variable::boolean("in_singular_region", 101, "sigma_min is below delta_hd_fixed").output());
    list.push(
        Variable::boolean("sensor_fault", 102, "A measurement is missing (set to no finite number) or frozen").output(),
    );
    list
}

fn reals() -> Vec<Variable> {
    let real = |vr, name: &str, unit, start, min, max, text: &str| {
        Variable::real(name, vr, unit, text).parameter().start(start).range(min, max)
    };
    let tunable = |vr, name: &str, unit, start, min, max, text: &str| {
        Variable::real(name, vr, unit, text).tunable().start(start).range(min, max)
    };
    let mut list = vec![
        real(2000, "sample_time", Some("s"), d::SAMPLE_TIME, 1e-5, 10.0, "Time between ticks")
            .display("ms")
            .nominal(1e-3),
        tunable(2001, "k_p", Some("1/s2"), d::K_P, 0.0, INF, "Position gain K_P (4.5b)").nominal(1e3),
        tunable(2002, "k_d", Some("1/s"), d::K_D, 0.0, INF, "Velocity gain K_D (4.5b)").nominal(100.0),
        tunable(2003, "k_a", None, d::K_A, -INF, INF, "Acceleration feedback gain (Figure 8)"),
        tunable(2004, "rho_fixed", None, d::RHO_FIXED, 0.0, INF, "Damping factor rho of modes 2 and 3").nominal(0.1),
        tunable(2005, "delta_hd_fixed", None, d::DELTA_HD_FIXED, 0.0, INF, "delta_hd of mode 3 (4.16)").nominal(0.1),
        tunable(
            2006,
            "lambda_f_fixed",
            None,
            d::LAMBDA_F_FIXED,
            0.0,
            INF,
            "Force-distribution damping of modes 2 and 3",
        )
        .nominal(0.01),
        real(2007, "c1", None, d::C1, 0.0, INF, "Pull to the particle's own best c1 (3.1)"),
        real(2008, "c2", None, d::C2, 0.0, INF, "Pull to the swarm's best c2 (3.1)"),
        real(2009, "inertia_max", None, d::INERTIA_MAX, 0.0, INF, "First inertia weight w_max (3.2)"),
        real(2010, "inertia_min", None, d::INERTIA_MIN, 0.0, INF, "Last inertia weight w_min (3.2)"),
        real(2011, "decay_max", None, d::DECAY_MAX, 0.0, INF, "First decay scale, the paper's rho_max (3.5)"),
        real(2012, "decay_min", None, d::DECAY_MIN, 0.0, INF, "Last decay scale, the paper's rho_min (3.5)")
            .nominal(0.01),
        real(2013, "regulating_scale", None, d::REGULATING_SCALE, 0.0, INF, "Regulating scale R (3.5)"),
        real(2014, "velocity_limit", None, d::VELOCITY_LIMIT, 1e-9, 1.0, "Largest step of a particle by search range"),
        real(2015, "rho_max", None, d::RHO_MAX, 0.0, INF, "Search range of rho: largest"),
        real(2016, "delta_hd_max", None, d::DELTA_HD_MAX, 0.0, INF, "Search range of delta_hd: largest").nominal(0.1),
        real(2017, "lambda_f_max", None, d::LAMBDA_F_MAX, 0.0, INF, "Search range of lambda_f: largest"),
        tunable(2020, "horizon", Some("s"), d::HORIZON, 1e-6, INF, "Prediction horizon of the fitness")
            .display("ms")
            .nominal(0.01),
        tunable(
            2021,
            "weight_velocity",
            Some("s2"),
            d::WEIGHT_VELOCITY,
            0.0,
            INF,
            "Fitness: weight of the velocity error",
        )
        .nominal(1e-4),
        tunable(
            2022,
            "weight_acceleration",
            Some("s4"),
            d::WEIGHT_ACCELERATION,
            0.0,
            INF,
            "Fitness: weight of the acceleration",
        )
        .nominal(1e-8),
        real(
            2024,
            "filter_time",
            Some("s"),
            d::FILTER_TIME,
            0.0,
            INF,
            "Time constant of the pose estimate's filter; 0: none",
        )
        .display("ms")
        .nominal(0.01),
        real(2023, "move_time", Some("s"), d::MOVE_TIME, 1e-3, INF, "Duration of the motion from start to end"),
    ];
    let waypoints = [
        ("start", [d::START_HEAVE, d::START_TILT_X, d::START_TILT_Y]),
        ("via", [d::VIA_HEAVE, d::VIA_TILT_X, d::VIA_TILT_Y]),
        ("end", [d::END_HEAVE, d::END_TILT_X, d::END_TILT_Y]),
    ];
    for (k, (point, starts)) in waypoints.into_iter().enumerate() {
        for (i, name) in coordinates("").iter().enumerate() {
            let (unit, display) = COORDINATE_UNITS[i];
            let text = format!("Waypoint {point}: {name}");
            let limit = if i == 0 { INF } else { 1.5 };
            list.push(
                real(
                    (2030 + 3 * k + i) as u32,
                    &format!("{point}_{name}"),
                    Some(unit),
                    starts[i],
                    -limit,
                    limit,
                    &text,
                )
                .display(display)
                .nominal(0.1),
            );
        }
    }
    list.extend([
        real(2040, "sensor_scale", None, 0.0, 0.0, INF, "Scale of all sensor imperfections; 0: ideal sensors"),
        real(
            2041,
            "sensor_length_resolution",
            Some("m"),
            d::SENSOR_LENGTH_RESOLUTION,
            0.0,
            INF,
            "Resolution of limb lengths (Table 1)",
        )
        .display("mm")
        .nominal(1e-4),
        real(
            2042,
            "sensor_length_noise",
            Some("m"),
            d::SENSOR_LENGTH_NOISE,
            0.0,
            INF,
            "Repeatability of limb lengths, standard deviation (Table 1)",
        )
        .display("mm")
        .nominal(1e-4),
        real(
            2043,
            "sensor_length_bias",
            Some("m"),
            d::SENSOR_LENGTH_BIAS,
            0.0,
            INF,
            "Largest static error of limb lengths (Table 1)",
        )
        .display("mm")
        .nominal(1e-3),
        real(
            2044,
            "sensor_angle_resolution",
            Some("rad"),
            d::SENSOR_ANGLE_RESOLUTION,
            0.0,
            INF,
            "Resolution of limb angles (Table 1)",
        )
        .display("deg")
        .nominal(1e-3),
        real(
            2045,
            "sensor_angle_noise",
            Some("rad"),
            d::SENSOR_ANGLE_NOISE,
            0.0,
            INF,
            "Repeatability of limb angles, standard deviation (Table 1)",
        )
        .display("deg")
        .nominal(1e-3),
        real(
            2046,
            "sensor_timeout",
            Some("s"),
            d::SENSOR_TIMEOUT,
            0.0,
            INF,
            "Time without a valid measurement after which the voltages are zero; 0: never",
        )
        .display("ms")
        .nominal(0.01),
    ]);
    list
}

fn integers() -> Vec<Variable> {
    let integer = |vr, name: &str, start, min, max, text: &str| {
        Variable::integer(name, vr, text).parameter().start_integer(start).range_integer(min, max)
    };
    vec![
        Variable::integer("control_mode", 2000, "1 RAC, 2 DRAC, 3 HDRAC, 4 HDRAC with MPSO")
            .tunable()
            .start_integer(4)
            .range_integer(1, 4),
        integer(2001, "computation_delay", 0, 0, 1, "Samples between measurement and voltage"),
        integer(2002, "swarm_size", d::SWARM_SIZE, 2, 1000, "Particles PS of the swarm"),
        integer(2003, "max_iterations", d::MAX_ITERATIONS, 1, 10_000, "Largest number of iterations at a tick"),
        integer(
            2004,
            "stall_iterations",
            d::STALL_ITERATIONS,
            1,
            10_000,
            "Iterations without a better solution that end the search",
        ),
        integer(2005, "seed", d::SEED, 0, i32::MAX, "Seed of all random numbers"),
        integer(2006, "reference_mode", 1, 1, 2, "1 internal waypoints, 2 inputs ref_*"),
        integer(
            2007,
            "profile",
            2,
            1,
            2,
            "1 constant rate of the path parameter with short blends, 2 quintic time law",
        ),
    ]
}
