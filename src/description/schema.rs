//! `fmi2ModelDescription.xsd` as far as our FMUs use it, for serde.
//!
//! Field order is the schema's order. Numbers are text already, see [`number`].

use serde::Serialize;

/// `xs:double` in the shortest form that reads back as the same value.
pub fn number(value: f64) -> String {
    format!("{value:?}")
}

#[derive(Serialize)]
#[serde(rename = "fmiModelDescription")]
pub struct ModelDescription<'a> {
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: &'a str,
    #[serde(rename = "@modelName")]
    pub model_name: &'a str,
    #[serde(rename = "@guid")]
    pub guid: &'a str,
    #[serde(rename = "@description")]
    pub description: &'a str,
    #[serde(rename = "@version")]
    pub version: &'a str,
    #[serde(rename = "@license")]
    pub license: &'a str,
    #[serde(rename = "@generationTool")]
    pub generation_tool: String,
    #[serde(rename = "@variableNamingConvention")]
    pub variable_naming_convention: &'a str,
    #[serde(rename = "@numberOfEventIndicators")]
    pub number_of_event_indicators: usize,
    #[serde(rename = "ModelExchange")]
    pub model_exchange: ModelExchange<'a>,
    #[serde(rename = "CoSimulation")]
    pub co_simulation: CoSimulation<'a>,
    #[serde(rename = "UnitDefinitions", skip_serializing_if = "UnitDefinitions::is_empty")]
    pub unit_definitions: UnitDefinitions<'a>,
    #[serde(rename = "LogCategories")]
    pub log_categories: LogCategories<'a>,
    #[serde(rename = "DefaultExperiment")]
    pub default_experiment: DefaultExperiment,
    #[serde(rename = "ModelVariables")]
    pub model_variables: ModelVariables<'a>,
    #[serde(rename = "ModelStructure")]
    pub model_structure: ModelStructure,
}

#[derive(Serialize)]
pub struct ModelExchange<'a> {
    #[serde(rename = "@modelIdentifier")]
    pub model_identifier: &'a str,
    #[serde(rename = "@completedIntegratorStepNotNeeded")]
    pub completed_integrator_step_not_needed: bool,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    pub can_be_instantiated_only_once_per_process: bool,
    #[serde(rename = "@canNotUseMemoryManagementFunctions")]
    pub can_not_use_memory_management_functions: bool,
    #[serde(rename = "@canGetAndSetFMUstate")]
    pub can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUstate")]
    pub can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivative")]
    pub provides_directional_derivative: bool,
}

#[derive(Serialize)]
pub struct CoSimulation<'a> {
    #[serde(rename = "@modelIdentifier")]
    pub model_identifier: &'a str,
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    pub can_handle_variable_communication_step_size: bool,
    #[serde(rename = "@canInterpolateInputs")]
    pub can_interpolate_inputs: bool,
    #[serde(rename = "@maxOutputDerivativeOrder")]
    pub max_output_derivative_order: u32,
    /// The standard's own spelling.
    #[serde(rename = "@canRunAsynchronuously")]
    pub can_run_asynchronously: bool,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    pub can_be_instantiated_only_once_per_process: bool,
    #[serde(rename = "@canNotUseMemoryManagementFunctions")]
    pub can_not_use_memory_management_functions: bool,
    #[serde(rename = "@canGetAndSetFMUstate")]
    pub can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUstate")]
    pub can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivative")]
    pub provides_directional_derivative: bool,
}

#[derive(Serialize)]
pub struct UnitDefinitions<'a> {
    #[serde(rename = "Unit")]
    pub units: Vec<Unit<'a>>,
}

impl UnitDefinitions<'_> {
    fn is_empty(&self) -> bool {
        self.units.is_empty()
    }
}

#[derive(Serialize)]
pub struct Unit<'a> {
    #[serde(rename = "@name")]
    pub name: &'a str,
    #[serde(rename = "BaseUnit")]
    pub base_unit: BaseUnit,
    #[serde(rename = "DisplayUnit", skip_serializing_if = "Vec::is_empty")]
    pub display_units: Vec<DisplayUnit<'a>>,
}

#[derive(Serialize)]
pub struct BaseUnit {
    #[serde(rename = "@kg", skip_serializing_if = "is_zero")]
    pub kg: i32,
    #[serde(rename = "@m", skip_serializing_if = "is_zero")]
    pub m: i32,
    #[serde(rename = "@s", skip_serializing_if = "is_zero")]
    pub s: i32,
    #[serde(rename = "@A", skip_serializing_if = "is_zero")]
    pub a: i32,
    #[serde(rename = "@rad", skip_serializing_if = "is_zero")]
    pub rad: i32,
}

fn is_zero(exponent: &i32) -> bool {
    *exponent == 0
}

#[derive(Serialize)]
pub struct DisplayUnit<'a> {
    #[serde(rename = "@name")]
    pub name: &'a str,
    #[serde(rename = "@factor")]
    pub factor: String,
}

#[derive(Serialize)]
pub struct LogCategories<'a> {
    #[serde(rename = "Category")]
    pub categories: Vec<Category<'a>>,
}

#[derive(Serialize)]
pub struct Category<'a> {
    #[serde(rename = "@name")]
    pub name: &'a str,
    #[serde(rename = "@description")]
    pub description: &'a str,
}

#[derive(Serialize)]
pub struct DefaultExperiment {
    #[serde(rename = "@startTime")]
    pub start_time: String,
    #[serde(rename = "@stopTime")]
    pub stop_time: String,
    #[serde(rename = "@tolerance")]
    pub tolerance: String,
    #[serde(rename = "@stepSize")]
    pub step_size: String,
}

#[derive(Serialize)]
pub struct ModelVariables<'a> {
    #[serde(rename = "ScalarVariable")]
    pub variables: Vec<ScalarVariable<'a>>,
}

#[derive(Serialize)]
pub struct ScalarVariable<'a> {
    #[serde(rename = "@name")]
    pub name: &'a str,
    #[serde(rename = "@valueReference")]
    pub value_reference: u32,
    #[serde(rename = "@description")]
    pub description: &'a str,
    #[serde(rename = "@causality")]
    pub causality: &'static str,
    #[serde(rename = "@variability")]
    pub variability: &'static str,
    #[serde(rename = "@initial", skip_serializing_if = "Option::is_none")]
    pub initial: Option<&'static str>,
    #[serde(rename = "$value")]
    pub attributes: Attributes<'a>,
}

/// The element inside `ScalarVariable`.
#[derive(Serialize)]
pub enum Attributes<'a> {
    Real {
        #[serde(rename = "@unit", skip_serializing_if = "Option::is_none")]
        unit: Option<&'a str>,
        #[serde(rename = "@displayUnit", skip_serializing_if = "Option::is_none")]
        display_unit: Option<&'a str>,
        #[serde(rename = "@min", skip_serializing_if = "Option::is_none")]
        min: Option<String>,
        #[serde(rename = "@max", skip_serializing_if = "Option::is_none")]
        max: Option<String>,
        #[serde(rename = "@nominal", skip_serializing_if = "Option::is_none")]
        nominal: Option<String>,
        #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
        start: Option<String>,
        #[serde(rename = "@derivative", skip_serializing_if = "Option::is_none")]
        derivative: Option<usize>,
    },
    Integer {
        #[serde(rename = "@min", skip_serializing_if = "Option::is_none")]
        min: Option<i32>,
        #[serde(rename = "@max", skip_serializing_if = "Option::is_none")]
        max: Option<i32>,
        #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
        start: Option<i32>,
    },
    Boolean {
        #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
        start: Option<bool>,
    },
}

#[derive(Serialize)]
pub struct ModelStructure {
    #[serde(rename = "Outputs", skip_serializing_if = "Unknowns::is_empty")]
    pub outputs: Unknowns,
    #[serde(rename = "Derivatives", skip_serializing_if = "Unknowns::is_empty")]
    pub derivatives: Unknowns,
    #[serde(rename = "InitialUnknowns", skip_serializing_if = "Unknowns::is_empty")]
    pub initial_unknowns: Unknowns,
}

#[derive(Serialize)]
pub struct Unknowns {
    #[serde(rename = "Unknown")]
    pub unknowns: Vec<Unknown>,
}

impl Unknowns {
    fn is_empty(&self) -> bool {
        self.unknowns.is_empty()
    }
}

/// Both lists are always written: a missing `dependencies` would mean «depends on all».
#[derive(Serialize)]
pub struct Unknown {
    #[serde(rename = "@index")]
    pub index: usize,
    #[serde(rename = "@dependencies")]
    pub dependencies: String,
    #[serde(rename = "@dependenciesKind")]
    pub dependencies_kind: String,
}
