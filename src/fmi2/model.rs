//! What a model provides to the generic FMI layer.

use serde::{Serialize, de::DeserializeOwned};

use super::Values;
use crate::description::Definition;

/// Why a model could not do what it was asked.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ModelError {
    /// The step cannot be computed with these values, a smaller one or other inputs might do:
    /// `fmi2Discard`.
    #[error("{0}")]
    Discard(String),
    /// The simulation cannot go on from here: `fmi2Error`.
    #[error("{0}")]
    Error(String),
}

/// Result of a model's methods.
pub type ModelResult<T = ()> = Result<T, ModelError>;

/// Where a model writes what it has to tell; the FMI layer filters by category and forwards.
pub trait Log {
    /// Something the user should know, category `logStatusWarning`; the call still succeeds.
    fn warning(&mut self, message: &str);
    /// A noteworthy event, category `logEvents`.
    fn event(&mut self, message: &str);
}

/// What `fmi2SetupExperiment` said.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, serde::Deserialize)]
pub struct Experiment {
    /// Start time, seconds.
    pub start_time: f64,
    /// Stop time, seconds, where one was defined.
    pub stop_time: Option<f64>,
    /// Relative tolerance, where one was defined.
    pub tolerance: Option<f64>,
}

/// Inputs over one communication step: the value set at its start plus the Taylor terms of
/// `fmi2SetRealInputDerivatives`.
pub trait StepInputs {
    /// Value of the Real input in `slot` at time `t`, seconds.
    fn at(&self, slot: usize, t: f64) -> f64;
    /// No input has a derivative set: `at` is constant over the step.
    fn constant(&self) -> bool;
}

/// Along what a directional derivative is wanted.
#[derive(Debug, Clone, Copy)]
pub struct Direction<'a> {
    /// The structure of Initialization Mode counts, in which parameters are knowns.
    pub initialization: bool,
    /// Slots of the knowns (Reals).
    pub knowns: &'a [usize],
    /// The seed, one number a known.
    pub seed: &'a [f64],
}

impl Direction<'_> {
    /// How far the direction leads along the Real in `slot`.
    pub fn along(&self, slot: usize) -> f64 {
        self.knowns.iter().zip(self.seed).filter(|(known, _)| **known == slot).map(|(_, seed)| seed).sum()
    }
}

/// Outcome of `fmi2NewDiscreteStates`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EventUpdate {
    /// The values of continuous states were changed by the event.
    pub states_changed: bool,
    /// Time of the next time event, seconds.
    pub next_event_time: Option<f64>,
}

/// A model behind the FMI layer. The layer checks call order, value references, sizes and
/// finiteness; a model checks what only it knows. `Clone` is the FMU state, `Serialize` its bytes.
///
/// `values` holds every variable by slot (see [`Values`]): the layer writes inputs and parameters
/// there, the model writes what it calculates.
pub trait Model: Clone + Serialize + DeserializeOwned + Send + 'static {
    /// The model description's data, the same for all instances.
    fn definition() -> &'static Definition;

    /// The rendered `guid`.
    fn guid() -> &'static str;

    /// The model right after instantiation.
    fn instantiate() -> Self;

    /// Computes the initial state from parameters and inputs and writes all calculated variables.
    /// Called in Initialization Mode, as often as a value is read after one was set, and once more
    /// on leaving it (`last` is true then). Must not depend on earlier calls. Errors refuse the
    /// parameters.
    fn initialize(
        &mut self,
        values: &mut Values,
        experiment: &Experiment,
        last: bool,
        log: &mut dyn Log,
    ) -> ModelResult;

    /// Brings every calculated variable up to date with time, states, inputs and tunable parameters.
    fn update(&mut self, values: &mut Values, time: f64) -> ModelResult;

    /// The state derivatives at `time`, in the order of the states: what [`Model::update`] would write to
    /// their variables. A solver of the host asks for these alone, many times a step.
    fn derivatives(&self, values: &Values, time: f64, derivatives: &mut [f64]) -> ModelResult;

    /// Whether nothing happens up to `to`, seconds: [`Model::step`] would change neither model nor values. The layer then
    /// spares itself the copy of both from which it restores a step that fails; inputs set before stay pending for
    /// [`Model::update`].
    fn idle_until(&self, _to: f64) -> bool {
        false
    }

    /// Advances from `from` to `to` (Co-Simulation) and writes the calculated variables there. `values` has the inputs as
    /// they are at `to`, `inputs` those on the way.
    /// On error the layer restores model and values as they were before the call.
    fn step(
        &mut self,
        values: &mut Values,
        inputs: &dyn StepInputs,
        from: f64,
        to: f64,
        log: &mut dyn Log,
    ) -> ModelResult;

    /// The continuous states, in the order of [`Definition::derivatives`].
    fn continuous_states(&self) -> &[f64];

    /// As above, to be written by `fmi2SetContinuousStates`; [`Model::update`] follows before any read.
    fn continuous_states_mut(&mut self) -> &mut [f64];

    /// Writes the nominal values of the continuous states.
    fn nominals(&self, nominals: &mut [f64]);

    /// Handles an event at `time` (Model Exchange, Event Mode).
    fn new_discrete_states(&mut self, values: &mut Values, time: f64, log: &mut dyn Log) -> ModelResult<EventUpdate>;

    /// Directional derivative: for each slot of `unknowns` (Real outputs, locals, derivatives) the
    /// derivative along `direction`. The layer has checked that knowns and unknowns are of the
    /// right sort.
    fn directional_derivative(
        &mut self,
        values: &Values,
        direction: &Direction,
        unknowns: &[usize],
        result: &mut [f64],
    ) -> ModelResult;

    /// First time derivative of the Real output in `slot`, `input_rates` giving the rate of each
    /// Real input by slot (zero where none was set).
    fn output_derivative(
        &mut self,
        values: &Values,
        time: f64,
        slot: usize,
        input_rates: &dyn Fn(usize) -> f64,
    ) -> ModelResult<f64>;
}
