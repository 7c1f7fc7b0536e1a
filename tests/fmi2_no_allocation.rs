//! `fmi2DoStep`, `fmi2GetReal` and `fmi2SetReal` allocate nothing when they succeed.

#[path = "fmi2_rules/host.rs"]
#[allow(dead_code)] // this test needs a part of it
mod host;
#[path = "fmi2_rules/toy.rs"]
#[allow(dead_code)]
mod toy;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use host::{CoSimulation, Host, call};
use rps3::fmi2::types::Status;
use toy::real;

rps3::export_fmu!(toy::Oscillator);

/// The system's allocator, counting the calls of the current thread.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

// SAFETY: all requests go to the system's allocator unchanged; the counter does not allocate.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }
}

fn allocations(work: impl FnOnce()) -> usize {
    let before = ALLOCATIONS.get();
    work();
    ALLOCATIONS.get() - before
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(std::hint::black_box(Box::new(1)))), 1);
}

#[test]
fn steps_with_getting_setting_and_input_derivatives_allocate_nothing() {
    let host = Host::initialized(CoSimulation);
    let references = [real::TIME, real::X, real::V, real::Y, real::HELD];
    let mut values = [0.0; 5];
    let count = allocations(|| {
        for n in 0..100 {
            let (u, rate, order) = (f64::from(n), 2.0, 1);
            assert_eq!(host.set_real(real::U, u), Status::Ok);
            assert_eq!(call!(fmi2SetRealInputDerivatives(host.c, &real::U, 1, &order, &rate)), Status::Ok);
            assert_eq!(host.step(f64::from(n) * 0.01, 0.01), Status::Ok);
            assert_eq!(call!(fmi2GetReal(host.c, references.as_ptr(), 5, values.as_mut_ptr())), Status::Ok);
            assert_eq!(
                call!(fmi2GetRealOutputDerivatives(host.c, &real::X, 1, &order, values.as_mut_ptr())),
                Status::Ok
            );
            let (known, seed) = (real::U, 1.0);
            let mut derivative = 0.0;
            let _ = call!(fmi2GetDirectionalDerivative(host.c, &real::Y, 1, &known, 1, &seed, &mut derivative));
        }
    });
    assert_eq!(count, 0);
}

#[test]
fn reusing_a_state_allocates_nothing() {
    let host = Host::initialized(CoSimulation);
    let mut state = host.state();
    let count = allocations(|| {
        for _ in 0..10 {
            assert_eq!(call!(fmi2GetFMUstate(host.c, &mut state)), Status::Ok);
            assert_eq!(call!(fmi2SetFMUstate(host.c, state)), Status::Ok);
        }
    });
    assert_eq!(count, 0);
}
