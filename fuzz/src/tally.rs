//! How much was tried.

use std::fmt::{Display, Formatter, Result};
use std::sync::atomic::{AtomicU64, Ordering};

/// Counters of this process; the threads of a test share them.
#[derive(Debug)]
pub struct Tally {
    /// Calls of FMI functions whose outcome was checked.
    pub calls: AtomicU64,
    /// Byte strings given to `fmi2DeSerializeFMUstate`.
    pub states: AtomicU64,
    /// Sets of parameters given to an initialization.
    pub parameters: AtomicU64,
}

/// What this process has tried so far.
pub static TALLY: Tally = Tally { calls: AtomicU64::new(0), states: AtomicU64::new(0), parameters: AtomicU64::new(0) };

/// One more.
pub fn count(counter: &AtomicU64) {
    counter.fetch_add(1, Ordering::Relaxed);
}

impl Display for Tally {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let [calls, states, parameters] =
            [&self.calls, &self.states, &self.parameters].map(|counter| counter.load(Ordering::Relaxed));
        write!(f, "{calls} checked FMI calls, {states} states as bytes, {parameters} sets of parameters")
    }
}
