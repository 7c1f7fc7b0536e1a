//! What is fuzzed and what must hold, as functions from bytes: libFuzzer calls them with inputs
//! that it breeds, `tests/robustness_fuzz.rs` with seeded random ones.
//!
//! A function that returns has found nothing; a broken promise panics. The promises:
//! - the call table holds: a call it forbids is `fmi2Error`, and no other status comes than those
//!   the standard has for the function;
//! - a refused call changes nothing: the serialized state is the same to the last byte;
//! - no number that is not finite comes with `fmi2OK`, and none with `fmi2Warning` is read later;
//! - nothing panics (`fmi2Fatal`), nothing takes longer than a host would wait;
//! - a step from a restored state gives the same bits again.

mod calls;
mod host;
mod numbers;
mod parameters;
mod states;
mod tally;

pub use calls::calls;
pub use parameters::parameters;
pub use states::states;
pub use tally::TALLY;
