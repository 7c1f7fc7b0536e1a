//! The border to C: raw pointers become references here, and panics stop here.

use std::any::Any;
use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::call_table::Function;
use super::error::{CallError, CallResult};
use super::handle::Handle;
use super::instance::Instance;
use super::model::Model;
use super::types::{Component, Status};

/// Runs `body` on the instance behind `component`: checks of the pointer, call table, panic boundary.
///
/// A wrong pointer, and a call while another is under way, are `fmi2Error` without a message: there
/// is no logger, or it is where the call came from.
///
/// # Safety
/// `component` is null or came from `fmi2Instantiate` and was not freed.
pub(super) unsafe fn enter<M: Model>(
    component: Component,
    function: Function,
    body: impl FnOnce(&mut Instance<M>) -> CallResult,
) -> Status {
    // SAFETY: the caller's promise.
    let handle = unsafe { Handle::<M>::behind(component) };
    let Some(mut instance) = handle.and_then(Handle::lock) else { return Status::Error };
    // An unwound instance is poisoned, so that no half-done change is ever seen.
    match catch_unwind(AssertUnwindSafe(|| instance.call(function, body))) {
        Ok(status) => status,
        Err(payload) => unwound(&mut instance, function, payload),
    }
}

#[cold]
fn unwound<M: Model>(instance: &mut Instance<M>, function: Function, payload: Box<dyn Any + Send>) -> Status {
    // Even the report may panic, in the payload's destructor; there is nobody left to tell.
    let _ = catch_unwind(AssertUnwindSafe(|| instance.poison(function, panic_message(&*payload))));
    let _ = catch_unwind(AssertUnwindSafe(|| drop(payload)));
    Status::Fatal
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

#[inline]
fn check_array<T>(pointer: *const T, length: usize, name: &str) -> CallResult {
    let possible = !pointer.is_null() && pointer.is_aligned() && length <= isize::MAX as usize / size_of::<T>();
    if possible { Ok(()) } else { Err(impossible_array(pointer.is_null(), pointer.is_aligned(), length, name)) }
}

#[cold]
fn impossible_array(null: bool, aligned: bool, length: usize, name: &str) -> CallError {
    if null {
        CallError::Refused(format!("{name} is NULL"))
    } else if !aligned {
        CallError::Refused(format!("{name} is not aligned"))
    } else {
        CallError::Refused(format!("{name} cannot have {length} elements"))
    }
}

/// An array that a caller passed, as an address, its length in bytes and its name.
pub(super) type Array<'a> = (usize, usize, &'a str);

/// What C passed as `pointer` and `length`, if it can be an array.
#[inline]
pub(super) fn array<T>(pointer: *const T, length: usize, name: &str) -> CallResult<Array<'_>> {
    if length > 0 {
        check_array(pointer, length, name)?;
    }
    Ok((pointer.addr(), length * size_of::<T>(), name))
}

/// Refuses results that would be written over one of the arguments.
#[inline]
pub(super) fn apart<const N: usize>(results: Array, arguments: [Array; N]) -> CallResult {
    for argument in arguments {
        let ((to, written, to_name), (from, read, from_name)) = (results, argument);
        if written > 0 && read > 0 && to < from.saturating_add(read) && from < to.saturating_add(written) {
            return Err(overlap(to_name, from_name));
        }
    }
    Ok(())
}

#[cold]
fn overlap(to_name: &str, from_name: &str) -> CallError {
    CallError::Refused(format!("{to_name} and {from_name} overlap"))
}

/// A C string, `None` for null.
///
/// # Safety
/// `pointer` is null or points to a string that ends with NUL and that nobody writes during `'a`.
pub(super) unsafe fn text<'a>(pointer: *const c_char) -> Option<&'a CStr> {
    // SAFETY: not null; the rest is the caller's promise.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) })
}
