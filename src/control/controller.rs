//! The sampled controller: one tick from measurement to voltages.

use nalgebra::{Vector3, Vector6};
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use super::actuation::voltages;
use super::mpso::Progress;
use super::parameters::Tuning;
use super::preview::{pose_errors, stacked_currents};
use super::search::{Elite, Search};
use super::sensor_watch::Used;
use super::{
    ControlError, ControllerParameters, Damping, Estimate, Estimator, ExternalReference, Fitness, ForceDistribution,
    Measurement, Reference, ReferencePoint, SensorFaults, SensorWatch, Sensors, SingularBasis, Situation,
    VoltageCommand, lyapunov, lyapunov_rate,
};
use crate::dynamics::solver::{Settings, Solver};
use crate::dynamics::{Inputs, NOMINAL, PlantModel, STATES, derivative, moving};
use crate::mechanism::Geometry;
use crate::scalar::Scalar;

/// The controller between ticks.
#[derive(Debug, Serialize, Deserialize)]
#[serde(try_from = "Saved", into = "Saved")]
pub struct Controller {
    parameters: ControllerParameters,
    /// Derived from `parameters`.
    model: PlantModel<f64>,
    reference: Reference<f64>,
    search: Search,
    /// What changes from tick to tick.
    memory: Memory,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Memory {
    estimator: Estimator,
    watch: SensorWatch,
    sensors: Sensors,
    rng: Xoshiro256PlusPlus,
    /// What the last search leaves for the next.
    elite: Elite,
    /// Voltages in force, V.
    voltages: [f64; 6],
    /// See [`Controller::work`].
    work: u64,
}

#[derive(Serialize, Deserialize)]
struct Saved {
    parameters: ControllerParameters,
    memory: Memory,
}

impl TryFrom<Saved> for Controller {
    type Error = ControlError;

    fn try_from(saved: Saved) -> Result<Self, ControlError> {
        let mut controller = Self::new(saved.parameters)?;
        controller.memory = saved.memory;
        Ok(controller)
    }
}

impl From<Controller> for Saved {
    fn from(controller: Controller) -> Self {
        Self { parameters: controller.parameters, memory: controller.memory }
    }
}

impl Clone for Controller {
    fn clone(&self) -> Self {
        Self { search: self.search.clone(), memory: self.memory.clone(), ..*self }
    }

    /// Keeps the swarm, a mere workspace, if it fits: so a backup at every step allocates nothing.
    fn clone_from(&mut self, source: &Self) {
        if self.parameters == source.parameters {
            self.memory.clone_from(&source.memory);
        } else {
            *self = source.clone();
        }
    }
}

/// What a tick leaves for the outputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Diagnostics<T = f64> {
    /// Voltages for leg and revolute motors, V.
    pub voltages: Vector6<T>,
    /// A voltage is at its limit.
    pub saturated: bool,
    /// Damping in force.
    pub damping: Damping<T>,
    /// rho_hd in force, 1/s.
    pub rho_hd: T,
    /// Smallest singular value of J at the estimated pose.
    pub sigma_min: T,
    /// L (5.2), m2/s2, and its rate, m2/s3.
    pub lyapunov: T,
    pub lyapunov_rate: T,
    /// Estimated coordinates, m, rad, rad.
    pub estimate: Vector3<T>,
    /// Reference coordinates, m, rad, rad.
    pub reference: Vector3<T>,
    /// Distance of P from its reference, m.
    pub position_error: T,
    /// Angle between platform and its reference, rad.
    pub rotation_error: T,
    /// Best fitness of the swarm, m2, and its iterations; 0 in modes without swarm.
    pub fitness: T,
    pub iterations: usize,
}

/// The prediction over a delay of one sample; the state is known less well than this.
const PREDICTION: Settings<STATES> = Settings { tolerance: 1e-7, nominal: NOMINAL, max_step: f64::INFINITY };

/// What a tick without its search costs at least, in evaluations of the fitness, roughly.
pub const LEAST_WORK: u64 = 100;
/// What a right-hand side of the dynamics costs.
const WORK_OF_A_DERIVATIVE: u64 = 5;

impl Controller {
    /// A controller before its first tick.
    ///
    /// # Errors
    /// Parameters that make no sense.
    pub fn new(parameters: ControllerParameters) -> Result<Self, ControlError> {
        parameters.validate()?;
        let model = PlantModel::without_stops(&parameters.mechanism);
        let reference = Reference::of(&parameters);
        let search = Search::new(parameters.swarm, parameters.mechanism.revolute_motors)?;
        let rng = Xoshiro256PlusPlus::seed_from_u64(parameters.seed);
        let mut sensor_rng = rng.clone();
        // a stream of its own, so that the swarm's luck does not depend on the sensors
        sensor_rng.jump();
        let memory = Memory {
            estimator: Estimator::of(&parameters),
            watch: SensorWatch::new(parameters.sensor_timeout, parameters.sample_time, &parameters.sensors),
            sensors: Sensors::new(parameters.sensors, sensor_rng),
            rng,
            elite: Elite::default(),
            voltages: [0.0; 6],
            work: 0,
        };
        Ok(Self { parameters, model, reference, search, memory })
    }

    /// What the sensors would read of `measured` at the next tick, and the state estimated from it
    /// alone, in any number type: readings keep the derivatives of what they measure.
    pub fn first_estimate<T: Scalar>(
        &self,
        geometry: &Geometry<T>,
        measured: &Measurement<T>,
        value: impl Fn(T) -> f64,
    ) -> (Measurement<T>, Estimate<T>) {
        let truth = measured.map(&value);
        let reading = self.memory.sensors.clone().read(&truth);
        let mut read = *measured;
        for i in 0..3 {
            read.lengths[i] += T::from(reading.lengths[i] - truth.lengths[i]);
            read.angles[i] += T::from(reading.angles[i] - truth.angles[i]);
        }
        let estimator = &self.memory.estimator;
        let waypoint = Vector3::from(self.parameters.waypoints[0]);
        let near = estimator.find(&self.model.geometry, &reading, &waypoint).estimate;
        (read, estimator.fit(geometry, &read, &near.s.map(T::from), true).estimate)
    }

    /// Parameters in force.
    pub fn parameters(&self) -> &ControllerParameters {
        &self.parameters
    }

    /// Takes `voltages` (V) as those in force until the first tick's reach the motors, and
    /// `measured` as valid until then.
    pub fn assume(&mut self, voltages: &Vector6<f64>, measured: &Measurement<f64>) {
        self.memory.voltages = (*voltages).into();
        self.memory.watch.assume(measured);
    }

    /// What all ticks so far cost, in evaluations of the fitness: a measure of time that is the same
    /// on every machine.
    pub fn work(&self) -> u64 {
        self.memory.work
    }

    /// What was wrong with the sensors at the last [`watched_tick`](Self::watched_tick).
    pub fn sensor_faults(&self) -> SensorFaults {
        self.memory.watch.faults()
    }

    /// By how much the readings of the last tick contradict each other, see [`Estimator::contradiction`]; `None` also where
    /// a known fault of a sensor explains it.
    pub fn contradiction(&self) -> Option<f64> {
        if self.sensor_faults().any() { None } else { self.memory.estimator.contradiction() }
    }

    /// One [`tick`](Self::tick) under the watch of [`SensorWatch`]: measurements that are not finite
    /// are missing, `fresh` ones may be frozen, and what lasts too long ends in zero voltages.
    ///
    /// # Errors
    /// As [`tick`](Self::tick).
    pub fn watched_tick(
        &mut self,
        t: f64,
        measured: &Measurement<f64>,
        fresh: bool,
        external: &ReferencePoint<f64>,
        tuning: &Tuning,
    ) -> Result<Diagnostics, ControlError> {
        let used = Used {
            revolute_currents: self.parameters.mechanism.revolute_motors,
            acceleration: tuning.gains.acceleration != 0.0,
        };
        let valid = self.memory.watch.check(measured, fresh, used);
        let mut diagnostics = self.tick(t, &valid, external, tuning, true)?;
        if self.memory.watch.faults().cut_off {
            diagnostics.voltages = Vector6::zeros();
            diagnostics.saturated = false;
            self.memory.voltages = [0.0; 6];
        }
        Ok(diagnostics)
    }

    /// The reference `t` s after the start; `external` where it comes from outside, given `ahead` s before `t`.
    fn reference_at(&self, external: &ReferencePoint<f64>, t: f64, ahead: f64) -> ReferencePoint<f64> {
        if self.parameters.external_reference {
            ExternalReference(*external).ahead(ahead)
        } else {
            self.reference.at(t)
        }
    }

    /// One tick, `t` s after the start.
    ///
    /// With a computation delay the voltages are meant for one sample later, when the state will
    /// be what the model predicts; `delayed` false suspends that, for the very first voltages.
    ///
    /// # Errors
    /// Measurements that fit no pose; a result that is not finite. The controller is then in an
    /// undefined state between two ticks: restore an earlier one.
    pub fn tick(
        &mut self,
        t: f64,
        measured: &Measurement<f64>,
        external: &ReferencePoint<f64>,
        tuning: &Tuning,
        delayed: bool,
    ) -> Result<Diagnostics, ControlError> {
        self.tick_observed(t, measured, external, tuning, delayed, |_| {})
    }

    /// [`tick`](Self::tick) that tells `observer` how the swarm's search goes on, in mode 4.
    ///
    /// # Errors
    /// As [`tick`](Self::tick).
    pub fn tick_observed(
        &mut self,
        t: f64,
        measured: &Measurement<f64>,
        external: &ReferencePoint<f64>,
        tuning: &Tuning,
        delayed: bool,
        observer: impl FnMut(&Progress),
    ) -> Result<Diagnostics, ControlError> {
        self.memory.work = self.memory.work.saturating_add(LEAST_WORK);
        let measured = self.memory.sensors.read(measured);
        let estimate = self.memory.estimator.update(&self.model.geometry, &measured);
        if !(estimate.s.amax() < LARGEST_POSE && estimate.s_dot.amax().is_finite()) {
            return Err(ControlError::NoPose {
                lengths: measured.lengths.into(),
                angles: measured.angles.into(),
                length_rates: measured.length_rates.into(),
                angle_rates: measured.angle_rates.into(),
            });
        }
        let currents = stacked_currents(&measured);
        let (ahead, acting, currents) = if self.parameters.computation_delay && delayed {
            let (acting, currents) = self.predict(&estimate, &currents)?;
            (self.parameters.sample_time, acting, currents)
        } else {
            (0.0, estimate, currents)
        };
        let reference = self.reference_at(external, t + ahead, ahead);
        let situation = Situation::new(&self.model, &acting, &reference, &measured, &tuning.gains);
        let basis = SingularBasis::new(&situation);
        let distribution = ForceDistribution::new(&self.model, &situation);
        let sample_time = self.parameters.sample_time;
        let (damping, fitness, iterations) = match tuning.mode.fixed_damping(&tuning.fixed) {
            Some(fixed) => (fixed, 0.0, 0),
            None => {
                let horizon = ahead + tuning.horizon;
                let target = self.reference_at(external, t + horizon, horizon);
                let fitness =
                    Fitness::new(&self.model, &situation, &basis, &distribution, &target, tuning, sample_time);
                self.search(&fitness, basis.sigma_min, tuning, observer)
            }
        };
        let rho_hd = damping.rho_hd(basis.sigma_min, sample_time);
        let acceleration = basis.coordinate_acceleration(damping.rho, rho_hd);
        let force = situation.generalized_force(&acceleration);
        let wanted = distribution.currents(&force, damping.lambda_f);
        let VoltageCommand { voltages, saturated } =
            voltages(&self.model.motors, &situation, &wanted, &currents, sample_time);
        if !voltages.iter().all(|v| v.is_finite()) {
            return Err(ControlError::NotFinite);
        }
        self.memory.voltages = voltages.into();
        let now = self.reference_at(external, t, 0.0);
        let (position_error, rotation_error) = pose_errors(&self.model, &estimate.s, &now.position);
        Ok(Diagnostics {
            voltages,
            saturated,
            damping,
            rho_hd,
            sigma_min: basis.sigma_min,
            lyapunov: lyapunov(&situation, &tuning.gains, damping.rho),
            lyapunov_rate: lyapunov_rate(&situation, &tuning.gains, damping.rho, rho_hd),
            estimate: estimate.s,
            reference: now.position,
            position_error,
            rotation_error,
            fitness,
            iterations,
        })
    }

    /// State and currents one sample ahead under the voltages in force.
    fn predict(
        &mut self,
        estimate: &Estimate<f64>,
        currents: &Vector6<f64>,
    ) -> Result<(Estimate<f64>, Vector6<f64>), ControlError> {
        let mut x = moving(&estimate.s, &estimate.s_dot);
        x.fixed_rows_mut::<6>(6).copy_from(currents);
        if !self.parameters.mechanism.revolute_motors {
            // their circuits are open, whatever the sensors say
            x.fixed_rows_mut::<3>(9).fill(0.0);
        }
        let v = self.memory.voltages;
        let inputs =
            Inputs { v_leg: Vector3::new(v[0], v[1], v[2]), v_rev: Vector3::new(v[3], v[4], v[5]), ..Inputs::zero() };
        let mut solver = Solver::default();
        solver
            .integrate(
                |_, x| derivative(&self.model, x, &inputs),
                &mut x,
                0.0,
                self.parameters.sample_time,
                &PREDICTION,
            )
            .map_err(ControlError::Prediction)?;
        self.memory.work = self.memory.work.saturating_add(WORK_OF_A_DERIVATIVE * solver.evaluations);
        let predicted = Estimate { s: x.fixed_rows::<3>(0).into(), s_dot: x.fixed_rows::<3>(3).into() };
        Ok((predicted, x.fixed_rows::<6>(6).into()))
    }

    /// The swarm's optimum: damping, fitness, iterations.
    fn search(
        &mut self,
        fitness: &Fitness,
        sigma_min: f64,
        tuning: &Tuning,
        observer: impl FnMut(&Progress),
    ) -> (Damping<f64>, f64, usize) {
        let Memory { rng, elite, work, .. } = &mut self.memory;
        let (damping, solution) = self.search.find(rng, elite, fitness, sigma_min, observer);
        *work = work.saturating_add(solution.evaluations as u64);
        if !solution.value.is_finite() {
            return (tuning.fixed, solution.value, solution.iterations);
        }
        (damping, solution.value, solution.iterations)
    }
}

/// No mechanism of sensible size is as high, in m, or tilts as far, in rad, as this times its base.
const LARGEST_POSE: f64 = 1e3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::SensorParameters;

    #[test]
    fn sensors_and_swarm_have_their_luck_from_different_streams() {
        let sensors = SensorParameters { scale: 1.0, ..SensorParameters::default() };
        let controller = Controller::new(ControllerParameters { sensors, ..ControllerParameters::default() }).unwrap();
        let zero = Measurement::from_array(&[0.0; super::super::CHANNELS]);
        let of_the_swarm_s_stream = Sensors::new(sensors, controller.memory.rng.clone()).read(&zero);
        assert_ne!(controller.memory.sensors.clone().read(&zero), of_the_swarm_s_stream);
    }
}
