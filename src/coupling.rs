//! Plant and controller coupled in process, without FMI: what every master's result is compared
//! with, and the fast way to studies of many runs.
#![forbid(unsafe_code)]

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::control::{
    ControlError, Controller, ControllerParameters, Diagnostics, Measurement, ReferencePoint, Tuning,
};
use crate::defaults as d;
use crate::dynamics::solver::{Settings, Solver, SolverError};
use crate::dynamics::{
    Inputs, NOMINAL, PlantModel, PlantParameters, PlantState, derivative, evaluate, settled_currents,
};

/// A load on the platform during a span of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Push {
    /// First and last instant, s.
    pub span: (f64, f64),
    /// Force at P, base frame, N.
    pub force: Vector3<f64>,
    /// Moment, base frame, N.m.
    pub moment: Vector3<f64>,
}

/// One run: the controller is called first at each tick, then the plant sees its voltages.
#[derive(Debug, Clone)]
pub struct Experiment {
    pub plant: PlantParameters,
    pub controller: ControllerParameters,
    pub tuning: Tuning,
    /// Duration, s.
    pub duration: f64,
    /// Local tolerance of the plant's solver.
    pub tolerance: f64,
    pub push: Option<Push>,
    /// Standard deviation of white noise on the measured limb lengths alone, m.
    pub length_noise: f64,
    pub noise_seed: u64,
}

impl Default for Experiment {
    /// The default experiment of both FMUs.
    fn default() -> Self {
        Self {
            plant: PlantParameters::default(),
            controller: ControllerParameters::default(),
            tuning: Tuning::default(),
            duration: d::STOP_TIME,
            tolerance: d::TOLERANCE,
            push: None,
            length_noise: 0.0,
            noise_seed: 1,
        }
    }
}

/// Pose and controller at a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Record {
    /// s
    pub time: f64,
    /// The plant's state at the tick.
    pub state: PlantState<f64>,
    pub diagnostics: Diagnostics,
}

/// Why a run ended early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RunError {
    #[error("at {time} s: {error}")]
    Control { time: f64, error: ControlError },
    #[error(transparent)]
    Solver(#[from] SolverError),
}

impl Record {
    /// The largest component of (heave, r_b tilt_x, r_b tilt_y) errors, m.
    pub fn pose_error(&self, joint_radius: f64) -> f64 {
        self.distance_from(&self.diagnostics.reference, joint_radius)
    }

    /// The same of the controller's estimate of the pose.
    pub fn estimate_error(&self, joint_radius: f64) -> f64 {
        self.distance_from(&self.diagnostics.estimate, joint_radius)
    }

    fn distance_from(&self, s: &Vector3<f64>, joint_radius: f64) -> f64 {
        let error = Vector3::new(self.state[0], self.state[1], self.state[2]) - s;
        error.x.abs().max(joint_radius * error.y.abs()).max(joint_radius * error.z.abs())
    }
}

/// What ideal sensors tell of the plant at state `x`.
pub fn measure(model: &PlantModel<f64>, x: &PlantState<f64>, inputs: &Inputs<f64>) -> Measurement<f64> {
    let e = evaluate(model, x, inputs);
    Measurement {
        lengths: Vector3::from(e.limbs.map(|limb| limb.length)),
        length_rates: Vector3::from(e.limb_motions.map(|motion| motion.length_rate)),
        angles: Vector3::from(e.limbs.map(|limb| limb.angle())),
        angle_rates: Vector3::from(e.limb_motions.map(|motion| motion.angle_rate)),
        leg_currents: Vector3::new(x[6], x[7], x[8]),
        revolute_currents: Vector3::new(x[9], x[10], x[11]),
        acceleration: e.motion.linear_bias + e.pose.linear_map * e.acceleration,
    }
}

impl Experiment {
    /// Runs it, giving each tick to `observe`.
    ///
    /// # Errors
    /// A controller or a plant that cannot go on.
    pub fn run(&self, observe: impl FnMut(&Record)) -> Result<(), RunError> {
        let mut controller =
            Controller::new(self.controller).map_err(|error| RunError::Control { time: 0.0, error })?;
        let external = ReferencePoint::default();
        let tick = |t: f64, measured: &Measurement<f64>| controller.tick(t, measured, &external, &self.tuning, true);
        self.run_with(tick, observe)
    }

    /// The same with `tick`, from time (s) and measurement, in the place of the controller.
    ///
    /// # Errors
    /// A controller or a plant that cannot go on.
    pub fn run_with(
        &self,
        mut tick: impl FnMut(f64, &Measurement<f64>) -> Result<Diagnostics, ControlError>,
        mut observe: impl FnMut(&Record),
    ) -> Result<(), RunError> {
        let model = PlantModel::new(&self.plant);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(self.noise_seed);
        let mut x = PlantState::zeros();
        let start = Vector3::from(self.plant.start);
        x.fixed_rows_mut::<3>(0).copy_from(&start);
        if let Some((leg, revolute)) = settled_currents(&model, &start, &Inputs::zero()) {
            x.fixed_rows_mut::<3>(6).copy_from(&leg);
            x.fixed_rows_mut::<3>(9).copy_from(&revolute);
        }
        let mut solver = Solver::default();
        let settings = Settings { tolerance: self.tolerance, nominal: NOMINAL, max_step: f64::INFINITY };
        let sample_time = self.controller.sample_time;
        let ticks = libm::round(self.duration / sample_time) as u64;
        let mut inputs = Inputs::zero();
        // as with a master that passes k times the step: its points and the ends of its steps differ by rounding
        let mut reached = 0.0;
        for k in 0..ticks {
            let time = k as f64 * sample_time;
            if let Some(push) = &self.push {
                let on = (push.span.0..push.span.1).contains(&time);
                inputs.force = if on { push.force } else { Vector3::zeros() };
                inputs.moment = if on { push.moment } else { Vector3::zeros() };
            }
            let mut measured = measure(&model, &x, &inputs);
            if self.length_noise > 0.0 {
                for i in 0..3 {
                    let noise: f64 = StandardNormal.sample(&mut rng);
                    measured.lengths[i] += self.length_noise * noise;
                }
            }
            let diagnostics = tick(time, &measured).map_err(|error| RunError::Control { time, error })?;
            observe(&Record { time, state: x, diagnostics });
            let v = &diagnostics.voltages;
            inputs.v_leg = Vector3::new(v[0], v[1], v[2]);
            inputs.v_rev = Vector3::new(v[3], v[4], v[5]);
            let end = time + sample_time;
            solver.integrate(|_, x| derivative(&model, x, &inputs), &mut x, reached, end, &settings)?;
            reached = end;
        }
        Ok(())
    }
}
