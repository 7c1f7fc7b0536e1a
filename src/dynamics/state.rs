//! The plant's constants, state and inputs.

use nalgebra::{SVector, Vector3};

use super::{Bodies, EndStops, MechanismParameters, Motors, PlantParameters};
use crate::mechanism::Geometry;
use crate::scalar::Scalar;

/// Number of continuous states.
pub const STATES: usize = 12;

/// Nominal magnitudes of the states.
pub const NOMINAL: [f64; STATES] = [0.1, 0.1, 0.1, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];

/// Heave, tilt_x, tilt_y (m, rad); their rates; currents of the leg motors and of the revolute
/// motors (A).
pub type PlantState<T> = SVector<T, STATES>;

/// The state at `s` (m, rad, rad) and `s_dot` without any current.
pub fn moving<T: Scalar>(s: &Vector3<T>, s_dot: &Vector3<T>) -> PlantState<T> {
    let mut x = PlantState::zeros();
    x.fixed_rows_mut::<3>(0).copy_from(s);
    x.fixed_rows_mut::<3>(3).copy_from(s_dot);
    x
}

/// Inputs of the plant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inputs<T> {
    /// Terminal voltages of the leg motors, V.
    pub v_leg: Vector3<T>,
    /// Terminal voltages of the revolute motors, V.
    pub v_rev: Vector3<T>,
    /// External force at P, base frame, N.
    pub force: Vector3<T>,
    /// External moment on the platform, base frame, N.m.
    pub moment: Vector3<T>,
}

impl<T: Scalar> Inputs<T> {
    /// No voltages, no loads.
    pub fn zero() -> Self {
        Self { v_leg: Vector3::zeros(), v_rev: Vector3::zeros(), force: Vector3::zeros(), moment: Vector3::zeros() }
    }
}

/// Everything about the plant that does not change during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlantModel<T> {
    pub geometry: Geometry<T>,
    pub bodies: Bodies<T>,
    pub motors: Motors<T>,
    /// `None` for a model without end stops (the controller's).
    pub stops: Option<EndStops<T>>,
}

impl<T: Scalar> PlantModel<T> {
    /// The plant with its end stops. The parameters must have been validated.
    pub fn new(parameters: &PlantParameters<T>) -> Self {
        Self { stops: Some(EndStops::new(parameters)), ..Self::without_stops(&parameters.mechanism) }
    }

    /// The mechanism alone.
    pub fn without_stops(parameters: &MechanismParameters<T>) -> Self {
        Self {
            geometry: Geometry::new(parameters.base_radius, parameters.joint_spacing),
            bodies: Bodies::new(parameters),
            motors: Motors::new(parameters),
            stops: None,
        }
    }
}

/// Coordinates s of a state.
#[inline]
pub(crate) fn coordinates<T: Scalar>(x: &PlantState<T>) -> Vector3<T> {
    Vector3::new(x[0], x[1], x[2])
}

/// Rates s_dot of a state.
#[inline]
pub(crate) fn rates<T: Scalar>(x: &PlantState<T>) -> Vector3<T> {
    Vector3::new(x[3], x[4], x[5])
}

/// Currents (leg, revolute) of a state, A.
#[inline]
pub(crate) fn currents<T: Scalar>(x: &PlantState<T>) -> (Vector3<T>, Vector3<T>) {
    (Vector3::new(x[6], x[7], x[8]), Vector3::new(x[9], x[10], x[11]))
}
