//! The border to C: raw pointers become references here, and panics stop here.

use std::any::Any;
use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::call_table::Function;
use super::error::{CallError, CallResult};
use super::instance::Instance;
use super::model::Model;
use super::types::{Component, Status};

/// Runs `body` on the instance behind `component`: null check, call table, panic boundary.
///
/// # Safety
/// `component` is null or came from `fmi2Instantiate` of the same model, was not freed, and no
/// other thread uses it during the call.
pub(super) unsafe fn enter<M: Model>(
    component: Component,
    function: Function,
    body: impl FnOnce(&mut Instance<M>) -> CallResult,
) -> Status {
    // SAFETY: the caller's promise; null becomes None.
    let Some(instance) = (unsafe { component.cast::<Instance<M>>().as_mut() }) else { return Status::Error };
    // An unwound instance is poisoned, so that no half-done change is ever seen.
    match catch_unwind(AssertUnwindSafe(|| instance.call(function, body))) {
        Ok(status) => status,
        Err(payload) => {
            // Even the report may panic, in the payload's destructor; there is nobody left to tell.
            let _ = catch_unwind(AssertUnwindSafe(|| instance.poison(function, panic_message(&*payload))));
            let _ = catch_unwind(AssertUnwindSafe(|| drop(payload)));
            Status::Fatal
        }
    }
}

/// The text of a panic.
pub(super) fn panic_message(payload: &(dyn Any + Send)) -> &str {
    payload
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("unknown panic")
}

/// `length` elements at `pointer`; nothing at all if `length` is zero.
///
/// # Safety
/// `pointer` is null or points to `length` elements that nobody writes during `'a`.
pub(super) unsafe fn slice<'a, T>(pointer: *const T, length: usize, name: &str) -> CallResult<&'a [T]> {
    if length == 0 {
        return Ok(&[]);
    }
    check_array(pointer, length, name)?;
    // SAFETY: not null, aligned and of possible size as just checked; the rest is the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts(pointer, length) })
}

/// As [`slice`], to be written.
///
/// # Safety
/// `pointer` is null or points to `length` elements that nobody else touches during `'a`.
pub(super) unsafe fn slice_mut<'a, T>(pointer: *mut T, length: usize, name: &str) -> CallResult<&'a mut [T]> {
    if length == 0 {
        return Ok(&mut []);
    }
    check_array(pointer, length, name)?;
    // SAFETY: as in `slice`.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer, length) })
}

/// The variable that `pointer` points to.
///
/// # Safety
/// `pointer` is null or points to a `T` that nobody else touches during `'a`.
pub(super) unsafe fn target<'a, T>(pointer: *mut T, name: &str) -> CallResult<&'a mut T> {
    check_array(pointer, 1, name)?;
    // SAFETY: not null and aligned as just checked; the rest is the caller's promise.
    Ok(unsafe { &mut *pointer })
}

fn check_array<T>(pointer: *const T, length: usize, name: &str) -> CallResult {
    if pointer.is_null() {
        Err(CallError::Refused(format!("{name} is NULL")))
    } else if !pointer.is_aligned() {
        Err(CallError::Refused(format!("{name} is not aligned")))
    } else if length > isize::MAX as usize / size_of::<T>() {
        Err(CallError::Refused(format!("{name} cannot have {length} elements")))
    } else {
        Ok(())
    }
}

/// A C string, `None` for null.
///
/// # Safety
/// `pointer` is null or points to a string that ends with NUL and that nobody writes during `'a`.
pub(super) unsafe fn text<'a>(pointer: *const c_char) -> Option<&'a CStr> {
    // SAFETY: not null; the rest is the caller's promise.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) })
}
