//! The control law's variables on the motions that the mechanism can make.
//!
//! The scheme chooses a platform acceleration with six components, of which the revolute joints
//! allow three: q_ddot = T s_ddot + T_dot s_dot. So (4.11) is minimized over these. In an
//! orthonormal basis Q of the twists T s_dot the problem keeps its form with three unknowns,
//!
//! ```text
//! y = Q^T q_ddot,   min |J Q y - a|^2 + rho^2 |y + rho_hd Q^T q_dot|^2,   a = a_d* - J (I - Q Q^T) T_dot s_dot,
//! ```
//!
//! and with it (4.10) and (4.14)-(4.18). Its optimum is the free one of (4.14) projected in the metric
//! J^T J + rho^2 I of the Lyapunov function (5.2), which is why (5.6) holds on the mechanism; a projection
//! in the plain metric adds a term of either sign to it. (The constraint rows of J Q are zero.)

use nalgebra::{Matrix3, Matrix6, Matrix6x3, Vector3, Vector6};

use crate::mechanism::{Geometry, Pose, PoseMotion, scale_twist};
use crate::scalar::Scalar;

/// J, a_d* and q_dot in an orthonormal basis of the allowed twists.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AllowedMotion<T> {
    /// Limb rows of J Q, dimensionless.
    pub jacobian: Matrix3<T>,
    /// Limb rows of a_d* - J (I - Q Q^T) T_dot s_dot, m/s2.
    pub desired: Vector3<T>,
    /// Q^T q_dot, m/s.
    pub twist: Vector3<T>,
    /// L^-T with T^T T = L L^T: s_ddot = L^-T y - T^+ T_dot s_dot.
    pub to_coordinates: Matrix3<T>,
    /// T^+ T_dot s_dot, (m, rad, rad)/s2.
    pub coordinate_bias: Vector3<T>,
}

impl<T: Scalar> AllowedMotion<T> {
    /// From the full J, a_d* (m/s2) and q_dot (m/s) at a pose in motion.
    pub fn new(
        geometry: &Geometry<T>,
        (pose, motion): (&Pose<T>, &PoseMotion<T>),
        jacobian: &Matrix6<T>,
        desired: &Vector6<T>,
        twist: &Vector6<T>,
    ) -> Self {
        let mut map = Matrix6x3::zeros();
        map.fixed_rows_mut::<3>(0).copy_from(&pose.linear_map);
        map.fixed_rows_mut::<3>(3).copy_from(&(pose.angular_map * geometry.joint_radius));
        let to_coordinates = inverse_transposed_factor(&map.tr_mul(&map));
        let basis = map * to_coordinates;
        let bias = scale_twist(geometry, Pose::twist_bias(motion));
        let bias_within = basis.tr_mul(&bias);
        let desired = desired - jacobian * (bias - basis * bias_within);
        Self {
            jacobian: jacobian.fixed_rows::<3>(0) * basis,
            desired: desired.fixed_rows::<3>(0).into(),
            twist: basis.tr_mul(twist),
            to_coordinates,
            coordinate_bias: to_coordinates * bias_within,
        }
    }

    /// s_ddot that belongs to the acceleration `y` (m/s2) in the basis.
    #[inline]
    pub fn coordinate_acceleration(&self, y: &Vector3<T>) -> Vector3<T> {
        self.to_coordinates * y - self.coordinate_bias
    }
}

/// L^-T of a positive definite m = L L^T.
fn inverse_transposed_factor<T: Scalar>(m: &Matrix3<T>) -> Matrix3<T> {
    let l11 = m.m11.sqrt();
    let (l21, l31) = (m.m21 / l11, m.m31 / l11);
    let l22 = (m.m22 - l21 * l21).sqrt();
    let l32 = (m.m32 - l31 * l21) / l22;
    let l33 = (m.m33 - l31 * l31 - l32 * l32).sqrt();
    let (i11, i22, i33) = (l11.recip(), l22.recip(), l33.recip());
    let i21 = -l21 * i11 * i22;
    let i32 = -l32 * i22 * i33;
    let i31 = -(l31 * i11 + l32 * i21) * i33;
    let zero = T::zero();
    Matrix3::new(i11, i21, i31, zero, i22, i32, zero, zero, i33)
}
