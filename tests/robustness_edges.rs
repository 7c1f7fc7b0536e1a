//! The pair of FMUs where numerics are hard: no tilt, exact singularities, end stops, stalled
//! motors, a wrong model, very short and very long communication steps.

mod common;

use common::{Slave, couple};
use rps3::defaults as d;
use rps3::fmi2::types::Status;
use rps3::models::{Controller, Plant};

const COORDINATES: [&str; 3] = ["heave", "tilt_x", "tilt_y"];
const SINGULAR: [f64; 3] = [d::VIA_HEAVE, d::VIA_TILT_X, d::VIA_TILT_Y];
const LEVEL: [f64; 3] = [0.05, 0.0, 0.0];
/// m
const R_B: f64 = d::JOINT_SPACING / 1.732_050_807_568_877_2;

/// A pair that starts at `start` and moves to `end` through `via`.
fn pair(poses: [[f64; 3]; 3], six: bool, mode: i32) -> (Slave<Plant>, Slave<Controller>) {
    let (plant, controller) = (Slave::<Plant>::new(), Slave::<Controller>::new());
    plant.set_boolean("revolute_motors", six);
    controller.set_boolean("revolute_motors", six);
    controller.set_integer("control_mode", mode);
    for (k, name) in COORDINATES.iter().enumerate() {
        assert_eq!(plant.set_real(&format!("{name}_start"), poses[0][k]), Status::Ok);
        for (point, pose) in ["start", "via", "end"].iter().zip(&poses) {
            assert_eq!(controller.set_real(&format!("{point}_{name}"), pose[k]), Status::Ok);
        }
    }
    (plant, controller)
}

fn initialize(plant: &Slave<Plant>, controller: &Slave<Controller>) {
    plant.initialize();
    common::measure(plant, controller);
    controller.initialize();
}

/// Largest component of the pose error, m.
fn pose_error(plant: &Slave<Plant>, controller: &Slave<Controller>) -> f64 {
    let error = |name: &str| (plant.real(name) - controller.real(&format!("{name}_ref"))).abs();
    error("heave").max(R_B * error("tilt_x")).max(R_B * error("tilt_y"))
}

fn all_finite(plant: &Slave<Plant>) -> bool {
    plant.outputs().iter().all(|x| x.is_finite())
}

#[test]
fn a_level_platform_is_held_and_left_and_reached() {
    for mode in [1, 2, 3, 4] {
        let tilted = [0.06, 0.05, -0.04];
        for poses in [[LEVEL; 3], [LEVEL, LEVEL, tilted], [tilted, LEVEL, LEVEL]] {
            let (plant, controller) = pair(poses, true, mode);
            initialize(&plant, &controller);
            couple(&plant, &controller, 0, 1200, 1e-3);
            let error = pose_error(&plant, &controller);
            assert!(error < 1e-3, "mode {mode}: {error} m");
        }
    }
}

#[test]
fn an_exactly_singular_start_is_survived_by_every_mode_and_held_with_six_motors() {
    for six in [true, false] {
        for mode in [1, 2, 3, 4] {
            let (plant, controller) = pair([SINGULAR; 3], six, mode);
            initialize(&plant, &controller);
            couple(&plant, &controller, 0, 300, 1e-3);
            assert!(all_finite(&plant));
            let error = pose_error(&plant, &controller);
            if six && mode == 4 {
                assert!(error < 1e-3, "{error} m");
            }
        }
    }
}

#[test]
fn motors_stalled_at_the_end_stops_draw_their_stall_current_for_a_minute() {
    for sign in [1.0, -1.0] {
        let plant = Slave::<Plant>::new();
        plant.initialize();
        for i in 1..=3 {
            plant.set_real(&format!("v_leg{i}"), sign * d::V_MAX);
            plant.set_real(&format!("v_rev{i}"), sign * d::V_MAX);
        }
        let mut late = Vec::new();
        for k in 0..60 {
            assert_eq!(plant.step(f64::from(k), 1.0), Status::Ok, "{:?}", plant.take_messages());
            if k >= 30 {
                late.push(plant.outputs());
            }
        }
        assert!(late.iter().flatten().all(|x| x.is_finite()));
        let stall = sign * d::V_MAX / d::MOTOR_RA;
        for name in ["i_leg1", "i_leg2", "i_leg3"] {
            // at rest to the solver's tolerance
            assert!((plant.real(name) - stall).abs() < 1e-2, "{name} = {}", plant.real(name));
        }
        for name in COORDINATES {
            assert!(plant.real(&format!("{name}_dot")).abs() < 1e-3, "{name} still moves");
        }
    }
}

#[test]
fn a_model_wrong_by_a_fifth_still_crosses() {
    let names = [
        "plate_mass",
        "lower_mass",
        "upper_mass",
        "lower_inertia",
        "upper_inertia",
        "motor_jm",
        "motor_bm",
        "motor_kt",
        "motor_ra",
        "motor_la",
    ];
    let start = [d::START_HEAVE, d::START_TILT_X, d::START_TILT_Y];
    let end = [d::END_HEAVE, d::END_TILT_X, d::END_TILT_Y];
    for (factor, mode) in [(0.8, 2), (1.2, 2), (0.8, 4), (1.2, 4)] {
        let (plant, controller) = pair([start, SINGULAR, end], true, mode);
        for name in names {
            assert_eq!(controller.set_real(name, controller.start(name) * factor), Status::Ok);
        }
        initialize(&plant, &controller);
        let mut worst = 0.0_f64;
        for k in 0..1400 {
            couple(&plant, &controller, k, k + 1, 1e-3);
            worst = worst.max(pose_error(&plant, &controller));
        }
        println!("model x {factor}, mode {mode}: {worst:.2e} m");
        assert!(worst < 10e-3, "model x {factor}, mode {mode}: {worst} m");
    }
}

#[test]
fn any_communication_step_from_a_microsecond_to_a_second_is_served() {
    for (step, steps) in [(1e-6, 3000), (1e-5, 1000), (1e-4, 500), (1e-2, 30), (0.1, 5), (1.0, 2)] {
        let (plant, controller) = (Slave::<Plant>::new(), Slave::<Controller>::new());
        controller.set_integer("control_mode", 2);
        initialize(&plant, &controller);
        couple(&plant, &controller, 0, steps, step);
        assert!(all_finite(&plant), "{step} s");
        if step <= 1e-3 {
            assert!(pose_error(&plant, &controller) < 1e-3, "{step} s");
        }
    }
}

#[test]
fn steps_without_a_tick_change_nothing_but_the_time() {
    // powers of two, so that both arrive at the same time to the bit
    let step = 1.0 / 1024.0;
    let states = [1, 4].map(|parts| {
        let controller = Slave::<Controller>::new();
        controller.initialize();
        let before = controller.outputs();
        for k in 0..10 {
            let point = f64::from(k) * step;
            assert_eq!(controller.set_real("d1", 0.3 + 1e-4 * f64::from(k)), Status::Ok);
            for j in 0..parts {
                let size = step / f64::from(parts);
                assert_eq!(controller.step(point + f64::from(j) * size, size), Status::Ok);
            }
        }
        assert_ne!(controller.outputs(), before, "there were ticks");
        controller.serialize(controller.state())
    });
    assert!(states[0] == states[1]);
}

#[test]
fn a_tick_at_the_end_of_a_step_belongs_to_the_next_even_if_the_master_s_clock_has_drifted() {
    let (exact, drifting) = (Slave::<Controller>::new(), Slave::<Controller>::new());
    let (mut time, mut ahead) = (0.0, 0);
    for slave in [&exact, &drifting] {
        slave.set_integer("control_mode", 2);
        slave.initialize();
    }
    let start = exact.real("d1");
    for k in 0..200_u32 {
        let point = f64::from(k) * 1e-3;
        for (slave, point) in [(&exact, point), (&drifting, time)] {
            assert_eq!(slave.set_real("d1", start + 1e-6 * f64::from(k % 7)), Status::Ok);
            assert_eq!(slave.step(point, 1e-3), Status::Ok);
        }
        time += 1e-3;
        ahead += u32::from(time > f64::from(k + 1) * 1e-3);
        assert_eq!(exact.outputs(), drifting.outputs(), "step {k}");
    }
    assert!(ahead > 20, "the sum of the steps is ahead of the ticks at {ahead} of 200 times");
}

#[test]
fn readings_held_over_many_ticks_of_one_step_are_not_frozen() {
    let controller = Slave::<Controller>::new();
    controller.set_integer("control_mode", 2);
    controller.initialize();
    let start = controller.real("d1");
    for k in 0..5 {
        let t = 0.05 * f64::from(k);
        assert_eq!(controller.set_reals(&[("d1", start + 0.05 * t), ("d1_dot", 0.05)]), Status::Ok);
        assert_eq!(controller.step(t, 0.05), Status::Ok);
        assert!(!controller.boolean("sensor_fault"), "{:?}", controller.take_messages());
    }
}

#[test]
fn a_tick_sees_the_inputs_set_at_its_time_however_late_the_start() {
    for (start, sample_time) in [(0.0, 1e-3), (5e7, 1e-3), (9e8, 1e-3), (2e6, 1e-4)] {
        let controller = Slave::<Controller>::new();
        controller.set_integer("control_mode", 2);
        controller.set_integer("reference_mode", 2);
        assert_eq!(controller.set_real("sample_time", sample_time), Status::Ok);
        assert_eq!(controller.setup(start, None), Status::Ok);
        controller.pass_initialization();
        for k in 0..300 {
            let reference = 0.05 + 1e-5 * f64::from(k);
            assert_eq!(controller.set_real("ref_heave", reference), Status::Ok);
            assert_eq!(controller.step(start + f64::from(k) * sample_time, sample_time), Status::Ok);
            assert_eq!(controller.real("heave_ref"), reference, "tick {k} from {start} s on");
        }
    }
}

#[test]
fn a_tolerance_beyond_all_measure_is_cut() {
    let heave = |tolerance: f64| {
        let plant = Slave::<Plant>::new();
        assert_eq!(plant.setup_tolerance(tolerance), Status::Ok);
        plant.pass_initialization();
        assert_eq!(plant.set_real("v_leg1", 20.0), Status::Ok);
        for k in 0..20 {
            assert_eq!(plant.step(0.01 * f64::from(k), 0.01), Status::Ok);
        }
        plant.real("heave")
    };
    assert_eq!(heave(1e3), heave(0.1));
    assert_ne!(heave(0.1), heave(1e-6));
}

#[test]
fn inputs_with_derivatives_end_where_these_lead() {
    fn check<M: common::Fmu>(input: &str) {
        let slave = Slave::<M>::new();
        slave.initialize();
        let start = slave.real(input);
        for k in 0..3 {
            slave.set_input_derivative(input, 0.5);
            // half the sample time of the controller, whose first step is an idle one
            assert_eq!(slave.step(5e-4 * f64::from(k), 5e-4), Status::Ok);
            let expected = start + 0.5 * 5e-4 * f64::from(k + 1);
            assert!((slave.real(input) - expected).abs() < 1e-12, "{input}: {} {expected}", slave.real(input));
        }
    }
    check::<Plant>("v_leg1");
    check::<Controller>("ref_heave");
}

#[test]
fn a_start_pose_or_waypoint_tilted_by_a_right_angle_is_refused() {
    let plant = Slave::<Plant>::new();
    let wide = [("theta_min", -3.1), ("theta_max", 3.1), ("d_min", 0.002), ("d_max", 5.0)];
    let tilted = [("tilt_x_start", 1.2), ("tilt_y_start", 1.2)];
    assert_eq!(plant.set_reals(&[wide.to_vec(), tilted.to_vec()].concat()), Status::Ok);
    assert_eq!(plant.try_initialize(), Status::Error);
    assert!(plant.take_messages().iter().any(|m| m.text.contains("is 90 deg or more")));
    let controller = Slave::<Controller>::new();
    assert_eq!(controller.set_reals(&[("via_tilt_x", 1.2), ("via_tilt_y", 1.2)]), Status::Ok);
    assert_eq!(controller.try_initialize(), Status::Error);
    assert!(controller.take_messages().iter().any(|m| m.text.contains("a tilt below 90 deg")));
}

#[test]
fn work_for_one_call_ends_with_a_discard_and_not_with_a_hang() {
    let plant = Slave::<Plant>::new();
    assert_eq!(plant.set_real("max_step", 1e-6), Status::Ok);
    plant.initialize();
    assert_eq!(plant.step(0.0, 100.0), Status::Discard);
    let controller = Slave::<Controller>::new();
    assert_eq!(controller.set_real("sample_time", 1e-5), Status::Ok);
    controller.set_integer("control_mode", 2);
    controller.initialize();
    assert_eq!(controller.step(0.0, 100.0), Status::Discard);
}

fn refuses_what_is_no_time<M: common::Fmu>() {
    let slave = Slave::<M>::new();
    for start in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -1e308, 2e9] {
        assert_eq!(slave.setup(start, None), Status::Error, "start time {start}");
    }
    for stop in [f64::NAN, f64::INFINITY, -1.0] {
        assert_eq!(slave.setup(0.0, Some(stop)), Status::Error, "stop time {stop}");
    }
    for stop in [1e308, f64::MAX] {
        assert_eq!(slave.setup(0.0, Some(stop)), Status::Ok, "far away is no harm");
    }
    slave.initialize();
    for step in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, 1e9, 0.0, -1e-3] {
        assert_eq!(slave.step(0.0, step), Status::Error, "step size {step}");
    }
    for point in [f64::NAN, f64::INFINITY, 1e308, -1.0] {
        assert_eq!(slave.step(point, 1e-3), Status::Error, "communication point {point}");
    }
    // as short as doubles go
    let shortest = slave.step(0.0, 5e-324);
    assert!(matches!(shortest, Status::Ok | Status::Error), "{shortest:?}");
    assert_eq!(slave.step(0.0, 1e-3), Status::Ok, "no refused step did harm");
}

#[test]
fn a_time_or_step_that_is_none_is_an_error_at_once() {
    refuses_what_is_no_time::<Plant>();
    refuses_what_is_no_time::<Controller>();
}

fn runs_from<M: common::Fmu>(start: f64) {
    let slave = Slave::<M>::new();
    assert_eq!(slave.setup(start, None), Status::Ok);
    slave.pass_initialization();
    let mut time = start;
    for _ in 0..20 {
        assert_eq!(slave.step(time, 1e-3), Status::Ok, "at {time}: {:?}", slave.take_messages());
        time += 1e-3;
    }
    assert_eq!(slave.real("time"), time);
}

#[test]
fn the_earliest_and_the_latest_start_time_are_served() {
    for start in [-1e9, -1.0, 1e6, 1e9 - 1.0] {
        runs_from::<Plant>(start);
        runs_from::<Controller>(start);
    }
    let late = Slave::<Plant>::new();
    assert_eq!(late.setup(1e9 - 1.0, None), Status::Ok);
    late.pass_initialization();
    assert_eq!(late.step(1e9 - 1.0, 2.0), Status::Error, "no step leads beyond");
    assert_eq!(late.step(1e9 - 1.0, 1.0), Status::Ok);
}
