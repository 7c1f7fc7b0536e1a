//! The platform's pose, velocity and bias acceleration from the generalized coordinates.

use nalgebra::{Matrix3, Vector3, Vector4, Vector6};

use super::{ExponentialCoefficients, Geometry};
use crate::scalar::{Scalar, constant};

/// Pose of the platform at s = (heave, tilt_x, tilt_y).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose<T> {
    coefficients: ExponentialCoefficients<T>,
    tilt: [T; 2],
    /// Position of P, base frame, m.
    pub position: Vector3<T>,
    /// Orientation R: platform frame to base frame.
    pub rotation: Matrix3<T>,
    /// dP/ds, m per (m, rad, rad): velocity of P = `linear_map` s_dot.
    pub linear_map: Matrix3<T>,
    /// Angular velocity = `angular_map` s_dot, rad/s, base frame.
    pub angular_map: Matrix3<T>,
}

/// Velocity of the platform, and its acceleration when s_ddot = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseMotion<T> {
    /// Velocity of P, m/s.
    pub velocity: Vector3<T>,
    /// Angular velocity, base frame, rad/s.
    pub angular_velocity: Vector3<T>,
    /// Acceleration of P at s_ddot = 0, m/s2.
    pub linear_bias: Vector3<T>,
    /// Angular acceleration at s_ddot = 0, rad/s2.
    pub angular_bias: Vector3<T>,
}

impl<T: Scalar> Pose<T> {
    /// Pose at `s` = (heave in m, tilt_x, tilt_y in rad).
    ///
    /// The revolute joints keep each B_i in its limb's plane; with the zero-torsion orientation
    /// exp([x, y, 0]x) this holds exactly when P_x = r_b/2 (R11 - R22) and P_y = -r_b R21.
    #[inline]
    pub fn new(geometry: &Geometry<T>, s: &Vector3<T>) -> Self {
        let (heave, x, y) = (s.x, s.y, s.z);
        let (one, zero) = (T::one(), T::zero());
        let r_b = geometry.joint_radius;
        let half = r_b * constant(0.5);
        let (xx, xy, yy) = (x * x, x * y, y * y);
        let coefficients = ExponentialCoefficients::at(xx + yy);
        let ExponentialCoefficients { a, b, c, b_u, .. } = coefficients;
        let difference = xx - yy;
        let two_b_u = b_u + b_u;
        let two_b = b + b;
        Self {
            coefficients,
            tilt: [x, y],
            position: Vector3::new(half * b * difference, -r_b * b * xy, heave),
            rotation: Matrix3::new(
                one - b * yy,
                b * xy,
                a * y, //
                b * xy,
                one - b * xx,
                -a * x, //
                -a * y,
                a * x,
                one - b * (xx + yy),
            ),
            linear_map: Matrix3::new(
                zero,
                half * x * (two_b_u * difference + two_b),
                half * y * (two_b_u * difference - two_b), //
                zero,
                -r_b * y * (two_b_u * xx + b),
                -r_b * x * (two_b_u * yy + b), //
                one,
                zero,
                zero,
            ),
            angular_map: Matrix3::new(
                zero,
                one - c * yy,
                c * xy, //
                zero,
                c * xy,
                one - c * xx, //
                zero,
                -b * y,
                b * x,
            ),
        }
    }

    /// Velocity and bias acceleration at the rates `s_dot`, (m, rad, rad)/s.
    #[inline]
    pub fn motion(&self, geometry: &Geometry<T>, s_dot: &Vector3<T>) -> PoseMotion<T> {
        let [x, y] = self.tilt;
        let (x_dot, y_dot) = (s_dot.y, s_dot.z);
        let ExponentialCoefficients { b, c, b_u, b_uu, c_u, .. } = self.coefficients;
        let two = constant::<T>(2.0);
        let r_b = geometry.joint_radius;
        let u_dot = two * (x * x_dot + y * y_dot);
        let u_ddot = two * (x_dot * x_dot + y_dot * y_dot);
        let (b_dot, b_ddot) = (b_u * u_dot, b_uu * u_dot * u_dot + b_u * u_ddot);
        let c_dot = c_u * u_dot;
        // P_x / (r_b/2) = b p, P_y / (-r_b) = b q with p = x^2 - y^2, q = x y
        let (p, p_dot, p_ddot) = (x * x - y * y, two * (x * x_dot - y * y_dot), two * (x_dot * x_dot - y_dot * y_dot));
        let (q, q_dot, q_ddot) = (x * y, x_dot * y + x * y_dot, two * x_dot * y_dot);
        let z = x * y_dot - y * x_dot;
        PoseMotion {
            velocity: self.linear_map * s_dot,
            angular_velocity: self.angular_map * s_dot,
            linear_bias: Vector3::new(
                r_b * constant(0.5) * (b_ddot * p + two * b_dot * p_dot + b * p_ddot),
                -r_b * (b_ddot * q + two * b_dot * q_dot + b * q_ddot),
                T::zero(),
            ),
            angular_bias: Vector3::new((c_dot * y + c * y_dot) * z, -(c_dot * x + c * x_dot) * z, b_dot * z),
        }
    }

    /// Generalized force of a `force` at P (N) and a `moment` (N.m), base frame: the transposed maps
    /// times them. Heave moves P along z alone and tilt does not, which halves the work.
    #[inline]
    pub fn generalized_force(&self, force: &Vector3<T>, moment: &Vector3<T>) -> Vector3<T> {
        let (l, a) = (&self.linear_map, &self.angular_map);
        Vector3::new(
            force.z,
            l.m12 * force.x + l.m22 * force.y + a.m12 * moment.x + a.m22 * moment.y + a.m32 * moment.z,
            l.m13 * force.x + l.m23 * force.y + a.m13 * moment.x + a.m23 * moment.y + a.m33 * moment.z,
        )
    }

    /// Orientation as a unit quaternion (w, x, y, z) with w >= 0 for tilts up to 180 deg.
    pub fn quaternion(&self) -> Vector4<T> {
        let [x, y] = self.tilt;
        // half the angle: cos(t/2), sin(t/2)/t
        let half = constant::<T>(0.5);
        let quarter = ExponentialCoefficients::at((x * x + y * y) * constant(0.25));
        let w = T::one() - quarter.b * (x * x + y * y) * constant(0.25);
        Vector4::new(w, quarter.a * half * x, quarter.a * half * y, T::zero())
    }

    /// The 6x3 map from s_dot to the twist times `s_dot`, stacked (m/s, rad/s).
    pub fn twist(motion: &PoseMotion<T>) -> Vector6<T> {
        stack(&motion.velocity, &motion.angular_velocity)
    }

    /// The twist's rate at s_ddot = 0, stacked (m/s2, rad/s2).
    pub fn twist_bias(motion: &PoseMotion<T>) -> Vector6<T> {
        stack(&motion.linear_bias, &motion.angular_bias)
    }
}

fn stack<T: Scalar>(linear: &Vector3<T>, angular: &Vector3<T>) -> Vector6<T> {
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}
