//! Why a call fails, and what that means for its status and for the instance.

use super::model::ModelError;
use super::types::Status;
use crate::description::LogCategory;

/// A call that did not simply succeed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CallError {
    /// `fmi2Warning`: the call did what it could, and the simulation can go on.
    #[error("{0}")]
    Warned(String),
    /// The call itself was wrong (order, arguments, data): `fmi2Error`. Nothing was changed and the
    /// instance stays as usable as it was.
    #[error("{0}")]
    Refused(String),
    /// `fmi2Discard`: other inputs or a smaller step may do. The instance is as before the call.
    #[error("{0}")]
    Discard(String),
    /// `fmi2Discard` of a status that this FMU does not keep (section 4.2.3).
    #[error("{0}")]
    NoSuchStatus(String),
    /// The computation failed: `fmi2Error`, and the instance is in the standard's state `error`.
    #[error("{0}")]
    Failed(String),
}

/// Result of a call on an instance.
pub type CallResult<T = ()> = Result<T, CallError>;

impl CallError {
    /// A wrong call.
    pub fn refused(message: impl Into<String>) -> Self {
        Self::Refused(message.into())
    }

    /// The status that C sees.
    pub fn status(&self) -> Status {
        match self {
            Self::Warned(_) => Status::Warning,
            Self::Discard(_) | Self::NoSuchStatus(_) => Status::Discard,
            Self::Refused(_) | Self::Failed(_) => Status::Error,
        }
    }

    /// The category it is logged under.
    pub fn category(&self) -> LogCategory {
        match self {
            Self::Warned(_) => LogCategory::StatusWarning,
            Self::Discard(_) | Self::NoSuchStatus(_) => LogCategory::StatusDiscard,
            Self::Refused(_) | Self::Failed(_) => LogCategory::StatusError,
        }
    }

    /// Where the standard has no `fmi2Discard` for a function, what cannot be computed is an error.
    pub fn without_discard(self) -> Self {
        match self {
            Self::Discard(message) => Self::Failed(message),
            other => other,
        }
    }
}

impl From<ModelError> for CallError {
    fn from(error: ModelError) -> Self {
        match error {
            ModelError::Discard(message) => Self::Discard(message),
            ModelError::Error(message) => Self::Failed(message),
        }
    }
}
