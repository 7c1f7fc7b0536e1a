//! The schemes that a study compares: the controller's modes, and what else one could use.

use super::{Figures, PlatformComputedTorque, VariableDamping};
use crate::control::{Controller, Damping, Estimator, Gains, Measurement, Mode, ReferencePoint, Tuning};
use crate::coupling::{Experiment, Record, RunError};
use crate::mechanism::Geometry;

/// A named way to control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scheme {
    pub name: &'static str,
    pub law: Law,
    /// K_P, 1/s2, critically damped, where it is another than the experiment's.
    pub position_gain: Option<f64>,
}

/// How voltages come about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// The controller in a mode, with fixed factors where the mode uses them.
    Controller(Mode, Damping<f64>),
    /// The controller's DRAC with a damping that follows a measure of singularity.
    Variable(VariableDamping),
    /// Computed torque in the platform's own coordinates.
    Platform(PlatformComputedTorque),
}

const fn fixed(rho: f64, delta_hd: f64) -> Damping<f64> {
    Damping { rho, delta_hd, lambda_f: if rho > 0.01 { 0.1 * rho } else { 1e-3 } }
}

const fn scheme(name: &'static str, law: Law) -> Scheme {
    Scheme { name, law, position_gain: None }
}

const fn mode(name: &'static str, mode: Mode, damping: Damping<f64>) -> Scheme {
    scheme(name, Law::Controller(mode, damping))
}

/// The controller's modes, those with fixed damping with two settings each; the swarm is last.
pub const MODES: [Scheme; 6] = [
    mode("RAC", Mode::Rac, fixed(0.0, 0.0)),
    mode("DRAC 0.05", Mode::Drac, fixed(0.05, 0.0)),
    mode("DRAC 0.2", Mode::Drac, fixed(0.2, 0.0)),
    mode("HDRAC 0.05, 0.1", Mode::Hdrac, fixed(0.05, 0.1)),
    mode("HDRAC 0.05, 0.02", Mode::Hdrac, fixed(0.05, 0.02)),
    mode("HDRAC+MPSO", Mode::HdracMpso, fixed(0.05, 0.1)),
];

/// What a user would otherwise pick.
pub const BASELINES: [Scheme; 5] = [
    scheme("Nakamura-Hanafusa (manipulability)", Law::Variable(VariableDamping::NAKAMURA_HANAFUSA)),
    scheme("Maciejewski-Klein (sigma_min)", Law::Variable(VariableDamping::MACIEJEWSKI_KLEIN)),
    scheme("platform coordinates", Law::Platform(PlatformComputedTorque::FIXED)),
    scheme("platform coordinates, lambda_f searched", Law::Platform(PlatformComputedTorque::SEARCHED)),
    Scheme {
        name: "platform coordinates, K_P 3600",
        law: Law::Platform(PlatformComputedTorque::FIXED),
        position_gain: Some(3600.0),
    },
];

impl Scheme {
    /// Runs `experiment` with this scheme, giving each tick to `observe`.
    ///
    /// # Errors
    /// A controller or a plant that cannot go on.
    pub fn run(&self, experiment: &Experiment, observe: impl FnMut(&Record)) -> Result<(), RunError> {
        let gains = self.position_gain.map_or(experiment.tuning.gains, |k_p| Gains {
            position: k_p,
            velocity: 2.0 * k_p.sqrt(),
            ..experiment.tuning.gains
        });
        let experiment = &Experiment { tuning: Tuning { gains, ..experiment.tuning }, ..experiment.clone() };
        let at_start = |error| RunError::Control { time: 0.0, error };
        match self.law {
            Law::Controller(mode, fixed) => {
                Experiment { tuning: Tuning { mode, fixed, ..experiment.tuning }, ..experiment.clone() }.run(observe)
            }
            Law::Variable(rule) => {
                let mut controller = Controller::new(experiment.controller).map_err(at_start)?;
                let geometry = joints(experiment);
                let parameters = &experiment.controller;
                let mut estimator = Estimator::of(parameters);
                let tick = |t: f64, measured: &Measurement<f64>| {
                    let fixed = rule.damping(&geometry, &estimator.update(&geometry, measured).s);
                    let tuning = Tuning { mode: Mode::Drac, fixed, ..experiment.tuning };
                    controller.tick(t, measured, &ReferencePoint::default(), &tuning, true)
                };
                experiment.run_with(tick, observe)
            }
            Law::Platform(law) => {
                experiment.controller.validate().map_err(at_start)?;
                let mut state = law.start(&experiment.controller, &experiment.tuning);
                experiment.run_with(|t, measured| state.tick(t, measured), observe)
            }
        }
    }

    /// Figures of merit of that run.
    pub fn figures(&self, experiment: &Experiment) -> Figures {
        Figures::of(experiment, |observe| self.run(experiment, observe))
    }
}

fn joints(experiment: &Experiment) -> Geometry<f64> {
    let mechanism = &experiment.controller.mechanism;
    Geometry::new(mechanism.base_radius, mechanism.joint_spacing)
}
