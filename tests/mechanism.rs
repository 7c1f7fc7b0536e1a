//! Facts of the mechanism's geometry and kinematics.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use nalgebra::{Matrix3, Vector3};
use num_dual::Dual64;
use proptest::prelude::*;
use rps3::mechanism::{Geometry, Limb, OverallJacobian, Pose, normalized_det_a, scale_twist};

const DEG: f64 = std::f64::consts::PI / 180.0;

fn geometry<T: rps3::scalar::Scalar>() -> Geometry<T> {
    Geometry::new(rps3::defaults::BASE_RADIUS.into(), rps3::defaults::JOINT_SPACING.into())
}

fn tilted(heave: f64, tilt: f64, direction: f64) -> Vector3<f64> {
    Vector3::new(heave, tilt * DEG * (direction * DEG).cos(), tilt * DEG * (direction * DEG).sin())
}

fn determinants(s: &Vector3<f64>) -> (f64, f64, f64) {
    let g = geometry();
    let limbs = Limb::all(&g, &Pose::new(&g, s));
    let jacobian = OverallJacobian::new(&g, &limbs);
    (jacobian.matrix.determinant(), normalized_det_a(&g, &limbs), jacobian.sigma_min())
}

/// Bisection for the heave at which det J changes its sign.
fn singular_heave(tilt: f64, direction: f64, mut low: f64, mut high: f64) -> f64 {
    let f = |z| determinants(&tilted(z, tilt, direction)).0;
    assert!(f(low) * f(high) < 0.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(low) * f(middle) <= 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

proptest! {
    #[test]
    fn pose_is_a_rotation_without_torsion_that_keeps_each_joint_in_its_limbs_plane(
        heave in -0.1..0.2, tilt in 0.0..50.0, direction in 0.0..360.0,
    ) {
        let g = geometry::<f64>();
        let pose = Pose::new(&g, &tilted(heave, tilt, direction));
        prop_assert!((pose.rotation * pose.rotation.transpose() - Matrix3::identity()).amax() < 1e-14);
        prop_assert!((pose.rotation.m12 - pose.rotation.m21).abs() < 1e-16);
        for (limb, lateral) in Limb::all(&g, &pose).iter().zip(g.lateral) {
            prop_assert!((pose.position + limb.arm).dot(&lateral).abs() < 1e-15);
            // B_i by length and angle, the paper's formula
            let b = g.radial.iter().zip(&g.lateral).find(|(_, l)| **l == lateral).unwrap().0
                * (g.base_radius - limb.length * limb.cos) + Vector3::z() * (limb.length * limb.sin);
            prop_assert!((b - pose.position - limb.arm).amax() < 1e-15);
        }
    }

    #[test]
    fn maps_and_bias_accelerations_are_the_derivatives_of_the_pose(
        heave in -0.1..0.2, tilt in 0.0..30.0, direction in 0.0..360.0,
        rates in prop::array::uniform3(-2.0..2.0),
    ) {
        // dual numbers differentiate the same formulas exactly: s(t) = s + s_dot t
        let s = tilted(heave, tilt, direction);
        let s_dot = Vector3::from(rates);
        let g = geometry::<f64>();
        let pose = Pose::new(&g, &s);
        let motion = pose.motion(&g, &s_dot);
        let limbs = Limb::all(&g, &pose);

        let gd = geometry::<Dual64>();
        let sd = s.zip_map(&s_dot, Dual64::new);
        let constant_rate = s_dot.map(Dual64::from);
        let pose_d = Pose::new(&gd, &sd);
        let motion_d = pose_d.motion(&gd, &constant_rate);
        let limbs_d = Limb::all(&gd, &pose_d);

        prop_assert!((pose_d.position.map(|x| x.eps) - motion.velocity).amax() < 1e-14);
        prop_assert!((motion_d.velocity.map(|x| x.eps) - motion.linear_bias).amax() < 1e-13);
        prop_assert!((motion_d.angular_velocity.map(|x| x.eps) - motion.angular_bias).amax() < 1e-13);
        // R_dot = [omega]x R
        let r_dot = pose_d.rotation.map(|x| x.eps);
        prop_assert!((r_dot - motion.angular_velocity.cross_matrix() * pose.rotation).amax() < 1e-14);
        for i in 0..3 {
            let rate = limbs[i].motion(&motion, &s_dot);
            let rate_d = limbs_d[i].motion(&motion_d, &constant_rate);
            prop_assert!((limbs_d[i].length.eps - rate.length_rate).abs() < 1e-13);
            prop_assert!((limbs_d[i].angle().eps - rate.angle_rate).abs() < 1e-12);
            prop_assert!((rate_d.length_rate.eps - rate.length_bias).abs() < 1e-11);
            prop_assert!((rate_d.angle_rate.eps - rate.angle_bias).abs() < 1e-10);
        }
    }

    #[test]
    fn overall_jacobian_maps_the_twist_to_limb_rates_and_its_rate_is_right(
        heave in 0.0..0.15, tilt in 0.0..30.0, direction in 0.0..360.0,
        rates in prop::array::uniform3(-2.0..2.0),
    ) {
        let s = tilted(heave, tilt, direction);
        let s_dot = Vector3::from(rates);
        let g = geometry::<f64>();
        let pose = Pose::new(&g, &s);
        let motion = pose.motion(&g, &s_dot);
        let limbs = Limb::all(&g, &pose);
        let limb_motions = [0, 1, 2].map(|i| limbs[i].motion(&motion, &s_dot));
        let jacobian = OverallJacobian::new(&g, &limbs).matrix;
        let twist = scale_twist(&g, Pose::twist(&motion));
        let x_dot = jacobian * twist;
        for i in 0..3 {
            prop_assert!((x_dot[i] - limb_motions[i].length_rate).abs() < 1e-14);
            prop_assert!(x_dot[3 + i].abs() < 1e-14, "the constraints are kept");
        }
        // J_dot by dual numbers
        let gd = geometry::<Dual64>();
        let pose_d = Pose::new(&gd, &s.zip_map(&s_dot, Dual64::new));
        let jacobian_dot = OverallJacobian::new(&gd, &Limb::all(&gd, &pose_d)).matrix.map(|x| x.eps);
        let expected = jacobian_dot * twist;
        let got = OverallJacobian::rate_times_twist(&limbs, &limb_motions, &motion);
        prop_assert!((expected - got).amax() < 1e-11);
    }
}

#[test]
fn the_paper_s_printed_singular_point_gives_its_printed_position_of_p() {
    // section 6.1, cm and deg
    let lengths = [0.0717, 9.7488, 0.0771].map(|d| d / 100.0);
    let angles = [19.9834, 0.2438, 19.9074].map(|t| t * DEG);
    let p = geometry::<f64>().mean_joint_position(lengths, angles) * 100.0;
    // four decimals are printed, of lengths, angles and P alike: rounding of the output and of the input
    assert_abs_diff_eq!(p.x, 1.6144, epsilon = 1e-4);
    assert_abs_diff_eq!(p.y, -2.7933, epsilon = 1e-4);
    assert_abs_diff_eq!(p.z, 0.0308, epsilon = 1e-4);
}

#[test]
fn the_paper_s_printed_singular_point_is_no_configuration_of_a_rigid_platform() {
    let g = geometry::<f64>();
    let joint = |i: usize, d: f64, theta: f64| {
        g.radial[i] * (g.base_radius - d * (theta * DEG).cos()) + Vector3::z() * d * (theta * DEG).sin()
    };
    // with limb lengths counted from the joints' own distance, so that d = 0 lies at r_b (2.4)
    let offset = g.base_radius - g.joint_radius;
    for with_offset in [0.0, offset] {
        let b = [(0.000717, 19.9834), (0.097488, 0.2438), (0.000771, 19.9074)];
        let joints = [0, 1, 2].map(|i| joint(i, b[i].0 + with_offset, b[i].1));
        let spacing = (joints[0] - joints[1]).norm();
        assert!((spacing - 0.3616).abs() > 0.05, "{spacing}");
    }
}

#[test]
fn default_crossing_s_via_point_is_singular() {
    let heave = singular_heave(8.0, 40.0, 0.04, 0.05);
    // ten printed decimals
    assert_abs_diff_eq!(heave, 0.0452873763, epsilon = 5e-11);
    let (det_j, det_a, sigma_min) = determinants(&tilted(heave, 8.0, 40.0));
    assert!(det_j.abs() < 1e-14 && det_a.abs() < 1e-13 && sigma_min < 1e-13, "{det_j:e} {det_a:e} {sigma_min:e}");
}

#[test]
fn tilt_of_10_deg_in_direction_30_deg_is_singular_at_three_heights() {
    for (heave, low, high) in [(0.0181, 0.01, 0.03), (0.0546, 0.04, 0.07), (-0.0738, -0.09, -0.06)] {
        assert_abs_diff_eq!(singular_heave(10.0, 30.0, low, high), heave, epsilon = 5e-5);
    }
}

#[test]
fn quaternion_is_the_rotation() {
    let g = geometry::<f64>();
    let pose = Pose::new(&g, &tilted(0.05, 23.0, 77.0));
    let q = pose.quaternion();
    let quaternion = nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]);
    assert_relative_eq!(quaternion.norm(), 1.0, epsilon = 1e-15);
    let rotation = nalgebra::UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix();
    assert!((rotation.matrix() - pose.rotation).amax() < 1e-15);
}
