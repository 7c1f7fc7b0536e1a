//! The first tick's outputs in any number type, for exact derivatives.
//!
//! [`super::Controller::tick`] works in the singular basis, which is quick for many dampings but
//! cannot be differentiated through; here the same equations stand in matrix form. The swarm's
//! damping is taken as given: by the envelope theorem the fitness at the optimum has the same
//! derivative, and what the other outputs would owe to a moving optimum is left out.

use nalgebra::{Vector3, Vector6};

use super::actuation::{currents, voltages};
use super::fitness::fitness_of_currents;
use super::{
    Damping, Diagnostics, Estimate, Measurement, Mode, ReferencePoint, Situation, Tuning, lyapunov, lyapunov_rate,
};
use crate::dynamics::PlantModel;
use crate::mechanism::{Pose, SingularValues, rotation_vector};
use crate::scalar::Scalar;

/// What a tick starts from.
#[derive(Debug, Clone, Copy)]
pub struct Start<T> {
    /// Sensor readings.
    pub measured: Measurement<T>,
    /// The state estimated from them.
    pub estimate: Estimate<T>,
    /// Reference at the tick and at the horizon of the fitness.
    pub reference: ReferencePoint<T>,
    pub ahead: ReferencePoint<T>,
    /// s
    pub sample_time: T,
}

/// Outputs of a tick without computation delay. `found` is the swarm's damping, for
/// [`Mode::HdracMpso`]. `None` where an undamped J is singular.
pub fn preview<T: SingularValues>(
    model: &PlantModel<T>,
    start: &Start<T>,
    tuning: &Tuning<T>,
    found: &Damping<T>,
) -> Option<Diagnostics<T>> {
    let Start { measured, estimate, reference, ahead, sample_time } = start;
    let situation = Situation::new(model, estimate, reference, measured, &tuning.gains);
    let damping = tuning.mode.fixed_damping(&tuning.fixed).unwrap_or(*found);
    let sigma_min = T::sigma_min(&situation.jacobian);
    let rho_hd = damping.rho_hd(sigma_min, *sample_time);
    let allowed = &situation.allowed;
    let y = damping.acceleration(&allowed.jacobian, &allowed.desired, &allowed.twist, rho_hd)?;
    let force = situation.generalized_force(&allowed.coordinate_acceleration(&y));
    let wanted = currents(model, &situation, &force, damping.lambda_f);
    let command = voltages(&model.motors, &situation, &wanted, &stacked_currents(measured), *sample_time);
    let fitness = match tuning.mode {
        Mode::HdracMpso => fitness_of_currents(model, &situation, &wanted, ahead, tuning),
        _ => T::zero(),
    };
    let (position_error, rotation_error) = pose_errors(model, &estimate.s, &reference.position);
    Some(Diagnostics {
        voltages: command.voltages,
        saturated: command.saturated,
        damping,
        rho_hd,
        sigma_min,
        lyapunov: lyapunov(&situation, &tuning.gains, damping.rho),
        lyapunov_rate: lyapunov_rate(&situation, &tuning.gains, damping.rho, rho_hd),
        estimate: estimate.s,
        reference: reference.position,
        position_error,
        rotation_error,
        fitness,
        iterations: 0,
    })
}

/// Measured currents of leg and revolute motors, A.
pub(crate) fn stacked_currents<T: Scalar>(measured: &Measurement<T>) -> Vector6<T> {
    let (leg, revolute) = (&measured.leg_currents, &measured.revolute_currents);
    Vector6::new(leg.x, leg.y, leg.z, revolute.x, revolute.y, revolute.z)
}

/// Distance of P (m) and angle (rad) between two poses.
pub(crate) fn pose_errors<T: Scalar>(model: &PlantModel<T>, s: &Vector3<T>, reference: &Vector3<T>) -> (T, T) {
    let (pose, target) = (Pose::new(&model.geometry, s), Pose::new(&model.geometry, reference));
    let rotation = target.rotation * pose.rotation.transpose();
    (length(&(target.position - pose.position)), length(&rotation_vector(&rotation)))
}

/// Euclidean norm whose derivative at zero is zero and not undefined.
fn length<T: Scalar>(v: &Vector3<T>) -> T {
    let square = v.norm_squared();
    if square > T::zero() { square.sqrt() } else { T::zero() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::PlantParameters;

    #[test]
    fn pose_errors_are_a_distance_and_an_angle() {
        let model = PlantModel::<f64>::new(&PlantParameters::default());
        // without torsion, tilts about one axis differ by a rotation about it
        let (reference, s) = (Vector3::new(0.05, 0.03, 0.04), Vector3::new(0.05, 0.06, 0.08));
        let (_, angle) = pose_errors(&model, &s, &reference);
        assert!((angle - 0.05).abs() < 1e-14, "{angle}");
        let (distance, angle) = pose_errors(&model, &Vector3::new(0.07, 0.03, 0.04), &reference);
        assert!((distance - 0.02).abs() < 1e-15 && angle < 1e-15, "{distance} {angle}");
        assert_eq!(pose_errors(&model, &s, &s), (0.0, 0.0));
    }
}
