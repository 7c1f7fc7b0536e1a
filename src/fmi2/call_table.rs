//! Which function may be called when: the tables of FMI 2.0.5, sections 3.2.3 and 4.2.4.
//!
//! The conditions that the standard puts on single variables (its footnotes 1 to 6) stand in
//! `layout`. Deviations, all to the lenient side: values of any variable, not only of
//! `InitialUnknowns`, can be read in Initialization Mode (footnote 2), since masters do so; and
//! `fmi2FreeInstance` frees an instance in every mode.

use serde::{Deserialize, Serialize};

use super::types::Interface;

/// Where an instance stands. The standard's `stepInProgress` and `stepCanceled` do not occur:
/// `fmi2DoStep` is synchronous.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u16)]
pub enum Mode {
    Instantiated = 1,
    Initialization = 1 << 1,
    /// Model Exchange
    Event = 1 << 2,
    /// Model Exchange
    ContinuousTime = 1 << 3,
    /// Co-Simulation
    StepComplete = 1 << 4,
    /// Co-Simulation, after `fmi2Discard`
    StepFailed = 1 << 5,
    Terminated = 1 << 6,
    Error = 1 << 7,
    Fatal = 1 << 8,
}

/// A set of modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Modes(u16);

impl Modes {
    /// No mode at all.
    pub const NONE: Self = Self(0);

    /// The set of `modes`.
    pub const fn of(modes: &[Mode]) -> Self {
        let mut bits = 0;
        let mut i = 0;
        while i < modes.len() {
            bits |= modes[i] as u16;
            i += 1;
        }
        Self(bits)
    }

    /// Modes of either set.
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether `mode` is in the set.
    pub const fn contains(self, mode: Mode) -> bool {
        self.0 & mode as u16 != 0
    }
}

/// The functions that act on an instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
pub enum Function {
    SetDebugLogging,
    FreeInstance,
    SetupExperiment,
    EnterInitializationMode,
    ExitInitializationMode,
    Terminate,
    Reset,
    GetReal,
    GetInteger,
    GetBoolean,
    GetString,
    SetReal,
    SetInteger,
    SetBoolean,
    SetString,
    GetFmuState,
    SetFmuState,
    FreeFmuState,
    SerializedFmuStateSize,
    SerializeFmuState,
    DeSerializeFmuState,
    GetDirectionalDerivative,
    EnterEventMode,
    NewDiscreteStates,
    EnterContinuousTimeMode,
    CompletedIntegratorStep,
    SetTime,
    SetContinuousStates,
    GetEventIndicators,
    GetContinuousStates,
    GetDerivatives,
    GetNominalsOfContinuousStates,
    SetRealInputDerivatives,
    GetRealOutputDerivatives,
    DoStep,
    CancelStep,
    GetStatus,
    GetRealStatus,
    GetIntegerStatus,
    GetBooleanStatus,
    GetStringStatus,
}

/// A row of the tables.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    pub function: Function,
    /// The C name.
    pub name: &'static str,
    pub model_exchange: Modes,
    pub co_simulation: Modes,
}

/// The rows in the order of [`Function`].
pub const TABLE: [Row; 41] = {
    use Function as F;
    use Mode::{ContinuousTime, Error, Event, Initialization, Instantiated, StepComplete, StepFailed, Terminated};
    const NONE: &[Mode] = &[];
    // every mode but fatal
    const ME: &[Mode] = &[Instantiated, Initialization, Event, ContinuousTime, Terminated, Error];
    const CS: &[Mode] = &[Instantiated, Initialization, StepComplete, StepFailed, Terminated, Error];
    // once equations are active, debugging after an error included
    const ME_GET: &[Mode] = &[Initialization, Event, ContinuousTime, Terminated, Error];
    const CS_GET: &[Mode] = &[Initialization, StepComplete, StepFailed, Terminated, Error];
    const CS_SET: &[Mode] = &[Instantiated, Initialization, StepComplete];
    const CS_STATUS: &[Mode] = &[StepComplete, StepFailed, Terminated];
    const INSTANTIATED: &[Mode] = &[Instantiated];
    const INITIALIZATION: &[Mode] = &[Initialization];
    const fn row(function: Function, name: &'static str, me: &[Mode], cs: &[Mode]) -> Row {
        Row { function, name, model_exchange: Modes::of(me), co_simulation: Modes::of(cs) }
    }
    [
        row(F::SetDebugLogging, "fmi2SetDebugLogging", ME, CS),
        row(F::FreeInstance, "fmi2FreeInstance", ME, CS),
        row(F::SetupExperiment, "fmi2SetupExperiment", INSTANTIATED, INSTANTIATED),
        row(F::EnterInitializationMode, "fmi2EnterInitializationMode", INSTANTIATED, INSTANTIATED),
        row(F::ExitInitializationMode, "fmi2ExitInitializationMode", INITIALIZATION, INITIALIZATION),
        row(F::Terminate, "fmi2Terminate", &[Event, ContinuousTime], &[StepComplete, StepFailed]),
        row(F::Reset, "fmi2Reset", ME, CS),
        row(F::GetReal, "fmi2GetReal", ME_GET, CS_GET),
        row(F::GetInteger, "fmi2GetInteger", ME_GET, CS_GET),
        row(F::GetBoolean, "fmi2GetBoolean", ME_GET, CS_GET),
        row(F::GetString, "fmi2GetString", ME_GET, CS_GET),
        row(F::SetReal, "fmi2SetReal", &[Instantiated, Initialization, Event, ContinuousTime], CS_SET),
        row(F::SetInteger, "fmi2SetInteger", &[Instantiated, Initialization, Event], CS_SET),
        row(F::SetBoolean, "fmi2SetBoolean", &[Instantiated, Initialization, Event], CS_SET),
        row(F::SetString, "fmi2SetString", &[Instantiated, Initialization, Event], CS_SET),
        row(F::GetFmuState, "fmi2GetFMUstate", ME, CS),
        row(F::SetFmuState, "fmi2SetFMUstate", ME, CS),
        row(F::FreeFmuState, "fmi2FreeFMUstate", ME, CS),
        row(F::SerializedFmuStateSize, "fmi2SerializedFMUstateSize", ME, CS),
        row(F::SerializeFmuState, "fmi2SerializeFMUstate", ME, CS),
        row(F::DeSerializeFmuState, "fmi2DeSerializeFMUstate", ME, CS),
        row(F::GetDirectionalDerivative, "fmi2GetDirectionalDerivative", ME_GET, CS_GET),
        row(F::EnterEventMode, "fmi2EnterEventMode", &[Event, ContinuousTime], NONE),
        row(F::NewDiscreteStates, "fmi2NewDiscreteStates", &[Event], NONE),
        row(F::EnterContinuousTimeMode, "fmi2EnterContinuousTimeMode", &[Event], NONE),
        row(F::CompletedIntegratorStep, "fmi2CompletedIntegratorStep", &[ContinuousTime], NONE),
        row(F::SetTime, "fmi2SetTime", &[Event, ContinuousTime], NONE),
        row(F::SetContinuousStates, "fmi2SetContinuousStates", &[ContinuousTime], NONE),
        row(F::GetEventIndicators, "fmi2GetEventIndicators", ME_GET, NONE),
        row(F::GetContinuousStates, "fmi2GetContinuousStates", ME_GET, NONE),
        row(F::GetDerivatives, "fmi2GetDerivatives", ME_GET, NONE),
        row(F::GetNominalsOfContinuousStates, "fmi2GetNominalsOfContinuousStates", ME, NONE),
        row(F::SetRealInputDerivatives, "fmi2SetRealInputDerivatives", NONE, CS_SET),
        row(
            F::GetRealOutputDerivatives,
            "fmi2GetRealOutputDerivatives",
            NONE,
            &[StepComplete, StepFailed, Terminated, Error],
        ),
        row(F::DoStep, "fmi2DoStep", NONE, &[StepComplete]),
        // legal in stepInProgress only, which a synchronous step never leaves behind
        row(F::CancelStep, "fmi2CancelStep", NONE, NONE),
        row(F::GetStatus, "fmi2GetStatus", NONE, CS_STATUS),
        row(F::GetRealStatus, "fmi2GetRealStatus", NONE, CS_STATUS),
        row(F::GetIntegerStatus, "fmi2GetIntegerStatus", NONE, CS_STATUS),
        row(F::GetBooleanStatus, "fmi2GetBooleanStatus", NONE, CS_STATUS),
        row(F::GetStringStatus, "fmi2GetStringStatus", NONE, CS_STATUS),
    ]
};

const _: () = {
    let mut i = 0;
    while i < TABLE.len() {
        assert!(TABLE[i].function as usize == i, "the rows follow the order of Function");
        i += 1;
    }
};

impl Function {
    /// The C name.
    pub const fn name(self) -> &'static str {
        TABLE[self as usize].name
    }

    /// Whether the function may be called on an instance of `interface` in `mode`.
    pub const fn is_legal(self, interface: Interface, mode: Mode) -> bool {
        let row = &TABLE[self as usize];
        let modes = match interface {
            Interface::ModelExchange => row.model_exchange,
            Interface::CoSimulation => row.co_simulation,
        };
        modes.contains(mode)
    }
}
