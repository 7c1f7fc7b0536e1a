//! State estimate from all six joint sensors.
//!
//! Lengths alone do not tell the pose at a direct singularity; lengths and angles together do
//! everywhere. So the pose is a weighted least-squares fit of all six, and its rate likewise.

use std::cmp::Ordering;

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::{ControllerParameters, Measurement};
use crate::dynamics::solve_positive_definite;
use crate::mechanism::{Geometry, Limb, Pose};
use crate::scalar::{Scalar, constant};

/// Estimated coordinates and rates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate<T> {
    /// (heave in m, tilt_x, tilt_y in rad).
    pub s: Vector3<T>,
    /// Their rates, 1/s.
    pub s_dot: Vector3<T>,
}

/// Least squares, then a filter that trusts the measured rates over short times.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimator {
    /// Weights of a length (1/m) and of an angle (1/rad): inverse standard deviations.
    length_weight: f64,
    angle_weight: f64,
    /// Steady share of the fitted pose in the filtered one at a tick; 1: no filter.
    gain: f64,
    sample_time: f64,
    /// Ticks since the start.
    ticks: u32,
    /// Last estimate: coordinates and rates.
    s: [f64; 3],
    s_dot: [f64; 3],
}

/// Newton's iterations at a tick. From the last tick's pose two reach rounding, from the first
/// guess five; the loop ends early when the step is that small.
const ITERATIONS: usize = 12;
const CONVERGED: f64 = 1e-13;

impl Estimator {
    /// As a controller with `parameters` uses it, before its first tick.
    pub fn of(parameters: &ControllerParameters) -> Self {
        let ControllerParameters { sensors, filter_time, sample_time, waypoints, .. } = parameters;
        Self::new(sensors.deviations(), *filter_time, *sample_time, waypoints[0])
    }

    /// `deviations` of length (m) and angle (rad) readings; the filter's time constant
    /// `filter_time` (s), 0 for none; first guess `s` (m, rad, rad).
    pub fn new(deviations: (f64, f64), filter_time: f64, sample_time: f64, s: [f64; 3]) -> Self {
        let gain = if filter_time > 0.0 { 1.0 - libm::exp(-sample_time / filter_time) } else { 1.0 };
        Self {
            length_weight: deviations.0.recip(),
            angle_weight: deviations.1.recip(),
            gain,
            sample_time,
            ticks: 0,
            s,
            s_dot: [0.0; 3],
        }
    }

    /// The estimate at a tick; remembers it.
    pub fn update(&mut self, geometry: &Geometry<f64>, measured: &Measurement<f64>) -> Estimate<f64> {
        let last = Estimate { s: self.s.into(), s_dot: self.s_dot.into() };
        let fit = self.fit(geometry, measured, &last.s, false);
        let mut s = fit.s;
        if self.gain < 1.0 && self.ticks > 0 {
            let predicted = last.s + (last.s_dot + fit.s_dot) * (0.5 * self.sample_time);
            // the mean of all fits so far, until the steady gain is reached
            let gain = self.gain.max(1.0 / (f64::from(self.ticks) + 1.0));
            s = predicted + (fit.s - predicted) * gain;
        }
        self.ticks = self.ticks.saturating_add(1);
        self.s = s.into();
        self.s_dot = fit.s_dot.into();
        Estimate { s, s_dot: fit.s_dot }
    }

    /// Weighted least-squares fit of pose (Gauss-Newton from `guess`) and rates. `exact` makes all
    /// iterations, as derivatives carried by `T` want: they converge after the value.
    pub fn fit<T: Scalar>(
        &self,
        geometry: &Geometry<T>,
        measured: &Measurement<T>,
        guess: &Vector3<T>,
        exact: bool,
    ) -> Estimate<T> {
        let (length_weight, angle_weight) = (constant(self.length_weight), constant::<T>(self.angle_weight));
        let mut s = *guess;
        let mut limbs = Limb::all(geometry, &Pose::new(geometry, &s));
        let mut normal = normal_matrix(&limbs, length_weight, angle_weight);
        for _ in 0..ITERATIONS {
            let residual = projected(&limbs, length_weight, angle_weight, |i, limb| {
                (measured.lengths[i] - limb.length, measured.angles[i] - limb.angle())
            });
            let step = solve_positive_definite(&normal, &residual);
            s += step;
            limbs = Limb::all(geometry, &Pose::new(geometry, &s));
            normal = normal_matrix(&limbs, length_weight, angle_weight);
            // (a NaN ends it too)
            if !exact && step.amax().partial_cmp(&constant(CONVERGED)) != Some(Ordering::Greater) {
                break;
            }
        }
        let rates =
            projected(&limbs, length_weight, angle_weight, |i, _| (measured.length_rates[i], measured.angle_rates[i]));
        Estimate { s, s_dot: solve_positive_definite(&normal, &rates) }
    }
}

/// Sum of weighted gradient products over the six sensors.
fn normal_matrix<T: Scalar>(limbs: &[Limb<T>; 3], length_weight: T, angle_weight: T) -> Matrix3<T> {
    let mut normal = Matrix3::zeros();
    for limb in limbs {
        let (length, angle) = (limb.length_gradient * length_weight, limb.angle_gradient * angle_weight);
        normal += length * length.transpose() + angle * angle.transpose();
    }
    normal
}

/// Sum of weighted gradients times the (length, angle) `values`.
fn projected<T: Scalar>(
    limbs: &[Limb<T>; 3],
    length_weight: T,
    angle_weight: T,
    values: impl Fn(usize, &Limb<T>) -> (T, T),
) -> Vector3<T> {
    let mut sum = Vector3::zeros();
    for (i, limb) in limbs.iter().enumerate() {
        let (length, angle) = values(i, limb);
        sum += limb.length_gradient * (length_weight * length_weight * length)
            + limb.angle_gradient * (angle_weight * angle_weight * angle);
    }
    sum
}
