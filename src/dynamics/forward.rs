//! Forward dynamics: the plant's right-hand side x_dot = f(x, u).

use nalgebra::{Matrix3, Vector3};

use super::state::{coordinates, currents, rates};
use super::{Inputs, MechanismDynamics, PlantModel, PlantState};
use crate::mechanism::{Limb, LimbMotion, Pose, PoseMotion};
use crate::scalar::Scalar;

/// Kinematics and dynamics at one state; everything that outputs are made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation<T> {
    pub pose: Pose<T>,
    pub motion: PoseMotion<T>,
    pub limbs: [Limb<T>; 3],
    pub limb_motions: [LimbMotion<T>; 3],
    pub dynamics: MechanismDynamics<T>,
    /// Forces of the leg drives on their limbs, friction and end stops included but not the rotors' inertia, N.
    pub leg_forces: Vector3<T>,
    /// Torques of the revolute drives, likewise, N.m.
    pub revolute_torques: Vector3<T>,
    /// s_ddot, (m, rad, rad)/s2.
    pub acceleration: Vector3<T>,
    /// x_dot.
    pub derivative: PlantState<T>,
}

/// Everything at state `x` under `inputs`.
#[inline(always)] // into `derivative`, which needs a part of it alone
pub fn evaluate<T: Scalar>(model: &PlantModel<T>, x: &PlantState<T>, inputs: &Inputs<T>) -> Evaluation<T> {
    let (s, s_dot) = (coordinates(x), rates(x));
    let (i_leg, i_rev) = currents(x);
    let pose = Pose::new(&model.geometry, &s);
    let motion = pose.motion(&model.geometry, &s_dot);
    let limbs = Limb::all(&model.geometry, &pose);
    let limb_motions = Limb::motions(&limbs, &motion, &s_dot);
    let motors = &model.motors;
    let dynamics = model.bodies.dynamics(&pose, &motion, &limbs, &limb_motions, motors);
    let length_rates = Vector3::from_fn(|i, _| limb_motions[i].length_rate);
    let angle_rates = Vector3::from_fn(|i, _| limb_motions[i].angle_rate);

    let mut leg_forces = i_leg * motors.leg.force_constant - motors.leg.friction(&length_rates);
    // open circuits carry no current: i_rev stays zero without revolute motors
    let mut revolute_torques = i_rev * motors.revolute.force_constant - motors.revolute.friction(&angle_rates);
    if let Some(stops) = &model.stops {
        for i in 0..3 {
            leg_forces[i] += stops.length.force(limbs[i].length, length_rates[i]);
            revolute_torques[i] += stops.torque(&limbs[i], angle_rates[i]);
        }
    }
    let mut force = pose.generalized_force(&inputs.force, &inputs.moment) - dynamics.bias;
    for i in 0..3 {
        force += limbs[i].length_gradient * leg_forces[i] + limbs[i].angle_gradient * revolute_torques[i];
    }
    let acceleration = solve_positive_definite(&dynamics.mass_matrix, &force);

    let leg_rates = motors.current_rates(&motors.leg, &inputs.v_leg, &i_leg, &length_rates);
    let rev_rates = if motors.revolute_motors {
        motors.current_rates(&motors.revolute, &inputs.v_rev, &i_rev, &angle_rates)
    } else {
        Vector3::zeros()
    };
    let mut derivative = PlantState::zeros();
    for i in 0..3 {
        derivative[i] = s_dot[i];
        derivative[3 + i] = acceleration[i];
        derivative[6 + i] = leg_rates[i];
        derivative[9 + i] = rev_rates[i];
    }
    Evaluation { pose, motion, limbs, limb_motions, dynamics, leg_forces, revolute_torques, acceleration, derivative }
}

/// The right-hand side x_dot = f(x, u).
#[inline(never)] // large, and called seven times by a solver's step
pub fn derivative<T: Scalar>(model: &PlantModel<T>, x: &PlantState<T>, inputs: &Inputs<T>) -> PlantState<T> {
    evaluate(model, x, inputs).derivative
}

/// The generalized force (N, N.m, N.m) that the motors must exert to hold the pose of `x` at rest
/// under the loads of `inputs` and the end stops.
pub fn static_load<T: Scalar>(model: &PlantModel<T>, s: &Vector3<T>, inputs: &Inputs<T>) -> Vector3<T> {
    let mut x = PlantState::zeros();
    for i in 0..3 {
        x[i] = s[i];
    }
    let at_rest = evaluate(model, &x, inputs);
    // without currents M s_ddot = -(load)
    -(at_rest.dynamics.mass_matrix * at_rest.acceleration)
}

/// Currents (leg, revolute; A) that hold the pose `s` at rest: of smallest norm with six motors,
/// unique with three. `None` where three motors cannot (direct singularity) or a motor would need
/// more than its voltage limit.
pub fn settled_currents<T: Scalar>(
    model: &PlantModel<T>,
    s: &Vector3<T>,
    inputs: &Inputs<T>,
) -> Option<(Vector3<T>, Vector3<T>)> {
    let load = static_load(model, s, inputs);
    let pose = Pose::new(&model.geometry, s);
    let limbs = Limb::all(&model.geometry, &pose);
    let (leg_map, revolute_map) = current_maps(model, &limbs);
    let (leg, revolute) = if model.motors.revolute_motors {
        let gram = leg_map * leg_map.transpose() + revolute_map * revolute_map.transpose();
        let multiplier = solve_positive_definite(&gram, &load);
        (leg_map.tr_mul(&multiplier), revolute_map.tr_mul(&multiplier))
    } else {
        (leg_map.try_inverse()? * load, Vector3::zeros())
    };
    let limit = model.motors.v_max / model.motors.resistance;
    (leg.amax() <= limit && revolute.amax() <= limit).then_some((leg, revolute))
}

/// Generalized force (N, N.m, N.m) per ampere of the leg and of the revolute motors, 3x3 each.
pub fn current_maps<T: Scalar>(model: &PlantModel<T>, limbs: &[Limb<T>; 3]) -> (Matrix3<T>, Matrix3<T>) {
    let columns = |gradient: fn(&Limb<T>) -> Vector3<T>, constant: T| {
        Matrix3::from_columns(&[0, 1, 2].map(|i| gradient(&limbs[i]) * constant))
    };
    (
        columns(|limb| limb.length_gradient, model.motors.leg.force_constant),
        columns(|limb| limb.angle_gradient, model.motors.revolute.force_constant),
    )
}

/// Solves m x = b for symmetric positive definite m by its Cholesky factorization m = L D L^T.
#[inline]
pub fn solve_positive_definite<T: Scalar>(m: &Matrix3<T>, b: &Vector3<T>) -> Vector3<T> {
    let inverse_1 = m.m11.recip();
    let (l21, l31) = (m.m21 * inverse_1, m.m31 * inverse_1);
    let inverse_2 = (m.m22 - l21 * m.m21).recip();
    let l32 = (m.m32 - l31 * m.m21) * inverse_2;
    let inverse_3 = (m.m33 - l31 * m.m31 - l32 * (m.m32 - l31 * m.m21)).recip();
    let y2 = b.y - l21 * b.x;
    let y3 = b.z - l31 * b.x - l32 * y2;
    let z = y3 * inverse_3;
    let y = y2 * inverse_2 - l32 * z;
    Vector3::new(b.x * inverse_1 - l21 * y - l31 * z, y, z)
}
