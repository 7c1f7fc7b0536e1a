//! Sensor drop-out: reported, bridged with the last valid measurement, and in time ended with zero voltages.

mod common;

use common::{COUPLED_STEP, Message, Slave};
use nalgebra::{Vector3, Vector6};
use rps3::control::{Controller, ControllerParameters, Measurement, ReferencePoint};
use rps3::coupling::{Experiment, measure};
use rps3::dynamics::{Inputs, PlantModel, PlantParameters, moving};
use rps3::fmi2::types::Status;
use rps3::models;

const VOLTAGES: [&str; 6] = ["v_leg1", "v_leg2", "v_leg3", "v_rev1", "v_rev2", "v_rev3"];

/// A controller in mode 2 after some ticks at its start pose.
fn running() -> Slave<models::Controller> {
    let slave = Slave::new();
    slave.set_integer("control_mode", 2);
    slave.initialize();
    advance(&slave, 0, 5);
    slave.take_messages();
    slave
}

fn advance(slave: &Slave<models::Controller>, from: u32, to: u32) {
    for k in from..to {
        assert_eq!(slave.step(f64::from(k) * COUPLED_STEP, COUPLED_STEP), Status::Ok);
    }
}

fn warnings(messages: &[Message]) -> Vec<&str> {
    messages.iter().filter(|m| m.status == Status::Warning as i32).map(|m| m.text.as_str()).collect()
}

#[test]
fn a_measurement_set_to_nan_is_a_warning_and_keeps_its_value() {
    let slave = running();
    let before = slave.real("d1");
    for missing in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(slave.set_real("d1", missing), Status::Warning);
        assert_eq!(slave.real("d1"), before);
        assert_eq!(warnings(&slave.take_messages()).len(), 1, "fmi2Warning comes with a message");
    }
    // the others of the same call are set
    assert_eq!(slave.set_reals(&[("d2", 0.23), ("d3", f64::NAN), ("theta1", 0.27)]), Status::Warning);
    assert_eq!((slave.real("d2"), slave.real("theta1")), (0.23, 0.27));
}

#[test]
fn elsewhere_nan_is_an_error_and_nothing_of_the_call_is_done() {
    let slave = running();
    let before = slave.real("d1");
    for other in ["ref_heave", "k_p"] {
        assert_eq!(slave.set_reals(&[("d1", 0.3), (other, f64::NAN)]), Status::Error);
        assert_eq!(slave.real("d1"), before);
    }
    assert_eq!(slave.set_reals(&[("d1", f64::NAN), ("k_p", f64::NAN)]), Status::Error);
    assert!(!slave.boolean("sensor_fault"));
    advance(&slave, 5, 6);
    assert!(!slave.boolean("sensor_fault"), "the refused call has set nothing missing");
}

#[test]
fn a_measurement_is_back_in_whatever_company_it_is_set() {
    let slave = running();
    let valid = ["d2", "theta1", "theta2", "i_leg1"].map(|name| (name, slave.real(name)));
    let [d2, theta1, theta2, i_leg1] = valid;
    for company in
        [vec![theta2], vec![theta1, theta2], vec![theta2, d2], vec![i_leg1, theta2, d2], vec![theta2, ("k_p", 100.0)]]
    {
        assert_eq!(slave.set_real("theta2", f64::NAN), Status::Warning);
        assert_eq!(slave.set_reals(&company), Status::Ok);
        let state = slave.serialize(slave.state());
        assert_eq!(slave.set_real("theta2", theta2.1), Status::Ok);
        assert!(state == slave.serialize(slave.state()), "{company:?}");
    }
}

#[test]
fn a_measurement_that_is_not_used_may_be_missing_for_ever() {
    for (k_a, cut_off) in [(0.0, false), (0.1, true)] {
        let slave = running();
        slave.set_reals(&[("k_a", k_a), ("a_x", f64::NAN)]);
        advance(&slave, 5, 100);
        assert!(slave.boolean("sensor_fault"));
        assert_eq!(VOLTAGES.map(|name| slave.real(name)) == [0.0; 6], cut_off, "k_a = {k_a}");
    }
}

#[test]
fn measurements_that_contradict_each_other_are_a_warning() {
    let slave = running();
    slave.set_reals(&[("theta1", 45.0), ("theta2", 46.0), ("theta3", 47.0)]);
    advance(&slave, 5, 8);
    let messages = slave.take_messages();
    let [warning] = warnings(&messages)[..] else { panic!("{messages:?}") };
    assert!(warning.contains("contradict each other"), "{warning}");
}

#[test]
fn voltages_that_are_cut_off_are_at_no_limit() {
    let slave = running();
    slave.set_real("i_leg1", 50.0);
    slave.set_real("theta2", f64::NAN);
    advance(&slave, 5, 24);
    assert!(slave.boolean("saturated"));
    advance(&slave, 24, 25);
    assert_eq!(VOLTAGES.map(|name| slave.real(name)), [0.0; 6]);
    assert!(!slave.boolean("saturated"));
}

#[test]
fn a_missing_measurement_is_reported_once_and_ends_the_voltages_in_time() {
    let slave = running();
    let held = VOLTAGES.map(|name| slave.real(name));
    assert!(held.iter().any(|v| *v != 0.0));
    slave.set_real("theta2", f64::NAN);
    slave.take_messages();
    advance(&slave, 5, 24);
    assert!(slave.boolean("sensor_fault"));
    assert!(VOLTAGES.iter().any(|name| slave.real(name) != 0.0), "19 ms are bridged");
    let messages = slave.take_messages();
    assert_eq!(warnings(&messages).len(), 1, "{messages:?}");
    assert!(messages[0].text.contains("theta2"));
    advance(&slave, 24, 25);
    assert_eq!(VOLTAGES.map(|name| slave.real(name)), [0.0; 6], "20 ms are not");
    advance(&slave, 25, 100);
    assert_eq!(warnings(&slave.take_messages()).len(), 1, "the cut-off, once");
    slave.set_real("theta2", slave.real("theta2"));
    advance(&slave, 100, 101);
    assert!(!slave.boolean("sensor_fault"));
    assert!(VOLTAGES.iter().any(|name| slave.real(name) != 0.0), "it recovers");
}

#[test]
fn the_timeout_is_a_parameter_and_zero_means_never() {
    for (timeout, last) in [(0.005, Some(5)), (0.0, None)] {
        let slave = Slave::<models::Controller>::new();
        slave.set_integer("control_mode", 2);
        slave.set_real("sensor_timeout", timeout);
        slave.initialize();
        slave.set_real("d1", f64::NAN);
        for k in 0..50 {
            advance(&slave, k, k + 1);
            assert!(slave.boolean("sensor_fault"));
            let cut_off = VOLTAGES.map(|name| slave.real(name)) == [0.0; 6];
            assert_eq!(cut_off, last.is_some_and(|last| k + 1 >= last), "tick {k}");
        }
    }
}

#[test]
fn what_is_missing_is_part_of_the_state_and_reset_forgets_it() {
    let slave = running();
    slave.set_real("d1", f64::NAN);
    let state = slave.state();
    slave.set_real("d1", 0.2);
    advance(&slave, 5, 6);
    assert!(!slave.boolean("sensor_fault"));
    slave.restore(state);
    advance(&slave, 5, 6);
    assert!(slave.boolean("sensor_fault"));
    slave.reset();
    slave.initialize();
    advance(&slave, 0, 1);
    assert!(!slave.boolean("sensor_fault"));
}

#[test]
fn a_measurement_may_be_missing_from_the_start() {
    let slave = Slave::<models::Controller>::new();
    slave.set_integer("control_mode", 2);
    assert_eq!(slave.set_real("d1", f64::NAN), Status::Warning);
    slave.initialize();
    assert!(slave.boolean("sensor_fault"));
    advance(&slave, 0, 3);
    assert!(slave.boolean("sensor_fault"));
}

/// A coupled crossing with `spoil` between plant and controller; the largest pose error (m), and
/// the times (s) of the first fault and of the first zero voltages.
fn crossing(spoil: impl Fn(f64, &mut Measurement<f64>)) -> (f64, Option<f64>, Option<f64>) {
    coupled(&Experiment { duration: 1.2, ..common::crossing(2) }, spoil)
}

/// The same of any `experiment`.
fn coupled(experiment: &Experiment, spoil: impl Fn(f64, &mut Measurement<f64>)) -> (f64, Option<f64>, Option<f64>) {
    let mut controller = Controller::new(experiment.controller).unwrap();
    let external = ReferencePoint::default();
    let (mut fault, mut cut_off, mut error) = (None, None, 0.0_f64);
    let mut last = None;
    let tick = |t: f64, measured: &Measurement<f64>| {
        let mut measured = *measured;
        spoil(t, &mut measured);
        if last.is_none() {
            controller.assume(&Vector6::zeros(), &measured);
        }
        last = Some(t);
        let diagnostics = controller.watched_tick(t, &measured, true, &external, &experiment.tuning)?;
        let faults = controller.sensor_faults();
        fault = fault.or(faults.any().then_some(t));
        cut_off = cut_off.or(faults.cut_off.then_some(t));
        Ok(diagnostics)
    };
    let joint_radius = PlantParameters::default().mechanism.joint_spacing / 3.0_f64.sqrt();
    experiment.run_with(tick, |record| error = error.max(record.pose_error(joint_radius))).unwrap();
    (error, fault, cut_off)
}

#[test]
fn after_a_cut_off_the_prediction_knows_that_there_was_no_voltage() {
    let experiment = Experiment::default();
    let parameters = ControllerParameters { computation_delay: true, ..experiment.controller };
    let model = PlantModel::<f64>::without_stops(&parameters.mechanism);
    let measured = measure(&model, &moving(&experiment.plant.start.into(), &Vector3::zeros()), &Inputs::zero());
    let missing = Measurement { lengths: measured.lengths * f64::NAN, ..measured };
    let tick = |controller: &mut Controller, k: u32, measured: &Measurement<f64>| {
        let external = ReferencePoint::default();
        controller.watched_tick(f64::from(k) * 1e-3, measured, true, &external, &experiment.tuning).unwrap().voltages
    };
    let mut controller = Controller::new(parameters).unwrap();
    controller.assume(&Vector6::zeros(), &measured);
    let held = (0..5).map(|k| tick(&mut controller, k, &measured)).last().unwrap();
    for k in 5..30 {
        tick(&mut controller, k, &missing);
    }
    assert!(controller.sensor_faults().cut_off);
    let next = |voltages: Option<Vector6<f64>>| {
        let mut controller = controller.clone();
        if let Some(voltages) = voltages {
            controller.assume(&voltages, &measured);
        }
        tick(&mut controller, 30, &measured)
    };
    assert_eq!(next(None), next(Some(Vector6::zeros())));
    assert_ne!(next(None), next(Some(held)));
}

#[test]
fn a_healthy_crossing_raises_no_alarm() {
    let (error, fault, _) = crossing(|_, _| {});
    assert_eq!(fault, None);
    assert!(error < 5e-3, "{error}");
    // nor do sensors of Table 1's resolution
    let sensors = ControllerParameters::default().sensors;
    let round = |x: f64, resolution: f64| libm::round(x / resolution) * resolution;
    let (_, fault, _) = crossing(|_, measured| {
        measured.lengths.apply(|x| *x = round(*x, sensors.length_resolution));
        measured.angles.apply(|x| *x = round(*x, sensors.angle_resolution));
    });
    assert_eq!(fault, None);
}

#[test]
fn a_length_that_freezes_during_the_crossing_is_found_in_time() {
    let frozen = std::cell::Cell::new(None);
    let (_, fault, cut_off) = crossing(|t, measured| {
        if t >= 0.4995 {
            let reading = frozen.get().unwrap_or(measured.lengths[0]);
            frozen.set(Some(reading));
            measured.lengths[0] = reading;
        }
    });
    let (fault, cut_off) = (fault.unwrap(), cut_off.unwrap());
    assert!((0.5195..0.5225).contains(&fault), "{fault}");
    assert_eq!(fault, cut_off, "a freeze is known when the time-out is over");
}

#[test]
fn a_short_gap_costs_little_and_a_long_one_the_motion_but_nothing_is_lost() {
    let gap = |length: f64| {
        crossing(move |t, measured| {
            if (0.4995..0.4995 + length).contains(&t) {
                measured.lengths[1] = f64::NAN;
                measured.angle_rates[2] = f64::NAN;
            }
        })
    };
    let (error, fault, cut_off) = gap(0.005);
    assert!((fault, cut_off) == (Some(0.5), None) && error < 10e-3, "{error} {fault:?} {cut_off:?}");
    let (error, _, cut_off) = gap(10.0);
    assert!(cut_off.is_some_and(|t| (t - 0.519).abs() < 2e-3), "{cut_off:?}");
    assert!(error.is_finite());
}

#[test]
fn a_gap_is_not_taken_for_a_static_error_of_the_length() {
    let mut experiment = Experiment { duration: 1.2, ..common::crossing(4) };
    experiment.controller.sensors.scale = 1.0;
    // The limb moves by a millimetre in the gap; the controller goes on with its last reading, and may book the difference.
    let (error, fault, cut_off) = coupled(&experiment, |t, measured| {
        if (0.3995..0.4145).contains(&t) {
            measured.lengths[1] = f64::NAN;
        }
    });
    let (without, _, _) = coupled(&experiment, |_, _| {});
    println!("largest error {error:e} m, {without:e} m without the gap");
    assert!(fault.is_some() && cut_off.is_none(), "{fault:?} {cut_off:?}");
    assert!(error < 0.3e-3 && without < 0.3e-3, "{error} {without}");
}
