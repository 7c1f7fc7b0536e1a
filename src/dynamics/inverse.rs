//! Inverse dynamics: what a given motion of the platform demands of the motors (section 6).

use nalgebra::{Matrix3x6, Vector3, Vector6};
use num_dual::Dual64;

use super::{
    Drive, Inputs, JointForces, MechanismParameters, PlantModel, current_maps, evaluate, joint_forces, moving,
};
use crate::svd::Svd;

/// One instant of a trajectory in s = (heave, tilt_x, tilt_y).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrajectoryPoint {
    /// s, (m, rad, rad).
    pub position: Vector3<f64>,
    /// s_dot, per s.
    pub velocity: Vector3<f64>,
    /// s_ddot, per s2.
    pub acceleration: Vector3<f64>,
    /// The third derivative, per s3; the voltages' inductive part depends on it.
    pub jerk: Vector3<f64>,
}

/// Demands on three motors of one kind.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DriveDemand {
    /// Force (N) or torque (N.m) of the motor at the joint.
    pub joint: Vector3<f64>,
    /// Torque at the rotor, K_t i, N.m.
    pub torque: Vector3<f64>,
    /// Armature current, A.
    pub current: Vector3<f64>,
    /// Terminal voltage (2.3), V; the supply's limit is not applied.
    pub voltage: Vector3<f64>,
}

/// What a motion demands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Generalized force of all motors together, (N, N.m, N.m).
    pub generalized_force: Vector3<f64>,
    /// Leg motors.
    pub leg: DriveDemand,
    /// Revolute motors; zero while their circuits are open.
    pub revolute: DriveDemand,
    /// Joint forces of the motion under these currents.
    pub joint_forces: JointForces,
    /// Ratio of the largest to the smallest singular value of the map from currents to forces.
    pub condition: f64,
    /// Generalized force (moments over r_b) that no currents supply, N: rounding error but for
    /// three motors at a direct singularity.
    pub shortfall: f64,
}

/// The inverse dynamics of a mechanism, within its joint limits (the end stops are left out).
///
/// Six motors act on three degrees of freedom: the currents of least norm are chosen, which are
/// also those of least copper loss. Three leg motors alone fail at direct singularities: there the
/// singular direction's force is left out (see [`Demand::shortfall`]), so currents stay finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InverseDynamics {
    model: PlantModel<f64>,
    /// The same in dual numbers, for the derivative of the currents along the trajectory.
    dual: PlantModel<Dual64>,
    torque_constant: f64,
}

impl InverseDynamics {
    /// From validated parameters.
    pub fn new(parameters: &MechanismParameters<f64>) -> Self {
        Self {
            model: PlantModel::without_stops(parameters),
            dual: PlantModel::without_stops(&parameters.map(Dual64::from)),
            torque_constant: parameters.motor_kt,
        }
    }

    /// The demands of `point` under the external loads of `inputs` (held while time passes; its
    /// voltages are not used).
    pub fn demand(&self, point: &TrajectoryPoint, inputs: &Inputs<f64>) -> Demand {
        // G(t) i(t) = Q(t) and its derivative
        let (map, load) = self.actuation_along(point, inputs);
        let (map_rate, load_rate) = (map.map(|x| x.eps), load.map(|x| x.eps));
        let (map, load) = (map.map(|x| x.re), load.map(|x| x.re));
        let svd = Svd::new(&map.transpose());
        let inverse = svd.pseudo_inverse(JointForces::CUTOFF).transpose();
        let currents = inverse * load;
        // i = G^T mu; with six motors the row space turns as well
        let multiplier = inverse.tr_mul(&currents);
        let turning = map_rate.tr_mul(&multiplier);
        let current_rates = inverse * (load_rate - map_rate * currents) + turning - inverse * (map * turning);

        let mut x = moving(&point.position, &point.velocity);
        x.fixed_rows_mut::<6>(6).copy_from(&currents);
        let mut evaluation = evaluate(&self.model, &x, inputs);
        // equal up to rounding unless there is a shortfall
        evaluation.acceleration = point.acceleration;
        let r_b = self.model.geometry.joint_radius;
        let rates = evaluation.limb_motions;
        let drives = (&self.model.motors.leg, &self.model.motors.revolute);
        Demand {
            generalized_force: Vector3::new(load.x, load.y * r_b, load.z * r_b),
            leg: self.drive(drives.0, 0, &currents, &current_rates, rates.map(|r| r.length_rate)),
            revolute: if self.model.motors.revolute_motors {
                self.drive(drives.1, 3, &currents, &current_rates, rates.map(|r| r.angle_rate))
            } else {
                DriveDemand::default()
            },
            joint_forces: joint_forces(&self.model, &evaluation, inputs),
            condition: svd.condition(),
            shortfall: (load - map * currents).norm(),
        }
    }

    /// The map G from currents to generalized forces and the forces Q that the motors owe, moments
    /// over r_b, with their time derivatives.
    fn actuation_along(&self, point: &TrajectoryPoint, inputs: &Inputs<f64>) -> (Matrix3x6<Dual64>, Vector3<Dual64>) {
        let model = &self.dual;
        let position = point.position.zip_map(&point.velocity, Dual64::new);
        let velocity = point.velocity.zip_map(&point.acceleration, Dual64::new);
        let acceleration = point.acceleration.zip_map(&point.jerk, Dual64::new);
        let loads =
            Inputs { force: inputs.force.map(Dual64::from), moment: inputs.moment.map(Dual64::from), ..Inputs::zero() };
        let idle = evaluate(model, &moving(&position, &velocity), &loads);
        // M s_ddot + h less friction and loads: M times what the motors must add to the idle acceleration
        let force = idle.dynamics.mass_matrix * (acceleration - idle.acceleration);
        let (leg, revolute) = current_maps(model, &idle.limbs);
        let mut map = Matrix3x6::zeros();
        map.fixed_columns_mut::<3>(0).copy_from(&leg);
        if model.motors.revolute_motors {
            map.fixed_columns_mut::<3>(3).copy_from(&revolute);
        }
        let commensurate = |row: usize, x: Dual64| if row == 0 { x } else { x / model.geometry.joint_radius };
        (
            Matrix3x6::from_fn(|row, column| commensurate(row, map[(row, column)])),
            Vector3::from_fn(|row, _| commensurate(row, force[row])),
        )
    }

    fn drive(
        &self,
        drive: &Drive<f64>,
        first: usize,
        currents: &Vector6<f64>,
        current_rates: &Vector6<f64>,
        joint_rates: [f64; 3],
    ) -> DriveDemand {
        let motors = &self.model.motors;
        let current = currents.fixed_rows::<3>(first).into_owned();
        let current_rate = current_rates.fixed_rows::<3>(first);
        DriveDemand {
            joint: current * drive.force_constant,
            torque: current * self.torque_constant,
            current,
            // (2.3)
            voltage: current * motors.resistance
                + Vector3::from(joint_rates) * drive.force_constant
                + current_rate * motors.inductance,
        }
    }
}
