//! One limb: the revolute-prismatic chain from A_i to B_i, in its plane.

use nalgebra::Vector3;

use super::{Geometry, Pose, PoseMotion};
use crate::scalar::Scalar;

/// A limb at a pose of the platform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limb<T> {
    /// From P to B_i, base frame, m.
    pub arm: Vector3<T>,
    /// Length d_i, m.
    pub length: T,
    /// sin theta_i, theta_i from the horizontal.
    pub sin: T,
    /// cos theta_i; positive while the limb leans inwards.
    pub cos: T,
    /// Unit vector from A_i to B_i.
    pub axial: Vector3<T>,
    /// Unit vector in the limb's plane, in the direction B_i moves when theta_i grows.
    pub normal: Vector3<T>,
    /// Unit normal n_i of the limb's plane.
    pub lateral: Vector3<T>,
    /// d(d_i)/ds, m per (m, rad, rad).
    pub length_gradient: Vector3<T>,
    /// d(theta_i)/ds, rad per (m, rad, rad).
    pub angle_gradient: Vector3<T>,
}

/// Rates of a limb, and its accelerations when s_ddot = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimbMotion<T> {
    /// d_i_dot, m/s.
    pub length_rate: T,
    /// theta_i_dot, rad/s.
    pub angle_rate: T,
    /// d_i_ddot at s_ddot = 0, m/s2.
    pub length_bias: T,
    /// theta_i_ddot at s_ddot = 0, rad/s2.
    pub angle_bias: T,
}

impl<T: Scalar> Limb<T> {
    /// Limb `i` (0, 1, 2) at `pose`.
    #[inline]
    pub fn new(geometry: &Geometry<T>, pose: &Pose<T>, i: usize) -> Self {
        let (radial, lateral) = (geometry.radial[i], geometry.lateral[i]);
        let r = &pose.rotation;
        let arm = Vector3::new(
            r.m11 * radial.x + r.m12 * radial.y,
            r.m21 * radial.x + r.m22 * radial.y,
            r.m31 * radial.x + r.m32 * radial.y,
        ) * geometry.joint_radius;
        let line = pose.position + arm - radial * geometry.base_radius;
        let length = line.norm();
        let axial = line / length;
        let sin = axial.z;
        let cos = -(axial.x * radial.x + axial.y * radial.y);
        let normal = Vector3::new(sin * radial.x, sin * radial.y, cos);
        let gradient = |direction: &Vector3<T>| pose.generalized_force(direction, &arm.cross(direction));
        Self {
            arm,
            length,
            sin,
            cos,
            axial,
            normal,
            lateral,
            length_gradient: gradient(&axial),
            angle_gradient: gradient(&normal) / length,
        }
    }

    /// All three limbs.
    #[inline]
    pub fn all(geometry: &Geometry<T>, pose: &Pose<T>) -> [Self; 3] {
        [Self::new(geometry, pose, 0), Self::new(geometry, pose, 1), Self::new(geometry, pose, 2)]
    }

    /// The angle theta_i, rad.
    pub fn angle(&self) -> T {
        self.sin.angle_beside(self.cos)
    }

    /// Motions of all three limbs.
    #[inline]
    pub fn motions(limbs: &[Self; 3], pose_motion: &PoseMotion<T>, s_dot: &Vector3<T>) -> [LimbMotion<T>; 3] {
        let [a, b, c] = limbs;
        [a.motion(pose_motion, s_dot), b.motion(pose_motion, s_dot), c.motion(pose_motion, s_dot)]
    }

    /// Rates and bias accelerations at the platform's motion and rates `s_dot`.
    #[inline]
    pub fn motion(&self, pose_motion: &PoseMotion<T>, s_dot: &Vector3<T>) -> LimbMotion<T> {
        let length_rate = self.length_gradient.dot(s_dot);
        let angle_rate = self.angle_gradient.dot(s_dot);
        let bias = pose_motion.linear_bias
            + pose_motion.angular_bias.cross(&self.arm)
            + self.centripetal(&pose_motion.angular_velocity);
        // polar components of B_i's acceleration
        LimbMotion {
            length_rate,
            angle_rate,
            length_bias: self.axial.dot(&bias) + self.length * angle_rate * angle_rate,
            angle_bias: (self.normal.dot(&bias) - (length_rate + length_rate) * angle_rate) / self.length,
        }
    }

    /// omega x (omega x arm), m/s2.
    #[inline]
    pub fn centripetal(&self, angular_velocity: &Vector3<T>) -> Vector3<T> {
        angular_velocity * angular_velocity.dot(&self.arm) - self.arm * angular_velocity.norm_squared()
    }
}
