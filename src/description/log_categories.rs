//! The log categories of every FMU of this crate (FMI 2.0 section 2.2.4).

/// A category under which the FMI layer logs; the names are the standard's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum LogCategory {
    Events,
    StatusWarning,
    StatusDiscard,
    StatusError,
    StatusFatal,
}

/// The standard's name for all categories together; declared, but no message bears it.
pub const LOG_ALL: &str = "logAll";

impl LogCategory {
    /// Every category that messages are logged under.
    pub const ALL: [Self; 5] =
        [Self::Events, Self::StatusWarning, Self::StatusDiscard, Self::StatusError, Self::StatusFatal];

    /// Its name in `LogCategories` and in calls of the logger.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Events => "logEvents",
            Self::StatusWarning => "logStatusWarning",
            Self::StatusDiscard => "logStatusDiscard",
            Self::StatusError => "logStatusError",
            Self::StatusFatal => "logStatusFatal",
        }
    }

    /// Its description in `LogCategories`.
    pub const fn description(self) -> &'static str {
        match self {
            Self::Events => "Noteworthy events during the simulation",
            Self::StatusWarning => "What the user should know although the call succeeded",
            Self::StatusDiscard => "Why a call returned fmi2Discard",
            Self::StatusError => "Why a call returned fmi2Error",
            Self::StatusFatal => "Why a call returned fmi2Fatal",
        }
    }
}
