//! The mechanism's constant geometry.

use nalgebra::Vector3;

use crate::scalar::{Scalar, constant};

/// Base and platform geometry. Lengths in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry<T> {
    /// Radius a of the circle of the revolute joints A_i, m.
    pub base_radius: T,
    /// Radius r_b = w / sqrt(3) of the circle of the spherical joints B_i, m.
    pub joint_radius: T,
    /// Radial unit vectors e_i of the limbs' planes.
    pub radial: [Vector3<T>; 3],
    /// Unit vectors n_i = z x e_i along the revolute joints, normal to the limbs' planes.
    pub lateral: [Vector3<T>; 3],
}

impl<T: Scalar> Geometry<T> {
    /// From the base circle's radius a and the spherical joints' spacing w, both in m.
    pub fn new(base_radius: T, joint_spacing: T) -> Self {
        let half_sqrt_3 = 0.5 * 3.0_f64.sqrt();
        let directions = [(1.0, 0.0), (-0.5, half_sqrt_3), (-0.5, -half_sqrt_3)];
        let vector = |x: f64, y: f64| Vector3::new(constant(x), constant(y), T::zero());
        Self {
            base_radius,
            joint_radius: joint_spacing / constant(3.0_f64.sqrt()),
            radial: directions.map(|(c, s)| vector(c, s)),
            lateral: directions.map(|(c, s)| vector(-s, c)),
        }
    }

    /// Position of P, m, from limb lengths (m) and angles (rad): mean(B_i), without asking
    /// whether the three points fit a rigid platform. The paper's P formula (section 6.1).
    pub fn mean_joint_position(&self, lengths: [T; 3], angles: [T; 3]) -> Vector3<T> {
        let [a, b, c] = self.joints(lengths, angles);
        (a + b + c) / constant::<T>(3.0)
    }

    /// (heave in m, tilt_x, tilt_y in rad) of the plane through the three B_i, from limb lengths (m) and angles (rad):
    /// the pose of readings that fit one, without a guess.
    pub fn pose_of_joints(&self, lengths: [T; 3], angles: [T; 3]) -> Vector3<T> {
        let [a, b, c] = self.joints(lengths, angles);
        let normal = (b - a).cross(&(c - a));
        let horizontal = (normal.x * normal.x + normal.y * normal.y).sqrt();
        let heave = (a.z + b.z + c.z) / constant::<T>(3.0);
        if horizontal > T::zero() {
            let scale = horizontal.angle_beside(normal.z) / horizontal;
            Vector3::new(heave, -normal.y * scale, normal.x * scale)
        } else {
            Vector3::new(heave, T::zero(), T::zero())
        }
    }

    /// Positions of the B_i, m.
    fn joints(&self, lengths: [T; 3], angles: [T; 3]) -> [Vector3<T>; 3] {
        std::array::from_fn(|i| {
            let (sin, cos) = angles[i].sine_cosine();
            let mut joint = self.radial[i] * (self.base_radius - lengths[i] * cos);
            joint.z += lengths[i] * sin;
            joint
        })
    }
}
