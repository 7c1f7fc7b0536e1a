//! The overall Jacobian of the limited-degree-of-freedom mechanism (Joshi & Tsai 2002): it maps the
//! platform's twist to the three limb rates and the three rates of the constraint displacements
//! c_i = n_i . B_i. It is the paper's J (4.1), singular exactly at direct singularities.

use nalgebra::{Matrix6, Vector6};

use super::{Geometry, Limb, LimbMotion, PoseMotion, SingularValues};
use crate::scalar::Scalar;

/// J and J_dot q_dot, rotations scaled by the characteristic length r_b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OverallJacobian<T> {
    /// J: [d_dot; c_dot] (m/s) = J [v; r_b omega] (m/s); dimensionless.
    pub matrix: Matrix6<T>,
}

impl<T: Scalar> OverallJacobian<T> {
    /// At a pose, from its limbs.
    #[inline]
    pub fn new(geometry: &Geometry<T>, limbs: &[Limb<T>; 3]) -> Self {
        let mut matrix = Matrix6::zeros();
        for (i, limb) in limbs.iter().enumerate() {
            for (row, direction) in [(i, limb.axial), (3 + i, limb.lateral)] {
                let moment = limb.arm.cross(&direction) / geometry.joint_radius;
                for k in 0..3 {
                    matrix[(row, k)] = direction[k];
                    matrix[(row, 3 + k)] = moment[k];
                }
            }
        }
        Self { matrix }
    }

    /// J_dot q_dot, m/s2: what [d_ddot; c_ddot] is beyond J q_ddot (4.2).
    #[inline]
    pub fn rate_times_twist(
        limbs: &[Limb<T>; 3],
        limb_motions: &[LimbMotion<T>; 3],
        motion: &PoseMotion<T>,
    ) -> Vector6<T> {
        let mut result = Vector6::zeros();
        for i in 0..3 {
            let (limb, rates) = (&limbs[i], &limb_motions[i]);
            let centripetal = limb.centripetal(&motion.angular_velocity);
            result[i] = limb.axial.dot(&centripetal) + limb.length * rates.angle_rate * rates.angle_rate;
            result[3 + i] = limb.lateral.dot(&centripetal);
        }
        result
    }
}

impl<T: SingularValues> OverallJacobian<T> {
    /// Smallest singular value, dimensionless.
    pub fn sigma_min(&self) -> T {
        T::sigma_min(&self.matrix)
    }
}

/// The twist (m/s, rad/s) with its angular part times r_b, the paper's q_dot made commensurate.
#[inline]
pub fn scale_twist<T: Scalar>(geometry: &Geometry<T>, mut twist: Vector6<T>) -> Vector6<T> {
    for k in 3..6 {
        twist[k] *= geometry.joint_radius;
    }
    twist
}
