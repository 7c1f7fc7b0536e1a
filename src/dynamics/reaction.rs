//! Forces in the spherical joints.

use nalgebra::{Matrix3, Vector3};

use super::{Evaluation, Inputs, PlantModel};
use crate::scalar::Scalar;

/// Force of each limb on the platform at B_i, by components in the limb's frame, N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reactions<T> {
    /// Along the limb, from A_i to B_i.
    pub axial: Vector3<T>,
    /// In the limb's plane, normal to it.
    pub normal: Vector3<T>,
    /// Along n_i, out of the limb's plane.
    pub lateral: Vector3<T>,
}

/// The nine joint forces at an evaluated state.
///
/// With the motor currents known, the limbs' own equations give the in-plane forces, whatever the
/// pose; the out-of-plane forces follow from the platform's balance (6.7)-(6.9), in which they are
/// independent of each other at every pose. So nothing here degenerates at a direct singularity,
/// unlike D F = Q of Appendix A.
pub fn reactions<T: Scalar>(model: &PlantModel<T>, evaluation: &Evaluation<T>, inputs: &Inputs<T>) -> Reactions<T> {
    let Evaluation { pose, motion, limbs, limb_motions, acceleration, .. } = evaluation;
    let (bodies, motors) = (&model.bodies, &model.motors);
    let mut axial = Vector3::zeros();
    let mut normal = Vector3::zeros();
    let linear = motion.linear_bias + pose.linear_map * acceleration;
    let angular = motion.angular_bias + pose.angular_map * acceleration;
    let (mut force, mut moment) = bodies.plate_wrench(pose, &motion.angular_velocity, &linear, &angular);
    force -= inputs.force;
    moment -= inputs.moment;
    for i in 0..3 {
        let (limb, rates) = (&limbs[i], &limb_motions[i]);
        let (along, about) = bodies.limb_bias(limb, rates);
        let length_acceleration = rates.length_bias + limb.length_gradient.dot(acceleration);
        let angle_acceleration = rates.angle_bias + limb.angle_gradient.dot(acceleration);
        axial[i] =
            evaluation.leg_forces[i] - along - (bodies.upper_mass + motors.leg.reflected_inertia) * length_acceleration;
        // (6.6)
        normal[i] = (evaluation.revolute_torques[i]
            - about
            - (bodies.limb_inertia(limb) + motors.revolute.reflected_inertia) * angle_acceleration)
            / limb.length;
        let in_plane = limb.axial * axial[i] + limb.normal * normal[i];
        force -= in_plane;
        moment -= limb.arm.cross(&in_plane);
    }
    Reactions { axial, normal, lateral: lateral_forces(model, evaluation, &force, &moment) }
}

/// Out-of-plane forces that balance the rest (`force`, `moment` about P) of the platform's wrench:
/// least squares over the six equations, of which three are then met by the choice of s_ddot.
fn lateral_forces<T: Scalar>(
    model: &PlantModel<T>,
    evaluation: &Evaluation<T>,
    force: &Vector3<T>,
    moment: &Vector3<T>,
) -> Vector3<T> {
    let r_b = model.geometry.joint_radius;
    let columns = evaluation.limbs.map(|limb| (limb.lateral, limb.arm.cross(&limb.lateral) / r_b));
    let scaled_moment = moment / r_b;
    let gram = Matrix3::from_fn(|i, j| columns[i].0.dot(&columns[j].0) + columns[i].1.dot(&columns[j].1));
    let right = Vector3::from_fn(|i, _| columns[i].0.dot(force) + columns[i].1.dot(&scaled_moment));
    super::forward::solve_positive_definite(&gram, &right)
}
