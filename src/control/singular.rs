//! The damped acceleration in the singular basis of J on the allowed motions.

use nalgebra::{Matrix3, Vector3};

use super::damping::SMALLEST_SQUARE;
use super::{Damping, Situation};
use crate::mechanism::SingularValues;
use crate::svd::Svd;

/// J = U S V^T (4.9) with what (4.10) and (4.15) need of a situation: evaluating a damping is then
/// a handful of operations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingularBasis {
    /// Squares of the singular values.
    squares: Vector3<f64>,
    /// sigma_i u_i^T a_d*
    desired: Vector3<f64>,
    /// v_i^T q_dot
    twist: Vector3<f64>,
    /// v_i, in the basis of the allowed twists.
    right: Matrix3<f64>,
    /// Singular coordinates to s_ddot.
    to_coordinates: Matrix3<f64>,
    coordinate_bias: Vector3<f64>,
    /// Smallest singular value of the whole J, dimensionless.
    pub sigma_min: f64,
}

impl SingularBasis {
    /// Decomposes J of `situation`.
    pub fn new(situation: &Situation<f64>) -> Self {
        let allowed = &situation.allowed;
        let Svd { u: left, singular_values: sigma, v: right } = Svd::new(&allowed.jacobian);
        Self {
            squares: sigma.component_mul(&sigma),
            desired: left.tr_mul(&allowed.desired).component_mul(&sigma),
            twist: right.tr_mul(&allowed.twist),
            to_coordinates: allowed.to_coordinates * right,
            coordinate_bias: allowed.coordinate_bias,
            right,
            sigma_min: f64::sigma_min(&situation.jacobian),
        }
    }

    /// Coordinates of q_ddot_hd (4.14) along the right singular vectors, m/s2: (4.10) and (4.15).
    #[inline]
    fn singular_coordinates(&self, rho: f64, rho_hd: f64) -> Vector3<f64> {
        let square = rho * rho;
        let velocity = rho_hd * square;
        Vector3::from_fn(|i, _| {
            (self.desired[i] - velocity * self.twist[i]) / (self.squares[i] + square + SMALLEST_SQUARE)
        })
    }

    /// q_ddot_hd (4.14) in the basis of the allowed twists, m/s2.
    pub fn acceleration(&self, damping: &Damping<f64>, sample_time: f64) -> Vector3<f64> {
        self.right * self.singular_coordinates(damping.rho, damping.rho_hd(self.sigma_min, sample_time))
    }

    /// s_ddot that belongs to it, (m, rad, rad)/s2.
    #[inline]
    pub fn coordinate_acceleration(&self, rho: f64, rho_hd: f64) -> Vector3<f64> {
        self.to_coordinates * self.singular_coordinates(rho, rho_hd) - self.coordinate_bias
    }
}
