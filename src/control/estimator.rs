//! State estimate from all six joint sensors.
//!
//! Lengths alone do not tell the pose at a direct singularity; lengths and angles together do
//! everywhere. So the pose is a weighted least-squares fit of all six, and its rate likewise.
//!
//! Lengths may be off by a static error each, which angles do not have. It is estimated along with the pose: the fits
//! of all ticks are one least-squares problem in the present pose and three constants, of which a tick keeps the
//! information matrix. What it says of the pose, the constants being what they are, fades with the filter's time
//! constant, for rates carry a pose on only so long; what it says of the constants alone stays.

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
    /// Their rates, m/s and rad/s.
    pub s_dot: Vector3<T>,
}

/// Standard deviations of what the sensors tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviations {
    /// Of a length about its static error, m.
    pub length: f64,
    /// Of an angle, rad.
    pub angle: f64,
    /// Of the static errors of lengths, m; above 0.
    pub length_bias: f64,
}

/// Recursive least squares over poses and the static errors of lengths.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimator {
    /// Information of a length, 1/m2, and of an angle, 1/rad2: inverse variances.
    length_information: f64,
    angle_information: f64,
    /// What a tick keeps of the information on the pose; 0: no filter.
    retention: f64,
    sample_time: f64,
    /// Last estimate: coordinates and rates.
    s: [f64; 3],
    s_dot: [f64; 3],
    /// Static errors of the lengths, m.
    biases: [f64; 3],
    /// Information on (pose, static errors) that the next tick begins with: its blocks pose-pose, pose-errors, errors-errors.
    pose_information: [[f64; 3]; 3],
    shared_information: [[f64; 3]; 3],
    bias_information: [[f64; 3]; 3],
    /// Of the last fit, see [`Fit`].
    misfit: f64,
}

/// A least-squares fit and the information that it rests on.
#[derive(Debug, Clone, Copy)]
pub struct Fit<T> {
    /// Pose and rates.
    pub estimate: Estimate<T>,
    biases: Vector3<T>,
    pose_information: Matrix3<T>,
    shared_information: Matrix3<T>,
    bias_information: Matrix3<f64>,
    /// Sum of the squared errors of the six readings, each by its standard deviation.
    misfit: T,
}

/// A fit that leaves more than this [`Fit::misfit`] is no matter of noise.
const SUSPICIOUS: f64 = 1e3;
/// Length, m, by which readings that contradict each other are off at least.
const CONTRADICTION: f64 = 0.02;

/// Newton's iterations at a tick. From the last tick's pose two reach rounding, from the first
/// guess five; the loop ends early when the step is that small.
const ITERATIONS: usize = 12;
const CONVERGED: f64 = 1e-13;

impl Estimator {
    /// As a controller with `parameters` uses it, before its first tick.
    pub fn of(parameters: &ControllerParameters) -> Self {
        let ControllerParameters { sensors, filter_time, sample_time, waypoints, .. } = parameters;
        Self::new(&sensors.deviations(), *filter_time, *sample_time, waypoints[0])
    }

    /// For sensors with `deviations`; the filter's time constant `filter_time` (s), 0 for none; first guess `s` (m, rad, rad).
    pub fn new(deviations: &Deviations, filter_time: f64, sample_time: f64, s: [f64; 3]) -> Self {
        let information = |deviation: f64| (deviation * deviation).recip();
        Self {
            length_information: information(deviations.length),
            angle_information: information(deviations.angle),
            retention: if filter_time > 0.0 { libm::exp(-sample_time / filter_time) } else { 0.0 },
            sample_time,
            s,
            s_dot: [0.0; 3],
            biases: [0.0; 3],
            pose_information: [[0.0; 3]; 3],
            shared_information: [[0.0; 3]; 3],
            bias_information: Matrix3::from_diagonal_element(information(deviations.length_bias)).into(),
            misfit: 0.0,
        }
    }

    /// The estimate at a tick; remembers it.
    pub fn update(&mut self, geometry: &Geometry<f64>, measured: &Measurement<f64>) -> Estimate<f64> {
        let fit = self.find(geometry, measured, &self.s.into());
        self.s = fit.estimate.s.into();
        self.s_dot = fit.estimate.s_dot.into();
        self.biases = fit.biases.into();
        self.misfit = fit.misfit;
        // The pose given the static errors is known less well at the next tick, and they alone as well as now: that
        // leaves their marginal information errors-errors - errors-pose pose-pose^-1 pose-errors as it is.
        let Fit { pose_information, shared_information, bias_information, .. } = fit;
        let of_pose = pose_information.try_inverse().unwrap_or_else(Matrix3::zeros) * shared_information;
        self.pose_information = (pose_information * self.retention).into();
        self.shared_information = (shared_information * self.retention).into();
        self.bias_information =
            (bias_information - shared_information.tr_mul(&of_pose) * (1.0 - self.retention)).into();
        fit.estimate
    }

    /// By how much the readings of the last tick contradict each other, m, as if all of it were one length's error:
    /// `None` where they fit a pose, but for noise.
    pub fn contradiction(&self) -> Option<f64> {
        let length = (self.misfit / self.length_information).sqrt();
        (self.misfit > SUSPICIOUS && length > CONTRADICTION).then_some(length)
    }

    /// [`fit`](Self::fit) from `guess`. Where that ends in a false minimum, as it can far from the truth, the plane through the
    /// platform's joints is the guess.
    pub fn find(&self, geometry: &Geometry<f64>, measured: &Measurement<f64>, guess: &Vector3<f64>) -> Fit<f64> {
        let fit = self.fit(geometry, measured, guess, false);
        if fit.misfit <= SUSPICIOUS {
            return fit;
        }
        let plane = geometry.pose_of_joints(measured.lengths.into(), measured.angles.into());
        let other = self.fit(geometry, measured, &plane, false);
        // a difference within rounding is none
        if other.misfit < 0.5 * fit.misfit { other } else { fit }
    }

    /// What [`update`](Self::update) would estimate, searched from `guess` and in any number type: Gauss-Newton over
    /// the pose and the static errors, which are eliminated from each step. `exact` makes all iterations, as
    /// derivatives carried by `T` want: they converge after the value.
    pub fn fit<T: Scalar>(
        &self,
        geometry: &Geometry<T>,
        measured: &Measurement<T>,
        guess: &Vector3<T>,
        exact: bool,
    ) -> Fit<T> {
        let [length_information, angle_information] =
            [self.length_information, self.angle_information].map(constant::<T>);
        let half_sample = constant::<T>(0.5 * self.sample_time);
        let [last, last_rate, last_biases] =
            [self.s, self.s_dot, self.biases].map(|v| Vector3::from(v).map(constant::<T>));
        let [known_pose, known_shared, known_bias] =
            [self.pose_information, self.shared_information, self.bias_information].map(Matrix3::from);
        let bias_information = known_bias + Matrix3::from_diagonal_element(self.length_information);
        let bias_variance = bias_information.try_inverse().unwrap_or_else(Matrix3::zeros);
        let [known_pose, known_shared, known_bias, bias_variance] =
            [known_pose, known_shared, known_bias, bias_variance].map(|m| m.map(constant::<T>));

        let (mut s, mut biases, mut iteration) = (*guess, last_biases, 0);
        loop {
            let limbs = Limb::all(geometry, &Pose::new(geometry, &s));
            let length_gradients = Matrix3::from_columns(&limbs.map(|limb| limb.length_gradient));
            let angle_gradients = Matrix3::from_columns(&limbs.map(|limb| limb.angle_gradient));
            let length_weights = length_gradients * length_information;
            let angle_weights = angle_gradients * angle_information;
            let seen = length_weights * length_gradients.transpose() + angle_weights * angle_gradients.transpose();
            let rates = length_weights * measured.length_rates + angle_weights * measured.angle_rates;
            let s_dot = solve_positive_definite(&seen, &rates);
            let pose_information = known_pose + seen;
            let shared_information = known_shared + length_weights;

            let predicted = last + (last_rate + s_dot) * half_sample;
            let (off, bias_off) = (s - predicted, biases - last_biases);
            let length_error = measured.lengths - Vector3::from(limbs.map(|limb| limb.length)) - biases;
            let angle_error = measured.angles - Vector3::from(limbs.map(|limb| limb.angle()));
            let residual = length_weights * length_error + angle_weights * angle_error
                - known_pose * off
                - known_shared * bias_off;
            let bias_residual = length_error * length_information - known_shared.tr_mul(&off) - known_bias * bias_off;

            let eliminated = shared_information * bias_variance;
            let step = solve_positive_definite(
                &(pose_information - eliminated * shared_information.transpose()),
                &(residual - eliminated * bias_residual),
            );
            s += step;
            biases += bias_variance * (bias_residual - shared_information.tr_mul(&step));
            iteration += 1;
            // (a NaN ends it too)
            let converged = step.amax().partial_cmp(&constant(CONVERGED)) != Some(Ordering::Greater);
            if iteration == ITERATIONS || (converged && !exact) {
                let estimate = Estimate { s, s_dot };
                let misfit =
                    length_error.norm_squared() * length_information + angle_error.norm_squared() * angle_information;
                return Fit { estimate, biases, pose_information, shared_information, bias_information, misfit };
            }
        }
    }
}
