//! docs/paper-map.md and docs/errata.md name functions and tests; all of them must exist.

use std::path::Path;

/// The `path::name` references between backticks.
fn references(text: &str) -> Vec<(&str, &str)> {
    text.split('`')
        .skip(1)
        .step_by(2)
        .filter_map(|code| code.split_once("::"))
        .filter(|(path, _)| path.contains('/'))
        .collect()
}

fn defines(source: &str, name: &str) -> bool {
    ["fn", "def", "struct", "enum", "const", "class"].iter().any(|keyword| {
        source.match_indices(&format!("{keyword} {name}")).any(|(at, found)| {
            source[at + found.len()..].chars().next().is_none_or(|c| !c.is_alphanumeric() && c != '_')
        })
    })
}

#[test]
fn every_function_and_test_that_the_documents_name_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut missing = Vec::new();
    for document in ["docs/paper-map.md", "docs/errata.md", "docs/theory.md", "docs/control.md"] {
        let text = std::fs::read_to_string(root.join(document)).unwrap();
        for (path, name) in references(&text) {
            let found = std::fs::read_to_string(root.join(path)).is_ok_and(|source| defines(&source, name));
            if !found {
                missing.push(format!("{document}: {path}::{name}"));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
}

#[test]
fn the_map_has_a_row_for_every_equation_figure_table_and_appendix() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let map = std::fs::read_to_string(root.join("docs/paper-map.md")).unwrap();
    let numbered = [(2, 11), (3, 5), (4, 18), (5, 6), (6, 9)];
    let equations =
        numbered.into_iter().flat_map(|(section, last)| (1..=last).map(move |k| format!("({section}.{k})")));
    let others = (1..=10)
        .map(|k| format!("Figure {k}"))
        .chain(["Table 1", "(A.1)", "(A.2)", "(B.1)", "(B.2)", "(C.1)"].map(String::from));
    let missing: Vec<String> = equations.chain(others).filter(|item| !map.contains(&format!("| {item} |"))).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn a_name_must_match_whole() {
    assert!(defines("pub fn singular_heights(", "singular_heights"));
    assert!(!defines("pub fn singular_heights(", "singular_height"));
    assert_eq!(references("see `src/a.rs::f` and `Vec::new`"), [("src/a.rs", "f")]);
}
