//! Evidence for the errata of sections 4 and 5 (docs/errata.md); those of section 2 are shown in
//! `singularity.rs`, those of section 6 and Appendix A in `newton_euler.rs`.

use nalgebra::{Matrix6, Vector3, Vector6};
use proptest::prelude::*;
use rps3::control::{
    Damping, Estimate, Gains, Measurement, ReferencePoint, SingularBasis, Situation, lyapunov, lyapunov_rate,
};
use rps3::defaults::{BASE_RADIUS, JOINT_SPACING};
use rps3::dynamics::{MechanismParameters, PlantModel};
use rps3::mechanism::{Geometry, Limb, OverallJacobian, Pose, singular_heights};
use rps3::svd::Svd;

/// J at a singular pose.
fn singular_jacobian() -> Matrix6<f64> {
    let g = Geometry::new(BASE_RADIUS, JOINT_SPACING);
    let (tilt_x, tilt_y) = (0.107, 0.0897);
    let heave = *singular_heights(&g, tilt_x, tilt_y).last().unwrap();
    let pose = Pose::new(&g, &Vector3::new(heave, tilt_x, tilt_y));
    OverallJacobian::new(&g, &Limb::all(&g, &pose)).matrix
}

fn damping(rho: f64) -> Damping<f64> {
    Damping { rho, delta_hd: 0.1, lambda_f: 0.0 }
}

/// (J^T J + rho^2)^-1 (J^T a + sign rho_hd rho^2 q_dot): sign -1 is (4.14), +1 follows from (4.12) as printed.
fn normal_equations(
    j: &Matrix6<f64>,
    a: &Vector6<f64>,
    q_dot: &Vector6<f64>,
    rho: f64,
    rho_hd: f64,
    sign: f64,
) -> Vector6<f64> {
    let gram = j.tr_mul(j) + Matrix6::identity() * (rho * rho);
    gram.cholesky().unwrap().solve(&(j.tr_mul(a) + q_dot * (sign * rho_hd * rho * rho)))
}

proptest! {
    #[test]
    fn hybrid_law_minimizes_its_objective(
        j in prop::array::uniform32(-1.0..1.0_f64), a in prop::array::uniform6(-10.0..10.0_f64),
        v in prop::array::uniform6(-1.0..1.0_f64), rho in 0.05..1.0_f64, rho_hd in 0.0..1000.0_f64,
    ) {
        // (4.14) against the gradient of (4.11)
        let j = Matrix6::from_fn(|row, column| j[(6 * row + column) % 32]);
        let (a, v) = (Vector6::from(a), Vector6::from(v));
        let q = damping(rho).acceleration(&j, &a, &v, rho_hd).unwrap();
        let gradient = j.tr_mul(&(j * q - a)) + (q + v * rho_hd) * (rho * rho);
        prop_assert!(gradient.amax() < 1e-10 * (1.0 + rho_hd), "{gradient}");
    }
}

#[test]
fn printed_4_12_speeds_up_what_the_scheme_means_to_stop() {
    let j = singular_jacobian();
    let degenerate = Svd::new(&j).v.column(5).into_owned();
    let (rho, rho_hd, sample_time) = (0.05, 1000.0, 1e-3);
    let velocity = degenerate * 0.3;
    let next = |sign| velocity + normal_equations(&j, &Vector6::zeros(), &velocity, rho, rho_hd, sign) * sample_time;
    // (4.14) removes the velocity at the next sample, the printed block matrix doubles it
    assert!(next(-1.0).norm() < 1e-9);
    assert!((next(1.0).norm() - 0.6).abs() < 1e-9);
    let ours = damping(rho).acceleration(&j, &Vector6::zeros(), &velocity, rho_hd).unwrap();
    assert!((velocity + ours * sample_time).norm() < 1e-9);
}

#[test]
fn degenerate_directions_are_those_with_sigma_far_below_rho() {
    // the line before (4.17) prints sigma_j >> rho for all; what (4.14) takes of a velocity says which they are
    let (rho_hd, sample_time) = (1000.0, 1e-3);
    let sigma = Vector6::new(1.0, 0.3, 0.1, 0.01, 1e-3, 1e-4);
    let velocity = Vector6::repeat(1.0);
    let q_ddot = damping(0.01)
        .acceleration(&Matrix6::from_diagonal(&sigma), &Vector6::zeros(), &velocity, rho_hd)
        .expect("a damped system");
    let left = velocity + q_ddot * sample_time;
    assert!(left[0] > 0.999 && left[2] > 0.98, "regular: their velocities are kept, {left}");
    assert!((left[3] - 0.5).abs() < 1e-9, "sigma = rho: half is kept");
    assert!(left[4] < 0.02 && left[5] < 1e-3, "degenerate: their velocities are removed, {left}");
}

/// The controller's situation at a pose, a rate and a reference some way off.
fn situation(s: Vector3<f64>, s_dot: Vector3<f64>, offset: Vector3<f64>, gains: &Gains) -> Situation<f64> {
    let model = PlantModel::without_stops(&MechanismParameters::default());
    let zero = Vector3::zeros();
    let measured = Measurement {
        lengths: zero,
        length_rates: zero,
        angles: zero,
        angle_rates: zero,
        leg_currents: zero,
        revolute_currents: zero,
        acceleration: zero,
    };
    let reference = ReferencePoint { position: s + offset, rate: offset, acceleration: offset * 3.0 };
    Situation::new(&model, &Estimate { s, s_dot }, &reference, &measured, gains)
}

const GAINS: Gains = Gains { position: 900.0, velocity: 60.0, acceleration: 0.0 };

proptest! {
    #[test]
    fn singular_basis_weighs_directions_as_the_matrix_form_does(
        tilt in 0.02..0.4_f64, direction in 0.0..std::f64::consts::TAU, off in prop::sample::select(vec![0.0, 1e-9, 1e-6, 1e-3]),
        rates in prop::array::uniform3(-0.5..0.5_f64), rho in 0.01..0.5_f64,
    ) {
        // (4.10) and (4.15) against (4.14), at and next to direct singularities
        let g = Geometry::new(BASE_RADIUS, JOINT_SPACING);
        let (tilt_x, tilt_y) = (tilt * direction.cos(), tilt * direction.sin());
        let heave = singular_heights(&g, tilt_x, tilt_y).last().unwrap() + off;
        let situation = situation(Vector3::new(heave, tilt_x, tilt_y), Vector3::from(rates), Vector3::new(2e-3, 0.01, -0.02), &GAINS);
        let damping = damping(rho);
        let basis = SingularBasis::new(&situation);
        let rho_hd = damping.rho_hd(basis.sigma_min, 1e-3);
        let allowed = &situation.allowed;
        let by_matrix = damping.acceleration(&allowed.jacobian, &allowed.desired, &allowed.twist, rho_hd).unwrap();
        let by_directions = basis.acceleration(&damping, 1e-3);
        // the matrix form squares the condition number
        let scale = (situation.desired.amax() + rho_hd) / (rho * rho);
        prop_assert!((by_matrix - by_directions).amax() < 1e-12 * scale, "{by_matrix} {by_directions}");
    }

    #[test]
    fn lyapunov_rate_is_what_the_hybrid_law_makes_of_5_4(
        s in prop::array::uniform3(0.02..0.1_f64), rates in prop::array::uniform3(-0.5..0.5_f64),
        rho in 0.01..0.5_f64, rho_hd in 0.0..1000.0_f64, moving in any::<bool>(),
    ) {
        // (5.4) with q_ddot from (4.14), J_dot q_dot from a_d* = a_d - J_dot q_dot, against (5.5)
        let offset = if moving { Vector3::new(2e-3, 0.01, -0.02) } else { Vector3::zeros() };
        let at = situation(Vector3::from(s), Vector3::from(rates), offset, &GAINS);
        let j = at.jacobian;
        let x_dot = j * at.twist;
        let q_ddot = damping(rho).acceleration(&j, &at.desired, &at.twist, rho_hd).unwrap();
        let wanted = at.reference_acceleration + (at.reference_rate - x_dot) * GAINS.velocity + at.error * GAINS.position;
        let j_dot_q_dot = wanted - at.desired;
        let rate = GAINS.position * at.error.dot(&(at.reference_rate - x_dot))
            + x_dot.dot(&(j * q_ddot)) + rho * rho * at.twist.dot(&q_ddot) + x_dot.dot(&j_dot_q_dot);
        let found = lyapunov_rate(&at, &GAINS, rho, rho_hd);
        prop_assert!((found - rate).abs() < 1e-8 * (1.0 + rate.abs()), "{found} {rate}");
        if !moving {
            // (5.6): a resting reference at the present pose
            prop_assert!(found <= 0.0);
        }
    }
}

#[test]
fn deceleration_region_ends_at_its_width() {
    // (4.16): 1/dt at the singularity, falling linearly to 0 at delta_hd
    let d = damping(0.05);
    assert_eq!(d.rho_hd(0.0, 1e-3), 1000.0);
    assert!((d.rho_hd(0.05, 1e-3) - 500.0).abs() < 1e-9);
    assert_eq!(d.rho_hd(0.1, 1e-3), 0.0);
    assert_eq!(d.rho_hd(0.2, 1e-3), 0.0);
}

#[test]
fn a_changing_rho_adds_to_the_lyapunov_functions_rate() {
    // (5.2) with pose and rates held, so that all of (5.4) but the missing term vanishes
    let at = situation(Vector3::new(0.05, 0.1, 0.1), Vector3::new(-0.2, 0.6, 0.4), Vector3::zeros(), &GAINS);
    let (rho, rho_dot, step) = (0.2, 3.0, 1e-6);
    let l = |time: f64| lyapunov(&at, &GAINS, rho + rho_dot * time);
    let rate = (l(step) - l(-step)) / (2.0 * step);
    let missing = rho * rho_dot * at.twist.norm_squared();
    assert!((rate - missing).abs() < 1e-9 && missing > 0.01, "{rate} {missing}");
    // and the rate by (5.5) does not see it
    let before = lyapunov_rate(&at, &GAINS, rho, 0.0);
    assert!((lyapunov_rate(&at, &GAINS, rho + 0.1, 0.0) - before).abs() < 1e-12, "without rho_hd, rho plays no part");
}

#[test]
fn at_a_singular_pose_the_scheme_rests_with_an_error_left() {
    // section 5 proves q_dot -> 0, not error -> 0: an error along the left null vector moves nothing
    let j = singular_jacobian();
    let error = Svd::new(&j).u.column(5).into_owned() * 0.01;
    let command = damping(0.05).acceleration(&j, &(error * 900.0), &Vector6::zeros(), 1000.0).unwrap();
    assert!(command.norm() < 1e-9, "{command}");
}
