//! Joint forces by Newton and Euler, D F = Q (section 2.1, Appendix A), completed.
//!
//! The printed D has the three axial forces alone as unknowns: six equations by three, so no
//! D^-1. The out-of-plane forces at the spherical joints are unknown as well, and with them the
//! matrix is square: it is the transpose of the overall Jacobian. Forces in the limbs' planes
//! normal to them follow from the limbs' own equations (6.5), (6.6) and belong to Q.

use nalgebra::{Vector3, Vector6};

use super::{Evaluation, Inputs, PlantModel, Reactions, reactions};
use crate::mechanism::OverallJacobian;
use crate::svd::Svd;

/// Joint forces of a motion, and how far they can be trusted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointForces {
    /// Forces of the limbs on the platform, N.
    pub reactions: Reactions<f64>,
    /// Forces that the leg drives must exert on their limbs (2.1), N.
    pub leg_forces: Vector3<f64>,
    /// Ratio of D's largest to its smallest singular value: relative errors of Q may grow by it.
    /// At most 1 / machine epsilon.
    pub condition: f64,
    /// Number of singular values above [`JointForces::CUTOFF`] times the largest; 6 when regular.
    pub rank: usize,
    /// Norm of the part of Q (N; moments over r_b) that no joint forces balance; rounding error
    /// when regular.
    pub residual: f64,
}

impl JointForces {
    /// Singular values below this fraction of the largest count as zero.
    ///
    /// Closer to a direct singularity the forces along the degenerate direction are not
    /// determined by the platform's balance; they are then set to zero (solution of least norm),
    /// so the result is always finite. [`super::reactions`] gets them from the motors' currents
    /// instead, where those are known.
    pub const CUTOFF: f64 = 1e-9;
}

/// Solves D F = Q for the motion of `evaluation`: its pose, rates and `acceleration`, with the
/// revolute drives' torques of it, but whatever the leg drives' forces are: these are results.
pub fn joint_forces(model: &PlantModel<f64>, evaluation: &Evaluation<f64>, inputs: &Inputs<f64>) -> JointForces {
    let Evaluation { pose, motion, limbs, acceleration, .. } = evaluation;
    let r_b = model.geometry.joint_radius;
    // the limbs' own equations (6.5), (6.6), with whatever leg forces the evaluation has
    let limb_equations = reactions(model, evaluation, inputs);
    let normal = limb_equations.normal;
    let linear = motion.linear_bias + pose.linear_map * acceleration;
    let angular = motion.angular_bias + pose.angular_map * acceleration;
    let (mut force, mut moment) = model.bodies.plate_wrench(pose, &motion.angular_velocity, &linear, &angular);
    force -= inputs.force;
    moment -= inputs.moment;
    for (limb, magnitude) in limbs.iter().zip(&normal) {
        let known = limb.normal * *magnitude;
        force -= known;
        moment -= limb.arm.cross(&known);
    }
    moment /= r_b;
    // Q_1 .. Q_6 of (A.2), forces first, in the base frame
    let q = Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
    let d = OverallJacobian::new(&model.geometry, limbs).matrix.transpose();
    let svd = Svd::new(&d);
    let f = svd.pseudo_inverse(JointForces::CUTOFF) * q;
    let axial = f.fixed_rows::<3>(0).into_owned();
    JointForces {
        reactions: Reactions { axial, normal, lateral: f.fixed_rows::<3>(3).into_owned() },
        // (2.1): beyond the axial force what the limb itself takes, its inertia included
        leg_forces: axial + (evaluation.leg_forces - limb_equations.axial),
        condition: svd.condition(),
        rank: svd.rank(JointForces::CUTOFF),
        residual: (q - d * f).norm(),
    }
}
