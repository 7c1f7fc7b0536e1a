//! The fitness of a damping: predicted motion through the actuator model.
//!
//! The paper does not print its fitness. Here a damping is as good as the motion that it leads to:
//! the currents that it asks for are limited to what the voltage limit can keep up, the mechanism
//! answers with M^-1, and with that acceleration held for a horizon H the error against the
//! reference there is weighed, and whether three motors can hold the pose there. What a tick's dampings share
//! is computed once in [`Fitness::new`].

use nalgebra::{Matrix3, Matrix3x6, Matrix6x3, SVector, Vector3, Vector6};

use super::actuation::{back_emf, damp};
use super::holding::Holding;
use super::parameters::Tuning;
use super::{Damping, ForceDistribution, ReferencePoint, SingularBasis, Situation};
use crate::dynamics::{PlantModel, solve_positive_definite};
use crate::scalar::{Scalar, constant};

/// Objective of the swarm at one tick.
#[derive(Debug, Clone, Copy)]
pub struct Fitness<'a> {
    basis: &'a SingularBasis,
    actuators: Actuators,
    sample_time: f64,
    /// Lowest and highest current that the voltage limit can keep up, A.
    lowest: Vector6<f64>,
    highest: Vector6<f64>,
    outlook: Outlook<f64>,
}

/// Where the platform would be at the horizon without acceleration, against the reference there;
/// errors scaled to m.
#[derive(Debug, Clone, Copy)]
struct Outlook<T> {
    /// (1, r_b, r_b)
    scale: Vector3<T>,
    /// m
    error: Vector3<T>,
    /// m/s
    rate_error: Vector3<T>,
    /// s
    horizon: T,
    /// s2
    weight_velocity: T,
    /// s4
    weight_acceleration: T,
    holding: Option<Holding<T>>,
}

impl<T: Scalar> Outlook<T> {
    fn new(model: &PlantModel<T>, situation: &Situation<T>, ahead: &ReferencePoint<T>, tuning: &Tuning<T>) -> Self {
        let Tuning { horizon, weight_velocity, weight_acceleration, holding, .. } = *tuning;
        let scale = coordinate_scale(model);
        Self {
            scale,
            error: (ahead.position - situation.s - situation.s_dot * horizon).component_mul(&scale),
            rate_error: (ahead.rate - situation.s_dot).component_mul(&scale),
            horizon,
            weight_velocity,
            weight_acceleration,
            holding: Holding::new(model, situation, ahead, horizon, &holding),
        }
    }

    /// The fitness, m2, of an s_ddot ((m, rad, rad)/s2) held up to the horizon.
    #[inline]
    fn weigh(&self, s_ddot: &Vector3<T>) -> T {
        let acceleration = s_ddot.component_mul(&self.scale);
        let error = self.error - acceleration * (self.horizon * self.horizon * constant(0.5));
        let rate_error = self.rate_error - acceleration * self.horizon;
        let tracking = error.norm_squared()
            + self.weight_velocity * rate_error.norm_squared()
            + self.weight_acceleration * acceleration.norm_squared();
        match &self.holding {
            Some(holding) => tracking + holding.weigh(s_ddot),
            None => tracking,
        }
    }
}

/// (1, r_b, r_b): coordinates to m.
fn coordinate_scale<T: Scalar>(model: &PlantModel<T>) -> Vector3<T> {
    let r_b = model.geometry.joint_radius;
    Vector3::new(T::one(), r_b, r_b)
}

/// Lowest and highest currents of leg and revolute motors that the voltage limit can keep up, A.
fn current_limits<T: Scalar>(model: &PlantModel<T>, situation: &Situation<T>) -> (Vector6<T>, Vector6<T>) {
    let emf = back_emf(&model.motors, situation);
    let (limit, resistance) = (model.motors.v_max, model.motors.resistance);
    (emf.map(|e| (-limit - e) / resistance), emf.map(|e| (limit - e) / resistance))
}

/// Currents of the first `N` motors, A, cut to what the voltage limit keeps up.
#[inline]
fn kept<T: Scalar, const N: usize>(
    currents: &SVector<T, N>,
    (lowest, highest): (&Vector6<T>, &Vector6<T>),
) -> SVector<T, N> {
    SVector::from_fn(|i, _| currents[i].max(lowest[i]).min(highest[i]))
}

/// The fitness (m2) of currents (A), written out: what [`Fitness::evaluate`] computes for many
/// dampings at the price of a few operations each. Can be differentiated through.
pub fn fitness_of_currents<T: Scalar>(
    model: &PlantModel<T>,
    situation: &Situation<T>,
    currents: &Vector6<T>,
    ahead: &ReferencePoint<T>,
    tuning: &Tuning<T>,
) -> T {
    let (lowest, highest) = current_limits(model, situation);
    let kept = kept(currents, (&lowest, &highest));
    let force = situation.leg_map * kept.fixed_rows::<3>(0) + situation.revolute_map * kept.fixed_rows::<3>(3)
        - situation.dynamics.bias
        - situation.friction;
    let acceleration = solve_positive_definite(&situation.dynamics.mass_matrix, &force);
    Outlook::new(model, situation, ahead, tuning).weigh(&acceleration)
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
        let (lowest, highest) = current_limits(model, situation);
        let outlook = Outlook::new(model, situation, ahead, tuning);
        Self { basis, actuators, sample_time, lowest, highest, outlook }
    }

    /// The fitness of `damping`, m2; smaller is better.
    #[inline]
    pub fn evaluate(&self, damping: &Damping<f64>) -> f64 {
        self.of_factors(damping.rho, self.rho_hd(damping), damping.lambda_f)
    }

    /// rho_hd (4.16) of `damping`, 1/s.
    pub fn rho_hd(&self, damping: &Damping<f64>) -> f64 {
        damping.rho_hd(self.basis.sigma_min, self.sample_time)
    }

    /// [`evaluate`](Self::evaluate) for rho_hd (1/s) in place of delta_hd.
    #[inline]
    pub fn of_factors(&self, rho: f64, rho_hd: f64, lambda_f: f64) -> f64 {
        self.of_acceleration(&self.basis.coordinate_acceleration(rho, rho_hd), lambda_f)
    }

    /// The fitness of asking for s_ddot = `wanted`, (m, rad, rad)/s2, in whatever way it was found.
    #[inline]
    pub fn of_acceleration(&self, wanted: &Vector3<f64>, lambda_f: f64) -> f64 {
        self.outlook.weigh(&self.respond(wanted, lambda_f))
    }

    /// s_ddot that the limited motors cause when `wanted` is asked for.
    #[inline]
    fn respond(&self, wanted: &Vector3<f64>, lambda_f: f64) -> Vector3<f64> {
        let limits = (&self.lowest, &self.highest);
        match &self.actuators {
            Actuators::Six { currents, still, response, free } => {
                let asked = currents * wanted + still;
                let kept = kept(&asked, limits);
                // within the limits six motors give what was asked for
                if kept == asked { *wanted } else { response * kept + free }
            }
            Actuators::Three { components, still, sigma, right, response, free } => {
                let leg = right * damp(&(components * wanted + still), sigma, lambda_f);
                response * kept(&leg, limits) + free
            }
        }
    }
}
