//! The rendered model descriptions.

use std::collections::BTreeSet;
use std::path::Path;

use rps3::description::{Definition, Kind, RenderError, Unknown, Variable, render};
use rps3::models::descriptions::{ALL, ModelDescription};
use rps3::models::{controller, plant};

const VERSION: &str = env!("CARGO_PKG_VERSION");

fn with_definitions() -> [(ModelDescription, Definition); 2] {
    let definitions = [plant::table::definition(), controller::table::definition()];
    let mut descriptions = ALL.into_iter();
    definitions.map(|definition| (descriptions.next().unwrap(), definition))
}

/// Values of an attribute, in document order.
fn attributes<'a>(xml: &'a str, name: &str) -> Vec<&'a str> {
    xml.split(&format!(" {name}=\"")).skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
}

/// The text between the first `<name` and `</name>`.
fn element<'a>(xml: &'a str, name: &str) -> &'a str {
    let start = xml.find(&format!("<{name}")).unwrap_or_else(|| panic!("no {name}"));
    &xml[start..start + xml[start..].find(&format!("</{name}>")).unwrap()]
}

#[test]
fn the_committed_copies_are_what_the_build_renders() {
    for description in ALL {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("modelDescription")
            .join(format!("{}.xml", description.model_identifier));
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            committed == description.xml,
            "{} is out of date: `cargo xtask describe` renders it anew",
            path.display()
        );
    }
}

#[test]
fn the_text_depends_on_the_tables_alone() {
    for (description, definition) in with_definitions() {
        assert_eq!(render(&definition, VERSION, description.guid).unwrap(), description.xml);
    }
}

#[test]
fn the_guid_changes_with_any_content() {
    let guids: BTreeSet<_> = ALL.iter().map(|d| d.guid).collect();
    assert_eq!(guids.len(), ALL.len());
    for description in ALL {
        assert_eq!(attributes(description.xml, "guid"), [description.guid]);
        assert_eq!(description.guid.len(), "{00000000-0000-0000-0000-000000000000}".len());
        assert_eq!(&description.guid[15..16], "5", "a name-based UUID: a fingerprint of the text");
    }
}

#[test]
fn the_derivative_attribute_is_the_states_index_counted_from_one() {
    let (description, definition) = &with_definitions()[0];
    let derivatives: Vec<usize> =
        attributes(description.xml, "derivative").into_iter().map(|i| i.parse().unwrap()).collect();
    let states: Vec<usize> = definition
        .variables
        .iter()
        .filter_map(|v| match &v.kind {
            Kind::Real { derivative_of: Some(state), .. } => {
                Some(1 + definition.variables.iter().position(|v| v.name == *state).unwrap())
            }
            _ => None,
        })
        .collect();
    assert_eq!(derivatives, states);
    assert_eq!(derivatives.len(), 12);
}

#[test]
fn dependencies_are_explicit_ordered_and_each_has_its_kind() {
    for description in ALL {
        let structure = element(description.xml, "ModelStructure");
        let (dependencies, kinds) = (attributes(structure, "dependencies"), attributes(structure, "dependenciesKind"));
        assert_eq!(dependencies.len(), structure.matches("<Unknown ").count(), "never left out");
        assert_eq!(kinds.len(), dependencies.len());
        for (dependencies, kinds) in dependencies.iter().zip(kinds) {
            let indices: Vec<usize> = dependencies.split_whitespace().map(|i| i.parse().unwrap()).collect();
            assert!(indices.is_sorted_by(|a, b| a < b), "{dependencies}");
            assert_eq!(indices.len(), kinds.split_whitespace().count());
        }
    }
    let plant = element(ALL[0].xml, "ModelStructure");
    assert!(attributes(plant, "dependencies").contains(&""), "what depends on nothing says so");
}

#[test]
fn units_are_defined_exactly_once_and_used() {
    for description in ALL {
        let defined = attributes(element(description.xml, "UnitDefinitions"), "name");
        let units: BTreeSet<_> = attributes(description.xml, "unit").into_iter().collect();
        let display_units: BTreeSet<_> = attributes(description.xml, "displayUnit").into_iter().collect();
        let used: BTreeSet<_> = units.union(&display_units).copied().collect();
        assert_eq!(defined.iter().copied().collect::<BTreeSet<_>>(), used);
    }
}

#[test]
fn display_units_convert_by_factor() {
    let xml = ALL[0].xml;
    let factor = |unit: &str| -> f64 {
        let text = &xml[xml.find(&format!("<DisplayUnit name=\"{unit}\"")).unwrap()..];
        attributes(text, "factor")[0].parse().unwrap()
    };
    assert_eq!(factor("cm"), 100.0); // 1 m is 100 cm
    assert!((factor("deg") * std::f64::consts::PI - 180.0).abs() < 1e-12);
}

#[test]
fn both_interfaces_claim_what_works() {
    for description in ALL {
        for interface in ["ModelExchange", "CoSimulation"] {
            let text = &description.xml[description.xml.find(&format!("<{interface} ")).unwrap()..];
            let text = &text[..text.find("/>").unwrap()];
            assert_eq!(attributes(text, "modelIdentifier"), [description.model_identifier]);
            for flag in [
                "canGetAndSetFMUstate",
                "canSerializeFMUstate",
                "canNotUseMemoryManagementFunctions",
                "providesDirectionalDerivative",
            ] {
                assert_eq!(attributes(text, flag), ["true"], "{interface} {flag}");
            }
            assert_eq!(attributes(text, "canBeInstantiatedOnlyOncePerProcess"), ["false"]);
        }
    }
}

#[test]
fn who_serializes_states_can_get_and_set_them() {
    for description in ALL {
        let [access, serialization] =
            ["canGetAndSetFMUstate", "canSerializeFMUstate"].map(|flag| attributes(description.xml, flag));
        assert_eq!(access.len(), 2, "for each interface");
        assert!(
            access
                .iter()
                .zip(&serialization)
                .all(|(access, serialization)| { *serialization == "false" || *access == "true" })
        );
    }
}

#[test]
fn nothing_is_written_that_importers_stumble_over() {
    for description in ALL {
        let xml = description.xml;
        assert!(xml.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription "));
        for word in
            ["xmlns", "canHandleMultipleSetPerTimeInstant", "NaN", "\"inf\"", "\"-inf\"", "generationDateAndTime"]
        {
            assert!(!xml.contains(word), "{word}");
        }
        for list in ["UnitDefinitions", "Outputs", "Derivatives", "InitialUnknowns"] {
            assert!(!xml.contains(&format!("<{list}/>")) && !xml.contains(&format!("<{list}></{list}>")), "{list}");
        }
    }
}

#[test]
fn numbers_read_back_as_the_same_bits() {
    let (description, definition) = &with_definitions()[0];
    let mut starts = attributes(description.xml, "start").into_iter();
    for v in &definition.variables {
        match v.kind {
            Kind::Real { start: Some(start), .. } => {
                assert_eq!(starts.next().unwrap().parse::<f64>().unwrap().to_bits(), start.to_bits(), "{}", v.name);
            }
            Kind::Integer { start: Some(_), .. } | Kind::Boolean { start: Some(_) } => drop(starts.next()),
            _ => {}
        }
    }
}

#[test]
fn text_is_escaped() {
    let mut definition = plant::table::definition();
    definition.variables[1].description = "a < b & \"c\"".into();
    let xml = render(&definition, VERSION, "").unwrap();
    assert!(xml.contains("description=\"a &lt; b &amp; &quot;c&quot;\""));
}

#[test]
fn a_definition_that_contradicts_itself_is_refused() {
    let broken = |change: fn(&mut Definition)| {
        let mut definition = plant::table::definition();
        change(&mut definition);
        render(&definition, VERSION, "").unwrap_err()
    };
    assert_eq!(
        broken(|d| d.variables.push(Variable::real("odd", 9999, Some("furlong"), "odd"))),
        RenderError::UnknownUnit("furlong".into())
    );
    assert_eq!(
        broken(|d| d.variables.push(Variable::real("odd", 9999, Some("m"), "odd").display("furlong"))),
        RenderError::UnknownDisplayUnit("furlong".into())
    );
    assert_eq!(
        broken(|d| d.outputs.push(Unknown { variable: "nobody".into(), dependencies: vec![] })),
        RenderError::UnknownVariable("nobody".into())
    );
    assert_eq!(
        broken(|d| d.outputs[0].dependencies.push("nobody".into())),
        RenderError::UnknownVariable("nobody".into())
    );
}
