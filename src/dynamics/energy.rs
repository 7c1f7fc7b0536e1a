//! Energy and power of the plant.

use super::state::{coordinates, currents, rates};
use super::{Inputs, PlantModel, PlantState};
use crate::mechanism::{Limb, Pose};
use crate::scalar::{Scalar, constant};

/// Kinetic, potential, magnetic and end-stop energy, J.
pub fn energy<T: Scalar>(model: &PlantModel<T>, x: &PlantState<T>) -> T {
    let s_dot = rates(x);
    let pose = Pose::new(&model.geometry, &coordinates(x));
    let limbs = Limb::all(&model.geometry, &pose);
    let mass_matrix = model.bodies.mass_matrix(&pose, &limbs, &model.motors);
    let (i_leg, i_rev) = currents(x);
    let twice =
        s_dot.dot(&(mass_matrix * s_dot)) + model.motors.inductance * (i_leg.norm_squared() + i_rev.norm_squared());
    let mut energy = twice * constant(0.5) + model.bodies.potential_energy(&pose, &limbs);
    if let Some(stops) = &model.stops {
        for limb in &limbs {
            energy += stops.length.energy(limb.length) + stops.angle.energy(limb.angle());
        }
    }
    energy
}

/// Power that enters at the motors' terminals, W.
pub fn electric_power<T: Scalar>(model: &PlantModel<T>, x: &PlantState<T>, inputs: &Inputs<T>) -> T {
    let (i_leg, i_rev) = currents(x);
    let limit = |v| model.motors.limit(v);
    let mut power = inputs.v_leg.map(limit).dot(&i_leg);
    if model.motors.revolute_motors {
        power += inputs.v_rev.map(limit).dot(&i_rev);
    }
    power
}
