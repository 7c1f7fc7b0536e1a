//! Everything the control law knows at a tick before a damping is chosen.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::{AllowedMotion, Estimate, Gains, Measurement, ReferencePoint};
use crate::dynamics::{MechanismDynamics, PlantModel, current_maps};
use crate::mechanism::{Limb, LimbMotion, OverallJacobian, Pose, scale_twist};
use crate::scalar::Scalar;

/// Kinematics, dynamics and desired acceleration at the estimated state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Situation<T> {
    /// Estimated coordinates (m, rad, rad) and rates.
    pub s: Vector3<T>,
    pub s_dot: Vector3<T>,
    /// Pose at `s`.
    pub pose: Pose<T>,
    /// J (4.1): scaled twist (m/s) to [d_dot; c_dot] (m/s).
    pub jacobian: Matrix6<T>,
    /// q_dot: the twist, rotations scaled by r_b, m/s.
    pub twist: Vector6<T>,
    /// a_d* (4.5b), m/s2.
    pub desired: Vector6<T>,
    /// Joint-side position error x_r - x, m.
    pub error: Vector6<T>,
    /// Reference rate x_r_dot, m/s, and acceleration x_r_ddot, m/s2.
    pub reference_rate: Vector6<T>,
    pub reference_acceleration: Vector6<T>,
    /// J, a_d* and q_dot on the motions that the mechanism can make.
    pub allowed: AllowedMotion<T>,
    /// M and h at the estimated state.
    pub dynamics: MechanismDynamics<T>,
    /// Generalized friction force of the drives, (N, N.m, N.m).
    pub friction: Vector3<T>,
    /// Generalized force per ampere of leg and revolute motors.
    pub leg_map: Matrix3<T>,
    pub revolute_map: Matrix3<T>,
    /// Joint rates, m/s and rad/s.
    pub length_rates: Vector3<T>,
    pub angle_rates: Vector3<T>,
}

impl<T: Scalar> Situation<T> {
    /// At `estimate`, heading for `reference`; the measured acceleration feeds `gains.acceleration`.
    pub fn new(
        model: &PlantModel<T>,
        estimate: &Estimate<T>,
        reference: &ReferencePoint<T>,
        measured: &Measurement<T>,
        gains: &Gains<T>,
    ) -> Self {
        let geometry = &model.geometry;
        let Estimate { s, s_dot } = *estimate;
        let pose = Pose::new(geometry, &s);
        let motion = pose.motion(geometry, &s_dot);
        let limbs = Limb::all(geometry, &pose);
        let limb_motions = Limb::motions(&limbs, &motion, &s_dot);
        let jacobian = OverallJacobian::new(geometry, &limbs).matrix;

        // The reference on the joint side; its constraint displacements are zero for good.
        let reference_pose = Pose::new(geometry, &reference.position);
        let reference_motion = reference_pose.motion(geometry, &reference.rate);
        let (mut error, mut reference_rate, mut reference_acceleration) =
            (Vector6::zeros(), Vector6::zeros(), Vector6::zeros());
        for i in 0..3 {
            let limb = Limb::new(geometry, &reference_pose, i);
            let rates = limb.motion(&reference_motion, &reference.rate);
            error[i] = limb.length - limbs[i].length;
            reference_rate[i] = rates.length_rate;
            reference_acceleration[i] = rates.length_bias + limb.length_gradient.dot(&reference.acceleration);
        }
        // (4.5b); J q_dot is [d_dot; 0] on the mechanism
        let mut desired = reference_acceleration
            + (reference_rate - limb_rates(&limb_motions)) * gains.velocity
            + error * gains.position
            - OverallJacobian::rate_times_twist(&limbs, &limb_motions, &motion);
        // Figure 8: feedback of the acceleration of P
        let reference_linear = reference_motion.linear_bias + reference_pose.linear_map * reference.acceleration;
        let acceleration_error = (reference_linear - measured.acceleration) * gains.acceleration;
        desired += jacobian.fixed_columns::<3>(0) * acceleration_error;

        let twist = scale_twist(geometry, Pose::twist(&motion));
        let allowed = AllowedMotion::new(geometry, (&pose, &motion), &jacobian, &desired, &twist);
        let (leg_map, revolute_map) = current_maps(model, &limbs);
        let length_rates = Vector3::from_fn(|i, _| limb_motions[i].length_rate);
        let angle_rates = Vector3::from_fn(|i, _| limb_motions[i].angle_rate);
        let leg_friction = model.motors.leg.friction(&length_rates);
        let revolute_friction = model.motors.revolute.friction(&angle_rates);
        let mut friction = Vector3::zeros();
        for i in 0..3 {
            friction += limbs[i].length_gradient * leg_friction[i] + limbs[i].angle_gradient * revolute_friction[i];
        }
        Self {
            s,
            s_dot,
            pose,
            jacobian,
            twist,
            desired,
            error,
            reference_rate,
            reference_acceleration,
            allowed,
            dynamics: model.bodies.dynamics(&pose, &motion, &limbs, &limb_motions, &model.motors),
            friction,
            leg_map,
            revolute_map,
            length_rates,
            angle_rates,
        }
    }

    /// Generalized force that s_ddot takes: M s_ddot + h + friction (4.4).
    #[inline]
    pub fn generalized_force(&self, s_ddot: &Vector3<T>) -> Vector3<T> {
        self.dynamics.mass_matrix * s_ddot + self.dynamics.bias + self.friction
    }
}

fn limb_rates<T: Scalar>(motions: &[LimbMotion<T>; 3]) -> Vector6<T> {
    let mut rates = Vector6::zeros();
    for (i, motion) in motions.iter().enumerate() {
        rates[i] = motion.length_rate;
    }
    rates
}
