//! From names of the variable tables to slots of [`Values`].

use std::collections::BTreeMap;

use crate::description::{Causality, Definition, VariableType};
use crate::fmi2::Values;

/// The slot of Real `name`.
///
/// # Panics
/// If the table has no such variable; names are fixed at compile time and every model resolves
/// all of its names once, in the first instantiation, so a test of any kind finds a wrong one.
pub fn real(definition: &Definition, name: &str) -> usize {
    find(definition, VariableType::Real, name)
}

/// The slot of Integer `name`; panics as [`real`] does.
pub fn integer(definition: &Definition, name: &str) -> usize {
    find(definition, VariableType::Integer, name)
}

/// The slot of Boolean `name`; panics as [`real`] does.
pub fn boolean(definition: &Definition, name: &str) -> usize {
    find(definition, VariableType::Boolean, name)
}

/// The slots of all Real parameters, by name.
pub fn real_parameters(definition: &Definition) -> BTreeMap<String, usize> {
    let parameters = definition
        .variables
        .iter()
        .filter(|v| v.causality == Causality::Parameter && v.variable_type() == VariableType::Real);
    parameters.map(|v| (v.name.clone(), real(definition, &v.name))).collect()
}

fn find(definition: &Definition, variable_type: VariableType, name: &str) -> usize {
    Values::slot(definition, variable_type, name).unwrap_or_else(|| panic!("no variable {name}"))
}
