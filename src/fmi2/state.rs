//! The complete FMU state, in memory and as bytes (FMI 2.0 section 2.1.8).
//!
//! A handle is the address of the snapshot it stands for. It is never followed: the instance
//! looks it up among those it handed out, so that a foreign, freed or made-up handle is refused.

use super::error::{CallError, CallResult};
use super::instance::{Instance, Snapshot};
use super::model::Model;
use super::state_bytes;
use super::types::FmuState;

fn unknown_handle() -> CallError {
    CallError::refused("the FMU state is not one of this instance, or was freed")
}

impl<M: Model> Instance<M> {
    /// `fmi2GetFMUstate`: into the state behind `handle`, or into a new one if that is null.
    pub(super) fn get_fmu_state(&mut self, handle: FmuState) -> CallResult<FmuState> {
        if handle.is_null() {
            return Ok(self.hand_out(self.now.clone()));
        }
        let state = self.states.get_mut(&handle.addr()).ok_or_else(unknown_handle)?;
        (**state).clone_from(&self.now);
        Ok(handle)
    }

    /// `fmi2SetFMUstate`
    pub(super) fn set_fmu_state(&mut self, handle: FmuState) -> CallResult {
        let state = self.states.get(&handle.addr()).ok_or_else(unknown_handle)?;
        self.now.clone_from(state);
        Ok(())
    }

    /// `fmi2FreeFMUstate` of a handle that is not null.
    pub(super) fn free_fmu_state(&mut self, handle: FmuState) -> CallResult {
        self.states.remove(&handle.addr()).map(drop).ok_or_else(unknown_handle)
    }

    /// The bytes of the state behind `handle`.
    pub(super) fn serialize(&self, handle: FmuState) -> CallResult<Vec<u8>> {
        let state = self.states.get(&handle.addr()).ok_or_else(unknown_handle)?;
        state_bytes::write(M::guid(), &**state).map_err(|error| CallError::Refused(error.to_string()))
    }

    /// `fmi2DeSerializeFMUstate`: a new state from bytes.
    pub(super) fn deserialize(&mut self, bytes: &[u8]) -> CallResult<FmuState> {
        let snapshot: Snapshot<M> =
            state_bytes::read(M::guid(), bytes).map_err(|error| CallError::Refused(error.to_string()))?;
        if !snapshot.fits(self.now.interface, self.layout) {
            return Err(CallError::refused("the state does not fit this instance"));
        }
        Ok(self.hand_out(snapshot))
    }

    fn hand_out(&mut self, snapshot: Snapshot<M>) -> FmuState {
        let mut state = Box::new(snapshot);
        let handle: *mut Snapshot<M> = &mut *state;
        self.states.insert(handle.addr(), state);
        handle.cast()
    }
}
