//! Parameters of the controller.

use serde::{Deserialize, Serialize};

use super::holding::HoldingTerm;
use super::mpso::{Settings, SettingsError};
use super::{Damping, Mode, Profile, SensorParameters};
use crate::defaults as d;
use crate::dynamics::solver::SolverError;
use crate::dynamics::{MechanismParameters, ParameterError};

/// Feedback gains (4.5b).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Gains<T = f64> {
    /// K_P, 1/s2.
    pub position: T,
    /// K_D, 1/s.
    pub velocity: T,
    /// K_A of the acceleration feedback (Figure 8), 1.
    pub acceleration: T,
}

/// The swarm and its search ranges: rho in [0, rho_max] and so on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SwarmParameters {
    pub settings: Settings,
    /// Largest rho, delta_hd and lambda_f, dimensionless.
    pub largest: Damping<f64>,
}

/// What is fixed after initialization.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ControllerParameters {
    /// The controller's model of the mechanism.
    pub mechanism: MechanismParameters,
    /// Time between ticks, s.
    pub sample_time: f64,
    /// The voltages of a tick reach the motors one tick later.
    pub computation_delay: bool,
    /// Start, via, end: (heave in m, tilt_x, tilt_y in rad).
    pub waypoints: [[f64; 3]; 3],
    /// Duration of the motion, s.
    pub move_time: f64,
    pub profile: Profile,
    /// The reference comes from outside.
    pub external_reference: bool,
    pub sensors: SensorParameters,
    /// Time for which a measurement may be missing or frozen before the voltages are cut off, s;
    /// 0: for ever.
    pub sensor_timeout: f64,
    /// Time constant of the pose filter, s; 0: none.
    pub filter_time: f64,
    pub swarm: SwarmParameters,
    pub seed: u64,
}

/// What may change between ticks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tuning<T = f64> {
    pub mode: Mode,
    pub gains: Gains<T>,
    /// Factors of the modes with fixed damping.
    pub fixed: Damping<T>,
    /// Prediction horizon of the fitness, s.
    pub horizon: T,
    /// Fitness weight of the velocity error, s2.
    pub weight_velocity: T,
    /// Fitness weight of the acceleration, s4.
    pub weight_acceleration: T,
    /// What the fitness adds for poses that three motors cannot hold.
    pub holding: HoldingTerm<T>,
}

/// Why the controller cannot start or go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ControlError {
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    #[error("swarm: {0}")]
    Swarm(#[from] SettingsError),
    #[error("{name} = {value} must be {condition}")]
    OutOfRange { name: &'static str, value: f64, condition: &'static str },
    #[error(
        "the measurements fit no pose of the mechanism: limb lengths {lengths:?} m, angles {angles:?} rad, \
         at rates {length_rates:?} m/s, {angle_rates:?} rad/s"
    )]
    NoPose { lengths: [f64; 3], angles: [f64; 3], length_rates: [f64; 3], angle_rates: [f64; 3] },
    #[error("the prediction over the computation delay fails: {0}")]
    Prediction(SolverError),
    #[error("the control law gave no finite voltages; gains, damping or measured rates are out of any sensible range")]
    NotFinite,
}

impl Default for Gains {
    fn default() -> Self {
        Self { position: d::K_P, velocity: d::K_D, acceleration: d::K_A }
    }
}

impl Default for SwarmParameters {
    fn default() -> Self {
        let largest = Damping { rho: d::RHO_MAX, delta_hd: d::DELTA_HD_MAX, lambda_f: d::LAMBDA_F_MAX };
        Self { settings: Settings::default(), largest }
    }
}

impl Default for ControllerParameters {
    fn default() -> Self {
        Self {
            mechanism: MechanismParameters::default(),
            sample_time: d::SAMPLE_TIME,
            computation_delay: false,
            waypoints: [
                [d::START_HEAVE, d::START_TILT_X, d::START_TILT_Y],
                [d::VIA_HEAVE, d::VIA_TILT_X, d::VIA_TILT_Y],
                [d::END_HEAVE, d::END_TILT_X, d::END_TILT_Y],
            ],
            move_time: d::MOVE_TIME,
            profile: Profile::Quintic,
            external_reference: false,
            sensors: SensorParameters::default(),
            sensor_timeout: d::SENSOR_TIMEOUT,
            filter_time: d::FILTER_TIME,
            swarm: SwarmParameters::default(),
            seed: d::SEED as u64,
        }
    }
}

impl Default for Tuning {
    fn default() -> Self {
        Self {
            mode: Mode::HdracMpso,
            gains: Gains::default(),
            fixed: Damping { rho: d::RHO_FIXED, delta_hd: d::DELTA_HD_FIXED, lambda_f: d::LAMBDA_F_FIXED },
            horizon: d::HORIZON,
            weight_velocity: d::WEIGHT_VELOCITY,
            weight_acceleration: d::WEIGHT_ACCELERATION,
            holding: HoldingTerm::default(),
        }
    }
}

impl ControllerParameters {
    /// # Errors
    /// Names the first parameter that makes no sense.
    pub fn validate(&self) -> Result<(), ControlError> {
        self.mechanism.validate()?;
        for (name, value) in [("sample_time", self.sample_time), ("move_time", self.move_time)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(ControlError::OutOfRange { name, value, condition: "positive and finite" });
            }
        }
        let largest = &self.swarm.largest;
        for (name, value) in [
            ("filter_time", self.filter_time),
            ("sensor_timeout", self.sensor_timeout),
            ("rho_max", largest.rho),
            ("delta_hd_max", largest.delta_hd),
            ("lambda_f_max", largest.lambda_f),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(ControlError::OutOfRange { name, value, condition: "finite and not negative" });
            }
        }
        for (name, waypoint) in
            [("start_*", self.waypoints[0]), ("via_*", self.waypoints[1]), ("end_*", self.waypoints[2])]
        {
            if let Some(&value) = waypoint.iter().find(|x| !x.is_finite()) {
                return Err(ControlError::OutOfRange { name, value, condition: "finite" });
            }
            let tilt = (waypoint[1] * waypoint[1] + waypoint[2] * waypoint[2]).sqrt();
            if tilt >= std::f64::consts::FRAC_PI_2 {
                return Err(ControlError::OutOfRange { name, value: tilt, condition: "a tilt below 90 deg" });
            }
        }
        Ok(())
    }
}
