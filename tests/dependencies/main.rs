//! Declared dependencies are true (section 2.2.8), both ways: at random points each known is moved alone through the C
//! functions; an unknown follows exactly those knowns that its entry in `ModelStructure` names.

#[path = "../common/mod.rs"]
mod common;
mod draws;
mod probe;

use std::cell::Cell;

use rps3::defaults::{BASE_RADIUS, JOINT_SPACING, START_MEASUREMENTS};
use rps3::description::{Causality, Definition, Initial, Variable};
use rps3::fmi2::Model;
use rps3::models::{Controller, Plant, plant};

use crate::common::Fmu;
use crate::draws::{draw_controller, draw_plant};
use crate::probe::{Dice, NO_STATE, Probe, Structure};

fn named<'a>(definition: &'a Definition, name: &str) -> &'a Variable {
    definition.variables.iter().find(|v| v.name == name).expect(name)
}

fn inputs(definition: &Definition) -> Vec<&Variable> {
    definition.variables.iter().filter(|v| v.causality == Causality::Input).collect()
}

#[test]
fn outputs_and_derivatives_of_the_plant_depend_on_the_declared_inputs_and_states_and_no_others() {
    let definition = Plant::definition();
    let states = plant::table::state_names();
    let mut knowns = inputs(definition);
    knowns.extend(states.iter().map(|name| named(definition, name)));
    knowns.push(named(definition, "time"));
    let list = [definition.outputs.clone(), definition.derivatives.clone()].concat();
    let mut structure = Structure::new(definition, knowns.clone(), &list);
    let unknowns = structure.unknowns.clone();
    let probe = Probe::<Plant>::new();
    probe.enter_initialization(0.0);
    assert!(probe.exit_initialization());
    probe.enter_continuous_time();
    let at = |point: &[f64]| {
        for (known, &value) in knowns.iter().zip(point) {
            if known.causality == Causality::Independent {
                probe.set_time(value);
            } else {
                probe.set(known, value);
            }
        }
        probe.get(&unknowns)
    };
    structure.observe((100, 1000), &mut Dice::new(), draw_plant, |_| true, at);
    structure.assert_true();
}

/// Checks `InitialUnknowns` in Initialization Mode: all inputs, all variables with an exact start, and time.
fn check_initial_unknowns<M: Fmu>(draw: fn(&Variable, &mut Dice) -> f64) {
    let definition = M::definition();
    let is_known = |v: &&Variable| {
        v.initial == Some(Initial::Exact) || matches!(v.causality, Causality::Input | Causality::Independent)
    };
    let knowns: Vec<_> = definition.variables.iter().filter(is_known).collect();
    let mut structure = Structure::new(definition, knowns.clone(), &definition.initial_unknowns);
    let unknowns = structure.unknowns.clone();
    let probe = Probe::<M>::new();
    let at = |point: &[f64]| {
        probe.reset();
        let mut start_time = 0.0;
        for (known, &value) in knowns.iter().zip(point) {
            if known.causality == Causality::Independent {
                start_time = value;
            } else {
                probe.set(known, value);
            }
        }
        probe.enter_initialization(start_time);
        probe.get(&unknowns)
    };
    structure.observe((300, 10_000), &mut Dice::new(), draw, |_| true, at);
    structure.assert_true();
}

#[test]
fn initial_unknowns_of_the_plant_depend_on_the_declared_starts_and_inputs_and_no_others() {
    check_initial_unknowns::<Plant>(draw_plant);
}

#[test]
fn initial_unknowns_of_the_controller_depend_on_the_declared_starts_and_inputs_and_no_others() {
    check_initial_unknowns::<Controller>(draw_controller);
}

/// A controller with random parameters but for those `given`, before one of its first four ticks; whether it got there.
fn controller_before_a_tick(probe: &Probe<Controller>, dice: &mut Dice, given: &[(&str, f64)]) -> bool {
    let definition = Controller::definition();
    probe.reset();
    for variable in definition.variables.iter().filter(|v| v.causality == Causality::Parameter) {
        let value = given.iter().find(|(name, _)| *name == variable.name);
        probe.set(variable, value.map_or_else(|| draw_controller(variable, dice), |(_, value)| *value));
    }
    probe.enter_initialization(0.0);
    if !probe.exit_initialization() {
        return false;
    }
    for _ in 0..dice.whole(0, 3) as u32 {
        set_inputs(probe, dice);
        let Some(next) = probe.event() else { return false };
        probe.enter_event(next);
    }
    true
}

fn set_inputs(probe: &Probe<Controller>, dice: &mut Dice) {
    for input in inputs(Controller::definition()) {
        probe.set(input, draw_controller(input, dice));
    }
}

#[test]
fn outputs_of_the_controller_depend_on_the_declared_inputs_and_no_others() {
    let definition = Controller::definition();
    let knowns = inputs(definition);
    let mut structure = Structure::new(definition, knowns.clone(), &definition.outputs);
    let unknowns = structure.unknowns.clone();
    let (probe, mut dice, state) = (Probe::<Controller>::new(), Dice::new(), Cell::new(NO_STATE));
    // Time: one tick and the next under the same inputs, once what the controller remembers has settled.
    let time = named(definition, "time");
    let without_memory = [
        // so that the reference goes some way from tick to tick
        ("sample_time", 0.02),
        ("computation_delay", 0.0),
        ("filter_time", 0.0),
        ("sensor_scale", 0.0),
        ("sensor_timeout", 0.0),
        // with the start measurements, which fit this geometry, each estimate is independent of the last one
        ("base_radius", BASE_RADIUS),
        ("joint_spacing", JOINT_SPACING),
    ];
    for _ in 0..300 {
        if !controller_before_a_tick(&probe, &mut dice, &without_memory) {
            continue;
        }
        set_inputs(&probe, &mut dice);
        let positions = ["d1", "d2", "d3", "theta1", "theta2", "theta3"].into_iter().zip(START_MEASUREMENTS);
        positions.for_each(|(name, value)| probe.set(named(definition, name), value));
        let tick = || {
            let next = probe.event()?;
            let values = probe.get(&unknowns);
            probe.enter_event(next);
            values
        };
        let values: Option<Vec<_>> = (0..20).map(|_| tick()).collect();
        if let Some(values) = values {
            values[2..].windows(2).for_each(|pair| structure.note(time, &pair[0], &pair[1]));
        }
    }
    let prepare = |dice: &mut Dice| {
        let ready = controller_before_a_tick(&probe, dice, &[]);
        let mut handle = state.get();
        probe.store(&mut handle);
        state.set(handle);
        ready
    };
    let at = |point: &[f64]| {
        probe.restore(state.get());
        knowns.iter().zip(point).for_each(|(input, &value)| probe.set(input, value));
        probe.event()?;
        probe.get(&unknowns)
    };
    structure.observe((300, 10_000), &mut dice, draw_controller, prepare, at);
    structure.assert_true();
}
