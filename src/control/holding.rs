//! Poses that three motors can hold.
//!
//! Against the platform's weight three motors need voltages that grow with 1 / sigma_min. Next to a direct
//! singularity a pose error of a tenth of a millimetre can therefore lie beyond the voltage limit, and what is
//! once there sinks away. A prediction that only knows the situation of the tick does not see that edge, so
//! the fitness asks for it: the voltages that hold the pose at the horizon, linear about the reference there.

use nalgebra::{Matrix3, Vector3};

use super::{ReferencePoint, Situation};
use crate::dynamics::{Inputs, PlantModel, current_maps, static_load};
use crate::mechanism::{Limb, Pose};
use crate::scalar::{Scalar, constant};

/// Voltages of the leg motors that hold the predicted pose.
#[derive(Debug, Clone, Copy)]
pub(super) struct Holding<T> {
    /// Of the pose that no acceleration leads to, V.
    voltages: Vector3<T>,
    /// V per s_ddot, held up to the horizon.
    slope: Matrix3<T>,
    /// V
    limit: T,
}

/// Share of the voltage limit that may go into holding.
const USABLE: f64 = 0.97;
/// What a volt beyond it counts, squared, m2/V2: more than any error of the pose.
const WEIGHT: f64 = 1e-6;
/// Step of the difference quotients, m or rad: far below the distance over which the voltages change,
/// far above rounding.
const STEP: f64 = 1e-7;

impl<T: Scalar> Holding<T> {
    /// At `situation`, with the reference `ahead` at the horizon (s). `None` where the motors cannot even hold that,
    /// as in the midst of a crossing, and with six motors, which hold every pose within the joints' limits.
    pub fn new(model: &PlantModel<T>, situation: &Situation<T>, ahead: &ReferencePoint<T>, horizon: T) -> Option<Self> {
        if model.motors.revolute_motors {
            return None;
        }
        let limit = model.motors.v_max * constant(USABLE);
        let target = ahead.position;
        let voltages = voltages(model, &target).filter(|v| v.iter().all(|v| v.abs() < limit))?;
        let mut gradient = Matrix3::zeros();
        for k in 0..3 {
            let mut aside = target;
            aside[k] += constant(STEP);
            let change = self::voltages(model, &aside)? - voltages;
            gradient.set_column(k, &(change / constant::<T>(STEP)));
        }
        let still = situation.s + situation.s_dot * horizon - target;
        Some(Self {
            voltages: voltages + gradient * still,
            slope: gradient * (horizon * horizon * constant(0.5)),
            limit,
        })
    }

    /// The part of the fitness, m2, for an s_ddot ((m, rad, rad)/s2) held up to the horizon.
    #[inline]
    pub fn weigh(&self, acceleration: &Vector3<T>) -> T {
        let voltages = self.voltages + self.slope * acceleration;
        let excess = voltages.map(|v| (v.abs() - self.limit).max(T::zero()));
        excess.norm_squared() * constant(WEIGHT)
    }
}

/// Voltages of three leg motors that hold the pose `s` (m, rad, rad), V. `None` at a direct singularity.
fn voltages<T: Scalar>(model: &PlantModel<T>, s: &Vector3<T>) -> Option<Vector3<T>> {
    let limbs = Limb::all(&model.geometry, &Pose::new(&model.geometry, s));
    let (leg_map, _) = current_maps(model, &limbs);
    let currents = leg_map.try_inverse()? * static_load(model, s, &Inputs::zero());
    Some(currents * model.motors.resistance)
}
