//! Joint sensors with the imperfections of Table 1.

use nalgebra::Vector3;
use rand::Rng;
use rand::distr::{Distribution, StandardUniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use super::estimator::Deviations;
use super::sensor_watch::CHANNELS;
use crate::defaults as d;
use crate::scalar::Scalar;

/// What the controller measures at a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement<T> {
    /// Limb lengths, m, and rates, m/s.
    pub lengths: Vector3<T>,
    pub length_rates: Vector3<T>,
    /// Limb angles, rad, and rates, rad/s.
    pub angles: Vector3<T>,
    pub angle_rates: Vector3<T>,
    /// Currents of leg and revolute motors, A.
    pub leg_currents: Vector3<T>,
    pub revolute_currents: Vector3<T>,
    /// Acceleration of P, base frame, m/s2.
    pub acceleration: Vector3<T>,
}

impl Measurement<f64> {
    /// All scalars, in the order of the fields.
    pub fn to_array(&self) -> [f64; CHANNELS] {
        let fields = [
            &self.lengths,
            &self.length_rates,
            &self.angles,
            &self.angle_rates,
            &self.leg_currents,
            &self.revolute_currents,
            &self.acceleration,
        ];
        std::array::from_fn(|channel| fields[channel / 3][channel % 3])
    }

    /// The inverse of [`to_array`](Self::to_array).
    pub fn from_array(scalars: &[f64; CHANNELS]) -> Self {
        let vector = |k: usize| Vector3::new(scalars[3 * k], scalars[3 * k + 1], scalars[3 * k + 2]);
        Self {
            lengths: vector(0),
            length_rates: vector(1),
            angles: vector(2),
            angle_rates: vector(3),
            leg_currents: vector(4),
            revolute_currents: vector(5),
            acceleration: vector(6),
        }
    }
}

impl<T: Scalar> Measurement<T> {
    /// With every number replaced.
    pub fn map<U: Scalar>(&self, f: impl Fn(T) -> U) -> Measurement<U> {
        Measurement {
            lengths: self.lengths.map(&f),
            length_rates: self.length_rates.map(&f),
            angles: self.angles.map(&f),
            angle_rates: self.angle_rates.map(&f),
            leg_currents: self.leg_currents.map(&f),
            revolute_currents: self.revolute_currents.map(&f),
            acceleration: self.acceleration.map(&f),
        }
    }
}

/// Figures of the position sensors (Table 1), all multiplied by `scale`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SensorParameters {
    /// 0: ideal sensors; 1: the figures below.
    pub scale: f64,
    /// Resolution of lengths, m, and angles, rad.
    pub length_resolution: f64,
    pub angle_resolution: f64,
    /// Repeatability of lengths, m, and angles, rad: standard deviation of the noise.
    pub length_noise: f64,
    pub angle_noise: f64,
    /// Largest static error of lengths, m.
    pub length_bias: f64,
}

impl Default for SensorParameters {
    fn default() -> Self {
        Self {
            scale: 0.0,
            length_resolution: d::SENSOR_LENGTH_RESOLUTION,
            angle_resolution: d::SENSOR_ANGLE_RESOLUTION,
            length_noise: d::SENSOR_LENGTH_NOISE,
            angle_noise: d::SENSOR_ANGLE_NOISE,
            length_bias: d::SENSOR_LENGTH_BIAS,
        }
    }
}

impl SensorParameters {
    /// Standard deviations of the readings, quantization included. Where nothing is wrong with the sensors, those of
    /// Table 1 unscaled, of which only the ratio matters, and no static error.
    pub fn deviations(&self) -> Deviations {
        let scale = if self.scale > 0.0 { self.scale } else { 1.0 };
        // a uniform error of width q has the variance q^2 / 12
        let deviation = |noise: f64, resolution: f64| {
            scale * (noise * noise + resolution * resolution / 12.0).sqrt().max(SMALLEST_DEVIATION)
        };
        Deviations {
            length: deviation(self.length_noise, self.length_resolution),
            angle: deviation(self.angle_noise, self.angle_resolution),
            // a uniform error within +-b has the variance b^2 / 3
            length_bias: (self.scale * self.length_bias / 3.0_f64.sqrt()).max(SMALLEST_BIAS),
        }
    }
}

/// m or rad; keeps a weight finite where a sensor is perfect.
const SMALLEST_DEVIATION: f64 = 1e-6;
/// m; no error that anything could be told from.
const SMALLEST_BIAS: f64 = 1e-9;

/// The sensors: static errors drawn once, and a generator for the noise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sensors {
    parameters: SensorParameters,
    biases: [f64; 3],
    rng: Xoshiro256PlusPlus,
}

impl Sensors {
    /// Draws the static errors from `rng`, uniform within +-length_bias, and keeps it for the noise.
    pub fn new(parameters: SensorParameters, mut rng: Xoshiro256PlusPlus) -> Self {
        let biases = [0, 1, 2].map(|_| {
            let uniform: f64 = StandardUniform.sample(&mut rng);
            (2.0 * uniform - 1.0) * parameters.length_bias * parameters.scale
        });
        Self { parameters, biases, rng }
    }

    /// What the sensors tell of the true lengths and angles. Rates and currents are passed on.
    pub fn read(&mut self, truth: &Measurement<f64>) -> Measurement<f64> {
        let mut measured = *truth;
        let p = self.parameters;
        if p.scale == 0.0 {
            return measured;
        }
        for i in 0..3 {
            let length_noise = standard_normal(&mut self.rng);
            let angle_noise = standard_normal(&mut self.rng);
            let length = truth.lengths[i] + self.biases[i] + p.scale * p.length_noise * length_noise;
            let angle = truth.angles[i] + p.scale * p.angle_noise * angle_noise;
            measured.lengths[i] = quantize(length, p.scale * p.length_resolution);
            measured.angles[i] = quantize(angle, p.scale * p.angle_resolution);
        }
        measured
    }
}

/// A standard normal deviate by Marsaglia's polar method (doi:10.1137/1006063). That of rand_distr asks the
/// platform's C library for logarithms, whose last bits differ from system to system.
fn standard_normal(rng: &mut impl Rng) -> f64 {
    loop {
        let [u, v] = [(); 2].map(|()| {
            let uniform: f64 = StandardUniform.sample(rng);
            2.0 * uniform - 1.0
        });
        let square = u * u + v * v;
        if 0.0 < square && square < 1.0 {
            return u * (-2.0 * libm::log(square) / square).sqrt();
        }
    }
}

/// Nearest multiple of `resolution`; `value` itself where that is 0.
fn quantize(value: f64, resolution: f64) -> f64 {
    if resolution > 0.0 { libm::round(value / resolution) * resolution } else { value }
}
