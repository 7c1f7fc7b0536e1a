//! A [`Definition`] as `modelDescription.xml`.

use std::collections::BTreeMap;

use super::log_categories::{LOG_ALL, LogCategory};
use super::schema::{self, Attributes, number};
use super::units::{Exponents, display_factor};
use super::{Causality, Definition, Initial, Kind, Unknown, Variability, Variable};

/// Why a definition cannot be rendered: it contradicts itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RenderError {
    /// A unit whose symbols are not known.
    UnknownUnit(String),
    /// A display unit without a factor.
    UnknownDisplayUnit(String),
    /// A name in the model structure, or a state, that no variable has.
    UnknownVariable(String),
    /// The XML serializer's own complaint.
    Xml(String),
}

impl std::fmt::Display for RenderError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::UnknownUnit(name) => write!(f, "unit {name} is not known"),
            Self::UnknownDisplayUnit(name) => write!(f, "display unit {name} is not known"),
            Self::UnknownVariable(name) => write!(f, "there is no variable {name}"),
            Self::Xml(message) => write!(f, "XML: {message}"),
        }
    }
}

impl std::error::Error for RenderError {}

/// Renders `definition` with the given model version and GUID.
///
/// The text depends on the arguments alone: no date, no machine.
pub fn render(definition: &Definition, version: &str, guid: &str) -> Result<String, RenderError> {
    let index = index(definition);
    let capabilities = definition.capabilities;
    let description = schema::ModelDescription {
        fmi_version: "2.0",
        model_name: definition.model_identifier,
        guid,
        description: definition.description,
        version,
        license: "MIT OR Apache-2.0",
        generation_tool: format!("rps3 {version}"),
        variable_naming_convention: "flat",
        number_of_event_indicators: definition.event_indicators,
        model_exchange: schema::ModelExchange {
            model_identifier: definition.model_identifier,
            completed_integrator_step_not_needed: true,
            can_be_instantiated_only_once_per_process: false,
            can_not_use_memory_management_functions: true,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: true,
            provides_directional_derivative: capabilities.provides_directional_derivative,
        },
        co_simulation: schema::CoSimulation {
            model_identifier: definition.model_identifier,
            can_handle_variable_communication_step_size: true,
            can_interpolate_inputs: capabilities.can_interpolate_inputs,
            max_output_derivative_order: capabilities.max_output_derivative_order,
            can_run_asynchronously: false,
            can_be_instantiated_only_once_per_process: false,
            can_not_use_memory_management_functions: true,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: true,
            provides_directional_derivative: capabilities.provides_directional_derivative,
        },
        unit_definitions: unit_definitions(&definition.variables)?,
        log_categories: log_categories(),
        default_experiment: schema::DefaultExperiment {
            start_time: number(definition.default_experiment.start_time),
            stop_time: number(definition.default_experiment.stop_time),
            tolerance: number(definition.default_experiment.tolerance),
            step_size: number(definition.default_experiment.step_size),
        },
        model_variables: schema::ModelVariables {
            variables: definition.variables.iter().map(|v| scalar_variable(v, &index)).collect::<Result<_, _>>()?,
        },
        model_structure: schema::ModelStructure {
            outputs: unknowns(&definition.outputs, &index)?,
            derivatives: unknowns(&definition.derivatives, &index)?,
            initial_unknowns: unknowns(&definition.initial_unknowns, &index)?,
        },
    };
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let mut serializer = quick_xml::se::Serializer::new(&mut text);
    serializer.indent(' ', 2);
    serde::Serialize::serialize(&description, serializer).map_err(|error| RenderError::Xml(error.to_string()))?;
    text.push('\n');
    Ok(text)
}

/// Index of each variable in `ModelVariables`, counted from 1.
type Index<'a> = BTreeMap<&'a str, usize>;

fn index(definition: &Definition) -> Index<'_> {
    definition.variables.iter().enumerate().map(|(i, v)| (v.name.as_str(), i + 1)).collect()
}

fn position(index: &Index<'_>, name: &str) -> Result<usize, RenderError> {
    index.get(name).copied().ok_or_else(|| RenderError::UnknownVariable(name.to_owned()))
}

/// The units in use, in alphabetical order, each with the display units in use.
fn unit_definitions(variables: &[Variable]) -> Result<schema::UnitDefinitions<'_>, RenderError> {
    let mut used: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for variable in variables {
        if let Kind::Real { unit: Some(unit), display_unit, .. } = &variable.kind {
            let displays = used.entry(unit).or_default();
            if let Some(display) = display_unit
                && !displays.contains(display)
            {
                displays.push(display);
                displays.sort_unstable();
            }
        }
    }
    let unit = |(name, displays): (&'static str, Vec<&'static str>)| {
        let base = Exponents::of(name).ok_or_else(|| RenderError::UnknownUnit(name.to_owned()))?;
        let display = |display: &'static str| {
            let factor =
                display_factor(name, display).ok_or_else(|| RenderError::UnknownDisplayUnit(display.to_owned()))?;
            Ok(schema::DisplayUnit { name: display, factor: number(factor) })
        };
        Ok(schema::Unit {
            name,
            base_unit: schema::BaseUnit { kg: base.kg, m: base.m, s: base.s, a: base.a, rad: base.rad },
            display_units: displays.into_iter().map(display).collect::<Result<_, _>>()?,
        })
    };
    Ok(schema::UnitDefinitions { units: used.into_iter().map(unit).collect::<Result<_, _>>()? })
}

fn log_categories() -> schema::LogCategories<'static> {
    let own = LogCategory::ALL.map(|c| schema::Category { name: c.name(), description: c.description() });
    let all = schema::Category { name: LOG_ALL, description: "All categories" };
    schema::LogCategories { categories: own.into_iter().chain([all]).collect() }
}

fn scalar_variable<'a>(variable: &'a Variable, index: &Index<'_>) -> Result<schema::ScalarVariable<'a>, RenderError> {
    Ok(schema::ScalarVariable {
        name: &variable.name,
        value_reference: variable.value_reference,
        description: &variable.description,
        causality: causality(variable.causality),
        variability: variability(variable.variability),
        initial: variable.initial.map(initial),
        attributes: attributes(&variable.kind, index)?,
    })
}

fn attributes<'a>(kind: &'a Kind, index: &Index<'_>) -> Result<Attributes<'a>, RenderError> {
    Ok(match kind {
        Kind::Real { start, bounds, nominal, unit, display_unit, derivative_of } => Attributes::Real {
            unit: *unit,
            display_unit: *display_unit,
            min: bounds.min.map(number),
            max: bounds.max.map(number),
            nominal: nominal.map(number),
            start: start.map(number),
            derivative: derivative_of.as_ref().map(|state| position(index, state)).transpose()?,
        },
        Kind::Integer { start, bounds } => Attributes::Integer { min: bounds.min, max: bounds.max, start: *start },
        Kind::Boolean { start } => Attributes::Boolean { start: *start },
    })
}

/// Dependencies are ordered by index (section 2.2.8); each is of kind `dependent`, the one that
/// makes no claim about the form of the equation.
fn unknowns(list: &[Unknown], index: &Index<'_>) -> Result<schema::Unknowns, RenderError> {
    let unknown = |unknown: &Unknown| {
        let mut dependencies =
            unknown.dependencies.iter().map(|name| position(index, name)).collect::<Result<Vec<_>, _>>()?;
        dependencies.sort_unstable();
        dependencies.dedup();
        let kinds = vec!["dependent"; dependencies.len()];
        let dependencies: Vec<String> = dependencies.iter().map(usize::to_string).collect();
        Ok(schema::Unknown {
            index: position(index, &unknown.variable)?,
            dependencies: dependencies.join(" "),
            dependencies_kind: kinds.join(" "),
        })
    };
    Ok(schema::Unknowns { unknowns: list.iter().map(unknown).collect::<Result<_, _>>()? })
}

fn causality(causality: Causality) -> &'static str {
    match causality {
        Causality::Parameter => "parameter",
        Causality::Input => "input",
        Causality::Output => "output",
        Causality::Local => "local",
        Causality::Independent => "independent",
    }
}

fn variability(variability: Variability) -> &'static str {
    match variability {
        Variability::Constant => "constant",
        Variability::Fixed => "fixed",
        Variability::Tunable => "tunable",
        Variability::Discrete => "discrete",
        Variability::Continuous => "continuous",
    }
}

fn initial(initial: Initial) -> &'static str {
    match initial {
        Initial::Exact => "exact",
        Initial::Approx => "approx",
        Initial::Calculated => "calculated",
    }
}
