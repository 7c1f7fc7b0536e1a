//! The values of all variables of an instance, by slot.
//!
//! A *slot* is a variable's place among those of its base type, in the order of
//! [`Definition::variables`]; value references are mapped to slots by the FMI layer.

use serde::{Deserialize, Serialize};

use crate::description::{Definition, Kind, VariableType};

/// Values by base type and slot.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct Values {
    /// Real values, in the units of the table.
    pub reals: Vec<f64>,
    /// Integer values.
    pub integers: Vec<i32>,
    /// Boolean values.
    pub booleans: Vec<bool>,
    /// By slot of the Reals: what the host set last was not finite, and `reals` holds the last value
    /// that was. True for variables alone that [may be missing](crate::description::Variable::may_be_missing).
    pub missing: Vec<bool>,
}

impl Clone for Values {
    fn clone(&self) -> Self {
        Self {
            reals: self.reals.clone(),
            integers: self.integers.clone(),
            booleans: self.booleans.clone(),
            missing: self.missing.clone(),
        }
    }

    /// Reuses what is allocated: every communication step copies the values.
    fn clone_from(&mut self, source: &Self) {
        self.reals.clone_from(&source.reals);
        self.integers.clone_from(&source.integers);
        self.booleans.clone_from(&source.booleans);
        self.missing.clone_from(&source.missing);
    }
}

impl Values {
    /// The start values of `definition`; zero or false for what has none.
    pub fn start(definition: &Definition) -> Self {
        let mut values = Self { reals: Vec::new(), integers: Vec::new(), booleans: Vec::new(), missing: Vec::new() };
        for variable in &definition.variables {
            match variable.kind {
                Kind::Real { start, .. } => {
                    values.reals.push(start.unwrap_or(0.0));
                    values.missing.push(false);
                }
                Kind::Integer { start, .. } => values.integers.push(start.unwrap_or(0)),
                Kind::Boolean { start } => values.booleans.push(start.unwrap_or(false)),
            }
        }
        values
    }

    /// The slot of the variable called `name`, `None` if there is none of that type.
    pub fn slot(definition: &Definition, variable_type: VariableType, name: &str) -> Option<usize> {
        definition.variables.iter().filter(|v| v.variable_type() == variable_type).position(|v| v.name == name)
    }
}
