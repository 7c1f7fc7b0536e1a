//! The SSP 1.0 package: both FMUs, connected by equal names.
//!
//! `SystemStructure.ssd` is the six-motor variant, `ThreeMotors.ssd` the one with leg motors only;
//! they differ in the parameter set that both components are bound to.

mod document;

use anyhow::{Context, Result};
use quick_xml::se::Serializer;
use roxmltree::{Document, Node};
use serde::Serialize;

use self::document::{
    BaseUnit, BooleanValue, Component, Connection, Connections, Connector, ConnectorType, Connectors,
    DefaultExperiment, Elements, Parameter, ParameterBinding, ParameterBindings, ParameterSet, Parameters, System,
    SystemStructureDescription, Unit, Units,
};
use crate::archive::Archive;
use crate::fmu::Fmu;

const SSD: &str = "http://ssp-standard.org/SSP1/SystemStructureDescription";
const SSC: &str = "http://ssp-standard.org/SSP1/SystemStructureCommon";
const SSV: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterValues";

/// System structure file, stem of its parameter set, value of `revolute_motors`.
const VARIANTS: [(&str, &str, bool); 2] =
    [("SystemStructure.ssd", "six_motors", true), ("ThreeMotors.ssd", "three_motors", false)];

/// The package's contents from (FMU, model description, archive) of each component.
///
/// # Errors
/// When a model description cannot be read.
pub fn archive(fmus: &[(Fmu, String, Vec<u8>)]) -> Result<Archive> {
    let documents = fmus
        .iter()
        .map(|(fmu, xml, _)| Ok((*fmu, Document::parse(xml).with_context(|| fmu.description_file())?)))
        .collect::<Result<Vec<_>>>()?;
    let mut archive = Archive::default();
    for (fmu, _, bytes) in fmus {
        archive.insert(format!("resources/{}", fmu.archive_file()), bytes.clone());
    }
    for (file, set, revolute_motors) in VARIANTS {
        archive.insert(file, render(&SystemStructureDescription::new(&documents, set))?);
        archive.insert(format!("resources/{set}.ssv"), render(&ParameterSet::new(set, revolute_motors))?);
    }
    Ok(archive)
}

fn render(root: &impl Serialize) -> Result<String> {
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let mut serializer = Serializer::new(&mut text);
    serializer.indent(' ', 2);
    root.serialize(serializer)?;
    text.push('\n');
    Ok(text)
}

impl SystemStructureDescription {
    fn new(fmus: &[(Fmu, Document)], parameter_set: &str) -> Self {
        let all: Vec<_> = fmus.iter().map(|(fmu, document)| Component::new(*fmu, document, parameter_set)).collect();
        let connections = connections(&all);
        let components = all.into_iter().map(|component| component.without_open_inputs(&connections)).collect();
        let experiment = fmus.iter().find_map(|(_, document)| element(document, "DefaultExperiment"));
        let time = |name, default: &str| experiment.and_then(|node| node.attribute(name)).unwrap_or(default).to_owned();
        Self {
            ssd: SSD,
            ssc: SSC,
            version: "1.0",
            name: "Rps3",
            system: System {
                name: "Rps3",
                connections: Connections { connections },
                elements: Elements { components },
            },
            units: Units { units: units(fmus) },
            default_experiment: DefaultExperiment {
                start_time: time("startTime", "0"),
                stop_time: time("stopTime", "1"),
            },
        }
    }
}

impl Component {
    fn new(fmu: Fmu, document: &Document, parameter_set: &str) -> Self {
        let variables = element(document, "ModelVariables").into_iter().flat_map(|node| node.children());
        Self {
            name: fmu.component,
            kind: "application/x-fmu-sharedlibrary",
            source: format!("resources/{}", fmu.archive_file()),
            implementation: "CoSimulation",
            connectors: Connectors { connectors: variables.filter_map(Connector::new).collect() },
            bindings: ParameterBindings {
                binding: ParameterBinding {
                    kind: "application/x-ssp-parameter-set",
                    source: format!("resources/{parameter_set}.ssv"),
                },
            },
        }
    }

    /// Leaves out inputs that nothing feeds: they keep their start values. FMPy 0.3.32 would connect them to
    /// whatever feeds the input before.
    fn without_open_inputs(mut self, connections: &[Connection]) -> Self {
        let fed = |name: &str| connections.iter().any(|c| c.end_element == self.name && c.end_connector == name);
        self.connectors.connectors.retain(|connector| connector.kind == "output" || fed(&connector.name));
        self
    }

    fn of_kind<'a>(&'a self, kind: &'a str) -> impl Iterator<Item = &'a str> {
        let connectors = self.connectors.connectors.iter();
        connectors.filter(move |connector| connector.kind == kind).map(|connector| connector.name.as_str())
    }
}

impl Connector {
    /// The connector of a `ScalarVariable` that is an input or output.
    fn new(variable: Node) -> Option<Self> {
        let kind = variable.attribute("causality").filter(|causality| ["input", "output"].contains(causality))?;
        let declared = variable.first_element_child()?;
        let value = match declared.tag_name().name() {
            "Real" => ConnectorType::Real { unit: declared.attribute("unit").map(String::from) },
            "Integer" => ConnectorType::Integer,
            "Boolean" => ConnectorType::Boolean,
            _ => return None,
        };
        Some(Self { name: variable.attribute("name")?.to_owned(), kind: kind.to_owned(), value })
    }
}

/// Every output of one component to the input of the same name of another.
fn connections(components: &[Component]) -> Vec<Connection> {
    let mut list = Vec::new();
    for from in components {
        for to in components.iter().filter(|to| to.name != from.name) {
            let shared = from.of_kind("output").filter(|output| to.of_kind("input").any(|input| input == *output));
            list.extend(shared.map(|name| Connection {
                start_element: from.name,
                start_connector: name.to_owned(),
                end_element: to.name,
                end_connector: name.to_owned(),
            }));
        }
    }
    list
}

/// The unit definitions of all FMUs, each name once.
fn units(fmus: &[(Fmu, Document)]) -> Vec<Unit> {
    let mut units: Vec<Unit> = Vec::new();
    let definitions = fmus.iter().filter_map(|(_, document)| element(document, "UnitDefinitions"));
    for node in definitions.flat_map(|definitions| definitions.children()).filter(|node| node.has_tag_name("Unit")) {
        let Some(name) = node.attribute("name").filter(|name| units.iter().all(|unit| unit.name != *name)) else {
            continue;
        };
        let base = node.children().find(|child| child.has_tag_name("BaseUnit"));
        let attribute = |key| base.and_then(|base| base.attribute(key)).map(String::from);
        units.push(Unit {
            name: name.to_owned(),
            base: BaseUnit {
                kg: attribute("kg"),
                m: attribute("m"),
                s: attribute("s"),
                ampere: attribute("A"),
                rad: attribute("rad"),
                factor: attribute("factor"),
                offset: attribute("offset"),
            },
        });
    }
    units
}

fn element<'a, 'input>(document: &'a Document<'input>, name: &str) -> Option<Node<'a, 'input>> {
    document.root_element().children().find(|node| node.has_tag_name(name))
}

impl ParameterSet {
    fn new(name: &'static str, revolute_motors: bool) -> Self {
        let parameter = Parameter { name: "revolute_motors", value: BooleanValue { value: revolute_motors } };
        Self { ssv: SSV, ssc: SSC, version: "1.0", name, parameters: Parameters { parameter } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fmu::{CONTROLLER, PLANT};

    /// A model with one input that bears the other's output name, an output, an input of its own and a parameter.
    fn description(input: &str, output: &str) -> String {
        format!(
            r#"<fmiModelDescription><UnitDefinitions><Unit name="V"><BaseUnit kg="1" m="2" s="-3" A="-1"/></Unit></UnitDefinitions>
            <DefaultExperiment startTime="0" stopTime="1.4"/><ModelVariables>
            <ScalarVariable name="{input}" causality="input"><Real unit="V"/></ScalarVariable>
            <ScalarVariable name="{output}" causality="output"><Real/></ScalarVariable>
            <ScalarVariable name="load" causality="input"><Real/></ScalarVariable>
            <ScalarVariable name="gain" causality="parameter"><Real/></ScalarVariable></ModelVariables></fmiModelDescription>"#
        )
    }

    #[test]
    fn inputs_are_connected_to_outputs_of_the_same_name() {
        let xml = [description("d1", "v_leg1"), description("v_leg1", "d1")];
        let documents = [CONTROLLER, PLANT].into_iter().zip(xml.iter().map(|xml| Document::parse(xml).unwrap()));
        let ssd = render(&SystemStructureDescription::new(&documents.collect::<Vec<_>>(), "six_motors")).unwrap();
        let ssd = Document::parse(&ssd).unwrap();
        let connections: Vec<_> = ssd
            .descendants()
            .filter(|node| node.has_tag_name((SSD, "Connection")))
            .map(|node| {
                ["startElement", "startConnector", "endElement", "endConnector"].map(|key| node.attribute(key).unwrap())
            })
            .collect();
        assert_eq!(connections, [["controller", "v_leg1", "plant", "v_leg1"], ["plant", "d1", "controller", "d1"]]);
        assert_eq!(ssd.descendants().filter(|node| node.has_tag_name((SSC, "Unit"))).count(), 1);
        assert!(ssd.descendants().all(|node| !["gain", "load"].map(Some).contains(&node.attribute("name"))));
    }
}
