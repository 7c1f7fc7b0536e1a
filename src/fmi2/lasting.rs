//! Statics that are freed when the library is unloaded.
//!
//! A host that loads and unloads an FMU thousands of times would otherwise lose the tables of
//! each round: Rust drops no statics. They are freed by `atexit`, which on the common platforms runs
//! when the shared library that called it goes. At the end of the process, where it runs too, a
//! thread may still be in a call; so nothing is freed while there is an instance, and no instance is
//! made any more once the tables are gone.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

/// Stays that have not ended, or [`GONE`].
static STAYS: AtomicUsize = AtomicUsize::new(0);

/// The tables were freed.
const GONE: usize = usize::MAX;

/// What frees the values.
static OWNERS: Mutex<Vec<Box<dyn FnOnce() + Send>>> = Mutex::new(Vec::new());

/// While there is one, nothing is freed: each instance has one.
#[derive(Debug)]
pub(super) struct Stay(());

impl Stay {
    /// A new one, `None` if it is too late.
    pub fn begin() -> Option<Self> {
        let begun = STAYS.fetch_update(Ordering::AcqRel, Ordering::Acquire, |stays| (stays != GONE).then(|| stays + 1));
        begun.ok().map(|_| Self(()))
    }
}

impl Drop for Stay {
    fn drop(&mut self) {
        STAYS.fetch_sub(1, Ordering::AcqRel);
    }
}

/// A value made at its first use, that lasts until the library is unloaded.
#[derive(Debug, Default)]
pub struct Lasting<T: 'static>(OnceLock<&'static T>);

impl<T: Send + Sync + 'static> Lasting<T> {
    /// Nothing yet.
    pub const fn new() -> Self {
        Self(OnceLock::new())
    }

    /// The value, made by `make` if this is its first use.
    pub fn get_or_init(&self, make: impl FnOnce() -> T) -> &'static T {
        self.0.get_or_init(|| {
            let value: *mut T = Box::into_raw(Box::new(make()));
            let address = value.expose_provenance();
            own(Box::new(move || {
                let value = std::ptr::with_exposed_provenance_mut::<T>(address);
                // SAFETY: from `Box::into_raw`, freed once, when nobody can use the library any more.
                drop(unsafe { Box::from_raw(value) });
            }));
            // SAFETY: just made, and freed when the library is unloaded only.
            unsafe { &*value }
        })
    }
}

fn own(owner: Box<dyn FnOnce() + Send>) {
    let mut owners = OWNERS.lock().unwrap_or_else(PoisonError::into_inner);
    if owners.is_empty() {
        // SAFETY: `free_all` is as `atexit` wants it. If it cannot be registered, nothing is freed.
        unsafe { libc::atexit(free_all) };
    }
    owners.push(owner);
}

extern "C" fn free_all() {
    if STAYS.compare_exchange(0, GONE, Ordering::AcqRel, Ordering::Acquire).is_err() {
        return;
    }
    let owners = std::mem::take(&mut *OWNERS.lock().unwrap_or_else(PoisonError::into_inner));
    // what was made last may refer to what was made before
    for owner in owners.into_iter().rev() {
        owner();
    }
}
