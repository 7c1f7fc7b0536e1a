//! What an `fmi2Component` points to.

use std::any::TypeId;

use try_lock::{Locked, TryLock};

use super::instance::Instance;
use super::lasting::Stay;
use super::model::Model;
use super::types::Component;

/// First in memory, where it can be looked at before anything else is believed.
const MAGIC: u64 = u64::from_ne_bytes(*b"rps3fmi2");

/// Its address stands for this library: no other has it, not even a second copy of the same file.
static LIBRARY: u8 = 0;

/// An instance with what tells a wrong pointer and a wrong moment.
///
/// A component of another FMU of this kind and, mostly, one that was freed are recognized; a
/// pointer into foreign memory cannot be. The lock is never waited for: it is taken only when a host calls
/// from within a callback, or from two threads at once, and both are errors.
#[repr(C)]
pub(super) struct Handle<M> {
    magic: u64,
    library: *const u8,
    model: TypeId,
    instance: TryLock<Instance<M>>,
    /// Ends after the instance, whose tables it keeps.
    _stay: Stay,
}

impl<M: Model> Handle<M> {
    /// Hands an instance out to C.
    pub fn hand_out(instance: Instance<M>, stay: Stay) -> Component {
        let (library, model) = (&raw const LIBRARY, TypeId::of::<M>());
        let handle = Self { magic: MAGIC, library, model, instance: TryLock::new(instance), _stay: stay };
        Box::into_raw(Box::new(handle)).cast()
    }

    /// What stands behind `component`, `None` if that is no instance of this model, made by this library.
    ///
    /// # Safety
    /// `component` is null or came from [`hand_out`](Self::hand_out), of this model or another, and
    /// was not taken back.
    pub unsafe fn behind<'a>(component: Component) -> Option<&'a Self> {
        let handle: *const Self = component.cast_const().cast();
        if handle.is_null() || !handle.is_aligned() {
            return None;
        }
        // SAFETY: handles of all libraries begin with a mark and a pointer, those of this library with the same
        // three fields, and each is read only if what stands before it is right.
        unsafe {
            let ours = (*handle).magic == MAGIC
                && std::ptr::eq((*handle).library, &raw const LIBRARY)
                && (*handle).model == TypeId::of::<M>();
            ours.then(|| &*handle)
        }
    }

    /// The instance, unless a call on it is under way. One that a panic has left is given out as well: it knows itself
    /// whether it can still be used.
    pub fn lock(&self) -> Option<Locked<'_, Instance<M>>> {
        self.instance.try_lock()
    }

    /// Takes back what `component` points to, unless a call on it is under way.
    ///
    /// # Safety
    /// As for [`behind`](Self::behind), and `component` is not used any more.
    pub unsafe fn take_back(component: Component) -> Option<Box<Self>> {
        // SAFETY: passed on to the caller.
        let idle = unsafe { Self::behind(component) }?.lock()?;
        // locked for good
        std::mem::forget(idle);
        let handle: *mut Self = component.cast();
        // SAFETY: it is a handle that no call is using. The mark is gone before the memory is, so that a
        // second try finds none if the memory still stands.
        unsafe { std::ptr::write_volatile(&raw mut (*handle).magic, 0) };
        // SAFETY: from `Box::into_raw`, and taken back once, as the mark and the lock tell.
        Some(unsafe { Box::from_raw(handle) })
    }
}
