//! Messages to the host (FMI 2.0 section 2.1.5).
//!
//! `loggingOn` switches *debug* logging. Warnings, errors and fatal errors are logged without it
//! as well, since section 2.1.3 promises that the logger was called for them; only
//! `fmi2SetDebugLogging` can silence them.

use std::ffi::{CStr, CString, c_int};

use super::model::Log;
use super::types::{CallbackFunctions, Status};
use crate::description::{LOG_ALL, LogCategory};

/// The host's logger with the categories that are on.
#[derive(Debug, Clone)]
pub struct Logger {
    callbacks: Option<CallbackFunctions>,
    instance_name: CString,
    /// One bit a category.
    enabled: u8,
}

const EVERYTHING: u8 = {
    let mut bits = 0;
    let mut i = 0;
    while i < LogCategory::ALL.len() {
        bits |= bit(LogCategory::ALL[i]);
        i += 1;
    }
    bits
};

const fn bit(category: LogCategory) -> u8 {
    1 << category as u8
}

impl Logger {
    /// A logger over a copy of the host's callbacks, as `fmi2Instantiate` leaves it.
    pub fn new(callbacks: Option<CallbackFunctions>, instance_name: &CStr, logging_on: bool) -> Self {
        let always = bit(LogCategory::StatusWarning) | bit(LogCategory::StatusError) | bit(LogCategory::StatusFatal);
        Self {
            callbacks,
            instance_name: instance_name.to_owned(),
            enabled: if logging_on { EVERYTHING } else { always },
        }
    }

    /// `fmi2SetDebugLogging`: switches `names`, or all categories if there are none.
    ///
    /// # Errors
    /// The first name that is not declared; nothing is switched then.
    pub fn switch<'a>(&mut self, on: bool, names: &[&'a CStr]) -> Result<(), &'a CStr> {
        let mut chosen = if names.is_empty() { EVERYTHING } else { 0 };
        for name in names {
            chosen |= match LogCategory::ALL.iter().find(|c| c.name().as_bytes() == name.to_bytes()) {
                Some(&category) => bit(category),
                None if name.to_bytes() == LOG_ALL.as_bytes() => EVERYTHING,
                None => return Err(name),
            };
        }
        self.enabled = if on { chosen } else { self.enabled & !chosen };
        Ok(())
    }

    /// Passes a message to the host if its category is on.
    pub fn log(&self, status: Status, category: LogCategory, message: &str) {
        let Some(CallbackFunctions { logger: Some(callback), component_environment, .. }) = self.callbacks else {
            return;
        };
        if self.enabled & bit(category) == 0 {
            return;
        }
        // `#` would start a variable reference (section 2.1.5); a NUL would end the message.
        let escaped = message.replace('#', "##").replace('\0', " ");
        let (Ok(message), Ok(category)) = (CString::new(escaped), CString::new(category.name())) else { return };
        // SAFETY: the host guarantees a logger of this signature that outlives the instance; all
        // strings end with NUL and live until it returns, and "%s" takes exactly the one argument.
        unsafe {
            callback(
                component_environment,
                self.instance_name.as_ptr(),
                status as c_int,
                category.as_ptr(),
                c"%s".as_ptr(),
                message.as_ptr(),
            );
        }
    }
}

impl Log for Logger {
    fn warning(&mut self, message: &str) {
        self.log(Status::Warning, LogCategory::StatusWarning, message);
    }

    fn event(&mut self, message: &str) {
        self.log(Status::Ok, LogCategory::Events, message);
    }
}
