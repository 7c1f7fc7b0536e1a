//! The variable tables keep the rules of FMI 2.0.5 section 2.2, those that validators miss included.

use std::collections::{BTreeSet, HashSet};

use rps3::description::{
    Causality, Definition, Exponents, Initial, Kind, Variability, Variable, VariableType, display_factor,
};
use rps3::models::{controller, plant};

fn definitions() -> [Definition; 2] {
    [plant::table::definition(), controller::table::definition()]
}

/// Runs `check` on every variable of both models.
fn for_each_variable(mut check: impl FnMut(&Definition, &Variable)) {
    for definition in definitions() {
        for variable in &definition.variables {
            check(&definition, variable);
        }
    }
}

fn variable<'a>(definition: &'a Definition, name: &str) -> &'a Variable {
    definition.variables.iter().find(|v| v.name == name).unwrap_or_else(|| panic!("no variable {name}"))
}

fn index(definition: &Definition, name: &str) -> usize {
    definition.variables.iter().position(|v| v.name == name).unwrap_or_else(|| panic!("no variable {name}"))
}

/// The states, as the derivatives name them.
fn states(definition: &Definition) -> Vec<String> {
    let state = |name: &String| match &variable(definition, name).kind {
        Kind::Real { derivative_of: Some(state), .. } => state.clone(),
        _ => panic!("{name} has no attribute derivative"),
    };
    definition.derivatives.iter().map(|d| state(&d.variable)).collect()
}

fn has_start(variable: &Variable) -> bool {
    match variable.kind {
        Kind::Real { start, .. } => start.is_some(),
        Kind::Integer { start, .. } => start.is_some(),
        Kind::Boolean { start } => start.is_some(),
    }
}

#[test]
fn names_are_unique_flat_identifiers() {
    for definition in definitions() {
        let mut seen = HashSet::new();
        for v in &definition.variables {
            assert!(seen.insert(v.name.as_str()), "{} appears twice", v.name);
            let first = v.name.chars().next().unwrap();
            assert!(first.is_ascii_lowercase(), "{}", v.name);
            assert!(v.name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'), "{}", v.name);
        }
    }
}

#[test]
fn only_the_independent_variable_is_called_time_and_there_is_one() {
    for definition in definitions() {
        let independent: Vec<_> =
            definition.variables.iter().filter(|v| v.causality == Causality::Independent).collect();
        assert_eq!(independent.len(), 1);
        assert_eq!(independent[0].name, "time");
    }
}

#[test]
fn value_references_are_unique_within_a_type() {
    for definition in definitions() {
        let mut seen = BTreeSet::new();
        for v in &definition.variables {
            assert!(seen.insert((v.variable_type(), v.value_reference)), "{}", v.name);
        }
    }
}

#[test]
fn causality_variability_and_initial_are_a_triple_of_section_2_2_7() {
    use Causality::{Independent, Input, Local, Output, Parameter};
    use Initial::{Approx, Calculated, Exact};
    use Variability::{Constant, Continuous, Discrete, Fixed, Tunable};
    for_each_variable(|_, v| {
        let legal = match (v.causality, v.variability) {
            (Parameter, Fixed | Tunable) => v.initial == Some(Exact),
            (Input, Discrete | Continuous) => v.initial.is_none(),
            (Output | Local, Constant) => v.initial == Some(Exact),
            (Output, Discrete | Continuous) => matches!(v.initial, Some(Exact | Approx | Calculated)),
            (Local, Fixed | Tunable) => matches!(v.initial, Some(Approx | Calculated)),
            (Local, Discrete | Continuous) => matches!(v.initial, Some(Exact | Approx | Calculated)),
            (Independent, Continuous) => v.initial.is_none(),
            _ => false,
        };
        assert!(legal, "{}: {:?}, {:?}, {:?}", v.name, v.causality, v.variability, v.initial);
        let is_real = v.variable_type() == VariableType::Real;
        assert!(is_real || v.variability != Continuous, "{}: only a Real is continuous", v.name);
    });
}

#[test]
fn start_values_are_present_exactly_where_required() {
    for_each_variable(|_, v| {
        let required = v.causality == Causality::Input || matches!(v.initial, Some(Initial::Exact | Initial::Approx));
        assert_eq!(has_start(v), required, "{}", v.name);
    });
}

#[test]
fn start_values_are_finite_and_within_min_and_max() {
    for_each_variable(|_, v| match &v.kind {
        Kind::Real { start, bounds, .. } => {
            for x in [bounds.min, bounds.max, *start].into_iter().flatten() {
                assert!(x.is_finite(), "{}", v.name);
            }
            let (min, max) = (bounds.min.unwrap_or(f64::MIN), bounds.max.unwrap_or(f64::MAX));
            assert!(min < max, "{}", v.name);
            assert!(start.is_none_or(|x| (min..=max).contains(&x)), "{}", v.name);
        }
        Kind::Integer { start, bounds } => {
            let (min, max) = (bounds.min.unwrap_or(i32::MIN), bounds.max.unwrap_or(i32::MAX));
            assert!(min < max, "{}", v.name);
            assert!(start.is_none_or(|x| (min..=max).contains(&x)), "{}", v.name);
        }
        Kind::Boolean { .. } => {}
    });
}

#[test]
fn nominal_values_are_positive() {
    for_each_variable(|_, v| {
        if let Kind::Real { nominal: Some(nominal), .. } = v.kind {
            assert!(nominal.is_finite() && nominal > 0.0, "{}", v.name);
        }
    });
}

#[test]
fn every_variable_has_a_description() {
    for_each_variable(|_, v| assert!(!v.description.trim().is_empty(), "{}", v.name));
}

#[test]
fn units_are_known_and_display_units_belong_to_one() {
    for_each_variable(|_, v| {
        if let Kind::Real { unit, display_unit, .. } = v.kind {
            if let Some(unit) = unit {
                assert!(Exponents::of(unit).is_some(), "{}: {unit}", v.name);
            }
            if let Some(display) = display_unit {
                assert!(unit.is_some_and(|unit| display_factor(unit, display).is_some()), "{}: {display}", v.name);
            }
        }
    });
}

#[test]
fn the_unit_of_a_derivative_is_the_states_unit_by_second() {
    for_each_variable(|definition, v| {
        if let Kind::Real { unit, derivative_of: Some(state), .. } = &v.kind {
            let Kind::Real { unit: state_unit, .. } = &variable(definition, state).kind else {
                panic!("{state} is no Real")
            };
            let [rate, state] =
                [unit, state_unit].map(|u| u.map_or(Exponents::default(), |u| Exponents::of(u).unwrap()));
            assert_eq!(rate, Exponents { s: state.s - 1, ..state }, "{}", v.name);
        }
    });
}

#[test]
fn base_units_are_those_of_the_si() {
    let exponents = |kg, m, s, a, rad| Exponents { kg, m, s, a, rad };
    for (unit, expected) in [
        ("N.m", exponents(1, 2, -2, 0, 0)),
        ("J", exponents(1, 2, -2, 0, 0)),
        ("W", exponents(1, 2, -3, 0, 0)),
        ("V", exponents(1, 2, -3, -1, 0)),
        ("Ohm", exponents(1, 2, -3, -2, 0)),
        ("H", exponents(1, 2, -2, -2, 0)),
        ("N.m.s/rad", exponents(1, 2, -1, 0, -1)),
        ("N.m/A", exponents(1, 2, -2, -1, 0)),
        ("1/s2", exponents(0, 0, -2, 0, 0)),
        ("kg.m2", exponents(1, 2, 0, 0, 0)),
        ("m2/s3", exponents(0, 2, -3, 0, 0)),
    ] {
        assert_eq!(Exponents::of(unit), Some(expected), "{unit}");
    }
    // V = W / A and Ohm = V / A and H = V s / A, whatever the table says
    let [v, w, ohm, h] = ["V", "W", "Ohm", "H"].map(|u| Exponents::of(u).unwrap());
    assert_eq!(v, Exponents { a: w.a - 1, ..w });
    assert_eq!(ohm, Exponents { a: v.a - 1, ..v });
    assert_eq!(h, Exponents { s: ohm.s + 1, ..ohm });
    assert_eq!(Exponents::of("furlong"), None);
}

#[test]
fn outputs_are_exactly_the_variables_of_that_causality_in_order() {
    for definition in definitions() {
        let listed: Vec<_> = definition.outputs.iter().map(|u| u.variable.as_str()).collect();
        let expected: Vec<_> =
            definition.variables.iter().filter(|v| v.causality == Causality::Output).map(|v| v.name.as_str()).collect();
        assert_eq!(listed, expected);
    }
}

#[test]
fn derivatives_are_exactly_the_variables_with_that_attribute_one_for_each_state() {
    for definition in definitions() {
        let listed: BTreeSet<_> = definition.derivatives.iter().map(|u| u.variable.clone()).collect();
        let expected: BTreeSet<_> = definition
            .variables
            .iter()
            .filter(|v| matches!(v.kind, Kind::Real { derivative_of: Some(_), .. }))
            .map(|v| v.name.clone())
            .collect();
        assert_eq!(listed, expected);
        let states = states(&definition);
        assert_eq!(states.iter().collect::<BTreeSet<_>>().len(), definition.derivatives.len());
        for state in &states {
            assert_eq!(variable(&definition, state).variability, Variability::Continuous, "{state}");
        }
    }
}

#[test]
fn the_plants_states_are_the_twelve_in_the_order_of_its_table() {
    assert_eq!(states(&plant::table::definition()), plant::table::state_names());
}

#[test]
fn initial_unknowns_are_exactly_the_expected_set_ordered_by_index() {
    for definition in definitions() {
        let listed: Vec<_> = definition.initial_unknowns.iter().map(|u| index(&definition, &u.variable)).collect();
        let states = states(&definition);
        let derivatives: Vec<_> = definition.derivatives.iter().map(|u| u.variable.clone()).collect();
        let expected: Vec<_> = (0..definition.variables.len())
            .filter(|&i| {
                let v = &definition.variables[i];
                let computed = matches!(v.initial, Some(Initial::Approx | Initial::Calculated));
                computed
                    && (v.causality == Causality::Output || states.contains(&v.name) || derivatives.contains(&v.name))
            })
            .collect();
        assert_eq!(listed, expected);
    }
}

#[test]
fn dependencies_of_outputs_and_derivatives_are_inputs_states_or_time() {
    for definition in definitions() {
        let states = states(&definition);
        for unknown in definition.outputs.iter().chain(&definition.derivatives) {
            for name in &unknown.dependencies {
                let v = variable(&definition, name);
                let known = matches!(v.causality, Causality::Input | Causality::Independent) || states.contains(name);
                assert!(known, "{} depends on {name}", unknown.variable);
            }
        }
    }
}

#[test]
fn dependencies_of_initial_unknowns_are_inputs_exact_variables_or_time() {
    for definition in definitions() {
        for unknown in &definition.initial_unknowns {
            for name in &unknown.dependencies {
                let v = variable(&definition, name);
                let known = matches!(v.causality, Causality::Input | Causality::Independent)
                    || v.initial == Some(Initial::Exact);
                assert!(known, "{} depends on {name}", unknown.variable);
            }
        }
    }
}

#[test]
fn dependencies_name_nothing_twice() {
    for definition in definitions() {
        for unknown in definition.outputs.iter().chain(&definition.derivatives).chain(&definition.initial_unknowns) {
            let distinct: BTreeSet<_> = unknown.dependencies.iter().collect();
            assert_eq!(distinct.len(), unknown.dependencies.len(), "{}", unknown.variable);
        }
    }
}

#[test]
fn the_controller_reads_what_the_plant_writes_and_the_other_way_round() {
    let [plant, controller] = definitions();
    let of = |definition: &Definition, causality| -> BTreeSet<String> {
        definition.variables.iter().filter(|v| v.causality == causality).map(|v| v.name.clone()).collect()
    };
    let measurements: BTreeSet<_> =
        of(&controller, Causality::Input).into_iter().filter(|name| !name.starts_with("ref_")).collect();
    assert!(measurements.is_subset(&of(&plant, Causality::Output)));
    let actions: BTreeSet<_> = of(&plant, Causality::Input).into_iter().filter(|name| name.starts_with("v_")).collect();
    assert!(actions.is_subset(&of(&controller, Causality::Output)));
    for name in measurements.iter().chain(&actions) {
        let unit = |definition| match variable(definition, name).kind {
            Kind::Real { unit, .. } => unit,
            _ => None,
        };
        assert_eq!(unit(&plant), unit(&controller), "{name}");
    }
}
