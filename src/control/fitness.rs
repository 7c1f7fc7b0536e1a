//! The fitness of a damping: predicted motion through the actuator model.
//!
//! The paper does not print its fitness. Here a damping is as good as the motion that it leads to:
//! the currents that it asks for are limited to what the voltage limit can keep up, the mechanism
//! answers with M^-1, and with that acceleration held for a horizon H the error against the
//! reference there is weighed. What a tick's dampings share is computed once in [`Fitness::new`].

use nalgebra::{Matrix3, Matrix3x6, Matrix6x3, Vector3, Vector6};

use super::actuation::{back_emf, damp};
use super::parameters::Tuning;
use super::{Damping, ForceDistribution, ReferencePoint, SingularBasis, Situation};
use crate::dynamics::PlantModel;

/// Objective of the swarm at one tick.
#[derive(Debug, Clone, Copy)]
pub struct Fitness<'a> {
    basis: &'a SingularBasis,
    actuators: Actuators,
    sample_time: f64,
    /// Lowest and highest current that the voltage limit can keep up, A.
    lowest: Vector6<f64>,
    highest: Vector6<f64>,
    /// Error at the horizon without acceleration, scaled to m, and its rate's, m/s.
    error: Vector3<f64>,
    rate_error: Vector3<f64>,
    /// (1, r_b, r_b)
    scale: Vector3<f64>,
    horizon: f64,
    half_square: f64,
    weight_velocity: f64,
    weight_acceleration: f64,
}

/// From the wanted s_ddot to the currents and back to the s_ddot that they cause.
#[derive(Debug, Clone, Copy)]
enum Actuators {
    Six {
        /// A per s_ddot and the currents that s_ddot = 0 takes.
        currents: Matrix6x3<f64>,
        still: Vector6<f64>,
        /// s_ddot per A, and at no current.
        response: Matrix3x6<f64>,
        free: Vector3<f64>,
    },
    Three {
        /// Singular components of the force map per s_ddot, and at s_ddot = 0.
        components: Matrix3<f64>,
        still: Vector3<f64>,
        sigma: Vector3<f64>,
        right: Matrix3<f64>,
        response: Matrix3<f64>,
        free: Vector3<f64>,
    },
}

impl<'a> Fitness<'a> {
    /// At `situation`; `ahead` is the reference at the horizon.
    pub fn new(
        model: &PlantModel<f64>,
        situation: &Situation<f64>,
        basis: &'a SingularBasis,
        distribution: &ForceDistribution,
        ahead: &ReferencePoint<f64>,
        tuning: &Tuning,
        sample_time: f64,
    ) -> Self {
        let r_b = model.geometry.joint_radius;
        let scale = Vector3::new(1.0, r_b, r_b);
        let mass = &situation.dynamics.mass_matrix;
        let inverse_mass = mass.try_inverse().unwrap_or_else(Matrix3::zeros);
        let load = situation.dynamics.bias + situation.friction;
        let free = -(inverse_mass * load);
        let actuators = match distribution {
            ForceDistribution::Six { inverse } => {
                let mut response = Matrix3x6::zeros();
                response.fixed_columns_mut::<3>(0).copy_from(&(inverse_mass * situation.leg_map));
                response.fixed_columns_mut::<3>(3).copy_from(&(inverse_mass * situation.revolute_map));
                Actuators::Six { currents: inverse * mass, still: inverse * load, response, free }
            }
            ForceDistribution::Three { left, sigma, right } => Actuators::Three {
                components: left * mass,
                still: left * load,
                sigma: *sigma,
                right: *right,
                response: inverse_mass * situation.leg_map,
                free,
            },
        };
        let emf = back_emf(&model.motors, situation);
        let (limit, resistance) = (model.motors.v_max, model.motors.resistance);
        let horizon = tuning.horizon;
        Self {
            basis,
            actuators,
            sample_time,
            lowest: emf.map(|e| (-limit - e) / resistance),
            highest: emf.map(|e| (limit - e) / resistance),
            error: (ahead.position - situation.s - situation.s_dot * horizon).component_mul(&scale),
            rate_error: (ahead.rate - situation.s_dot).component_mul(&scale),
            scale,
            horizon,
            half_square: 0.5 * horizon * horizon,
            weight_velocity: tuning.weight_velocity,
            weight_acceleration: tuning.weight_acceleration,
        }
    }

    /// The fitness of `damping`, m2; smaller is better.
    #[inline]
    pub fn evaluate(&self, damping: &Damping<f64>) -> f64 {
        let rho_hd = damping.rho_hd(self.basis.sigma_min, self.sample_time);
        let wanted = self.basis.coordinate_acceleration(damping.rho, rho_hd);
        let acceleration = self.respond(&wanted, damping.lambda_f).component_mul(&self.scale);
        let error = self.error - acceleration * self.half_square;
        let rate_error = self.rate_error - acceleration * self.horizon;
        error.norm_squared()
            + self.weight_velocity * rate_error.norm_squared()
            + self.weight_acceleration * acceleration.norm_squared()
    }

    /// s_ddot that the limited motors cause when `wanted` is asked for.
    #[inline]
    fn respond(&self, wanted: &Vector3<f64>, lambda_f: f64) -> Vector3<f64> {
        match &self.actuators {
            Actuators::Six { currents, still, response, free } => {
                let asked = currents * wanted + still;
                let kept = self.limit(asked);
                // within the limits six motors give what was asked for
                if kept == asked { *wanted } else { response * kept + free }
            }
            Actuators::Three { components, still, sigma, right, response, free } => {
                let leg = right * damp(&(components * wanted + still), sigma, lambda_f);
                let kept = Vector3::from_fn(|i, _| leg[i].max(self.lowest[i]).min(self.highest[i]));
                response * kept + free
            }
        }
    }

    #[inline]
    fn limit(&self, currents: Vector6<f64>) -> Vector6<f64> {
        Vector6::from_fn(|i, _| currents[i].max(self.lowest[i]).min(self.highest[i]))
    }
}
