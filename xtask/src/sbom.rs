//! The software bill of materials of each FMU, in CycloneDX's format.

use std::collections::BTreeMap;

use anyhow::{Context, Result, ensure};
use cyclonedx_bom::models::component::{Classification, Scope};
use cyclonedx_bom::models::dependency::{Dependencies, Dependency};
use cyclonedx_bom::models::license::{LicenseChoice, Licenses};
use cyclonedx_bom::models::property::{Properties, Property};
use cyclonedx_bom::prelude::*;

use crate::fmu::Fmu;
use crate::library::Build;
use crate::linked::Linked;

/// Where the bill lies in the FMU: below `extra/`, which FMI 2.0 has since 2.0.2, the owner of a format names the
/// directory.
pub const IN_ARCHIVE: &str = "extra/org.cyclonedx/bom.json";

/// Licenses of this project and of Rust's standard library.
const USUAL: &str = "MIT OR Apache-2.0";

/// The bill of an FMU whose libraries `builds` made: the linked crates and the standard libraries, and which needs
/// which. It has neither a serial number nor a time, so that equal builds have equal bills.
///
/// # Errors
/// When a crate names no license or none that SPDX knows, or when the bill is not valid.
pub fn render(fmu: Fmu, builds: &[Build], linked: &Linked) -> Result<String> {
    let fmu = component(fmu.identifier, env!("CARGO_PKG_VERSION"), USUAL)?;
    let standard = standard_libraries(builds)?;
    let crates = linked
        .packages
        .iter()
        .map(|package| {
            let (name, version) = (package.name.as_str(), package.version.to_string());
            let license = package.license.as_deref().with_context(|| format!("{name} names no license"))?;
            let mut component = component(name, &version, license)?;
            component.purl = Some(Purl::new("cargo", name, &version)?);
            Ok(component)
        })
        .collect::<Result<Vec<_>>>()?;

    let ids = linked.packages.iter().map(|package| &package.id);
    let references: BTreeMap<_, _> = ids.zip(crates.iter().map(reference)).collect();
    let named = |ids: &[_]| ids.iter().map(|id| references[id].clone()).collect();
    let mut first: Vec<_> = named(&linked.direct);
    first.extend(standard.iter().map(reference));
    let mut dependencies = vec![Dependency { dependency_ref: reference(&fmu), dependencies: first }];
    dependencies.extend(linked.packages.iter().map(|package| Dependency {
        dependency_ref: references[&package.id].clone(),
        dependencies: named(&linked.needs[&package.id]),
    }));

    let bom = Bom {
        serial_number: None,
        metadata: Some(Metadata {
            component: Some(fmu),
            properties: Some(Properties(vec![Property::new("cdx:reproducible", "true")])),
            ..Metadata::default()
        }),
        components: Some(Components(crates.into_iter().chain(standard).collect())),
        dependencies: Some(Dependencies(dependencies)),
        ..Bom::default()
    };
    let validation = bom.validate_version(SpecVersion::V1_5);
    ensure!(validation.passed(), "the bill of materials is not valid: {validation:?}");
    let mut text = Vec::new();
    bom.output_as_json(&mut text, SpecVersion::V1_5)?;
    Ok(String::from_utf8(text)? + "\n")
}

/// One a compiler, with the platforms whose libraries it made.
fn standard_libraries(builds: &[Build]) -> Result<Vec<Component>> {
    let mut platforms: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for build in builds {
        platforms.entry(&build.compiler).or_default().push(build.platform.directory);
    }
    let one = |(compiler, platforms): (&str, Vec<&str>)| {
        let version = compiler.split_whitespace().nth(1).with_context(|| format!("{compiler} has no version"))?;
        let mut component = component("std", version, USUAL)?;
        component.description = Some(NormalizedString::new(&format!("Rust's standard library, by {compiler}")));
        component.properties = Some(Properties(vec![Property::new("rps3:binaries", &platforms.join(" "))]));
        Ok(component)
    };
    platforms.into_iter().map(one).collect()
}

fn component(name: &str, version: &str, license: &str) -> Result<Component> {
    let mut component = Component::new(Classification::Library, name, version, Some(format!("{name}@{version}")));
    let license =
        SpdxExpression::parse_lax(license.to_owned()).with_context(|| format!("{name}: license {license}"))?;
    component.licenses = Some(Licenses(vec![LicenseChoice::Expression(license)]));
    component.scope = Some(Scope::Required);
    Ok(component)
}

fn reference(component: &Component) -> String {
    component.bom_ref.clone().expect("all our components have references")
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::{fmu, linked, platform};

    fn build(platform: platform::Platform, compiler: &str) -> Build {
        Build { platform, compiler: compiler.into(), libraries: BTreeMap::new(), descriptions: PathBuf::new() }
    }

    #[test]
    fn a_second_bill_is_equal() {
        let (linked, builds) = (linked::crates(&[]).unwrap(), [build(platform::LINUX_X86_64, "rustc 1.2.3 (x)")]);
        assert_eq!(render(fmu::PLANT, &builds, &linked).unwrap(), render(fmu::PLANT, &builds, &linked).unwrap());
    }

    #[test]
    fn a_license_that_spdx_does_not_know_is_refused() {
        assert!(component("a", "1.0.0", "MIT/Apache-2.0").is_ok());
        assert!(component("a", "1.0.0", "Sundry").is_err());
    }

    #[test]
    fn platforms_of_one_compiler_share_its_standard_library() {
        let builds = [
            build(platform::LINUX_X86_64, "rustc 1.2.3 (x)"),
            build(platform::WINDOWS_X86_64, "rustc 1.2.4 (y)"),
            build(platform::LINUX_AARCH64, "rustc 1.2.4 (y)"),
        ];
        let found = standard_libraries(&builds).unwrap();
        let properties = found.iter().map(|one| one.properties.as_ref().unwrap().0[0].value.to_string());
        assert_eq!(properties.collect::<Vec<_>>(), ["linux64", "win64 aarch64-linux"]);
    }
}
