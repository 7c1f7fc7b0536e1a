//! Directional derivatives of both models against central differences of the models themselves.

use rps3::description::{Causality, VariableType};
use rps3::fmi2::{Direction, Experiment, Log, Model, Values};
use rps3::models::{Controller, Plant};

struct Silent;

impl Log for Silent {
    fn warning(&mut self, _message: &str) {}
    fn event(&mut self, _message: &str) {}
}

const EXPERIMENT: Experiment = Experiment { start_time: 0.0, stop_time: None, tolerance: None };

fn slot<M: Model>(name: &str) -> usize {
    Values::slot(M::definition(), VariableType::Real, name).unwrap()
}

fn initialized<M: Model>(values: &Values) -> (M, Values) {
    let mut model = M::instantiate();
    let mut values = values.clone();
    model.initialize(&mut values, &EXPERIMENT, true, &mut Silent).unwrap();
    (model, values)
}

fn along(initialization: bool, knowns: &[usize]) -> Direction<'_> {
    Direction { initialization, knowns, seed: &[1.0] }
}

/// Slots of all Reals with one of the causalities but for those in `but`.
fn slots<M: Model>(causalities: &[Causality], but: &[&str]) -> Vec<usize> {
    let reals = M::definition().variables.iter().filter(|v| v.variable_type() == VariableType::Real);
    let wanted = reals
        .enumerate()
        .filter(|(_, v)| causalities.contains(&v.causality) && !but.iter().any(|prefix| v.name.starts_with(prefix)));
    wanted.map(|(slot, _)| slot).collect()
}

/// Largest relative difference between derivative and central difference over all unknowns.
fn compare_initialization<M: Model>(values: &Values, knowns: &[usize], unknowns: &[usize]) {
    let (mut model, at) = initialized::<M>(values);
    let reals: Vec<_> = M::definition().variables.iter().filter(|v| v.variable_type() == VariableType::Real).collect();
    for &known in knowns {
        let mut derivative = vec![0.0; unknowns.len()];
        model.directional_derivative(&at, &along(true, &[known]), unknowns, &mut derivative).unwrap();
        let step = 1e-6 * values.reals[known].abs().max(1e-3);
        let moved = |by: f64| {
            let mut values = values.clone();
            values.reals[known] += by;
            initialized::<M>(&values).1
        };
        let (plus, minus) = (moved(step), moved(-step));
        for (&unknown, derivative) in unknowns.iter().zip(&derivative) {
            let difference = (plus.reals[unknown] - minus.reals[unknown]) / (2.0 * step);
            // what rounding leaves of a central difference, relative to the values' size
            let noise = 1e-9 * (1.0 + at.reals[unknown].abs()) / step * 1e-3;
            let error = (difference - derivative).abs();
            assert!(
                error <= 2e-5 * derivative.abs().max(difference.abs()) + noise,
                "d {} / d {}: {derivative:e}, difference {difference:e}",
                reals[unknown].name,
                reals[known].name
            );
        }
    }
}

/// The default start, moved off the pose where errors vanish and saturation begins.
fn controller_values(mode: i32, six: bool, external: bool) -> Values {
    let definition = Controller::definition();
    let mut values = Values::start(definition);
    let integer = |name: &str| Values::slot(definition, VariableType::Integer, name).unwrap();
    values.integers[integer("control_mode")] = mode;
    values.integers[integer("reference_mode")] = if external { 2 } else { 1 };
    values.booleans[Values::slot(definition, VariableType::Boolean, "revolute_motors").unwrap()] = six;
    for (name, value) in [
        ("d1", 0.2166),
        ("d2_dot", 0.01),
        ("theta1_dot", 0.02),
        ("theta3", 0.296),
        ("i_leg1", 0.3),
        ("i_rev2", 0.1),
        ("a_x", 0.2),
        ("k_a", 0.1),
        ("ref_heave_dot", 0.01),
        ("ref_tilt_x_ddot", 0.2),
        ("start_heave", 0.0705),
    ] {
        values.reals[slot::<Controller>(name)] = value;
    }
    values
}

#[test]
fn controller_s_initial_outputs_have_the_derivatives_it_tells() {
    // what acts through random numbers or the search has no derivative to be compared
    let but = [
        "sensor_",
        "filter_time",
        "c1",
        "c2",
        "inertia_",
        "decay_",
        "regulating",
        "velocity_limit",
        "rho_max",
        "delta_hd_max",
        "lambda_f_max",
        "v_max",
        "plate_ixx",
        "plate_izz",
    ];
    for mode in [1, 2, 3] {
        for (six, external) in [(true, false), (false, true)] {
            let values = controller_values(mode, six, external);
            let knowns = slots::<Controller>(&[Causality::Input, Causality::Parameter], &but);
            compare_initialization::<Controller>(&values, &knowns, &slots::<Controller>(&[Causality::Output], &[]));
        }
    }
}

#[test]
fn initial_outputs_are_the_first_tick_s_and_the_derivative_s_own_values() {
    // the matrix form that is differentiated and the singular basis that runs agree
    for mode in [2, 3] {
        let values = controller_values(mode, true, false);
        let (mut model, at) = initialized::<Controller>(&values);
        let mut stepped = at.clone();
        let held = Held(at.reals.clone());
        model.step(&mut stepped, &held, 0.0, 1e-3, &mut Silent).unwrap();
        for unknown in slots::<Controller>(&[Causality::Output], &[]) {
            assert_eq!(at.reals[unknown].to_bits(), stepped.reals[unknown].to_bits());
        }
    }
}

struct Held(Vec<f64>);

impl rps3::fmi2::StepInputs for Held {
    fn at(&self, slot: usize, _t: f64) -> f64 {
        self.0[slot]
    }
    fn constant(&self) -> bool {
        true
    }
}

#[test]
fn plant_s_initial_outputs_have_the_derivatives_it_tells() {
    for (six, settled) in [(true, true), (false, true), (true, false)] {
        let definition = Plant::definition();
        let mut values = Values::start(definition);
        values.booleans[Values::slot(definition, VariableType::Boolean, "revolute_motors").unwrap()] = six;
        values.booleans[Values::slot(definition, VariableType::Boolean, "settled_start").unwrap()] = settled;
        values.reals[slot::<Plant>("v_leg1")] = 3.0;
        values.reals[slot::<Plant>("f_ext_x")] = 5.0;
        // 0 stands for the uniform disc, from which no derivative leads away
        let knowns = slots::<Plant>(
            &[Causality::Input, Causality::Parameter],
            &["plate_ixx", "plate_izz", "relative_tolerance", "max_step"],
        );
        compare_initialization::<Plant>(&values, &knowns, &slots::<Plant>(&[Causality::Output, Causality::Local], &[]));
    }
}

#[test]
fn plant_s_derivatives_and_outputs_have_the_derivatives_it_tells() {
    let values = Values::start(Plant::definition());
    let (mut model, mut at) = initialized::<Plant>(&values);
    for (k, x) in [0.06, 0.08, 0.05, 0.1, -0.3, 0.2, 1.0, -0.5, 0.7, 0.2, 0.3, -0.4].into_iter().enumerate() {
        model.continuous_states_mut()[k] = x;
    }
    model.update(&mut at, 0.0).unwrap();
    let heave = slot::<Plant>("heave");
    let states: Vec<usize> = (heave..heave + 12).collect();
    let inputs = slots::<Plant>(&[Causality::Input], &[]);
    let unknowns = slots::<Plant>(&[Causality::Output, Causality::Local], &[]);
    for &known in states.iter().chain(&inputs) {
        let mut derivative = vec![0.0; unknowns.len()];
        model.directional_derivative(&at, &along(false, &[known]), &unknowns, &mut derivative).unwrap();
        let step = 1e-6;
        let moved = |by: f64| {
            let mut model = model.clone();
            let mut values = at.clone();
            if known >= heave {
                model.continuous_states_mut()[known - heave] += by;
            } else {
                values.reals[known] += by;
            }
            model.update(&mut values, 0.0).unwrap();
            values
        };
        let (plus, minus) = (moved(step), moved(-step));
        for (&unknown, derivative) in unknowns.iter().zip(&derivative) {
            let difference = (plus.reals[unknown] - minus.reals[unknown]) / (2.0 * step);
            let noise = 1e-8 * (1.0 + at.reals[unknown].abs());
            assert!((difference - derivative).abs() <= 1e-6 * derivative.abs() + noise, "{known} {unknown}");
        }
    }
}

#[test]
fn derivatives_alone_are_the_variables_that_an_update_writes() {
    let (mut plant, mut values) = initialized::<Plant>(&Values::start(Plant::definition()));
    for (k, x) in plant.continuous_states_mut().iter_mut().enumerate() {
        *x += 0.01 * (k as f64 - 4.0);
    }
    let mut derivatives = [0.0; 12];
    plant.derivatives(&values, 0.0, &mut derivatives).unwrap();
    plant.update(&mut values, 0.0).unwrap();
    let variables = &Plant::definition().derivatives;
    assert_eq!(variables.len(), 12);
    for (unknown, derivative) in variables.iter().zip(derivatives) {
        // the same formulas in the same order: the same bits
        assert_eq!(values.reals[slot::<Plant>(&unknown.variable)], derivative, "{}", unknown.variable);
    }
}

#[test]
fn a_directional_derivative_is_the_same_alone_and_among_all_outputs() {
    let (mut plant, values) = initialized::<Plant>(&Values::start(Plant::definition()));
    let derivatives: Vec<usize> = Plant::definition().derivatives.iter().map(|d| slot::<Plant>(&d.variable)).collect();
    let with_an_output: Vec<usize> = derivatives.iter().copied().chain([slot::<Plant>("sigma_min")]).collect();
    for known in ["heave", "tilt_y_dot", "i_rev2", "v_leg1", "f_ext_x"] {
        let knowns = [slot::<Plant>(known)];
        let (mut alone, mut among) = ([0.0; 12], [0.0; 13]);
        plant.directional_derivative(&values, &along(false, &knowns), &derivatives, &mut alone).unwrap();
        plant.directional_derivative(&values, &along(false, &knowns), &with_an_output, &mut among).unwrap();
        assert_eq!(alone, among[..12], "along {known}");
        assert!(alone.iter().any(|x| *x != 0.0), "along {known}");
    }
}
