//! Nothing on the step path of either model allocates: right-hand side, Co-Simulation step with its
//! backup, tick in every mode, event, directional derivative of the plant.

use allocation_counter::measure;
use rps3::description::VariableType;
use rps3::dynamics::{Inputs, PlantModel, PlantParameters, PlantState, derivative};
use rps3::fmi2::{Direction, Experiment, Log, Model, StepInputs, Values};
use rps3::models::{Controller, Plant};

struct Silent;

impl Log for Silent {
    fn warning(&mut self, _message: &str) {}
    fn event(&mut self, _message: &str) {}
}

struct Held<'a>(&'a [f64]);

impl StepInputs for Held<'_> {
    fn at(&self, slot: usize, _t: f64) -> f64 {
        self.0[slot]
    }
    fn constant(&self) -> bool {
        true
    }
}

fn initialized<M: Model>(prepare: impl FnOnce(&mut Values)) -> (M, Values) {
    let mut values = Values::start(M::definition());
    prepare(&mut values);
    let mut model = M::instantiate();
    let experiment = Experiment { start_time: 0.0, stop_time: None, tolerance: None };
    model.initialize(&mut values, &experiment, true, &mut Silent).unwrap();
    (model, values)
}

/// Allocations of ten steps of 1 ms, each with the backup that the FMI layer keeps.
fn allocations_of_steps<M: Model>(prepare: impl FnOnce(&mut Values)) -> u64 {
    let (mut model, mut values) = initialized::<M>(prepare);
    let mut backup = (model.clone(), values.clone());
    let inputs = values.reals.clone();
    let counted = measure(|| {
        for k in 0..10 {
            let t = 1e-3 * f64::from(k);
            backup.0.clone_from(&model);
            backup.1.clone_from(&values);
            model.step(&mut values, &Held(&inputs), t, t + 1e-3, &mut Silent).unwrap();
        }
    });
    counted.count_total
}

#[test]
fn right_hand_side() {
    let model = PlantModel::new(&PlantParameters::default());
    let mut x = PlantState::<f64>::zeros();
    x[0] = 0.05;
    assert_eq!(measure(|| _ = std::hint::black_box(derivative(&model, &x, &Inputs::zero()))).count_total, 0);
}

#[test]
fn plant_step() {
    assert_eq!(allocations_of_steps::<Plant>(|_| ()), 0);
}

#[test]
fn controller_step_in_every_mode_and_with_both_motor_variants() {
    let definition = Controller::definition();
    let mode_slot = Values::slot(definition, VariableType::Integer, "control_mode").unwrap();
    let delay_slot = Values::slot(definition, VariableType::Integer, "computation_delay").unwrap();
    let motors_slot = Values::slot(definition, VariableType::Boolean, "revolute_motors").unwrap();
    for mode in 1..=4 {
        for (six, delay) in [(true, 0), (false, 1)] {
            let count = allocations_of_steps::<Controller>(|values| {
                values.integers[mode_slot] = mode;
                values.integers[delay_slot] = delay;
                values.booleans[motors_slot] = six;
            });
            assert_eq!(count, 0, "mode {mode}");
        }
    }
}

#[test]
fn controller_event() {
    let (mut model, mut values) = initialized::<Controller>(|_| ());
    let counted = measure(|| {
        for k in 0..10 {
            let update = model.new_discrete_states(&mut values, 1e-3 * f64::from(k), &mut Silent).unwrap();
            assert_eq!(update.next_event_time, Some(1e-3 * f64::from(k + 1)));
        }
    });
    assert_eq!(counted.count_total, 0);
}

#[test]
fn plant_s_directional_derivative() {
    let (mut model, values) = initialized::<Plant>(|_| ());
    let slot = |name: &str| Values::slot(Plant::definition(), VariableType::Real, name).unwrap();
    let (knowns, unknowns) = ([slot("tilt_x")], [slot("heave_ddot"), slot("a_x")]);
    let direction = Direction { initialization: false, knowns: &knowns, seed: &[1.0] };
    let mut result = [0.0; 2];
    let counted = measure(|| model.directional_derivative(&values, &direction, &unknowns, &mut result).unwrap());
    assert_eq!(counted.count_total, 0);
    assert!(result.iter().all(|x| *x != 0.0));
}
