//! Rps3Plant: the mechanism with its motors behind the FMI layer.

mod dependencies;
mod outputs;
pub mod table;

use std::collections::BTreeMap;

use nalgebra::Vector3;
use num_dual::Dual64;
use serde::{Deserialize, Serialize};

use self::outputs::{CALCULATED, Calculated, calculate, is_state_or_derivative, states_and_derivatives};
use super::{descriptions, slots};
use crate::description::Definition;
use crate::dynamics::solver::{Settings, Solver};
use crate::dynamics::{Inputs, NOMINAL, PlantModel, PlantParameters, PlantState, STATES, derivative, settled_currents};
use crate::fmi2::{
    Direction, EventUpdate, Experiment, Lasting, Log, Model, ModelError, ModelResult, StepInputs, Values,
};
use crate::mechanism::{Limb, Pose};
use crate::scalar::Scalar;

/// The plant: its constants, its state and its solver.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(from = "Saved", into = "Saved")]
pub struct Plant {
    parameters: PlantParameters,
    /// Derived from `parameters`.
    model: PlantModel<f64>,
    x: PlantState<f64>,
    solver: Solver,
    tolerance: f64,
    max_step: f64,
}

/// What of a plant cannot be derived from the rest.
#[derive(Serialize, Deserialize)]
struct Saved {
    parameters: PlantParameters,
    x: [f64; STATES],
    solver: Solver,
    tolerance: f64,
    max_step: f64,
}

impl From<Saved> for Plant {
    fn from(saved: Saved) -> Self {
        let Saved { parameters, x, solver, tolerance, max_step } = saved;
        Self { parameters, model: PlantModel::new(&parameters), x: x.into(), solver, tolerance, max_step }
    }
}

impl From<Plant> for Saved {
    fn from(plant: Plant) -> Self {
        let Plant { parameters, x, solver, tolerance, max_step, .. } = plant;
        Self { parameters, x: x.into(), solver, tolerance, max_step }
    }
}

/// Slots of the variables that the glue touches.
struct Slots {
    /// First of v_leg1..3, v_rev1..3, f_ext_x..z, m_ext_x..z.
    inputs: usize,
    /// First of the calculated variables.
    calculated: usize,
    relative_tolerance: usize,
    max_step: usize,
    revolute_motors: usize,
    settled_start: usize,
    /// Of the Real parameters, by name.
    parameters: BTreeMap<String, usize>,
}

fn table() -> &'static (Definition, Slots) {
    static TABLE: Lasting<(Definition, Slots)> = Lasting::new();
    TABLE.get_or_init(|| {
        let definition = table::definition();
        let slots = Slots {
            inputs: slots::real(&definition, "v_leg1"),
            calculated: slots::real(&definition, "heave"),
            relative_tolerance: slots::real(&definition, "relative_tolerance"),
            max_step: slots::real(&definition, "max_step"),
            revolute_motors: slots::boolean(&definition, "revolute_motors"),
            settled_start: slots::boolean(&definition, "settled_start"),
            parameters: slots::real_parameters(&definition),
        };
        (definition, slots)
    })
}

/// Local errors add up along a run: the solver works this much below the tolerance asked for, so
/// that the results keep it.
pub const TOLERANCE_MARGIN: f64 = 0.1;

impl Plant {
    /// Parameters in force.
    pub fn parameters(&self) -> &PlantParameters {
        &self.parameters
    }

    /// Continuous states.
    pub fn state(&self) -> &PlantState<f64> {
        &self.x
    }

    /// How often the right-hand side was evaluated by the Co-Simulation solver.
    pub fn evaluations(&self) -> u64 {
        self.solver.evaluations
    }

    /// The state at the start pose, at rest, and whether the currents could be settled.
    fn start<T: Scalar>(
        model: &PlantModel<T>,
        parameters: &PlantParameters<T>,
        inputs: &Inputs<T>,
    ) -> (PlantState<T>, bool) {
        let mut x = PlantState::zeros();
        let s = Vector3::from(parameters.start);
        x.fixed_rows_mut::<3>(0).copy_from(&s);
        let settled = if parameters.settled_start { settled_currents(model, &s, inputs) } else { None };
        if let Some((leg, revolute)) = settled {
            x.fixed_rows_mut::<3>(6).copy_from(&leg);
            x.fixed_rows_mut::<3>(9).copy_from(&revolute);
        }
        (x, settled.is_some())
    }

    fn write(&self, values: &mut Values) {
        let calculated = calculate(&self.model, &self.x, &inputs(values));
        let first = table().1.calculated;
        values.reals[first..first + CALCULATED].copy_from_slice(calculated.as_slice());
    }
}

/// Inputs by a function from the place among the twelve.
fn inputs_from<T: Scalar>(at: impl Fn(usize) -> T) -> Inputs<T> {
    let vector = |first: usize| Vector3::new(at(first), at(first + 1), at(first + 2));
    Inputs { v_leg: vector(0), v_rev: vector(3), force: vector(6), moment: vector(9) }
}

fn inputs(values: &Values) -> Inputs<f64> {
    let first = table().1.inputs;
    inputs_from(|k| values.reals[first + k])
}

/// Parameters by a function from the slot.
fn parameters_from<T: Scalar>(values: &Values, at: impl Fn(usize) -> T) -> PlantParameters<T> {
    let slots = &table().1;
    PlantParameters::by_name(
        |name| at(slots.parameters[name]),
        values.booleans[slots.revolute_motors],
        values.booleans[slots.settled_start],
    )
}

/// A limb beyond its limits at the start pose cannot be meant; the message says which.
fn check_start(parameters: &PlantParameters, model: &PlantModel<f64>) -> Result<(), crate::dynamics::ParameterError> {
    use crate::dynamics::ParameterError;
    let [_, x, y] = parameters.start;
    let tilt = (x * x + y * y).sqrt();
    if tilt >= std::f64::consts::FRAC_PI_2 {
        return Err(ParameterError::TiltTooLarge(tilt));
    }
    let pose = Pose::new(&model.geometry, &Vector3::from(parameters.start));
    for (i, limb) in Limb::all(&model.geometry, &pose).iter().enumerate() {
        let lengths = ("d", limb.length, parameters.d_min, parameters.d_max);
        let angles = ("theta", limb.angle(), parameters.theta_min, parameters.theta_max);
        for (quantity, value, min, max) in [lengths, angles] {
            if !(min..=max).contains(&value) {
                let pose = parameters.start;
                return Err(ParameterError::StartBeyondLimits { pose, quantity, limb: i + 1, value, min, max });
            }
        }
    }
    let limbs = Limb::all(&model.geometry, &pose);
    match model.bodies.mass_matrix(&pose, &limbs, &model.motors).cholesky() {
        Some(_) => Ok(()),
        None => Err(ParameterError::SingularMassMatrix),
    }
}

impl Model for Plant {
    fn definition() -> &'static Definition {
        &table().0
    }

    fn guid() -> &'static str {
        descriptions::PLANT.guid
    }

    fn instantiate() -> Self {
        let parameters = PlantParameters::default();
        Self {
            parameters,
            model: PlantModel::new(&parameters),
            x: PlantState::zeros(),
            solver: Solver::default(),
            tolerance: crate::defaults::TOLERANCE,
            max_step: f64::INFINITY,
        }
    }

    fn initialize(
        &mut self,
        values: &mut Values,
        experiment: &Experiment,
        last: bool,
        log: &mut dyn Log,
    ) -> ModelResult {
        let slots = &table().1;
        let parameters = parameters_from(values, |slot| values.reals[slot]);
        let refuse = |error: crate::dynamics::ParameterError| ModelError::Error(error.to_string());
        parameters.validate().map_err(refuse)?;
        let model = PlantModel::new(&parameters);
        check_start(&parameters, &model).map_err(refuse)?;
        let (x, settled) = Self::start(&model, &parameters, &inputs(values));
        if last && parameters.settled_start && !settled {
            log.warning(
                "settled_start: no currents within the voltage limit hold the start pose (a direct singularity of \
                 the leg motors, or too large a load); all currents start at zero",
            );
        }
        let own = values.reals[slots.relative_tolerance];
        let theirs = experiment.tolerance.unwrap_or(crate::defaults::TOLERANCE);
        self.tolerance = if own > 0.0 { own } else { theirs.min(table::LARGEST_TOLERANCE) };
        self.max_step = values.reals[slots.max_step];
        self.parameters = parameters;
        self.model = model;
        self.x = x;
        self.solver = Solver::default();
        self.write(values);
        Ok(())
    }

    fn update(&mut self, values: &mut Values, _time: f64) -> ModelResult {
        self.write(values);
        Ok(())
    }

    fn derivatives(&self, values: &Values, _time: f64, derivatives: &mut [f64]) -> ModelResult {
        derivatives.copy_from_slice(derivative(&self.model, &self.x, &inputs(values)).as_slice());
        Ok(())
    }

    fn step(
        &mut self,
        values: &mut Values,
        step_inputs: &dyn StepInputs,
        from: f64,
        to: f64,
        _log: &mut dyn Log,
    ) -> ModelResult {
        let settings =
            Settings { tolerance: self.tolerance * TOLERANCE_MARGIN, nominal: NOMINAL, max_step: self.max_step };
        let model = &self.model;
        let outcome = if step_inputs.constant() {
            let u = inputs(values);
            self.solver.integrate(|_, x| derivative(model, x, &u), &mut self.x, from, to, &settings)
        } else {
            let first = table().1.inputs;
            let u = |t: f64| inputs_from(|k| step_inputs.at(first + k, t));
            self.solver.integrate(|t, x| derivative(model, x, &u(t)), &mut self.x, from, to, &settings)
        };
        outcome.map_err(|error| ModelError::Discard(error.to_string()))?;
        self.write(values);
        Ok(())
    }

    fn continuous_states(&self) -> &[f64] {
        self.x.as_slice()
    }

    fn continuous_states_mut(&mut self) -> &mut [f64] {
        self.x.as_mut_slice()
    }

    fn nominals(&self, nominals: &mut [f64]) {
        nominals.copy_from_slice(&NOMINAL);
    }

    fn new_discrete_states(&mut self, values: &mut Values, _time: f64, _log: &mut dyn Log) -> ModelResult<EventUpdate> {
        self.write(values);
        Ok(EventUpdate::default())
    }

    fn directional_derivative(
        &mut self,
        values: &Values,
        direction: &Direction,
        unknowns: &[usize],
        result: &mut [f64],
    ) -> ModelResult {
        let slots = &table().1;
        let dual = |slot: usize| Dual64::new(values.reals[slot], direction.along(slot));
        let u = inputs_from(|k| dual(slots.inputs + k));
        let calculated = if direction.initialization {
            let parameters = parameters_from(values, dual);
            let model = PlantModel::new(&parameters);
            let (x, _) = Self::start(&model, &parameters, &u);
            calculate(&model, &x, &u)
        } else {
            let model = PlantModel::new(&self.parameters.map(Dual64::from));
            let x = PlantState::from_fn(|i, _| Dual64::new(self.x[i], direction.along(slots.calculated + i)));
            let mut places = unknowns.iter().filter_map(|slot| slot.checked_sub(slots.calculated));
            if places.all(is_state_or_derivative) {
                states_and_derivatives(&model, &x, &u)
            } else {
                calculate(&model, &x, &u)
            }
        };
        pick(&calculated, unknowns, result)
    }

    fn output_derivative(
        &mut self,
        values: &Values,
        _time: f64,
        slot: usize,
        input_rates: &dyn Fn(usize) -> f64,
    ) -> ModelResult<f64> {
        let first = table().1.inputs;
        let model = PlantModel::new(&self.parameters.map(Dual64::from));
        let x_dot = derivative(&self.model, &self.x, &inputs(values));
        let x = self.x.zip_map(&x_dot, Dual64::new);
        let u = inputs_from(|k| Dual64::new(values.reals[first + k], input_rates(first + k)));
        let mut rate = [0.0];
        pick(&calculate(&model, &x, &u), &[slot], &mut rate)?;
        Ok(rate[0])
    }
}

/// Derivative parts of the calculated variables in `slots`.
fn pick(calculated: &Calculated<Dual64>, slots: &[usize], result: &mut [f64]) -> ModelResult {
    let first = table().1.calculated;
    for (slot, value) in slots.iter().zip(result) {
        let place = slot.checked_sub(first).filter(|place| *place < CALCULATED);
        let place = place.ok_or_else(|| ModelError::Error("no calculated variable".into()))?;
        *value = calculated[place].eps;
    }
    Ok(())
}
