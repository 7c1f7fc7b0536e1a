//! Both FMUs coupled by a master of a few lines.

use std::cell::RefCell;

use anyhow::{Result, ensure};
use fmi::EventFlags;
use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation, Common, InstanceCS, InstanceME, ModelExchange};
use rps3::defaults::{STEP_SIZE as STEP, STOP_TIME, TOLERANCE};
use rps3::dynamics::solver::{Settings, Solver};
use rps3::dynamics::{NOMINAL, PlantState};
use rps3::models::TOLERANCE_MARGIN;
use rps3::study::Sample;

use crate::side::{MEASURED, REFERENCE, STATES, VOLTAGES, import, references};

/// Communication steps of the default experiment.
pub const STEPS: usize = 1400;

/// When values are exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exchange {
    /// The controller steps first, and the plant's step sees its new voltages.
    GaussSeidel,
    /// Both step with the values of the step's beginning.
    Jacobi,
}

/// Value references of everything that is exchanged or recorded.
struct References {
    states: [u32; 12],
    /// In the plant and in the controller.
    measured: [[u32; 21]; 2],
    voltages: [[u32; 6]; 2],
    reference: [u32; 3],
    computation_delay: [u32; 1],
}

impl References {
    fn new(plant: &Fmi2Import, controller: &Fmi2Import) -> Result<Self> {
        Ok(Self {
            states: references(plant, STATES)?,
            measured: [references(plant, MEASURED)?, references(controller, MEASURED)?],
            voltages: [references(plant, VOLTAGES)?, references(controller, VOLTAGES)?],
            reference: references(controller, REFERENCE)?,
            computation_delay: references(controller, ["computation_delay"])?,
        })
    }

    /// What both sides say now.
    fn sample(&self, plant: &mut impl Common, controller: &mut impl Common) -> Result<Sample> {
        Ok(Sample {
            state: reals(plant, &self.states)?,
            measured: reals(plant, &self.measured[0])?,
            voltages: reals(controller, &self.voltages[1])?,
            reference: reals(controller, &self.reference)?,
        })
    }

    fn measure(&self, plant: &mut impl Common, controller: &mut impl Common) -> Result<()> {
        let values = reals(plant, &self.measured[0])?;
        controller.set_real(&self.measured[1], &values)?;
        Ok(())
    }

    fn actuate(&self, controller: &mut impl Common, plant: &mut impl Common) -> Result<()> {
        let values = reals(controller, &self.voltages[1])?;
        plant.set_real(&self.voltages[0], &values)?;
        Ok(())
    }
}

fn reals<const N: usize>(side: &mut impl Common, references: &[u32; N]) -> Result<[f64; N]> {
    let mut values = [f64::NAN; N];
    side.get_real(references, &mut values)?;
    Ok(values)
}

/// Both through Initialization Mode; the controller's first outputs belong to the plant's first measurements.
fn initialize(plant: &mut impl Common, controller: &mut impl Common, references: &References) -> Result<()> {
    Common::setup_experiment(plant, Some(TOLERANCE), 0.0, Some(STOP_TIME))?;
    Common::enter_initialization_mode(plant)?;
    Common::exit_initialization_mode(plant)?;
    Common::setup_experiment(controller, Some(TOLERANCE), 0.0, Some(STOP_TIME))?;
    Common::enter_initialization_mode(controller)?;
    references.measure(plant, controller)?;
    Common::exit_initialization_mode(controller)?;
    Ok(())
}

/// A Co-Simulation master with fixed steps.
pub struct Pair {
    plant: InstanceCS,
    controller: InstanceCS,
    references: References,
    // what the libraries were loaded from has to outlive them
    _imports: [Fmi2Import; 2],
}

impl Pair {
    /// Both FMUs initialized; `computation_delay` is the controller's parameter.
    ///
    /// # Errors
    /// When an FMU cannot be imported or a call fails.
    pub fn new(computation_delay: i32) -> Result<Self> {
        let imports = [import("Rps3Plant")?, import("Rps3Controller")?];
        let references = References::new(&imports[0], &imports[1])?;
        let mut plant = imports[0].instantiate_cs("plant", false, true)?;
        let mut controller = imports[1].instantiate_cs("controller", false, true)?;
        controller.set_integer(&references.computation_delay, &[computation_delay])?;
        initialize(&mut plant, &mut controller, &references)?;
        Ok(Self { plant, controller, references, _imports: imports })
    }

    /// Steps `range` of the default experiment; a sample at the beginning of each.
    ///
    /// # Errors
    /// When a call fails.
    pub fn run(&mut self, range: std::ops::Range<usize>, exchange: Exchange) -> Result<Vec<Sample>> {
        let Self { plant, controller, references, .. } = self;
        let mut samples = Vec::new();
        for k in range {
            let time = k as f64 * STEP;
            references.measure(plant, controller)?;
            if exchange == Exchange::Jacobi {
                references.actuate(controller, plant)?;
            }
            controller.do_step(time, STEP, true)?;
            samples.push(references.sample(plant, controller)?);
            if exchange == Exchange::GaussSeidel {
                references.actuate(controller, plant)?;
            }
            plant.do_step(time, STEP, true)?;
        }
        Ok(samples)
    }

    /// The plant's state, serialized, and the controller's.
    ///
    /// # Errors
    /// When a call fails.
    pub fn save(&mut self) -> Result<[Vec<u8>; 2]> {
        let bytes = |side: &mut InstanceCS| -> Result<Vec<u8>> {
            let state = side.get_fmu_state()?;
            Ok(side.serialize_fmu_state(&state)?)
        };
        Ok([bytes(&mut self.plant)?, bytes(&mut self.controller)?])
    }

    /// Goes on from what [`save`](Self::save) returned, here or in another pair.
    ///
    /// # Errors
    /// When a call fails.
    pub fn restore(&mut self, bytes: &[Vec<u8>; 2]) -> Result<()> {
        for (side, bytes) in [&mut self.plant, &mut self.controller].into_iter().zip(bytes) {
            let state = side.deserialize_fmu_state(bytes)?;
            fmi::traits::FmiStatus::ok(side.set_fmu_state(&state))?;
        }
        Ok(())
    }
}

/// The default experiment in Model Exchange: the controller's ticks are time events, the plant is integrated from tick to
/// tick by the solver that its Co-Simulation side has inside.
///
/// # Errors
/// When an FMU cannot be imported or a call fails.
pub fn model_exchange() -> Result<Vec<Sample>> {
    let imports = [import("Rps3Plant")?, import("Rps3Controller")?];
    let references = References::new(&imports[0], &imports[1])?;
    let mut plant = imports[0].instantiate_me("plant", false, true)?;
    let mut controller = imports[1].instantiate_me("controller", false, true)?;
    initialize(&mut plant, &mut controller, &references)?;
    update(&mut plant)?;
    ModelExchange::enter_continuous_time_mode(&mut plant)?;
    let mut states = [0.0; 12];
    ModelExchange::get_continuous_states(&mut plant, &mut states)?;
    let mut x = PlantState::from(states);
    let settings = Settings { tolerance: TOLERANCE * TOLERANCE_MARGIN, nominal: NOMINAL, max_step: 0.01 };
    let mut solver = Solver::default();
    let mut samples = Vec::new();
    let mut time = 0.0;
    for k in 0..=STEPS {
        references.measure(&mut plant, &mut controller)?;
        let end = k as f64 * STEP + STEP;
        // the tick that is due there, up to rounding
        ensure!(
            update(&mut controller)?.is_some_and(|next| (next - end).abs() < 1e-9 * STEP),
            "no tick is due at {end} s"
        );
        ModelExchange::enter_continuous_time_mode(&mut controller)?;
        references.actuate(&mut controller, &mut plant)?;
        samples.push(references.sample(&mut plant, &mut controller)?);
        {
            let plant = RefCell::new(&mut plant);
            let failure = RefCell::new(None);
            let derivative = |t: f64, x: &PlantState<f64>| {
                let mut derivatives = [f64::NAN; 12];
                if let Err(error) = derivatives_at(&mut plant.borrow_mut(), t, x, &mut derivatives) {
                    failure.borrow_mut().get_or_insert(error);
                }
                PlantState::from(derivatives)
            };
            let outcome = solver.integrate(derivative, &mut x, time, end, &settings);
            if let Some(error) = failure.into_inner() {
                return Err(error);
            }
            outcome?;
        }
        time = end;
        ModelExchange::set_time(&mut plant, time)?;
        ModelExchange::set_continuous_states(&mut plant, x.as_slice())?;
        ModelExchange::completed_integrator_step(&mut plant, true, &mut false, &mut false)?;
        ModelExchange::set_time(&mut controller, time)?;
        ModelExchange::enter_event_mode(&mut controller)?;
    }
    Ok(samples)
}

fn derivatives_at(plant: &mut InstanceME, t: f64, x: &PlantState<f64>, derivatives: &mut [f64; 12]) -> Result<()> {
    ModelExchange::set_time(plant, t)?;
    ModelExchange::set_continuous_states(plant, x.as_slice())?;
    ModelExchange::get_derivatives(plant, derivatives)?;
    Ok(())
}

/// Event iteration; the time of the next event.
fn update(side: &mut InstanceME) -> Result<Option<f64>> {
    let mut flags = EventFlags { discrete_states_need_update: true, ..EventFlags::default() };
    while flags.discrete_states_need_update {
        ModelExchange::new_discrete_states(side, &mut flags)?;
    }
    Ok(flags.next_event_time)
}
