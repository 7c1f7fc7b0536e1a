//! The rendered model descriptions, as `build.rs` made them from the variable tables.

/// A rendered model description.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModelDescription {
    /// Name of the model and of its shared library.
    pub model_identifier: &'static str,
    /// The `guid` attribute: a fingerprint of the rest of the text.
    pub guid: &'static str,
    /// The text of `modelDescription.xml`.
    pub xml: &'static str,
}

include!(concat!(env!("OUT_DIR"), "/descriptions.rs"));

/// Every model description of this crate.
pub const ALL: [ModelDescription; 2] = [PLANT, CONTROLLER];
