//! DC motors (2.3) and their drives.

use nalgebra::Vector3;

use super::MechanismParameters;
use crate::scalar::{Scalar, constant};

/// A motor seen through its transmission: rotor angle = ratio x joint displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive<T> {
    /// Joint force (N) or torque (N.m) per ampere; back-emf (V) per joint rate.
    pub force_constant: T,
    /// Rotor inertia at the joint, kg or kg.m2.
    pub reflected_inertia: T,
    /// Rotor friction at the joint, N.s/m or N.m.s/rad.
    pub reflected_friction: T,
}

/// The six motors. Without revolute motors their circuits are open: no current, no torque, but the
/// rotors still turn with the gears, so that both variants are one mechanism with one mass matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motors<T> {
    /// Through the screw, ratio 2 pi / lead (rad/m).
    pub leg: Drive<T>,
    /// Through the gear.
    pub revolute: Drive<T>,
    /// The revolute motors are powered.
    pub revolute_motors: bool,
    /// Armature inductance, H.
    pub inductance: T,
    /// Armature resistance, Ohm.
    pub resistance: T,
    /// Terminal voltage limit, V.
    pub v_max: T,
}

impl<T: Scalar> Drive<T> {
    fn new(parameters: &MechanismParameters<T>, ratio: T) -> Self {
        Self {
            force_constant: ratio * parameters.motor_kt,
            reflected_inertia: ratio * ratio * parameters.motor_jm,
            reflected_friction: ratio * ratio * parameters.motor_bm,
        }
    }

    /// Joint forces, N or N.m, that friction takes of three motors at these joint rates, m/s or rad/s.
    #[inline]
    pub fn friction(&self, joint_rates: &Vector3<T>) -> Vector3<T> {
        joint_rates * self.reflected_friction
    }
}

impl<T: Scalar> Motors<T> {
    pub(super) fn new(parameters: &MechanismParameters<T>) -> Self {
        Self {
            leg: Drive::new(parameters, constant::<T>(std::f64::consts::TAU) / parameters.screw_lead),
            revolute: Drive::new(parameters, parameters.gear_ratio),
            revolute_motors: parameters.revolute_motors,
            inductance: parameters.motor_la,
            resistance: parameters.motor_ra,
            v_max: parameters.v_max,
        }
    }

    /// The voltage that reaches the terminals, V.
    #[inline]
    pub fn limit(&self, voltage: T) -> T {
        if voltage > self.v_max {
            self.v_max
        } else if voltage < -self.v_max {
            -self.v_max
        } else {
            voltage
        }
    }

    /// Rates of three currents (2.3), A/s, from the demanded voltages and the joint rates.
    #[inline]
    pub fn current_rates(
        &self,
        drive: &Drive<T>,
        voltages: &Vector3<T>,
        currents: &Vector3<T>,
        joint_rates: &Vector3<T>,
    ) -> Vector3<T> {
        let limited = voltages.map(|v| self.limit(v));
        (limited - currents * self.resistance - joint_rates * drive.force_constant) / self.inductance
    }
}
