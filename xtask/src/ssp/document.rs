//! Elements of SSP 1.0 files, as serde writes them.
#![allow(missing_docs, reason = "the fields are the standard's attributes, named in their renames")]

use serde::Serialize;

/// Root element of an `.ssd` file.
#[derive(Serialize)]
#[serde(rename = "ssd:SystemStructureDescription")]
pub struct SystemStructureDescription {
    #[serde(rename = "@xmlns:ssd")]
    pub ssd: &'static str,
    #[serde(rename = "@xmlns:ssc")]
    pub ssc: &'static str,
    #[serde(rename = "@version")]
    pub version: &'static str,
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "ssd:System")]
    pub system: System,
    #[serde(rename = "ssd:Units")]
    pub units: Units,
    #[serde(rename = "ssd:DefaultExperiment")]
    pub default_experiment: DefaultExperiment,
}

/// The system: its components and how they are connected.
#[derive(Serialize)]
pub struct System {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "ssd:Elements")]
    pub elements: Elements,
    #[serde(rename = "ssd:Connections")]
    pub connections: Connections,
}

/// The components.
#[derive(Serialize)]
pub struct Elements {
    #[serde(rename = "ssd:Component")]
    pub components: Vec<Component>,
}

/// An FMU in the system.
#[derive(Serialize)]
pub struct Component {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "@type")]
    pub kind: &'static str,
    #[serde(rename = "@source")]
    pub source: String,
    #[serde(rename = "@implementation")]
    pub implementation: &'static str,
    #[serde(rename = "ssd:Connectors")]
    pub connectors: Connectors,
    #[serde(rename = "ssd:ParameterBindings")]
    pub bindings: ParameterBindings,
}

/// Inputs and outputs of a component.
#[derive(Serialize)]
pub struct Connectors {
    #[serde(rename = "ssd:Connector")]
    pub connectors: Vec<Connector>,
}

/// An input or output.
#[derive(Serialize)]
pub struct Connector {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@kind")]
    pub kind: String,
    #[serde(rename = "$value")]
    pub value: ConnectorType,
}

/// Base type of a connector.
#[derive(Serialize)]
pub enum ConnectorType {
    #[serde(rename = "ssc:Real")]
    Real {
        #[serde(rename = "@unit", skip_serializing_if = "Option::is_none")]
        unit: Option<String>,
    },
    #[serde(rename = "ssc:Integer")]
    Integer,
    #[serde(rename = "ssc:Boolean")]
    Boolean,
}

/// What parameterizes a component.
#[derive(Serialize)]
pub struct ParameterBindings {
    #[serde(rename = "ssd:ParameterBinding")]
    pub binding: ParameterBinding,
}

/// Reference to a parameter set.
#[derive(Serialize)]
pub struct ParameterBinding {
    #[serde(rename = "@type")]
    pub kind: &'static str,
    #[serde(rename = "@source")]
    pub source: String,
}

/// All connections of the system.
#[derive(Serialize)]
pub struct Connections {
    #[serde(rename = "ssd:Connection")]
    pub connections: Vec<Connection>,
}

/// From an output to an input.
#[derive(Serialize)]
pub struct Connection {
    #[serde(rename = "@startElement")]
    pub start_element: &'static str,
    #[serde(rename = "@startConnector")]
    pub start_connector: String,
    #[serde(rename = "@endElement")]
    pub end_element: &'static str,
    #[serde(rename = "@endConnector")]
    pub end_connector: String,
}

/// Unit definitions.
#[derive(Serialize)]
pub struct Units {
    #[serde(rename = "ssc:Unit")]
    pub units: Vec<Unit>,
}

/// A unit by its SI base units.
#[derive(Serialize)]
pub struct Unit {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "ssc:BaseUnit")]
    pub base: BaseUnit,
}

/// Exponents of the SI base units, factor and offset: the same attributes as in FMI 2.0.
#[derive(Serialize)]
pub struct BaseUnit {
    #[serde(rename = "@kg", skip_serializing_if = "Option::is_none")]
    pub kg: Option<String>,
    #[serde(rename = "@m", skip_serializing_if = "Option::is_none")]
    pub m: Option<String>,
    #[serde(rename = "@s", skip_serializing_if = "Option::is_none")]
    pub s: Option<String>,
    #[serde(rename = "@A", skip_serializing_if = "Option::is_none")]
    pub ampere: Option<String>,
    #[serde(rename = "@rad", skip_serializing_if = "Option::is_none")]
    pub rad: Option<String>,
    #[serde(rename = "@factor", skip_serializing_if = "Option::is_none")]
    pub factor: Option<String>,
    #[serde(rename = "@offset", skip_serializing_if = "Option::is_none")]
    pub offset: Option<String>,
}

/// Start and stop time, seconds.
#[derive(Serialize)]
pub struct DefaultExperiment {
    #[serde(rename = "@startTime")]
    pub start_time: String,
    #[serde(rename = "@stopTime")]
    pub stop_time: String,
}

/// Root element of an `.ssv` file.
#[derive(Serialize)]
#[serde(rename = "ssv:ParameterSet")]
pub struct ParameterSet {
    #[serde(rename = "@xmlns:ssv")]
    pub ssv: &'static str,
    #[serde(rename = "@xmlns:ssc")]
    pub ssc: &'static str,
    #[serde(rename = "@version")]
    pub version: &'static str,
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "ssv:Parameters")]
    pub parameters: Parameters,
}

/// The values of a parameter set.
#[derive(Serialize)]
pub struct Parameters {
    #[serde(rename = "ssv:Parameter")]
    pub parameter: Parameter,
}

/// A Boolean parameter by name.
#[derive(Serialize)]
pub struct Parameter {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "ssv:Boolean")]
    pub value: BooleanValue,
}

/// The value of a Boolean parameter.
#[derive(Serialize)]
pub struct BooleanValue {
    #[serde(rename = "@value")]
    pub value: bool,
}
