//! All calculated variables of the plant at a state, generic for exact derivatives.

use nalgebra::SVector;

use crate::dynamics::{
    Inputs, PlantModel, PlantState, STATES, derivative, electric_power, energy, evaluate, reactions,
};
use crate::mechanism::{OverallJacobian, SingularValues, normalized_det_a};
use crate::scalar::Scalar;

/// States, other outputs, and the derivatives that are no outputs, in the table's order: it puts
/// them in one row of consecutive slots.
pub const CALCULATED: usize = STATES + OUTPUTS + STATES - COORDINATES;
/// Outputs beside the states.
const OUTPUTS: usize = 41;
/// Their derivatives are states themselves.
const COORDINATES: usize = 3;

/// The values of all calculated variables.
pub type Calculated<T> = SVector<T, CALCULATED>;

/// Calculated variables at state `x` under `inputs`.
pub fn calculate<T: SingularValues>(model: &PlantModel<T>, x: &PlantState<T>, inputs: &Inputs<T>) -> Calculated<T> {
    let e = evaluate(model, x, inputs);
    let forces = reactions(model, &e, inputs);
    let acceleration = e.motion.linear_bias + e.pose.linear_map * e.acceleration;
    let quaternion = e.pose.quaternion();
    let jacobian = OverallJacobian::new(&model.geometry, &e.limbs);
    let mut result = Calculated::zeros();
    let mut row = Row { values: &mut result, next: 0 };
    row.put(x.as_slice());
    row.put(&e.limbs.map(|limb| limb.length));
    row.put(&e.limb_motions.map(|motion| motion.length_rate));
    row.put(&e.limbs.map(|limb| limb.angle()));
    row.put(&e.limb_motions.map(|motion| motion.angle_rate));
    row.put(forces.axial.as_slice());
    row.put(forces.normal.as_slice());
    row.put(forces.lateral.as_slice());
    row.put(e.pose.position.as_slice());
    row.put(e.motion.velocity.as_slice());
    row.put(acceleration.as_slice());
    row.put(e.motion.angular_velocity.as_slice());
    row.put(quaternion.as_slice());
    row.put(&[
        jacobian.sigma_min(),
        normalized_det_a(&model.geometry, &e.limbs),
        electric_power(model, x, inputs),
        energy(model, x),
    ]);
    row.put(&e.derivative.as_slice()[COORDINATES..]);
    debug_assert_eq!(row.next, CALCULATED);
    result
}

/// Whether [`states_and_derivatives`] has the variable in this place.
pub fn is_state_or_derivative(place: usize) -> bool {
    !(STATES..STATES + OUTPUTS).contains(&place)
}

/// As [`calculate`], the other outputs left zero: what the host's solver needs for its Jacobian.
pub fn states_and_derivatives<T: Scalar>(
    model: &PlantModel<T>,
    x: &PlantState<T>,
    inputs: &Inputs<T>,
) -> Calculated<T> {
    let mut result = Calculated::zeros();
    let (states, rest) = result.as_mut_slice().split_at_mut(STATES);
    states.copy_from_slice(x.as_slice());
    rest[OUTPUTS..].copy_from_slice(&derivative(model, x, inputs).as_slice()[COORDINATES..]);
    result
}

struct Row<'a, T> {
    values: &'a mut Calculated<T>,
    next: usize,
}

impl<T: Scalar> Row<'_, T> {
    fn put(&mut self, values: &[T]) {
        self.values.as_mut_slice()[self.next..self.next + values.len()].copy_from_slice(values);
        self.next += values.len();
    }
}
