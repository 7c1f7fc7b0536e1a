//! What one would otherwise pick. None of it is part of the FMUs.

use nalgebra::Vector3;

use crate::control::{
    ControlError, ControllerParameters, Damping, Diagnostics, Estimator, Fitness, ForceDistribution, Measurement,
    Reference, SingularBasis, Situation, Tuning, VoltageCommand, lyapunov, lyapunov_rate, pose_errors,
    stacked_currents, voltages,
};
use crate::defaults as d;
use crate::dynamics::PlantModel;
use crate::mechanism::{Geometry, Limb, OverallJacobian, Pose};

/// A damping of DRAC that grows towards the singularity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VariableDamping {
    measure: Measure,
    /// rho at the singularity.
    largest: f64,
    /// Measure from which on nothing is damped.
    threshold: f64,
}

/// How far a pose is from singular, dimensionless.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Measure {
    /// Manipulability w = |det J|.
    Manipulability,
    /// Smallest singular value of J.
    SmallestSingularValue,
}

impl VariableDamping {
    /// rho^2 = rho_0^2 (1 - w / w_0)^2: Y. Nakamura, H. Hanafusa, "Inverse Kinematic Solutions With
    /// Singularity Robustness for Robot Manipulator Control", J. Dyn. Sys. Meas. Control 108 (1986).
    pub const NAKAMURA_HANAFUSA: Self = Self { measure: Measure::Manipulability, largest: 0.05, threshold: 0.02 };
    /// rho^2 = rho_0^2 (1 - (sigma / epsilon)^2): A. A. Maciejewski, C. A. Klein, "Numerical filtering for
    /// the operation of robotic manipulators through kinematically singular configurations", J. Robotic Syst. 5 (1988),
    /// in the form of S. Chiaverini, IEEE Trans. Robot. Autom. 13 (1997).
    pub const MACIEJEWSKI_KLEIN: Self = Self { measure: Measure::SmallestSingularValue, largest: 0.05, threshold: 0.1 };

    /// The damping at the pose `s` (m, rad, rad); the force distribution's is that of the fixed modes.
    pub fn damping(&self, geometry: &Geometry<f64>, s: &Vector3<f64>) -> Damping<f64> {
        let jacobian = OverallJacobian::new(geometry, &Limb::all(geometry, &Pose::new(geometry, s)));
        let share = match self.measure {
            Measure::Manipulability => (1.0 - jacobian.matrix.determinant().abs() / self.threshold).max(0.0),
            Measure::SmallestSingularValue => {
                let ratio = jacobian.sigma_min() / self.threshold;
                (1.0 - ratio * ratio).max(0.0).sqrt()
            }
        };
        let rho = self.largest * share;
        Damping { rho, delta_hd: 0.0, lambda_f: d::LAMBDA_F_FIXED }
    }
}

/// Computed torque with the error composed in s = (heave, tilt_x, tilt_y), where no inverse of J
/// is needed: s_ddot = s_r_ddot + K_D (s_r_dot - s_dot) + K_P (s_r - s). Only the distribution of
/// its force to three motors meets the singularity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlatformComputedTorque {
    /// lambda_f is searched at each tick by the swarm's fitness instead of being fixed.
    searched: bool,
}

/// [`PlatformComputedTorque`] at work.
#[derive(Debug, Clone)]
pub struct PlatformController {
    searched: bool,
    parameters: ControllerParameters,
    tuning: Tuning,
    model: PlantModel<f64>,
    reference: Reference<f64>,
    estimator: Estimator,
}

/// Values of lambda_f looked at, from the largest down, and their ratio.
const CANDIDATES: i32 = 60;
const RATIO: f64 = 0.8;

impl PlatformComputedTorque {
    /// With the fixed lambda_f of the modes with fixed damping.
    pub const FIXED: Self = Self { searched: false };
    /// With lambda_f searched.
    pub const SEARCHED: Self = Self { searched: true };

    /// Before the first tick.
    pub fn start(&self, parameters: &ControllerParameters, tuning: &Tuning) -> PlatformController {
        let model = PlantModel::without_stops(&parameters.mechanism);
        PlatformController {
            searched: self.searched,
            parameters: *parameters,
            tuning: *tuning,
            reference: Reference::of(parameters),
            estimator: Estimator::of(parameters),
            model,
        }
    }
}

impl PlatformController {
    /// One tick, `t` s after the start.
    ///
    /// # Errors
    /// None so far: a state that is not finite ends the run in the plant's solver.
    pub fn tick(&mut self, t: f64, measured: &Measurement<f64>) -> Result<Diagnostics, ControlError> {
        let Self { model, tuning, .. } = self;
        let sample_time = self.parameters.sample_time;
        let estimate = self.estimator.update(&model.geometry, measured);
        let now = self.reference.at(t);
        let situation = Situation::new(model, &estimate, &now, measured, &tuning.gains);
        let basis = SingularBasis::new(&situation);
        let distribution = ForceDistribution::new(model, &situation);
        let acceleration = now.acceleration
            + (now.rate - estimate.s_dot) * tuning.gains.velocity
            + (now.position - estimate.s) * tuning.gains.position;
        let mut lambda_f = d::LAMBDA_F_FIXED;
        let mut fitness = 0.0;
        if self.searched {
            let ahead = self.reference.at(t + tuning.horizon);
            let objective = Fitness::new(model, &situation, &basis, &distribution, &ahead, tuning, sample_time);
            let candidates = (0..CANDIDATES).map(|k| d::LAMBDA_F_MAX * RATIO.powi(k)).chain([0.0]);
            (fitness, lambda_f) = candidates
                .map(|lambda_f| (objective.of_acceleration(&acceleration, lambda_f), lambda_f))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .unwrap_or((0.0, lambda_f));
        }
        let wanted = distribution.currents(&situation.generalized_force(&acceleration), lambda_f);
        let VoltageCommand { voltages, saturated } =
            voltages(&model.motors, &situation, &wanted, &stacked_currents(measured), sample_time);
        let (position_error, rotation_error) = pose_errors(model, &estimate.s, &now.position);
        Ok(Diagnostics {
            voltages,
            saturated,
            damping: Damping { rho: 0.0, delta_hd: 0.0, lambda_f },
            rho_hd: 0.0,
            sigma_min: basis.sigma_min,
            lyapunov: lyapunov(&situation, &tuning.gains, 0.0),
            lyapunov_rate: lyapunov_rate(&situation, &tuning.gains, 0.0, 0.0),
            estimate: estimate.s,
            reference: now.position,
            position_error,
            rotation_error,
            fitness,
            iterations: 0,
        })
    }
}
