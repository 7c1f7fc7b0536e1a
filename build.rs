//! Renders the model descriptions from the variable tables into `OUT_DIR`.
//!
//! The tables are compiled twice, here and in the library, so that the XML, its GUID and the
//! binary can never disagree.
#![allow(dead_code, unused_imports, missing_docs)] // the library uses more of the shared modules than this script

use std::error::Error;
use std::path::Path;
use std::{env, fs};

use uuid::Uuid;

#[path = "src/defaults.rs"]
mod defaults;
#[path = "src/description/mod.rs"]
mod description;
#[path = "src/models"]
mod models {
    pub mod common_table;
    pub mod controller {
        mod dependencies;
        pub mod table;
    }
    pub mod plant {
        mod dependencies;
        pub mod table;
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let sources = [
        "defaults.rs",
        "description",
        "models/common_table.rs",
        "models/controller/dependencies.rs",
        "models/controller/table.rs",
        "models/plant/dependencies.rs",
        "models/plant/table.rs",
    ];
    println!("cargo::rerun-if-changed=build.rs");
    for source in sources {
        println!("cargo::rerun-if-changed=src/{source}");
    }

    let out_dir = env::var("OUT_DIR")?;
    let version = env::var("CARGO_PKG_VERSION")?;
    let mut constants = String::new();
    for (name, definition) in
        [("PLANT", models::plant::table::definition()), ("CONTROLLER", models::controller::table::definition())]
    {
        let identifier = definition.model_identifier;
        let guid = guid(&description::render(&definition, &version, "")?);
        fs::write(
            Path::new(&out_dir).join(format!("{identifier}.xml")),
            description::render(&definition, &version, &guid)?,
        )?;
        constants += &format!(
            "/// The model description of {identifier}.\n\
             pub const {name}: ModelDescription = ModelDescription {{\n\
             \x20   model_identifier: {identifier:?},\n\
             \x20   guid: {guid:?},\n\
             \x20   xml: include_str!(concat!(env!(\"OUT_DIR\"), \"/{identifier}.xml\")),\n\
             }};\n"
        );
    }
    fs::write(Path::new(&out_dir).join("descriptions.rs"), constants)?;
    Ok(())
}

/// A name-based UUID of the description without its GUID: equal texts, equal GUIDs.
fn guid(text: &str) -> String {
    format!("{{{}}}", Uuid::new_v5(&Uuid::NAMESPACE_OID, text.as_bytes()))
}
