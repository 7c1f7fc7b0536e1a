//! Facts about the damped acceleration (4.10)-(4.18).

use nalgebra::{Vector3, Vector6};
use proptest::prelude::*;
use rps3::control::{ControllerParameters, Measurement};
use rps3::control::{Damping, Estimate, Gains, Reference, SingularBasis, Situation};
use rps3::coupling::measure;
use rps3::defaults as d;
use rps3::dynamics::{Inputs, PlantModel, PlantParameters, PlantState};
use rps3::mechanism::Pose;

const SAMPLE_TIME: f64 = 1e-3;
const VIA: [f64; 3] = [d::VIA_HEAVE, d::VIA_TILT_X, d::VIA_TILT_Y];

/// The situation at `s` and `s_dot` while the default crossing's reference is at 0.45 s.
fn situation(s: [f64; 3], s_dot: [f64; 3]) -> (PlantModel<f64>, Situation<f64>) {
    let model = PlantModel::new(&PlantParameters::default());
    let parameters = ControllerParameters::default();
    let reference = Reference::new(
        parameters.waypoints.map(Vector3::from),
        parameters.move_time,
        parameters.profile,
        model.geometry.joint_radius,
    );
    let mut x = PlantState::zeros();
    x.fixed_rows_mut::<3>(0).copy_from(&Vector3::from(s));
    x.fixed_rows_mut::<3>(3).copy_from(&Vector3::from(s_dot));
    let measured: Measurement<f64> = measure(&model, &x, &Inputs::zero());
    let estimate = Estimate { s: s.into(), s_dot: s_dot.into() };
    let situation = Situation::new(&model, &estimate, &reference.at(0.45), &measured, &Gains::default());
    (model, situation)
}

fn damping(rho: f64, delta_hd: f64) -> Damping<f64> {
    Damping { rho, delta_hd, lambda_f: 0.0 }
}

prop_compose! {
    fn any_state()(heave in 0.02..0.09_f64, tilt in prop::array::uniform2(-0.15..0.15_f64), rates in prop::array::uniform3(-0.5..0.5_f64))
        -> ([f64; 3], [f64; 3]) { ([heave, tilt[0], tilt[1]], rates) }
}

proptest! {
    #[test]
    fn matrix_form_equals_the_sum_over_singular_vectors(
        (s, s_dot) in any_state(), log_rho in -2.0..0.0_f64, delta_hd in 0.0..0.3_f64,
    ) {
        let (_, situation) = situation(s, s_dot);
        let basis = SingularBasis::new(&situation);
        let damping = damping(10.0_f64.powf(log_rho), delta_hd);
        let by_vectors = basis.acceleration(&damping, SAMPLE_TIME); // (4.10), (4.15)
        let rho_hd = damping.rho_hd(basis.sigma_min, SAMPLE_TIME);
        let by_matrices = damping.acceleration(&situation.jacobian, &situation.desired, &situation.twist, rho_hd).unwrap(); // (4.14)
        // the Gram matrix has a condition number of up to 2 / rho^2
        prop_assert!((by_vectors - by_matrices).amax() < 1e-11 * (1.0 + by_vectors.amax()));
    }

    #[test]
    fn damped_acceleration_minimizes_its_objective(
        (s, s_dot) in any_state(), rho in 0.01..1.0_f64, delta_hd in 0.0..0.3_f64,
        direction in prop::array::uniform6(-1.0..1.0_f64),
    ) {
        let (_, situation) = situation(s, s_dot);
        let basis = SingularBasis::new(&situation);
        let damping = damping(rho, delta_hd);
        let rho_hd = damping.rho_hd(basis.sigma_min, SAMPLE_TIME);
        let objective = |q_ddot: Vector6<f64>| {
            (situation.jacobian * q_ddot - situation.desired).norm_squared()
                + rho * rho * (q_ddot + situation.twist * rho_hd).norm_squared() // (4.11)
        };
        let best = basis.acceleration(&damping, SAMPLE_TIME);
        let step = Vector6::from(direction) * (0.1 * (1.0 + best.amax()));
        // a quadratic function: what a step adds is that step's own square, the same to both sides
        let (plus, minus, least) = (objective(best + step), objective(best - step), objective(best));
        prop_assert!(plus > least && minus > least);
        prop_assert!((plus - minus).abs() < 1e-8 * (plus + minus));
    }

    #[test]
    fn undamped_acceleration_gives_the_joints_what_they_ask_for((s, s_dot) in any_state()) {
        let (_, situation) = situation(s, s_dot);
        let basis = SingularBasis::new(&situation);
        prop_assume!(basis.sigma_min > 1e-3);
        let q_ddot = basis.acceleration(&damping(0.0, 0.1), SAMPLE_TIME); // (4.5a)
        prop_assert!((situation.jacobian * q_ddot - situation.desired).amax() < 1e-9 * (1.0 + situation.desired.amax()));
    }
}

#[test]
fn deceleration_region_is_linear_in_the_smallest_singular_value() {
    let damping = damping(0.1, 0.05);
    for (sigma_min, expected) in [(0.0, 1000.0), (0.025, 500.0), (0.05, 0.0), (0.06, 0.0)] {
        let rho_hd = damping.rho_hd(sigma_min, SAMPLE_TIME); // (4.16)
        assert!((rho_hd - expected).abs() < 1e-9, "{sigma_min}: {rho_hd}");
    }
}

#[test]
fn leftover_velocity_along_the_degenerate_direction_is_gone_at_the_next_sample() {
    let s_dot = [-0.05, 0.2, -0.3];
    let (model, situation) = situation(VIA, s_dot);
    let svd = rps3::svd::Svd::new(&situation.jacobian);
    let sigma = svd.singular_values[5];
    let degenerate = svd.v.column(5).into_owned();
    let damping = damping(0.05, 0.1);
    assert!(sigma < 1e-8, "the default crossing's via is singular to the digits it is given with: {sigma:e}");
    let before = degenerate.dot(&situation.twist);
    assert!(before.abs() > 1e-2, "there is a velocity to remove: {before}");
    let basis = SingularBasis::new(&situation);
    // ideal computed torque and (4.13): the velocity one sample later
    let after = before + SAMPLE_TIME * degenerate.dot(&basis.acceleration(&damping, SAMPLE_TIME)); // (4.17), (4.18)
    assert!(after.abs() < 1e-6 * before.abs(), "{before:e} -> {after:e}");
    // The degenerate direction is a motion of the mechanism, so that the mechanism itself stops along it.
    let rho_hd = damping.rho_hd(sigma, SAMPLE_TIME);
    let s_ddot = basis.coordinate_acceleration(damping.rho, rho_hd);
    let pose = Pose::new(&model.geometry, &Vector3::from(VIA));
    let motion = pose.motion(&model.geometry, &s_dot.into());
    let (linear, angular) =
        (pose.linear_map * s_ddot + motion.linear_bias, pose.angular_map * s_ddot + motion.angular_bias);
    let r_b = model.geometry.joint_radius;
    let q_ddot = Vector6::new(linear.x, linear.y, linear.z, r_b * angular.x, r_b * angular.y, r_b * angular.z);
    let after = before + SAMPLE_TIME * degenerate.dot(&q_ddot);
    assert!(after.abs() < 1e-6 * before.abs(), "mechanism: {before:e} -> {after:e}");
}
