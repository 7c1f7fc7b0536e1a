//! Facts about the damped acceleration (4.10)-(4.18).

use nalgebra::{Vector3, Vector6};
use proptest::prelude::*;
use rps3::control::{ControllerParameters, Measurement};
use rps3::control::{Damping, Estimate, Gains, Reference, SingularBasis, Situation};
use rps3::coupling::measure;
use rps3::defaults as d;
use rps3::dynamics::{Inputs, PlantModel, PlantParameters, derivative, moving};
use rps3::mechanism::Pose;
use rps3::svd::Svd;

const SAMPLE_TIME: f64 = 1e-3;
const VIA: [f64; 3] = [d::VIA_HEAVE, d::VIA_TILT_X, d::VIA_TILT_Y];

/// The situation at `s` and `s_dot` while the default crossing's reference is at 0.45 s.
fn situation(s: [f64; 3], s_dot: [f64; 3]) -> (PlantModel<f64>, Situation<f64>) {
    situation_with(&Gains::default(), s, s_dot)
}

fn situation_with(gains: &Gains, s: [f64; 3], s_dot: [f64; 3]) -> (PlantModel<f64>, Situation<f64>) {
    let model = PlantModel::new(&PlantParameters::default());
    let reference = Reference::of(&ControllerParameters::default());
    let measured: Measurement<f64> = measure(&model, &moving(&s.into(), &s_dot.into()), &Inputs::zero());
    let estimate = Estimate { s: s.into(), s_dot: s_dot.into() };
    let situation = Situation::new(&model, &estimate, &reference.at(0.45), &measured, gains);
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
        let allowed = &situation.allowed;
        let by_matrices = damping.acceleration(&allowed.jacobian, &allowed.desired, &allowed.twist, rho_hd).unwrap(); // (4.14)
        // the Gram matrix has a condition number of up to 2 / rho^2
        prop_assert!((by_vectors - by_matrices).amax() < 1e-11 * (1.0 + by_vectors.amax()));
    }

    #[test]
    fn damped_acceleration_minimizes_its_objective_over_what_the_mechanism_can_do(
        (s, s_dot) in any_state(), rho in 0.01..1.0_f64, delta_hd in 0.0..0.3_f64,
        direction in prop::array::uniform3(-1.0..1.0_f64),
    ) {
        let (model, situation) = situation(s, s_dot);
        let basis = SingularBasis::new(&situation);
        let damping = damping(rho, delta_hd);
        let rho_hd = damping.rho_hd(basis.sigma_min, SAMPLE_TIME);
        let objective = |s_ddot: Vector3<f64>| {
            let q_ddot = twist_rate(&model, &situation, &s_ddot);
            (situation.jacobian * q_ddot - situation.desired).norm_squared()
                + rho * rho * (q_ddot + situation.twist * rho_hd).norm_squared() // (4.11)
        };
        let best = basis.coordinate_acceleration(rho, rho_hd);
        let step = Vector3::from(direction) * (0.1 * (1.0 + best.amax()));
        // a quadratic function: what a step adds to its least value is the same to both sides
        let (plus, minus, least) = (objective(best + step), objective(best - step), objective(best));
        prop_assert!(plus > least && minus > least);
        prop_assert!((plus - minus).abs() < 1e-8 * (plus + minus));
    }

    #[test]
    fn undamped_acceleration_gives_the_joints_what_they_ask_for((s, s_dot) in any_state()) {
        let (model, situation) = situation(s, s_dot);
        let basis = SingularBasis::new(&situation);
        prop_assume!(basis.sigma_min > 1e-3);
        let q_ddot = twist_rate(&model, &situation, &basis.coordinate_acceleration(0.0, 0.0)); // (4.5a)
        prop_assert!((situation.jacobian * q_ddot - situation.desired).amax() < 1e-9 * (1.0 + situation.desired.amax()));
    }
}

/// q_ddot = T s_ddot + T_dot s_dot, rotations scaled by r_b, m/s2.
fn twist_rate(model: &PlantModel<f64>, situation: &Situation<f64>, s_ddot: &Vector3<f64>) -> Vector6<f64> {
    let (pose, motion) = (&situation.pose, situation.pose.motion(&model.geometry, &situation.s_dot));
    let linear = pose.linear_map * s_ddot + motion.linear_bias;
    let angular = (pose.angular_map * s_ddot + motion.angular_bias) * model.geometry.joint_radius;
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
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
    let svd = Svd::new(&situation.jacobian);
    let (sigma, degenerate) = (svd.singular_values[5], svd.v.column(5));
    let damping = damping(0.05, 0.1);
    assert!(sigma < 1e-8, "the default crossing's via is singular to the digits it is given with: {sigma:e}");
    let before = degenerate.dot(&situation.twist);
    assert!(before.abs() > 1e-2, "there is a velocity to remove: {before}");
    // ideal computed torque and (4.13): the velocity one sample later
    let rho_hd = damping.rho_hd(sigma, SAMPLE_TIME);
    let s_ddot = SingularBasis::new(&situation).coordinate_acceleration(damping.rho, rho_hd);
    let after = before + SAMPLE_TIME * degenerate.dot(&twist_rate(&model, &situation, &s_ddot)); // (4.17), (4.18)
    assert!(after.abs() < 1e-6 * before.abs(), "{before:e} -> {after:e}");
}

proptest! {
    #[test]
    fn acceleration_feedback_adds_the_error_of_p_s_acceleration((s, s_dot) in any_state(), k_a in -0.5..0.5_f64) {
        // Figure 8: what P lacks of its reference's acceleration, on the joint side by J's columns for translations
        let gains = Gains { acceleration: k_a, ..Gains::default() };
        let ((model, with), (_, without)) = (situation_with(&gains, s, s_dot), situation(s, s_dot));
        // P by central differences of its position along the reference and along the plant's motion
        let p = |s: Vector3<f64>| Pose::new(&model.geometry, &s).position;
        let second = |at: &dyn Fn(f64) -> Vector3<f64>, h: f64| (p(at(h)) - p(at(0.0)) * 2.0 + p(at(-h))) / (h * h);
        let reference = Reference::of(&ControllerParameters::default());
        let x = moving(&s.into(), &s_dot.into());
        let s_ddot: Vector3<f64> = derivative(&model, &x, &Inputs::zero()).fixed_rows::<3>(3).into();
        let plant = |t: f64| Vector3::from(s) + Vector3::from(s_dot) * t + s_ddot * (0.5 * t * t);
        let wanted = second(&|t| reference.at(0.45 + t).position, 1e-3);
        let missing = wanted - second(&plant, 1e-4 / (1.0 + s_ddot.amax()).sqrt());
        let expected = without.jacobian.fixed_columns::<3>(0) * missing * k_a;
        let added = with.desired - without.desired;
        prop_assert!((added - expected).amax() < 1e-4 * (1.0 + missing.amax()), "{added} {expected}");
    }
}
