//! What an `fmi2Component` points to.

use std::sync::{Mutex, MutexGuard, TryLockError};

use super::instance::Instance;
use super::lasting::Stay;
use super::model::Model;
use super::types::Component;

/// First in memory, where it can be looked at before anything else is believed.
const MAGIC: u64 = u64::from_ne_bytes(*b"rps3fmi2");

/// An instance with what tells a wrong pointer and a wrong moment.
///
/// A component of another FMU of this kind and, mostly, one that was freed are recognized; a
/// pointer into foreign memory cannot be. The lock is never waited for: it is taken only when a host calls
/// from within a callback, or from two threads at once, and both are errors.
#[repr(C)]
pub(super) struct Handle<M> {
    magic: u64,
    guid: &'static str,
    instance: Mutex<Instance<M>>,
    /// Ends after the instance, whose tables it keeps.
    _stay: Stay,
}

impl<M: Model> Handle<M> {
    /// Hands an instance out to C.
    pub fn hand_out(instance: Instance<M>, stay: Stay) -> Component {
        let handle = Self { magic: MAGIC, guid: M::guid(), instance: Mutex::new(instance), _stay: stay };
        Box::into_raw(Box::new(handle)).cast()
    }

    /// What stands behind `component`, `None` if that is no instance of this model.
    ///
    /// # Safety
    /// `component` is null or came from [`hand_out`](Self::hand_out), of this model or another, and
    /// was not taken back.
    pub unsafe fn behind<'a>(component: Component) -> Option<&'a Self> {
        let handle: *const Self = component.cast_const().cast();
        if handle.is_null() || !handle.is_aligned() {
            return None;
        }
        // SAFETY: handles of all models begin with the same two fields, and the second is read only
        // if the first is right.
        unsafe { ((*handle).magic == MAGIC && (*handle).guid == M::guid()).then(|| &*handle) }
    }

    /// The instance, unless a call on it is under way.
    pub fn lock(&self) -> Option<MutexGuard<'_, Instance<M>>> {
        match self.instance.try_lock() {
            Ok(instance) => Some(instance),
            // of no importance: the instance itself knows whether it can still be used
            Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }

    /// Takes back what `component` points to, unless a call on it is under way.
    ///
    /// # Safety
    /// As for [`behind`](Self::behind), and `component` is not used any more.
    pub unsafe fn take_back(component: Component) -> Option<Box<Self>> {
        // SAFETY: passed on to the caller.
        let idle = unsafe { Self::behind(component) }?.lock()?;
        let handle: *mut Self = component.cast();
        // SAFETY: it is a handle that no call is using. The mark is gone before the memory is, so that a
        // second try finds none if the memory still stands.
        unsafe { std::ptr::write_volatile(&raw mut (*handle).magic, 0) };
        // the box must be the only way to its content
        drop(idle);
        // SAFETY: from `Box::into_raw`, and taken back once, as the mark tells.
        Some(unsafe { Box::from_raw(handle) })
    }
}
