//! Crossings of the singular surface.

use nalgebra::Vector3;
use rand::Rng;
use rand_distr::{Distribution, StandardUniform};

use crate::control::ControllerParameters;
use crate::coupling::Experiment;
use crate::defaults as d;
use crate::dynamics::PlantParameters;
use crate::mechanism::{Geometry, Limb, Pose, singular_heights};

/// A motion through a singular pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Start, singular pose and end: (heave in m, tilt_x, tilt_y in rad).
    pub waypoints: [[f64; 3]; 3],
}

/// Tilts of the random crossings, rad.
const TILTS: (f64, f64) = (3.0 * d::DEG, 12.0 * d::DEG);
/// Points at which a path is compared with the limits.
const CHECKS: usize = 50;

impl Crossing {
    /// Through the singular pose `via` the way the default crossing passes its own.
    pub fn through(via: [f64; 3]) -> Self {
        let shifted = |sign: f64| {
            let tilt = 1.0 + sign * d::CROSSING_TILT;
            [via[0] + sign * d::CROSSING_HEAVE, via[1] * tilt, via[2] * tilt]
        };
        Self { waypoints: [shifted(1.0), via, shifted(-1.0)] }
    }

    /// Through a random singular pose: tilt 3 to 12 deg in any direction, on any sheet of the singular
    /// surface, such that the whole path keeps within the joints' limits.
    pub fn random(plant: &PlantParameters, rng: &mut impl Rng) -> Self {
        let geometry = Geometry::new(plant.mechanism.base_radius, plant.mechanism.joint_spacing);
        let mut uniform = |low: f64, high: f64| {
            let share: f64 = StandardUniform.sample(rng);
            low + (high - low) * share
        };
        loop {
            let tilt = uniform(TILTS.0, TILTS.1);
            let (sin, cos) = libm::sincos(uniform(0.0, std::f64::consts::TAU));
            let heights = singular_heights(&geometry, tilt * cos, tilt * sin);
            let sheet = uniform(0.0, heights.len() as f64) as usize;
            let crossing = Self::through([heights[sheet], tilt * cos, tilt * sin]);
            if crossing.within_limits(plant, &geometry) {
                return crossing;
            }
        }
    }

    /// Limb lengths and angles of the whole path lie within the plant's limits.
    fn within_limits(&self, plant: &PlantParameters, geometry: &Geometry<f64>) -> bool {
        let [start, _, end] = self.waypoints.map(Vector3::from);
        (0..=CHECKS).all(|k| {
            let pose = Pose::new(geometry, &start.lerp(&end, k as f64 / CHECKS as f64));
            within_stops(plant, &Limb::all(geometry, &pose))
        })
    }

    /// An experiment with default parameters that drives this crossing with three or six motors.
    pub fn experiment(&self, revolute_motors: bool) -> Experiment {
        let mut plant = PlantParameters { start: self.waypoints[0], ..PlantParameters::default() };
        let mut controller = ControllerParameters { waypoints: self.waypoints, ..ControllerParameters::default() };
        plant.mechanism.revolute_motors = revolute_motors;
        controller.mechanism.revolute_motors = revolute_motors;
        Experiment { plant, controller, ..Experiment::default() }
    }
}

/// No limb is beyond an end stop.
pub(super) fn within_stops(plant: &PlantParameters, limbs: &[Limb<f64>; 3]) -> bool {
    limbs.iter().all(|limb| {
        (plant.d_min..=plant.d_max).contains(&limb.length)
            && (plant.theta_min..=plant.theta_max).contains(&limb.angle())
    })
}

impl Default for Crossing {
    /// The default crossing of both FMUs.
    fn default() -> Self {
        Self::through([d::VIA_HEAVE, d::VIA_TILT_X, d::VIA_TILT_Y])
    }
}
