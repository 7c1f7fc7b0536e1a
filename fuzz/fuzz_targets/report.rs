//! Tells at the end what was tried: libFuzzer counts inputs, of which each makes many calls.

extern "C" fn report() {
    eprintln!("{}", rps3_fuzz::TALLY);
}

/// Has the report printed when the process exits.
pub fn at_exit() {
    // SAFETY: a function without arguments that does not unwind.
    assert_eq!(unsafe { libc::atexit(report) }, 0);
}
