//! From a generalized force to motor currents and voltages.

use nalgebra::{Matrix3, Vector3, Vector6};

use super::Situation;
use super::damping::SMALLEST_SQUARE;
use crate::dynamics::{Motors, PlantModel, solve_positive_definite};
use crate::scalar::{Scalar, constant};
use crate::svd::Svd;

/// Currents of leg and revolute motors, A, stacked.
type Currents<T> = Vector6<T>;

/// How the motors share a generalized force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ForceDistribution {
    /// Six motors: currents of smallest norm, B^T (B B^T)^-1 Q.
    Six { inverse: nalgebra::Matrix6x3<f64> },
    /// Three motors: damped inverse of the force map, in its singular basis. Forces are scaled to
    /// (N, N, N) by r_b, so the damping is dimensionless.
    Three {
        /// U^T diag(1, 1/r_b, 1/r_b) / force constant, A per (N, N.m, N.m).
        left: Matrix3<f64>,
        /// Singular values.
        sigma: Vector3<f64>,
        /// V.
        right: Matrix3<f64>,
    },
}

impl ForceDistribution {
    /// At `situation`.
    pub fn new(model: &PlantModel<f64>, situation: &Situation<f64>) -> Self {
        if model.motors.revolute_motors {
            let (leg, revolute) = (situation.leg_map, situation.revolute_map);
            let gram = leg * leg.transpose() + revolute * revolute.transpose();
            let gram_inverse = gram.try_inverse().unwrap_or_else(Matrix3::zeros);
            let mut inverse = nalgebra::Matrix6x3::zeros();
            inverse.fixed_rows_mut::<3>(0).copy_from(&leg.tr_mul(&gram_inverse));
            inverse.fixed_rows_mut::<3>(3).copy_from(&revolute.tr_mul(&gram_inverse));
            Self::Six { inverse }
        } else {
            let scale = force_scale(model);
            let constant = model.motors.leg.force_constant;
            let svd = Svd::new(&(Matrix3::from_diagonal(&scale) * situation.leg_map / constant));
            let left = svd.u.transpose() * Matrix3::from_diagonal(&scale) / constant;
            Self::Three { left, sigma: svd.singular_values, right: svd.v }
        }
    }

    /// Currents (A) for the generalized `force` (N, N.m, N.m); `lambda_f` damps the inverse of
    /// three motors.
    #[inline]
    pub fn currents(&self, force: &Vector3<f64>, lambda_f: f64) -> Currents<f64> {
        match self {
            Self::Six { inverse } => inverse * force,
            Self::Three { left, sigma, right } => {
                let leg = right * damp(&(left * force), sigma, lambda_f);
                Vector6::new(leg.x, leg.y, leg.z, 0.0, 0.0, 0.0)
            }
        }
    }
}

/// Components along the singular directions times sigma / (sigma^2 + lambda^2).
#[inline]
pub(super) fn damp(components: &Vector3<f64>, sigma: &Vector3<f64>, lambda_f: f64) -> Vector3<f64> {
    let square = lambda_f * lambda_f + SMALLEST_SQUARE;
    Vector3::from_fn(|i, _| components[i] * sigma[i] / (sigma[i] * sigma[i] + square))
}

/// (1, 1/r_b, 1/r_b): generalized forces to N.
fn force_scale<T: Scalar>(model: &PlantModel<T>) -> Vector3<T> {
    let inverse = model.geometry.joint_radius.recip();
    Vector3::new(T::one(), inverse, inverse)
}

/// [`ForceDistribution::currents`] by normal equations, which can be differentiated through.
pub fn currents<T: Scalar>(
    model: &PlantModel<T>,
    situation: &Situation<T>,
    force: &Vector3<T>,
    lambda_f: T,
) -> Currents<T> {
    let (leg, revolute) = (situation.leg_map, situation.revolute_map);
    if model.motors.revolute_motors {
        let gram = leg * leg.transpose() + revolute * revolute.transpose();
        let multiplier = solve_positive_definite(&gram, force);
        stack(&leg.tr_mul(&multiplier), &revolute.tr_mul(&multiplier))
    } else {
        let scale = force_scale(model);
        let map = Matrix3::from_diagonal(&scale) * leg / model.motors.leg.force_constant;
        let gram = map.tr_mul(&map) + Matrix3::identity() * (lambda_f * lambda_f + constant(SMALLEST_SQUARE));
        let right = map.tr_mul(&force.component_mul(&scale)) / model.motors.leg.force_constant;
        stack(&solve_positive_definite(&gram, &right), &Vector3::zeros())
    }
}

fn stack<T: Scalar>(leg: &Vector3<T>, revolute: &Vector3<T>) -> Vector6<T> {
    Vector6::new(leg.x, leg.y, leg.z, revolute.x, revolute.y, revolute.z)
}

/// Voltages for the motors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoltageCommand<T> {
    /// Leg and revolute motors, V, within the limit.
    pub voltages: Vector6<T>,
    /// At least one was limited.
    pub saturated: bool,
}

/// Voltages that drive the measured currents to `wanted` (A) within a sample (2.3), limited:
/// v = r_a i + K omega + l_a (i - i_measured) / sample_time.
pub fn voltages<T: Scalar>(
    motors: &Motors<T>,
    situation: &Situation<T>,
    wanted: &Currents<T>,
    measured: &Currents<T>,
    sample_time: T,
) -> VoltageCommand<T> {
    let emf = back_emf(motors, situation);
    let mut saturated = false;
    let mut voltages = Vector6::zeros();
    let motor_count = if motors.revolute_motors { 6 } else { 3 };
    for k in 0..motor_count {
        let wanted_voltage =
            wanted[k] * motors.resistance + emf[k] + (wanted[k] - measured[k]) * motors.inductance / sample_time;
        voltages[k] = motors.limit(wanted_voltage);
        saturated |= voltages[k] != wanted_voltage;
    }
    VoltageCommand { voltages, saturated }
}

/// Back-emf of leg and revolute motors, V.
pub(super) fn back_emf<T: Scalar>(motors: &Motors<T>, situation: &Situation<T>) -> Vector6<T> {
    stack(
        &(situation.length_rates * motors.leg.force_constant),
        &(situation.angle_rates * motors.revolute.force_constant),
    )
}
